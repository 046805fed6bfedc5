//! Numbers in messages: short, and such that you can type a suggested number unchanged. Takes a number; gives its
//! text.

use crate::solvers::largest_step::SHORTEST_SHARE;
use core::fmt;

/// The shortest decimals that parse to this number, with an exponent if they would be long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain(pub f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = self;
        if *x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
            write!(f, "{x}")
        } else {
            write!(f, "{x:e}")
        }
    }
}

/// Four digits of a number that is only looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Plain(format!("{:.3e}", self.0).parse().unwrap_or(self.0)).fmt(f)
    }
}

/// Seven digits of a bound, rounded towards zero: if the last digit were rounded up, the step would fail again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtMost(pub f64);

/// More than half a unit of the seventh digit, for any first digit.
const DIGIT: f64 = 1e-6;

impl AtMost {
    fn rounded(self) -> f64 {
        let seven = |x: f64| format!("{x:.6e}").parse().unwrap_or(x);
        let near: f64 = seven(self.0);
        if near.abs() <= self.0.abs() {
            return near;
        }
        seven(self.0 * (1.0 - DIGIT))
    }
}

impl fmt::Display for AtMost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Plain(self.rounded()).fmt(f)
    }
}

/// The ratio of a value to its bound; a ratio slightly above one is printed as above one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times(pub f64);

impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = self;
        let above = x - 1.0;
        if above > 0.0 && above < 5e-7 {
            write!(f, "1 + {above:.1e}")
        } else if *x < 1e7 {
            write!(f, "{x:.6}")
        } else {
            write!(f, "{x:.6e}")
        }
    }
}

/// The suggestion for a step of `h` that is too long. `largest`, of the same sign, is the largest
/// possible step from the same state; 0 if none was found.
pub(crate) fn instead(f: &mut fmt::Formatter<'_>, h: f64, largest: f64) -> fmt::Result {
    if !h.is_finite() {
        return write!(f, "; the step size is {h}: give a finite one");
    }
    if largest == 0.0 {
        let tried = h * SHORTEST_SHARE;
        return write!(
            f,
            "; steps from {tried:.0e} to {} from this state failed too: check the step, the state, and the parameters",
            Plain(h)
        );
    }
    let h = Plain(h);
    let largest = AtMost(largest);
    write!(f, "; reduce the step size from {h} to at most {largest}")
}

/// The suggestion for a step that is too long; `steps` are its size and the largest possible one,
/// if they are known.
pub(crate) fn shorter(f: &mut fmt::Formatter<'_>, steps: Option<(f64, f64)>) -> fmt::Result {
    match steps {
        Some((h, largest)) => instead(f, h, largest),
        None => write!(f, "; reduce the step size"),
    }
}

/// The shorter step that was tried successfully, if one was found.
pub(crate) fn works(f: &mut fmt::Formatter<'_>, step: Option<f64>) -> fmt::Result {
    match step {
        Some(h) => write!(f, "; a step of {h} succeeds"),
        None => Ok(()),
    }
}

/// An entry of a matrix, from 1 as in files and plots.
pub(crate) fn place(row: usize, column: usize) -> String {
    format!("({}, {})", row + 1, column + 1)
}

/// The lane of a failure, counted from 1; nothing for the first lane, since types without lanes have it too.
pub(crate) fn in_lane(f: &mut fmt::Formatter<'_>, lane: impl Into<u32>) -> fmt::Result {
    match lane.into() {
        0 => Ok(()),
        lane => write!(f, "lane {}: ", lane + 1),
    }
}

/// The message for a component of the momentum (from 0 here) that is NaN or infinite, with a suggestion;
/// `steps` as in [`shorter`].
pub(crate) fn not_finite(
    f: &mut fmt::Formatter<'_>,
    component: usize,
    steps: Option<(f64, f64)>,
) -> fmt::Result {
    let component = component + 1;
    write!(f, "the momentum is NaN or infinite (component {component})")?;
    match steps {
        Some((h, largest)) if !largest.is_nan() => instead(f, h, largest),
        _ => write!(f, "; check the state and the parameters"),
    }
}

#[cfg(test)]
mod tests {
    use super::{AtMost, Plain, Times};

    #[test]
    fn what_is_offered_is_never_above_the_bound_and_hardly_below() {
        let mut x: f64 = 1.0;
        for _ in 0..10_000 {
            // Powers of an irrational number have all leading digits.
            x *= 1.618_033_988_749_895;
            if x > 1e300 {
                x = 1e-300;
            }
            let said: f64 = AtMost(x).to_string().parse().expect("a number");
            assert!(said <= x && said >= x * (1.0 - 2.0e-6), "{x:e}: {said:e}");
            let back: f64 = AtMost(-x).to_string().parse().expect("a number");
            assert_eq!(back, -said);
        }
        // Rounding to nearest would be above the number, so the test can fail.
        assert_eq!(format!("{:.6e}", 0.095_999_999_99), "9.600000e-2");
        assert_eq!(AtMost(0.095_999_999_99).to_string(), "0.0959999");
        assert_eq!(AtMost(0.25).to_string(), "0.25");
    }

    #[test]
    fn long_numbers_have_an_exponent() {
        assert_eq!(Plain(30.0).to_string(), "30");
        assert_eq!(Plain(1e300).to_string(), "1e300");
        assert_eq!(Plain(-2.5e-9).to_string(), "-2.5e-9");
        assert_eq!(Times(3.0).to_string(), "3.000000");
        assert_eq!(Times(1.5e199).to_string(), "1.500000e199");
        assert_eq!(Times(1.0 + 4e-7).to_string(), "1 + 4.0e-7");
        assert_eq!(Times(f64::NAN).to_string(), "NaN");
    }
}
