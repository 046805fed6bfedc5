//! Equality saturation within limits: rules are applied to all known terms at once until both sides are in one class
//! or a limit is reached. The result is the chain of rewritten terms, or the reason why there is none. The limits are
//! counts; no clock is read.

use super::Limits;
use super::conditions::{decide, put};
use super::language::{Facts, Term};
use super::rulebook::Rule;
use super::rules::Group;
use super::worth::Matched;
use core::time::Duration;
use egg::{
    Applier, BackoffScheduler, EGraph, FlatTerm, Id, Pattern, PatternAst, RecExpr, Rewrite, Runner,
    StopReason, Subst, Symbol, TreeTerm,
};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The rounds of a search; each runs until it finds nothing new. They expand products in the given order, rotate
/// products, bring nested sums to one form, and reorder summands. Reordering n summands gives about n 2^n terms,
/// which must not be expanded again, so it is the last round.
const ROUNDS: [&[Group]; 4] = [
    &[Group::Plain, Group::Linear],
    &[Group::Plain, Group::Linear, Group::Turn],
    &[Group::Plain, Group::Nest],
    &[Group::Plain, Group::Turn, Group::Order],
];

/// A rule with more matches in one iteration has to pause, which keeps the overshoot of the node limit small.
const MATCHES: usize = 4_000;

/// The maximum length of an explanation.
const STEPS: u64 = 20_000;

/// The result of a search.
pub struct SearchResult {
    /// The terms from the left to the right side; each but the first has the rule that produced it.
    pub chain: Option<Vec<FlatTerm<Term>>>,
    /// Why the search ended.
    pub end: String,
    /// Terms in the graph at the end.
    pub nodes: usize,
    /// Iterations over all rounds.
    pub iterations: usize,
}

/// A rule with conditions, as egg applies it.
struct Conditional {
    rule: Rule,
}

impl Applier<Term, Facts> for Conditional {
    fn apply_one(
        &self,
        graph: &mut EGraph<Term, Facts>,
        root: Id,
        found: &Subst,
        _: Option<&PatternAst<Term>>,
        name: Symbol,
    ) -> Vec<Id> {
        let here = Matched { graph, found, root };
        if !here.worth(&self.rule.worth) {
            return Vec::new();
        }
        let Some(values) = decide(&self.rule.given, &here) else {
            return Vec::new();
        };
        // Numbers are literal on both sides, so that the step can be read and checked alone.
        let left = put(&self.rule.left, &values);
        let right = put(&self.rule.right, &values);
        let (id, changed) = graph.union_instantiations(&left, &right, found, name);
        if changed { vec![id] } else { Vec::new() }
    }
}

fn rewrite(rule: &Rule) -> Result<Rewrite<Term, Facts>, String> {
    let searcher = Pattern::new(rule.left.clone());
    let name = rule.name.as_str();
    if rule.given.is_empty() && rule.worth.is_empty() {
        Rewrite::new(name, searcher, Pattern::new(rule.right.clone()))
    } else {
        Rewrite::new(name, searcher, Conditional { rule: rule.clone() })
    }
}

/// Searches for a chain of rules from `left` to `right`. The result is deterministic.
pub fn search(
    left: &RecExpr<Term>,
    right: &RecExpr<Term>,
    rules: &[Rule],
    limits: &Limits,
) -> Result<SearchResult, String> {
    let mut rewrites = Vec::new();
    for rule in rules {
        rewrites.push((rule.group, rewrite(rule)?));
    }
    let mut graph = EGraph::new(Facts).with_explanations_enabled();
    let (a, b) = (graph.add_expr(left), graph.add_expr(right));
    let mut iterations = 0usize;
    let mut end = String::new();
    let limit = |what: &str| format!("the two sides were not joined within the {what} limit");
    for groups in ROUNDS {
        let left_over = limits.iterations.saturating_sub(iterations);
        if left_over == 0 {
            end = limit("iteration");
            break;
        }
        let runner: Runner<Term, Facts> = Runner::new(Facts)
            .with_egraph(graph)
            .with_iter_limit(left_over)
            .with_node_limit(limits.nodes)
            // The other limits bound the work; with a time limit, the result would depend on the load of the machine.
            .with_time_limit(Duration::MAX)
            .with_scheduler(BackoffScheduler::default().with_initial_match_limit(MATCHES))
            .with_hook(move |runner| {
                let equal = runner.egraph.find(a) == runner.egraph.find(b);
                if equal { Err(String::new()) } else { Ok(()) }
            })
            .run(
                rewrites
                    .iter()
                    .filter(|(g, _)| groups.contains(g))
                    .map(|(_, r)| r),
            );
        iterations = iterations.saturating_add(runner.iterations.len());
        let reason = runner.stop_reason.clone();
        graph = runner.egraph;
        if graph.find(a) == graph.find(b) {
            break;
        }
        end = match reason {
            Some(StopReason::NodeLimit(_)) => limit("node"),
            Some(StopReason::IterationLimit(_)) => limit("iteration"),
            _ => "the rules lead to nothing new, and the two sides were not joined".into(),
        };
        if !matches!(reason, Some(StopReason::Saturated)) {
            break;
        }
    }
    let nodes = graph.total_number_of_nodes();
    let mut chain = None;
    if graph.find(a) == graph.find(b) {
        let mut explanation = graph.explain_equivalence(left, right);
        let steps = length(&explanation.explanation_trees, &mut BTreeMap::new());
        if steps > STEPS {
            end = format!("the proof has {steps} steps, too many to be written out");
        } else {
            chain = Some(without_detours(explanation.make_flat_explanation()));
        }
    }
    Ok(SearchResult {
        chain,
        end,
        nodes,
        iterations,
    })
}

/// The number of terms of an explanation in full, in which shared parts are repeated.
fn length(proof: &[Rc<TreeTerm<Term>>], known: &mut BTreeMap<*const TreeTerm<Term>, u64>) -> u64 {
    let mut total = 0u64;
    for tree in proof {
        let place = Rc::as_ptr(tree);
        let steps = match known.get(&place) {
            Some(steps) => *steps,
            None => {
                let inner = tree.child_proofs.iter().map(|p| length(p, known));
                let steps = inner.fold(1, u64::saturating_add);
                known.insert(place, steps);
                steps
            }
        };
        total = total.saturating_add(steps);
    }
    total
}

/// The chain without loops back to an earlier term.
fn without_detours(chain: &[FlatTerm<Term>]) -> Vec<FlatTerm<Term>> {
    let mut out: Vec<FlatTerm<Term>> = Vec::new();
    for term in chain {
        match out.iter().position(|seen| seen == term) {
            Some(i) => out.truncate(i + 1),
            None => out.push(term.clone()),
        }
    }
    out
}
