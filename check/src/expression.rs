//! Expressions of the statement without their source positions. Takes expressions of the syntax tree; gives a tree that
//! this crate walks, splits and evaluates.

use clebsch_core::syntax::ast::{self, Size};
use std::collections::BTreeMap;

/// An expression.
#[derive(Clone, Debug)]
pub struct Expression {
    /// The kind of the expression.
    pub kind: Kind,
}

/// Kinds of expressions.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A quotient of integers.
    Number(i128, i128),
    /// A double.
    Constant(f64),
    /// A name.
    Name(String),
    /// An expression with a declared shape: the keyword, then rows and columns.
    Shaped(Box<Expression>, String, [usize; 2]),
    /// A sum of signed terms: `true` marks a term that is subtracted.
    Sum(Vec<(bool, Expression)>),
    /// A product in order.
    Product(Vec<Expression>),
    /// A quotient.
    Quotient(Box<Expression>, Box<Expression>),
    /// The opposite.
    Neg(Box<Expression>),
    /// The transpose.
    Transpose(Box<Expression>),
    /// A power, by numerator and denominator of the exponent.
    Power(Box<Expression>, i128, i128),
    /// A function of arguments.
    Call(String, Vec<Expression>),
    /// A component, counted from 1.
    Component(Box<Expression>, Vec<u64>),
}

/// Sizes by name.
pub type Sizes = BTreeMap<String, usize>;

impl Expression {
    /// The expression of the syntax tree.
    #[must_use]
    pub fn of(e: &ast::Expression, sizes: &Sizes) -> Self {
        let one = |e: &ast::Expression| Box::new(Self::of(e, sizes));
        let all = |list: &[ast::Expression]| list.iter().map(|e| Self::of(e, sizes)).collect();
        let kind = match &e.kind {
            ast::Kind::Number(q) => Kind::Number(q.numerator(), q.denominator()),
            ast::Kind::Constant(c) => Kind::Constant(c.value()),
            ast::Kind::Name(n) => Kind::Name(n.clone()),
            ast::Kind::Shaped(a, shape) => {
                let size = |i: usize| match shape.sizes.get(i) {
                    Some(Size::Number(n, _)) => usize::try_from(*n).ok(),
                    Some(Size::Name(n)) => sizes.get(&n.text).copied(),
                    None => None,
                };
                let rows = size(0).unwrap_or(1);
                let cols = match shape.name.text.as_str() {
                    "Vec" => 1,
                    _ => size(1).unwrap_or(rows),
                };
                Kind::Shaped(one(a), shape.name.text.clone(), [rows, cols])
            }
            ast::Kind::Sum(terms) => {
                let terms = terms.iter().map(|(minus, t)| (*minus, Self::of(t, sizes)));
                Kind::Sum(terms.collect())
            }
            ast::Kind::Product(list) => Kind::Product(all(list)),
            ast::Kind::Quotient(a, b) => Kind::Quotient(one(a), one(b)),
            ast::Kind::Neg(a) => Kind::Neg(one(a)),
            ast::Kind::Transpose(a) => Kind::Transpose(one(a)),
            ast::Kind::Power(a, q) => Kind::Power(one(a), q.numerator(), q.denominator()),
            ast::Kind::Call(f, list) => Kind::Call(f.text.clone(), all(list)),
            ast::Kind::Component(a, at) => Kind::Component(one(a), at.clone()),
        };
        Self { kind }
    }

    /// The direct operands, in order.
    #[must_use]
    pub fn parts(&self) -> Vec<&Self> {
        match &self.kind {
            Kind::Number(..) | Kind::Constant(_) | Kind::Name(_) => Vec::new(),
            Kind::Sum(terms) => terms.iter().map(|(_, t)| t).collect(),
            Kind::Product(list) | Kind::Call(_, list) => list.iter().collect(),
            Kind::Quotient(a, b) => vec![a, b],
            Kind::Neg(a)
            | Kind::Transpose(a)
            | Kind::Power(a, ..)
            | Kind::Component(a, _)
            | Kind::Shaped(a, ..) => vec![a],
        }
    }

    /// Like `parts`, by mutable reference.
    fn parts_mut(&mut self) -> Vec<&mut Self> {
        match &mut self.kind {
            Kind::Number(..) | Kind::Constant(_) | Kind::Name(_) => Vec::new(),
            Kind::Sum(terms) => terms.iter_mut().map(|(_, t)| t).collect(),
            Kind::Product(list) | Kind::Call(_, list) => list.iter_mut().collect(),
            Kind::Quotient(a, b) => vec![a, b],
            Kind::Neg(a)
            | Kind::Transpose(a)
            | Kind::Power(a, ..)
            | Kind::Component(a, _)
            | Kind::Shaped(a, ..) => vec![a],
        }
    }

    /// Visits the expression and all its parts.
    pub fn each(&self, visit: &mut dyn FnMut(&Self)) {
        visit(self);
        for part in self.parts() {
            part.each(visit);
        }
    }

    /// Whether the expression contains a name.
    pub fn has(&self, name: &str) -> bool {
        let mut found = false;
        self.each(&mut |e| found |= matches!(&e.kind, Kind::Name(n) if n == name));
        found
    }

    /// Replaces parts by the values of `of`, larger parts first; it does not search the replacements.
    pub fn replace(&mut self, of: &dyn Fn(&Self) -> Option<Self>) {
        match of(self) {
            Some(put) => *self = put,
            None => self
                .parts_mut()
                .into_iter()
                .for_each(|part| part.replace(of)),
        }
    }
}
