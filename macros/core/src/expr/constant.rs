//! Constants that exact arithmetic does not represent: π, and decimals of many digits, such as physical constants.
//! Takes a decimal; the algebra treats each constant as a letter of its own and knows only that it is positive.

/// A positive finite number, stored as the double of the run.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Constant(u64);

impl Constant {
    /// The ratio of the circumference of a circle to its diameter.
    pub const PI: Constant = Constant(std::f64::consts::PI.to_bits());

    /// The double nearest to a decimal, if it is positive and finite.
    pub fn parse(digits: &str) -> Option<Constant> {
        let value: f64 = digits.parse().ok()?;
        (value.is_finite() && value > 0.0).then_some(Constant(value.to_bits()))
    }

    /// Its value.
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }

    /// Its bits: equal bits denote equal numbers.
    pub fn bits(self) -> u64 {
        self.0
    }

    /// Significant digits without trailing zeros, and the power of ten that multiplies them: `("1.380649", -23)`.
    pub fn digits(self) -> (String, i32) {
        let text = format!("{:e}", self.value());
        match text.split_once('e') {
            Some((digits, power)) => (digits.to_owned(), power.parse().unwrap_or(0)),
            None => (text, 0),
        }
    }
}

/// As the language writes it.
impl std::fmt::Display for Constant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (*self == Constant::PI, self.digits().1) {
            (true, _) => f.write_str("pi"),
            (false, -4..=8) => write!(f, "{}", self.value()),
            (false, _) => write!(f, "{:e}", self.value()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Constant;

    #[test]
    fn constants_are_written_as_they_were() {
        for text in ["1.380649e-23", "299792458", "0.123456789", "6.62607015e-34"] {
            assert_eq!(Constant::parse(text).unwrap().to_string(), text);
        }
        assert_eq!(Constant::PI.to_string(), "pi");
        assert_eq!(Constant::parse("0"), None);
        assert_eq!(Constant::parse("1e999"), None);
    }
}
