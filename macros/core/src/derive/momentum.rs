//! Momentum maps and the named form of the balance: the edge momentum `M`, its coadjoint
//! transport `Ad*`, and a diamond for every advected quantity. Body side:
//! `M_k = Ad*_Ω M_{k-1} + Σ ∇ℓ ◇ a`; spatial side: `Ad*_ω M_k = M_{k-1} + Σ ∇ℓ ◇ a`, with
//! `<v ◇ a, ξ> = <v, δa>` along `ξ` (thesis 2.82, 2.85, 2.120, 2.155).

use super::Letters;
use super::balance::{Balance, pairing, shorter};
use super::variation::{Variation, at};
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Side, Spec};
use crate::expr::{self, Expr, Shift};

/// The momentum map of one configuration.
#[derive(Clone, Debug)]
pub struct Momentum {
    /// The edge momentum as a matrix: `2 skew(∇ℓ Ω^T)` for SO(n), `∇ℓ Ω^T` for GL(n); for SU(2) and SE(3) its pairings
    /// with the coordinates. It is evaluated at the start of the edge on the body side, and at its end on the spatial
    /// side.
    pub edge: Expr,
    /// The edge momentum, reduced.
    pub reduced: Expr,
    /// The contribution of the edge at its start: `M` (body) or `Ad*_ω M = ω^T M ω^-T` (spatial).
    pub start: Expr,
    /// The contribution of the edge at its end: `Ad*_Ω M` (body) or `M` (spatial).
    pub end: Expr,
    /// The momentum map of the configuration and its multiplier: `skew(Λ^T P)` on the body side (the right one),
    /// `skew(P Λ^T)` on the spatial side (the left one); without `skew` for GL(n).
    pub cotangent: Expr,
    /// For each advected quantity, the momentum map of the quantity and its multiplier, `V ◇ a`, as a matrix; zero if
    /// this configuration does not move it.
    pub diamonds: Vec<Expr>,
}

/// The momentum maps of all configurations.
pub fn momenta(
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
    variations: &[Variation],
    algebra: &Algebra,
) -> Vec<Momentum> {
    let each = spec.configurations.iter().zip(balances).zip(variations);
    each.enumerate()
        .map(|(i, ((c, b), v))| momentum(spec, letters, c, i, b, v, algebra))
        .collect()
}

fn momentum(
    spec: &Spec,
    letters: &Letters,
    c: &Configuration,
    i: usize,
    b: &Balance,
    v: &Variation,
    algebra: &Algebra,
) -> Momentum {
    let s = &letters.symbols;
    let w = expr::here(s, c.velocity);
    let raw = expr::collect(s, &b.gradient);
    let raw = c.group.pulled_back(s, Side::Spatial, w.clone(), raw);
    // As a matrix, or in coordinates if the Lie algebra has them.
    let matrix = |y: Expr| c.group.as_algebra(s, y);
    let edge = matrix(raw.clone());
    let carry = |y: Expr| {
        let wt = expr::transpose(s, w.clone());
        let back = expr::inverse(s, wt.clone());
        expr::product([wt, y, back])
    };
    let carried = match c.group.coordinates() {
        _ if c.group.is_additive() => edge.clone(),
        Some(_) => matrix(carry(raw)),
        None => carry(edge.clone()),
    };
    let (start, end) = c.side.ordered(edge.clone(), carried);
    let p = expr::letter(s, letters.momentum[i], Shift::HERE);
    let product = c.group.pulled_back(s, c.side, expr::here(s, c.element), p);
    let cotangent = if c.group.is_orthogonal() {
        expr::part(expr::Part::Skew, product)
    } else if c.group.coordinates().is_some() {
        matrix(product)
    } else {
        product
    };
    let xi = at(letters.variation[i], Shift::HERE);
    let diamonds = spec.advected.iter().enumerate().map(|(j, _)| {
        let multiplier = expr::here(s, letters.multiplier[j]);
        let Some((_, change)) = v.advected.get(j) else {
            return expr::zero(edge.shape());
        };
        let y = expr::gradient(s, &pairing(letters, &multiplier, change), xi);
        if c.group.coordinates().is_some() {
            return shorter(algebra, y);
        }
        // For a vector, the map is a vector too and reads best in that form.
        if multiplier.shape().is_vector() && c.group.is_of_space() {
            return expr::hat(shorter(algebra, c.group.covector(s, y)));
        }
        algebra.raise(&algebra.lower(&c.group.as_algebra(s, y)))
    });
    Momentum {
        diamonds: diamonds.collect(),
        reduced: shorter(algebra, edge.clone()),
        edge,
        start,
        end,
        cotangent,
    }
}
