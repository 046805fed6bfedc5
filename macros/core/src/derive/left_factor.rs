//! The left factor of a balance that is linear in the velocity.

use super::occurrence::{Occurrence, occurrence};
use crate::algebra::{Algebra, Poly};
use crate::expr;
use crate::expr::symbol::{SymbolId, Symbols};

/// Splits `Ω X - X^T Ω^T + rest`: returns `X` and the rest, or None if the velocity occurs anywhere else.
pub(super) fn split(
    algebra: &Algebra,
    poly: &Poly,
    velocity: SymbolId,
    s: &Symbols,
) -> Option<(Poly, Poly)> {
    let (mut x, mut rest) = (Poly::zero(poly.shape), Poly::zero(poly.shape));
    let mut mirrored = Poly::zero(poly.shape);
    for (term, coefficient) in &poly.terms {
        let last = term.word.len().saturating_sub(1);
        let mut others = term.clone();
        let ok = match occurrence(algebra, term, velocity) {
            Occurrence::Free => rest.push(others, *coefficient),
            Occurrence::Once {
                place: 0,
                transposed: false,
            } => {
                others.word.remove(0);
                x.push(others, *coefficient)
            }
            Occurrence::Once {
                place,
                transposed: true,
            } if place == last => {
                others.word.pop();
                mirrored.push(others, coefficient.negated())
            }
            Occurrence::Once { .. } | Occurrence::Otherwise => return None,
        };
        debug_assert!(ok);
    }
    let x_t = expr::transpose(s, algebra.raise(&x));
    let agrees = algebra.is_zero(&expr::sub(x_t, algebra.raise(&mirrored)));
    (agrees && !x.is_zero()).then_some((x, rest))
}
