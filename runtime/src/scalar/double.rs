//! [`Real`] for `f64`, the scalar of ordinary runs.
//! Takes and gives plain doubles; every function is the standard library's.

use super::Real;

impl Real for f64 {
    type One = Self;
    const EPSILON: f64 = f64::EPSILON / 2.0;

    #[inline(always)]
    fn one_of(&self, _: usize) -> Self {
        *self
    }

    #[inline(always)]
    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn magnitude(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn least(self) -> f64 {
        self
    }

    #[inline(always)]
    fn greatest(self) -> f64 {
        self
    }

    #[inline(always)]
    fn where_positive(self, then: Self) -> Self {
        if self > 0.0 { then } else { 0.0 }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline]
    fn exp(self) -> Self {
        f64::exp(self)
    }

    #[inline]
    fn ln(self) -> Self {
        f64::ln(self)
    }

    #[inline]
    fn sin(self) -> Self {
        f64::sin(self)
    }

    #[inline]
    fn cos(self) -> Self {
        f64::cos(self)
    }

    #[inline]
    fn sinh(self) -> Self {
        f64::sinh(self)
    }

    #[inline]
    fn cosh(self) -> Self {
        f64::cosh(self)
    }

    #[inline]
    fn tanh(self) -> Self {
        f64::tanh(self)
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}
