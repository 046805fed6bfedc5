//! The operations of kernels, and their names in listings and printed code.

use crate::kernel::Value;

/// A constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Number {
    /// A number that binary64 represents exactly.
    Double(f64),
    /// A quotient of integers, rounded once in the precision of the evaluation.
    Ratio(i64, i64),
    /// Pi.
    Pi,
}

/// The notation of an operation on one value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// `-a`
    Prefix,
    /// `a.f()`
    Method,
    /// `f(&a)`
    Function,
}

macro_rules! operations {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $case:ident $form:ident $word:literal,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum $name { $($(#[$doc])* $case,)* }

        impl $name {
            /// Its notation.
            #[must_use]
            pub fn form(self) -> Form {
                match self { $($name::$case => Form::$form,)* }
            }

            /// Its name in listings and in the runtime.
            #[must_use]
            pub fn word(self) -> &'static str {
                match self { $($name::$case => $word,)* }
            }
        }
    };
}

operations! {
    /// An operation on one value.
    Single {
        /// The negative, entry by entry.
        Neg Prefix "-",
        /// The transpose.
        Transpose Method "transpose",
        /// The sum of the diagonal, from the first entry on.
        Trace Method "trace",
        /// The square root of a number.
        Sqrt Method "sqrt",
        /// The exponential of a number.
        Exp Method "exp",
        /// The natural logarithm of a number.
        Log Method "ln",
        /// The sine of a number, in radians.
        Sin Method "sin",
        /// The cosine of a number, in radians.
        Cos Method "cos",
        /// The hyperbolic sine of a number.
        Sinh Method "sinh",
        /// The hyperbolic cosine of a number.
        Cosh Method "cosh",
        /// The hyperbolic tangent of a number.
        Tanh Method "tanh",
        /// The absolute value of a number.
        Abs Method "abs",
        /// -1, 0 or 1 by the sign of a number.
        Sign Method "sign",
        /// The real part of a unit quaternion.
        Real Method "real",
        /// The imaginary part of a unit quaternion.
        Imaginary Method "imaginary",
        /// The inverse of a matrix; NaN if no pivot is usable.
        Inverse Function "inverse_or_nan",
        /// The determinant; zero if no pivot is usable.
        Determinant Function "determinant",
        /// The adjugate of a matrix of two or three rows.
        Adjugate Function "adjugate",
        /// The skew matrix of the cross product, `hat(v) w = v x w`.
        Hat Function "hat",
        /// The axial vector of the skew part, `vee(hat(v)) = v`.
        Vee Function "vee",
        /// The axial vector of `A - Aᵀ`.
        AxialOfDifference Function "axial_of_difference",
        /// `tr(A) Id - A` of a 3 x 3 matrix.
        TraceComplement Function "trace_complement",
        /// `A - Id` for a matrix with columns of length 1, without loss of digits for small differences.
        LessIdentity Function "less_identity",
        /// `(A + Aᵀ)/2`.
        SymmetricPart Function "symmetric_part",
        /// `(A - Aᵀ)/2`.
        SkewPart Function "skew_part",
        /// The matrix without its off-diagonal entries.
        DiagonalPart Function "diagonal_part",
        /// The diagonal matrix with these entries.
        Diagonal Function "diagonal",
        /// The diagonal as a vector.
        DiagonalOf Function "diagonal_of",
        /// The rotation of a homogeneous matrix.
        MotionRotation Function "motion_rotation",
        /// The translation of a homogeneous matrix.
        MotionTranslation Function "motion_translation",
        /// The homogeneous matrix `[hat(ω) v; 0 0]` of `(ω, v)`.
        Twist Function "twist",
        /// The real part of the quaternion of a 4 x 4 left-multiplication matrix.
        QuaternionReal Function "quaternion_real",
        /// The imaginary part of that quaternion.
        QuaternionImaginary Function "quaternion_imaginary",
        /// The rotation of a unit quaternion, given as a 4 x 4 matrix.
        QuaternionRotation Function "quaternion_rotation",
        /// The 4 x 4 matrix of a purely imaginary quaternion.
        PureQuaternion Function "pure_quaternion",
    }
}

/// An operation on two values.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Pair {
    /// The sum, entry by entry.
    Add,
    /// The difference, entry by entry.
    Sub,
    /// A product of numbers, of an array and a number, or of matrices (weighted columns of the first, summed in order).
    Mul,
    /// A number or an array divided by a number.
    Div,
    /// `Aᵀ B` without the transpose.
    TransposedMul,
    /// The sum of the products of entries.
    Dot,
    /// The cross product.
    Cross,
    /// `hat(v) A`.
    Crossed,
    /// `A hat(v)`.
    Crossing,
    /// `D A` for a diagonal matrix `D`.
    DiagonalTimes,
    /// `A D` for a diagonal matrix `D`.
    TimesDiagonal,
    /// The unit quaternion from one to another: `conj(a) b`.
    Between,
}

impl Pair {
    /// Its name in listings and in the runtime.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Pair::Add => "+",
            Pair::Sub => "-",
            Pair::Mul => "*",
            Pair::Div => "/",
            Pair::TransposedMul => "tr_mul",
            Pair::Dot => "dot",
            Pair::Cross => "cross",
            Pair::Crossed => "crossed",
            Pair::Crossing => "crossing",
            Pair::DiagonalTimes => "diagonal_times",
            Pair::TimesDiagonal => "times_diagonal",
            Pair::Between => "between",
        }
    }
}

/// A call of a functional of the model, or of one of its derivatives.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Call {
    /// The index of the functional in the model.
    pub functional: usize,
    /// The number of arguments among the values; directions and the seed follow.
    pub arguments: usize,
    /// The arguments along which it is differentiated, counted from 0, in increasing order.
    pub along: Vec<u8>,
    /// The argument along which a seed is pulled back, counted from 0.
    pub back: Option<u8>,
    /// Arguments, then directions, then the seed.
    pub values: Vec<Value>,
    /// The rows and columns of the result.
    pub shape: crate::Shape,
}

/// An operation of a kernel.
#[derive(Clone, PartialEq, Debug)]
pub enum Operation {
    /// An input by its index.
    Input(usize),
    /// A constant.
    Number(Number),
    /// Ones on the diagonal.
    Identity(crate::Shape),
    /// All zeros.
    Zero(crate::Shape),
    /// A unit vector.
    Unit(crate::Dim, usize),
    /// The identity shifted down by a number of rows.
    Inclusion(crate::Shape, usize),
    /// An operation on one value.
    One(Single, Value),
    /// An operation on two values.
    Two(Pair, Value, Value),
    /// An integer power of a number, by repeated squaring.
    Power(Value, i32),
    /// A rational power `num/den` of a number.
    Root(Value, i64, i64),
    /// An entry of a vector by its row.
    Entry(Value, usize),
    /// An entry of a matrix by row and column.
    EntryAt(Value, usize, usize),
    /// Consecutive rows of a matrix, as many as the inclusion has columns.
    RowsFrom(Value, crate::Shape, usize),
    /// A matrix with zero rows above and below.
    IntoRows(Value, crate::Shape, usize),
    /// Consecutive columns of a matrix, as many as the inclusion has columns.
    ColumnsFrom(Value, crate::Shape, usize),
    /// A matrix with zero columns on both sides.
    IntoColumns(Value, crate::Shape, usize),
    /// A functional.
    Functional(Call),
}

impl Operation {
    /// The values that it uses, in the order of its arguments.
    #[must_use]
    pub fn uses(&self) -> Vec<Value> {
        match self {
            Operation::Input(_)
            | Operation::Number(_)
            | Operation::Identity(_)
            | Operation::Zero(_)
            | Operation::Unit(..)
            | Operation::Inclusion(..) => Vec::new(),
            Operation::One(_, a)
            | Operation::Power(a, _)
            | Operation::Root(a, ..)
            | Operation::Entry(a, _)
            | Operation::EntryAt(a, ..)
            | Operation::RowsFrom(a, ..)
            | Operation::IntoRows(a, ..)
            | Operation::ColumnsFrom(a, ..)
            | Operation::IntoColumns(a, ..) => vec![*a],
            Operation::Two(_, a, b) => vec![*a, *b],
            Operation::Functional(call) => call.values.clone(),
        }
    }
}
