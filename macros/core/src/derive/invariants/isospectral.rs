//! The free body in any dimension. The step has a Lax form, proved by normal form, whose eigenvalues are Manakov's
//! integrals, the coefficients of `det(ν + M + λ C²)`. Takes the Riccati factor and the balance; gives the Lax pair
//! and the integrals.

use super::random_step::RandomStep;
use super::{Family, Inputs, Invariant, Kind, here, is_conserved, length};
use crate::algebra::Rational;
use crate::algebra::exact::{Matrix, Point};
use crate::derive::select_solver::StepEquation;
use crate::expr::shape::Dim;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter};

/// `L' K = K L`: the matrices `L` before and after the step are similar.
#[derive(Clone, Debug)]
pub struct Lax {
    /// `C² + λ h M - λ²` at a node.
    pub matrix: Expr,
    /// `K = C - λ Ω^T` on the body side, `K = ω C - λ` on the spatial one.
    pub intertwiner: Expr,
    /// The factor `C`.
    pub factor: Expr,
}

/// The Lax form of the step, if the model is a free body.
pub(super) fn lax(x: &Inputs) -> Option<Lax> {
    let s = &x.letters.symbols;
    let ([c], [StepEquation::Exact(mv)], [b]) = (
        x.spec.configurations.as_slice(),
        x.solve.riccati.as_slice(),
        x.balances,
    ) else {
        return None;
    };
    // On the spatial side, the factor is an advected quantity: its value at the end of the edge is its update.
    let carried: Vec<(Letter, Expr)> = x
        .spec
        .advected
        .iter()
        .map(|a| (here(a.quantity), a.update.clone()))
        .collect();
    let made_of = |l: &Letter| {
        let role = s.get(l.symbol).role;
        role == Role::Parameter || (role == Role::Advected && c.side.is_spatial())
    };
    let at_node = expr::letters(&mv.factor).iter().all(made_of);
    if !mv.symmetric || !at_node || !c.group.is_orthogonal() {
        return None;
    }
    let n = c.group.size();
    let skew = |e: &Expr| match e.shape().is_vector() {
        true => expr::hat(e.clone()),
        false => e.clone(),
    };
    let lambda = expr::here(s, x.letters.spectral);
    let step = expr::here(s, x.spec.step);
    let of = |momentum: Expr, factor: Expr| {
        let square = expr::mul(factor.clone(), factor);
        let middle = expr::product([lambda.clone(), step.clone(), momentum]);
        let last = expr::mul(
            expr::power(lambda.clone(), Rational::integer(2)),
            expr::identity(n),
        );
        let shape = square.shape();
        expr::sum([square, middle, expr::neg(last)], shape)
    };
    let w = expr::here(s, c.velocity);
    let intertwiner = if c.side.is_body() {
        expr::sub(
            mv.factor.clone(),
            expr::mul(lambda.clone(), expr::transpose(s, w)),
        )
    } else {
        expr::sub(
            expr::mul(w, mv.factor.clone()),
            expr::mul(lambda.clone(), expr::identity(n)),
        )
    };
    let after = expr::substitute(s, &mv.factor, &carried);
    let left = expr::mul(of(skew(&b.incoming), after), intertwiner.clone());
    let right = expr::mul(
        intertwiner.clone(),
        of(skew(&b.outgoing), mv.factor.clone()),
    );
    if !x.algebra.equal(&left, &right) {
        return None;
    }
    let momentum = expr::here(s, x.letters.node_momentum[0]);
    Some(Lax {
        matrix: of(skew(&momentum), mv.factor.clone()),
        intertwiner,
        factor: mv.factor.clone(),
    })
}

/// Manakov's integrals.
pub(super) fn integrals(x: &Inputs, lax: Option<&Lax>, passages: &[RandomStep]) -> Vec<Invariant> {
    let Some(lax) = lax else {
        return Vec::new();
    };
    let s = &x.letters.symbols;
    let mu = expr::here(s, x.letters.node_momentum[0]);
    let factor = &lax.factor;
    let size = length(x, &mu);
    if mu.shape().is_vector() {
        // In three dimensions, |μ|² and this invariant are a complete set.
        let value = expr::dot(
            mu.clone(),
            expr::product([factor.clone(), factor.clone(), mu.clone()]),
        );
        let scale = expr::product([
            expr::trace(expr::mul(factor.clone(), factor.clone())),
            expr::power(size, Rational::integer(2)),
        ]);
        let kept = is_conserved(passages, &value);
        return kept
            .then(|| Invariant {
                name: "momentum_quadratic".to_owned(),
                kind: Kind::Value,
                family: Family::Manakov,
                value: Some(value),
                scale: Some(scale),
                exact: true,
                reason: "Manakov integral, quadratic in the momentum".to_owned(),
            })
            .into_iter()
            .collect();
    }
    // The determinant is equal for general ν and λ, so every coefficient is.
    let agree = |p: &RandomStep| {
        (1..=3).all(|k| {
            let (a, b) = (
                determinant(x, factor, &p.before, k),
                determinant(x, factor, &p.after, k),
            );
            a.is_some() && a == b
        })
    };
    if passages.is_empty() || !passages.iter().all(agree) {
        return Vec::new();
    }
    let n = match mu.shape().rows {
        Dim::Fixed(n) => i64::from(n),
        Dim::Named(_) => 2,
    };
    vec![Invariant {
        name: "manakov".to_owned(),
        kind: Kind::Spectrum,
        family: Family::Manakov,
        value: None,
        scale: Some(expr::power(
            expr::add(size, length(x, &expr::mul(factor.clone(), factor.clone()))),
            Rational::integer(n),
        )),
        exact: true,
        reason: "Manakov integrals: the eigenvalues of the Lax matrix".to_owned(),
    }]
}

/// `det(ν + M + λ C²)` at a point, for the k-th pair of general ν and λ.
fn determinant(x: &Inputs, factor: &Expr, point: &Point, k: u64) -> Option<u64> {
    let m = point.letter(here(x.letters.node_momentum[0]))?;
    let c = point.value(factor)?;
    let n = m.rows;
    let (nu, lambda) = (1_000_003 * k + 17, 998_244_353 + 7 * k);
    let whole = Matrix::identity(n)
        .scaled(nu)
        .plus(&m)
        .plus(&c.times(&c).scaled(lambda));
    Some(whole.inverted().map_or(0, |(_, det)| det))
}
