//! Expressions of random models: trees over symbols, with their shapes. Symbols are indices into the table of a model; evaluation
//! uses the oracle's numbers.

use super::grid::Grid;
use crate::oracle::dual::Number;

/// Rows and columns.
pub type Shape = (usize, usize);

/// The shape of a scalar.
pub const SCALAR: Shape = (1, 1);

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// The literal and its value.
    Number(&'static str, f64),
    /// The step size.
    Step,
    /// The identity.
    Identity(usize),
    /// A unit vector of this length, along an axis counted from 1.
    Axis(usize, usize),
    /// A symbol and its shape.
    Letter(usize, Shape),
    /// A symbol at the end of the edge, and its shape.
    Next(usize, Shape),
    /// Terms; `true` subtracts.
    Sum(Vec<(bool, Tree)>),
    /// Factors in order.
    Product(Vec<Tree>),
    /// A quotient by a scalar.
    Quotient(Box<Tree>, Box<Tree>),
    /// A power of a scalar, or the inverse of a matrix as `^-1`.
    Power(Box<Tree>, i32, i32),
    /// The transpose.
    Transposed(Box<Tree>),
    /// Components, counted from 1.
    Component(Box<Tree>, Vec<usize>),
    /// A function.
    Call(&'static str, Vec<Tree>),
}

/// The values of all symbols at both ends of an edge.
#[derive(Debug)]
pub struct Edge<'a, T> {
    /// The step size.
    pub step: f64,
    /// Values at the start, including velocities.
    pub here: &'a [Grid<T>],
    /// Values at the end.
    pub next: &'a [Grid<T>],
}

impl Tree {
    /// A function of one argument.
    #[must_use]
    pub fn call(name: &'static str, a: Tree) -> Tree {
        Tree::Call(name, vec![a])
    }

    /// A number from its literal.
    #[must_use]
    pub fn number(typed: &'static str) -> Tree {
        Tree::Number(typed, typed.parse().unwrap_or(f64::NAN))
    }

    /// `a + b`.
    #[must_use]
    pub fn plus(self, b: Tree) -> Tree {
        Tree::Sum(vec![(false, self), (false, b)])
    }

    /// `a - b`.
    #[must_use]
    pub fn minus(self, b: Tree) -> Tree {
        Tree::Sum(vec![(false, self), (true, b)])
    }

    /// `a b`.
    #[must_use]
    pub fn times(self, b: Tree) -> Tree {
        Tree::Product(vec![self, b])
    }

    /// `a/b`.
    #[must_use]
    pub fn over(self, b: Tree) -> Tree {
        Tree::Quotient(Box::new(self), Box::new(b))
    }

    /// `a^T`.
    #[must_use]
    pub fn transposed(self) -> Tree {
        Tree::Transposed(Box::new(self))
    }

    /// `a^n`.
    #[must_use]
    pub fn power(self, n: i32, d: i32) -> Tree {
        Tree::Power(Box::new(self), n, d)
    }

    /// The direct subexpressions, in order.
    #[must_use]
    pub fn parts(&self) -> Vec<&Tree> {
        match self {
            Tree::Number(..)
            | Tree::Step
            | Tree::Identity(_)
            | Tree::Axis(..)
            | Tree::Letter(..)
            | Tree::Next(..) => Vec::new(),
            Tree::Sum(terms) => terms.iter().map(|(_, t)| t).collect(),
            Tree::Product(list) | Tree::Call(_, list) => list.iter().collect(),
            Tree::Quotient(a, b) => vec![a, b],
            Tree::Power(a, ..) | Tree::Transposed(a) | Tree::Component(a, _) => vec![a],
        }
    }

    /// All compound subexpressions, recursively.
    #[must_use]
    pub fn compounds(&self) -> Vec<&Tree> {
        let own = self.parts().into_iter();
        own.filter(|part| !part.parts().is_empty())
            .flat_map(|part| [vec![part], part.compounds()].concat())
            .collect()
    }

    /// Whether any subexpression satisfies the predicate.
    pub fn mentions(&self, wanted: &dyn Fn(&Tree) -> bool) -> bool {
        wanted(self) || self.parts().into_iter().any(|p| p.mentions(wanted))
    }

    /// Rows and columns.
    #[must_use]
    pub fn shape(&self) -> Shape {
        match self {
            Tree::Number(..) | Tree::Step | Tree::Component(..) => SCALAR,
            Tree::Identity(n) => (*n, *n),
            Tree::Axis(n, _) => (*n, 1),
            Tree::Letter(_, shape) | Tree::Next(_, shape) => *shape,
            Tree::Sum(terms) => terms.first().map_or(SCALAR, |(_, t)| t.shape()),
            Tree::Product(list) => {
                let shapes = || list.iter().map(Tree::shape).filter(|s| *s != SCALAR);
                match (shapes().next(), shapes().next_back()) {
                    (Some(a), Some(b)) => (a.0, b.1),
                    _ => SCALAR,
                }
            }
            Tree::Quotient(a, _) | Tree::Power(a, ..) => a.shape(),
            Tree::Transposed(a) => {
                let (rows, cols) = a.shape();
                (cols, rows)
            }
            Tree::Call(name, list) => {
                let (rows, cols) = list.first().map_or(SCALAR, Tree::shape);
                match *name {
                    "inv" | "sym" | "skew" => (rows, cols),
                    "diag" => (rows, rows),
                    "rot" if rows == 3 => (2, 2),
                    "hat" | "rot" => (3, 3),
                    "quat" => (4, 4),
                    "pos" => (rows - 1, 1),
                    "vee" | "cross" | "im" => (3, 1),
                    _ => SCALAR,
                }
            }
        }
    }

    /// The value on an edge.
    #[must_use]
    pub fn value<T: Number>(&self, at: &Edge<'_, T>) -> Grid<T> {
        let impossible = || Grid::number(T::constant(f64::NAN));
        let go = |t: &Tree| t.value(at);
        match self {
            Tree::Number(_, x) => Grid::number(T::constant(*x)),
            Tree::Step => Grid::number(T::constant(at.step)),
            Tree::Identity(n) => Grid::identity(*n),
            Tree::Axis(n, axis) => Grid::from_entries(*n, 1, |i, _| {
                T::constant(f64::from(u8::from(i + 1 == *axis)))
            }),
            Tree::Letter(index, _) => at.here.get(*index).cloned().unwrap_or_else(impossible),
            Tree::Next(index, _) => at.next.get(*index).cloned().unwrap_or_else(impossible),
            Tree::Sum(terms) => {
                let signed = terms.iter().map(|(minus, t)| match minus {
                    true => go(t).each(|x| -x),
                    false => go(t),
                });
                signed.reduce(|a, b| a.plus(&b)).unwrap_or_else(impossible)
            }
            Tree::Product(list) => {
                let values = list.iter().map(go);
                values.reduce(|a, b| a.times(&b)).unwrap_or_else(impossible)
            }
            Tree::Quotient(a, b) => {
                let below = go(b).scalar();
                go(a).each(|x| x / below)
            }
            Tree::Power(a, n, d) => {
                let base = go(a);
                match (base.data.len(), *n, *d) {
                    (1, n, 1) => base.each(|x| x.power(n)),
                    (1, n, d) => base.each(|x| x.fraction(n, d)),
                    (_, -1, 1) => base.inverse(),
                    (_, 2, 1) => base.times(&base),
                    _ => impossible(),
                }
            }
            Tree::Transposed(a) => go(a).transposed(),
            Tree::Component(a, indices) => {
                let a = go(a);
                Grid::number(match indices.as_slice() {
                    [i] => a.at(i - 1, 0),
                    [i, j] => a.at(i - 1, j - 1),
                    _ => T::constant(f64::NAN),
                })
            }
            Tree::Call(name, list) => {
                let shape = list.first().map_or(SCALAR, Tree::shape);
                let values: Vec<Grid<T>> = list.iter().map(go).collect();
                called(name, shape, &values).unwrap_or_else(impossible)
            }
        }
    }
}

/// The functions of the language, by their definitions.
fn called<T: Number>(name: &str, shape: Shape, arguments: &[Grid<T>]) -> Option<Grid<T>> {
    let a = arguments.first()?;
    let half = T::constant(0.5);
    let zero = T::constant(0.0);
    Some(match name {
        "tr" | "I1" => Grid::number(a.trace()),
        "I2" => {
            let trace = a.trace();
            Grid::number(half * (trace * trace - a.times(a).trace()))
        }
        "det" => Grid::number(a.determinant()),
        "inv" => a.inverse(),
        "sym" => a.plus(&a.transposed()).scaled(half),
        "skew" => a.plus(&a.transposed().each(|x| -x)).scaled(half),
        "diag" if shape.1 == 1 => {
            Grid::from_entries(
                a.rows,
                a.rows,
                |i, j| if i == j { a.at(i, 0) } else { zero },
            )
        }
        "diag" => Grid::from_entries(
            a.rows,
            a.rows,
            |i, j| if i == j { a.at(i, i) } else { zero },
        ),
        "hat" => a.hat(),
        "vee" => a.vee(),
        "dot" => a.transposed().times(arguments.get(1)?),
        "cross" => a.hat().times(arguments.get(1)?),
        "re" => Grid::number(a.quaternion_parts().0),
        "im" => {
            let (_, v) = a.quaternion_parts();
            Grid::from_entries(3, 1, |i, _| v[i])
        }
        "quat" => Grid::quaternion(zero, [0, 1, 2].map(|i| a.at(i, 0))),
        // For a motion, its rotation block. For a quaternion, whose last row differs from a motion's, the rotation that it covers.
        "rot" if a.rows == 3 => a.block(2, 2, (0, 0)),
        "rot" if is_motion(a) => a.block(3, 3, (0, 0)),
        "rot" => a.covered(),
        "pos" => a.block(a.rows - 1, 1, (0, a.rows - 1)),
        "sqrt" => a.each(Number::sqrt),
        "exp" => a.each(Number::exp),
        "log" => a.each(Number::ln),
        "sin" => a.each(Number::sin),
        "cos" => a.each(Number::cos),
        "sinh" => a.each(Number::sinh),
        "cosh" => a.each(Number::cosh),
        "tanh" => a.each(|x| x.sinh() / x.cosh()),
        "abs" => a.each(|x| x * x.sign()),
        "sign" => a.each(Number::sign),
        _ => return None,
    })
}

/// Whether the last row is `(0, 0, 0, 1)`.
fn is_motion<T: Number>(a: &Grid<T>) -> bool {
    (0..4).all(|j| a.at(3, j).value() == f64::from(u8::from(j == 3)))
}
