//! Heavy top, spatial representation: J and the arm chi are advected by the motion, and the vertical is a parameter. Takes weight,
//! z, the spatial J and chi at node 0, attitude, spatial momentum and h; gives attitude, momentum, J and chi at the nodes. Its half
//! kicks (h/2) w z x chi are the body kicks, rotated by Lambda.

use super::Unsolvable;
use super::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed};
use super::free_body_spatial::{seen_from_body, seen_from_space};
use super::heavy_top::{HeavyTop, Top};

/// The data of a top in the spatial frame at node 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialTop {
    /// Weight w.
    pub weight: f64,
    /// Upward vertical z.
    pub up: Vector,
    /// Poinsot (second moment) matrix J at node 0.
    pub poinsot: Matrix,
    /// Support -> centre of mass chi at node 0.
    pub arm: Vector,
}

/// A moving heavy top in the spatial representation.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTopSpatial {
    top: HeavyTop,
    poinsot: Matrix,
    arm: Vector,
}

impl HeavyTopSpatial {
    /// Starts a trajectory with the spatial momentum of node 0.
    pub fn start(
        top: &SpatialTop,
        attitude: &Quaternion,
        spatial_momentum: &Vector,
        h: f64,
    ) -> Result<HeavyTopSpatial, Unsolvable> {
        let rotation = attitude.matrix();
        let poinsot = seen_from_body(&top.poinsot, &rotation);
        let arm = apply_transposed(&rotation, &top.arm);
        let body = Top {
            poinsot,
            weight: arm.map(|c| top.weight * c),
            up: top.up,
        };
        let momentum = apply_transposed(&rotation, spatial_momentum);
        Ok(HeavyTopSpatial {
            top: HeavyTop::start(&body, attitude, &momentum, h)?,
            poinsot,
            arm,
        })
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        self.top.step()
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.top.attitude()
    }

    /// Spatial momentum m_k.
    pub fn spatial_momentum(&self) -> Vector {
        self.top.spatial_momentum()
    }

    /// Poinsot matrix J_k in space axes.
    pub fn poinsot(&self) -> Matrix {
        seen_from_space(&self.poinsot, &self.attitude().matrix())
    }

    /// Support -> centre of mass chi_k in space axes.
    pub fn arm(&self) -> Vector {
        apply(&self.attitude().matrix(), &self.arm)
    }

    /// Energy m . I_k^-1 m / 2 + w chi . z: oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        self.top.energy()
    }
}
