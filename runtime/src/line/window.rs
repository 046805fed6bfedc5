//! Views of a list around several sites that a loop computes together. Each view has a static length, so that the
//! compiler removes the tests of indices.

use super::columns::{Columns, Numbered, of_length};
use super::part::LANES;
use crate::Real;
use num_traits::Zero;

/// A list from which `M` consecutive sites can be read together.
pub trait Windowed<const M: usize> {
    /// The view of `M` sites.
    type Window<'a>
    where
        Self: 'a;

    /// The view that starts at site `first`.
    ///
    /// # Panics
    /// If fewer than `M` sites remain.
    fn window(&self, first: usize) -> Self::Window<'_>;
}

/// A view of a list that stores each number of a value in a separate column.
pub struct Window<'a, V: Numbered<N>, const N: usize, const M: usize> {
    columns: [&'a [V::Number; M]; N],
    first: usize,
}

impl<V: Numbered<N>, const N: usize, const M: usize> Window<'_, V, N, M> {
    /// The value at one of the [`LANES`] sites.
    #[inline(always)]
    pub fn at(&self, site: usize) -> V {
        self.ahead::<0>(site)
    }

    /// The value `ON` sites ahead. The index check is the same as in the loop; a different check may halve the number
    /// of sites computed together.
    #[inline(always)]
    pub fn ahead<const ON: usize>(&self, site: usize) -> V {
        // A loop: `map` of an array is not always inlined.
        let mut numbers = [V::Number::zero(); N];
        for (number, column) in numbers.iter_mut().zip(&self.columns) {
            *number = lanes::<_, ON, M>(column)[site - self.first];
        }
        V::of(numbers)
    }
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize, const M: usize> Windowed<M>
    for Columns<V, T, N>
{
    type Window<'a>
        = Window<'a, V, N, M>
    where
        Self: 'a;

    #[inline(always)]
    fn window(&self, first: usize) -> Window<'_, V, N, M> {
        Window {
            columns: self.columns(first),
            first,
        }
    }
}

/// A view of a list that stores values one after another.
pub struct Stretch<'a, V, const M: usize> {
    list: &'a [V; M],
    first: usize,
}

impl<V: Copy, const M: usize> Stretch<'_, V, M> {
    /// The value at one of the [`LANES`] sites.
    #[inline(always)]
    pub fn at(&self, site: usize) -> V {
        self.ahead::<0>(site)
    }

    /// The value `ON` sites ahead.
    #[inline(always)]
    pub fn ahead<const ON: usize>(&self, site: usize) -> V {
        lanes::<_, ON, M>(self.list)[site - self.first]
    }
}

/// The [`LANES`] sites of a window that start `ON` sites ahead.
#[inline(always)]
fn lanes<T, const ON: usize, const M: usize>(window: &[T; M]) -> &[T; LANES] {
    of_length(&window[ON..ON + LANES])
}

impl<V: Copy, const M: usize> Windowed<M> for Vec<V> {
    type Window<'a>
        = Stretch<'a, V, M>
    where
        Self: 'a;

    #[inline(always)]
    fn window(&self, first: usize) -> Stretch<'_, V, M> {
        Stretch {
            list: of_length(&self[first..first + M]),
            first,
        }
    }
}
