//! The magnitude of the terms of an expression, which is the scale of its rounding error. To first order this is a
//! running error bound in units of rounding (Higham, Accuracy and Stability of Numerical Algorithms, section 3.3).
//! The terms of a sum count individually. The terms of a factor count times the *values* of the other factors, so
//! that the power of a small number is small. A difference of stored positions is as uncertain as the positions.
//! Takes an expression; gives one without cancellation.

use super::shape::{Dim, Shape, Structure};
use super::symbol::Symbols;
use super::{
    Expr, Function, Letter, Map, Node, Rational, add, call, dot, identity, integer, mul, number,
    position_differences, power, quotient, substitute, sum, trace, transpose,
};

/// The magnitude of the terms of an expression.
pub(crate) fn magnitude(s: &Symbols, e: &Expr) -> Expr {
    Terms {
        symbols: s,
        differences: None,
    }
    .of(e)
    .terms
}

/// The magnitude of the terms of an expression at a node. Differences of positions count by their own lengths, plus
/// the effect of the rounding of the positions themselves, to first order and in units of rounding.
pub(crate) fn magnitude_by_differences(s: &Symbols, e: &Expr) -> Expr {
    let plain = |e: &Expr| magnitude(s, e);
    in_differences(s, e, plain, |named| {
        let definitions = named.definitions.iter();
        let sizes: Vec<(Letter, Expr)> = definitions.map(|(l, d)| (*l, magnitude(s, d))).collect();
        let terms = Terms {
            symbols: &named.symbols,
            differences: Some(&sizes),
        };
        let Size { terms, stored, .. } = terms.of(&named.whole);
        add(terms, stored)
    })
}

/// The magnitude without the rounding of the positions.
pub(crate) fn lengths_of_differences(s: &Symbols, e: &Expr) -> Expr {
    let plain = |e: &Expr| magnitude(s, e);
    in_differences(s, e, plain, |named| magnitude(&named.symbols, &named.whole))
}

/// A magnitude computed with letters for differences of positions; the plain magnitude if there are none.
fn in_differences(
    s: &Symbols,
    e: &Expr,
    plain: impl Fn(&Expr) -> Expr,
    size: impl Fn(&position_differences::NamedDifferences) -> Expr,
) -> Expr {
    match position_differences::named(s, e) {
        Some(named) => substitute(&named.symbols, &size(&named), &named.definitions),
        None => plain(e),
    }
}

/// Whether the scalar product of `a` and `b` is a component of a letter.
fn is_component(a: &Expr, b: &Expr) -> bool {
    let is = |a: &Expr, b: &Expr| matches!((a.node(), b.node()), (Node::Letter(_), Node::Unit(..)));
    is(a, b) || is(b, a)
}

/// Whether the product selects rows of a letter, possibly padded by zeros.
fn is_selection(factors: &[Expr]) -> bool {
    let inclusion = |e: &Expr| match e.node() {
        Node::Transpose(a) => matches!(a.node(), Node::Inclusion(..)),
        node => matches!(node, Node::Inclusion(..)),
    };
    match factors {
        [first @ .., last] => matches!(last.node(), Node::Letter(_)) && first.iter().all(inclusion),
        [] => false,
    }
}

/// Whether the expression is a product of elements of SU(2).
fn unit_quaternions(s: &Symbols, e: &Expr) -> bool {
    match e.node() {
        Node::Letter(l) => s.get(l.symbol).structure == Structure::UnitQuaternion,
        Node::Transpose(a) | Node::Neg(a) | Node::Inverse(a) => unit_quaternions(s, a),
        Node::Product(factors) => factors.iter().all(|f| unit_quaternions(s, f)),
        _ => false,
    }
}

/// The length of the value itself.
fn length(s: &Symbols, x: &Expr) -> Expr {
    let square = if x.shape().is_scalar() {
        mul(x.clone(), x.clone())
    } else if x.shape().is_vector() {
        dot(x.clone(), x.clone())
    } else {
        trace(mul(transpose(s, x.clone()), x.clone()))
    };
    power(square, Rational::HALF)
}

/// The magnitude of a value.
struct Size {
    /// The value's own length.
    value: Expr,
    /// The magnitude of its terms if they cancel; for a single term, its value.
    terms: Expr,
    /// The magnitude of its change due to the rounding of stored elements.
    stored: Expr,
}

impl Size {
    /// The magnitude of an expression that is neither a sum nor stored.
    fn exact(value: Expr) -> Self {
        Self {
            terms: value.clone(),
            value,
            stored: integer(0),
        }
    }

    /// Whether no terms cancel.
    fn is_single(&self) -> bool {
        self.terms == self.value
    }

    /// The magnitude of a product.
    fn times(self, other: Self) -> Self {
        let value = mul(self.value.clone(), other.value.clone());
        let [own, others] = [
            mul(self.terms.clone(), other.value.clone()),
            mul(self.value.clone(), other.terms.clone()),
        ];
        let terms = match (self.is_single(), other.is_single()) {
            (true, true) => value.clone(),
            (false, true) => own,
            (true, false) => others,
            (false, false) => add(own, others),
        };
        Self {
            stored: add(mul(self.stored, other.value), mul(self.value, other.stored)),
            value,
            terms,
        }
    }

    /// The magnitude of a function with this value and this derivative with respect to its argument.
    fn at_rate(self, value: Expr, rate: impl Fn(Expr) -> Expr) -> Self {
        Self {
            terms: match self.is_single() {
                true => value.clone(),
                false => add(value.clone(), rate(self.terms)),
            },
            stored: match self.stored.is_zero() {
                true => self.stored,
                false => rate(self.stored),
            },
            value,
        }
    }
}

struct Terms<'a> {
    symbols: &'a Symbols,
    /// The magnitudes of the positions in the letters of differences, if their rounding is requested.
    differences: Option<&'a [(Letter, Expr)]>,
}

impl Terms<'_> {
    fn of(&self, e: &Expr) -> Size {
        let of = |x: &Expr| self.of(x);
        let length = |x: &Expr| length(self.symbols, x);
        match e.node() {
            Node::Number(q) if q.is_negative() => Size::exact(number(q.negated())),
            Node::Number(_) | Node::Constant(_) => Size::exact(e.clone()),
            Node::Zero(_) => Size::exact(integer(0)),
            Node::Identity(_) | Node::Unit(..) | Node::Inclusion(..) => Size::exact(integer(1)),
            Node::Sum(list) => {
                let all: Vec<Size> = list.iter().map(of).collect();
                let total = |part: &dyn Fn(&Size) -> Expr| {
                    sum(all.iter().map(part).collect::<Vec<_>>(), Shape::SCALAR)
                };
                Size {
                    value: length(e),
                    terms: total(&|x| x.terms.clone()),
                    stored: total(&|x| x.stored.clone()),
                }
            }
            // Selected rows of a stored vector have their own magnitude.
            Node::Product(list) if is_selection(list) => Size {
                stored: sum(
                    list.iter().map(|x| of(x).stored).collect::<Vec<_>>(),
                    Shape::SCALAR,
                ),
                ..Size::exact(length(e))
            },
            Node::Product(list) => {
                let all = list.iter().map(of);
                all.reduce(Size::times)
                    .unwrap_or_else(|| Size::exact(integer(1)))
            }
            // A component of a stored vector has its own magnitude, not that of the other components.
            Node::Dot(a, b) if is_component(a, b) => Size {
                stored: add(of(a).stored, of(b).stored),
                ..Size::exact(length(e))
            },
            // The products of components may cancel in their sum.
            Node::Dot(a, b) | Node::Cross(a, b) => Size {
                value: length(e),
                ..of(a).times(of(b))
            },
            // The entries of a rotation cancel in its axial vector.
            Node::Vee(a) => Size {
                value: length(e),
                ..of(a)
            },
            Node::Neg(a) | Node::Transpose(a) | Node::Part(_, a) => of(a),
            // The trace of n entries is at most √n times their length; the trace of a product is at most the product of
            // the lengths.
            Node::Trace(a) => Size {
                value: length(e),
                ..match a.node() {
                    Node::Product(_) => of(a),
                    _ => Size::exact(length(&identity(a.shape().rows))).times(of(a)),
                }
            },
            // The sum of the absolute values of the products in a determinant is at most this (Hadamard).
            Node::Det(a) => match a.shape().rows {
                Dim::Fixed(n) => Size {
                    value: length(e),
                    terms: power(length(a), Rational::integer(n.into())),
                    stored: integer(0),
                },
                // The dimension is named, so the power is not known: the value itself.
                Dim::Named(_) => Size::exact(length(e)),
            },
            Node::Hat(a) | Node::Map(Map::Pure | Map::Twist, a) => {
                Size::exact(integer(2)).times(of(a))
            }
            // Linear in the entries; `stored` handles unit quaternions.
            Node::Map(Map::Imaginary | Map::Real, a) if !unit_quaternions(self.symbols, a) => of(a),
            Node::Map(Map::Diagonal | Map::DiagonalOf, a) => of(a),
            Node::Quotient(a, b) => of(a).times(Size::exact(quotient(integer(1), length(b)))),
            Node::Power(a, q) if *q == Rational::integer(2) => of(a).times(of(a)),
            // The derivative of a root does not exist at zero.
            Node::Power(a, q) if q.value() > 1.0 => of(a).at_rate(length(e), |change| {
                let less = q.plus(Rational::MINUS_ONE);
                less.map_or_else(
                    || integer(0),
                    |less| mul(mul(number(*q), power(length(a), less)), change),
                )
            }),
            Node::Call(f, a) => of(a).at_rate(length(e), |change| called(*f, a, e, change, length)),
            Node::Letter(_)
            | Node::Power(..)
            | Node::Inverse(_)
            | Node::Adjugate(_)
            | Node::Map(..)
            | Node::Given(_)
            | Node::PullBack(..) => Size {
                stored: self.stored(e).unwrap_or_else(|| integer(0)),
                ..Size::exact(length(e))
            },
        }
    }

    /// The magnitude of the stored elements from which a small value is computed.
    fn stored(&self, e: &Expr) -> Option<Expr> {
        let differences = self.differences?;
        match e.node() {
            Node::Map(Map::Imaginary, a) if unit_quaternions(self.symbols, a) => Some(integer(1)),
            Node::Letter(l) => {
                let found = differences.iter().find(|(difference, _)| difference == l);
                found.map(|(_, size)| size.clone())
            }
            _ => None,
        }
    }
}

/// The change of a function when its argument changes, or a bound of it.
fn called(f: Function, a: &Expr, e: &Expr, change: Expr, length: impl Fn(&Expr) -> Expr) -> Expr {
    match f {
        Function::Sin | Function::Cos | Function::Tanh | Function::Abs => change,
        Function::Sign => integer(0),
        Function::Exp => mul(length(e), change),
        Function::Sinh => mul(call(Function::Cosh, a.clone()), change),
        Function::Cosh => mul(length(&call(Function::Sinh, a.clone())), change),
        Function::Log => quotient(change, length(a)),
    }
}
