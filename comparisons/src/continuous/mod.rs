//! The continuous-time equations of motion for the references, written by hand from Lagrange's and Euler's equations. Each system
//! is a right-hand side on plain arrays, with attitudes as quaternions whose norm the equations conserve.

pub mod any_dimension;
pub mod coupled;
pub mod ellipsoid;
pub mod mixed_four;
pub mod point;
pub mod rigid;
pub mod submerged;

use crate::handwritten::attitude::{Matrix, Quaternion, Vector};

/// A system y' = f(y) of N equations.
pub trait Motion<const N: usize> {
    /// Writes f(y).
    fn rate(&self, y: &[f64; N], out: &mut [f64; N]);
}

/// q' = q (0, omega)/2 for a body angular velocity.
#[inline(always)]
pub fn spun(q: &Quaternion, omega: &Vector) -> [f64; 4] {
    let [x, y, z] = *omega;
    q.times(&Quaternion([0.0, 0.5 * x, 0.5 * y, 0.5 * z])).0
}

/// The inertia matrix tr(J) Id - J.
pub fn inertia(poinsot: &Matrix) -> Matrix {
    let trace = poinsot[0][0] + poinsot[1][1] + poinsot[2][2];
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let own = if r == c { trace } else { 0.0 };
            own - poinsot[r][c]
        })
    })
}

/// The inverse of a 3 x 3 matrix by cofactors; entries are not finite if the matrix is singular.
pub fn inverse(a: &Matrix) -> Matrix {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1]
    };
    let determinant =
        a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
    std::array::from_fn(|r| std::array::from_fn(|c| cofactor(c, r) / determinant))
}
