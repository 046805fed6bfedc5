//! Numbers that no value of an expression exceeds, from the lengths of its letters: what its rounding
//! is measured by. A difference of stored places is as uncertain as they are.
//! Takes an expression; gives one without cancellation.

use super::shape::{Shape, Structure};
use super::symbol::Symbols;
use super::{
    Expr, Function, Letter, Map, Node, Rational, add, call, dot, integer, mul, number, places,
    power, quotient, substitute, sum, trace, transpose,
};

/// How large the terms of an expression are.
pub(crate) fn magnitude(s: &Symbols, e: &Expr) -> Expr {
    Terms {
        symbols: s,
        differences: None,
    }
    .of(e)
    .value
}

/// How large the terms of an expression at a node are, differences of places by their own lengths, with what the rounding of
/// the places themselves changes, to first order and in units of rounding.
pub(crate) fn magnitude_by_differences(s: &Symbols, e: &Expr) -> Expr {
    let plain = |e: &Expr| magnitude(s, e);
    in_differences(s, e, plain, |named| {
        let definitions = named.definitions.iter();
        let sizes: Vec<(Letter, Expr)> = definitions.map(|(l, d)| (*l, magnitude(s, d))).collect();
        let terms = Terms {
            symbols: &named.symbols,
            differences: Some(&sizes),
        };
        let Size { value, stored } = terms.of(&named.whole);
        add(value, stored)
    })
}

/// The same without the rounding of places.
pub(crate) fn lengths_of_differences(s: &Symbols, e: &Expr) -> Expr {
    let plain = |e: &Expr| magnitude(s, e);
    in_differences(s, e, plain, |named| magnitude(&named.symbols, &named.whole))
}

/// A size that is taken with letters for differences of places; the plain one where there are none.
fn in_differences(
    s: &Symbols,
    e: &Expr,
    plain: impl Fn(&Expr) -> Expr,
    size: impl Fn(&places::Named) -> Expr,
) -> Expr {
    match places::named(s, e) {
        Some(named) => substitute(&named.symbols, &size(&named), &named.definitions),
        None => plain(e),
    }
}

/// Whether the scalar product of these is a component of a letter.
fn is_component(a: &Expr, b: &Expr) -> bool {
    let is = |a: &Expr, b: &Expr| matches!((a.node(), b.node()), (Node::Letter(_), Node::Unit(..)));
    is(a, b) || is(b, a)
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

/// How large a value is, and how large its change where stored elements change by their rounding.
struct Size {
    value: Expr,
    stored: Expr,
}

struct Terms<'a> {
    symbols: &'a Symbols,
    /// The sizes of the places of which letters of differences are made, where their rounding is asked for.
    differences: Option<&'a [(Letter, Expr)]>,
}

impl Terms<'_> {
    fn of(&self, e: &Expr) -> Size {
        let of = |x: &Expr| self.of(x);
        let exact = |value| Size {
            value,
            stored: integer(0),
        };
        match e.node() {
            Node::Number(q) if q.is_negative() => exact(number(q.negated())),
            Node::Number(_) | Node::Constant(_) => exact(e.clone()),
            Node::Zero(_) => exact(integer(0)),
            Node::Identity(_) | Node::Unit(..) | Node::Inclusion(..) => exact(integer(1)),
            Node::Sum(list) => {
                let all: Vec<Size> = list.iter().map(of).collect();
                let total = |part: &dyn Fn(&Size) -> Expr| {
                    sum(all.iter().map(part).collect::<Vec<_>>(), Shape::SCALAR)
                };
                Size {
                    value: total(&|x| x.value.clone()),
                    stored: total(&|x| x.stored.clone()),
                }
            }
            Node::Product(list) => {
                let all = list.iter().map(of);
                all.reduce(times).unwrap_or_else(|| exact(integer(1)))
            }
            // A component of what is stored is as large as it is, not as the others are.
            Node::Dot(a, b) if is_component(a, b) => Size {
                value: length(self.symbols, e),
                stored: add(of(a).stored, of(b).stored),
            },
            Node::Dot(a, b) | Node::Cross(a, b) => times(of(a), of(b)),
            Node::Neg(a) | Node::Transpose(a) | Node::Part(_, a) | Node::Vee(a) => of(a),
            Node::Hat(a) | Node::Trace(a) | Node::Map(Map::Pure | Map::Twist, a) => {
                times(exact(integer(2)), of(a))
            }
            // Linear in the entries; where these are of a quaternion, see `stored`.
            Node::Map(Map::Imaginary | Map::Real, a) if !unit_quaternions(self.symbols, a) => of(a),
            Node::Map(Map::Diagonal | Map::DiagonalOf, a) => of(a),
            Node::Quotient(a, b) if self.differences.is_some() => {
                let (a, b) = (of(a), length(self.symbols, b));
                Size {
                    value: quotient(a.value, b.clone()),
                    stored: quotient(a.stored, b),
                }
            }
            Node::Power(a, q) if *q == Rational::integer(2) => times(of(a), of(a)),
            // A root where its argument vanishes has no rate; roots stand in what is told by their letters as well.
            Node::Power(a, q) if self.differences.is_some() && q.value() > 1.0 => {
                let rate = q.plus(Rational::MINUS_ONE);
                let rate = rate.map(|less| mul(number(*q), power(length(self.symbols, a), less)));
                Size {
                    value: length(self.symbols, e),
                    stored: rate.map_or_else(|| integer(0), |rate| mul(rate, of(a).stored)),
                }
            }
            Node::Call(f, a) if self.differences.is_some() => Size {
                value: length(self.symbols, e),
                stored: called(*f, a, e, self.of(a).stored, |x| length(self.symbols, x)),
            },
            Node::Letter(_)
            | Node::Quotient(..)
            | Node::Power(..)
            | Node::Inverse(_)
            | Node::Det(_)
            | Node::Adjugate(_)
            | Node::Map(..)
            | Node::Call(..)
            | Node::Given(_)
            | Node::PullBack(..) => Size {
                value: length(self.symbols, e),
                stored: self.stored(e).unwrap_or_else(|| integer(0)),
            },
        }
    }

    /// The size of the stored elements of which a small value is made.
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

/// What the rounding of an argument changes a function by, or a bound of it.
fn called(f: Function, a: &Expr, e: &Expr, stored: Expr, length: impl Fn(&Expr) -> Expr) -> Expr {
    if stored.is_zero() {
        return stored;
    }
    match f {
        Function::Sin | Function::Cos | Function::Tanh | Function::Abs => stored,
        Function::Sign => integer(0),
        Function::Exp => mul(length(e), stored),
        Function::Sinh => mul(call(Function::Cosh, a.clone()), stored),
        Function::Cosh => mul(length(&call(Function::Sinh, a.clone())), stored),
        Function::Log => quotient(stored, length(a)),
    }
}

fn times(a: Size, b: Size) -> Size {
    Size {
        stored: add(
            mul(a.stored, b.value.clone()),
            mul(a.value.clone(), b.stored),
        ),
        value: mul(a.value, b.value),
    }
}
