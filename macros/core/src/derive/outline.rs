//! The beginning of a derivation: the variations and the equations. Takes a checked model; gives the data from which
//! the forces of neighbours and of end conditions are derived, without proofs and consequences.

use super::advection_rule::{self, AdvectionRule};
use super::balance::{self, Balance};
use super::variation::{self, Variation, at};
use super::{Derivation, Letters, action, letters, place_of_most, reduction, too_large};
use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::diagnostic::Errors;
use crate::expr::{self, Expr, Letter, Shift};
use crate::work::{self, Count};

/// The first results of a derivation: the variations and the equations, without their proof and their consequences.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The reduced model.
    pub spec: Spec,
    /// Symbols of the model and of the derivation.
    pub letters: Letters,
    /// How every quantity varies, per configuration.
    pub variations: Vec<Variation>,
    /// How advected quantities follow from the configuration.
    pub transports: Vec<AdvectionRule>,
    /// The balance of every configuration.
    pub balances: Vec<Balance>,
}

/// The beginning of a derivation.
pub fn outline(spec: Spec) -> Result<Outline, Errors> {
    let _count = Count::begin();
    let whole = place_of_most(&spec);
    let spec = reduction::reduce(spec)?;
    let letters = letters(&spec);
    let algebra = Algebra::new(&letters.symbols);
    let action = action::action(&spec);
    let variations = variation::variations(&spec, &letters, &algebra)?;
    let transports = advection_rule::transports(&spec, &letters, &algebra)?;
    let balances = balance::balances(&spec, &letters, &action, &variations, &algebra);
    if work::exhausted() {
        return Err(too_large(whole, work::excess()).into());
    }
    Ok(Outline {
        spec,
        letters,
        variations,
        transports,
        balances,
    })
}

impl Outline {
    /// The expression with advected quantities replaced by their definitions, at both ends of the edge. Quantities
    /// without a definition are unchanged.
    pub fn defined(&self, e: &Expr) -> Expr {
        let s = &self.letters.symbols;
        let mut list: Vec<(Letter, Expr)> = Vec::new();
        for (a, t) in self.spec.advected.iter().zip(&self.transports) {
            let AdvectionRule::Defined(value) = t else {
                continue;
            };
            for shift in [Shift::HERE, Shift::NEXT] {
                let value = expr::shift_time(s, value, shift.time);
                list.push((at(a.quantity, shift), value));
            }
        }
        expr::substitute(s, e, &list)
    }
}

impl Derivation {
    /// The first results of this derivation.
    pub fn outline(&self) -> Outline {
        Outline {
            spec: self.spec.clone(),
            letters: self.letters.clone(),
            variations: self.variations.clone(),
            transports: self.transports.clone(),
            balances: self.balances.clone(),
        }
    }
}
