//! The terms that equality saturation rewrites. Operators have at most two operands, so that associativity and
//! commutativity are ordinary rules. All terms of a class of equal terms have the same shape.

use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::{Dim, Shape};
use clebsch_core::expr::{Constant, Letter};
use core::fmt;
use core::str::FromStr;
use egg::{Analysis, DidMerge, EGraph, Id, Language, define_language};

define_language! {
    /// Operators. A difference is a sum with a term scaled by -1; a quotient is a scaling by a power with exponent
    /// -1. The first operand of a scaling is a number, and a product (`*`) joins matrices with equal inner
    /// dimensions.
    pub enum Term {
        "+" = Sum([Id; 2]),
        "." = Scale([Id; 2]),
        "*" = Product([Id; 2]),
        "^" = Power([Id; 2]),
        "T" = Transpose(Id),
        "inv" = Inverse(Id),
        "tr" = Trace(Id),
        "det" = Det(Id),
        "dot" = Dot([Id; 2]),
        "cross" = Cross([Id; 2]),
        "hat" = Hat(Id),
        "vee" = Vee(Id),
        "sym" = Symmetric(Id),
        "skew" = Skew(Id),
        "diag" = Diagonal(Id),
        "exp" = Exp(Id),
        "log" = Log(Id),
        "id" = Identity(Id),
        "zero" = Zero([Id; 2]),
        Number(Number),
        Leaf(Leaf),
    }
}

/// An exact number, written `2`, `-1` or `1/2` in rules.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Number(pub Rational);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.denominator() {
            1 => write!(f, "{}", self.0.numerator()),
            den => write!(f, "{}/{den}", self.0.numerator()),
        }
    }
}

impl FromStr for Number {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let (num, den) = text.split_once('/').unwrap_or((text, "1"));
        let num = num.parse().map_err(|_| ())?;
        let den = den.parse().map_err(|_| ())?;
        Rational::new(num, den).map(Number).ok_or(())
    }
}

/// A term without operands, specific to the statement.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Leaf {
    /// A symbol at an offset, with its shape.
    Letter(Letter, Shape),
    /// A number outside the range of exact arithmetic.
    Constant(Constant),
    /// A dimension, as the operand of an identity or a zero matrix.
    Size(Dim),
    /// The unit vector along an axis counted from 0.
    Unit(Dim, u8),
}

impl fmt::Display for Leaf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Leaf::Letter(at, _) => write!(
                f,
                "letter{}@{},{},{}",
                at.symbol.0, at.shift.time, at.shift.label[0], at.shift.label[1]
            ),
            Leaf::Constant(c) => write!(f, "constant-{c}"),
            Leaf::Size(dim) => write!(f, "size-{dim:?}"),
            Leaf::Unit(dim, axis) => write!(f, "unit-{dim:?}-{axis}"),
        }
    }
}

/// Leaves come from statements only; a rule with a leaf is a mistake in the table.
impl FromStr for Leaf {
    type Err = ();

    fn from_str(_: &str) -> Result<Self, ()> {
        Err(())
    }
}

/// The shape of a term from the shapes of its operands; `None` if they do not match. A size counts as the identity
/// matrix of that size.
pub fn shape(node: &Term, operands: &[Shape]) -> Option<Shape> {
    let three = Dim::Fixed(3);
    let scalar = |s: Shape| s.is_scalar().then_some(s);
    let square = |s: Shape| s.is_square().then_some(s);
    match (node, operands) {
        (Term::Number(_), []) => Some(Shape::SCALAR),
        (Term::Leaf(leaf), []) => Some(match *leaf {
            Leaf::Letter(_, shape) => shape,
            Leaf::Constant(_) => Shape::SCALAR,
            Leaf::Size(dim) => Shape::square(dim),
            Leaf::Unit(dim, _) => Shape::vector(dim),
        }),
        (Term::Sum(_), [a, b]) => (a == b).then_some(*a),
        (Term::Scale(_), [s, a]) => scalar(*s).map(|_| *a),
        (Term::Product(_), [a, b]) => (a.cols == b.rows).then_some(Shape {
            rows: a.rows,
            cols: b.cols,
        }),
        (Term::Power(_), [a, q]) => scalar(*a).and(scalar(*q)),
        (Term::Transpose(_), [a]) => Some(a.transposed()),
        (Term::Inverse(_) | Term::Symmetric(_) | Term::Skew(_) | Term::Diagonal(_), [a]) => {
            square(*a)
        }
        (Term::Trace(_) | Term::Det(_), [a]) => square(*a).map(|_| Shape::SCALAR),
        (Term::Dot(_), [a, b]) => (a == b && a.cols == Dim::Fixed(1)).then_some(Shape::SCALAR),
        (Term::Cross(_), [a, b]) => (a == b && *a == Shape::vector(three)).then_some(*a),
        (Term::Hat(_), [a]) => (*a == Shape::vector(three)).then_some(Shape::square(three)),
        (Term::Vee(_), [a]) => (*a == Shape::square(three)).then_some(Shape::vector(three)),
        (Term::Exp(_) | Term::Log(_), [a]) => scalar(*a),
        (Term::Identity(_), [n]) => square(*n),
        (Term::Zero(_), [n, m]) => Some(Shape {
            rows: n.rows,
            cols: m.rows,
        }),
        _ => None,
    }
}

/// Facts about a class of equal terms.
#[derive(Clone, Debug)]
pub struct Fact {
    /// The common shape; `None` for an ill-shaped term, to which no rule applies.
    pub shape: Option<Shape>,
    /// The value, if one of the terms is a number.
    pub number: Option<Rational>,
}

/// Maintains a [`Fact`] for every class.
#[derive(Clone, Default, Debug)]
pub struct Facts;

impl Analysis<Term> for Facts {
    type Data = Fact;

    fn make(graph: &mut EGraph<Term, Self>, node: &Term, _: Id) -> Fact {
        let operands: Option<Vec<Shape>> = node
            .children()
            .iter()
            .map(|c| graph[*c].data.shape)
            .collect();
        Fact {
            shape: operands.and_then(|list| shape(node, &list)),
            number: match node {
                Term::Number(q) => Some(q.0),
                _ => None,
            },
        }
    }

    fn merge(&mut self, into: &mut Fact, from: Fact) -> DidMerge {
        let shape = egg::merge_option(&mut into.shape, from.shape, |_, _| DidMerge(false, false));
        let number =
            egg::merge_option(&mut into.number, from.number, |_, _| DidMerge(false, false));
        shape | number
    }
}
