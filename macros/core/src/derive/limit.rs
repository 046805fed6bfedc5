//! The limit of small steps: the Lagrangian per unit time that the action of a step discretises, from the expansion
//! of `Ω = exp(h ξ)`, and the physical energy derived from it. The limit reveals wrong signs and factors, and gives
//! runs their energy.

use super::Letters;
use super::action::{Action, summands};
use super::cancellation;
use super::lie;
use super::variation::{Variation, at};
use crate::algebra::{Algebra, Atom, Monomial, Poly, Rational, Term, assumed as points};
use crate::check::spec::Spec;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use std::collections::BTreeMap;

/// The continuous Lagrangian in the velocities `ξ` (letters of [`Letters::variation`]), at most quadratic in them.
#[derive(Clone, Debug)]
pub struct Limit {
    /// The whole Lagrangian per unit time.
    pub lagrangian: Expr,
    /// Its part without velocities, with the opposite sign.
    pub potential: Expr,
    /// Its part linear in the velocities.
    pub linear: Expr,
    /// The kinetic energy, quadratic in the velocities.
    pub kinetic: Expr,
}

/// The size of the largest first derivative that is differentiated again.
const LARGEST: u32 = 20_000;

const TOO_LARGE: &str = "the Lagrangian is too large to expand";

/// The highest derivative that is examined for terms beyond the quadratic ones.
const HIGHEST: i64 = 8;

/// The reason if the Lagrangian is not quadratic in the velocity: its energy is then not known as a function of the
/// momentum.
pub const NOT_QUADRATIC: &str = "the Lagrangian is not quadratic in the velocity";

/// The reason if the action does not shrink in proportion to the step size.
pub const STANDING: &str = "the action of a step does not shrink in proportion to the step";

/// The reason if a clock occurs in the Lagrangian: neither a limit nor an energy is sought.
pub const DRIVEN: &str = "the Lagrangian depends on time";

/// The reason if the step size cannot be extracted from a function.
pub(crate) const INSIDE: &str = "the step occurs inside a function or root";

/// The limit, or why it does not exist.
pub fn limit(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    variations: &[Variation],
    assumed: &[Expr],
    algebra: &Algebra,
) -> Result<Limit, String> {
    let s = &letters.symbols;
    let clocks = spec.clocks();
    let of_clock = |l: &Letter| clocks.contains(&l.symbol);
    if expr::letters(&action.total).iter().any(of_clock) {
        return Err(DRIVEN.to_owned());
    }
    let (mut identity, mut first, mut second) = (Vec::new(), Vec::new(), Vec::new());
    // The rate of exp(h ξ) at any h.
    let mut rates = Vec::new();
    for (i, c) in spec.configurations.iter().enumerate() {
        let xi = lie::element(s, c.group, letters.variation[i]);
        let w = at(c.velocity, Shift::HERE);
        identity.push((w, c.group.identity()));
        first.push((w, xi.clone()));
        rates.push(match c.group.is_additive() {
            true => (w, xi.clone()),
            false => (w, expr::mul(expr::here(s, c.velocity), xi.clone())),
        });
        second.push((w, c.group.second(xi)));
    }
    let l = expr::substitute(s, &action.total, &spec.end_of_edge());
    let still = expr::substitute(s, &l, &identity);
    let step = expr::here(s, spec.step);
    let d1 = expr::directional(s, &l, &first);
    if d1.size() > LARGEST {
        return Err(TOO_LARGE.to_owned());
    }
    no_higher_powers(s, &l, [&rates, &identity], &step, algebra)?;
    let d2 = expr::add(
        expr::directional(s, &d1, &first),
        expr::directional(s, &l, &second),
    );
    let series = expr::sum(
        [
            l,
            expr::mul(step.clone(), d1),
            expr::product([
                expr::number(Rational::HALF),
                expr::power(step, Rational::integer(2)),
                d2,
            ]),
        ],
        Shape::SCALAR,
    );
    let series = expr::substitute(s, &series, &identity);
    let poly = algebra.lower(&series);
    let h = Atom::Letter(at(spec.step, Shift::HERE));
    let mut parts = [
        Poly::zero(Shape::SCALAR),
        Poly::zero(Shape::SCALAR),
        Poly::zero(Shape::SCALAR),
    ];
    // Terms that do not vanish with the step size must cancel among themselves, separately for each order.
    let mut standing: BTreeMap<Rational, Vec<Expr>> = BTreeMap::new();
    for (term, coefficient) in &poly.terms {
        let (order, rest) = order_in(&term.monomial, &h);
        let value = algebra.raise(&Poly::term(
            Shape::SCALAR,
            *coefficient,
            Term {
                monomial: rest.clone(),
                word: Vec::new(),
            },
        ));
        let constant = expr::letters(&value)
            .iter()
            .all(|l| matches!(s.get(l.symbol).role, Role::Parameter));
        if expr::contains(&value, at(spec.step, Shift::HERE)) {
            return Err(INSIDE.to_owned());
        }
        if order > Rational::ONE || algebra.is_zero(&value) {
            continue;
        }
        // A constant of order one, such as the reference level of a potential, remains; constants of lower order are
        // dropped.
        if order < Rational::ONE {
            if constant || is_carried_constant(spec, letters, variations, algebra, &value) {
                continue;
            }
            standing.entry(order).or_default().push(value);
            continue;
        }
        let degree = degree(letters, &rest, algebra);
        let Some(part) = parts.get_mut(degree) else {
            return Err(NOT_QUADRATIC.to_owned());
        };
        let pushed = part.push(
            Term {
                monomial: rest,
                word: Vec::new(),
            },
            *coefficient,
        );
        if !pushed {
            return Err("its coefficients are too large".to_owned());
        }
    }
    let cancels = |terms: Vec<Expr>| {
        let all = expr::sum(terms, Shape::SCALAR);
        algebra.is_zero(&all) || (!assumed.is_empty() && points::vanishes(s, assumed, &all))
    };
    if !standing.into_values().all(cancels) {
        return Err(STANDING.to_owned());
    }
    let [constant, linear, kinetic] = parts.map(|p| algebra.raise(&p));
    let constant = as_stated(s, spec, &still, constant, algebra);
    Ok(Limit {
        lagrangian: expr::sum(
            [kinetic.clone(), linear.clone(), constant.clone()],
            Shape::SCALAR,
        ),
        potential: expr::neg(constant),
        linear,
        kinetic,
    })
}

/// The part that is proportional to the step size at zero velocity. It is kept as stated if the expanded form has
/// larger rounding errors far from the origin.
fn as_stated(s: &Symbols, spec: &Spec, still: &Expr, expanded: Expr, algebra: &Algebra) -> Expr {
    let step = at(spec.step, Shift::HERE);
    let stated = expr::collect(s, &of_order(algebra, still, step, Rational::ONE));
    match cancellation::error(algebra, &stated) < cancellation::error(algebra, &expanded)
        && algebra.equal(&stated, &expanded)
    {
        true => stated,
        false => expanded,
    }
}

/// The coefficient of one power of the step size: the sum of all terms of this order, with the step size set to
/// one.
pub(crate) fn of_order(algebra: &Algebra, e: &Expr, step: Letter, order: Rational) -> Expr {
    let h = Atom::Letter(step);
    let is_of = |e: &Expr| {
        let terms = algebra.lower(e).terms.into_keys();
        terms
            .map(|t| order_in(&t.monomial, &h).0)
            .all(|q| q == order)
    };
    let terms: Vec<Expr> = summands(algebra.symbols(), e)
        .into_iter()
        .filter(is_of)
        .collect();
    let sum = expr::sum(terms, Shape::SCALAR);
    expr::substitute(algebra.symbols(), &sum, &[(step, expr::integer(1))])
}

/// Rejects an action if a term with a high power of the step size in its divisor contributes to the limit by its
/// third or a higher derivative along `exp(h ξ)`. Examples are `(b/h^3)*dot(d, d)^2` and `-h*m*c^2*sqrt(1 - dot(d,
/// d)/(c*h)^2)`.
fn no_higher_powers(
    s: &Symbols,
    action: &Expr,
    [rates, identity]: [&[(Letter, Expr)]; 2],
    step: &Expr,
    algebra: &Algebra,
) -> Result<(), String> {
    let expr::Node::Letter(step) = step.node() else {
        return Ok(());
    };
    let h = Atom::Letter(*step);
    let lowered = algebra.lower(action);
    let mut lowest = Rational::ZERO;
    let mut mixed = false;
    for term in lowered.terms.keys() {
        let (order, rest) = order_in(&term.monomial, &h);
        let functions = Term {
            monomial: rest,
            word: Vec::new(),
        };
        let functions = algebra.raise(&Poly::term(Shape::SCALAR, Rational::ONE, functions));
        // The series of a function of the velocity and the step size contains all powers of both.
        mixed |=
            expr::contains(&functions, *step) && expr::contains_role(s, &functions, Role::Velocity);
        lowest = lowest.min(order);
    }
    if lowest < Rational::integer(1 - HIGHEST) {
        return Err(TOO_LARGE.to_owned());
    }
    if lowest >= Rational::integer(-1) && !mixed {
        return Ok(());
    }
    let mut derivative = action.clone();
    for n in 1..=HIGHEST {
        // The n-th term of the series has the factor h^n.
        let most = Rational::integer(1 - n);
        let needed = lowest <= most;
        if !(needed || mixed) {
            break;
        }
        if derivative.size() > LARGEST {
            // For functions, the first four derivatives are required; higher derivatives are used if they are small
            // enough.
            return match needed || n <= 4 {
                true => Err(TOO_LARGE.to_owned()),
                false => Ok(()),
            };
        }
        derivative = expr::directional(s, &derivative, rates);
        if n < 3 {
            continue;
        }
        let poly = algebra.lower(&expr::substitute(s, &derivative, identity));
        let mut left: BTreeMap<Rational, Vec<Expr>> = BTreeMap::new();
        for (term, coefficient) in &poly.terms {
            let (order, _) = order_in(&term.monomial, &h);
            let one = Poly::term(Shape::SCALAR, *coefficient, term.clone());
            left.entry(order).or_default().push(algebra.raise(&one));
        }
        let stays = |(order, terms): (Rational, Vec<Expr>)| {
            order <= most && !algebra.is_zero(&expr::sum(terms, Shape::SCALAR))
        };
        if left.into_iter().any(stays) {
            return Err(NOT_QUADRATIC.to_owned());
        }
    }
    Ok(())
}

/// Whether the group preserves a function of advected quantities, such as the trace of an advected inertia. The
/// function is then constant for every motion and does not vary.
fn is_carried_constant(
    spec: &Spec,
    letters: &Letters,
    variations: &[Variation],
    algebra: &Algebra,
    value: &Expr,
) -> bool {
    let s = &letters.symbols;
    let node = expr::letters(value).iter().all(|l| {
        matches!(s.get(l.symbol).role, Role::Parameter)
            || spec.advected.iter().any(|a| a.quantity == l.symbol)
    });
    node && variations
        .iter()
        .all(|v| algebra.is_zero(&expr::directional(s, value, &v.advected)))
}

fn order_in(monomial: &Monomial, h: &Atom) -> (Rational, Monomial) {
    let mut rest = monomial.clone();
    match rest.iter().position(|(a, _)| a == h) {
        Some(i) => {
            let (_, e) = rest.remove(i);
            (e, rest)
        }
        None => (Rational::ZERO, rest),
    }
}

/// The number of velocities in a term, found by scaling them.
fn degree(letters: &Letters, monomial: &Monomial, algebra: &Algebra) -> usize {
    let s = &letters.symbols;
    let term = Term {
        monomial: monomial.clone(),
        word: Vec::new(),
    };
    let value = algebra.raise(&Poly::term(Shape::SCALAR, Rational::ONE, term));
    let doubled: Vec<(Letter, Expr)> = letters
        .variation
        .iter()
        .map(|v| {
            let twice = expr::scale(Rational::integer(2), expr::here(s, *v));
            (at(*v, Shift::HERE), twice)
        })
        .collect();
    let scaled = expr::substitute(s, &value, &doubled);
    for (n, factor) in [1, 2, 4].into_iter().enumerate() {
        let expected = expr::scale(Rational::integer(factor), value.clone());
        if algebra.equal(&scaled, &expected) {
            return n;
        }
    }
    usize::MAX
}

#[cfg(test)]
mod tests;
