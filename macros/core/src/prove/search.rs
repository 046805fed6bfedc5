//! Equality saturation within bounds: rules are applied to all known terms at once until both
//! sides fall together or a bound is reached. Takes two terms and rules, gives the chain of
//! rewritten terms from one to the other, or why there is none. Counts decide, not the clock.

use super::Limits;
use super::conditions::{Join, Value, View, decide, put};
use super::language::{Facts, Term};
use super::rulebook::Rule;
use super::rules::Group;
use crate::algebra::Rational;
use crate::expr::shape::Shape;
use core::time::Duration;
use egg::{
    Applier, BackoffScheduler, EGraph, FlatTerm, Id, Pattern, PatternAst, RecExpr, Rewrite, Runner,
    StopReason, Subst, Symbol, Var,
};
use std::time::Instant;

/// The rounds of a search: multiply out in the order as written; then let sums change order;
/// then everything at once. Reordering n summands makes about 3^n terms and must not be
/// multiplied out again, hence the order of rounds.
const ROUNDS: [&[Group]; 5] = [
    &[Group::Plain, Group::Linear],
    &[Group::Plain, Group::Linear, Group::Turn],
    &[Group::Plain, Group::Nest],
    &[Group::Plain, Group::Turn, Group::Order],
    &[
        Group::Plain,
        Group::Linear,
        Group::Turn,
        Group::Nest,
        Group::Order,
    ],
];

/// Matches of one rule in one iteration beyond which the rule has to pause: keeps the overshoot
/// of the node limit small.
const MATCHES: usize = 4_000;

/// How a search ended.
pub struct Found {
    /// The terms from the left to the right side, each but the first with the rule that made it.
    pub chain: Option<Vec<FlatTerm<Term>>>,
    /// Why the search ended.
    pub end: String,
    /// Terms held at the end.
    pub nodes: usize,
    /// Iterations of all rounds.
    pub iterations: usize,
}

/// A rule with conditions, as egg applies it.
struct Conditional {
    rule: Rule,
}

/// Sight of a match.
struct Matched<'a> {
    graph: &'a EGraph<Term, Facts>,
    found: &'a Subst,
    root: Id,
}

impl View for Matched<'_> {
    fn shape(&self, v: Var) -> Option<Shape> {
        self.graph[*self.found.get(v)?].data.shape
    }

    fn number(&self, v: Var) -> Option<Rational> {
        self.graph[*self.found.get(v)?].data.number
    }

    fn whole(&self) -> Option<Shape> {
        self.graph[self.root].data.shape
    }

    fn itself(&self, v: Var) -> Option<bool> {
        let found = self.graph.find(*self.found.get(v)?);
        Some(found == self.graph.find(self.root))
    }

    fn zero(&self, v: Var) -> Option<bool> {
        let class = &self.graph[*self.found.get(v)?];
        let zero = |node: &Term| matches!(node, Term::Zero(_));
        Some(class.data.number.is_some_and(Rational::is_zero) || class.nodes.iter().any(zero))
    }

    fn multiples(&self, a: Option<Var>, b: Var) -> Option<bool> {
        let a = match a {
            Some(v) => *self.found.get(v)?,
            None => self.root,
        };
        let (a, b) = (self.lines(a), self.lines(*self.found.get(b)?));
        Some(a.iter().any(|id| b.contains(id)))
    }

    fn undivided(&self, join: Join, a: Var, b: Var) -> Option<bool> {
        let pair = [*self.found.get(a)?, *self.found.get(b)?];
        let joined = self.graph.lookup(match join {
            Join::Sum => Term::Sum(pair),
            Join::Scale => Term::Scale(pair),
            Join::Product => Term::Product(pair),
        })?;
        let has = |id: Id, test: &dyn Fn(&Term) -> bool| self.graph[id].nodes.iter().any(test);
        let leaf = |id: Id| has(id, &|node| matches!(node, Term::Leaf(_)));
        let whole = has(joined, &|node| match node {
            Term::Leaf(_) | Term::Number(_) | Term::Identity(_) | Term::Zero(_) => true,
            Term::Power(_) => true,
            Term::Transpose(a) | Term::Inverse(a) => leaf(*a),
            _ => false,
        });
        // `x + (-x + y)`: a part that holds the whole again.
        let again = |node: &Term| match (join, node) {
            (Join::Sum, Term::Sum(parts))
            | (Join::Scale, Term::Scale(parts))
            | (Join::Product, Term::Product(parts)) => {
                parts.iter().any(|id| self.graph.find(*id) == joined)
            }
            _ => false,
        };
        Some(whole || pair.iter().any(|id| has(*id, &again)))
    }

    fn sum(&self, v: Option<Var>) -> Option<bool> {
        let id = match v {
            Some(v) => *self.found.get(v)?,
            None => self.root,
        };
        // `a + 0` or `a/2 + a/2` does not make a sum of `a`.
        let own = self.lines(id);
        let part = |id: &Id| own.contains(&self.graph.find(*id));
        Some(self.graph[id].nodes.iter().any(|node| match node {
            Term::Sum([a, b]) => !part(a) && !part(b),
            _ => false,
        }))
    }
}

impl Matched<'_> {
    /// The class itself and all that it is known to be a multiple of.
    fn lines(&self, id: Id) -> Vec<Id> {
        let id = self.graph.find(id);
        let scaled = self.graph[id].nodes.iter().filter_map(|node| match node {
            Term::Scale([s, a]) if self.graph[*s].data.number.is_some() => {
                Some(self.graph.find(*a))
            }
            _ => None,
        });
        core::iter::once(id).chain(scaled).collect()
    }
}

impl Conditional {
    fn values(
        &self,
        graph: &EGraph<Term, Facts>,
        root: Id,
        found: &Subst,
    ) -> Option<Vec<(Var, Value)>> {
        decide(&self.rule.given, &Matched { graph, found, root })
    }
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
        let Some(values) = self.values(graph, root, found) else {
            return Vec::new();
        };
        // Numbers stand literally on both sides, so that the step can be read and checked alone.
        let left = put(&self.rule.left, &values);
        let right = put(&self.rule.right, &values);
        let (id, changed) = graph.union_instantiations(&left, &right, found, name);
        if changed { vec![id] } else { Vec::new() }
    }
}

fn rewrite(rule: &Rule) -> Result<Rewrite<Term, Facts>, String> {
    let searcher = Pattern::new(rule.left.clone());
    let name = rule.name.as_str();
    if rule.given.is_empty() {
        Rewrite::new(name, searcher, Pattern::new(rule.right.clone()))
    } else {
        Rewrite::new(name, searcher, Conditional { rule: rule.clone() })
    }
}

/// Looks for a chain of rules from `left` to `right`. The same input gives the same answer,
/// unless the clock, the last safety, runs out.
pub fn search(
    left: &RecExpr<Term>,
    right: &RecExpr<Term>,
    rules: &[Rule],
    limits: &Limits,
) -> Result<Found, String> {
    let start = Instant::now();
    let mut rewrites = Vec::new();
    for rule in rules {
        rewrites.push((rule.group, rewrite(rule)?));
    }
    let mut graph = EGraph::new(Facts).with_explanations_enabled();
    let (a, b) = (graph.add_expr(left), graph.add_expr(right));
    let mut iterations = 0usize;
    let mut end = String::new();
    for groups in ROUNDS {
        let left_over = limits.iterations.saturating_sub(iterations);
        let time = Duration::from_secs(limits.seconds).saturating_sub(start.elapsed());
        let runner: Runner<Term, Facts> = Runner::new(Facts)
            .with_egraph(graph)
            .with_iter_limit(left_over)
            .with_node_limit(limits.nodes)
            .with_time_limit(time)
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
        let limit = |what: &str| format!("the two sides were not joined within the {what} limit");
        end = match reason {
            Some(StopReason::NodeLimit(_)) => limit("node"),
            Some(StopReason::TimeLimit(_)) => limit("time"),
            Some(StopReason::IterationLimit(_)) => limit("iteration"),
            _ => "every term the rules reach was reached, and the two sides were not joined".into(),
        };
        if !matches!(reason, Some(StopReason::Saturated)) {
            break;
        }
    }
    let nodes = graph.total_number_of_nodes();
    let chain = (graph.find(a) == graph.find(b)).then(|| {
        let mut explanation = graph.explain_equivalence(left, right);
        explanation.make_flat_explanation().clone()
    });
    Ok(Found {
        chain,
        end,
        nodes,
        iterations,
    })
}
