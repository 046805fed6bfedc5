//! A number with its derivatives with respect to several others. The numbers may be jets themselves, for second
//! derivatives.
//! Takes numbers; gives sums, products, quotients and roots of them.

use crate::Real;
use core::ops::{Add, Div, Mul, Sub};

/// A scalar, or a jet.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The scalar.
    type Base: Real;
    /// How many jets are nested.
    const DEPTH: u32;
    /// A constant.
    fn constant(value: Self::Base) -> Self;
    /// The value without derivatives.
    fn base(self) -> Self::Base;
    /// The square root.
    fn root(self) -> Self;
}

impl<T: Real> Number for T {
    type Base = T;
    const DEPTH: u32 = 0;

    fn constant(value: T) -> T {
        value
    }

    fn base(self) -> T {
        self
    }

    fn root(self) -> T {
        self.sqrt()
    }
}

/// A value and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet<A, const N: usize> {
    pub value: A,
    pub along: [A; N],
}

impl<A: Number, const N: usize> Number for Jet<A, N> {
    type Base = A::Base;
    const DEPTH: u32 = A::DEPTH + 1;

    fn constant(value: A::Base) -> Self {
        Self::variable(A::constant(value), None)
    }

    fn base(self) -> A::Base {
        self.value.base()
    }

    fn root(self) -> Self {
        let value = self.value.root();
        let factor = A::constant(A::Base::from_f64(0.5)) / value;
        Self {
            value,
            along: self.along.map(|x| x * factor),
        }
    }
}

impl<A: Number, const N: usize> Jet<A, N> {
    /// The variable with the index `which`, or a constant if `which` is `None`.
    pub fn variable(value: A, which: Option<usize>) -> Self {
        let (one, zero) = (A::Base::from_f64(1.0), A::Base::from_f64(0.0));
        Self {
            value,
            along: core::array::from_fn(|i| match which == Some(i) {
                true => A::constant(one),
                false => A::constant(zero),
            }),
        }
    }

    /// Multiplies by a number.
    pub fn times(self, factor: f64) -> Self {
        let factor = A::constant(A::Base::from_f64(factor));
        Self {
            value: self.value * factor,
            along: self.along.map(|x| x * factor),
        }
    }

    fn product(self, other: Self) -> Self {
        let (x, y) = (self.value, other.value);
        self.with(other, x * y, |a, b| a * y + x * b)
    }

    fn quotient(self, other: Self) -> Self {
        let (one, y) = (A::constant(A::Base::from_f64(1.0)), other.value);
        let value = self.value / y;
        self.with(other, value, |a, b| (a - value * b) * (one / y))
    }

    fn with(self, other: Self, value: A, each: impl Fn(A, A) -> A) -> Self {
        let (a, b) = (self.along, other.along);
        Self {
            value,
            along: core::array::from_fn(|i| each(a[i], b[i])),
        }
    }
}

impl<A: Number, const N: usize> Add for Jet<A, N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.with(other, self.value + other.value, |a, b| a + b)
    }
}

impl<A: Number, const N: usize> Sub for Jet<A, N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.with(other, self.value - other.value, |a, b| a - b)
    }
}

impl<A: Number, const N: usize> Mul for Jet<A, N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<A: Number, const N: usize> Div for Jet<A, N> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}
