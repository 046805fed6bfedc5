//! Whether a step that looks symmetric is. Takes the reversal as derived; gives the warning that
//! the action is not self-adjoint, where that is not what the model asks for.

use super::{Inputs, Topic, Warning, difference};
use crate::check::spec::Spec;
use crate::derive::action::{self, Action};
use crate::derive::reversal::{self, Reversal};
use crate::diagnostic::Diagnostic;
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
    if difference::is_total(x, &reversal::sum(x.spec, &action)) {
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
