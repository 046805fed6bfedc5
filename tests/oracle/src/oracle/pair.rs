//! Numbers of 32 digits: the unevaluated sum of two doubles, with a relative error of about 1e-31. The implementation is
//! independent of the runtime's scalars, so that a mistake in one cannot hide a mistake in the other.

use super::dual::Number;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, where `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The nearest double.
    pub high: f64,
    /// The remainder.
    pub low: f64,
}

/// A sum and its exact rounding error.
fn sum(a: f64, b: f64) -> Pair {
    let high = a + b;
    let of_b = high - a;
    let low = (a - (high - of_b)) + (b - of_b);
    Pair { high, low }
}

/// A double as an exact sum of two doubles with 26 bits each.
fn halves(a: f64) -> (f64, f64) {
    let scaled = a * f64::from((1_u32 << 27) + 1);
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// A product and its exact rounding error.
fn product(a: f64, b: f64) -> Pair {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    let low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2;
    Pair { high, low }
}

/// Half of pi: a double and its remainder.
const QUARTER_TURN: Pair = Pair {
    high: std::f64::consts::FRAC_PI_2,
    low: 6.123_233_995_736_766e-17,
};

/// The logarithm of two: a double and its remainder.
const LOG_OF_TWO: Pair = Pair {
    high: std::f64::consts::LN_2,
    low: 2.319_046_813_846_299_6e-17,
};

impl Pair {
    /// A double times a power of two.
    fn scaled(self, power: i32) -> Self {
        let factor = 2.0_f64.powi(power);
        Pair {
            high: self.high * factor,
            low: self.low * factor,
        }
    }

    /// The power series whose n-th term is the previous term times `x / divisor(n)`.
    fn series(first: Pair, x: Pair, divisor: impl Fn(f64) -> f64) -> Pair {
        let mut total = first;
        let mut term = first;
        // Forty terms of a series in a number below one; the last is below 32 digits.
        for n in 1..40 {
            term = term * x / Pair::constant(divisor(f64::from(n)));
            total = total + term;
        }
        total
    }

    /// Sine and cosine of an angle of at most pi/4.
    fn small_angle(self) -> [Pair; 2] {
        let square = -(self * self);
        let sine = Pair::series(self, square, |n| 2.0 * n * (2.0 * n + 1.0));
        let cosine = Pair::series(Pair::constant(1.0), square, |n| 2.0 * n * (2.0 * n - 1.0));
        [sine, cosine]
    }

    /// Sine and cosine. Subtracting whole quarter turns costs the angle as many digits as they have.
    fn angle(self) -> [Pair; 2] {
        let quarters = (self.high / QUARTER_TURN.high).round();
        let [sine, cosine] = (self - QUARTER_TURN * Pair::constant(quarters)).small_angle();
        match quarters.rem_euclid(4.0) {
            0.0 => [sine, cosine],
            1.0 => [cosine, -sine],
            2.0 => [-sine, -cosine],
            _ => [-cosine, sine],
        }
    }
}

impl Number for Pair {
    fn constant(value: f64) -> Self {
        Pair {
            high: value,
            low: 0.0,
        }
    }
    fn value(self) -> f64 {
        self.high
    }
    fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return self;
        }
        // One Newton step doubles the digits of the square root in double precision.
        let root = Pair::constant(self.high.sqrt());
        (root + self / root) * Pair::constant(0.5)
    }
    fn exp(self) -> Self {
        let whole = (self.high / LOG_OF_TWO.high).round();
        let rest = self - LOG_OF_TWO * Pair::constant(whole);
        Pair::series(Pair::constant(1.0), rest, |n| n).scaled(whole as i32)
    }
    fn ln(self) -> Self {
        let mut result = Pair::constant(self.high.ln());
        for _ in 0..2 {
            result = result + self * (-result).exp() - Pair::constant(1.0);
        }
        result
    }
    fn sin(self) -> Self {
        self.angle()[0]
    }
    fn cos(self) -> Self {
        self.angle()[1]
    }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let once = sum(high.high, high.low + low.high);
        sum(once.high, once.low + low.low)
    }
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Pair {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let whole = product(self.high, other.high);
        let across = self.high * other.low + self.low * other.high;
        sum(whole.high, whole.low + across)
    }
}

impl Div for Pair {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        // Three digits of a long division in base 2^53.
        let first = self.high / other.high;
        let rest = self - other * Pair::constant(first);
        let second = rest.high / other.high;
        let rest = rest - other * Pair::constant(second);
        sum(first, second) + Pair::constant(rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Pair, b: Pair) {
        let off = (a - b).high.abs();
        assert!(off <= 1e-30 * b.high.abs().max(1.0), "{a:?} {b:?}");
    }

    #[test]
    fn functions_undo_one_another_and_add_up() {
        for x in [0.3, 1.7, 5.1, 0.01] {
            let x = Pair::constant(x) / Pair::constant(3.0);
            near(x.exp().ln(), x);
            near(x.sqrt() * x.sqrt(), x);
            near(x.sin() * x.sin() + x.cos() * x.cos(), Pair::constant(1.0));
            let double = x + x;
            near(double.sin(), (x.sin() * x.cos()).scaled(1));
            near(x / Pair::constant(7.0) * Pair::constant(7.0), x);
        }
    }

    #[test]
    fn constants_have_all_digits() {
        // The sine of pi/6 is one half; e equals the sum of its series.
        let third = QUARTER_TURN / Pair::constant(3.0);
        near(third.sin(), Pair::constant(0.5));
        near(Pair::constant(2.0).ln(), LOG_OF_TWO);
    }
}
