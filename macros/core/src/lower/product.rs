//! Products: matrix chains bracketed by cost, and scalars collected into one factor with one division.

use super::Lowering;
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr, Node};
use crate::schedule::{Bracketed, associate};
use clebsch_program::{Operation, Pair, Single, Value};

impl Lowering<'_> {
    pub(super) fn product(&mut self, factors: &[Expr]) -> Value {
        let (mut numbers, matrices): (Vec<Expr>, Vec<Expr>) =
            factors.iter().cloned().partition(|f| f.shape().is_scalar());
        let (Some(first), Some(last)) = (matrices.first(), matrices.last()) else {
            return self.quotient(&numbers);
        };
        let column = last.shape().cols == Dim::Fixed(1);
        let number = column && first.shape().rows == Dim::Fixed(1);
        let chain = match doubled(&mut numbers, &matrices) {
            Some(a) => self.of(Single::AxialOfDifference, &a),
            None => self.chain(&matrices),
        };
        match (numbers.as_slice(), numbers.first().and_then(divisor)) {
            ([], _) => chain,
            ([_], Some(below)) if column => {
                let below = self.value(&below);
                self.two(Pair::Div, chain, below)
            }
            (several, _) if number => self.quotient_from(Some(chain), several),
            // Computed once, because every component is multiplied by it.
            (several, _) => {
                let factor = self.quotient(several);
                self.two(Pair::Mul, chain, factor)
            }
        }
    }

    /// A product of scalars, with one division by all divisors. Divisions read better than negative powers.
    fn quotient(&mut self, numbers: &[Expr]) -> Value {
        self.quotient_from(None, numbers)
    }

    /// The product after a first factor.
    fn quotient_from(&mut self, first: Option<Value>, numbers: &[Expr]) -> Value {
        let above: Vec<&Expr> = numbers.iter().filter(|n| divisor(n).is_none()).collect();
        let below: Vec<Expr> = numbers.iter().filter_map(divisor).collect();
        let mut product = first;
        for n in above {
            let n = self.value(n);
            product = Some(self.times(product, n));
        }
        let above = match product {
            // A single first factor is not multiplied by 1.
            Some(value) => value,
            None => self.rational(Rational::ONE),
        };
        let mut divisors = None;
        for n in &below {
            let n = self.value(n);
            divisors = Some(self.times(divisors, n));
        }
        match divisors {
            Some(below) => self.two(Pair::Div, above, below),
            None => above,
        }
    }

    fn times(&mut self, product: Option<Value>, n: Value) -> Value {
        match product {
            Some(product) => self.two(Pair::Mul, product, n),
            None => n,
        }
    }

    fn chain(&mut self, factors: &[Expr]) -> Value {
        let bracketed = associate(factors);
        self.bracketed(&bracketed, factors).0
    }

    /// The value, its shape, and the factor if it is a single one.
    fn bracketed<'e>(
        &mut self,
        b: &Bracketed,
        factors: &'e [Expr],
    ) -> (Value, Shape, Option<&'e Expr>) {
        let (a, b) = match b {
            Bracketed::Factor(i) => {
                let factor = &factors[*i];
                return (self.value(factor), factor.shape(), Some(factor));
            }
            Bracketed::Pair(a, b) => (a, b),
        };
        let (left, right) = (shape_of(a, factors), shape_of(b, factors));
        let shape = Shape {
            rows: left.rows,
            cols: right.cols,
        };
        let (first, second) = (factor_of(a, factors), factor_of(b, factors));
        let value = self.pair([a, b], [left, right], [first, second], factors);
        (value, shape, None)
    }

    fn pair(
        &mut self,
        [a, b]: [&Bracketed; 2],
        [left, right]: [Shape; 2],
        [first, second]: [Option<&Expr>; 2],
        factors: &[Expr],
    ) -> Value {
        if let Some((whole, at, transposed)) = first.and_then(inclusion) {
            let y = self.bracketed(b, factors).0;
            return self.push(match transposed {
                true => Operation::RowsFrom(y, whole, at),
                false => Operation::IntoRows(y, whole, at),
            });
        }
        if let Some((whole, at, transposed)) = second.and_then(inclusion) {
            let x = self.bracketed(a, factors).0;
            return self.push(match transposed {
                true => Operation::IntoColumns(x, whole, at),
                false => Operation::ColumnsFrom(x, whole, at),
            });
        }
        let hat = |e: Option<&Expr>| match e.map(Expr::node) {
            Some(Node::Hat(v)) => Some(v.clone()),
            _ => None,
        };
        if let Some(v) = hat(first)
            && (right.is_vector() || right.cols == Dim::Fixed(3))
        {
            let (v, y) = (self.value(&v), self.bracketed(b, factors).0);
            let pair = match right.is_vector() {
                true => Pair::Cross,
                false => Pair::Crossed,
            };
            return self.two(pair, v, y);
        }
        if let Some(v) = hat(second)
            && left.rows == Dim::Fixed(3)
        {
            let (x, v) = (self.bracketed(a, factors).0, self.value(&v));
            return self.two(Pair::Crossing, x, v);
        }
        let transposed = match first.map(Expr::node) {
            Some(Node::Transpose(inner)) => Some(inner.clone()),
            _ => None,
        };
        let is_diagonal = [first, second].map(|e| e.is_some_and(|e| self.is_diagonal(e)));
        // nalgebra multiplies by scalars from the right.
        if left.is_scalar() {
            let (y, x) = (self.bracketed(b, factors).0, self.bracketed(a, factors).0);
            return self.two(Pair::Mul, y, x);
        }
        let number = left.rows == Dim::Fixed(1) && right.cols == Dim::Fixed(1);
        if let (Some(inner), [false, false]) = (&transposed, is_diagonal) {
            // A row times a column, and A^T B without forming the transpose.
            let (x, y) = (self.value(inner), self.bracketed(b, factors).0);
            let pair = match number {
                true => Pair::Dot,
                false => Pair::TransposedMul,
            };
            return self.two(pair, x, y);
        }
        let (x, y) = (self.bracketed(a, factors).0, self.bracketed(b, factors).0);
        match is_diagonal {
            [true, _] => self.two(Pair::DiagonalTimes, x, y),
            [_, true] => self.two(Pair::TimesDiagonal, x, y),
            _ if number => {
                let x = self.one(Single::Transpose, x);
                self.two(Pair::Dot, x, y)
            }
            _ => self.two(Pair::Mul, x, y),
        }
    }
}

/// `A` if the whole is `2 vee(A)`, the axial vector of `A - A^T`; halves the scalar factor.
fn doubled(numbers: &mut Vec<Expr>, matrices: &[Expr]) -> Option<Expr> {
    let [only] = matrices else {
        return None;
    };
    let Node::Vee(a) = only.node() else {
        return None;
    };
    let is_number = |n: &Expr| matches!(n.node(), Node::Number(_));
    let at = numbers.iter().position(is_number)?;
    let Node::Number(q) = numbers[at].node() else {
        return None;
    };
    let half = q.times(Rational::HALF)?;
    numbers[at] = expr::number(half);
    if half.is_one() {
        numbers.remove(at);
    }
    Some(a.clone())
}

fn shape_of(b: &Bracketed, factors: &[Expr]) -> Shape {
    match b {
        Bracketed::Factor(i) => factors[*i].shape(),
        Bracketed::Pair(a, b) => Shape {
            rows: shape_of(a, factors).rows,
            cols: shape_of(b, factors).cols,
        },
    }
}

fn factor_of<'e>(b: &Bracketed, factors: &'e [Expr]) -> Option<&'e Expr> {
    match b {
        Bracketed::Factor(i) => Some(&factors[*i]),
        Bracketed::Pair(..) => None,
    }
}

/// The divisor of a scalar factor, if it is a reciprocal.
fn divisor(number: &Expr) -> Option<Expr> {
    match number.node() {
        Node::Power(base, q) if q.is_negative() => Some(expr::power(base.clone(), q.negated())),
        _ => None,
    }
}

/// The shape and the row of an inclusion, and whether it is transposed.
fn inclusion(e: &Expr) -> Option<(Shape, usize, bool)> {
    let (e, transposed) = match e.node() {
        Node::Transpose(inner) => (inner, true),
        _ => (e, false),
    };
    match e.node() {
        Node::Inclusion(whole, at) => Some((*whole, *at as usize, transposed)),
        _ => None,
    }
}
