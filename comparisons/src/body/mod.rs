//! Other methods for a rigid body: their common initial data and interface. They take a Poinsot matrix, attitude,
//! body momentum and h, and return attitude and body momentum at each node, in the user's axes.

pub mod exact;
pub mod implicit;
pub mod splitting;

use crate::continuous::rigid::RigidBody;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector};
use crate::handwritten::body_in_field::{BodyInField, Field};
use crate::handwritten::free_body::FreeBody;
use crate::handwritten::heavy_top::HeavyTop;
use crate::runge_kutta::{RungeKutta, Scheme};

/// Initial data of a free body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Poinsot (second-moment) matrix J in body axes.
    pub poinsot: Matrix,
    /// Attitude body -> space at node 0.
    pub attitude: Quaternion,
    /// Angular momentum in body axes at node 0.
    pub body_momentum: Vector,
    /// Step size.
    pub h: f64,
}

/// The motion of a rigid body, free or in a field.
pub trait BodyMotion {
    /// Steps once.
    ///
    /// # Errors
    /// [`Unsolvable`] if an implicit step has no solution or does not converge.
    fn step(&mut self) -> Result<(), Unsolvable>;

    /// Attitude body -> space at the current node.
    fn attitude(&self) -> Quaternion;

    /// Angular momentum in body axes at the current node.
    fn body_momentum(&self) -> Vector;
}

impl BodyMotion for FreeBody {
    #[inline(always)]
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

impl BodyMotion for HeavyTop {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        Self::step(self)
    }

    fn attitude(&self) -> Quaternion {
        Self::attitude(self)
    }

    fn body_momentum(&self) -> Vector {
        Self::body_momentum(self)
    }
}

impl<F: Field> BodyMotion for BodyInField<F> {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        Self::step(self)
    }

    fn attitude(&self) -> Quaternion {
        Self::attitude(self)
    }

    fn body_momentum(&self) -> Vector {
        Self::body_momentum(self)
    }
}

impl<R: Scheme<7>> BodyMotion for RungeKutta<R, RigidBody, 7> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        Self::step(self)
    }

    fn attitude(&self) -> Quaternion {
        let [w, x, y, z, ..] = *self.state();
        Quaternion([w, x, y, z]).normalised()
    }

    fn body_momentum(&self) -> Vector {
        let [.., a, b, c] = *self.state();
        [a, b, c]
    }
}
