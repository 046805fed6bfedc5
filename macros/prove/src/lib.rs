//! A second prover, by equality saturation. It shares neither normal forms nor reductions with
//! [`clebsch_core::algebra`]. For a statement `left = right` it returns a proof in which every step was re-checked,
//! or the reason why it found none. It never refutes a statement.

mod check;
mod conditions;
mod language;
mod notation;
mod rulebook;
mod rules;
mod search;
mod summands;
#[cfg(test)]
mod tests;
mod translate;
mod worth;

use clebsch_core::Derivation;
use clebsch_core::derive::certificate::Step;
use clebsch_core::expr::Expr;
use clebsch_core::expr::symbol::Symbols;
use egg::{Language, RecExpr};
use language::{Leaf, Term};

/// Runs equality saturation on every step of a derivation's certificate. Each text is a proof by named rules, or the
/// reason why none was found, which does not refute the step.
pub fn second_proof(d: &Derivation) -> Vec<String> {
    let verdict = |step: &Step| {
        let statement = Statement {
            name: step.name.clone(),
            left: step.left.clone(),
            right: step.right.clone(),
        };
        match prove(&d.letters.symbols, &statement, &Limits::default()) {
            Verdict::Proved { explanation, .. } => {
                format!(
                    "{}: proved\n       {}",
                    step.name,
                    explanation.join("\n       ")
                )
            }
            Verdict::Unproved { reason, .. } => format!("{}: unproved, {reason}", step.name),
        }
    };
    d.certificate.steps.iter().map(verdict).collect()
}

/// An equation between two expressions of equal shape, claimed for all admissible values of its letters for which
/// both sides are defined.
#[derive(Clone, Debug)]
pub struct Statement {
    /// The name of the statement in reports.
    pub name: String,
    /// Left-hand side.
    pub left: Expr,
    /// Right-hand side.
    pub right: Expr,
}

/// Limits of a search, in numbers of terms and iterations; no clock is read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Maximum number of terms in the graph.
    pub nodes: usize,
    /// Maximum number of iterations, over all rounds.
    pub iterations: usize,
    /// Maximum number of summands of a side after expansion.
    pub summands: usize,
}

impl Default for Limits {
    /// Sufficient for the identities of discrete mechanics. A statement without a proof takes about a second in an
    /// optimised build.
    fn default() -> Self {
        Limits {
            nodes: 12_000,
            iterations: 60,
            summands: 8,
        }
    }
}

/// The result of [`prove`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// The statement holds.
    Proved {
        /// The proof: the left-hand side, then one line for each step with the name of its rule. `read backwards`
        /// marks a rule applied from right to left.
        explanation: Vec<String>,
        /// Terms in the graph at the end of the search.
        nodes: usize,
        /// Iterations used.
        iterations: usize,
    },
    /// No proof was found; the statement may still be true.
    Unproved {
        /// The reason.
        reason: String,
        /// Terms in the graph at the end of the search.
        nodes: usize,
        /// Iterations used.
        iterations: usize,
    },
}

impl Verdict {
    /// Whether the statement was proved.
    pub fn is_proved(&self) -> bool {
        matches!(self, Verdict::Proved { .. })
    }
}

fn refused(reason: impl Into<String>) -> Verdict {
    Verdict::Unproved {
        reason: reason.into(),
        nodes: 0,
        iterations: 0,
    }
}

/// Tries to prove a statement. The prover uses the identities of the declared structure of each letter and no other
/// assumptions, so definitions must be substituted first.
pub fn prove(symbols: &Symbols, statement: &Statement, limits: &Limits) -> Verdict {
    let (mut left, mut right) = (statement.left.clone(), statement.right.clone());
    if left.shape() != right.shape() {
        return refused("the two sides have different shapes");
    }
    let size = |l: &Expr, r: &Expr| summands::count(l).max(summands::count(r));
    let mut removed = None;
    let before = size(&left, &right);
    if before > limits.summands && left != right {
        let (l, r, common) = summands::without_common(&left, &right);
        if size(&l, &r) > limits.summands {
            return refused(format!(
                "{} summands on a side, more than {}: their reorderings are too many to search",
                before, limits.summands
            ));
        }
        (left, right) = (l, r);
        removed = Some(common);
    }
    let (Some((l, shape)), Some((r, _))) =
        (translate::translate(&left), translate::translate(&right))
    else {
        return refused("the shapes inside the statement do not fit");
    };
    if shape != left.shape() {
        return refused("the shapes inside the statement do not fit");
    }
    let first = removed.map(|common| {
        let terms = common.iter().filter_map(translate::translate);
        let texts: Vec<String> = terms.map(|(t, _)| notation::whole(symbols, &t)).collect();
        format!(
            "{} summands stand on both sides and are taken from both ({}); what is left:",
            common.len(),
            texts.join(", ")
        )
    });
    prove_terms(symbols, &l, &r, first, limits)
}

/// Tries to prove a statement between terms of the search language.
fn prove_terms(
    symbols: &Symbols,
    left: &RecExpr<Term>,
    right: &RecExpr<Term>,
    first: Option<String>,
    limits: &Limits,
) -> Verdict {
    let rules = match rulebook::rules(symbols, &leaves(left, right)) {
        Ok(rules) => rules,
        Err(e) => return refused(e),
    };
    let found = match search::search(left, right, &rules, limits) {
        Ok(found) => found,
        Err(e) => return refused(e),
    };
    let (nodes, iterations) = (found.nodes, found.iterations);
    let unproved = |reason| Verdict::Unproved {
        reason,
        nodes,
        iterations,
    };
    let Some(chain) = found.chain else {
        return unproved(found.end);
    };
    if let Err(e) = check::check(&chain, left, right, &rules) {
        return unproved(format!("the explanation failed its re-check: {e}"));
    }
    let mut explanation: Vec<String> = first.into_iter().collect();
    for term in &chain {
        let text = notation::text(symbols, term);
        explanation.push(match check::rule_of(term) {
            None => text,
            Some((name, false)) => format!("= {text}    [{name}]"),
            Some((name, true)) => format!("= {text}    [{name}, read backwards]"),
        });
    }
    Verdict::Proved {
        explanation,
        nodes,
        iterations,
    }
}

fn leaves(left: &RecExpr<Term>, right: &RecExpr<Term>) -> Vec<Leaf> {
    let mut out: Vec<Leaf> = left
        .as_ref()
        .iter()
        .chain(right.as_ref())
        .filter_map(|node| match node {
            Term::Leaf(leaf) if node.is_leaf() => Some(*leaf),
            _ => None,
        })
        .collect();
    out.sort();
    out.dedup();
    out
}
