//! Directional derivatives: the first-order change of an expression if some letters change by given amounts. It is
//! linear in the amounts, with one rule per kind of node.

use super::letter_mask::{Marks, Memo};
use super::*;
use crate::expr::symbol::Symbols;

/// The derivative of `e` if each letter in `changes` changes by its amount and no other letter changes.
pub fn directional(symbols: &Symbols, e: &Expr, changes: &[(Letter, Expr)]) -> Expr {
    let moving = changes.iter().filter(|(_, amount)| !amount.is_zero());
    let walk = Walk {
        symbols,
        changes,
        marks: Marks::of_all(moving.map(|(l, _)| *l)),
    };
    walk.of(e, &mut Memo::default())
}

/// The data that are constant during one derivative.
struct Walk<'a> {
    symbols: &'a Symbols,
    changes: &'a [(Letter, Expr)],
    /// Marks of the letters that change.
    marks: Marks,
}

impl Walk<'_> {
    fn of(&self, e: &Expr, memo: &mut Memo<Expr>) -> Expr {
        if e.0.marks.are_apart(self.marks) {
            return zero(e.shape());
        }
        if let Some(known) = memo.get(e) {
            return known;
        }
        let derivative = self.of_node(e, memo);
        memo.keep(e, &derivative);
        derivative
    }

    fn of_node(&self, e: &Expr, memo: &mut Memo<Expr>) -> Expr {
        let symbols = self.symbols;
        let mut d = |x: &Expr| self.of(x, memo);
        let shape = e.shape();
        match e.node() {
            Node::Number(_)
            | Node::Constant(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..) => zero(shape),
            Node::Letter(at) => self
                .changes
                .iter()
                .find(|(l, _)| l == at)
                .map_or_else(|| zero(shape), |(_, amount)| amount.clone()),
            Node::Sum(terms) => sum(terms.iter().map(d).collect::<Vec<_>>(), shape),
            Node::Neg(a) => neg(d(a)),
            Node::Product(factors) => {
                let mut terms = Vec::new();
                for (i, f) in factors.iter().enumerate() {
                    let df = d(f);
                    if !df.is_zero() {
                        let mut word = factors.clone();
                        word[i] = df;
                        terms.push(product(word));
                    }
                }
                sum(terms, shape)
            }
            Node::Quotient(a, b) => {
                let (da, db) = (d(a), d(b));
                let first = if da.is_zero() {
                    zero(shape)
                } else {
                    quotient(da, b.clone())
                };
                if db.is_zero() {
                    return first;
                }
                let second = quotient(mul(db, a.clone()), power(b.clone(), Rational::integer(2)));
                sub(first, second)
            }
            Node::Power(a, q) => {
                let da = d(a);
                match q.plus(Rational::MINUS_ONE) {
                    Some(lower) if !da.is_zero() => {
                        product([number(*q), power(a.clone(), lower), da])
                    }
                    _ => integer(0),
                }
            }
            Node::Transpose(a) => transpose(symbols, d(a)),
            Node::Inverse(a) => {
                let da = d(a);
                if da.is_zero() {
                    return zero(shape);
                }
                neg(product([e.clone(), da, e.clone()]))
            }
            Node::Trace(a) => trace(d(a)),
            Node::Det(a) if let Some(factors) = determinant::det_by_factors(a) => d(&factors),
            Node::Det(a) => {
                let da = d(a);
                if da.is_zero() {
                    return integer(0);
                }
                trace(mul(adjugate(symbols, a), da))
            }
            Node::Adjugate(a) => d(&adjugate_polynomial(a)),
            Node::Dot(a, b) => add(dot(d(a), b.clone()), dot(a.clone(), d(b))),
            Node::Cross(a, b) => add(cross(d(a), b.clone()), cross(a.clone(), d(b))),
            Node::Hat(v) => hat(d(v)),
            Node::Vee(a) => vee(d(a)),
            Node::Part(which, a) => part(*which, d(a)),
            Node::Call(Function::Log, a) if matches!(a.node(), Node::Det(_)) => {
                let Node::Det(inner) = a.node() else {
                    return integer(0);
                };
                let whole = std::slice::from_ref(inner);
                let factors = determinant::factors_of_det(inner).unwrap_or(whole);
                let changes = factors.iter().map(|x| (x, d(x)));
                let changes = changes.filter(|(_, dx)| !dx.is_zero());
                let changes = changes.map(|(x, dx)| trace(mul(inverse(symbols, x.clone()), dx)));
                sum(changes.collect::<Vec<_>>(), Shape::SCALAR)
            }
            Node::Call(function, a) => {
                let da = d(a);
                if da.is_zero() {
                    return integer(0);
                }
                match function {
                    Function::Exp => mul(e.clone(), da),
                    _ => function.chain(e, a, da),
                }
            }
            Node::Map(map, a) => match map {
                Map::Real => real(d(a)),
                Map::Imaginary => imaginary(d(a)),
                Map::Pure => pure(d(a)),
                Map::Rotation if is_motion(symbols, a) => block(symbols, &d(a)),
                Map::Translation => column(symbols, &d(a)),
                Map::Diagonal => diagonal(d(a)),
                Map::DiagonalOf => diagonal_of(d(a)),
                Map::Twist => twist(d(a)),
                // A letter of SU(2) changes along the group only, here from the right.
                Map::Rotation => {
                    let da = d(a);
                    if da.is_zero() {
                        return zero(shape);
                    }
                    mul(e.clone(), hat(quaternion::angular(symbols, a, da)))
                }
            },
            Node::Given(a) => functional::changed(symbols, a, None, &mut d),
            Node::PullBack(a, which, seed) => {
                functional::changed(symbols, a, Some((*which, seed)), &mut d)
            }
        }
    }
}
