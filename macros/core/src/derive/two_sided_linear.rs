//! The explicit form of a balance whose node momentum is linear in the velocity of the outgoing edge. On GL(n) this
//! is `μ = L (Ω - Id) R + rest` with factors known at the node, although gradients along the group are quadratic; for
//! a field, `p = L ΔX R + rest`. Small linear systems then give the velocity. Takes a balance; gives the factors and
//! the rest.

use super::Letters;
use super::balance::{Balance, shorter};
use super::cancellation;
use super::occurrence::{Occurrence, occurrence};
use super::variation::at;
use crate::algebra::{Algebra, Atom, Factor, Poly, Rational, Term};
use crate::check::spec::Spec;
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Shift};

/// `μ = left (Ω - Id) right + rest`, or `p = left ΔX right + rest`: the unknown is small if the step size is small.
/// The factors are square matrices, or numbers that denote multiples of the identity. They contain parameters and
/// quantities at the node.
#[derive(Clone, Debug)]
pub struct TwoSidedLinear {
    /// The factor to the left of the velocity, including the step size.
    pub left: Expr,
    /// The factor to its right.
    pub right: Expr,
    /// The node momentum at zero velocity.
    pub rest: Expr,
}

/// The largest number of components of a vector whose factor is computed column by column.
const LARGEST: u32 = 8;

/// The form of the balance of configuration `i`, or why it does not exist.
pub fn form(
    spec: &Spec,
    letters: &Letters,
    b: &Balance,
    i: usize,
    algebra: &Algebra,
) -> Result<TwoSidedLinear, String> {
    let s = &letters.symbols;
    let velocity = spec.configurations[i].velocity;
    let refused = || format!("the balance is not linear in {}", s.get(velocity).name);
    let outgoing = expr::substitute(s, &b.outgoing, &spec.end_of_edge());
    let poly = algebra.lower(&outgoing);
    let group = spec.configurations[i].group;
    let split = match group.shape().is_scalar() {
        true => split_number(algebra, &poly, velocity),
        false => split(algebra, &poly, velocity),
    };
    let by_columns = || by_columns(letters, &outgoing, velocity, algebra);
    let found = match split {
        Some((left, right, rest)) => {
            let number = group.is_additive();
            let [left, right] = [left, right].map(|p| factor(algebra, &p, number));
            Some((left, right, algebra.raise(&rest)))
        }
        None => group.is_additive().then(by_columns).flatten(),
    };
    let (left, right, rest) = found.ok_or_else(refused)?;
    let still = group.identity();
    let word = expr::product([left.clone(), still.clone(), right.clone()]);
    let at_rest = expr::add(word, rest);
    let at_rest = shorter(algebra, at_rest);
    // The derived form, if the expanded form has larger rounding errors far from the origin.
    let still_there = [(at(velocity, Shift::HERE), still.clone())];
    let derived = expr::substitute(s, &outgoing, &still_there);
    let found = TwoSidedLinear {
        rest: cancellation::nearer(algebra, at_rest, derived),
        left,
        right,
    };
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    let change = expr::sub(expr::here(s, velocity), still);
    let word = [found.left.clone(), change, found.right.clone()];
    let whole = expr::add(expr::product(word), found.rest.clone());
    let proved = algebra.is_zero(&expr::sub(whole, outgoing));
    match proved && !moving(&found.left) && !moving(&found.right) && !moving(&found.rest) {
        true => Ok(found),
        false => Err(refused()),
    }
}

/// A factor; for a field, a multiple of the identity may be given as a number.
fn factor(algebra: &Algebra, p: &Poly, number: bool) -> Expr {
    if !number || p.shape.is_scalar() || p.terms.keys().any(|t| !t.word.is_empty()) {
        return shorter(algebra, algebra.raise(p));
    }
    let mut multiple = Poly::zero(Shape::SCALAR);
    let terms = &mut p.terms.iter();
    match terms.all(|(term, c)| multiple.push(term.clone(), *c)) {
        true => shorter(algebra, algebra.raise(&multiple)),
        false => algebra.raise(p),
    }
}

/// The parts of a scalar that is linear in a scalar velocity.
fn split_number(algebra: &Algebra, poly: &Poly, velocity: SymbolId) -> Option<(Poly, Poly, Poly)> {
    let own = Atom::Letter(at(velocity, Shift::HERE));
    let (mut left, mut rest) = (Poly::zero(Shape::SCALAR), Poly::zero(Shape::SCALAR));
    for (term, coefficient) in &poly.terms {
        let mut others = term.clone();
        let place = others
            .monomial
            .iter()
            .position(|(atom, q)| *atom == own && q.is_one());
        if let Some(place) = place {
            others.monomial.remove(place);
        }
        let free = matches!(occurrence(algebra, &others, velocity), Occurrence::Free);
        let into = match place {
            Some(_) => &mut left,
            None => &mut rest,
        };
        if !free || !into.push(others, *coefficient) {
            return None;
        }
    }
    let one = Poly::term(Shape::SCALAR, Rational::ONE, Term::default());
    (!left.is_zero()).then_some((left, one, rest))
}

/// The parts of a vector that is linear in a vector velocity, with the factor computed column by column.
fn by_columns(
    letters: &Letters,
    outgoing: &Expr,
    velocity: SymbolId,
    algebra: &Algebra,
) -> Option<(Expr, Expr, Expr)> {
    let s = &letters.symbols;
    let shape = s.get(velocity).shape;
    let Dim::Fixed(n) = shape.rows else {
        return None;
    };
    if !shape.is_vector() || n > LARGEST {
        return None;
    }
    let own: Letter = at(velocity, Shift::HERE);
    let columns = (0..n as u8).map(|axis| {
        let unit = expr::unit(shape.rows, axis);
        let column = expr::directional(s, outgoing, &[(own, unit.clone())]);
        expr::mul(shorter(algebra, column), expr::transpose(s, unit))
    });
    let left = expr::sum(columns.collect::<Vec<_>>(), Shape::square(shape.rows));
    let rest = expr::substitute(s, outgoing, &[(own, expr::zero(shape))]);
    let left = algebra.shortest(&left);
    Some((left, expr::integer(1), shorter(algebra, rest)))
}

/// A term `coefficient monomial left Ω right`, split into its factors.
struct Linear {
    left: Term,
    right: Vec<Factor>,
    coefficient: Rational,
}

/// The factors of the velocity, and the terms without it. All terms with the velocity must share a factor on one
/// side.
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
    let (mut left, mut right) = (
        Poly::zero(Shape::square(poly.shape.rows)),
        Poly::zero(Shape::square(poly.shape.cols)),
    );
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
