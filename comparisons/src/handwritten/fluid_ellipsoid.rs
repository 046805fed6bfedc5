//! An incompressible self-gravitating ellipsoid (Dirichlet, Riemann), by its placement Q with det Q = 1: half a kick of gravity and
//! pressure, a drift, half a kick, and a projection of the momentum (RATTLE). The new placement is linear in the pressure impulse,
//! so its determinant is a cubic; the solver finds the root connected to zero. Takes moments, mass, placement and momentum; gives
//! placement and momentum after one step.

use super::Unsolvable;
use super::attitude::{Matrix, inverse, product, sum, transposed};
use super::ellipsoid;
use crate::elliptic::carlson_rj;

/// The data of the ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidEllipsoid {
    /// I0, second moments of mass in the reference.
    pub moments: Matrix,
    /// Mass, in units in which the gravitational constant is one.
    pub mass: f64,
}

/// Eigenvalues and eigenvectors (as columns) of a symmetric matrix, by Jacobi rotations.
fn spectrum(a: &Matrix) -> ([f64; 3], Matrix) {
    let (mut a, mut v) = (*a, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    // Convergence is quadratic; six sweeps reach rounding.
    for _ in 0..8 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if a[i][j] == 0.0 {
                continue;
            }
            let ratio = (a[j][j] - a[i][i]) / (2.0 * a[i][j]);
            let t = ratio.signum() / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
            let c = 1.0 / (1.0 + t * t).sqrt();
            let s = t * c;
            for m in [&mut a, &mut v] {
                for row in m.iter_mut() {
                    (row[i], row[j]) = (c * row[i] - s * row[j], s * row[i] + c * row[j]);
                }
            }
            let (first, second) = (a[i], a[j]);
            a[i] = std::array::from_fn(|k| c * first[k] - s * second[k]);
            a[j] = std::array::from_fn(|k| s * first[k] + c * second[k]);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

/// The cofactor matrix, which is the derivative of the determinant.
fn cofactors(q: &Matrix) -> Matrix {
    let (back, determinant) = ellipsoid::inverse(q);
    transposed(&back).map(|row| row.map(|x| determinant * x))
}

fn paired(a: &Matrix, b: &Matrix) -> f64 {
    let both = a.iter().flatten().zip(b.iter().flatten());
    both.map(|(x, y)| x * y).sum()
}

impl FluidEllipsoid {
    /// The gravitational force on the placement: `V = -(3/5) M² R_F(B)` with B = Q Qᵀ. The derivative of R_F with respect to x is
    /// -R_D(y, z, x)/6.
    fn pull(&self, q: &Matrix) -> Matrix {
        let (x, v) = spectrum(&product(q, &transposed(q)));
        let mut slope = [[0.0; 3]; 3];
        for k in 0..3 {
            let own = -carlson_rj(x[(k + 1) % 3], x[(k + 2) % 3], x[k], x[k]) / 6.0;
            for i in 0..3 {
                for j in 0..3 {
                    slope[i][j] += own * v[i][k] * v[j][k];
                }
            }
        }
        let twice = 6.0 / 5.0 * self.mass * self.mass;
        product(&slope, q).map(|row| row.map(|x| twice * x))
    }

    /// Placement, momentum and the pressure impulse divided by h, after a step of h. The initial placement must have determinant
    /// one, with a momentum that preserves it.
    ///
    /// # Errors
    /// [`Unsolvable`] if no pressure restores the determinant to one.
    pub fn step(
        &self,
        q: &Matrix,
        momentum: &Matrix,
        h: f64,
    ) -> Result<(Matrix, Matrix, f64), Unsolvable> {
        let back = inverse(&self.moments);
        let normal = cofactors(q);
        let free = sum(momentum, 0.5 * h, &self.pull(q));
        let mut pressure = 0.0;
        let placed = |pressure: f64| {
            let p = sum(&free, h * pressure, &normal);
            (sum(q, h, &product(&p, &back)), p)
        };
        let across = product(&normal, &back);
        for _ in 0..60 {
            let (next, _) = placed(pressure);
            let (_, determinant) = ellipsoid::inverse(&next);
            let change = (1.0 - determinant) / (h * h * paired(&cofactors(&next), &across));
            pressure += change;
            if !pressure.is_finite() {
                return Err(Unsolvable);
            }
            if change.abs() <= 1e-15 * pressure.abs() {
                break;
            }
        }
        let (next, p) = placed(pressure);
        let p = sum(&p, 0.5 * h, &self.pull(&next));
        let normal = cofactors(&next);
        let across = product(&normal, &back);
        let off = paired(&across, &p) / paired(&across, &normal);
        Ok((next, sum(&p, -off, &normal), pressure))
    }
}
