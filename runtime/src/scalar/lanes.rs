//! Several independent runs side by side, one per lane, for ensembles.
//! Takes `[f64; N]`; gives a scalar whose operators act lane by lane and vectorise.

use super::Real;
use core::array::from_fn;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// `N` numbers advanced together; lane `i` is the `i`-th member of the ensemble.
///
/// Every operation rounds each lane as `f64` does. `N` of 4 or 8 fills the vector registers of
/// current processors. Since the alignment is 64 bytes, one instruction loads a lane group.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> PartialEq for Lanes<N> {
    /// Tests all lanes without a branch for each.
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        let pairs = self.0.iter().zip(&other.0);
        pairs.fold(true, |all, (x, y)| all & (x == y))
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for x in &mut self.0 {
            *x = f(*x);
        }
        self
    }

    /// Folds the lanes with `pick`, NaN winning over everything; without branches, to vectorise.
    #[inline(always)]
    fn reduce(self, start: f64, pick: impl Fn(f64, f64) -> bool) -> f64 {
        let mut best = start;
        let mut poisoned = false;
        for x in self.0 {
            best = if pick(x, best) { x } else { best };
            poisoned |= x.is_nan();
        }
        if poisoned { f64::NAN } else { best }
    }
}

macro_rules! lanewise {
    ($Op:ident, $op:ident, $Assign:ident, $assign:ident) => {
        impl<const N: usize> $Op for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $op(mut self, other: Self) -> Self {
                self.$assign(other);
                self
            }
        }
        impl<const N: usize> $Assign for Lanes<N> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                for (a, b) in self.0.iter_mut().zip(&other.0) {
                    a.$assign(*b);
                }
            }
        }
    };
}

lanewise!(Add, add, AddAssign, add_assign);
lanewise!(Sub, sub, SubAssign, sub_assign);
lanewise!(Mul, mul, MulAssign, mul_assign);
lanewise!(Div, div, DivAssign, div_assign);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for x in &mut self.0 {
            *x = -*x;
        }
        self
    }
}

impl<const N: usize> Zero for Lanes<N> {
    #[inline(always)]
    fn zero() -> Self {
        Self([0.0; N])
    }

    fn is_zero(&self) -> bool {
        self.0.iter().all(|x| *x == 0.0)
    }
}

impl<const N: usize> One for Lanes<N> {
    #[inline(always)]
    fn one() -> Self {
        Self([1.0; N])
    }
}

impl<const N: usize> Real for Lanes<N> {
    type One = f64;

    const EPSILON: f64 = <f64 as Real>::EPSILON;
    const LANES: usize = N;

    #[inline(always)]
    fn one_of(&self, lane: usize) -> f64 {
        self.0
            .get(lane)
            .or(self.0.first())
            .copied()
            .unwrap_or(f64::NAN)
    }

    #[inline(always)]
    fn set_lane(&mut self, lane: usize, one: f64) {
        if let Some(x) = self.0.get_mut(lane) {
            *x = one;
        }
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.0.first().copied().unwrap_or(f64::NAN)
    }

    #[inline]
    fn lane(self, index: usize) -> f64 {
        self.0.get(index).copied().unwrap_or(f64::NAN)
    }

    #[inline(always)]
    fn magnitude(self) -> f64 {
        self.map(f64::abs).reduce(0.0, |x, best| x > best)
    }

    #[inline(always)]
    fn least(self) -> f64 {
        self.reduce(f64::INFINITY, |x, best| x < best)
    }

    #[inline(always)]
    fn greatest(self) -> f64 {
        self.reduce(f64::NEG_INFINITY, |x, best| x > best)
    }

    #[inline(always)]
    fn where_positive(self, then: Self) -> Self {
        let mut kept = then;
        for (k, x) in kept.0.iter_mut().zip(&self.0) {
            *k = if *x > 0.0 { *k } else { 0.0 };
        }
        kept
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for x in &mut self.0 {
            *x = x.sqrt();
        }
        self
    }

    #[inline]
    fn exp(self) -> Self {
        self.map(f64::exp)
    }

    #[inline]
    fn ln(self) -> Self {
        self.map(f64::ln)
    }

    #[inline]
    fn sin(self) -> Self {
        self.map(f64::sin)
    }

    #[inline]
    fn cos(self) -> Self {
        self.map(f64::cos)
    }

    #[inline]
    fn sinh(self) -> Self {
        self.map(f64::sinh)
    }

    #[inline]
    fn cosh(self) -> Self {
        self.map(f64::cosh)
    }

    #[inline]
    fn tanh(self) -> Self {
        self.map(f64::tanh)
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.iter().fold(true, |all, x| all & x.is_finite())
    }

    #[inline(always)]
    fn nowhere_positive(self) -> bool {
        self.0.iter().fold(true, |all, x| all & (*x <= 0.0))
    }
}

impl<const N: usize> From<[f64; N]> for Lanes<N> {
    fn from(lanes: [f64; N]) -> Self {
        Self(lanes)
    }
}

impl<const N: usize> FromIterator<f64> for Lanes<N> {
    /// The first `N` items; missing ones are zero.
    fn from_iter<I: IntoIterator<Item = f64>>(items: I) -> Self {
        let mut items = items.into_iter();
        Self(from_fn(|_| items.next().unwrap_or(0.0)))
    }
}
