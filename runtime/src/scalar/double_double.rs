//! About 32 significant digits from two doubles, for order tests and reference values.
//! Takes and gives unevaluated sums `high + low` with `|low| <= ulp(high)/2`.

use super::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// The unevaluated sum of two doubles (arithmetic of Dekker, 1971, and Knuth).
///
/// The relative error of one operation is at most about 2^-104. The exponent range is the same as for
/// `f64`; products of numbers beyond 1e300 overflow to NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// Sum and its exact rounding error.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// Like `two_sum`, if `|a| >= |b|`.
#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The number as a sum of two halves of 26 bits each.
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// Product and its exact rounding error; by splitting, because without hardware support a fused
/// multiply-add is a library call an order of magnitude slower.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

impl DoubleDouble {
    /// ln 2.
    const LN_2: Self = Self {
        high: core::f64::consts::LN_2,
        low: 2.319_046_813_846_299_6e-17,
    };
    /// pi / 2.
    const HALF_PI: Self = Self {
        high: core::f64::consts::FRAC_PI_2,
        low: 6.123_233_995_736_766e-17,
    };

    /// The sum `high + low`, normalised so that `high` is the nearest double.
    #[inline]
    pub fn from_parts(high: f64, low: f64) -> Self {
        let (high, low) = two_sum(high, low);
        Self { high, low }
    }

    /// The leading double, nearest to the number.
    #[inline]
    pub fn high(self) -> f64 {
        self.high
    }

    /// The remainder after the leading double.
    #[inline]
    pub fn low(self) -> f64 {
        self.low
    }

    /// Absolute value.
    #[inline]
    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// Product with a power of two, exact.
    #[inline]
    fn scaled(self, power_of_two: f64) -> Self {
        Self {
            high: self.high * power_of_two,
            low: self.low * power_of_two,
        }
    }

    /// Sine and cosine: reduction by multiples of pi/2, then Taylor series on |r| <= pi/4.
    fn sin_cos(self) -> (Self, Self) {
        let turns = (self.high / Self::HALF_PI.high).round();
        let r = self - Self::HALF_PI * Self::from_f64(turns);
        let square = r * r;
        let (mut sin, mut cos) = (r, Self::one());
        let (mut odd, mut even) = (r, Self::one());
        // (pi/4)^34 / 34! is below 1e-41, so 17 pairs of terms are more than enough.
        for k in 1..=17_i32 {
            let n = f64::from(2 * k);
            even = -even * square / Self::from_f64(n * (n - 1.0));
            odd = -odd * square / Self::from_f64(n * (n + 1.0));
            cos += even;
            sin += odd;
        }
        match turns.rem_euclid(4.0) {
            0.0 => (sin, cos),
            1.0 => (cos, -sin),
            2.0 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (sum, error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let (sum, error) = quick_two_sum(sum, error + low);
        let (high, low) = quick_two_sum(sum, error + low_error);
        Self { high, low }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (product, error) = two_product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        let (high, low) = quick_two_sum(product, error + cross);
        Self { high, low }
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        // Long division: each quotient digit is one double.
        let first = self.high / other.high;
        let rest = self - other * Self::from_f64(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from_f64(second);
        let third = rest.high / other.high;
        let (high, low) = quick_two_sum(first, second);
        Self { high, low } + Self::from_f64(third)
    }
}

impl AddAssign for DoubleDouble {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for DoubleDouble {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for DoubleDouble {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl DivAssign for DoubleDouble {
    #[inline(always)]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl Zero for DoubleDouble {
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    fn is_zero(&self) -> bool {
        self.high == 0.0
    }
}

impl One for DoubleDouble {
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl From<f64> for DoubleDouble {
    fn from(x: f64) -> Self {
        Self::from_f64(x)
    }
}

impl Real for DoubleDouble {
    type One = Self;
    // 2^-104: the worst error of one operation, four times the representation's 2^-106.
    const EPSILON: f64 = f64::EPSILON * f64::EPSILON;

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
        Self { high: x, low: 0.0 }
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.high
    }

    #[inline(always)]
    fn magnitude(self) -> f64 {
        self.high.abs()
    }

    #[inline(always)]
    fn least(self) -> f64 {
        self.high
    }

    #[inline(always)]
    fn greatest(self) -> f64 {
        self.high
    }

    #[inline(always)]
    fn where_positive(self, then: Self) -> Self {
        if self.high > 0.0 { then } else { Self::zero() }
    }

    #[inline]
    fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return Self::zero();
        }
        // One Newton step doubles the 53 correct bits of the hardware root.
        let root = self.high.sqrt();
        let (square, error) = two_product(root, root);
        let defect = (self - Self::from_parts(square, error)).high;
        Self::from_parts(root, defect / (2.0 * root))
    }

    fn exp(self) -> Self {
        // exp(x) = 2^k (1 + m)^512 with m = expm1(r/512), |r| <= ln(2)/2; working with m instead of
        // 1 + m keeps the nine squarings from losing digits.
        if self.high.is_nan() || self.high.abs() >= 700.0 {
            return Self::from_f64(self.high.exp());
        }
        let k = (self.high / Self::LN_2.high).round();
        let r = (self - Self::LN_2 * Self::from_f64(k)).scaled(1.0 / 512.0);
        let (mut m, mut term) = (r, r);
        // |r/512| < 6.8e-4: ten terms leave less than 1e-38.
        for n in 2..=10_i32 {
            term = term * r / Self::from_f64(f64::from(n));
            m += term;
        }
        for _ in 0..9 {
            m = m.scaled(2.0) + m * m;
        }
        (m + Self::one()).scaled(k.exp2())
    }

    fn ln(self) -> Self {
        // One Newton step for exp(y) = x from the 53 bits of the library function. It is taken twice, so that
        // arguments near 1, where the logarithm cancels, are equally accurate.
        let mut y = Self::from_f64(self.high.ln());
        if y.is_finite() {
            for _ in 0..2 {
                y += self * (-y).exp() - Self::one();
            }
        }
        y
    }

    fn sin(self) -> Self {
        self.sin_cos().0
    }

    fn cos(self) -> Self {
        self.sin_cos().1
    }

    fn sinh(self) -> Self {
        if self.high.abs() > 0.5 {
            let growing = self.exp();
            return (growing - Self::one() / growing).scaled(0.5);
        }
        // The exponentials would cancel, so a series is used: 0.5^31 / 31! is below 1e-43.
        let square = self * self;
        let (mut sum, mut term) = (self, self);
        for k in 1..=15_i32 {
            let n = f64::from(2 * k);
            term = term * square / Self::from_f64(n * (n + 1.0));
            sum += term;
        }
        sum
    }

    fn cosh(self) -> Self {
        let growing = self.exp();
        (growing + Self::one() / growing).scaled(0.5)
    }

    fn tanh(self) -> Self {
        // Beyond, the difference from 1 is below the last digit, and the exponentials overflow.
        if self.high.abs() > 40.0 {
            return Self::from_f64(self.high.signum());
        }
        self.sinh() / self.cosh()
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }

    #[inline]
    fn from_ratio(num: i64, den: i64) -> Self {
        // An i64 has up to 63 bits: split into two exact doubles first.
        let exact = |n: i64| {
            let high = n as f64;
            let rest = i128::from(n) - high as i128;
            Self::from_parts(high, rest as f64)
        };
        exact(num) / exact(den)
    }
}

#[cfg(test)]
mod tests {
    use super::DoubleDouble;
    use crate::Real;

    #[test]
    fn operators_that_assign_do_what_the_others_do() {
        let (a, b) = (
            DoubleDouble::from_ratio(22, 7),
            DoubleDouble::from_ratio(-5, 3),
        );
        let (mut sum, mut difference, mut product, mut quotient) = (a, a, a, a);
        sum += b;
        difference -= b;
        product *= b;
        quotient /= b;
        let wanted = [a + b, a - b, a * b, a / b];
        assert_eq!([sum, difference, product, quotient], wanted);
    }
}
