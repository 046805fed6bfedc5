//! Exact rational numbers on `i128`, the coefficients of every normal form.
//! Every operation is checked: an overflow is `None`, never a wrong number.

use core::cmp::Ordering;

/// A rational number in lowest terms with a positive denominator.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Rational {
    num: i128,
    den: i128,
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Rational {
    /// Zero.
    pub const ZERO: Rational = Rational { num: 0, den: 1 };
    /// One.
    pub const ONE: Rational = Rational { num: 1, den: 1 };
    /// Minus one.
    pub const MINUS_ONE: Rational = Rational { num: -1, den: 1 };
    /// One half.
    pub const HALF: Rational = Rational { num: 1, den: 2 };
    /// A quarter.
    pub const QUARTER: Rational = Rational { num: 1, den: 4 };

    /// The fraction `num/den` in lowest terms; `None` for a zero denominator or on overflow.
    pub fn new(num: i128, den: i128) -> Option<Rational> {
        if den == 0 || num == i128::MIN || den == i128::MIN {
            return None;
        }
        let g = gcd(num.unsigned_abs(), den.unsigned_abs()).max(1) as i128;
        let sign = den.signum();
        Some(Rational {
            num: sign * (num / g),
            den: sign * (den / g),
        })
    }

    /// The integer `n`.
    pub const fn integer(n: i64) -> Rational {
        Rational {
            num: n as i128,
            den: 1,
        }
    }

    /// The numerator, with the sign.
    pub fn numerator(self) -> i128 {
        self.num
    }

    /// Denominator, positive.
    pub fn denominator(self) -> i128 {
        self.den
    }

    /// Whether the number is zero.
    pub fn is_zero(self) -> bool {
        self.num == 0
    }

    /// Whether the number is one.
    pub fn is_one(self) -> bool {
        self == Rational::ONE
    }

    /// Whether the number is below zero.
    pub fn is_negative(self) -> bool {
        self.num < 0
    }

    /// The value as an integer that fits `i32`, if it is one.
    pub fn as_integer(self) -> Option<i32> {
        if self.den == 1 {
            i32::try_from(self.num).ok()
        } else {
            None
        }
    }

    /// Sum, `None` on overflow.
    pub fn plus(self, other: Rational) -> Option<Rational> {
        let num = self
            .num
            .checked_mul(other.den)?
            .checked_add(other.num.checked_mul(self.den)?)?;
        Rational::new(num, self.den.checked_mul(other.den)?)
    }

    /// Product, `None` on overflow.
    pub fn times(self, other: Rational) -> Option<Rational> {
        Rational::new(
            self.num.checked_mul(other.num)?,
            self.den.checked_mul(other.den)?,
        )
    }

    /// The negative.
    pub fn negated(self) -> Rational {
        Rational {
            num: -self.num,
            den: self.den,
        }
    }

    /// One over the number, `None` for zero.
    pub fn inverse(self) -> Option<Rational> {
        Rational::new(self.den, self.num)
    }

    /// Integer power, `None` on overflow or for a negative power of zero.
    pub fn power(self, exponent: i32) -> Option<Rational> {
        let base = if exponent < 0 { self.inverse()? } else { self };
        let mut result = Rational::ONE;
        if base.is_one() || exponent == 0 {
            return Some(result);
        }
        for _ in 0..exponent.unsigned_abs().min(256) {
            result = result.times(base)?;
        }
        (exponent.unsigned_abs() <= 256 || base.is_zero()).then_some(result)
    }

    /// The nearest double.
    pub fn value(self) -> f64 {
        self.num as f64 / self.den as f64
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        match (
            self.num.checked_mul(other.den),
            other.num.checked_mul(self.den),
        ) {
            (Some(a), Some(b)) => a.cmp(&b),
            // Beyond the exact range any fixed order suffices, because it only sorts terms.
            _ => (self.num, self.den).cmp(&(other.num, other.den)),
        }
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests {
    use super::Rational;

    #[test]
    fn arithmetic_stays_in_lowest_terms() {
        let a = Rational::new(6, -4).unwrap();
        assert_eq!((a.numerator(), a.denominator()), (-3, 2));
        assert_eq!(a.plus(Rational::HALF), Some(Rational::MINUS_ONE));
        assert_eq!(a.times(a.inverse().unwrap()), Some(Rational::ONE));
        assert_eq!(Rational::MINUS_ONE.power(-1), Some(Rational::MINUS_ONE));
    }

    #[test]
    fn overflow_and_division_by_zero_are_refused() {
        let big = Rational::new(i128::MAX, 1).unwrap();
        assert_eq!(big.plus(Rational::ONE), None);
        assert_eq!(big.times(big), None);
        assert_eq!(Rational::ZERO.inverse(), None);
        assert_eq!(Rational::new(1, 0), None);
    }
}
