//! Heavy top with the whole kick at the head of each edge (the form printed in the thesis, with its sign corrected): N_{k+1} =
//! Om_k^T N_k + h Gamma_k x gU. First order if N_{k+1} is read as the momentum at node k. Takes J, gU, z, attitude, N_1 and h;
//! gives attitude, N_{k+1} and Gamma_k.

use super::Unsolvable;
use super::attitude::{Quaternion, Vector, add_scaled, apply_transposed, cross, dot};
use super::heavy_top::Top;
use super::principal_axes::PrincipalAxes;
use super::principal_root::Quartic;

/// A heavy top in edge momenta, simple rather than fast.
#[derive(Clone, Copy, Debug)]
pub struct OneSidedTop {
    q: Quaternion,
    /// N_{k+1} in principal axes.
    n: Vector,
    weight: Vector,
    up: Vector,
    quartic: Quartic,
    axes: PrincipalAxes,
    h: f64,
}

/// The rotation (as a quaternion) that solves Om J - J Om^T = h hat(n) in principal axes.
pub fn edge_rotation(
    axes: &PrincipalAxes,
    quartic: &Quartic,
    n: &Vector,
    h: f64,
) -> Result<Quaternion, Unsolvable> {
    let u = n.map(|c| 0.5 * h * c);
    let squares = u.map(|c| c * c);
    let a = squares[0] + squares[1] + squares[2];
    let kappa = quartic.constant_root(&squares, a)?;
    let i = axes.moments;
    let d = i.map(|m| m - kappa);
    Ok(Quaternion([
        d[0] * d[1] * d[2] + d[0] * squares[0] + d[1] * squares[1] + d[2] * squares[2],
        (d[1] * d[2] + a) * u[0] + (i[1] - i[2]) * u[1] * u[2],
        (d[2] * d[0] + a) * u[1] + (i[2] - i[0]) * u[2] * u[0],
        (d[0] * d[1] + a) * u[2] + (i[0] - i[1]) * u[0] * u[1],
    ])
    .normalised())
}

impl OneSidedTop {
    /// Starts with the momentum N_1 of the first edge, in the body axes of node 0.
    pub fn start(
        top: &Top,
        attitude: &Quaternion,
        edge_momentum: &Vector,
        h: f64,
    ) -> Result<OneSidedTop, Unsolvable> {
        let axes = PrincipalAxes::new(&top.poinsot)?;
        Ok(OneSidedTop {
            q: axes.enter_attitude(attitude),
            n: axes.enter(edge_momentum),
            weight: axes.enter(&top.weight),
            up: top.up,
            quartic: Quartic::new(&axes.moments),
            axes,
            h,
        })
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let turn = edge_rotation(&self.axes, &self.quartic, &self.n, self.h)?;
        self.q = self.q.times(&turn).normalised();
        let carried = apply_transposed(&turn.matrix(), &self.n);
        let vertical = apply_transposed(&self.q.matrix(), &self.up);
        self.n = add_scaled(&carried, self.h, &cross(&vertical, &self.weight));
        Ok(())
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.q)
    }

    /// Momentum N_{k+1} of the outgoing edge of the current node k, in its body axes.
    pub fn edge_momentum(&self) -> Vector {
        self.axes.leave(&self.n)
    }

    /// The vertical in body axes, Gamma_k.
    pub fn vertical(&self) -> Vector {
        self.axes
            .leave(&apply_transposed(&self.q.matrix(), &self.up))
    }

    /// Energy with N_{k+1} as the momentum of node k: the error is O(h), which is the defect of the one-sided form.
    pub fn energy(&self) -> f64 {
        let i = self.axes.moments;
        let [x, y, z] = self.n;
        let vertical = apply_transposed(&self.q.matrix(), &self.up);
        0.5 * (x * x / i[0] + y * y / i[1] + z * z / i[2]) + dot(&self.weight, &vertical)
    }
}
