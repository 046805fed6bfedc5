//! Other ways to move a free rigid body: what they start from, and what all of them can do.
//! Takes a Poinsot matrix, attitude, body momentum and h; gives attitude and body momentum node by
//! node, in the user's axes.

pub mod exact;
pub mod implicit;
pub mod splitting;

use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector};

/// What a free body starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Poinsot (second-moment) matrix J in body axes.
    pub poinsot: Matrix,
    /// Attitude body -> space at node 0.
    pub attitude: Quaternion,
    /// Angular momentum in body axes at node 0.
    pub body_momentum: Vector,
    /// Step length.
    pub h: f64,
}

/// A free body on its way.
pub trait FreeMotion {
    /// One step.
    ///
    /// # Errors
    /// [`Unsolvable`] when an implicit step has no solution, or does not find it.
    fn step(&mut self) -> Result<(), Unsolvable>;

    /// Attitude body -> space at the present node.
    fn attitude(&self) -> Quaternion;

    /// Angular momentum in body axes at the present node.
    fn body_momentum(&self) -> Vector;
}

impl FreeMotion for crate::handwritten::free_body::FreeBody {
    fn step(&mut self) -> Result<(), Unsolvable> {
        Self::step(self);
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        Self::attitude(self)
    }

    fn body_momentum(&self) -> Vector {
        Self::body_momentum(self)
    }
}
