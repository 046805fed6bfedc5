//! Dual numbers of the oracle: a value and one exact directional derivative, with no step size to choose. A dual number of dual
//! numbers gives second derivatives; a dual number of pairs gives derivatives to 32 digits. The implementation is independent of
//! the runtime's dual numbers, so that a mistake in one cannot hide a mistake in the other.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A scalar that can evaluate an unreduced action.
pub trait Number:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// The value without its derivative.
    fn value(self) -> f64;
    /// The square root; the derivative is infinite at 0.
    fn sqrt(self) -> Self;
    /// The exponential.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The sine.
    fn sin(self) -> Self;
    /// The cosine.
    fn cos(self) -> Self;

    /// The hyperbolic sine.
    #[must_use]
    fn sinh(self) -> Self {
        (self.exp() - (-self).exp()) * Self::constant(0.5)
    }

    /// The hyperbolic cosine.
    #[must_use]
    fn cosh(self) -> Self {
        (self.exp() + (-self).exp()) * Self::constant(0.5)
    }

    /// The sign, with zero derivative.
    #[must_use]
    fn sign(self) -> Self {
        Self::constant(if self.value() == 0.0 {
            0.0
        } else {
            self.value().signum()
        })
    }

    /// A rational power of a positive number.
    #[must_use]
    fn fraction(self, numerator: i32, denominator: i32) -> Self {
        // A quotient of two constants, because one third is not exact in double precision.
        let exponent =
            Self::constant(f64::from(numerator)) / Self::constant(f64::from(denominator));
        (self.ln() * exponent).exp()
    }

    /// An integer power by repeated multiplication; a negative exponent inverts the result.
    #[must_use]
    fn power(self, exponent: i32) -> Self {
        let mut result = Self::constant(1.0);
        for _ in 0..exponent.unsigned_abs() {
            result = result * self;
        }
        if exponent < 0 {
            Self::constant(1.0) / result
        } else {
            result
        }
    }
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn exp(self) -> Self {
        f64::exp(self)
    }
    fn ln(self) -> Self {
        f64::ln(self)
    }
    fn sin(self) -> Self {
        f64::sin(self)
    }
    fn cos(self) -> Self {
        f64::cos(self)
    }
}

/// `value + slope ε` with `ε² = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T = f64> {
    /// The value.
    pub value: T,
    /// The derivative along the chosen direction.
    pub slope: T,
}

impl<T: Number> Dual<T> {
    fn chain(self, value: T, derivative: T) -> Self {
        Self {
            value,
            slope: derivative * self.slope,
        }
    }
}

impl<T: Number> Number for Dual<T> {
    fn constant(value: f64) -> Self {
        Self {
            value: T::constant(value),
            slope: T::constant(0.0),
        }
    }
    fn value(self) -> f64 {
        self.value.value()
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::constant(0.5) / root)
    }
    fn exp(self) -> Self {
        let exponential = self.value.exp();
        self.chain(exponential, exponential)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), T::constant(1.0) / self.value)
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }
}

impl<T: Number> Mul for Dual<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl<T: Number> Div for Dual<T> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl<T: Number> Neg for Dual<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}
