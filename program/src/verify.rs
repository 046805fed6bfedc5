//! Computes the kind of the result of an operation; misfits are errors.

use crate::kernel::{Input, Line, Value};
use crate::operation::{Operation, Pair, Single};
use crate::shape::{Dim, Kind, Shape};
use core::fmt;

/// Why an operation does not fit its arguments.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Misfit {
    /// A line uses a value that is not computed before the line.
    Later(usize),
    /// An input that does not exist.
    Input(usize),
    /// Two inputs of different kinds have the same name.
    Renamed(String),
    /// The kinds of the arguments of a line do not fit its operation.
    Kinds(usize),
    /// An operation and the kinds of its arguments.
    Operation(&'static str, Vec<Kind>),
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Misfit::Later(at) => write!(f, "value {at} is used before it is computed"),
            Misfit::Input(at) => write!(f, "there is no input {at}"),
            Misfit::Renamed(name) => {
                write!(f, "two inputs of different kinds have the name {name}")
            }
            Misfit::Kinds(at) => write!(f, "line {at} gives another kind than it states"),
            Misfit::Operation(word, kinds) => {
                let kinds: Vec<String> = kinds.iter().map(ToString::to_string).collect();
                write!(f, "`{word}` does not take {}", kinds.join(" and "))
            }
        }
    }
}

impl std::error::Error for Misfit {}

const THREE: Dim = Dim::Fixed(3);
const FOUR: Dim = Dim::Fixed(4);

/// The kind of the result, after these lines.
///
/// # Errors
/// If an argument is missing or of a kind that the operation does not take.
pub fn kind_of(operation: &Operation, inputs: &[Input], lines: &[Line]) -> Result<Kind, Misfit> {
    let of = |v: &Value| lines.get(v.0).map(|l| l.kind).ok_or(Misfit::Later(v.0));
    match operation {
        Operation::Input(at) => inputs.get(*at).map(|i| i.kind).ok_or(Misfit::Input(*at)),
        Operation::Number(_) => Ok(Kind::SCALAR),
        Operation::Identity(shape) | Operation::Zero(shape) | Operation::Inclusion(shape, _) => {
            Ok(Kind::Array(*shape))
        }
        Operation::Unit(dim, _) => Ok(Kind::Array(Shape::vector(*dim))),
        Operation::One(single, a) => {
            let kind = of(a)?;
            single_of(*single, kind).ok_or_else(|| Misfit::Operation(single.word(), vec![kind]))
        }
        Operation::Two(pair, a, b) => {
            let kinds = [of(a)?, of(b)?];
            pair_of(*pair, kinds).ok_or_else(|| Misfit::Operation(pair.word(), kinds.to_vec()))
        }
        Operation::Power(a, _) | Operation::Root(a, ..) => match of(a)? {
            Kind::SCALAR => Ok(Kind::SCALAR),
            kind => Err(Misfit::Operation("power", vec![kind])),
        },
        Operation::Entry(a, _) | Operation::EntryAt(a, ..) => match of(a)? {
            Kind::Array(_) => Ok(Kind::SCALAR),
            kind @ Kind::Quaternion => Err(Misfit::Operation("entry", vec![kind])),
        },
        Operation::RowsFrom(a, whole, _) => part(
            of(a)?,
            whole.rows,
            |s| Shape {
                rows: whole.cols,
                ..s
            },
            |s| s.rows,
        ),
        Operation::IntoRows(a, whole, _) => part(
            of(a)?,
            whole.cols,
            |s| Shape {
                rows: whole.rows,
                ..s
            },
            |s| s.rows,
        ),
        Operation::ColumnsFrom(a, whole, _) => part(
            of(a)?,
            whole.rows,
            |s| Shape {
                cols: whole.cols,
                ..s
            },
            |s| s.cols,
        ),
        Operation::IntoColumns(a, whole, _) => part(
            of(a)?,
            whole.cols,
            |s| Shape {
                cols: whole.rows,
                ..s
            },
            |s| s.cols,
        ),
        Operation::Functional(call) => {
            for v in &call.values {
                of(v)?;
            }
            Ok(Kind::Array(call.shape))
        }
    }
}

/// The kind of a matrix whose rows or columns an inclusion selects or embeds.
fn part(
    kind: Kind,
    wanted: Dim,
    changed: impl Fn(Shape) -> Shape,
    own: impl Fn(Shape) -> Dim,
) -> Result<Kind, Misfit> {
    match kind {
        Kind::Array(shape) if own(shape) == wanted => Ok(Kind::Array(changed(shape))),
        kind => Err(Misfit::Operation("inclusion", vec![kind])),
    }
}

fn single_of(single: Single, kind: Kind) -> Option<Kind> {
    let Kind::Array(shape) = kind else {
        return match single {
            Single::Real => Some(Kind::SCALAR),
            Single::Imaginary => Some(Kind::Array(Shape::vector(THREE))),
            _ => None,
        };
    };
    let when = |fits: bool, shape: Shape| fits.then_some(Kind::Array(shape));
    let three = Shape::vector(THREE);
    match single {
        Single::Neg => Some(kind),
        Single::Transpose => Some(Kind::Array(shape.transposed())),
        Single::Trace | Single::Determinant => when(shape.is_square(), Shape::SCALAR),
        Single::Sqrt
        | Single::Exp
        | Single::Log
        | Single::Sin
        | Single::Cos
        | Single::Sinh
        | Single::Cosh
        | Single::Tanh
        | Single::Abs
        | Single::Sign => when(shape.is_scalar(), Shape::SCALAR),
        Single::Real | Single::Imaginary => None,
        Single::Inverse
        | Single::Adjugate
        | Single::LessIdentity
        | Single::SymmetricPart
        | Single::SkewPart
        | Single::DiagonalPart => when(shape.is_square(), shape),
        Single::TraceComplement => when(shape == Shape::square(THREE), shape),
        Single::Hat => when(shape == three, Shape::square(THREE)),
        Single::Vee | Single::AxialOfDifference => when(shape == Shape::square(THREE), three),
        Single::Diagonal => when(shape.cols == Dim::Fixed(1), Shape::square(shape.rows)),
        Single::DiagonalOf => when(shape.is_square(), Shape::vector(shape.rows)),
        Single::MotionRotation => Some(Kind::Array(Shape::square(less_one(shape)?))),
        Single::MotionTranslation => Some(Kind::Array(Shape::vector(less_one(shape)?))),
        Single::Twist => match shape.rows {
            Dim::Fixed(3) if shape.is_vector() => Some(Kind::Array(Shape::square(THREE))),
            Dim::Fixed(6) if shape.is_vector() => Some(Kind::Array(Shape::square(FOUR))),
            _ => None,
        },
        Single::QuaternionReal => when(shape == Shape::square(FOUR), Shape::SCALAR),
        Single::QuaternionImaginary => when(shape == Shape::square(FOUR), three),
        Single::QuaternionRotation => when(shape == Shape::square(FOUR), Shape::square(THREE)),
        Single::PureQuaternion => when(shape == three, Shape::square(FOUR)),
    }
}

/// The size of a homogeneous matrix in two or three dimensions without its last row.
fn less_one(shape: Shape) -> Option<Dim> {
    match (shape.is_square(), shape.rows) {
        (true, Dim::Fixed(n @ (3 | 4))) => Some(Dim::Fixed(n - 1)),
        _ => None,
    }
}

fn pair_of(pair: Pair, kinds: [Kind; 2]) -> Option<Kind> {
    let [Kind::Array(a), Kind::Array(b)] = kinds else {
        let both = kinds == [Kind::Quaternion; 2];
        return (both && pair == Pair::Between).then_some(Kind::Quaternion);
    };
    let three = Shape::vector(THREE);
    let shape = match pair {
        Pair::Add | Pair::Sub => (a == b).then_some(a),
        Pair::Mul if b.is_scalar() => Some(a),
        Pair::Mul => (a.cols == b.rows).then_some(Shape {
            rows: a.rows,
            cols: b.cols,
        }),
        Pair::Div => b.is_scalar().then_some(a),
        Pair::TransposedMul => (a.rows == b.rows).then_some(Shape {
            rows: a.cols,
            cols: b.cols,
        }),
        Pair::Dot => (a == b).then_some(Shape::SCALAR),
        Pair::Cross => (a == three && b == three).then_some(three),
        Pair::Crossed => (a == three && b == Shape::square(THREE)).then_some(b),
        Pair::Crossing => (a == Shape::square(THREE) && b == three).then_some(a),
        Pair::DiagonalTimes => (a.is_square() && a.cols == b.rows).then_some(b),
        Pair::TimesDiagonal => (b.is_square() && a.cols == b.rows).then_some(a),
        Pair::Between => None,
    };
    shape.map(Kind::Array)
}
