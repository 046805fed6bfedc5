//! The engine's view of rigid motions of a space of any dimension: the angular and the linear part of their
//! covectors, and the effect of rotations and positions on them. Takes expressions of the space; gives expressions of
//! the space.

use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// A group of rigid motions `p -> R p + x`. Covectors and velocities in continuous time are an angular part stacked
/// on a linear one.
pub trait Euclidean {
    /// The dimension of its space.
    fn space(&self) -> Dim;

    /// The number of coordinates of rotations.
    fn angles(&self) -> Dim;

    /// The velocity of a spatial position that rotates about the origin, `ω × x`.
    fn swept(&self, s: &Symbols, turning: Expr, place: Expr) -> Expr;

    /// The moment of a linear momentum about the origin, `x × l`.
    fn moment(&self, s: &Symbols, place: Expr, linear: Expr) -> Expr;

    /// An angular part in a frame that is rotated by `turn`.
    fn turned(&self, turn: Expr, angular: Expr) -> Expr;

    /// An angular part in the form that is combined with rotations of other groups: an axial vector or a skew matrix.
    fn as_turn(&self, s: &Symbols, angular: Expr) -> Expr;

    /// The inverse of [`Euclidean::as_turn`], for an angular velocity.
    fn of_turn(&self, turn: Expr) -> Expr;
}

impl dyn Euclidean + '_ {
    /// The shape of an angular part.
    pub fn angular_shape(&self) -> Shape {
        Shape::vector(self.angles())
    }

    /// The shape of a linear part.
    pub fn linear_shape(&self) -> Shape {
        Shape::vector(self.space())
    }

    /// The position of the two parts in a vector of coordinates: the first row, and the number of rows.
    pub fn rows(&self) -> [(u8, Dim); 2] {
        let first = match self.angles() {
            Dim::Fixed(n) => u8::try_from(n).unwrap_or(u8::MAX),
            Dim::Named(_) => u8::MAX,
        };
        [(0, self.angles()), (first, self.space())]
    }

    /// The angular part of a vector of coordinates.
    pub fn angular(&self, s: &Symbols, x: &Expr) -> Expr {
        let [(at, count), _] = self.rows();
        expr::rows_of(s, x, at, count)
    }

    /// The linear part of a vector of coordinates.
    pub fn linear(&self, s: &Symbols, x: &Expr) -> Expr {
        let [_, (at, count)] = self.rows();
        expr::rows_of(s, x, at, count)
    }
}
