//! Assumptions without content: all choices of the parameters satisfy them, or none. Takes the assumptions; gives
//! warnings. That an equation always holds is proved. All else is tried from fixed starts over twelve orders of
//! magnitude, which may fail for very narrow bounds.

use super::draw::{self, Draw};
use super::feasible::{Budget, Condition, Problem};
use super::{Inputs, Topic, Warning};
use crate::algebra::exact;
use crate::check::spec::Assumption;
use crate::diagnostic::Diagnostic;
use crate::expr::range::range;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr};
use crate::interpret::Assignment;
use crate::syntax::ast::Comparison;

/// The limit on nodes evaluated for the assumptions of one model.
const NODES: u64 = 200_000;

/// The number of starts that are tried.
const STARTS: u64 = 16;

/// The warnings.
pub(super) fn assumptions(x: &Inputs) -> Vec<Warning> {
    let s = &x.spec.symbols;
    let budget = Budget::new(NODES);
    let mut out = Vec::new();
    let mut sound = Vec::new();
    for a in &x.spec.assumptions {
        let text = shown(x, a);
        if always(s, a, &budget) {
            let d = Diagnostic::new(a.place, format!("the assumption {text} always holds"));
            let d = d.help("remove it, or state the condition that you mean");
            out.push(Warning::new(Topic::Assumption, d));
        } else if never(s, &[a], &budget) {
            let d = Diagnostic::new(
                a.place,
                format!(
                    "the assumption {text} never holds: every choice of the parameters will be rejected"
                ),
            );
            let d = d.help("state a condition that some parameters satisfy");
            out.push(Warning::new(Topic::Assumption, d));
        } else {
            sound.push(a);
        }
    }
    for count in 2..=sound.len() {
        if never(s, &sound[..count], &budget) {
            let last = sound[count - 1];
            let d = Diagnostic::new(
                last.place,
                format!(
                    "the assumption {} never holds together with the assumptions before it: every choice of the parameters \
                     will be rejected",
                    shown(x, last)
                ),
            )
            .help("remove or change one of them");
            out.push(Warning::new(Topic::Assumption, d));
            break;
        }
    }
    out
}

/// Values near the given ones that the assumptions admit; otherwise the given values.
pub(super) fn admitted(x: &Inputs, values: Assignment) -> Option<Assignment> {
    if x.spec.assumptions.is_empty() {
        return Some(values);
    }
    let s = &x.spec.symbols;
    let budget = Budget::new(NODES / 10);
    let list = x.spec.assumptions.iter();
    let conditions: Vec<Condition> = list.map(|a| Condition::of(s, a)).collect();
    Problem::new(s, &conditions, &budget)?.solve(&values)
}

fn shown(x: &Inputs, a: &Assumption) -> String {
    let relation = match a.relation {
        Comparison::Equal => "==",
        Comparison::Greater => ">",
        Comparison::AtLeast => ">=",
        Comparison::Less => "<",
        Comparison::AtMost => "<=",
    };
    format!("`{} {relation} {}`", x.text(&a.left), x.text(&a.right))
}

/// Whether the ranges of functions show that the assumption always holds; underflow would contradict this
/// numerically.
fn by_range(left: &Expr, relation: Comparison, right: &Expr) -> bool {
    if !left.shape().is_scalar() {
        return false;
    }
    let r = range(&expr::sub(left.clone(), right.clone()));
    match relation {
        Comparison::Equal => false,
        Comparison::Greater => r.is_positive(),
        Comparison::AtLeast => r.is_not_negative(),
        Comparison::Less => r.is_negative(),
        Comparison::AtMost => r.is_not_positive(),
    }
}

fn always(s: &Symbols, a: &Assumption, budget: &Budget) -> bool {
    if by_range(&a.left, a.relation, &a.right) {
        return true;
    }
    let Some(opposite) = Condition::opposite(s, a) else {
        return exact::vanishes(s, &expr::sub(a.left.clone(), a.right.clone()));
    };
    fails(s, &[opposite], budget)
}

fn never(s: &Symbols, list: &[&Assumption], budget: &Budget) -> bool {
    let beyond = |a: &&Assumption| match a.relation.opposite() {
        Some(opposite) => by_range(&a.left, opposite, &a.right),
        None => {
            by_range(&a.left, Comparison::Greater, &a.right)
                || by_range(&a.left, Comparison::Less, &a.right)
        }
    };
    if list.iter().any(beyond) {
        return true;
    }
    let conditions: Vec<Condition> = list.iter().map(|a| Condition::of(s, a)).collect();
    fails(s, &conditions, budget)
}

/// Whether no start leads to values that satisfy all conditions; `false` if this is undecided.
fn fails(s: &Symbols, conditions: &[Condition], budget: &Budget) -> bool {
    let Some(problem) = Problem::new(s, conditions, budget) else {
        return false;
    };
    let found = (0..STARTS).any(|seed| {
        let values = start(s, problem.letters(), seed);
        problem.holds(&values) || problem.solve(&values).is_some()
    });
    !found && !budget.is_spent()
}

/// The values of a start: as a user would give them, zero, one, and values of either sign over twelve orders of
/// magnitude.
fn start(s: &Symbols, letters: &[SymbolId], seed: u64) -> Assignment {
    let mut source = Draw::new(seed.wrapping_mul(977));
    let mut values = draw::nothing(s);
    for id in letters {
        let symbol = s.get(*id);
        let mut data = draw::natural(s, *id, 1.0, &mut source);
        let group = symbol.structure.is_invertible();
        if !group && seed == 1 {
            data.iter_mut().for_each(|v| *v = 0.0);
        } else if !group && seed > 3 {
            let factor = 10f64.powf(6.0 * source.number());
            let sign = if source.number() < 0.0 { -1.0 } else { 1.0 };
            data.iter_mut().for_each(|v| *v *= sign * factor);
        } else if symbol.shape.is_scalar() && seed == 2 {
            data.iter_mut().for_each(|v| *v = 1.0);
        }
        let (rows, cols) = (
            draw::size(s, symbol.shape.rows),
            draw::size(s, symbol.shape.cols),
        );
        values.set(&symbol.name, 0, rows, cols, &data);
    }
    values
}
