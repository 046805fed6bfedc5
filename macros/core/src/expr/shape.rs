//! Shapes and structures of quantities: the numbers of rows and columns, and the identity (symmetric, skew,
//! orthogonal, ...) that a matrix satisfies for all values.

pub use clebsch_program::{Dim, Shape};

/// An identity that a matrix satisfies for every value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Structure {
    /// No identity.
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
    /// Whether the matrix equals its transpose.
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

    /// Whether the inverse equals the transpose.
    pub fn is_orthogonal(self) -> bool {
        matches!(self, Structure::Orthogonal | Structure::UnitQuaternion)
    }

    /// Whether the determinant is 1.
    pub fn is_unimodular(self) -> bool {
        self.is_orthogonal() || self == Structure::RigidMotion
    }
}
