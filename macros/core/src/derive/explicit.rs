//! The explicit form of a balance on GL(n): the momentum of a node is linear in the velocity of the
//! edge that leaves it, `μ = L (Ω - Id) R + rest` with factors known at the node, though gradients along
//! the group are quadratic. Two small linear systems then give the velocity.
//! Takes a balance; gives the factors and the rest.

use super::Letters;
use super::balance::{Balance, shorter};
use super::occurrence::{Occurrence, occurrence};
use crate::algebra::{Algebra, Factor, Poly, Rational, Term};
use crate::check::spec::Spec;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr};

/// `μ = left (Ω - Id) right + rest`: what is solved for is small where the step is. All are n x n
/// matrices, made of parameters and of quantities at the node.
#[derive(Clone, Debug)]
pub struct Explicit {
    /// The factor to the left of the velocity, the step in it.
    pub left: Expr,
    /// The factor to its right.
    pub right: Expr,
    /// The node momentum at rest.
    pub rest: Expr,
}

/// The form of the balance of configuration `i`, or what stands against it.
pub fn form(
    spec: &Spec,
    letters: &Letters,
    b: &Balance,
    i: usize,
    algebra: &Algebra,
) -> Result<Explicit, String> {
    let s = &letters.symbols;
    let velocity = spec.configurations[i].velocity;
    let refused = || format!("the balance is not linear in {}", s.get(velocity).name);
    let outgoing = expr::substitute(s, &b.outgoing, &spec.end_of_edge());
    let poly = algebra.lower(&outgoing);
    let (left, right, rest) = split(algebra, &poly, velocity).ok_or_else(refused)?;
    let (left, right) = (
        shorter(algebra, algebra.raise(&left)),
        shorter(algebra, algebra.raise(&right)),
    );
    let at_rest = expr::add(expr::mul(left.clone(), right.clone()), algebra.raise(&rest));
    let found = Explicit {
        rest: shorter(algebra, at_rest),
        left,
        right,
    };
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    let n = spec.configurations[i].group.size();
    let change = expr::sub(expr::here(s, velocity), expr::identity(n));
    let word = [found.left.clone(), change, found.right.clone()];
    let whole = expr::add(expr::product(word), found.rest.clone());
    let proved = algebra.is_zero(&expr::sub(whole, outgoing));
    match proved && !moving(&found.left) && !moving(&found.right) && !moving(&found.rest) {
        true => Ok(found),
        false => Err(refused()),
    }
}

/// A term `coefficient monomial left Ω right` by its factors.
struct Linear {
    left: Term,
    right: Vec<Factor>,
    coefficient: Rational,
}

/// The factors around the velocity and what stands without it: all terms have one factor in common,
/// on one side or the other.
fn split(algebra: &Algebra, poly: &Poly, velocity: SymbolId) -> Option<(Poly, Poly, Poly)> {
    let mut rest = Poly::zero(poly.shape);
    let mut linear: Vec<Linear> = Vec::new();
    for (term, coefficient) in &poly.terms {
        match occurrence(algebra, term, velocity) {
            Occurrence::Free if rest.push(term.clone(), *coefficient) => {}
            Occurrence::Once {
                place,
                transposed: false,
            } => {
                let (mut left, right) = (term.clone(), term.word[place + 1..].to_vec());
                left.word.truncate(place);
                linear.push(Linear {
                    left,
                    right,
                    coefficient: *coefficient,
                });
            }
            _ => return None,
        }
    }
    let first = linear.first()?;
    let (mut left, mut right) = (Poly::zero(poly.shape), Poly::zero(poly.shape));
    let of_word = |word: &[Factor]| Term {
        word: word.to_vec(),
        ..Term::default()
    };
    let added = if linear.iter().all(|t| t.right == first.right) {
        right.push(of_word(&first.right), Rational::ONE)
            && linear
                .iter()
                .all(|t| left.push(t.left.clone(), t.coefficient))
    } else if linear.iter().all(|t| t.left.word == first.left.word) {
        left.push(of_word(&first.left.word), Rational::ONE)
            && linear.iter().all(|t| {
                let mut term = of_word(&t.right);
                term.monomial = t.left.monomial.clone();
                right.push(term, t.coefficient)
            })
    } else {
        return None;
    };
    added.then_some((left, right, rest))
}
