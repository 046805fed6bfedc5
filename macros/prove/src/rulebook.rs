//! The rules for one statement: the general rules, and the rules that follow from the structure of its letters
//! (`g g^T = 1` for a rotation g). Every rule has a unique name.

use super::conditions::{RuleCondition, Structured, Value, put};
use super::language::{Leaf, Term};
use super::rules::{Group, Row, TABLE};
use super::worth::Worth;
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::Dim;
use clebsch_core::expr::symbol::Symbols;
use egg::{PatternAst, Var};

/// A rule in usable form.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Unique name; it contains the letter if the rule holds for one letter only.
    pub name: String,
    /// The group that determines the rounds of the search in which it is used.
    pub group: Group,
    /// Left-hand side.
    pub left: PatternAst<Term>,
    /// Right-hand side.
    pub right: PatternAst<Term>,
    /// Its conditions and computations.
    pub given: Vec<RuleCondition<Var>>,
    /// When the search should apply it.
    pub worth: Vec<Worth<Var>>,
}

/// All rules for a statement with these leaves, sorted and without repetition. An error names the unreadable line of
/// the table.
pub fn rules(symbols: &Symbols, leaves: &[Leaf]) -> Result<Vec<Rule>, String> {
    let mut out = Vec::new();
    for (group, rows) in TABLE {
        for row in rows {
            instances(symbols, leaves, group, row, &mut out)?;
        }
    }
    unit_rules(leaves, &mut out)?;
    // Two symbols may print alike, but names of rules must be unique.
    for i in 1..out.len() {
        let (before, rest) = out.split_at_mut(i);
        if let Some(rule) = rest.first_mut()
            && before.iter().any(|r| r.name == rule.name)
        {
            rule.name = format!("{} #{i}", rule.name);
        }
    }
    Ok(out)
}

fn pattern(name: &str, text: &str) -> Result<PatternAst<Term>, String> {
    text.parse()
        .map_err(|e| format!("rule `{name}` is not readable: {e}"))
}

fn variable(name: &str, text: &str) -> Result<Var, String> {
    text.parse()
        .map_err(|e| format!("rule `{name}` is not readable: {e}"))
}

/// Instances of a row for every choice of distinct letters that satisfy its conditions.
fn instances(
    symbols: &Symbols,
    leaves: &[Leaf],
    group: Group,
    (name, left, right, given, when): &Row,
    out: &mut Vec<Rule>,
) -> Result<(), String> {
    let (left, right) = (pattern(name, left)?, pattern(name, right)?);
    let mut wanted: Vec<(Var, Structured)> = Vec::new();
    let mut rest: Vec<RuleCondition<Var>> = Vec::new();
    for condition in *given {
        match condition.letter() {
            Some((v, has)) => wanted.push((variable(name, v)?, has)),
            None => rest.push(condition.renamed(|v| variable(name, v))?),
        }
    }
    let mut worth: Vec<Worth<Var>> = Vec::new();
    for w in *when {
        worth.push(w.renamed(|v| variable(name, v))?);
    }
    let mut choices: Vec<Vec<(Var, Leaf)>> = vec![Vec::new()];
    for (v, has) in wanted {
        let mut longer = Vec::new();
        for choice in choices {
            for leaf in leaves {
                let Leaf::Letter(at, shape) = *leaf else {
                    continue;
                };
                let fits = shape.is_square() && has(symbols.get(at.symbol).structure);
                if fits && choice.iter().all(|(_, l)| l != leaf) {
                    let mut next = choice.clone();
                    next.push((v, *leaf));
                    longer.push(next);
                }
            }
        }
        choices = longer;
    }
    for choice in choices {
        let names: Vec<String> = choice
            .iter()
            .map(|(_, l)| super::notation::leaf(symbols, *l))
            .collect();
        let values: Vec<(Var, Value)> = choice.iter().map(|(v, l)| (*v, Value::Leaf(*l))).collect();
        out.push(Rule {
            name: if names.is_empty() {
                (*name).to_owned()
            } else {
                format!("{name}: {}", names.join(", "))
            },
            group,
            left: put(&left, &values),
            right: put(&right, &values),
            given: rest.clone(),
            worth: worth.clone(),
        });
    }
    Ok(())
}

/// Brackets and vector products of the unit vectors in the statement.
fn unit_rules(leaves: &[Leaf], out: &mut Vec<Rule>) -> Result<(), String> {
    let (u, v, w) = (
        variable("unit vectors", "?u")?,
        variable("unit vectors", "?v")?,
        variable("unit vectors", "?w")?,
    );
    let bracket = pattern("unit vectors", "(* (T ?u) ?v)")?;
    let cross = pattern("unit vectors", "(* (hat ?u) ?v)")?;
    let (value, axial) = (pattern("", "?w")?, pattern("", "(. ?u ?w)")?);
    let units: Vec<(Dim, u8)> = leaves
        .iter()
        .filter_map(|l| match l {
            Leaf::Unit(n, axis) => Some((*n, *axis)),
            _ => None,
        })
        .collect();
    for (n, a) in &units {
        for (m, b) in units.iter().filter(|(m, _)| m == n) {
            let pair = [
                (u, Value::Leaf(Leaf::Unit(*n, *a))),
                (v, Value::Leaf(Leaf::Unit(*m, *b))),
            ];
            let delta = if a == b {
                Rational::ONE
            } else {
                Rational::ZERO
            };
            let mut rule = |name: &str, left, right| {
                out.push(Rule {
                    name: format!("{name}: {a}, {b} in dimension {n:?}"),
                    group: Group::Plain,
                    left: put(left, &pair),
                    right,
                    given: Vec::new(),
                    worth: Vec::new(),
                });
            };
            rule(
                "bracket of unit vectors",
                &bracket,
                put(&value, &[(w, Value::Number(delta))]),
            );
            // e_a x e_b = e_c for cyclic a, b, c.
            if *n == Dim::Fixed(3) && a != b && *a < 3 && *b < 3 {
                let sign = if (a + 1) % 3 == *b {
                    Rational::ONE
                } else {
                    Rational::MINUS_ONE
                };
                let third = Value::Leaf(Leaf::Unit(*n, 3 - a - b));
                let right = put(&axial, &[(u, Value::Number(sign)), (w, third)]);
                rule("cross of unit vectors", &cross, right);
            }
        }
    }
    Ok(())
}
