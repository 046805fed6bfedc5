//! Free rigid body, spatial representation: J is advected by the motion, and the spatial momentum is constant. Takes the spatial J,
//! attitude and spatial momentum of node 0, and h; gives attitude and J at the nodes. With J_k = Lambda_k J_b Lambda_k^T, the
//! equation om J_k - J_k om^T = h hat(m) is the body equation, rotated by Lambda_k.

use super::Unsolvable;
use super::attitude::{Matrix, Quaternion, Vector, apply_transposed};
use super::free_body::FreeBody;

/// A moving free body in the spatial representation.
#[derive(Clone, Copy, Debug)]
pub struct FreeBodySpatial {
    body: FreeBody,
    /// Lambda^T J Lambda, constant.
    poinsot: Matrix,
    momentum: Vector,
}

/// R^T M R, exactly symmetric.
pub fn seen_from_body(m: &Matrix, r: &Matrix) -> Matrix {
    let columns = [0, 1, 2].map(|j| [r[0][j], r[1][j], r[2][j]]);
    let images = columns.map(|c| super::attitude::apply(m, &c));
    let entry = |i: usize, j: usize| super::attitude::dot(&columns[i], &images[j]);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (entry(i, j) + entry(j, i))))
}

/// R M R^T, exactly symmetric.
pub fn seen_from_space(m: &Matrix, r: &Matrix) -> Matrix {
    let back = [0, 1, 2].map(|i| [r[0][i], r[1][i], r[2][i]]);
    seen_from_body(m, &back)
}

impl FreeBodySpatial {
    /// Starts a trajectory with the spatial J and momentum of node 0.
    pub fn start(
        poinsot: &Matrix,
        attitude: &Quaternion,
        spatial_momentum: &Vector,
        h: f64,
    ) -> Result<FreeBodySpatial, Unsolvable> {
        let rotation = attitude.matrix();
        let poinsot = seen_from_body(poinsot, &rotation);
        let momentum = apply_transposed(&rotation, spatial_momentum);
        Ok(FreeBodySpatial {
            body: FreeBody::start(&poinsot, attitude, &momentum, h)?,
            poinsot,
            momentum: *spatial_momentum,
        })
    }

    /// Steps once.
    #[inline(always)]
    pub fn step(&mut self) {
        self.body.step();
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.body.attitude()
    }

    /// Poinsot matrix J_k in space axes.
    pub fn poinsot(&self) -> Matrix {
        seen_from_space(&self.poinsot, &self.attitude().matrix())
    }

    /// Spatial momentum, constant since node 0.
    pub fn spatial_momentum(&self) -> Vector {
        self.momentum
    }

    /// Energy m . I_k^-1 m / 2.
    pub fn energy(&self) -> f64 {
        self.body.energy()
    }
}
