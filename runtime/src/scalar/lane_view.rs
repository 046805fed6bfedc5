//! One lane of a value that consists of scalars, read in place.
//! Takes a value over lanes and the number of a lane; gives the value over plain numbers.
//!
//! Loops over the lanes with the arithmetic of plain numbers vectorise best: even if they are long, they compile fast
//! and fill the registers of each instruction set.

use super::Real;
use nalgebra::{ArrayStorage, SMatrix};
use num_traits::Zero;

/// A value that consists of scalars and can be read lane by lane. The result equals the result of
/// [`lane`](super::lane), but only the used parts are copied, for loops of steps.
pub trait InLanes: Copy {
    /// This type over the scalar of one lane.
    type One: Copy;

    /// The value of a lane; the first lane if `lane` is out of range.
    fn in_lane(&self, lane: usize) -> Self::One;
}

impl<T: Real> InLanes for T {
    type One = <T as Real>::One;

    #[inline(always)]
    fn in_lane(&self, lane: usize) -> Self::One {
        self.one_of(lane)
    }
}

impl<T: Real> InLanes for core::marker::PhantomData<T> {
    type One = core::marker::PhantomData<T::One>;

    #[inline(always)]
    fn in_lane(&self, _: usize) -> Self::One {
        core::marker::PhantomData
    }
}

impl<T: Real, const K: usize> InLanes for [T; K] {
    type One = [T::One; K];

    #[inline(always)]
    fn in_lane(&self, lane: usize) -> Self::One {
        let mut all = [T::One::zero(); K];
        for (one, x) in all.iter_mut().zip(self) {
            *one = x.one_of(lane);
        }
        all
    }
}

impl<T: Real, const R: usize, const C: usize> InLanes for SMatrix<T, R, C> {
    type One = SMatrix<T::One, R, C>;

    #[inline(always)]
    fn in_lane(&self, lane: usize) -> Self::One {
        let mut all = [[T::One::zero(); R]; C];
        for (column, xs) in all.iter_mut().zip(&self.data.0) {
            *column = xs.in_lane(lane);
        }
        SMatrix::from_data(ArrayStorage(all))
    }
}

/// Implements [`InLanes`] for a type of the runtime, given its fields and the fields that all lanes share.
macro_rules! in_lanes {
    ($Type:ident { $($field:tt),+ $(; $($shared:ident),+)? }) => {
        impl<T: $crate::Real> $crate::scalar::InLanes for $Type<T> {
            type One = $Type<<T as $crate::Real>::One>;

            #[inline(always)]
            fn in_lane(&self, lane: usize) -> Self::One {
                $Type {
                    $($field: self.$field.in_lane(lane),)+
                    $($($shared: self.$shared,)+)?
                }
            }
        }
    };
}
pub(crate) use in_lanes;

/// Sets one lane of an array of scalars.
#[inline(always)]
pub(crate) fn set_all<T: Real, const K: usize>(all: &mut [T; K], lane: usize, ones: [T::One; K]) {
    for (x, one) in all.iter_mut().zip(ones) {
        x.set_lane(lane, one);
    }
}
