//! Parts of lists that loops over sites fill, either site by site or several sites at once.

use super::columns::{ColumnsPart, Numbered, of_length};
use crate::Real;
use core::marker::PhantomData;
use nalgebra::SMatrix;

/// The number of sites computed together: two registers of the widest instruction set.
pub const LANES: usize = 16;

/// A range of sites of a list, to be filled.
pub trait Part: Sized + Send {
    /// The value of a site.
    type One: Copy + Send;

    /// The number of sites.
    fn count(&self) -> usize;

    /// Splits into the sites before `at` and the remaining sites.
    fn split(self, at: usize) -> (Self, Self);

    /// The value at a site.
    fn get(&self, site: usize) -> Self::One;

    /// Sets the value at a site.
    fn put(&mut self, site: usize, value: Self::One);
}

/// A range of sites that can be filled several at a time.
pub trait InColumns: Part {
    /// The values of [`LANES`] sites, in one column for each number.
    type Lanes;

    /// All numbers zero.
    fn zeros() -> Self::Lanes;

    /// The value in one lane.
    fn lane(lanes: &Self::Lanes, lane: usize) -> Self::One;

    /// Sets the value in one lane.
    fn put_lane(lanes: &mut Self::Lanes, lane: usize, value: Self::One);

    /// Reads the values of [`LANES`] sites that start at `first`.
    fn read(&self, first: usize) -> Self::Lanes;

    /// Writes the values of [`LANES`] sites that start at `first`.
    fn write(&mut self, first: usize, lanes: &Self::Lanes);
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize> Part for ColumnsPart<'_, V, T, N> {
    type One = V;

    #[inline(always)]
    fn count(&self) -> usize {
        self.columns.first().map_or(0, |c| c.len())
    }

    fn split(self, at: usize) -> (Self, Self) {
        let mut behind = [const { None }; N];
        let mut k = 0;
        let before = self.columns.map(|column| {
            let (before, rest) = column.split_at_mut(at);
            behind[k] = Some(rest);
            k += 1;
            before
        });
        let behind = behind.map(Option::unwrap_or_default);
        let part = |columns| Self {
            columns,
            of: PhantomData,
        };
        (part(before), part(behind))
    }

    #[inline(always)]
    fn get(&self, site: usize) -> V {
        let mut numbers = [T::zero(); N];
        for (number, column) in numbers.iter_mut().zip(&self.columns) {
            *number = column[site];
        }
        V::of(numbers)
    }

    #[inline(always)]
    fn put(&mut self, site: usize, value: V) {
        for (column, number) in self.columns.iter_mut().zip(value.numbers()) {
            column[site] = number;
        }
    }
}

impl<V: Numbered<N, Number = T>, T: Real, const N: usize> InColumns for ColumnsPart<'_, V, T, N> {
    type Lanes = [[T; LANES]; N];

    #[inline(always)]
    fn zeros() -> Self::Lanes {
        [[T::zero(); LANES]; N]
    }

    #[inline(always)]
    fn lane(lanes: &Self::Lanes, lane: usize) -> V {
        let mut numbers = [T::zero(); N];
        for (number, column) in numbers.iter_mut().zip(lanes) {
            *number = column[lane];
        }
        V::of(numbers)
    }

    #[inline(always)]
    fn put_lane(lanes: &mut Self::Lanes, lane: usize, value: V) {
        for (column, number) in lanes.iter_mut().zip(value.numbers()) {
            column[lane] = number;
        }
    }

    #[inline(always)]
    fn read(&self, first: usize) -> Self::Lanes {
        let mut lanes = Self::zeros();
        for (lanes, column) in lanes.iter_mut().zip(&self.columns) {
            *lanes = *of_length(&column[first..first + LANES]);
        }
        lanes
    }

    #[inline(always)]
    fn write(&mut self, first: usize, lanes: &Self::Lanes) {
        for (column, lanes) in self.columns.iter_mut().zip(lanes) {
            column[first..first + LANES].copy_from_slice(lanes);
        }
    }
}

/// A list that stores values one after another.
impl<V: Copy + Send> Part for &mut [V] {
    type One = V;

    #[inline(always)]
    fn count(&self) -> usize {
        self.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }

    #[inline(always)]
    fn get(&self, site: usize) -> V {
        self[site]
    }

    #[inline(always)]
    fn put(&mut self, site: usize, value: V) {
        self[site] = value;
    }
}

impl<T: Real, const R: usize, const C: usize> InColumns for &mut [SMatrix<T, R, C>] {
    type Lanes = [[[T; LANES]; R]; C];

    #[inline(always)]
    fn zeros() -> Self::Lanes {
        [[[T::zero(); LANES]; R]; C]
    }

    #[inline(always)]
    fn lane(lanes: &Self::Lanes, lane: usize) -> SMatrix<T, R, C> {
        let mut value = SMatrix::zeros();
        for (own, column) in value.data.0.iter_mut().zip(lanes) {
            for (own, numbers) in own.iter_mut().zip(column) {
                *own = numbers[lane];
            }
        }
        value
    }

    #[inline(always)]
    fn put_lane(lanes: &mut Self::Lanes, lane: usize, value: SMatrix<T, R, C>) {
        for (own, column) in value.data.0.iter().zip(lanes) {
            for (own, numbers) in own.iter().zip(column) {
                numbers[lane] = *own;
            }
        }
    }

    #[inline(always)]
    fn read(&self, first: usize) -> Self::Lanes {
        let mut lanes = Self::zeros();
        for (lane, value) in self[first..first + LANES].iter().enumerate() {
            Self::put_lane(&mut lanes, lane, *value);
        }
        lanes
    }

    #[inline(always)]
    fn write(&mut self, first: usize, lanes: &Self::Lanes) {
        for (lane, value) in self[first..first + LANES].iter_mut().enumerate() {
            *value = Self::lane(lanes, lane);
        }
    }
}
