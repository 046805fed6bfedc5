//! What loops over sites read of a list around several sites that they compute together: each number of all these sites side by
//! side, as many of them as the compiler is told, so that no index is tested.

use super::columns::{Columns, Numbered, of_length};
use crate::Real;
use nalgebra::SMatrix;
use num_traits::Zero;

/// A list of which `M` sites can be read together.
pub trait Windowed<const M: usize> {
    /// Those sites.
    type Window<'a>
    where
        Self: 'a;

    /// The sites from one on.
    ///
    /// # Panics
    /// Where there are fewer.
    fn window(&self, first: usize) -> Self::Window<'_>;
}

/// Sites of a list of values of several numbers.
pub struct Window<'a, V: Numbered<N>, const N: usize, const M: usize> {
    columns: [&'a [V::Number; M]; N],
    first: usize,
}

impl<V: Numbered<N>, const N: usize, const M: usize> Window<'_, V, N, M> {
    /// The value at a site.
    #[inline(always)]
    pub fn at(&self, site: usize) -> V {
        // A loop: `map` of an array is not always inlined.
        let mut numbers = [V::Number::zero(); N];
        for (number, column) in numbers.iter_mut().zip(&self.columns) {
            *number = column[site - self.first];
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

/// Sites of a list of matrices.
pub struct Matrices<'a, T, const R: usize, const C: usize, const M: usize> {
    list: &'a [SMatrix<T, R, C>; M],
    first: usize,
}

impl<T: Real, const R: usize, const C: usize, const M: usize> Matrices<'_, T, R, C, M> {
    /// The value at a site.
    #[inline(always)]
    pub fn at(&self, site: usize) -> SMatrix<T, R, C> {
        self.list[site - self.first]
    }
}

impl<T: Real, const R: usize, const C: usize, const M: usize> Windowed<M>
    for Vec<SMatrix<T, R, C>>
{
    type Window<'a>
        = Matrices<'a, T, R, C, M>
    where
        Self: 'a;

    #[inline(always)]
    fn window(&self, first: usize) -> Matrices<'_, T, R, C, M> {
        Matrices {
            list: of_length(&self[first..first + M]),
            first,
        }
    }
}

/// Sites of a list of numbers.
pub struct Numbers<'a, T, const M: usize> {
    list: &'a [T; M],
    first: usize,
}

impl<T: Copy, const M: usize> Numbers<'_, T, M> {
    /// The number at a site.
    #[inline(always)]
    pub fn at(&self, site: usize) -> T {
        self.list[site - self.first]
    }
}

impl<T: Real, const M: usize> Windowed<M> for Vec<T> {
    type Window<'a>
        = Numbers<'a, T, M>
    where
        Self: 'a;

    #[inline(always)]
    fn window(&self, first: usize) -> Numbers<'_, T, M> {
        Numbers {
            list: of_length(&self[first..first + M]),
            first,
        }
    }
}
