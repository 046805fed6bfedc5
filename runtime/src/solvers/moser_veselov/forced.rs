//! One solve of the Moser-Veselov equation, for bodies whose momentum changes from step to step.
//! Takes the body and `h N`; gives the rotation `Omega` of the edge.

use super::cayley::{dot, gyroscopic};
use super::kappa::{kappa, kappa_at_once};
use super::{MoserVeselovError, Poinsot};
use crate::scalar::InLanes;
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
/// [`MoserVeselovError`] if `h_n` is beyond the bound of the principal solution in some lane, or not
/// finite. The error does not contain the step size: see [`MoserVeselovError::with_steps`].
#[inline(always)]
pub fn forced<T: Real>(
    body: &Poinsot<T>,
    h_n: &Vector3<T>,
) -> Result<Rotation<T>, MoserVeselovError> {
    if T::LANES > 1 {
        let (all, found) = match body.is_diagonal() {
            true => in_all_lanes::<T, true>(body, h_n),
            false => in_all_lanes::<T, false>(body, h_n),
        };
        if found {
            return Ok(all);
        }
    }
    match turn(body, body.scaled(h_n)) {
        Some(q) => Ok(Rotation::normalised(q)),
        None => Err(MoserVeselovError::diagnose(body, h_n)),
    }
}

/// The principal solutions of equal bodies, and whether one iteration found the root of each. The code
/// is free of branches, so that the bodies are solved side by side. If the root of a body is found, its
/// solution equals the result of [`forced()`], bit for bit; otherwise it is meaningless.
#[inline(always)]
pub(in crate::solvers) fn forced_together<T: Real, const COUNT: usize>(
    body: &Poinsot<T>,
    h_n: &[Vector3<T>; COUNT],
) -> ([Rotation<T>; COUNT], bool) {
    match body.is_diagonal() {
        true => in_a_loop::<T, true, COUNT>(body, h_n),
        false => in_a_loop::<T, false, COUNT>(body, h_n),
    }
}

#[inline(always)]
fn in_a_loop<T: Real, const DIAGONAL: bool, const COUNT: usize>(
    body: &Poinsot<T>,
    h_n: &[Vector3<T>; COUNT],
) -> ([Rotation<T>; COUNT], bool) {
    let (mut all, mut found) = ([Rotation::identity(); COUNT], true);
    for (omega, v) in all.iter_mut().zip(h_n) {
        let (q, one) = principal_at_once::<T, DIAGONAL>(body, body.scaled(v));
        *omega = Rotation::normalised(q);
        found &= one;
    }
    (all, found)
}

/// The quaternion of the principal solution, not normalised, for `u = h N / (2 unit)`.
#[inline(always)]
pub(super) fn turn<T: Real>(body: &Poinsot<T>, u: [T; 3]) -> Option<[T; 4]> {
    // There is one branch, with straight-line code on both sides.
    if body.is_diagonal() {
        principal::<T, true>(body, u)
    } else {
        principal::<T, false>(body, u)
    }
}

#[inline(always)]
fn principal<T: Real, const DIAGONAL: bool>(body: &Poinsot<T>, u: [T; 3]) -> Option<[T; 4]> {
    let momentum = Momentum::new::<DIAGONAL>(body, u);
    let kappa = kappa(body, momentum.a, momentum.energy, momentum.deviation)?;
    Some(momentum.quaternion::<DIAGONAL>(body, kappa))
}

/// Like `principal`, with one iteration; also returns whether that suffices. Free of branches, so
/// that a loop over many bodies vectorises. If one iteration does not suffice, the result is
/// meaningless.
#[inline(always)]
pub(super) fn principal_at_once<T: Real, const DIAGONAL: bool>(
    body: &Poinsot<T>,
    u: [T; 3],
) -> ([T; 4], bool) {
    let momentum = Momentum::new::<DIAGONAL>(body, u);
    let (a, energy) = (momentum.a, momentum.energy);
    let (kappa, found) = kappa_at_once(body, a, energy, momentum.deviation);
    (momentum.quaternion::<DIAGONAL>(body, kappa), found)
}

/// `u` and its quadratic forms.
struct Momentum<T> {
    u: [T; 3],
    /// The squares of its components.
    squares: [T; 3],
    /// `|u|^2`.
    a: T,
    energy: T,
    deviation: T,
}

impl<T: Real> Momentum<T> {
    #[inline(always)]
    fn new<const DIAGONAL: bool>(body: &Poinsot<T>, u: [T; 3]) -> Self {
        let squares = [u[0] * u[0], u[1] * u[1], u[2] * u[2]];
        let products = [u[1] * u[2], u[2] * u[0], u[0] * u[1]];
        Self {
            u,
            squares,
            a: (squares[0] + squares[1]) + squares[2],
            energy: body.energy.value::<DIAGONAL>(squares, products),
            deviation: body.deviation.value::<DIAGONAL>(squares, products),
        }
    }

    /// `det(I - kappa - hat(u))` and `adj(I - kappa - hat(u)) u`.
    #[inline(always)]
    fn quaternion<const DIAGONAL: bool>(&self, body: &Poinsot<T>, kappa: T) -> [T; 4] {
        let Self { u, a, .. } = *self;
        // adj(I - kappa) u = adj(I) u + kappa (I - s1) u + kappa^2 u and det(I - kappa) are sorted by
        // powers: few operations have to wait for kappa.
        let rest_u = body.rest_times::<DIAGONAL>(u);
        let adjugate_u = body.adjugate_and_times::<DIAGONAL>(a, u);
        let gyro = gyroscopic::<T, DIAGONAL>(body, u);
        let p = if DIAGONAL {
            dot(body.moments, self.squares)
        } else {
            dot(u, body.inertia_times::<DIAGONAL>(u))
        };
        let square = kappa * kappa;
        let det = ((body.s3 + p) - kappa * (body.s2 + a)) + square * (body.s1 - kappa);
        // A loop, since closures are not always inlined.
        let mut n = u;
        for i in 0..3 {
            n[i] = ((adjugate_u[i] + gyro[i]) + kappa * rest_u[i]) + square * u[i];
        }
        [det, n[0], n[1], n[2]]
    }
}

/// The principal solutions of all lanes, in a loop over the lanes, and whether one iteration found
/// the root of each.
#[inline(always)]
fn in_all_lanes<T: Real, const DIAGONAL: bool>(
    body: &Poinsot<T>,
    h_n: &Vector3<T>,
) -> (Rotation<T>, bool) {
    let (mut all, mut found) = (Rotation::identity(), true);
    for lane in 0..T::LANES {
        let body = body.in_lane(lane);
        let u = body.scaled(&h_n.in_lane(lane));
        let (q, one) = principal_at_once::<T::One, DIAGONAL>(&body, u);
        all.set_one(lane, Rotation::normalised(q));
        found &= one;
    }
    (all, found)
}
