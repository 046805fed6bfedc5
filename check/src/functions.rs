//! Functions of one number, with first and second derivative. Takes a name and a number; gives the value, or `None` if
//! the function is unknown.

use crate::number::Number;

/// The largest number of roundings of a function of the standard library.
const ROUNDINGS: f64 = 4.0;

/// The function of this name.
#[must_use]
pub fn named(name: &str, x: &Number) -> Option<Number> {
    let v = x.value;
    Some(match name {
        "sqrt" => square_root(x),
        "exp" => x.through([v.exp(); 3], ROUNDINGS),
        "log" => x.through([v.ln(), 1.0 / v, -1.0 / (v * v)], ROUNDINGS),
        "sin" => x.through([v.sin(), v.cos(), v.sin()], ROUNDINGS),
        "cos" => x.through([v.cos(), -v.sin(), v.cos()], ROUNDINGS),
        "sinh" => x.through([v.sinh(), v.cosh(), v.sinh()], ROUNDINGS),
        "cosh" => x.through([v.cosh(), v.sinh(), v.cosh()], ROUNDINGS),
        "tanh" => {
            let (value, part) = (v.tanh(), 1.0 / v.cosh());
            x.through([value, part * part, 2.0 * value * part * part], ROUNDINGS)
        }
        "abs" => {
            let side = sign(v);
            let mut out = x.through([v.abs(), side, 0.0], 0.0);
            unknown_side(x, &mut out, 2.0);
            out
        }
        "sign" => {
            let mut out = Number::exact(sign(v));
            if x.error > 0.0 && v.abs() <= x.error {
                out.error = 2.0;
            }
            out
        }
        _ => return None,
    })
}

fn sign(v: f64) -> f64 {
    match v {
        v if v > 0.0 => 1.0,
        v if v < 0.0 => -1.0,
        _ => 0.0,
    }
}

/// If the argument may have either sign, so may the derivative.
fn unknown_side(x: &Number, out: &mut Number, jump: f64) {
    if x.error > 0.0 && x.value.abs() <= x.error {
        out.slopes = x.slopes.clone();
        for slope in &mut out.slopes {
            (slope.error, slope.value) = (jump * (slope.value.abs() + slope.error), 0.0);
        }
    }
}

/// The square root.
#[must_use]
pub fn square_root(x: &Number) -> Number {
    let root = x.value.sqrt();
    let first = 0.5 / root;
    let second = -0.5 * first / x.value;
    x.through([root, first, second], 1.0)
}

/// A fractional power; integer exponents use products.
#[must_use]
pub fn power(x: &Number, numerator: i128, denominator: i128) -> Number {
    match denominator {
        1 => {
            let size = whole_power(x, numerator.unsigned_abs());
            match numerator < 0 {
                true => Number::exact(1.0).over(&size),
                false => size,
            }
        }
        2 => power(&square_root(x), numerator, 1),
        _ => {
            #[allow(clippy::cast_precision_loss)]
            let q = numerator as f64 / denominator as f64;
            let v = x.value;
            let (value, first) = (v.powf(q), q * v.powf(q - 1.0));
            let second = q * (q - 1.0) * v.powf(q - 2.0);
            // The exponent is rounded too, which the logarithm magnifies.
            x.through(
                [value, first, second],
                ROUNDINGS + q.abs() * v.ln().abs() + 1.0,
            )
        }
    }
}

/// `x^n` by squares and products.
fn whole_power(x: &Number, mut n: u128) -> Number {
    let mut out: Option<Number> = None;
    let mut square = x.clone();
    while n > 0 {
        if n & 1 == 1 {
            out = Some(match out {
                Some(part) => part.times(&square),
                None => square.clone(),
            });
        }
        n >>= 1;
        if n > 0 {
            square = square.times(&square);
        }
    }
    out.unwrap_or_else(|| Number::exact(1.0))
}
