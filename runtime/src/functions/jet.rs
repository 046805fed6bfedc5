//! A number with its derivatives with respect to three others.
//! Takes numbers; gives sums, products, quotients and roots of them.

use crate::Real;
use core::ops::{Add, Div, Mul, Sub};

/// A value and its three derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<T> {
    pub value: T,
    pub along: [T; 3],
}

impl<T: Real> Jet<T> {
    /// A constant.
    pub fn constant(value: T) -> Self {
        Self {
            value,
            along: [T::zero(); 3],
        }
    }

    /// The variable with this number.
    pub fn variable(value: T, which: usize) -> Self {
        Self {
            value,
            along: core::array::from_fn(|i| if i == which { T::one() } else { T::zero() }),
        }
    }

    /// This many times it.
    pub fn times(self, factor: f64) -> Self {
        self.by(T::from_f64(factor))
    }

    fn by(self, factor: T) -> Self {
        Self {
            value: self.value * factor,
            along: self.along.map(|x| x * factor),
        }
    }

    /// The square root.
    pub fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        let factor = T::from_f64(0.5) / value;
        Self {
            value,
            along: self.along.map(|x| x * factor),
        }
    }

    fn product(self, other: Self) -> Self {
        let (x, y) = (self.value, other.value);
        self.with(other, x * y, |a, b| a * y + x * b)
    }

    fn quotient(self, other: Self) -> Self {
        let (one, y) = (T::one(), other.value);
        let value = self.value / y;
        self.with(other, value, |a, b| (a - value * b) * (one / y))
    }

    fn with(self, other: Self, value: T, each: impl Fn(T, T) -> T) -> Self {
        let (a, b) = (self.along, other.along);
        Self {
            value,
            along: [each(a[0], b[0]), each(a[1], b[1]), each(a[2], b[2])],
        }
    }
}

impl<T: Real> Add for Jet<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.with(other, self.value + other.value, |a, b| a + b)
    }
}

impl<T: Real> Sub for Jet<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.with(other, self.value - other.value, |a, b| a - b)
    }
}

impl<T: Real> Mul for Jet<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<T: Real> Div for Jet<T> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}
