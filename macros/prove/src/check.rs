//! Re-checks an explanation independently of the graph that found it. Every step must apply one rule at one position,
//! with its conditions true for the terms in the explanation. The check shares no state with the search. (egg's own
//! check panics on a mistake, and ignores unknown rules and conditions.)

use super::conditions::{Value, View, decide, put};
use super::language::{Term, shape};
use super::rulebook::Rule;
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::Shape;
use egg::{ENodeOrVar, FlatTerm, Id, Language, PatternAst, RecExpr, Var};
use std::collections::BTreeMap;

type Bindings<'a> = BTreeMap<Var, &'a FlatTerm<Term>>;

/// Checks that the rules lead from `left` to `right` along the chain; the error names the step that fails.
pub fn check(
    chain: &[FlatTerm<Term>],
    left: &RecExpr<Term>,
    right: &RecExpr<Term>,
    rules: &[Rule],
) -> Result<(), String> {
    let begins = chain
        .first()
        .is_some_and(|t| is_written(t, left, left.root()));
    let ends = chain
        .last()
        .is_some_and(|t| is_written(t, right, right.root()));
    if !begins || !ends {
        return Err("the explanation does not join the two sides".into());
    }
    if chain.first().is_some_and(|t| changes(t) != 0) {
        return Err("the explanation does not begin with a side".into());
    }
    for (i, (before, after)) in chain.iter().zip(chain.iter().skip(1)).enumerate() {
        if changes(after) != 1 {
            return Err(format!("step {} does not use exactly one rule", i + 1));
        }
        step(before, after, rules).map_err(|e| format!("step {}: {e}", i + 1))?;
    }
    Ok(())
}

/// The name of the rule that produced a term, and whether it was applied from right to left.
pub fn rule_of(term: &FlatTerm<Term>) -> Option<(String, bool)> {
    if let Some(name) = term.forward_rule {
        return Some((name.to_string(), false));
    }
    if let Some(name) = term.backward_rule {
        return Some((name.to_string(), true));
    }
    term.children.iter().find_map(rule_of)
}

fn changes(term: &FlatTerm<Term>) -> usize {
    let here = usize::from(term.forward_rule.is_some()) + usize::from(term.backward_rule.is_some());
    term.children.iter().map(changes).sum::<usize>() + here
}

fn is_written(term: &FlatTerm<Term>, whole: &RecExpr<Term>, at: Id) -> bool {
    let Some(node) = whole.as_ref().get(usize::from(at)) else {
        return false;
    };
    node.matches(&term.node)
        && node.children().len() == term.children.len()
        && node
            .children()
            .iter()
            .zip(&term.children)
            .all(|(id, child)| is_written(child, whole, *id))
}

fn same(a: &FlatTerm<Term>, b: &FlatTerm<Term>) -> bool {
    a.node.matches(&b.node)
        && a.children.len() == b.children.len()
        && a.children.iter().zip(&b.children).all(|(x, y)| same(x, y))
}

fn step(before: &FlatTerm<Term>, after: &FlatTerm<Term>, rules: &[Rule]) -> Result<(), String> {
    let rule = |name: &str| {
        rules
            .iter()
            .find(|r| r.name == name)
            .ok_or_else(|| format!("`{name}` is no rule"))
    };
    if let Some(name) = after.forward_rule {
        return apply(rule(name.as_str())?, before, after);
    }
    if let Some(name) = after.backward_rule {
        return apply(rule(name.as_str())?, after, before);
    }
    if !before.node.matches(&after.node) || before.children.len() != after.children.len() {
        return Err("a term changes where no rule is used".into());
    }
    for (x, y) in before.children.iter().zip(&after.children) {
        if changes(y) != 0 {
            step(x, y, rules)?;
        } else if !same(x, y) {
            return Err("a term changes where no rule is used".into());
        }
    }
    Ok(())
}

/// The terms bound to the variables of a rule, as conditions see them.
struct Bound<'a> {
    bindings: &'a Bindings<'a>,
    root: &'a FlatTerm<Term>,
}

impl View for Bound<'_> {
    fn shape(&self, v: Var) -> Option<Shape> {
        shape_of(self.bindings.get(&v)?)
    }

    fn number(&self, v: Var) -> Option<Rational> {
        match &self.bindings.get(&v)?.node {
            Term::Number(q) => Some(q.0),
            _ => None,
        }
    }

    fn whole(&self) -> Option<Shape> {
        shape_of(self.root)
    }
}

fn shape_of(term: &FlatTerm<Term>) -> Option<Shape> {
    let operands: Option<Vec<Shape>> = term.children.iter().map(shape_of).collect();
    shape(&term.node, &operands?)
}

fn apply(rule: &Rule, from: &FlatTerm<Term>, to: &FlatTerm<Term>) -> Result<(), String> {
    let refuse = |what: &str| Err(format!("{what} of `{}` does not fit", rule.name));
    let mut bindings = Bindings::new();
    if !fits(&rule.left, rule.left.root(), from, &mut bindings) {
        return refuse("the left-hand side");
    }
    let view = Bound {
        bindings: &bindings,
        root: from,
    };
    let Some(values) = decide(&rule.given, &view) else {
        return refuse("a condition");
    };
    // The bindings of the term must agree with the values that the rule computes.
    let computed: Vec<(Var, Value)> = values
        .into_iter()
        .filter(|(v, _)| !bindings.contains_key(v))
        .collect();
    let right = put(&rule.right, &computed);
    if !fits(&right, right.root(), to, &mut bindings) {
        return refuse("the right-hand side");
    }
    if shape_of(to).is_none() || shape_of(to) != shape_of(from) {
        return refuse("the shape");
    }
    Ok(())
}

/// Whether the term is an instance of the pattern; binds each variable at its first occurrence.
fn fits<'a>(
    pattern: &PatternAst<Term>,
    at: Id,
    term: &'a FlatTerm<Term>,
    bindings: &mut Bindings<'a>,
) -> bool {
    match pattern.as_ref().get(usize::from(at)) {
        None => false,
        Some(ENodeOrVar::Var(v)) => match bindings.get(v) {
            Some(bound) => same(bound, term),
            None => bindings.insert(*v, term).is_none(),
        },
        Some(ENodeOrVar::ENode(node)) => {
            node.matches(&term.node)
                && node.children().len() == term.children.len()
                && node
                    .children()
                    .iter()
                    .zip(&term.children)
                    .all(|(id, child)| fits(pattern, *id, child, bindings))
        }
    }
}
