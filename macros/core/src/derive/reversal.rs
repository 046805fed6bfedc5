//! Time reversal: whether the action of one step changes sign if its ends are exchanged and the step size changes
//! sign. Composition to higher order requires this symmetry.

#[cfg(test)]
mod tests;

use super::action::Action;
use super::variation::at;
use crate::algebra::{Algebra, assumed};
use crate::check::spec::Spec;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};

/// Whether the action of a step is symmetric under time reversal.
#[derive(Clone, Debug)]
pub enum Reversal {
    /// Symmetric for all parameters.
    Symmetric,
    /// Symmetric for the parameters that the assumptions admit.
    Assumed,
    /// The remainder of `ℓ(q0, q1, h) + ℓ(q1, q0, -h)`; None if it is too large to show.
    Broken(Option<Expr>),
}

impl Reversal {
    /// Whether the step may be composed.
    pub fn is_symmetric(&self) -> bool {
        matches!(self, Reversal::Symmetric | Reversal::Assumed)
    }
}

/// The size of the largest remainder that is shown.
const LARGEST: u32 = 40;

/// `ℓ(q0, q1, h) + ℓ(q1, q0, -h)`, expressed by the velocities and the quantities at the start of the edge.
pub(crate) fn sum(spec: &Spec, action: &Action) -> Expr {
    let s = &spec.symbols;
    let mut swap: Vec<(Letter, Expr)> = vec![(
        at(spec.step, Shift::HERE),
        expr::neg(expr::here(s, spec.step)),
    )];
    for c in &spec.configurations {
        let w = expr::here(s, c.velocity);
        swap.push((at(c.velocity, Shift::HERE), c.group.inverse(s, w)));
    }
    let forward = spec.end_of_edge();
    let nodes = spec.configurations.iter().map(|c| c.element);
    for x in nodes.chain(spec.advected.iter().map(|a| a.quantity)) {
        swap.push((at(x, Shift::HERE), expr::letter(s, x, Shift::NEXT)));
        swap.push((at(x, Shift::NEXT), expr::here(s, x)));
    }
    let reversed = expr::substitute(s, &action.total, &swap);
    let sum = expr::add(action.total.clone(), reversed);
    expr::substitute(s, &sum, &forward)
}

/// The expression with every advected quantity replaced by its definition: an advected point has 1 as its last
/// component, and an advected frame is orthogonal. The shapes of their letters do not show this.
pub(crate) fn by_configuration(spec: &Spec, e: &Expr) -> Expr {
    let defined = spec.advected.iter().filter_map(|a| {
        let definition = a.definition.clone()?;
        Some((at(a.quantity, Shift::HERE), definition))
    });
    expr::substitute(&spec.symbols, e, &defined.collect::<Vec<_>>())
}

/// The remaining advance of a clock in the action after a step of `h` and one of `-h`, for the first clock that does
/// not return.
pub(crate) fn clock_left(spec: &Spec, action: &Action, algebra: &Algebra) -> Option<Expr> {
    let s = &spec.symbols;
    let clocks = spec.clocks();
    let mut used: Vec<_> = expr::letters(&action.total)
        .iter()
        .map(|l| l.symbol)
        .collect();
    // Also include the quantities in the updates of these clocks.
    let own = |id| spec.advected.iter().find(move |a| a.quantity == id);
    let mut next = 0;
    while let Some(id) = used.get(next).copied() {
        next += 1;
        for l in own(id)
            .map(|a| expr::letters(&a.update))
            .unwrap_or_default()
        {
            if !used.contains(&l.symbol) {
                used.push(l.symbol);
            }
        }
    }
    let wanted = clocks.iter().filter(|c| used.contains(c));
    let mut left = wanted.filter_map(|id| {
        let advected = own(*id)?;
        let step = at(spec.step, Shift::HERE);
        let mut back: Vec<(Letter, Expr)> = vec![(step, expr::neg(expr::here(s, spec.step)))];
        for other in clocks.iter().filter_map(|c| own(*c)) {
            back.push((at(other.quantity, Shift::HERE), other.update.clone()));
        }
        let there_and_back = expr::substitute(s, &advected.update, &back);
        let rest = expr::sub(there_and_back, expr::here(s, *id));
        (!algebra.is_zero(&rest)).then_some(rest)
    });
    left.next()
}

/// Whether `ℓ(q0, q1, h) = -ℓ(q1, q0, -h)` up to constants, given that the expressions `assumed` vanish.
pub fn reversal(spec: &Spec, action: &Action, assumed: &[Expr], algebra: &Algebra) -> Reversal {
    let s = &spec.symbols;
    if let Some(rest) = clock_left(spec, action, algebra) {
        return Reversal::Broken((rest.size() <= LARGEST).then_some(rest));
    }
    let sum = sum(spec, action);
    let constant = |e: &Expr| {
        expr::letters(e)
            .iter()
            .all(|l| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step))
    };
    let rest = algebra.raise(&algebra.lower(&sum));
    if algebra.exhausted() {
        return Reversal::Broken(None);
    }
    if constant(&rest) {
        return Reversal::Symmetric;
    }
    // If the sum is constant, it has its value at zero velocity and the identity. Identities beyond the normal form
    // may prove this, such as that a rotation preserves its axis.
    let whole = by_configuration(spec, &rest);
    let still = spec
        .configurations
        .iter()
        .flat_map(|c| [c.velocity, c.element].map(|x| (at(x, Shift::HERE), c.group.identity())));
    let at_rest = expr::substitute(s, &whole, &still.collect::<Vec<_>>());
    let at_rest = algebra.raise(&algebra.lower(&at_rest));
    if constant(&at_rest) {
        if algebra.agree(&whole, &at_rest) {
            return Reversal::Symmetric;
        }
        let moving = expr::sub(whole, at_rest);
        if !assumed.is_empty() && assumed::vanishes(s, assumed, &moving) {
            return Reversal::Assumed;
        }
    }
    Reversal::Broken((rest.size() <= LARGEST).then_some(rest))
}
