//! Conditions of a rule on its variables, and values that it computes from them. They are decided twice: on classes
//! during the search, and on the terms of an explanation during the check.

use super::language::{Leaf, Number, Term};
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::{Dim, Shape, Structure};
use egg::{ENodeOrVar, Id, Language, PatternAst, RecExpr, Var};

/// A predicate on structures.
pub type Structured = fn(Structure) -> bool;

/// One condition or computation on the variables of a rule.
#[derive(Clone, Copy, Debug)]
pub enum RuleCondition<V> {
    /// A letter with `A^T = A`.
    Symmetric(V),
    /// A letter with `A^T = -A`.
    Skew(V),
    /// A diagonal letter.
    Diagonal(V),
    /// A letter of SO(n).
    Orthogonal(V),
    /// 1 x 1.
    Scalar(V),
    /// n x 1 with n not 1.
    Vector(V),
    /// n x 1, where n may be 1.
    Column(V),
    /// n x m with m not 1.
    Wide(V),
    /// As many rows as columns.
    Square(V),
    /// The product of the two is 1 x 1.
    Bilinear(V, V),
    /// An exact number, taken literally.
    Number(V),
    /// An integer; its variable already has a `Number` condition.
    Whole(V),
    /// The first is the sum of the other two numbers.
    Plus(V, V, V),
    /// The first is one more than the second.
    After(V, V),
    /// The first is the product of the other two numbers.
    Times(V, V, V),
    /// The first is the second raised to the integer power of the third.
    Raised(V, V, V),
    /// The first is the number of rows of the second, if that is a number.
    Rows(V, V),
    /// The zero of the shape of the left-hand side.
    Zero(V),
    /// The identity matrix of the shape of the left-hand side.
    Identity(V),
}

/// The value substituted for a variable before a rule is applied.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Value {
    /// A number.
    Number(Rational),
    /// The zero of a shape.
    Zero(Shape),
    /// The identity matrix.
    Identity(Dim),
    /// A leaf of the statement.
    Leaf(Leaf),
}

/// The bindings of the variables of a rule.
pub trait View {
    /// The shape of a variable's binding.
    fn shape(&self, v: Var) -> Option<Shape>;
    /// Its value, if it is a number.
    fn number(&self, v: Var) -> Option<Rational>;
    /// The shape of the left-hand side.
    fn whole(&self) -> Option<Shape>;
}

impl<V: Copy> RuleCondition<V> {
    /// The variable and its required structure, if the condition concerns a letter.
    pub fn letter(&self) -> Option<(V, Structured)> {
        match *self {
            RuleCondition::Symmetric(v) => Some((v, Structure::is_symmetric)),
            RuleCondition::Skew(v) => Some((v, |s| s == Structure::Skew)),
            RuleCondition::Diagonal(v) => Some((v, |s| s == Structure::Diagonal)),
            RuleCondition::Orthogonal(v) => Some((v, |s| s == Structure::Orthogonal)),
            _ => None,
        }
    }

    /// The condition with renamed variables, or the first error of `f`.
    pub fn renamed<W, E>(&self, f: impl Fn(V) -> Result<W, E>) -> Result<RuleCondition<W>, E> {
        Ok(match *self {
            RuleCondition::Symmetric(a) => RuleCondition::Symmetric(f(a)?),
            RuleCondition::Skew(a) => RuleCondition::Skew(f(a)?),
            RuleCondition::Diagonal(a) => RuleCondition::Diagonal(f(a)?),
            RuleCondition::Orthogonal(a) => RuleCondition::Orthogonal(f(a)?),
            RuleCondition::Scalar(a) => RuleCondition::Scalar(f(a)?),
            RuleCondition::Vector(a) => RuleCondition::Vector(f(a)?),
            RuleCondition::Column(a) => RuleCondition::Column(f(a)?),
            RuleCondition::Wide(a) => RuleCondition::Wide(f(a)?),
            RuleCondition::Square(a) => RuleCondition::Square(f(a)?),
            RuleCondition::Bilinear(a, b) => RuleCondition::Bilinear(f(a)?, f(b)?),
            RuleCondition::Number(a) => RuleCondition::Number(f(a)?),
            RuleCondition::Whole(a) => RuleCondition::Whole(f(a)?),
            RuleCondition::Plus(r, a, b) => RuleCondition::Plus(f(r)?, f(a)?, f(b)?),
            RuleCondition::After(r, a) => RuleCondition::After(f(r)?, f(a)?),
            RuleCondition::Times(r, a, b) => RuleCondition::Times(f(r)?, f(a)?, f(b)?),
            RuleCondition::Raised(r, a, b) => RuleCondition::Raised(f(r)?, f(a)?, f(b)?),
            RuleCondition::Rows(r, a) => RuleCondition::Rows(f(r)?, f(a)?),
            RuleCondition::Zero(a) => RuleCondition::Zero(f(a)?),
            RuleCondition::Identity(a) => RuleCondition::Identity(f(a)?),
        })
    }
}

/// Decides the conditions in order. `None` if one fails; otherwise the values of the variables that are literal or
/// computed.
pub fn decide(given: &[RuleCondition<Var>], view: &impl View) -> Option<Vec<(Var, Value)>> {
    let shape = |v: Var| view.shape(v);
    let number = |v: Var| view.number(v);
    let literal = |v: Var, q: Rational| Some((v, Value::Number(q)));
    let mut values: Vec<(Var, Value)> = Vec::new();
    for condition in given {
        let mut holds = true;
        let value = match *condition {
            // Letters were substituted when the rule was made for this statement.
            RuleCondition::Symmetric(_)
            | RuleCondition::Skew(_)
            | RuleCondition::Diagonal(_)
            | RuleCondition::Orthogonal(_) => None,
            RuleCondition::Scalar(v) => {
                holds = shape(v)?.is_scalar();
                None
            }
            RuleCondition::Vector(v) => {
                holds = shape(v)?.is_vector();
                None
            }
            RuleCondition::Column(v) => {
                holds = shape(v)?.cols == Dim::Fixed(1);
                None
            }
            RuleCondition::Wide(v) => {
                holds = shape(v)?.cols != Dim::Fixed(1);
                None
            }
            RuleCondition::Square(v) => {
                holds = shape(v)?.is_square();
                None
            }
            RuleCondition::Bilinear(a, b) => {
                holds = shape(a)?.rows == Dim::Fixed(1) && shape(b)?.cols == Dim::Fixed(1);
                None
            }
            RuleCondition::Whole(v) => {
                holds = number(v)?.as_integer().is_some();
                None
            }
            RuleCondition::Number(v) => literal(v, number(v)?),
            RuleCondition::Plus(r, a, b) => literal(r, number(a)?.plus(number(b)?)?),
            RuleCondition::After(r, a) => literal(r, number(a)?.plus(Rational::ONE)?),
            RuleCondition::Times(r, a, b) => literal(r, number(a)?.times(number(b)?)?),
            RuleCondition::Raised(r, a, b) => {
                literal(r, number(a)?.power(number(b)?.as_integer()?)?)
            }
            RuleCondition::Rows(r, a) => match shape(a)?.rows {
                Dim::Fixed(n) => literal(r, Rational::integer(i64::from(n))),
                Dim::Named(_) => return None,
            },
            RuleCondition::Zero(v) => Some((v, Value::Zero(view.whole()?))),
            RuleCondition::Identity(v) => Some((v, Value::Identity(view.whole()?.rows))),
        };
        if !holds {
            return None;
        }
        values.extend(value);
    }
    Some(values)
}

impl Value {
    fn add_to(self, pattern: &mut PatternAst<Term>) -> Id {
        let mut add = |node: Term| pattern.add(ENodeOrVar::ENode(node));
        match self {
            Value::Number(q) => add(Term::Number(Number(q))),
            Value::Leaf(leaf) => add(Term::Leaf(leaf)),
            // A 1 x 1 zero or identity is always written as a number.
            Value::Zero(s) if s.is_scalar() => add(Term::Number(Number(Rational::ZERO))),
            Value::Identity(Dim::Fixed(1)) => add(Term::Number(Number(Rational::ONE))),
            Value::Zero(s) => {
                let n = add(Term::Leaf(Leaf::Size(s.rows)));
                let m = add(Term::Leaf(Leaf::Size(s.cols)));
                add(Term::Zero([n, m]))
            }
            Value::Identity(dim) => {
                let n = add(Term::Leaf(Leaf::Size(dim)));
                add(Term::Identity(n))
            }
        }
    }
}

/// The pattern with variables replaced by their values.
pub fn put(pattern: &PatternAst<Term>, values: &[(Var, Value)]) -> PatternAst<Term> {
    let mut out: PatternAst<Term> = RecExpr::default();
    let mut places: Vec<Id> = Vec::new();
    for node in pattern.as_ref() {
        let place = match node {
            ENodeOrVar::Var(v) => match values.iter().find(|(w, _)| w == v) {
                Some((_, value)) => value.add_to(&mut out),
                None => out.add(ENodeOrVar::Var(*v)),
            },
            ENodeOrVar::ENode(n) => {
                let moved = n
                    .clone()
                    .map_children(|c| places.get(usize::from(c)).copied().unwrap_or(c));
                out.add(ENodeOrVar::ENode(moved))
            }
        };
        places.push(place);
    }
    out
}
