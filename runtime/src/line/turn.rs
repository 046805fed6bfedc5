//! Rotations as unknowns of Newton's method: the vector `v` of the Cayley transform
//! `Ω = (Id - hat(v)/2)^-1 (Id + hat(v)/2)`. It represents every rotation except half turns.

use crate::Real;
use nalgebra::{Matrix3, Vector3};

/// `1/(1 + v.v/4)`.
#[inline(always)]
fn factor<T: Real>(v: &Vector3<T>) -> T {
    T::one() / (T::one() + v.dot(v) * T::from_f64(0.25))
}

/// The rotation with the Cayley vector `v`.
#[inline(always)]
#[must_use]
pub fn turn_of<T: Real>(v: &Vector3<T>) -> Matrix3<T> {
    let factor = factor(v);
    let half = factor * T::from_f64(0.5);
    let ([x, y, z], [a, b, c]) = (v.data.0[0], (v * factor).data.0[0]);
    let (xx, yy, zz) = (x * x * half, y * y * half, z * z * half);
    let (xy, xz, yz) = (x * y * half, x * z * half, y * z * half);
    let one = T::one();
    #[rustfmt::skip]
    let turn = Matrix3::new(
        one - (yy + zz), xy - c, xz + b,
        xy + c, one - (xx + zz), yz - a,
        xz - b, yz + a, one - (xx + yy),
    );
    turn
}

/// The change of `v` that changes its rotation by `Ω hat(η)`.
#[inline(always)]
fn vector_change<T: Real>(v: &Vector3<T>, eta: &Vector3<T>) -> Vector3<T> {
    let half = v * T::from_f64(0.5);
    eta + half.cross(eta) + half * half.dot(eta)
}

/// Converts a change `Ω hat(η)` of a rotation into the change of its vector. `velocity` is the vector at which the
/// derivative was taken.
#[inline(always)]
pub(super) fn of_vector<T: Real>(velocity: &[T], change: &mut [T]) {
    if let (&[x, y, z], [a, b, c]) = (velocity, change) {
        let change = vector_change(&Vector3::new(x, y, z), &Vector3::new(*a, *b, *c));
        [*a, *b, *c] = change.data.0[0];
    }
}

#[cfg(test)]
mod tests {
    use super::{turn_of, vector_change};
    use nalgebra::{Matrix3, Vector3};

    /// Compares with the defining quotient, and with central differences, whose error is quadratic in their step.
    #[test]
    fn a_turn_is_its_cayley_transform_and_changes_with_its_vector() {
        let v = Vector3::new(0.7, -1.3, 0.4);
        let hat = |v: Vector3<f64>| v.cross_matrix() * 0.5;
        let cayley = |v: Vector3<f64>| {
            let below = (Matrix3::identity() - hat(v))
                .try_inverse()
                .expect("is one");
            below * (Matrix3::identity() + hat(v))
        };
        assert!((turn_of(&v) - cayley(v)).norm() < 8.0 * f64::EPSILON);
        let h = 1e-5;
        for axis in 0..3 {
            let mut eta = Vector3::zeros();
            eta[axis] = 1.0;
            let along = vector_change(&v, &eta) * h;
            let change = (turn_of(&(v + along)) - turn_of(&(v - along))) / (2.0 * h);
            let own = turn_of(&v) * eta.cross_matrix();
            assert!((change - own).norm() < 1e-9, "{change} {own}");
        }
    }
}
