//! Reports expressions that are ambiguous or use the notation of another language. Each error shows both readings.

use super::{Cursor, Expression, Kind, Token, unknown};
use crate::algebra::Rational;
use crate::diagnostic::{Diagnostic, Place};
use crate::syntax::FUNCTIONS;

/// Types that Rust allows as suffixes of numbers.
const SUFFIXES: [&str; 14] = [
    "f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128",
    "usize",
];

/// The name of an operand in a message: its text if that is one word, otherwise `a`.
fn spelled(e: &Expression) -> &str {
    match &e.kind {
        Kind::Name(name) => name,
        _ => "a",
    }
}

/// `x/a b`: it is unclear whether `b` is in the numerator or in the denominator.
pub(super) fn after_divisor(c: &Cursor, divisor: &Expression) -> Diagnostic {
    let next = match c.peek() {
        Some(Token::Glued(number, name)) => return glued(c, number, name),
        Some(Token::Name(n)) => n.clone(),
        Some(Token::Number(n)) => n.clone(),
        _ => "(...)".to_owned(),
    };
    let a = match &divisor.kind {
        Kind::Number(q) if q.denominator() == 1 => q.numerator().to_string(),
        _ => spelled(divisor).to_owned(),
    };
    let d = Diagnostic::new(
        divisor.place.to(c.place()),
        "a product without `*` is ambiguous after `/`",
    )
    .help(format!(
        "write `/({a}*{next})` to divide by both, or `/{a}*{next}` to multiply by `{next}`"
    ));
    // `d/dt x`.
    match unknown::function(&a) {
        Some(rate) => d.help(rate),
        None => d,
    }
}

/// `2h`: not a product, and ambiguous after `/`; `0x10` and `2f64` are numbers of other languages.
pub(super) fn glued(c: &Cursor, number: &str, name: &str) -> Diagnostic {
    if let Some(value) = of_another_base(number, name) {
        let message = format!("`{number}{name}`: numbers are decimal");
        return Diagnostic::new(c.place(), message).help(match value {
            Some(value) => format!("write `{value}`"),
            None => "write it in decimal, such as `16`".to_owned(),
        });
    }
    if SUFFIXES.contains(&name) {
        let message = format!("`{number}{name}`: numbers are exact and have no type");
        return Diagnostic::new(c.place(), message).help(format!("write `{number}`"));
    }
    let divides = c.follows_punct('/');
    let d = Diagnostic::new(
        c.place(),
        format!("`{number}{name}` is neither a number nor a name"),
    );
    d.help(match divides {
        true => format!(
            "write `/({number}*{name})` to divide by both, or `/{number}*{name}` to multiply by `{name}`"
        ),
        false => format!("write `{number}*{name}`"),
    })
}

/// The value of `0x10`, `0o17` or `0b11`, which arrive as `0` and the rest; `Some(None)` if the value is invalid or
/// too large.
fn of_another_base(number: &str, name: &str) -> Option<Option<u128>> {
    let base = match name.as_bytes().first()? {
        b'x' => 16,
        b'o' => 8,
        b'b' => 2,
        _ => return None,
    };
    let digits = name[1..].replace('_', "");
    let all = !digits.is_empty() && digits.chars().all(|c| c.is_digit(base));
    (number == "0" && all).then(|| u128::from_str_radix(&digits, base).ok())
}

/// The error for a missing `*` after a factor. A number may follow (`v[1] 2`, `(a + b)2`: a product, a power or an
/// index?), or parentheses after a call, an index or a power (`dot(a, b)(2)`). `opened` is whether the factor began
/// with a parenthesis.
pub(super) fn after_factor(
    c: &Cursor,
    factor: Option<&Expression>,
    opened: bool,
) -> Option<Diagnostic> {
    let factor = factor?;
    let (what, remedy) = match c.peek()? {
        Token::Number(n) => (
            format!("`{n}` follows a factor without `*`"),
            format!("write `*{n}` for the product, `^{n}` for a power"),
        ),
        Token::Open('(') => {
            let inner = match &factor.kind {
                Kind::Neg(inner) => &inner.kind,
                other => other,
            };
            if let Some(told) = power_of_function(inner, factor.place) {
                return Some(told);
            }
            let what = match inner {
                Kind::Call(..) => "a function",
                Kind::Component(..) => "a component",
                Kind::Power(..) => "a power",
                _ => return None,
            };
            if opened {
                return None;
            }
            (
                format!("parentheses follow {what} without `*`"),
                "write `*(...)` for the product".to_owned(),
            )
        }
        _ => return None,
    };
    Some(Diagnostic::new(factor.place.to(c.place()), what).help(remedy))
}

/// `sin^2(q)`, `sin^-1(x)`: a power belongs after the argument of the function.
fn power_of_function(factor: &Kind, place: Place) -> Option<Diagnostic> {
    let Kind::Power(base, q) = factor else {
        return None;
    };
    let Kind::Name(f) = &base.kind else {
        return None;
    };
    if !FUNCTIONS.contains(&f.as_str()) || q.denominator() != 1 {
        return None;
    }
    let power = q.numerator();
    let message = format!("`{f}^{power}(...)`: write the power after the argument of a function");
    let help = match unknown::function(&format!("a{f}")).filter(|_| power == -1) {
        Some(inverse) => inverse.to_owned(),
        None => format!("write `{f}(...)^{power}`"),
    };
    Some(Diagnostic::new(place, message).help(help))
}

/// The error for `x^1/2`, which is half of `x` but probably means the root. `x^2/2` and `x^-1/2` are accepted as half
/// of the power.
pub(super) fn after_exponent(c: &Cursor, base: &Expression, q: Rational) -> Option<Diagnostic> {
    let Some(Token::Number(n)) = c.peek_at(1).filter(|_| q.is_one() && c.is_punct('/')) else {
        return None;
    };
    let x = spelled(base);
    let message = format!("`{x}^1/{n}` is ambiguous");
    let help = format!("write `{x}^(1/{n})` for the exponent 1/{n}, or `{x}/{n}` to divide by {n}");
    Some(Diagnostic::new(base.place.to(c.place()), message).help(help))
}
