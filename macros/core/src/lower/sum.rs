//! Sums: differences from zero velocity first, because the two terms lose digits if they are separated.

use super::Lowering;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Map, Node};
use crate::schedule;
use clebsch_program::{Pair, Single, Value};

impl Lowering<'_> {
    pub(super) fn sum(&mut self, terms: &[Expr]) -> Value {
        if let Some(of) = self.complement(terms) {
            return self.of(Single::TraceComplement, &of);
        }
        // A leading minus sign costs an operation and reads badly: start with a positive term.
        let negative = |t: &Expr| matches!(t.node(), Node::Neg(_));
        let first = terms.iter().position(|t| !negative(t)).unwrap_or(0);
        let mut order: Vec<&Expr> = vec![&terms[first]];
        let others = terms.iter().enumerate().filter(|(i, _)| *i != first);
        order.extend(others.map(|(_, t)| t));
        let mut sum: Option<Value> = None;
        while let Some((minus, at, moving)) = self.difference(&order) {
            let moved = match moving.node() {
                Node::Map(Map::Real, a) => {
                    let moved = self.of(Single::LessIdentity, a);
                    self.one(Single::QuaternionReal, moved)
                }
                _ => self.of(Single::LessIdentity, &moving),
            };
            sum = Some(match (minus, sum) {
                (true, None) => self.one(Single::Neg, moved),
                (false, None) => moved,
                (true, Some(sum)) => self.two(Pair::Sub, sum, moved),
                (false, Some(sum)) => self.two(Pair::Add, sum, moved),
            });
            let (a, b) = at;
            order.remove(a.max(b));
            order.remove(a.min(b));
        }
        for t in order {
            sum = Some(match (t.node(), sum) {
                (Node::Neg(a), Some(sum)) => {
                    let a = self.value(a);
                    self.two(Pair::Sub, sum, a)
                }
                (_, None) => self.value(t),
                (_, Some(sum)) => {
                    let t = self.value(t);
                    self.two(Pair::Add, sum, t)
                }
            });
        }
        // A sum has at least two terms.
        sum.unwrap_or_else(|| self.rational(crate::algebra::Rational::ZERO))
    }

    /// The matrix `A` in `tr(A) Id - A`, in three dimensions.
    fn complement(&self, terms: &[Expr]) -> Option<Expr> {
        let [trace, subtracted] = terms else {
            return None;
        };
        let (Node::Product(factors), Node::Neg(a)) = (trace.node(), subtracted.node()) else {
            return None;
        };
        let [number, identity] = factors.as_slice() else {
            return None;
        };
        let (Node::Trace(x), Node::Identity(Dim::Fixed(3))) = (number.node(), identity.node())
        else {
            return None;
        };
        // The trace of the transpose is the same.
        (a == x || *a == expr::transpose(self.symbols, x.clone())).then(|| a.clone())
    }

    /// `Ω - Id` or `Id - Ω` among the terms of a sum, for orthogonal `Ω`, and `re(W) - 1`. Gives whether the letter
    /// is subtracted, the positions of the two terms, and the letter.
    fn difference(&self, terms: &[&Expr]) -> Option<(bool, (usize, usize), Expr)> {
        let plain = |e: &Expr| match e.node() {
            Node::Neg(a) => (true, a.clone()),
            _ => (false, e.clone()),
        };
        terms.iter().enumerate().find_map(|(i, t)| {
            let (minus, moving) = plain(t);
            let rest = schedule::at_rest(self.symbols, &moving)?;
            let opposite = match minus {
                true => rest,
                false => expr::neg(rest),
            };
            let j = terms.iter().position(|t| **t == opposite)?;
            Some((minus, (i, j), moving))
        })
    }
}
