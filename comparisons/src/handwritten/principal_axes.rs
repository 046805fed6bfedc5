//! Principal axes of a body. The steppers run in principal axes, where inertia is diagonal, and convert input and output. Takes a
//! symmetric Poinsot (second moment) matrix J; gives the moments of inertia and the rotation to user axes.

use super::Unsolvable;
use super::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed};

/// Moments of inertia and their frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// I_1, I_2, I_3 = eigenvalues of tr(J) Id - J, all positive, I_2 between the others.
    pub moments: Vector,
    /// Rotation from principal components to user components; the identity if J is diagonal in this order.
    frame: Quaternion,
}

impl PrincipalAxes {
    /// Diagonalises J; fails if J has a moment that is not positive or an entry that is not finite.
    pub fn new(poinsot: &Matrix) -> Result<PrincipalAxes, Unsolvable> {
        let (second_moments, mut frame) = eigenframe(poinsot);
        let [a, b, c] = second_moments;
        let mut moments = [b + c, c + a, a + b];
        // At most two cyclic permutations of the axes bring the middle moment to the second place.
        let cyclic = Quaternion([0.5, 0.5, 0.5, 0.5]);
        while (moments[1] - moments[0]) * (moments[1] - moments[2]) > 0.0 {
            let [x, y, z] = moments;
            moments = [y, z, x];
            frame = frame.times(&cyclic);
        }
        if moments.iter().all(|m| *m > 0.0 && m.is_finite()) {
            Ok(PrincipalAxes { moments, frame })
        } else {
            Err(Unsolvable)
        }
    }

    /// Principal components of a body vector.
    pub fn enter(&self, v: &Vector) -> Vector {
        if self.frame == Quaternion::IDENTITY {
            *v
        } else {
            apply_transposed(&self.frame.matrix(), v)
        }
    }

    /// User components of a body vector in principal axes.
    pub fn leave(&self, v: &Vector) -> Vector {
        if self.frame == Quaternion::IDENTITY {
            *v
        } else {
            apply(&self.frame.matrix(), v)
        }
    }

    /// Attitude of the principal axes from an attitude of the user's axes.
    pub fn enter_attitude(&self, q: &Quaternion) -> Quaternion {
        if self.frame == Quaternion::IDENTITY {
            *q
        } else {
            q.times(&self.frame).normalised()
        }
    }

    /// Attitude of the user's axes from an attitude of the principal axes.
    pub fn leave_attitude(&self, q: &Quaternion) -> Quaternion {
        if self.frame == Quaternion::IDENTITY {
            *q
        } else {
            q.times(&self.frame.conjugate()).normalised()
        }
    }
}

/// Eigenvalues of a symmetric matrix, and the rotation whose columns are the eigenvectors, by cyclic Jacobi rotations.
fn eigenframe(matrix: &Matrix) -> (Vector, Quaternion) {
    let scale = matrix
        .iter()
        .flatten()
        .fold(0.0, |m: f64, c| m.max(c.abs()));
    let mut frame = Quaternion::IDENTITY;
    let mut here = *matrix;
    // Convergence is quadratic; ten sweeps are twice the number that any 3 x 3 matrix needs.
    for _ in 0..10 {
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let off = here[i][j];
            if off.abs() <= 1e-17 * scale || !off.is_finite() {
                continue;
            }
            // The smaller of the two angles that annihilate the entry; the larger one would only exchange axes, without end.
            let ratio = (here[i][i] - here[j][j]) / (2.0 * off);
            let angle =
                (1.0_f64.copysign(ratio) / (ratio.abs() + (1.0 + ratio * ratio).sqrt())).atan();
            let (sin, cos) = (0.5 * angle).sin_cos();
            let mut turn = [cos, 0.0, 0.0, 0.0];
            turn[k + 1] = sin;
            frame = frame.times(&Quaternion(turn)).normalised();
            // Recomputed from the given matrix, so that sweeps do not accumulate rounding.
            here = congruent(matrix, &frame.matrix());
        }
    }
    ([here[0][0], here[1][1], here[2][2]], frame)
}

/// R^T M R.
fn congruent(m: &Matrix, r: &Matrix) -> Matrix {
    let columns = [0, 1, 2].map(|j| [r[0][j], r[1][j], r[2][j]]);
    let images = columns.map(|c| apply(m, &c));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| super::attitude::dot(&columns[i], &images[j])))
}
