//! Free rigid body, body representation: explicit Moser-Veselov step with the trajectory's constant kappa. Takes J (any symmetric
//! Poinsot matrix with positive moments), attitude, body momentum and h; gives attitude and body momentum at the nodes. Based on
//! the equation of Hairer and Vilmart (2006) for the Rodrigues vector, in the kappa form.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, dot,
};
use super::principal_axes::PrincipalAxes;
use super::principal_root::Quartic;
use super::spaced::{SpacedQuaternion, SpacedVector};

/// Number of steps between two projections onto the conserved quantities; rounding accumulates over 64 steps at most.
const PROJECTION_EVERY: u32 = 64;

/// A moving free body, in principal axes with the middle moment second.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody {
    /// h/2 times the body momentum.
    u: SpacedVector,
    q: SpacedQuaternion,
    until_projection: u32,
    /// d_j d_k + a with d = I - kappa.
    adjugate: Vector,
    /// I_j - I_k, and twice that.
    gyration: Vector,
    double_gyration: Vector,
    /// The determinant det d + u^T d u along the trajectory, as constant + slope u_2^2.
    determinant: f64,
    determinant_slope: f64,
    axes: PrincipalAxes,
    /// h/2 times the spatial momentum, a = its square, and sum u_i^2 / I_i, all at node 0.
    spatial: Vector,
    a: f64,
    energy: f64,
    h: f64,
}

impl FreeBody {
    /// Starts a trajectory with the body momentum of node 0. Fails beyond the solvability bound.
    pub fn start(
        poinsot: &Matrix,
        attitude: &Quaternion,
        body_momentum: &Vector,
        h: f64,
    ) -> Result<FreeBody, Unsolvable> {
        let axes = PrincipalAxes::new(poinsot)?;
        let i = axes.moments;
        let u = axes.enter(body_momentum).map(|m| 0.5 * h * m);
        let q = axes.enter_attitude(attitude);
        let squares = u.map(|c| c * c);
        let a = squares[0] + squares[1] + squares[2];
        let kappa = Quartic::new(&i).constant_root(&squares, a)?;
        let d = i.map(|m| m - kappa);
        // a and sum u_i^2 / I_i are conserved, so u_1^2 and u_3^2 are linear in u_2^2; the middle moment bounds both slopes by -1
        // and 0. With three equal moments every component is constant.
        let reciprocal = i.map(|m| 1.0 / m);
        let spread = reciprocal[0] - reciprocal[2];
        let (slope_1, slope_3) = if spread == 0.0 {
            (0.0, 0.0)
        } else {
            (
                (reciprocal[2] - reciprocal[1]) / spread,
                (reciprocal[1] - reciprocal[0]) / spread,
            )
        };
        let determinant_slope = d[1] + (d[0] * slope_1 + d[2] * slope_3);
        let now = d[0] * d[1] * d[2] + d[0] * squares[0] + d[1] * squares[1] + d[2] * squares[2];
        let gyration = [i[1] - i[2], i[2] - i[0], i[0] - i[1]];
        Ok(FreeBody {
            u: SpacedVector::new(u),
            q: SpacedQuaternion::new(q),
            until_projection: PROJECTION_EVERY,
            adjugate: [d[1] * d[2] + a, d[2] * d[0] + a, d[0] * d[1] + a],
            gyration,
            double_gyration: gyration.map(|g| 2.0 * g),
            determinant: now - determinant_slope * squares[1],
            determinant_slope,
            axes,
            spatial: apply(&q.matrix(), &u),
            a,
            energy: squares[0] / i[0] + squares[1] / i[1] + squares[2] / i[2],
            h,
        })
    }

    /// Steps once.
    #[inline(always)]
    pub fn step(&mut self) {
        let [x, y, z] = self.u.get();
        let [p, q, r] = self.gyration;
        let [pp, qq, rr] = self.double_gyration;
        let determinant = self.determinant + self.determinant_slope * (y * y);
        let n1 = self.adjugate[0] * x + p * (y * z);
        let n2 = self.adjugate[1] * y + q * (z * x);
        let n3 = self.adjugate[2] * z + r * (x * y);
        let inverse = 1.0 / ((determinant * determinant + n1 * n1) + (n2 * n2 + n3 * n3));
        self.u.set([
            x + inverse * (pp * (n2 * n3)),
            y + inverse * (qq * (n3 * n1)),
            z + inverse * (rr * (n1 * n2)),
        ]);
        let turn = Quaternion([determinant, n1, n2, n3]);
        self.q.set(self.q.get().times(&turn).scaled(inverse.sqrt()));
        self.until_projection -= 1;
        if self.until_projection == 0 {
            self.project();
        }
    }

    /// Projects onto the momentum and energy of node 0: a Newton step for the body momentum, then the smallest rotation that aligns
    /// the attitude with the spatial momentum.
    #[cold]
    #[inline(never)]
    fn project(&mut self) {
        let i = self.axes.moments;
        let mut u = self.u.get();
        for _ in 0..2 {
            let square = dot(&u, &u);
            u = u.map(|c| c * (1.0 + 0.5 * (self.a - square) / self.a.max(f64::MIN_POSITIVE)));
            let rates = [u[0] / i[0], u[1] / i[1], u[2] / i[2]];
            let energy = dot(&u, &rates);
            // The component of the energy gradient tangent to the momentum sphere. At a steady rotation it vanishes, and the energy
            // leaves its extremum only by rounding.
            let along = add_scaled(&rates, -energy / self.a.max(f64::MIN_POSITIVE), &u);
            let slope = dot(&along, &along);
            if slope > 1e-12 * dot(&rates, &rates) {
                u = add_scaled(&u, 0.5 * (self.energy - energy) / slope, &along);
            }
        }
        let q = self.q.get().normalised();
        let turn = cross(&apply(&q.matrix(), &u), &self.spatial)
            .map(|c| 0.5 * c / self.a.max(f64::MIN_POSITIVE));
        let q = Quaternion([1.0, turn[0], turn[1], turn[2]])
            .times(&q)
            .normalised();
        self.u.set(u);
        self.q.set(q);
        self.until_projection = PROJECTION_EVERY;
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.q.get())
    }

    /// Body momentum mu_k at the current node.
    pub fn body_momentum(&self) -> Vector {
        self.axes.leave(&self.u.get()).map(|c| 2.0 * c / self.h)
    }

    /// Spatial momentum, computed from attitude and body momentum.
    pub fn spatial_momentum(&self) -> Vector {
        apply(&self.q.get().matrix(), &self.u.get()).map(|c| 2.0 * c / self.h)
    }

    /// Energy mu . I^-1 mu / 2.
    pub fn energy(&self) -> f64 {
        let i = self.axes.moments;
        let [x, y, z] = self.u.get();
        2.0 * (x * x / i[0] + y * y / i[1] + z * z / i[2]) / (self.h * self.h)
    }

    /// Body momentum from the attitude and the spatial momentum of node 0; differs from [`FreeBody::body_momentum`] by rounding
    /// only.
    pub fn momentum_from_attitude(&self) -> Vector {
        self.axes
            .leave(&apply_transposed(&self.q.get().matrix(), &self.spatial))
            .map(|c| 2.0 * c / self.h)
    }
}
