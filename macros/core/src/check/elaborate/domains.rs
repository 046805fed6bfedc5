//! Domains of functions. A function that is undefined for every value of its argument is an error, with the tokens
//! where it occurs; so is a number beyond the largest double. Other arguments are checked by `new` and by the step.

use super::{Elaborated, Elaborator, fail};
use crate::algebra::Rational;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::range::range;
use crate::expr::{self, Expr, Function};

/// The description of an argument that must be positive but never is.
fn never_positive(e: &Expr, vanishes: bool) -> Option<&'static str> {
    let r = range(e);
    match (vanishes, r.is_negative(), r.is_not_positive()) {
        (true, ..) => Some("zero"),
        (_, true, _) => Some("negative"),
        (.., true) => Some("negative or zero"),
        _ => None,
    }
}

impl Elaborator<'_> {
    /// A power of a scalar or square matrix.
    pub(super) fn power(&self, base: Expr, q: Rational, at: Place, place: Place) -> Elaborated {
        if q.is_negative() && self.vanishes(&base) {
            let message = "this is a negative power of an expression that is identically zero";
            return fail(Diagnostic::new(at, message).help("its base must not be zero"));
        }
        if q.as_integer().is_none()
            && !base.is_zero()
            && let Some(always) = never_positive(&base, false)
        {
            let message = format!("the base of this root is {always} for all values");
            return fail(Diagnostic::new(at, message).help(
                "roots and fractional powers are real only for positive numbers: is the sign wrong?",
            ));
        }
        self.finite(expr::power(base, q), place)
    }

    /// A function of a scalar.
    pub(super) fn function(&self, f: Function, a: Expr, at: Place, place: Place) -> Elaborated {
        if f == Function::Log
            && let Some(always) = never_positive(&a, self.vanishes(&a))
        {
            let message = format!("the argument of `log` is {always} for all values");
            return fail(
                Diagnostic::new(at, message)
                    .help("the logarithm is real only for positive numbers: is the sign wrong?"),
            );
        }
        self.finite(expr::call(f, a), place)
    }

    /// The expression, unless it is a number that overflows a double.
    pub(super) fn finite(&self, e: Expr, place: Place) -> Elaborated {
        if range(&e).overflows() {
            let message = "this number exceeds the largest double, 1.8e308";
            return fail(Diagnostic::new(place, message).help("use other units"));
        }
        Ok(e)
    }
}
