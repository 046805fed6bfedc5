//! Total differences `F(end) - F(start)` and constants, which do not affect the motion. Takes terms of the action;
//! decides at exact points whether they are one of these.

use super::{Inputs, LARGEST};
use crate::derive::lie;
use crate::derive::reversal::by_configuration;
use crate::derive::variation::at;
use crate::expr::{self, Expr, Function, Letter, Node, Shift};

/// The limit on differentiated nodes, over all pairs of ends.
const EVALUATED: u64 = 100_000;

/// Whether an expression is unchanged if a node moves together with the velocities on its outgoing edge.
pub(super) fn is_kept(x: &Inputs, e: &Expr) -> bool {
    kept(x, &smoothed(x, e))
}

/// Replaces functions with jumps by smooth ones: `sign(u)` by `tanh(u)` and `abs(u)` by `u tanh(u)`. An expression
/// that is constant on both sides of a jump has derivative zero, although it is not constant. If a result for the
/// smooth functions follows from the form alone, it also holds for the original ones.
fn smoothed(x: &Inputs, e: &Expr) -> Expr {
    let e = expr::rebuild(&x.letters.symbols, e, &mut |c| smoothed(x, c));
    match e.node() {
        Node::Call(Function::Sign, a) => expr::call(Function::Tanh, a.clone()),
        Node::Call(Function::Abs, a) => expr::mul(a.clone(), expr::call(Function::Tanh, a.clone())),
        _ => e,
    }
}

fn kept(x: &Inputs, e: &Expr) -> bool {
    x.variations.iter().all(|v| {
        let changes = v.on_outgoing();
        // If there are many bodies, a term contains one or two of them.
        let apart = !changes.iter().any(|(l, _)| expr::contains(e, *l));
        apart || x.vanishes(&expr::directional(&x.letters.symbols, e, &changes))
    })
}

/// The derivatives of an expression if the element at the end of the edge moves and the element at its start is
/// fixed, so that only the velocity changes.
fn at_the_end<'a>(x: &'a Inputs, e: &'a Expr) -> impl Iterator<Item = Expr> + 'a {
    let s = &x.letters.symbols;
    let ends = x.spec.configurations.iter().zip(&x.letters.direction);
    let ends = ends.filter(|(c, _)| expr::contains(e, at(c.velocity, Shift::HERE)));
    ends.map(move |(c, eta)| {
        let eta = lie::element(s, c.group, *eta);
        let w = expr::here(s, c.velocity);
        let change = c.group.moved(c.side, w, eta);
        expr::directional(s, e, &[(at(c.velocity, Shift::HERE), change)])
    })
}

/// The expression in the velocities and the configuration at the start of the edge.
pub(super) fn on_edge(x: &Inputs, e: &Expr) -> Expr {
    let e = expr::substitute(&x.letters.symbols, e, &x.spec.end_of_edge());
    by_configuration(x.spec, &e)
}

/// Whether `e`, from [`on_edge`], is constant along every motion.
pub(super) fn is_constant(x: &Inputs, e: &Expr) -> bool {
    let e = &smoothed(x, e);
    kept(x, e) && at_the_end(x, e).all(|d| x.vanishes(&d))
}

/// Whether `e` is `F(q1, h) - F(q0, h)` or a constant. No derivative of `e` may mix its two ends, `e` must be
/// constant where they coincide, and clocks must not change the derivative at its end from one step to the next.
/// `false` for an expression that is too large, and for a difference over which a clock advances. If the clock in the
/// term does not advance, the term is a force: `A(t)*(next(X) - X)` is the force `-dA/dt`.
pub(super) fn is_total(x: &Inputs, e: &Expr) -> bool {
    let e = smoothed(x, &on_edge(x, e));
    let pairs = (x.spec.configurations.len() as u64).pow(2);
    if pairs * u64::from(e.size()) > EVALUATED {
        return false;
    }
    let still = x.spec.configurations.iter().map(|c| {
        let identity = c.group.identity();
        (at(c.velocity, Shift::HERE), identity)
    });
    let still: Vec<(Letter, Expr)> = still.collect();
    let met = expr::substitute(&x.letters.symbols, &e, &still);
    let later = a_step_later(x, &e);
    let goes_on = |d: &Expr| {
        let d = expr::substitute(&x.letters.symbols, d, &still);
        let after = expr::substitute(&x.letters.symbols, &d, &later);
        later.is_empty() || x.vanishes(&expr::sub(after, d))
    };
    let mut ends = at_the_end(x, &e);
    kept(x, &met) && ends.all(|d| d.size() <= LARGEST && kept(x, &d) && goes_on(&d))
}

/// The clocks of an expression, each with its value at the next node.
fn a_step_later(x: &Inputs, e: &Expr) -> Vec<(Letter, Expr)> {
    let clocks = x.spec.clocks();
    let advected = x.spec.advected.iter();
    let held = advected
        .filter(|a| clocks.contains(&a.quantity) && expr::contains(e, at(a.quantity, Shift::HERE)));
    held.map(|a| (at(a.quantity, Shift::HERE), a.update.clone()))
        .collect()
}
