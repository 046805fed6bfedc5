//! Forward derivatives: a value with its first derivatives with respect to `N` seeds.
//! Takes values and seeds; gives numbers whose operators follow the chain rule exactly.

use super::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// `real` and its partial derivatives with respect to `N` independent variables.
///
/// A step run on dual numbers gives its exact Jacobian: seed variable `i` with
/// [`Dual::variable`], read column `i` from `dual`.
///
/// ```
/// use clebsch::{Dual, Real};
///
/// let x = Dual::<2>::variable(3.0, 0);
/// let y = Dual::<2>::variable(4.0, 1);
/// let z = x * y - x.powi(3);
/// assert_eq!((z.real, z.dual), (-15.0, [4.0 - 27.0, 3.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub real: f64,
    /// The derivative with respect to each variable.
    pub dual: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A constant: all derivatives are zero.
    #[inline]
    pub const fn constant(real: f64) -> Self {
        Self {
            real,
            dual: [0.0; N],
        }
    }

    /// The independent variable of index `index` at `real`; a constant when `index >= N`.
    #[inline]
    pub fn variable(real: f64, index: usize) -> Self {
        let mut dual = [0.0; N];
        if let Some(seed) = dual.get_mut(index) {
            *seed = 1.0;
        }
        Self { real, dual }
    }

    /// A function with value `real` and derivative `slope` at `self.real`.
    #[inline(always)]
    fn chain(self, real: f64, slope: f64) -> Self {
        let mut dual = self.dual;
        match N > IN_PLACE {
            true => scale(&mut dual, slope),
            false => dual.iter_mut().for_each(|d| *d *= slope),
        }
        Self { real, dual }
    }

    /// `alpha * a.dual + beta * b.dual` with the value `real`.
    #[inline(always)]
    fn combine(real: f64, a: Self, alpha: f64, b: Self, beta: f64) -> Self {
        let mut dual = a.dual;
        if N > IN_PLACE {
            mix(&mut dual, alpha, &b.dual, beta);
            return Self { real, dual };
        }
        for (x, y) in dual.iter_mut().zip(b.dual) {
            *x = *x * alpha + y * beta;
        }
        Self { real, dual }
    }
}

/// With more derivatives than this, an operation calls a function. In place, its loop would be compiled again for every operation
/// of a model, which takes minutes.
const IN_PLACE: usize = 8;

/// `a * slope`.
#[inline(never)]
fn scale(a: &mut [f64], slope: f64) {
    a.iter_mut().for_each(|x| *x *= slope);
}

/// `alpha * a + beta * b`.
#[inline(never)]
fn mix(a: &mut [f64], alpha: f64, b: &[f64], beta: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        *x = *x * alpha + y * beta;
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::combine(self.real + other.real, self, 1.0, other, 1.0)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::combine(self.real - other.real, self, 1.0, other, -1.0)
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::combine(self.real * other.real, self, other.real, other, self.real)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.real;
        let real = self.real / other.real;
        Self::combine(real, self, inverse, other, -real * inverse)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.real, -1.0)
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> MulAssign for Dual<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const N: usize> DivAssign for Dual<N> {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<const N: usize> Zero for Dual<N> {
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    fn is_zero(&self) -> bool {
        self.real == 0.0 && self.dual.iter().all(|d| *d == 0.0)
    }
}

impl<const N: usize> One for Dual<N> {
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
}

impl<const N: usize> Real for Dual<N> {
    type One = Self;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    #[inline(always)]
    fn order() -> u32 {
        1
    }

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
        Self::constant(x)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.real
    }

    #[inline(always)]
    fn magnitude(self) -> f64 {
        let mut largest = self.real.abs();
        for d in self.dual {
            // Not `f64::max`, which would drop a NaN.
            if d.is_nan() {
                return f64::NAN;
            }
            if d.abs() > largest {
                largest = d.abs();
            }
        }
        largest
    }

    #[inline(always)]
    fn least(self) -> f64 {
        self.real
    }

    #[inline(always)]
    fn greatest(self) -> f64 {
        self.real
    }

    #[inline(always)]
    fn where_positive(self, then: Self) -> Self {
        if self.real > 0.0 { then } else { Self::zero() }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.real.sqrt();
        if root == 0.0 {
            // If the argument is zero with derivative zero, so is the derivative of the root; else it is infinite or
            // NaN.
            let dual = self.dual.map(|d| if d == 0.0 { 0.0 } else { d / root });
            return Self { real: root, dual };
        }
        self.chain(root, 0.5 / root)
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.real.exp();
        self.chain(value, value)
    }

    #[inline]
    fn ln(self) -> Self {
        self.chain(self.real.ln(), 1.0 / self.real)
    }

    #[inline]
    fn sin(self) -> Self {
        let (sin, cos) = self.real.sin_cos();
        self.chain(sin, cos)
    }

    #[inline]
    fn cos(self) -> Self {
        let (sin, cos) = self.real.sin_cos();
        self.chain(cos, -sin)
    }

    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.real.sinh(), self.real.cosh())
    }

    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.real.cosh(), self.real.sinh())
    }

    #[inline]
    fn tanh(self) -> Self {
        let value = self.real.tanh();
        self.chain(value, 1.0 - value * value)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.real.is_finite() && self.dual.iter().all(|d| d.is_finite())
    }
}
