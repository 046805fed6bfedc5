//! Numbers on the command line: `0.5`, `1e-3`, `2*pi/3`.
//! Takes a text; gives its value. The expressions are those of case files.

use crate::plain::shown;
use clebsch_core::lattice::value::SiteData;

/// The value of a number, or of an expression in numbers, `pi`, functions, and names that `of` knows.
///
/// # Errors
/// Why it has no finite value.
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

#[cfg(test)]
mod tests {
    use super::value;

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
}
