//! Sizes of values: rows and columns, as numbers or as declared names.

use core::fmt;

/// One dimension of a matrix: a number, or a declared name (`dim n in 3..=8`).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Dim {
    /// A number known when the model is stated.
    Fixed(u32),
    /// The n-th declared dimension of the model.
    Named(u16),
}

impl Dim {
    /// The number of rows or columns, given the sizes of declared names; `None` for a name without a size.
    #[must_use]
    pub fn size(self, sizes: &[usize]) -> Option<usize> {
        match self {
            Dim::Fixed(n) => Some(n as usize),
            Dim::Named(i) => sizes.get(usize::from(i)).copied(),
        }
    }
}

impl fmt::Display for Dim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Dim::Fixed(n) => write!(f, "{n}"),
            Dim::Named(i) => write!(f, "n{i}"),
        }
    }
}

/// Rows and columns. A scalar is 1 x 1, a vector n x 1.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Shape {
    /// Number of rows.
    pub rows: Dim,
    /// Number of columns.
    pub cols: Dim,
}

const ONE: Dim = Dim::Fixed(1);

impl Shape {
    /// A number.
    pub const SCALAR: Shape = Shape {
        rows: ONE,
        cols: ONE,
    };

    /// A column vector.
    #[must_use]
    pub const fn vector(n: Dim) -> Shape {
        Shape { rows: n, cols: ONE }
    }

    /// A square matrix.
    #[must_use]
    pub const fn square(n: Dim) -> Shape {
        Shape { rows: n, cols: n }
    }

    /// Whether this is a number.
    #[must_use]
    pub fn is_scalar(self) -> bool {
        self == Shape::SCALAR
    }

    /// Whether this is a column vector (and not a number).
    #[must_use]
    pub fn is_vector(self) -> bool {
        self.cols == ONE && self.rows != ONE
    }

    /// Whether rows and columns agree.
    #[must_use]
    pub fn is_square(self) -> bool {
        self.rows == self.cols
    }

    /// The shape of the transpose.
    #[must_use]
    pub fn transposed(self) -> Shape {
        Shape {
            rows: self.cols,
            cols: self.rows,
        }
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.is_scalar(), self.is_vector()) {
            (true, _) => f.write_str("number"),
            (_, true) => write!(f, "vector {}", self.rows),
            _ => write!(f, "matrix {} x {}", self.rows, self.cols),
        }
    }
}

/// The kind of a value of a kernel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Kind {
    /// A number, a vector or a matrix.
    Array(Shape),
    /// A unit quaternion as four numbers: real part first.
    Quaternion,
}

impl Kind {
    /// A number.
    pub const SCALAR: Kind = Kind::Array(Shape::SCALAR);

    /// The rows and columns of the value's storage in an evaluation.
    #[must_use]
    pub fn shape(self) -> Shape {
        match self {
            Kind::Array(shape) => shape,
            Kind::Quaternion => Shape::vector(Dim::Fixed(4)),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Array(shape) => shape.fmt(f),
            Kind::Quaternion => f.write_str("unit quaternion"),
        }
    }
}
