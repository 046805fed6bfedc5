//! The formulas of invariants on the card: those that the emitted functions compute, in the letters of the model.
//! Takes an invariant; gives plain text that contains everything needed to evaluate it.

use super::items::text;
use crate::algebra::Rational;
use crate::derive::continuous::{Continuous, velocity};
use crate::derive::invariants::{Invariant, Kind};
use crate::derive::limit::Limit;
use crate::derive::{Derivation, lie};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Letter, Shift};

/// The formula of an invariant.
pub fn formula(d: &Derivation, v: &Invariant) -> String {
    match (&v.kind, &v.value, d.limit.as_ref(), &d.continuous) {
        (Kind::Spectrum, _, _, _) => {
            let factor = d.integrability.lax.as_ref();
            let factor = factor.map_or_else(String::new, |lax| text(d, &lax.factor));
            format!("coefficients of det(ν + μ + λ ({factor})²) that hold μ")
        }
        (Kind::ConstraintRate(j), _, _, _) => {
            format!("rate of change of {}", text(d, &d.spec.holds[*j].value))
        }
        (Kind::Energy, _, Ok(limit), Some(c)) => energy(d, limit, c),
        (_, Some(value), _, _) => text(d, value),
        (_, None, _, _) => v.name.clone(),
    }
}

/// `½ (μ - l)·ζ + V`, followed by the momentum `μ = I ζ + l` at the velocity `ζ`, which determines `ζ`. The inverse
/// of the inertia `I` fits on one line for a few models only.
fn energy(d: &Derivation, limit: &Limit, continuous: &Continuous) -> String {
    let s = &d.letters.symbols;
    let zeta: Vec<(Letter, Expr)> = d
        .spec
        .configurations
        .iter()
        .zip(d.letters.variation.iter().zip(&d.letters.rate))
        .map(|(c, (xi, zeta))| (lie::letter(*xi), velocity(&d.letters, c.group, *zeta)))
        .collect();
    let own = d.spec.configurations.iter().enumerate();
    let terms = own.map(|(i, c)| {
        let mu = expr::here(s, d.letters.node_momentum[i]);
        // The momentum at zero velocity, which is the gradient of the linear part.
        let xi = lie::letter(d.letters.variation[i]);
        let still = expr::gradient(s, &limit.linear, xi);
        let still = c.group.of_gradient(s, expr::substitute(s, &still, &zeta));
        let moving = expr::sub(mu, expr::collect(s, &still));
        let along = velocity(&d.letters, c.group, d.letters.rate[i]);
        let pairing = c.group.pairing(s, moving, along);
        expr::scale(Rational::HALF, expr::collect(s, &pairing))
    });
    let kinetic = expr::sum(terms, Shape::SCALAR);
    let total = expr::add(kinetic, limit.potential.clone());
    let momenta = continuous.momenta.iter().zip(&d.letters.node_momentum);
    let momenta: Vec<String> = momenta
        .map(|(value, id)| {
            let here = expr::letter(s, *id, Shift::HERE);
            format!("{} = {}", text(d, &here), text(d, value))
        })
        .collect();
    format!("{}, where {}", text(d, &total), momenta.join(", "))
}
