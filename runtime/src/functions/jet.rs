//! A number with its derivatives with respect to several others.
//! Takes numbers; gives sums, products, quotients and roots of them.

use crate::Real;
use core::ops::{Add, Div, Mul, Sub};

/// A value and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<T, const N: usize> {
    pub value: T,
    pub along: [T; N],
}

impl<T: Real, const N: usize> Jet<T, N> {
    /// A constant.
    pub fn constant(value: T) -> Self {
        Self {
            value,
            along: [T::zero(); N],
        }
    }

    /// The variable with the index `which`, or a constant if `which` is `None`.
    pub fn variable(value: T, which: Option<usize>) -> Self {
        Self {
            value,
            along: core::array::from_fn(|i| match which == Some(i) {
                true => T::one(),
                false => T::zero(),
            }),
        }
    }

    /// Multiplies by a number.
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
            along: core::array::from_fn(|i| each(a[i], b[i])),
        }
    }
}

impl<T: Real, const N: usize> Add for Jet<T, N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.with(other, self.value + other.value, |a, b| a + b)
    }
}

impl<T: Real, const N: usize> Sub for Jet<T, N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.with(other, self.value - other.value, |a, b| a - b)
    }
}

impl<T: Real, const N: usize> Mul for Jet<T, N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<T: Real, const N: usize> Div for Jet<T, N> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}
