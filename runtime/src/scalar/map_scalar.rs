//! Types that consist of scalars, over any scalar: parameters, states and their parts. Takes a value over one scalar
//! and a function of scalars; gives the value over another scalar: lanes collected from several bodies, or one body
//! extracted from the lanes.

use super::{Lanes, Real};
use core::array::from_fn;
use nalgebra::SMatrix;

/// A type in which only scalars differ between bodies.
///
/// The emitted parameters, initial data and states implement it, field by field.
pub trait OfScalars: Copy + core::fmt::Debug + Send + Sync {
    /// The type of its scalars.
    type Scalar: Real;

    /// This type over another scalar.
    type Over<U: Real>: OfScalars<Scalar = U, Over<Self::Scalar> = Self>;

    /// Replaces every scalar by its image, always in the same order. Nothing is checked: the result satisfies the
    /// conditions of its type (for example a unit quaternion) only if `change` preserves them.
    fn over<U: Real>(&self, change: &mut impl FnMut(Self::Scalar) -> U) -> Self::Over<U>;
}

impl<T: Real> OfScalars for core::marker::PhantomData<T> {
    type Scalar = T;
    type Over<U: Real> = core::marker::PhantomData<U>;

    fn over<U: Real>(&self, _: &mut impl FnMut(T) -> U) -> core::marker::PhantomData<U> {
        core::marker::PhantomData
    }
}

/// [`OfScalars`] for a struct of such fields over its last type parameter, after const parameters in
/// brackets; `at` names the number of a node, which is not changed. Emitted for the data of every model.
#[doc(hidden)]
#[macro_export]
macro_rules! of_scalars {
    ([$($size:ident)*] $name:ident { $($field:ident),* } $(at $node:ident)?) => {
        impl<$(const $size: usize,)* __T: $crate::Real> $crate::OfScalars for $name<$($size,)* __T> {
            type Scalar = __T;
            type Over<__U: $crate::Real> = $name<$($size,)* __U>;
            fn over<__U: $crate::Real>(
                &self,
                change: &mut impl FnMut(__T) -> __U,
            ) -> $name<$($size,)* __U> {
                $name { $($field: self.$field.over(change),)* $($node: self.$node,)? }
            }
        }

        impl<$(const $size: usize),*> $crate::saved::Saved for $name<$($size,)* f64> {
            fn words(&mut self, words: &mut $crate::saved::Words) {
                $($crate::saved::Saved::words(&mut self.$field, words);)*
                $($crate::saved::Saved::words(&mut self.$node, words);)?
            }
        }
    };
}

/// `N` bodies side by side: lane `i` is `body(i)`.
///
/// ```
/// use clebsch::Lanes;
/// use clebsch::nalgebra::Vector2;
/// use clebsch::scalar::{gather, lane};
///
/// let bodies = [Vector2::new(1.0, 2.0), Vector2::new(3.0, 4.0)];
/// let wide: Vector2<Lanes<2>> = gather(|i| bodies[i]);
/// assert_eq!(wide.x, Lanes([1.0, 3.0]));
/// assert_eq!(lane::<Vector2<f64>, 2>(&wide, 1), bodies[1]);
/// ```
pub fn gather<X, const N: usize>(body: impl Fn(usize) -> X) -> X::Over<Lanes<N>>
where
    X: OfScalars<Scalar = f64>,
{
    let lists: [Vec<f64>; N] = from_fn(|i| {
        let mut list = Vec::new();
        let _ = body(i).over(&mut |x: f64| {
            list.push(x);
            x
        });
        list
    });
    let mut place = 0;
    // Any body gives the positions of the scalars.
    body(0).over(&mut |_| {
        let at = |list: &Vec<f64>| list.get(place).copied().unwrap_or(f64::NAN);
        let lanes = Lanes(lists.each_ref().map(at));
        place += 1;
        lanes
    })
}

/// The body in one lane; all NaN if `index` is not a lane.
pub fn lane<X, const N: usize>(wide: &X::Over<Lanes<N>>, index: usize) -> X
where
    X: OfScalars<Scalar = f64>,
{
    wide.over(&mut |x: Lanes<N>| x.lane(index))
}

impl<T: Real> OfScalars for T {
    type Scalar = T;
    type Over<U: Real> = U;

    #[inline]
    fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> U {
        change(*self)
    }
}

impl<T: Real, const R: usize, const C: usize> OfScalars for SMatrix<T, R, C> {
    type Scalar = T;
    type Over<U: Real> = SMatrix<U, R, C>;

    #[inline]
    fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> SMatrix<U, R, C> {
        self.map(change)
    }
}

impl<T: Real, const K: usize> OfScalars for [T; K] {
    type Scalar = T;
    type Over<U: Real> = [U; K];

    #[inline]
    fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> [U; K] {
        self.map(change)
    }
}

/// Several values as nested pairs: `(a, (b, (c, [])))`.
impl<A: OfScalars, B: OfScalars<Scalar = A::Scalar>> OfScalars for (A, B) {
    type Scalar = A::Scalar;
    type Over<U: Real> = (A::Over<U>, B::Over<U>);

    #[inline]
    fn over<U: Real>(&self, change: &mut impl FnMut(A::Scalar) -> U) -> Self::Over<U> {
        (self.0.over(change), self.1.over(change))
    }
}

/// Implements [`OfScalars`] for a type of the runtime, given its fields.
macro_rules! of_scalars {
    // With fields of other types.
    ($Type:ident { $($field:tt),+ ; $($shared:ident),+ }) => {
        impl<T: $crate::Real> $crate::scalar::OfScalars for $Type<T> {
            type Scalar = T;
            type Over<U: $crate::Real> = $Type<U>;

            fn over<U: $crate::Real>(&self, change: &mut impl FnMut(T) -> U) -> $Type<U> {
                $Type {
                    $($field: $crate::scalar::OfScalars::over(&self.$field, change),)+
                    $($shared: self.$shared,)+
                }
            }
        }
    };
    ($Type:ident $(<$($N:ident),+>)? { $($field:tt),+ }) => {
        impl<$($(const $N: usize,)+)? T: $crate::Real> $crate::scalar::OfScalars for $Type<$($($N,)+)? T> {
            type Scalar = T;
            type Over<U: $crate::Real> = $Type<$($($N,)+)? U>;

            #[inline]
            fn over<U: $crate::Real>(
                &self,
                change: &mut impl FnMut(T) -> U,
            ) -> $Type<$($($N,)+)? U> {
                $Type { $($field: self.$field.over(change)),+ }
            }
        }

        impl $(<$(const $N: usize),+>)? $crate::saved::Saved for $Type<$($($N,)+)? f64> {
            fn words(&mut self, words: &mut $crate::saved::Words) {
                $($crate::saved::Saved::words(&mut self.$field, words);)+
            }
        }
    };
}
pub(crate) use of_scalars;
