//! Forces of terms with functionals of all sites. Each term is differentiated through the pull-backs of its
//! functionals, and directly with respect to the positions. One site is written out, and its letters represent all
//! sites: `A(X)` are the values at all sites. The pull-back of a seed is the contribution of all sites of the
//! functional to one site of the quantity it depends on.

use super::neighbour_force::{Force, elaborated, forces};
use super::{Refused, RepresentativeChain};
use crate::algebra::Rational;
use crate::derive::action::summands;
use crate::expr::shape::Shape;
use crate::expr::{self, Applied, Expr, Node};
use crate::lattice::Lattice;

/// Terms with functionals.
#[derive(Clone, Debug)]
pub struct FunctionalForce {
    /// The terms of the Lagrangian, each with the label of the sites of its sum.
    pub terms: Vec<(usize, Expr)>,
    /// The contributions, each in full at one node.
    pub forces: Vec<Force>,
}

/// The terms with functionals, if any.
pub(super) fn meshed(
    lattice: &Lattice,
    part: &RepresentativeChain,
) -> Result<Option<FunctionalForce>, Refused> {
    let mut terms: Vec<(usize, Expr)> = Vec::new();
    for summand in part.unfolded.summands.iter().filter(|t| t.of_functionals) {
        let Some(range) = summand.range else { continue };
        let term = elaborated(part, summand).map_err(|refused| match refused {
            Refused::Form(_) => {
                Refused::Form("a term contains a functional of all sites and a velocity".to_owned())
            }
            wrong => wrong,
        })?;
        match terms.iter_mut().find(|(label, _)| *label == range.label) {
            Some((_, known)) => *known = expr::add(known.clone(), term),
            None => terms.push((range.label, term)),
        }
    }
    if terms.is_empty() {
        return Ok(None);
    }
    if lattice.places().is_none() {
        return Err(Refused::Form(
            "no field of positions is declared `on torus(L)` or `on box`".to_owned(),
        ));
    }
    let whole = terms.iter().map(|(_, e)| e.clone()).reduce(expr::add);
    let forces = whole.map_or_else(Vec::new, |e| forces(part, &e));
    let forces = forces.into_iter().map(|f| Force {
        value: gathered(part, &f.value),
        ..f
    });
    Ok(Some(FunctionalForce {
        terms,
        forces: forces.collect(),
    }))
}

/// Replaces a sum of pull-backs by the pull-back of the sum of their seeds: each pull-back is computed over all
/// sites.
fn gathered(part: &RepresentativeChain, e: &Expr) -> Expr {
    let s = &part.d.letters.symbols;
    let mut rest: Vec<Expr> = Vec::new();
    let mut backs: Vec<(Applied, u8, Vec<Expr>)> = Vec::new();
    for term in summands(s, e) {
        let Some((factor, a, which, seed)) = back(&term) else {
            rest.push(term);
            continue;
        };
        // A factor of a seed may move into the seed if it is the same at all sites.
        let seed = expr::mul(expr::number(factor), gathered(part, &seed));
        match backs.iter_mut().find(|(b, i, _)| *b == a && *i == which) {
            Some((.., seeds)) => seeds.push(seed),
            None => backs.push((a, which, vec![seed])),
        }
    }
    let backs = backs.into_iter().map(|(a, which, seeds)| {
        let seed = expr::sum(seeds, Shape::SCALAR);
        expr::pull_back(s, a, which, seed)
    });
    expr::sum(rest.into_iter().chain(backs).collect::<Vec<_>>(), e.shape())
}

/// A pull-back of a scalar, and the exact number that multiplies it.
fn back(e: &Expr) -> Option<(Rational, Applied, u8, Expr)> {
    match e.node() {
        Node::PullBack(a, which, seed) if seed.shape().is_scalar() => {
            Some((Rational::ONE, a.clone(), *which, seed.clone()))
        }
        Node::Neg(a) => {
            let (factor, a, which, seed) = back(a)?;
            Some((factor.negated(), a, which, seed))
        }
        Node::Product(list) => {
            let mut factor = Rational::ONE;
            let mut found = None;
            for x in list {
                match x.node() {
                    Node::Number(q) => factor = factor.times(*q)?,
                    _ if found.is_none() => found = Some(back(x)?),
                    _ => return None,
                }
            }
            let (own, a, which, seed) = found?;
            Some((factor.times(own)?, a, which, seed))
        }
        _ => None,
    }
}
