//! Translates expressions into terms: n-ary sums and products become nested pairs, and signs and quotients become
//! scalings. The result is `None` if shapes do not match.

use super::language::{Leaf, Number, Term, shape};
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::{Dim, Shape};
use clebsch_core::expr::{Expr, Function, Node, Part};
use egg::{Id, Language, RecExpr};

/// A term under construction, with the shapes of its subterms.
#[derive(Default)]
struct Builder {
    term: RecExpr<Term>,
    shapes: Vec<Shape>,
}

/// The term of an expression, and its shape.
pub fn translate(e: &Expr) -> Option<(RecExpr<Term>, Shape)> {
    let mut builder = Builder::default();
    let root = builder.expression(e)?;
    let shape = builder.shape_of(root)?;
    Some((builder.term, shape))
}

impl Builder {
    fn shape_of(&self, id: Id) -> Option<Shape> {
        self.shapes.get(usize::from(id)).copied()
    }

    fn add(&mut self, node: Term) -> Option<Id> {
        let operands: Option<Vec<Shape>> =
            node.children().iter().map(|c| self.shape_of(*c)).collect();
        self.shapes.push(shape(&node, &operands?)?);
        Some(self.term.add(node))
    }

    fn number(&mut self, q: Rational) -> Option<Id> {
        self.add(Term::Number(Number(q)))
    }

    fn size(&mut self, dim: Dim) -> Option<Id> {
        self.add(Term::Leaf(Leaf::Size(dim)))
    }

    fn scaled(&mut self, by: Rational, a: Id) -> Option<Id> {
        let by = self.number(by)?;
        self.add(Term::Scale([by, a]))
    }

    /// Nested to the right: `a + (b + (c + ...))`.
    fn fold(&mut self, list: &[Expr], join: fn([Id; 2]) -> Term) -> Option<Id> {
        let ids: Option<Vec<Id>> = list.iter().map(|e| self.expression(e)).collect();
        self.nest(&ids?, join)
    }

    fn nest(&mut self, ids: &[Id], join: fn([Id; 2]) -> Term) -> Option<Id> {
        let (last, before) = ids.split_last()?;
        before
            .iter()
            .rev()
            .try_fold(*last, |tail, head| self.add(join([*head, tail])))
    }

    /// Scalar factors first, then matrices in their order.
    fn product(&mut self, factors: &[Expr]) -> Option<Id> {
        let (scalars, matrices): (Vec<Expr>, Vec<Expr>) =
            factors.iter().cloned().partition(|f| f.shape().is_scalar());
        if matrices.is_empty() {
            return self.fold(&scalars, Term::Scale);
        }
        let tail = self.fold(&matrices, Term::Product)?;
        let mut ids: Vec<Id> = Vec::new();
        for s in &scalars {
            ids.push(self.expression(s)?);
        }
        ids.push(tail);
        self.nest(&ids, Term::Scale)
    }

    fn expression(&mut self, e: &Expr) -> Option<Id> {
        match e.node() {
            Node::Number(q) => self.number(*q),
            Node::Constant(c) => self.add(Term::Leaf(Leaf::Constant(*c))),
            Node::Letter(at) => self.add(Term::Leaf(Leaf::Letter(*at, e.shape()))),
            Node::Identity(n) => {
                let n = self.size(*n)?;
                self.add(Term::Identity(n))
            }
            Node::Zero(shape) if shape.is_scalar() => self.number(Rational::ZERO),
            Node::Zero(shape) => {
                let n = self.size(shape.rows)?;
                let m = self.size(shape.cols)?;
                self.add(Term::Zero([n, m]))
            }
            Node::Unit(n, axis) => self.add(Term::Leaf(Leaf::Unit(*n, *axis))),
            Node::Sum(terms) => self.fold(terms, Term::Sum),
            Node::Product(factors) => self.product(factors),
            Node::Neg(a) => {
                let a = self.expression(a)?;
                self.scaled(Rational::MINUS_ONE, a)
            }
            Node::Quotient(a, b) => {
                let a = self.expression(a)?;
                let b = self.expression(b)?;
                let exponent = self.number(Rational::MINUS_ONE)?;
                let inverse = self.add(Term::Power([b, exponent]))?;
                self.add(Term::Scale([inverse, a]))
            }
            Node::Power(a, q) => {
                let a = self.expression(a)?;
                let q = self.number(*q)?;
                self.add(Term::Power([a, q]))
            }
            Node::Transpose(a) => self.unary(a, Term::Transpose),
            Node::Inverse(a) => self.unary(a, Term::Inverse),
            Node::Trace(a) => self.unary(a, Term::Trace),
            Node::Det(a) => self.unary(a, Term::Det),
            Node::Adjugate(a) => {
                let det = self.unary(a, Term::Det)?;
                let inverse = self.unary(a, Term::Inverse)?;
                self.add(Term::Scale([det, inverse]))
            }
            Node::Dot(a, b) => self.binary(a, b, Term::Dot),
            Node::Cross(a, b) => self.binary(a, b, Term::Cross),
            Node::Hat(a) => self.unary(a, Term::Hat),
            Node::Vee(a) => self.unary(a, Term::Vee),
            Node::Part(Part::Symmetric, a) => self.unary(a, Term::Symmetric),
            Node::Part(Part::Skew, a) => self.unary(a, Term::Skew),
            Node::Part(Part::Diagonal, a) => self.unary(a, Term::Diagonal),
            Node::Call(Function::Exp, a) => self.unary(a, Term::Exp),
            Node::Call(Function::Log, a) => self.unary(a, Term::Log),
            // No rules for these exist, so that statements with them stay unproved.
            Node::Call(..)
            | Node::Inclusion(..)
            | Node::Map(..)
            | Node::Given(_)
            | Node::PullBack(..) => None,
        }
    }

    fn unary(&mut self, a: &Expr, make: fn(Id) -> Term) -> Option<Id> {
        let a = self.expression(a)?;
        self.add(make(a))
    }

    fn binary(&mut self, a: &Expr, b: &Expr, make: fn([Id; 2]) -> Term) -> Option<Id> {
        let a = self.expression(a)?;
        let b = self.expression(b)?;
        self.add(make([a, b]))
    }
}
