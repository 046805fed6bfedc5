//! Two rigid bodies with a spherical joint, centre of mass at rest (Grossman, Krishnaprasad, Marsden
//! 1988): L = sum of xi_i . I_i xi_i / 2 - eps (xi_1 x d_1) . R (xi_2 x d_2), R = attitude_1^T
//! attitude_2, I_i about the joint's effective mass. Takes the parameters; gives fourteen equations,
//! y = (q_1, mu_1, q_2, mu_2).

use super::{Motion, inertia, spun};
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed, cross};

/// The two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledBodies {
    inertia: [Matrix; 2],
    arms: [Vector; 2],
    reduced_mass: f64,
}

impl CoupledBodies {
    /// Bodies with Poinsot matrices J_i + eps d_i d_i^T, arms d_i from the joint, and reduced mass eps.
    pub fn new(poinsot: [Matrix; 2], arms: [Vector; 2], reduced_mass: f64) -> Self {
        Self {
            inertia: [inertia(&poinsot[0]), inertia(&poinsot[1])],
            arms,
            reduced_mass,
        }
    }

    /// The 6 x 6 matrix from both angular velocities to both momenta.
    fn mass(&self, r: &Matrix) -> [[f64; 6]; 6] {
        let [d, e] = self.arms;
        let mut mass = [[0.0; 6]; 6];
        for k in 0..3 {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            // d/d xi_1 of -eps (xi_1 x d) . v is -eps d x v.
            let v = apply(r, &cross(&unit, &e));
            let coupling = cross(&d, &v).map(|c| -self.reduced_mass * c);
            for i in 0..3 {
                mass[i][k] = self.inertia[0][i][k];
                mass[i + 3][k + 3] = self.inertia[1][i][k];
                mass[i][k + 3] = coupling[i];
                mass[k + 3][i] = coupling[i];
            }
        }
        mass
    }
}

/// Solves a symmetric positive definite system by Cholesky factorisation; entries are not finite if the matrix is not positive
/// definite.
fn solve(mut a: [[f64; 6]; 6], mut b: [f64; 6]) -> [f64; 6] {
    for k in 0..6 {
        let pivot = a[k][k].sqrt();
        for row in a.iter_mut().skip(k) {
            row[k] /= pivot;
        }
        for j in k + 1..6 {
            for i in j..6 {
                a[i][j] -= a[i][k] * a[j][k];
            }
        }
    }
    for k in 0..6 {
        let known: f64 = (0..k).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    for k in (0..6).rev() {
        let known: f64 = (k + 1..6).map(|j| a[j][k] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

impl Motion<14> for CoupledBodies {
    fn rate(&self, y: &[f64; 14], out: &mut [f64; 14]) {
        let [w1, x1, y1, z1, a1, b1, c1, w2, x2, y2, z2, a2, b2, c2] = *y;
        let (q1, q2) = (Quaternion([w1, x1, y1, z1]), Quaternion([w2, x2, y2, z2]));
        let r = q1.conjugate().times(&q2).matrix();
        let v = solve(self.mass(&r), [a1, b1, c1, a2, b2, c2]);
        let (xi1, xi2) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
        let (p, s) = (cross(&xi1, &self.arms[0]), cross(&xi2, &self.arms[1]));
        // Rotating body 1 by eta changes R by -hat(eta) R, and the Lagrangian by eps eta . (R s x p). Rotating body 2 changes the
        // Lagrangian by the opposite amount, in the frame of body 2.
        let torque1 = cross(&apply(&r, &s), &p).map(|c| self.reduced_mass * c);
        let torque2 = apply_transposed(&r, &torque1).map(|c| -c);
        let (t1, t2) = (cross(&[a1, b1, c1], &xi1), cross(&[a2, b2, c2], &xi2));
        let (r1, r2) = (spun(&q1, &xi1), spun(&q2, &xi2));
        let p1: Vector = std::array::from_fn(|i| t1[i] + torque1[i]);
        let p2: Vector = std::array::from_fn(|i| t2[i] + torque2[i]);
        let parts = r1.iter().chain(&p1).chain(&r2).chain(&p2);
        for (place, value) in out.iter_mut().zip(parts) {
            *place = *value;
        }
    }
}
