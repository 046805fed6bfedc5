//! Checks whether a step that looks symmetric is symmetric. Takes the derived reversal; gives the warning that the
//! action is not self-adjoint, at the terms that cause it, unless the model requests such a step.

use super::terms::{action_of, place, typed};
use super::{Inputs, Topic, Warning, difference};
use crate::check::spec::Spec;
use crate::derive::action::{self, Action};
use crate::derive::reversal::{self, Reversal};
use crate::derive::variation::at;
use crate::diagnostic::Diagnostic;
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Function, Node, Shift};
use crate::syntax::ast::NodeRule;

/// The warning, if the action is not self-adjoint and no one-sided rule explains it.
pub(super) fn order(x: &Inputs) -> Option<Warning> {
    let Reversal::Broken(left) = x.reversal else {
        return None;
    };
    // A clock that does not return has no effect on the order of a step.
    if reversal::clock_left(x.spec, x.action, &x.engine()).is_some() {
        return None;
    }
    // `node incoming` and `node outgoing` request first order. The question is then whether the step would be
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
    let (addends, all) = typed(x);
    let mut blamed = blamed(x, addends);
    if blamed.is_empty() {
        blamed = self::blamed(x, all);
    }
    let suspects: Vec<&Expr> = match blamed.is_empty() {
        true => vec![&x.spec.typed],
        false => blamed.iter().map(|(term, _)| term).collect(),
    };
    if suspects.iter().all(|term| is_undecided(x, term)) {
        return None;
    }
    let all: Vec<String> = blamed.iter().map(|(term, _)| x.text(term)).collect();
    let terms = one_of_each(&all);
    let alike = match (all.len() - terms.len(), terms.len()) {
        (0, _) => "",
        (_, 1) => " and of the same term at other sites",
        _ => " and of the same terms at other sites",
    };
    let left = match all.is_empty() {
        true => left,
        false => shown(x, &blamed),
    };
    let left = left.map(|e| x.text(&e));
    let reverses = |verb, left: Option<String>| {
        left.map_or_else(String::new, |sum| format!(", which with {verb} {sum}"))
    };
    let because = match terms.as_slice() {
        [] => left.map_or_else(String::new, |sum| format!(": their sum is {sum}")),
        [one] => {
            let sum = match alike.is_empty() {
                true => reverses("its reverse adds up to", left),
                false => reverses("their reverses add up to", left),
            };
            format!(" because of the term {one}{alike}{sum}")
        }
        several => {
            let several: Vec<&str> = several.iter().map(|t| t.as_str()).collect();
            let sum = reverses("their reverses add up to", left);
            format!(
                " because of the terms {}{alike}{sum}",
                several.join(" and ")
            )
        }
    };
    let d = Diagnostic::new(
        place(x, blamed.first().map(|(term, _)| term)),
        format!(
            "the scheme is of first order only: its discrete Lagrangian L is not self-adjoint, since L(q0, q1, h) and -L(q1, \
             q0, -h) differ by more than a total difference{because}"
        ),
    )
    .help(
        "write both ends of the step alike, as in `(X + next(X))/2*(next(Y) - Y)`, with odd powers of `h` only; `node \
         incoming;` and `node outgoing;` affect only terms at one node. If you want a scheme of first order, keep it",
    );
    let clocks = x.spec.clocks();
    let of_clock = |term: &&Expr| {
        let mut letters = expr::letters(term).into_iter();
        letters.any(|l| clocks.contains(&l.symbol))
    };
    let clock = suspects.iter().any(of_clock);
    let d = match clock {
        true => d.help(
            "evaluate a clock that multiplies a velocity at the middle of the step, `t + h/2`, or average both ends",
        ),
        false => d,
    };
    Some(Warning::new(Topic::FirstOrder, d))
}

/// Keeps one of several texts that differ by indices of sites only, such as `q_{3,k}` and `q_{4,k}`.
fn one_of_each(terms: &[String]) -> Vec<&String> {
    let mut seen: Vec<String> = Vec::new();
    let mut out = Vec::new();
    for term in terms {
        let mut parts = term.split("_{");
        let mut form = parts.next().unwrap_or("").to_owned();
        for part in parts {
            form.push_str("_{#");
            form.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit()));
        }
        if !seen.contains(&form) {
            seen.push(form);
            out.push(term);
        }
    }
    out
}

/// Whether the step size occurs inside a root or an absolute value, as in `sqrt(h^2 - x)`. For positive steps this
/// is `h` times a root, so that its formal reversal differs from the reversal of the scheme. The parity of a
/// functional is not known.
fn is_undecided(x: &Inputs, e: &Expr) -> bool {
    let h = at(x.spec.step, Shift::HERE);
    let inside = match e.node() {
        Node::Power(a, q) if q.as_integer().is_none() => expr::contains(a, h),
        Node::Call(Function::Abs, a) => expr::contains(a, h),
        Node::Given(_) | Node::PullBack(..) => expr::contains(e, h),
        _ => false,
    };
    inside || e.children().into_iter().any(|c| is_undecided(x, c))
}

/// The largest sum that is shown.
const SHOWN: u32 = 40;

/// The sum of terms and their reverses, in the shorter of two forms: directly or in normal form. `None` if both are
/// too long to read.
fn shown(x: &Inputs, terms: &[(Expr, Expr)]) -> Option<Expr> {
    let sums = terms.iter().map(|(_, sum)| sum.clone());
    let sum = expr::sum(sums, Shape::SCALAR);
    let algebra = x.engine();
    let normal = algebra.raise(&algebra.lower(&sum));
    let shorter = match !algebra.exhausted() && normal.size() < sum.size() {
        true => normal,
        false => sum,
    };
    (shorter.size() <= SHOWN).then_some(shorter)
}

/// The terms, as typed, that are not self-adjoint, each with the sum of the term and its reverse. Terms that are
/// self-adjoint together are omitted; if all terms are to blame, none is named.
fn blamed(x: &Inputs, terms: Vec<Expr>) -> Vec<(Expr, Expr)> {
    let count = terms.len();
    let mut found: Vec<(Expr, Expr)> = Vec::new();
    for term in terms {
        let Some(sum) = left_over(x, &term) else {
            continue;
        };
        let joint = |other: &Expr| difference::is_total(x, &expr::add(sum.clone(), other.clone()));
        match found.iter().position(|(_, other)| joint(other)) {
            Some(partner) => {
                found.remove(partner);
            }
            None => found.push((term, sum)),
        }
    }
    match found.len() == count {
        true => Vec::new(),
        false => found,
    }
}

/// A term and its reverse, if their sum is not a total difference.
fn left_over(x: &Inputs, term: &Expr) -> Option<Expr> {
    let action = action_of(x, term);
    let symmetric = |a: &Action| reversed(x, a).is_some_and(|r| r.is_symmetric());
    let special = x.for_symmetric_matrices(&action);
    if symmetric(&action) || special.is_some_and(|a| symmetric(&a)) {
        return None;
    }
    let sum = reversal::sum(x.spec, &action);
    (!difference::is_total(x, &sum)).then_some(sum)
}

/// The reversal of an action; `None` if the work limit was reached.
fn reversed(x: &Inputs, action: &Action) -> Option<Reversal> {
    let algebra = x.engine();
    let found = reversal::reversal(x.spec, action, x.assumed, &algebra);
    (!algebra.exhausted()).then_some(found)
}
