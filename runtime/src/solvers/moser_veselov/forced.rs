//! One solve of the Moser-Veselov equation, for bodies whose momentum changes from step to step.
//! Takes the body and `h N`; gives the rotation `Omega` of the edge.

use super::cayley::{dot, gyroscopic};
use super::kappa::kappa;
use super::{MoserVeselovError, Poinsot};
use crate::{Real, Rotation};
use nalgebra::Vector3;

/// The principal solution `Omega` of `Omega J - J Omega^T = hat(h N)`.
///
/// `h_n` is the step times the edge momentum, in the frame of `body` (body axes for `next(R) = R
/// Omega`; spatial axes, with `J` carried along, for `next(R) = Omega R`). No iteration state is
/// kept: equal arguments give equal results.
///
/// ```
/// use clebsch::nalgebra::{Matrix3, Vector3};
/// use clebsch::solvers::moser_veselov::forced;
/// use clebsch::Poinsot;
///
/// let body = Poinsot::new(Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0)))?;
/// // About a principal axis I sin(theta) = h N, here with I = 2.
/// let omega = forced(&body, &Vector3::new(0.0, 0.0, 1.0))?;
/// let theta = (1.0_f64 / 2.0).asin();
/// assert!((omega.quaternion()[3] - (theta / 2.0).sin()).abs() < 1e-15);
/// // More than the moment of inertia is more than the equation can take.
/// let error = forced(&body, &Vector3::new(0.0, 0.0, 2.5)).unwrap_err();
/// assert!((error.ratio - 1.25).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`MoserVeselovError`] when there is no principal solution, in any lane, or `h_n` is not finite.
/// The step size is not known here: see [`MoserVeselovError::with_steps`].
#[inline(always)]
pub fn forced<T: Real>(
    body: &Poinsot<T>,
    h_n: &Vector3<T>,
) -> Result<Rotation<T>, MoserVeselovError> {
    match turn(body, body.scaled(h_n)) {
        Some(q) => Ok(Rotation::normalised(q)),
        None => Err(MoserVeselovError::diagnose(body, h_n)),
    }
}

/// The quaternion of the principal solution, not normalised, for `u = h N / (2 unit)`.
#[inline(always)]
pub(super) fn turn<T: Real>(body: &Poinsot<T>, u: [T; 3]) -> Option<[T; 4]> {
    // One branch here, straight-line code on either side.
    if body.diagonal {
        principal::<T, true>(body, u)
    } else {
        principal::<T, false>(body, u)
    }
}

#[inline(always)]
fn principal<T: Real, const DIAGONAL: bool>(body: &Poinsot<T>, u: [T; 3]) -> Option<[T; 4]> {
    let squares = [u[0] * u[0], u[1] * u[1], u[2] * u[2]];
    let products = [u[1] * u[2], u[2] * u[0], u[0] * u[1]];
    let a = (squares[0] + squares[1]) + squares[2];
    let energy = body.energy.value::<DIAGONAL>(squares, products);
    let deviation = body.deviation.value::<DIAGONAL>(squares, products);
    let kappa = kappa(body, a, energy, deviation)?;
    // adj(I - kappa) u = adj(I) u + kappa (I - s1) u + kappa^2 u and det(I - kappa), sorted by
    // powers so that little is left to do once kappa is known.
    let inertia_u = body.inertia_times::<DIAGONAL>(u);
    let adjugate_u = body.adjugate_times::<DIAGONAL>(u);
    let gyro = gyroscopic::<T, DIAGONAL>(body, u);
    let p = dot(u, inertia_u);
    let square = kappa * kappa;
    let det = ((body.s3 + p) - kappa * (body.s2 + a)) + square * (body.s1 - kappa);
    let n = |i: usize| {
        let constant = (adjugate_u[i] + gyro[i]) + a * u[i];
        let linear = inertia_u[i] - body.s1 * u[i];
        (constant + kappa * linear) + square * u[i]
    };
    Some([det, n(0), n(1), n(2)])
}
