//! The common interface of steppers for the measurements, implemented here for the hand-written ones. The tests wrap the generated
//! steppers.

use crate::handwritten::attitude::{Matrix, Vector};
use crate::handwritten::free_body::FreeBody;
use crate::handwritten::heavy_top::HeavyTop;
use crate::handwritten::one_sided_top::OneSidedTop;

/// A body that rotates about a fixed point, at a node.
pub trait Motion {
    /// Steps once, or returns the error message.
    fn step(&mut self) -> Result<(), String>;

    /// Rotation matrix body -> space.
    fn attitude(&self) -> Matrix;

    /// Node momentum in body axes.
    fn body_momentum(&self) -> Vector;

    /// Node momentum in space axes.
    fn spatial_momentum(&self) -> Vector;

    /// The energy that the stepper reports.
    fn energy(&self) -> f64;

    /// The upward vertical in body axes; zero for a free body.
    fn vertical(&self) -> Vector {
        [0.0; 3]
    }
}

impl Motion for FreeBody {
    fn step(&mut self) -> Result<(), String> {
        FreeBody::step(self);
        Ok(())
    }

    fn attitude(&self) -> Matrix {
        FreeBody::attitude(self).matrix()
    }

    fn body_momentum(&self) -> Vector {
        FreeBody::body_momentum(self)
    }

    fn spatial_momentum(&self) -> Vector {
        FreeBody::spatial_momentum(self)
    }

    fn energy(&self) -> f64 {
        FreeBody::energy(self)
    }
}

impl Motion for HeavyTop {
    fn step(&mut self) -> Result<(), String> {
        HeavyTop::step(self).map_err(|refusal| refusal.to_string())
    }

    fn attitude(&self) -> Matrix {
        HeavyTop::attitude(self).matrix()
    }

    fn body_momentum(&self) -> Vector {
        HeavyTop::body_momentum(self)
    }

    fn spatial_momentum(&self) -> Vector {
        HeavyTop::spatial_momentum(self)
    }

    fn energy(&self) -> f64 {
        HeavyTop::energy(self)
    }

    fn vertical(&self) -> Vector {
        HeavyTop::vertical(self)
    }
}

/// This stepper reports the momentum N_{k+1} of the outgoing edge as the node momentum.
impl Motion for OneSidedTop {
    fn step(&mut self) -> Result<(), String> {
        OneSidedTop::step(self).map_err(|refusal| refusal.to_string())
    }

    fn attitude(&self) -> Matrix {
        OneSidedTop::attitude(self).matrix()
    }

    fn body_momentum(&self) -> Vector {
        self.edge_momentum()
    }

    fn spatial_momentum(&self) -> Vector {
        crate::handwritten::attitude::apply(&Motion::attitude(self), &self.edge_momentum())
    }

    fn energy(&self) -> f64 {
        OneSidedTop::energy(self)
    }

    fn vertical(&self) -> Vector {
        OneSidedTop::vertical(self)
    }
}
