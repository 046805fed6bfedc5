//! A rigid body in an ideal fluid: Kirchhoff's equations (Lamb, Hydrodynamics, 124) with weight and buoyancy, attitude and
//! position. Thirteen equations, y = (w, x, y, z, position, angular momentum, linear momentum). The momenta are about the body's
//! point in body axes; the position is in spatial axes.

use super::{Motion, inertia, inverse, spun};
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, product, scaled, sum,
    transposed_product,
};
use crate::handwritten::kirchhoff_body::Submerged;

/// The body, with its kinetic energy omega . I omega/2 + omega . D u + u . M u/2 solved for the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubmergedBody {
    /// I^-1.
    inverse_inertia: Matrix,
    /// D.
    coupling: Matrix,
    /// I^-1 D.
    turning: Matrix,
    /// (M - D^T I^-1 D)^-1: the inverse mass while the body is free to rotate.
    inverse_masses: Matrix,
    moment: Vector,
    weight: f64,
    up: Vector,
}

impl SubmergedBody {
    /// The equations of this body; not finite if its kinetic energy is not positive definite.
    pub fn new(body: &Submerged) -> Self {
        let inverse_inertia = inverse(&inertia(&body.poinsot));
        let turning = product(&inverse_inertia, &body.coupling);
        let carried = transposed_product(&body.coupling, &turning);
        Self {
            inverse_inertia,
            coupling: body.coupling,
            turning,
            inverse_masses: inverse(&sum(&body.masses, -1.0, &carried)),
            moment: body.moment,
            weight: body.weight,
            up: body.up,
        }
    }

    /// Angular and linear velocity in body axes, from pi = I omega + D u and p = D^T omega + M u.
    fn velocities(&self, pi: &Vector, p: &Vector) -> (Vector, Vector) {
        let free = add_scaled(p, -1.0, &apply_transposed(&self.turning, pi));
        let u = apply(&self.inverse_masses, &free);
        let left = add_scaled(pi, -1.0, &apply(&self.coupling, &u));
        (apply(&self.inverse_inertia, &left), u)
    }
}

impl Motion<13> for SubmergedBody {
    #[inline(always)]
    fn rate(&self, y: &[f64; 13], out: &mut [f64; 13]) {
        let [q0, q1, q2, q3, _, _, _, a, b, c, d, e, f] = *y;
        let (q, pi, p) = (Quaternion([q0, q1, q2, q3]), [a, b, c], [d, e, f]);
        let (omega, u) = self.velocities(&pi, &p);
        let rotation = q.matrix();
        // The potential moment . g + weight (position . up), with g = attitude^T up.
        let g = apply_transposed(&rotation, &self.up);
        let pushed = add_scaled(&cross(&pi, &omega), 1.0, &cross(&p, &u));
        let torque = add_scaled(&pushed, 1.0, &cross(&g, &self.moment));
        let force = add_scaled(&cross(&p, &omega), 1.0, &scaled(-self.weight, &g));
        let (turned, moved) = (spun(&q, &omega), apply(&rotation, &u));
        let parts = turned.iter().chain(&moved).chain(&torque).chain(&force);
        for (place, value) in out.iter_mut().zip(parts) {
            *place = *value;
        }
    }
}
