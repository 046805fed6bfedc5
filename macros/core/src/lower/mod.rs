//! From expressions to kernels: one rule per kind of node. Differences from zero velocity and products are ordered so
//! that they lose no digits and cost least.

mod functional;
mod product;
mod sum;

use crate::algebra::Rational;
use crate::expr::shape::Structure;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Constant, Expr, Function, Letter, Map, Node, Part};
use crate::schedule::Program;
use clebsch_program::{Kernel, Kind, Number, Operation, Pair, Single, Value};

/// The source of an input of a kernel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Source {
    /// The value of a letter.
    Letter(Letter),
    /// The rotation that a unit quaternion covers.
    RotationOf(Letter),
    /// A unit quaternion as four numbers.
    QuaternionOf(Letter),
}

/// The names of letters in a kernel.
pub trait Inputs {
    /// The name of a letter's value.
    fn letter(&self, symbols: &Symbols, letter: Letter) -> String;

    /// The name of the rotation that a unit quaternion covers, if the kernel has it.
    fn rotation(&self, letter: Letter) -> Option<String> {
        let _ = letter;
        None
    }

    /// The name of a unit quaternion as four numbers, if the kernel has it.
    fn quaternion(&self, letter: Letter) -> Option<String> {
        let _ = letter;
        None
    }
}

/// A kernel, and the sources of its inputs.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// The operations.
    pub kernel: Kernel,
    /// One source for each input.
    pub sources: Vec<Source>,
}

/// Lowers a program: its temporaries under their names, its results as outputs. `name` spells a temporary.
pub fn program(
    p: &Program,
    inputs: &dyn Inputs,
    name: &dyn Fn(crate::expr::symbol::SymbolId) -> String,
) -> Lowered {
    let mut lowering = Lowering::new(&p.symbols, inputs);
    for (id, e) in &p.temporaries {
        let value = lowering.value(e);
        // A value that has a name keeps it.
        let line = lowering.kernel.line(value);
        if line.name.is_none() && !matches!(line.operation, Operation::Input(_)) {
            lowering.kernel.name(value, &name(*id));
        }
        lowering.temporaries.push((*id, value));
    }
    for e in &p.results {
        let value = lowering.value(e);
        lowering.kernel.outputs.push(value);
    }
    lowering.done()
}

/// Lowers one expression.
pub fn expression(symbols: &Symbols, e: &Expr, inputs: &dyn Inputs) -> Lowered {
    let mut lowering = Lowering::new(symbols, inputs);
    let value = lowering.value(e);
    lowering.kernel.outputs.push(value);
    lowering.done()
}

/// A kernel under construction.
pub(crate) struct Lowering<'a> {
    symbols: &'a Symbols,
    inputs: &'a dyn Inputs,
    kernel: Kernel,
    sources: Vec<Source>,
    temporaries: Vec<(crate::expr::symbol::SymbolId, Value)>,
}

impl<'a> Lowering<'a> {
    fn new(symbols: &'a Symbols, inputs: &'a dyn Inputs) -> Self {
        Lowering {
            symbols,
            inputs,
            kernel: Kernel::new(),
            sources: Vec::new(),
            temporaries: Vec::new(),
        }
    }

    fn done(self) -> Lowered {
        Lowered {
            kernel: self.kernel,
            sources: self.sources,
        }
    }

    /// Adds an operation. Constructors of expressions check shapes, so every operation fits.
    fn push(&mut self, operation: Operation) -> Value {
        let misfit = |e| unreachable!("an expression of the wrong shape: {e}");
        self.kernel.push(operation).unwrap_or_else(misfit)
    }

    fn one(&mut self, single: Single, a: Value) -> Value {
        self.push(Operation::One(single, a))
    }

    fn two(&mut self, pair: Pair, a: Value, b: Value) -> Value {
        self.push(Operation::Two(pair, a, b))
    }

    fn of(&mut self, single: Single, e: &Expr) -> Value {
        let a = self.value(e);
        self.one(single, a)
    }

    fn input(&mut self, name: &str, kind: Kind, source: Source) -> Value {
        let misfit = |e| unreachable!("an input of the wrong shape: {e}");
        let value = self.kernel.input(name, kind).unwrap_or_else(misfit);
        if self.kernel.inputs().len() > self.sources.len() {
            self.sources.push(source);
        }
        value
    }

    /// The value of an expression.
    pub(crate) fn value(&mut self, e: &Expr) -> Value {
        match e.node() {
            Node::Number(q) => self.rational(*q),
            Node::Constant(c) => {
                let number = match *c == Constant::PI {
                    true => Number::Pi,
                    false => Number::Double(c.value()),
                };
                self.push(Operation::Number(number))
            }
            Node::Letter(l) => self.letter(*l),
            Node::Identity(_) => self.push(Operation::Identity(e.shape())),
            Node::Zero(_) => self.push(Operation::Zero(e.shape())),
            Node::Unit(_, axis) => self.push(Operation::Unit(e.shape().rows, *axis as usize)),
            Node::Inclusion(_, at) => self.push(Operation::Inclusion(e.shape(), *at as usize)),
            Node::Sum(terms) => self.sum(terms),
            Node::Neg(a) => self.of(Single::Neg, a),
            Node::Product(factors) => self.product(factors),
            Node::Quotient(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.two(Pair::Div, a, b)
            }
            Node::Power(a, q) => self.power(a, *q),
            Node::Transpose(a) => self.of(Single::Transpose, a),
            Node::Inverse(a) => self.of(Single::Inverse, a),
            Node::Trace(a) => self.of(Single::Trace, a),
            Node::Det(a) => self.of(Single::Determinant, a),
            Node::Adjugate(a) => self.of(Single::Adjugate, a),
            Node::Dot(a, b) => self.dot(a, b),
            Node::Cross(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.two(Pair::Cross, a, b)
            }
            Node::Hat(a) => self.of(Single::Hat, a),
            Node::Vee(a) => self.of(Single::Vee, a),
            Node::Part(which, a) => {
                let single = match which {
                    Part::Symmetric => Single::SymmetricPart,
                    Part::Skew => Single::SkewPart,
                    Part::Diagonal => Single::DiagonalPart,
                };
                self.of(single, a)
            }
            Node::Call(function, a) => {
                let single = match function {
                    Function::Exp => Single::Exp,
                    Function::Log => Single::Log,
                    Function::Sin => Single::Sin,
                    Function::Cos => Single::Cos,
                    Function::Sinh => Single::Sinh,
                    Function::Cosh => Single::Cosh,
                    Function::Tanh => Single::Tanh,
                    Function::Abs => Single::Abs,
                    Function::Sign => Single::Sign,
                };
                self.of(single, a)
            }
            Node::Map(map, a) => self.map(*map, a),
            Node::Given(a) => self.functional(e, a, None),
            Node::PullBack(a, which, seed) => self.functional(e, a, Some((*which, seed))),
        }
    }

    fn letter(&mut self, l: Letter) -> Value {
        let temporary = self.temporaries.iter().find(|(id, _)| *id == l.symbol);
        if let Some((_, value)) = temporary {
            return *value;
        }
        let name = self.inputs.letter(self.symbols, l);
        let kind = Kind::Array(self.symbols.get(l.symbol).shape);
        self.input(&name, kind, Source::Letter(l))
    }

    /// An exact number: a binary64 constant, or a quotient.
    pub(crate) fn rational(&mut self, q: Rational) -> Value {
        self.push(Operation::Number(number(q)))
    }

    fn power(&mut self, a: &Expr, q: Rational) -> Value {
        let base = self.value(a);
        if q == Rational::integer(2) {
            return self.two(Pair::Mul, base, base);
        }
        if q == Rational::HALF {
            return self.one(Single::Sqrt, base);
        }
        if let Some(n) = q.as_integer() {
            return self.push(Operation::Power(base, n));
        }
        let part = |x| i64::try_from(x).unwrap_or(0);
        self.push(Operation::Root(
            base,
            part(q.numerator()),
            part(q.denominator()),
        ))
    }

    fn dot(&mut self, a: &Expr, b: &Expr) -> Value {
        let Node::Unit(_, row) = b.node() else {
            let (a, b) = (self.value(a), self.value(b));
            return self.two(Pair::Dot, a, b);
        };
        let row = *row as usize;
        // A single entry, instead of a column from which one entry is taken.
        if let Node::Product(factors) = a.node()
            && let [matrix, last] = factors.as_slice()
            && !matrix.shape().is_scalar()
            && let Node::Unit(_, col) = last.node()
        {
            let matrix = self.value(matrix);
            return self.push(Operation::EntryAt(matrix, row, *col as usize));
        }
        let a = self.value(a);
        self.push(Operation::Entry(a, row))
    }

    fn map(&mut self, map: Map, a: &Expr) -> Value {
        if map == Map::Rotation
            && let Node::Letter(l) = a.node()
            && let Some(name) = self.inputs.rotation(*l)
        {
            let shape = expr::rotation(self.symbols, a.clone()).shape();
            return self.input(&name, Kind::Array(shape), Source::RotationOf(*l));
        }
        if matches!(map, Map::Real | Map::Imaginary)
            && let Some(unit) = self.quaternion(a)
        {
            let single = match map {
                Map::Real => Single::Real,
                _ => Single::Imaginary,
            };
            return self.one(single, unit);
        }
        let single = match map {
            Map::Rotation if expr::is_motion(self.symbols, a) => Single::MotionRotation,
            Map::Rotation => Single::QuaternionRotation,
            Map::Translation => Single::MotionTranslation,
            Map::Twist => Single::Twist,
            Map::Diagonal => Single::Diagonal,
            Map::DiagonalOf => Single::DiagonalOf,
            Map::Real => Single::QuaternionReal,
            Map::Imaginary => Single::QuaternionImaginary,
            Map::Pure => Single::PureQuaternion,
        };
        self.of(single, a)
    }

    /// A unit quaternion that has a name as four numbers, or the relative quaternion of two of these.
    fn quaternion(&mut self, a: &Expr) -> Option<Value> {
        match quaternion(a, &|l| self.inputs.quaternion(l))? {
            Quaternion::Own(l, name) => {
                Some(self.input(&name, Kind::Quaternion, Source::QuaternionOf(l)))
            }
            Quaternion::Between(from, to) => {
                let [from, to] = [from, to]
                    .map(|(l, name)| self.input(&name, Kind::Quaternion, Source::QuaternionOf(l)));
                Some(self.two(Pair::Between, from, to))
            }
        }
    }

    /// Whether this is declared as a diagonal matrix.
    fn is_diagonal(&self, e: &Expr) -> bool {
        match e.node() {
            Node::Letter(at) => self.symbols.get(at.symbol).structure == Structure::Diagonal,
            _ => false,
        }
    }
}

/// An expression that is a unit quaternion.
pub(crate) enum Quaternion {
    /// The unit quaternion of a letter.
    Own(Letter, String),
    /// `conj(a) b`.
    Between((Letter, String), (Letter, String)),
}

/// The unit quaternion of an expression, if the letters have names as four numbers.
pub(crate) fn quaternion(a: &Expr, named: &dyn Fn(Letter) -> Option<String>) -> Option<Quaternion> {
    let bound = |e: &Expr| match e.node() {
        Node::Letter(l) => named(*l).map(|name| (*l, name)),
        _ => None,
    };
    if let Some((l, name)) = bound(a) {
        return Some(Quaternion::Own(l, name));
    }
    let Node::Product(two) = a.node() else {
        return None;
    };
    let [from, to] = two.as_slice() else {
        return None;
    };
    match from.node() {
        Node::Transpose(from) => Some(Quaternion::Between(bound(from)?, bound(to)?)),
        _ => None,
    }
}

/// An exact number as a constant.
pub(crate) fn number(q: Rational) -> Number {
    let (num, den) = (q.numerator(), q.denominator());
    let exact = den.count_ones() == 1 && num.unsigned_abs() < 1 << 53 && den < 1 << 53;
    match (exact, i64::try_from(num), i64::try_from(den)) {
        (false, Ok(num), Ok(den)) => Number::Ratio(num, den),
        _ => Number::Double(q.value()),
    }
}
