//! Momentum maps and the named form of the balance: the edge momentum `M`, its coadjoint
//! transport `Ad*`, and a diamond for every advected quantity:
//! `M_k + Σ ∇ℓ_k ◇ a_k = Ad*_Ω M_{k-1} + ...` (the discrete Euler-Poincare equation).

use super::Letters;
use super::balance::Balance;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::{Side, Spec};
use crate::expr::{self, Expr, Shift};

/// The momentum map of one configuration.
#[derive(Clone, Debug)]
pub struct Momentum {
    /// The edge momentum as a matrix: `2 skew(∇ℓ Ω^T)` for SO(n), `∇ℓ Ω^T` for GL(n) (body side;
    /// on the spatial side `∇ℓ` and `Ω^T` change places).
    pub edge: Expr,
    /// The same, reduced.
    pub reduced: Expr,
    /// `Ad*_Ω M` as a matrix: `Ω^T M Ω` (body).
    pub transported: Expr,
    /// The right momentum map of the configuration and its multiplier: `skew(Λ^T P)`.
    pub cotangent: Expr,
}

/// The momentum maps of all configurations.
pub fn momenta(
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
    algebra: &Algebra,
) -> Vec<Momentum> {
    let s = &letters.symbols;
    let each = spec.configurations.iter().zip(balances).enumerate();
    each.map(|(i, (c, b))| {
        let w = expr::here(s, c.velocity);
        let wt = expr::transpose(s, w.clone());
        let g = b.gradient.clone();
        let back = expr::inverse(s, wt.clone());
        let (raw, left, right) = match c.side {
            Side::Body => (expr::mul(g, wt.clone()), wt, back),
            Side::Spatial => (expr::mul(wt.clone(), g), back, wt),
        };
        let edge = if c.group.is_orthogonal() {
            expr::sub(raw.clone(), expr::transpose(s, raw))
        } else {
            raw
        };
        let element = expr::here(s, c.element);
        let p = expr::letter(s, letters.momentum[i], Shift::HERE);
        let et = expr::transpose(s, element);
        let product = match c.side {
            Side::Body => expr::mul(et, p),
            Side::Spatial => expr::mul(p, et),
        };
        let cotangent = if c.group.is_orthogonal() {
            expr::part(expr::Part::Skew, product)
        } else {
            expr::scale(Rational::HALF, product)
        };
        Momentum {
            reduced: super::balance::shorter(algebra, edge.clone()),
            transported: expr::product([left, edge.clone(), right]),
            edge,
            cotangent,
        }
    })
    .collect()
}
