//! Numbers with a bound on their rounding error. Takes numbers, exact or rounded once; gives the running error bound
//! of everything computed from them (Wilkinson).

use super::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// The relative error of one rounded operation.
const UNIT: f64 = f64::EPSILON / 2.0;

/// A number and a bound on its rounding error. If a bound does not exist, as for a quotient whose divisor may
/// vanish, it is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    value: f64,
    error: f64,
}

impl Rounded {
    /// One number.
    #[inline]
    #[must_use]
    pub const fn exactly(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A number that was rounded once.
    #[inline]
    #[must_use]
    pub const fn once(value: f64) -> Self {
        Self {
            value,
            error: UNIT * value.abs(),
        }
    }

    /// The bound on its rounding error.
    #[inline]
    #[must_use]
    pub const fn error(&self) -> f64 {
        self.error
    }

    /// Whether it is exactly zero.
    #[inline(always)]
    fn is_nothing(&self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }

    /// Whether it has bounds.
    #[inline(always)]
    fn is_bounded(&self) -> bool {
        (self.value.abs() + self.error).is_finite()
    }

    /// The bounds.
    #[inline(always)]
    fn ends(&self) -> [f64; 2] {
        [self.value - self.error, self.value + self.error]
    }

    const fn unknown() -> Self {
        Self {
            value: f64::NAN,
            error: f64::NAN,
        }
    }

    /// A function of the number, given its value and slope there and a bound of its second derivative within the
    /// error bounds; `steps` counts its roundings.
    #[inline]
    fn through(self, value: f64, slope: f64, bend: f64, steps: f64) -> Self {
        Self {
            value,
            error: self.error * slope.abs()
                + bend * (0.5 * self.error) * self.error
                + steps * UNIT * value.abs(),
        }
    }
}

impl Add for Rounded {
    type Output = Self;
    #[inline]
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        self.error += other.error + UNIT * self.value.abs();
        self
    }
}

impl Neg for Rounded {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            error: self.error,
        }
    }
}

impl Sub for Rounded {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Rounded {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        // Entries of basis matrices and of identities.
        if self.is_nothing() && other.is_bounded() {
            return self;
        }
        if other.is_nothing() && self.is_bounded() {
            return other;
        }
        let (a, b) = (self.value.abs(), other.value.abs());
        Self {
            value: self.value * other.value,
            error: a * other.error + b * self.error + self.error * other.error + UNIT * a * b,
        }
    }
}

impl Div for Rounded {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let [low, high] = other.ends();
        let nearest = if low > 0.0 { low } else { -high };
        // False for NaN.
        let positive = nearest > 0.0;
        if !positive {
            return Self::unknown();
        }
        let value = 1.0 / other.value;
        let bend = 2.0 / (nearest * nearest * nearest);
        self * other.through(value, -value * value, bend, 1.0)
    }
}

macro_rules! assigned {
    ($($Trait:ident $function:ident $operator:tt),+) => {$(
        impl $Trait for Rounded {
            #[inline]
            fn $function(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}

assigned!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

impl Zero for Rounded {
    #[inline]
    fn zero() -> Self {
        Self::exactly(0.0)
    }

    #[inline]
    fn is_zero(&self) -> bool {
        *self == Self::exactly(0.0)
    }
}

impl One for Rounded {
    #[inline]
    fn one() -> Self {
        Self::exactly(1.0)
    }
}

impl Real for Rounded {
    type One = Self;
    const EPSILON: f64 = UNIT;

    /// Shortcuts of plain numbers are not taken.
    #[inline]
    fn order() -> u32 {
        1
    }

    #[inline]
    fn one_of(&self, _: usize) -> Self {
        *self
    }

    #[inline]
    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::exactly(x)
    }

    #[inline]
    fn value(self) -> f64 {
        self.value
    }

    fn magnitude(self) -> f64 {
        self.value.abs() + self.error
    }

    #[inline]
    fn least(self) -> f64 {
        let [low, _] = self.ends();
        low
    }

    #[inline]
    fn greatest(self) -> f64 {
        let [_, high] = self.ends();
        high
    }

    /// If the sign is unknown, the result covers both cases: the interval from 0 to `then`.
    fn where_positive(self, then: Self) -> Self {
        let [low, high] = self.ends();
        if low > 0.0 {
            return then;
        }
        if high <= 0.0 {
            return Self::zero();
        }
        let value = 0.5 * then.value;
        Self {
            value,
            error: 0.5 * then.error + UNIT * value.abs() + 0.5 * then.magnitude(),
        }
    }

    fn sqrt(self) -> Self {
        if self.is_zero() {
            return self;
        }
        let [low, _] = self.ends();
        let positive = low > 0.0;
        if !positive {
            return Self::unknown();
        }
        let root = self.value.sqrt();
        self.through(root, 0.5 / root, 0.25 / (low * low.sqrt()), 1.0)
    }

    fn exp(self) -> Self {
        let value = self.value.exp();
        let [_, high] = self.ends();
        self.through(value, value, high.exp(), 2.0)
    }

    fn ln(self) -> Self {
        let [low, _] = self.ends();
        let positive = low > 0.0;
        if !positive {
            return Self::unknown();
        }
        let bend = 1.0 / (low * low);
        self.through(self.value.ln(), 1.0 / self.value, bend, 2.0)
    }

    fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        // The bound contains the rounding of the argument; near a zero of the sine the value is small, but its error
        // is not.
        self.through(sin, cos, 1.0, 2.0)
    }

    fn cos(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.through(cos, -sin, 1.0, 2.0)
    }

    fn sinh(self) -> Self {
        let (value, slope) = (self.value.sinh(), self.value.cosh());
        self.through(value, slope, self.magnitude().sinh(), 2.0)
    }

    fn cosh(self) -> Self {
        let (value, slope) = (self.value.cosh(), self.value.sinh());
        self.through(value, slope, self.magnitude().cosh(), 2.0)
    }

    fn tanh(self) -> Self {
        let value = self.value.tanh();
        // The second derivative, -2 t (1 - t^2), is at most 4/sqrt(27).
        self.through(value, 1.0 - value * value, 0.77, 2.0)
    }

    /// Whether a bound exists.
    fn is_finite(self) -> bool {
        self.magnitude().is_finite()
    }
}

#[cfg(test)]
mod tests;
