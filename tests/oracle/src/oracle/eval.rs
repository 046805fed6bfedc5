//! Evaluates expression trees of random models, apart from the engine and from the text.
//! Takes a tree and the values of its letters; gives a scalar, vector, row or matrix.
//! A tree of impossible shape gives NaN, which no comparison passes.

use super::dual::Number;
use super::random::tree::{Expr, Named};
use super::square::{Square, cross, dot, hat, outer, vee};

/// The value of an expression.
#[derive(Clone, Copy, Debug)]
pub enum Value<T> {
    /// A scalar.
    Scalar(T),
    /// A column.
    Column([T; 3]),
    /// A transposed column.
    Row([T; 3]),
    /// A matrix.
    Matrix(Square<T, 3>),
}

impl<T: Number> Value<T> {
    /// What an impossible expression is worth.
    #[must_use]
    pub fn impossible() -> Self {
        Self::Scalar(T::constant(f64::NAN))
    }

    /// The scalar, or NaN if it is none.
    #[must_use]
    pub fn scalar(self) -> T {
        match self {
            Self::Scalar(value) => value,
            _ => T::constant(f64::NAN),
        }
    }

    /// The same as a value that does not vary.
    #[must_use]
    pub fn constant(value: &Value<f64>) -> Self {
        match value {
            Value::Scalar(x) => Self::Scalar(T::constant(*x)),
            Value::Column(x) => Self::Column(x.map(T::constant)),
            Value::Row(x) => Self::Row(x.map(T::constant)),
            Value::Matrix(x) => Self::Matrix(Square::constant(x)),
        }
    }

    fn each(self, change: impl Fn(T) -> T) -> Self {
        match self {
            Self::Scalar(x) => Self::Scalar(change(x)),
            Self::Column(x) => Self::Column(x.map(change)),
            Self::Row(x) => Self::Row(x.map(change)),
            Self::Matrix(x) => Self::Matrix(Square(x.0.map(|row| row.map(&change)))),
        }
    }

    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Self::Scalar(a), Self::Scalar(b)) => Self::Scalar(a + b),
            (Self::Column(a), Self::Column(b)) => {
                Self::Column([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
            }
            (Self::Row(a), Self::Row(b)) => Self::Row([a[0] + b[0], a[1] + b[1], a[2] + b[2]]),
            (Self::Matrix(a), Self::Matrix(b)) => Self::Matrix(a + b),
            _ => Self::impossible(),
        }
    }

    fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::Scalar(a), b) | (b, Self::Scalar(a)) => b.each(|entry| entry * a),
            (Self::Matrix(a), Self::Matrix(b)) => Self::Matrix(a * b),
            (Self::Matrix(a), Self::Column(b)) => Self::Column(a.apply(&b)),
            (Self::Row(a), Self::Matrix(b)) => Self::Row(b.transpose().apply(&a)),
            (Self::Row(a), Self::Column(b)) => Self::Scalar(dot(&a, &b)),
            (Self::Column(a), Self::Row(b)) => Self::Matrix(outer(&a, &b)),
            _ => Self::impossible(),
        }
    }
}

/// The values of letters at one place: a node, or an edge seen from its tail.
#[derive(Debug)]
pub struct Place<'a, T> {
    /// The step.
    pub step: f64,
    /// The values of the letters by their place in the table.
    pub letters: &'a [Value<T>],
    /// The same at the head of the edge.
    pub at_head: &'a [Value<T>],
    /// Named subexpressions.
    pub lets: &'a [Named],
}

impl<T: Number> Place<'_, T> {
    /// The value of an expression.
    #[must_use]
    pub fn value(&self, expr: &Expr) -> Value<T> {
        match expr {
            Expr::Number(_, value) => Value::Scalar(T::constant(*value)),
            Expr::Step => Value::Scalar(T::constant(self.step)),
            Expr::Identity => Value::Matrix(Square::identity()),
            Expr::Axis(axis) => Value::Column(std::array::from_fn(|i| {
                T::constant(if i + 1 == *axis { 1.0 } else { 0.0 })
            })),
            Expr::Symbol(index) => known(self.letters, *index),
            Expr::Next(index) => known(self.at_head, *index),
            Expr::Let(index) => self
                .lets
                .get(*index)
                .map_or(Value::impossible(), |named| self.value(&named.expr)),
            Expr::Negated(a) => self.value(a).each(|entry| -entry),
            Expr::Sum(a, b) => self.value(a).plus(self.value(b)),
            Expr::Difference(a, b) => self.value(a).plus(self.value(b).each(|entry| -entry)),
            Expr::Product(a, b, _) => self.value(a).times(self.value(b)),
            Expr::Quotient(a, b) => {
                let divisor = self.value(b).scalar();
                self.value(a).each(|entry| entry / divisor)
            }
            Expr::Power(a, exponent) => match (self.value(a), exponent) {
                (Value::Scalar(x), _) => Value::Scalar(x.power(*exponent)),
                (Value::Matrix(x), -1) => Value::Matrix(x.inverse()),
                _ => Value::impossible(),
            },
            Expr::Transposed(a) => match self.value(a) {
                Value::Scalar(x) => Value::Scalar(x),
                Value::Column(x) => Value::Row(x),
                Value::Row(x) => Value::Column(x),
                Value::Matrix(x) => Value::Matrix(x.transpose()),
            },
            Expr::Call(name, arguments) => {
                let arguments: Vec<Value<T>> = arguments
                    .iter()
                    .map(|argument| self.value(argument))
                    .collect();
                call(name, &arguments)
            }
            Expr::Grouped(a) => self.value(a),
        }
    }
}

fn known<T: Number>(letters: &[Value<T>], index: usize) -> Value<T> {
    letters
        .get(index)
        .copied()
        .unwrap_or_else(Value::impossible)
}

/// The functions of the language that random models use.
fn call<T: Number>(name: &str, arguments: &[Value<T>]) -> Value<T> {
    let half = T::constant(0.5);
    match (name, arguments) {
        ("tr" | "I1", [Value::Matrix(m)]) => Value::Scalar(m.trace()),
        ("I2", [Value::Matrix(m)]) => Value::Scalar(m.second_invariant()),
        ("det", [Value::Matrix(m)]) => Value::Scalar(m.determinant()),
        ("inv", [Value::Matrix(m)]) => Value::Matrix(m.inverse()),
        ("sym", [Value::Matrix(m)]) => Value::Matrix((*m + m.transpose()).scaled(half)),
        ("skew", [Value::Matrix(m)]) => Value::Matrix((*m - m.transpose()).scaled(half)),
        ("hat", [Value::Column(v)]) => Value::Matrix(hat(v)),
        ("vee", [Value::Matrix(m)]) => Value::Column(vee(m)),
        ("dot", [Value::Column(a), Value::Column(b)]) => Value::Scalar(dot(a, b)),
        ("cross", [Value::Column(a), Value::Column(b)]) => Value::Column(cross(a, b)),
        ("sqrt", [Value::Scalar(x)]) => Value::Scalar(x.sqrt()),
        ("exp", [Value::Scalar(x)]) => Value::Scalar(x.exp()),
        ("log", [Value::Scalar(x)]) => Value::Scalar(x.ln()),
        _ => Value::impossible(),
    }
}
