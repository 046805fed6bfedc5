//! Checks every rule of the table numerically, on random matrices of every combination of shapes and numbers that the
//! rule admits. Tampered explanations must be rejected.

use super::numbers::{Matrix, Sequence, value};
use super::{Desk, Limits};
use crate::conditions::{RuleCondition, View, decide, put};
use crate::language::Term;
use crate::rules::{Row, TABLE};
use crate::{check, leaves, rulebook, search, translate};
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::Shape;
use clebsch_core::expr::{mul, neg, sub};
use egg::{ENodeOrVar, PatternAst, Symbol, Var};
use std::collections::BTreeMap;

/// A candidate for a variable.
#[derive(Clone)]
struct Candidate {
    value: Matrix,
    number: Option<Rational>,
}

fn plain(value: Matrix) -> Candidate {
    Candidate {
        value,
        number: None,
    }
}

struct Sample<'a> {
    chosen: &'a BTreeMap<Var, Candidate>,
    whole: Shape,
}

impl View for Sample<'_> {
    fn shape(&self, v: Var) -> Option<Shape> {
        Some(self.chosen.get(&v)?.value.shape())
    }

    fn number(&self, v: Var) -> Option<Rational> {
        self.chosen.get(&v)?.number
    }

    fn whole(&self) -> Option<Shape> {
        Some(self.whole)
    }
}

fn candidates(given: &[RuleCondition<Var>], v: Var, random: &mut Sequence) -> Vec<Candidate> {
    let m = random.matrix(3, 3);
    for condition in given {
        match condition {
            RuleCondition::Orthogonal(w) if *w == v => return vec![plain(random.rotation())],
            RuleCondition::Symmetric(w) if *w == v => return vec![plain(m.plus(&m.transposed()))],
            RuleCondition::Skew(w) if *w == v => {
                return vec![plain(m.plus(&m.transposed().scaled(-1.0)))];
            }
            RuleCondition::Diagonal(w) if *w == v => {
                let diagonal = |i, j| if i == j { m.at(i, j) } else { 0.0 };
                return vec![plain(Matrix::from(3, 3, diagonal))];
            }
            RuleCondition::Number(w) if *w == v => {
                return [(2, 1), (-1, 1), (1, 2), (3, 1), (0, 1)]
                    .iter()
                    .map(|(n, d)| {
                        let q = Rational::new(*n, *d).unwrap();
                        Candidate {
                            value: Matrix::scalar(q.value()),
                            number: Some(q),
                        }
                    })
                    .collect();
            }
            _ => {}
        }
    }
    [(1, 1), (3, 1), (1, 3), (3, 3)]
        .iter()
        .map(|(r, c)| plain(random.matrix(*r, *c)))
        .collect()
}

/// The number of combinations of shapes and numbers that were tried, or an error if the rule fails.
fn try_row((name, left, right, given, _): &Row, random: &mut Sequence) -> Result<usize, String> {
    let left: PatternAst<Term> = left.parse().unwrap();
    let right: PatternAst<Term> = right.parse().unwrap();
    let given: Vec<RuleCondition<Var>> = given
        .iter()
        .map(|g| g.renamed(|v| v.parse::<Var>()).unwrap())
        .collect();
    let mut choices: Vec<BTreeMap<Var, Candidate>> = vec![BTreeMap::new()];
    for node in left.as_ref() {
        let ENodeOrVar::Var(v) = node else { continue };
        if choices[0].contains_key(v) {
            continue;
        }
        let options = candidates(&given, *v, random);
        choices = choices
            .iter()
            .flat_map(|c| {
                options.iter().map(|o| {
                    let mut longer = c.clone();
                    longer.insert(*v, o.clone());
                    longer
                })
            })
            .collect();
    }
    let letters: Vec<Var> = given.iter().filter_map(|g| Some(g.letter()?.0)).collect();
    let mut tried = 0;
    for chosen in choices {
        let values: BTreeMap<Var, Matrix> =
            chosen.iter().map(|(v, c)| (*v, c.value.clone())).collect();
        let Some(l) = value(&left, left.root(), &values) else {
            continue;
        };
        let view = Sample {
            chosen: &chosen,
            whole: l.shape(),
        };
        let Some(mut computed) = decide(&given, &view) else {
            continue;
        };
        if !l.data.iter().all(|x| x.is_finite()) {
            continue;
        }
        computed.retain(|(v, _)| !letters.contains(v) && !chosen.contains_key(v));
        let right = put(&right, &computed);
        let r = value(&right, right.root(), &values).ok_or(format!("{name}: shapes"))?;
        if l.shape() != r.shape() {
            return Err(format!("{name}: shapes"));
        }
        let size = l
            .data
            .iter()
            .chain(&r.data)
            .fold(1.0f64, |m, x| m.max(x.abs()));
        for (x, y) in l.data.iter().zip(&r.data) {
            // The products of a few 3 x 3 matrices make some hundred roundings; the inverse of a random matrix may
            // lose a few more digits. The comparison is not `>`, so that a right-hand side of NaN also fails.
            let close = (x - y).abs() <= 1e-10 * size;
            if !close {
                return Err(format!("{name}: {l:?} is not {r:?}"));
            }
        }
        tried += 1;
    }
    Ok(tried)
}

#[test]
fn every_rule_holds_for_numbers() {
    let mut random = Sequence(20);
    for (_, rows) in TABLE {
        for row in rows {
            let tries: Result<Vec<usize>, String> =
                (0..16).map(|_| try_row(row, &mut random)).collect();
            let tried: usize = tries.unwrap().iter().sum();
            assert!(tried > 0, "{}: no numbers fit", row.0);
        }
    }
}

#[test]
fn wrong_rules_are_noticed() {
    let wrong: [Row; 3] = [
        ("sign", "(tr (* ?a ?b))", "(. -1 (tr (* ?b ?a)))", &[], &[]),
        ("shape", "(T (* ?a ?b))", "(* (T ?a) (T ?b))", &[], &[]),
        ("domain", "(^ ?s 2)", "(exp (. 2 (log ?s)))", &[], &[]),
    ];
    for row in wrong {
        let mut random = Sequence(1);
        let tries: Result<Vec<usize>, String> =
            (0..16).map(|_| try_row(&row, &mut random)).collect();
        assert!(tries.is_err(), "{}", row.0);
    }
}

#[test]
fn tampered_explanations_are_refused() {
    let mut d = Desk::default();
    let (o, j) = (d.rotation("Ω"), d.symmetric("J"));
    let tail = sub(mul(j.clone(), d.t(&o)), mul(o.clone(), j.clone()));
    let left = mul(d.t(&o), mul(tail, o.clone()));
    let right = sub(mul(d.t(&o), j.clone()), mul(j, o));
    let (l, _) = translate::translate(&left).unwrap();
    let (r, _) = translate::translate(&right).unwrap();
    let (other, _) = translate::translate(&neg(right)).unwrap();
    let rules = rulebook::rules(&d.symbols, &leaves(&l, &r)).unwrap();
    let found = search::search(&l, &r, &rules, &Limits::default()).unwrap();
    let chain = found.chain.unwrap();
    assert_eq!(check::check(&chain, &l, &r, &rules), Ok(()));
    assert!(check::check(&chain, &l, &other, &rules).is_err());
    assert!(check::check(&chain, &r, &l, &rules).is_err());
    assert!(check::check(&[], &l, &r, &rules).is_err());
    for i in 1..chain.len() {
        let mut shorter = chain.clone();
        shorter.remove(i);
        assert!(
            check::check(&shorter, &l, &r, &rules).is_err(),
            "without step {i}"
        );
        let fewer: Vec<_> = rules
            .iter()
            .filter(|rule| Some(&rule.name) != check::rule_of(&chain[i]).map(|x| x.0).as_ref())
            .cloned()
            .collect();
        assert!(
            check::check(&chain, &l, &r, &fewer).is_err(),
            "without the rule of step {i}"
        );
    }
    let mut renamed = chain.clone();
    rename(&mut renamed[1]);
    assert!(check::check(&renamed, &l, &r, &rules).is_err());
}

/// Claims another rule for each step.
fn rename(term: &mut egg::FlatTerm<Term>) {
    let other = Some(Symbol::from("transpose twice"));
    term.forward_rule = term.forward_rule.and(other);
    term.backward_rule = term.backward_rule.and(other);
    term.children.iter_mut().for_each(rename);
}

#[test]
fn conditions_are_checked_on_the_terms() {
    let mut d = Desk::default();
    let (a, b) = (d.general("A"), d.general("B"));
    let (l, _) = translate::translate(&mul(a.clone(), b.clone())).unwrap();
    let (r, _) = translate::translate(&mul(b, a)).unwrap();
    let mut rules = rulebook::rules(&d.symbols, &leaves(&l, &r)).unwrap();
    // A rule that holds for diagonal matrices only, inserted with a condition that fails.
    let mut commute = rules[0].clone();
    commute.name = "commute".into();
    commute.left = "(* ?a ?b)".parse().unwrap();
    commute.right = "(* ?b ?a)".parse().unwrap();
    let scalar = RuleCondition::Scalar("?a".parse().unwrap());
    for (given, holds) in [(vec![], true), (vec![scalar], false)] {
        commute.given = given;
        rules.push(commute.clone());
        let mut chain = vec![flat(&l), flat(&r)];
        chain[1].forward_rule = Some(Symbol::from("commute"));
        assert_eq!(check::check(&chain, &l, &r, &rules).is_ok(), holds);
        rules.pop();
    }
}

fn flat(term: &egg::RecExpr<Term>) -> egg::FlatTerm<Term> {
    fn at(term: &egg::RecExpr<Term>, id: egg::Id) -> egg::FlatTerm<Term> {
        let children = egg::Language::children(&term[id])
            .iter()
            .map(|c| at(term, *c));
        egg::FlatTerm::new(term[id].clone(), children.collect())
    }
    at(term, term.root())
}
