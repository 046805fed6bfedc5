//! The view of a stepper that measurements need, so that generated, hand-written and wrong ones are treated alike.
//! Takes the hand-written steppers; gives them as motions. Generated ones are wrapped where they are tested.

use crate::handwritten::attitude::{Matrix, Vector};
use crate::handwritten::free_body::FreeBody;
use crate::handwritten::heavy_top::HeavyTop;
use crate::handwritten::one_sided_top::OneSidedTop;

/// A body turning about a fixed point, at a node.
pub trait Motion {
    /// One step; the message of the refusal otherwise.
    fn step(&mut self) -> Result<(), String>;

    /// Rotation matrix body -> space.
    fn attitude(&self) -> Matrix;

    /// Node momentum in body axes.
    fn body_momentum(&self) -> Vector;

    /// Node momentum in space axes.
    fn spatial_momentum(&self) -> Vector;

    /// Energy as the stepper reports it.
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

/// The momentum of the edge that begins at the node, N_{k+1}, stands for the node momentum here.
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
