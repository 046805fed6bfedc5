//! Whether a step that looks symmetric is. Takes the reversal as derived; gives the warning that
//! the action is not self-adjoint, where that is not what the model asks for.

use super::{Inputs, LARGEST, Topic, Warning};
use crate::check::spec::{Side, Spec};
use crate::derive::action::{self, Action};
use crate::derive::lie;
use crate::derive::reversal::{self, Reversal};
use crate::derive::variation::at;
use crate::diagnostic::Diagnostic;
use crate::expr::{self, Expr, Letter, Shift};
use crate::syntax::ast::NodeRule;

/// The warning, if the action is not self-adjoint and no rule of one side explains it.
pub(super) fn order(x: &Inputs) -> Option<Warning> {
    let Reversal::Broken(left) = x.reversal else {
        return None;
    };
    // `node incoming` and `node outgoing` ask for first order: what counts is whether the step were
    // symmetric without them.
    let (action, left) = if x.spec.node_rule == NodeRule::Symmetric {
        (x.action.clone(), left.clone())
    } else {
        let spec = Spec {
            node_rule: NodeRule::Symmetric,
            ..x.spec.clone()
        };
        let action = action::action(&spec);
        match reversed(x, &action)? {
            Reversal::Broken(left) => (action, left),
            Reversal::Symmetric | Reversal::Assumed => return None,
        }
    };
    if let Some(special) = x.for_symmetric_matrices(&action)
        && reversed(x, &special)?.is_symmetric()
    {
        return None;
    }
    if is_total_difference(x, &action) {
        return None;
    }
    let left = left.map_or_else(String::new, |e| format!(": their sum is {}", x.text(&e)));
    let d = Diagnostic::new(
        x.spec.lagrangian_place,
        format!(
            "the scheme is of first order only: its discrete Lagrangian L is not self-adjoint, \
             L(q0, q1, h) and -L(q1, q0, -h) are not equal up to a total difference{left}"
        ),
    )
    .help(
        "treat both ends of the step alike, as in `(X + next(X))/2*(next(Y) - Y)`, and use odd \
         powers of `h` only; first order that is meant is asked for by `node incoming;` or \
         `node outgoing;`",
    );
    Some(Warning::new(Topic::FirstOrder, d))
}

/// The reversal of an action; nothing where the work ran out.
fn reversed(x: &Inputs, action: &Action) -> Option<Reversal> {
    let algebra = x.engine();
    let found = reversal::reversal(x.spec, action, x.assumed, &algebra);
    (!algebra.exhausted()).then_some(found)
}

/// Most nodes that are differentiated, over all pairs of ends.
const EVALUATED: u64 = 100_000;

/// Whether `S = L(q0, q1, h) + L(q1, q0, -h)` is `F(q1, h) - F(q0, h)`: no derivative of `S` mixes
/// its two ends, and `S` is constant where they meet.
fn is_total_difference(x: &Inputs, action: &Action) -> bool {
    let s = &x.letters.symbols;
    let sum = reversal::by_configuration(x.spec, &reversal::sum(x.spec, action));
    let pairs = (x.spec.configurations.len() as u64).pow(2);
    if pairs * u64::from(sum.size()) > EVALUATED {
        return false;
    }
    let still: Vec<(Letter, Expr)> = x
        .spec
        .configurations
        .iter()
        .map(|c| (at(c.velocity, Shift::HERE), expr::identity(c.group.size())))
        .collect();
    let met = expr::substitute(s, &sum, &still);
    let kept = |e: &Expr| {
        let mut list = x.variations.iter();
        list.all(|v| x.vanishes(&expr::directional(s, e, &v.on_outgoing())))
    };
    if !kept(&met) {
        return false;
    }
    // The element at the end moves and that at the start stays: the velocity alone changes.
    let ends = x.spec.configurations.iter().zip(&x.letters.direction);
    ends.map(|(c, eta)| {
        let eta = lie::element(s, c.group, *eta);
        let w = expr::here(s, c.velocity);
        let change = match c.side {
            Side::Body => expr::mul(w, eta),
            Side::Spatial => expr::mul(eta, w),
        };
        expr::directional(s, &sum, &[(at(c.velocity, Shift::HERE), change)])
    })
    .all(|once| once.size() <= LARGEST && kept(&once))
}
