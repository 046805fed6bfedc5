//! Shapes and structures of quantities: how many rows and columns, and which identity
//! (symmetric, skew, orthogonal, ...) a matrix obeys whatever its value.

/// One dimension of a matrix: a number, or a declared name (`dim n in 3..=8`).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Dim {
    /// A number known when the model is stated.
    Fixed(u32),
    /// The n-th declared dimension of the model.
    Named(u16),
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
    pub const fn vector(n: Dim) -> Shape {
        Shape { rows: n, cols: ONE }
    }

    /// A square matrix.
    pub const fn square(n: Dim) -> Shape {
        Shape { rows: n, cols: n }
    }

    /// Whether this is a number.
    pub fn is_scalar(self) -> bool {
        self == Shape::SCALAR
    }

    /// Whether this is a column vector (and not a number).
    pub fn is_vector(self) -> bool {
        self.cols == ONE && self.rows != ONE
    }

    /// Whether rows and columns agree.
    pub fn is_square(self) -> bool {
        self.rows == self.cols
    }

    /// The shape of the transpose.
    pub fn transposed(self) -> Shape {
        Shape {
            rows: self.cols,
            cols: self.rows,
        }
    }
}

/// What a matrix obeys whatever its value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Structure {
    /// Nothing.
    General,
    /// `A^T = A`.
    Symmetric,
    /// `A^T = -A`.
    Skew,
    /// Diagonal, hence symmetric.
    Diagonal,
    /// `A^T = A^-1` and `det A = 1`: an element of SO(n).
    Orthogonal,
    /// Has an inverse: an element of GL(n).
    Invertible,
    /// Left multiplication by a unit quaternion, 4 x 4: an element of SU(2). Orthogonal.
    UnitQuaternion,
    /// A homogeneous matrix `[R x; 0 1]` of a rigid motion.
    RigidMotion,
}

impl Structure {
    /// Whether the transpose is the matrix itself.
    pub fn is_symmetric(self) -> bool {
        matches!(self, Structure::Symmetric | Structure::Diagonal)
    }

    /// Whether the inverse exists for every admissible value.
    pub fn is_invertible(self) -> bool {
        match self {
            Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => true,
            Structure::General | Structure::Symmetric | Structure::Skew | Structure::Diagonal => {
                false
            }
        }
    }

    /// Whether the inverse is the transpose.
    pub fn is_orthogonal(self) -> bool {
        matches!(self, Structure::Orthogonal | Structure::UnitQuaternion)
    }

    /// Whether the determinant is 1.
    pub fn is_unimodular(self) -> bool {
        self.is_orthogonal() || self == Structure::RigidMotion
    }
}
