//! Heavy top, body representation, with the potential split over both ends of a step: second order, self-adjoint. Takes J, gU
//! (weight times support -> centre of mass, body axes), z (up, spatial axes), attitude, body momentum, h; gives attitude, momenta
//! and the vertical at the nodes. The state is the attitude quaternion and the spatial momentum.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, dot,
};
use super::principal_axes::PrincipalAxes;
use super::principal_root::{self, Quartic};
use super::spaced::{SpacedQuaternion, SpacedVector};

/// The data of a top: J and gU in body axes, z in spatial axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Top {
    /// Poinsot (second moment) matrix J.
    pub poinsot: Matrix,
    /// Weight times the vector from the support to the centre of mass.
    pub weight: Vector,
    /// Upward vertical.
    pub up: Vector,
}

/// A moving heavy top, in principal axes. Stores momenta times h/2 and forces times h^2/4.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop {
    q: SpacedQuaternion,
    /// Spatial momentum m_k of the node.
    m: SpacedVector,
    /// Half the spatial change of momentum at the node: z x (R gU).
    kick: SpacedVector,
    /// Body momentum of the outgoing edge, R^T (m + kick), the only input of the solver.
    u: SpacedVector,
    /// gU in principal axes.
    weight: Vector,
    double_weight: Vector,
    up: Vector,
    moments: Vector,
    gyration: Vector,
    quartic: Quartic,
    axes: PrincipalAxes,
    h: f64,
}

impl HeavyTop {
    /// Starts a trajectory with the body momentum of node 0.
    pub fn start(
        top: &Top,
        attitude: &Quaternion,
        body_momentum: &Vector,
        h: f64,
    ) -> Result<HeavyTop, Unsolvable> {
        let axes = PrincipalAxes::new(&top.poinsot)?;
        let i = axes.moments;
        let q = axes.enter_attitude(attitude);
        let rotation = q.matrix();
        let weight = axes.enter(&top.weight).map(|c| 0.25 * h * h * c);
        let momentum = axes.enter(body_momentum).map(|c| 0.5 * h * c);
        let vertical = apply_transposed(&rotation, &top.up);
        Ok(HeavyTop {
            q: SpacedQuaternion::new(q),
            m: SpacedVector::new(apply(&rotation, &momentum)),
            kick: SpacedVector::new(cross(&top.up, &apply(&rotation, &weight))),
            u: SpacedVector::new(add_scaled(&momentum, 1.0, &cross(&vertical, &weight))),
            weight,
            double_weight: weight.map(|c| 2.0 * c),
            up: top.up,
            moments: i,
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            quartic: Quartic::new(&i),
            axes,
            h,
        })
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let u = self.u.get();
        let squares = u.map(|c| c * c);
        let a = (squares[0] + squares[1]) + squares[2];
        let kappa = self.quartic.principal_root(&squares, a)?;
        let turn = principal_root::turn(&self.moments, &self.gyration, &u, &squares, a, kappa);
        let q = self.q.get();
        let unscaled = q.times(&turn);
        // The numerator removes the rounding error of |q|^2 = 1, to first order.
        let correction = 2.0 - q.norm_squared();
        let square = turn.norm_squared();
        let scale = (correction + correction) / square;
        let e = unscaled.deviation();
        // Spatial momentum of the edge, then the kicks before and after the new node.
        let n = add_scaled(&self.m.get(), 1.0, &self.kick.get());
        let carried = add_scaled(&n, scale, &apply_transposed(&e, &n));
        let vertical = add_scaled(&self.up, scale, &apply_transposed(&e, &self.up));
        let arm = add_scaled(&self.weight, scale, &apply(&e, &self.weight));
        let kick = cross(&self.up, &arm);
        self.u.set(add_scaled(
            &carried,
            1.0,
            &cross(&vertical, &self.double_weight),
        ));
        self.m.set(add_scaled(&n, 1.0, &kick));
        self.kick.set(kick);
        self.q.set(unscaled.scaled((0.5 * scale).sqrt()));
        Ok(())
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.q.get())
    }

    /// Spatial momentum m_k at the current node.
    pub fn spatial_momentum(&self) -> Vector {
        self.m.get().map(|c| 2.0 * c / self.h)
    }

    /// Body momentum mu_k at the current node.
    pub fn body_momentum(&self) -> Vector {
        self.axes
            .leave(&apply_transposed(&self.q.get().matrix(), &self.m.get()))
            .map(|c| 2.0 * c / self.h)
    }

    /// The vertical in body axes, Gamma_k.
    pub fn vertical(&self) -> Vector {
        self.axes
            .leave(&apply_transposed(&self.q.get().matrix(), &self.up))
    }

    /// Energy mu . I^-1 mu / 2 + gU . Gamma; oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        let mu = apply_transposed(&self.q.get().matrix(), &self.m.get());
        let rates = [
            mu[0] / self.moments[0],
            mu[1] / self.moments[1],
            mu[2] / self.moments[2],
        ];
        let potential = dot(
            &self.weight,
            &apply_transposed(&self.q.get().matrix(), &self.up),
        );
        (2.0 * dot(&mu, &rates) + 4.0 * potential) / (self.h * self.h)
    }

    /// Body momentum of the outgoing edge: N_{k+1} = mu_k + (h/2) Gamma_k x gU.
    pub fn edge_momentum(&self) -> Vector {
        self.axes.leave(&self.u.get()).map(|c| 2.0 * c / self.h)
    }
}
