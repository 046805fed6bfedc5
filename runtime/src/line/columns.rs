//! Lists that store each number of a site's value in a separate column, so that loops can read and write several sites
//! at a time. Takes values; gives single values, or a part of the list to be filled.

use super::Attitude;
use crate::saved::{Saved, Sites, Words};
use crate::{Real, Rotation};
use core::marker::PhantomData;
use core::ops::Range;
use nalgebra::{SMatrix, Vector3};

/// A value that consists of `N` numbers.
pub trait Numbered<const N: usize>: Copy + Send + Sync {
    /// The scalar type.
    type Number: Real;

    /// The numbers of the value.
    fn numbers(&self) -> [Self::Number; N];

    /// The value with these numbers.
    fn of(numbers: [Self::Number; N]) -> Self;
}

/// A list with a value of `N` numbers for each site.
#[derive(Clone, Debug)]
pub struct Columns<V, T, const N: usize> {
    /// The columns, one after another.
    data: Vec<T>,
    /// The distance between the starts of consecutive columns.
    stride: usize,
    len: usize,
    of: PhantomData<V>,
}

/// The attitudes of all sites.
pub type Attitudes<T> = Columns<Attitude<T>, T, 4>;

/// For each site, the spatial momentum of the edge that leaves it.
pub type Edges<T> = Columns<Vector3<T>, T, 3>;

/// From this length on, columns start at different offsets within a memory page. Otherwise a processor that compares
/// only these offsets mistakes a write to one column for a read from another.
const PAGE: usize = 512;

/// The difference of the page offsets of consecutive columns.
const SHIFT: usize = 40;

fn stride_of(len: usize) -> usize {
    match len < PAGE {
        true => len,
        false => (len - SHIFT).next_multiple_of(PAGE) + SHIFT,
    }
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize> Columns<V, T, N> {
    /// A list of `len` copies of `value`.
    pub fn filled(value: V, len: usize) -> Self {
        let stride = stride_of(len);
        let mut data = Vec::with_capacity(N * stride);
        for number in value.numbers() {
            data.extend(core::iter::repeat_n(number, stride));
        }
        Self {
            data,
            stride,
            len,
            of: PhantomData,
        }
    }

    /// The number of sites.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The value at a site.
    ///
    /// # Panics
    /// If `site` is out of range.
    #[inline(always)]
    pub fn at(&self, site: usize) -> V {
        assert!(site < self.len, "site {site} of {}", self.len);
        let mut numbers = [T::zero(); N];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number = self.data[k * self.stride + site];
        }
        V::of(numbers)
    }

    /// Sets the value at a site.
    ///
    /// # Panics
    /// If `site` is out of range.
    #[inline(always)]
    pub fn set(&mut self, site: usize, value: V) {
        assert!(site < self.len, "site {site} of {}", self.len);
        for (k, number) in value.numbers().into_iter().enumerate() {
            self.data[k * self.stride + site] = number;
        }
    }

    /// All values.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = V> + '_ {
        (0..self.len).map(|site| self.at(site))
    }

    /// Changes the number of sites: keeps the first sites, and appends copies of a value.
    pub fn resize(&mut self, len: usize, value: V) {
        let mut other = Self::filled(value, len);
        other.keep(0..self.len.min(len), self);
        *self = other;
    }

    /// Copies the values of some sites from another list.
    pub fn keep(&mut self, sites: Range<usize>, from: &Self) {
        for k in 0..N {
            let (own, other) = (k * self.stride, k * from.stride);
            self.data[own + sites.start..own + sites.end]
                .copy_from_slice(&from.data[other + sites.start..other + sites.end]);
        }
    }

    /// All columns, from site `first`, `M` sites long.
    #[inline(always)]
    pub(super) fn columns<const M: usize>(&self, first: usize) -> [&[T; M]; N] {
        // A loop: `map` of an array is not always inlined.
        let mut all = [self.column(0, first); N];
        for (k, column) in all.iter_mut().enumerate() {
            *column = self.column(k, first);
        }
        all
    }

    #[inline(always)]
    fn column<const M: usize>(&self, k: usize, first: usize) -> &[T; M] {
        of_length(&self.data[k * self.stride..][..self.len][first..first + M])
    }

    /// A writable part of the list.
    pub fn part(&mut self, sites: Range<usize>) -> ColumnsPart<'_, V, T, N> {
        assert!(sites.end <= self.len, "sites {sites:?} of {}", self.len);
        let mut rest = self.data.as_mut_slice();
        let columns = core::array::from_fn(|_| {
            let (own, others) = core::mem::take(&mut rest).split_at_mut(self.stride);
            rest = others;
            &mut own[sites.clone()]
        });
        ColumnsPart {
            columns,
            of: PhantomData,
        }
    }
}

/// Reduces the list to one value if all sites have the same value.
pub fn once<V: PartialEq>(list: &mut Vec<V>) {
    if list.windows(2).all(|two| two[0] == two[1]) {
        list.truncate(1);
    }
}

/// A slice of known length as an array.
#[inline(always)]
pub(super) fn of_length<T, const M: usize>(list: &[T]) -> &[T; M] {
    match list.try_into() {
        Ok(array) => array,
        Err(_) => unreachable!("a slice of that length"),
    }
}

/// Some sites of a list, open for writing.
pub struct ColumnsPart<'a, V, T, const N: usize> {
    pub(super) columns: [&'a mut [T]; N],
    pub(super) of: PhantomData<V>,
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize> ColumnsPart<'_, V, T, N> {
    /// Sets the value at all sites to `value`.
    pub fn fill(mut self, value: V) {
        for (column, number) in self.columns.iter_mut().zip(value.numbers()) {
            column.fill(number);
        }
    }
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize> FromIterator<V> for Columns<V, T, N> {
    fn from_iter<I: IntoIterator<Item = V>>(values: I) -> Self {
        let values: Vec<V> = values.into_iter().collect();
        let Some(first) = values.first() else {
            return Self {
                data: Vec::new(),
                stride: 0,
                len: 0,
                of: PhantomData,
            };
        };
        let mut out = Self::filled(*first, values.len());
        for (site, value) in values.into_iter().enumerate() {
            out.set(site, value);
        }
        out
    }
}

impl<V, T: PartialEq, const N: usize> PartialEq for Columns<V, T, N> {
    fn eq(&self, other: &Self) -> bool {
        let is_same = |k: usize| {
            let [own, others] = [self, other].map(|x| &x.data[k * x.stride..k * x.stride + x.len]);
            own == others
        };
        self.len == other.len && (0..N).all(is_same)
    }
}

/// Saves values site by site, as a plain list of values does.
impl<V: Numbered<N, Number = f64> + Saved, const N: usize> Sites for Columns<V, f64, N> {
    fn sites(&mut self, words: &mut Words) {
        words.same(self.len as u64);
        for site in 0..self.len {
            let mut value = self.at(site);
            value.words(words);
            self.set(site, value);
        }
    }
}

impl<T: Real> Numbered<4> for Attitude<T> {
    type Number = T;

    #[inline(always)]
    fn numbers(&self) -> [T; 4] {
        self.rotation().quaternion()
    }

    #[inline(always)]
    fn of(numbers: [T; 4]) -> Self {
        Self::new(Rotation::from_unit(numbers))
    }
}

impl<T: Real> Numbered<3> for Vector3<T> {
    type Number = T;

    #[inline(always)]
    fn numbers(&self) -> [T; 3] {
        let [numbers] = self.data.0;
        numbers
    }

    #[inline(always)]
    fn of(numbers: [T; 3]) -> Self {
        numbers.into()
    }
}

/// Implements [`Numbered`] for a struct of matrices; each field is listed with its number of entries.
#[doc(hidden)]
#[macro_export]
macro_rules! numbered {
    ($name:ident { $($field:ident: $count:expr),* $(,)? }) => {
        impl<T: $crate::Real> $crate::line::Numbered<{ 0 $(+ $count)* }> for $name<T> {
            type Number = T;

            #[inline(always)]
            fn numbers(&self) -> [T; 0 $(+ $count)*] {
                let mut out = [<T as $crate::num_traits::Zero>::zero(); 0 $(+ $count)*];
                let mut at = 0;
                $(
                    for (k, own) in self.$field.as_slice().iter().enumerate() {
                        out[at + k] = *own;
                    }
                    at += $count;
                )*
                let _ = at;
                out
            }

            #[inline(always)]
            fn of(numbers: [T; 0 $(+ $count)*]) -> Self {
                let mut at = 0;
                $(
                    let $field = $crate::line::array_from(&numbers, at);
                    at += $count;
                )*
                let _ = at;
                Self { $($field),* }
            }
        }
    };
}

/// The matrix stored from index `at` on, in column-major order.
#[doc(hidden)]
#[inline(always)]
pub fn array_from<T: Real, const R: usize, const C: usize>(
    numbers: &[T],
    at: usize,
) -> SMatrix<T, R, C> {
    let mut out = SMatrix::<T, R, C>::zeros();
    for (k, number) in out.as_mut_slice().iter_mut().enumerate() {
        *number = numbers[at + k];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Columns, Edges, once};
    use crate::line::Part;
    use nalgebra::Vector3;

    fn edge(i: usize) -> Vector3<f64> {
        let x = i as f64;
        Vector3::new(x, x + 0.1, 1.0 - 2.0 * x)
    }

    #[test]
    fn a_list_in_columns_is_the_list_of_its_values() {
        for count in [1, 5, 511, 512, 513, 2000] {
            let mut list: Edges<f64> = (0..count).map(edge).collect();
            assert_eq!(list.len(), count);
            assert!(list.iter().eq((0..count).map(edge)));
            list.resize(count + 3, edge(7));
            assert!(list.iter().eq((0..count).chain([7; 3]).map(edge)));
            let mut other = Columns::filled(edge(0), count + 3);
            assert_ne!(other, list);
            other.keep(0..count + 3, &list);
            assert_eq!(other, list);
            let (mut before, mut behind) = other.part(0..count).split(count / 2);
            assert_eq!(before.count() + behind.count(), count);
            if count > 1 {
                before.put(0, edge(90));
            }
            behind.put(0, edge(91));
            assert_eq!(behind.get(0), edge(91));
            assert_eq!(other.at(count / 2), edge(91));
        }
    }

    #[test]
    fn what_is_the_same_everywhere_is_kept_once() {
        let (mut same, mut other) = (vec![2.0; 5], vec![2.0, 2.0, 3.0]);
        once(&mut same);
        once(&mut other);
        assert_eq!((same.len(), other.len()), (1, 3));
    }
}
