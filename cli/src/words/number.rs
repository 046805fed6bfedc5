//! Numbers as users type them, `0.5`, `1e-3`, `2*pi/3`, and as clebsch prints them. Takes a text and gives its value;
//! the text may be an expression as in a case file. Takes a number and gives a text that is as short as a reader
//! needs.

use crate::words::plain::shown;
use clebsch_core::lattice::value::SiteData;

/// The value of a number, or of an expression in numbers, `pi`, functions, and names that `of` defines.
///
/// # Errors
/// The reason why the text has no finite value.
pub(crate) fn value(text: &str, of: &dyn Fn(&str) -> Option<f64>) -> Result<f64, String> {
    let text = text.trim();
    let found = match text.parse::<f64>() {
        Ok(number) => Ok(number),
        Err(_) => SiteData::read(text).and_then(|data| data.value(&|name| of(name))),
    };
    match found {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(number) => Err(format!(
            "`{}` is {number}, not a finite number",
            shown(text)
        )),
        Err(why) => Err(format!("`{}` is not a number: {why}", shown(text))),
    }
}

/// Above this, not every integer is an f64.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// An integer in digits, or as `2e4` and `1.5e3` if an f64 represents it exactly.
pub(crate) fn whole(text: &str) -> Option<u64> {
    if let Ok(count) = text.parse::<u64>() {
        return Some(count);
    }
    let number = text.parse::<f64>().ok()?;
    // An integer of this size is converted exactly.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    ((0.0..=EXACT).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

/// A number for a caption, without the noise of its last digits.
pub(crate) fn plain(number: f64) -> String {
    let rounded: f64 = format!("{number:.11e}").parse().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e15).contains(&rounded.abs()) {
        return rounded.to_string();
    }
    // Four digits suffice with an exponent.
    let short: f64 = format!("{rounded:.3e}").parse().unwrap_or(rounded);
    format!("{short:e}")
}

/// A number with at most four digits, for pictures.
pub(crate) fn short(number: f64) -> String {
    plain(format!("{number:.3e}").parse().unwrap_or(number))
}

/// A number with this many decimals. Zero is printed without a sign.
pub(crate) fn decimals(number: f64, count: usize) -> String {
    let text = format!("{number:.count$}");
    match text.trim_start_matches(['-', '0', '.']).is_empty() {
        true => text.trim_start_matches('-').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::{decimals, value, whole};

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(decimals(-1e-9, 3), "0.000");
        assert_eq!(decimals(-0.25, 3), "-0.250");
    }

    #[test]
    fn expressions_have_values_and_others_say_why_not() {
        let of = |name: &str| (name == "m").then_some(3.0);
        for (text, number) in [
            ("0.5", 0.5),
            (" 1/100", 0.01),
            ("-2*m", -6.0),
            ("sqrt(4)", 2.0),
        ] {
            assert_eq!(value(text, &of), Ok(number), "{text}");
        }
        for wrong in ["", "x", "1/0", "inf", "nan", "2*", "[1]"] {
            assert!(value(wrong, &of).is_err(), "{wrong}");
        }
    }

    #[test]
    fn whole_numbers_may_have_an_exponent() {
        for (text, number) in [
            ("0", 0),
            ("1e6", 1_000_000),
            ("1.5e3", 1500),
            ("2E4", 20_000),
            ("9007199254740992.0", 1 << 53),
            ("18446744073709551615", u64::MAX),
        ] {
            assert_eq!(whole(text), Some(number), "{text}");
        }
        for text in [
            "1.5", "1e-3", "-1e3", "1e300", "1e16", "inf", "nan", "", "1 000",
        ] {
            assert_eq!(whole(text), None, "{text}");
        }
    }
}
