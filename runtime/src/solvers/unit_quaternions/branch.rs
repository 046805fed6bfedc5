//! Solves long steps: iterates further for `s`, or follows the principal branch from small momenta. Takes the body and
//! `u`; gives the quaternion lane by lane, or the fraction of `u` for which a solution was found.

use super::body::QuaternionBody;
use super::shift::{Equation, Turn, quick};
use crate::linalg::{determinant, hat, solve};
use crate::scalar::largest;
use crate::solvers::moser_veselov::choose;
use crate::{Group, Real, UnitQuaternion};
use nalgebra::{Matrix3, Vector3};

/// The largest number of Newton iterations on the branch. They start close to it, so they converge quickly or not at
/// all.
const MOST_ITERATIONS: usize = 10;

/// The largest number of trials along the branch. Reaching its very end takes about fifty halvings of the last advance,
/// each followed by a few advances.
const MOST_TRIALS: usize = 2000;

/// The resolution of the end of the branch, as a fraction of `u`.
const RESOLUTION: f64 = 1e-14;

/// The largest fraction of `u` in one advance along the branch, because other branches may be close.
const LONGEST: f64 = 0.05;

fn quaternions<T: Real>(mask: T, then: [T; 4], otherwise: [T; 4]) -> [T; 4] {
    let [[a, b, c, d], [w, x, y, z]] = [then, otherwise];
    [(a, w), (b, x), (c, y), (d, z)].map(|(then, otherwise)| choose(mask, then, otherwise))
}

fn turns<T: Real>(mask: T, then: Turn<T>, otherwise: Turn<T>) -> Turn<T> {
    Turn {
        omega: quaternions(mask, then.omega, otherwise.omega),
        per_square: choose(mask, then.per_square, otherwise.per_square),
    }
}

/// The rotation, if one Newton step does not suffice; `None` if some lane is unsolvable. Each lane's result is
/// independent of the other lanes.
#[inline(never)]
pub(super) fn turn<T: Real>(body: &QuaternionBody<T>, u: [T; 3]) -> Option<Turn<T>> {
    let one = T::one();
    let [x, y, z] = u;
    let a = (x * x + y * y) + z * z;
    if !a.is_finite() {
        return None;
    }
    let beyond = a - body.easy;
    let easy = one - beyond.where_positive(one);
    let long = (a - body.moderate).where_positive(one);
    // Recomputed, because storing it would slow down short steps.
    let equation = Equation::new::<false>(body, u);
    let start = equation.start();
    let mut s = equation.improved(start);
    for _ in 0..T::order() {
        s = equation.improved(s);
    }
    if !beyond.nowhere_positive() {
        let mut more = s;
        for _ in 0..(1 + u32::from(wide::<T>())) {
            more = equation.improved(more);
        }
        s = choose(easy, s, more);
    }
    let mut near = Turn::new(equation.quaternion(s));
    if T::LANES > 1 && quick::<T>() {
        let (change, found) = equation.quick(start);
        let exact = one - (change * change - body.exact).where_positive(one);
        let small = one - (a - body.quick).where_positive(one);
        near = turns(exact * small, found, near);
    }
    if long.nowhere_positive() {
        return near.omega.iter().all(|x| x.is_finite()).then_some(near);
    }
    let mut far = [T::zero(); 4];
    for lane in 0..T::LANES {
        if long.lane(lane) <= 0.0 {
            continue;
        }
        let root = followed(&body.lane(lane), u.map(|x| x.lane(lane))).ok()?;
        for (sum, x) in far.iter_mut().zip(root.components()) {
            sum.set_lane(lane, T::One::from_f64(x));
        }
    }
    let far = quaternions(long, far, UnitQuaternion::identity().components());
    let far = polished(body, u, UnitQuaternion::from_components(far).ok()?)?;
    Some(turns(long, Turn::new(far.components()), near))
}

/// Whether the scalar has more digits than `f64`.
fn wide<T: Real>() -> bool {
    T::EPSILON < 1e-20
}

/// `w A v + v x A v + β v - u` and its derivative along `W (ξ/2)`, at `W = w + v`.
fn balance<T: Real>(
    body: &QuaternionBody<T>,
    u: [T; 3],
    q: &UnitQuaternion<T>,
) -> (Vector3<T>, Matrix3<T>) {
    let ([x, y, z], [yz, xz, xy]) = (body.moments, body.products);
    let number = Matrix3::from_diagonal_element(body.real);
    let a = Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z) - number;
    let (w, v) = (q.real(), q.imaginary());
    let image = a * v;
    let along = (a * w + hat(&v) * a + number) * v;
    let change = (Matrix3::from_diagonal_element(w) + hat(&v)) * T::from_f64(0.5);
    let tangent = (a * w + hat(&v) * a - hat(&image) + number) * change;
    let tangent = tangent - image * v.transpose() * T::from_f64(0.5);
    (along - Vector3::from(u), tangent)
}

/// Refines a root in `f64` by Newton's method, for more digits and for derivatives. If the tangent is at rounding
/// level, the root is unchanged.
fn polished<T: Real>(
    body: &QuaternionBody<T>,
    u: [T; 3],
    mut q: UnitQuaternion<T>,
) -> Option<UnitQuaternion<T>> {
    for _ in 0..(2 * u32::from(wide::<T>()) + T::order()) {
        let (residual, tangent) = balance(body, u, &q);
        q = q.retract((-solve(&tangent, &residual)?).as_slice());
    }
    q.components().iter().all(|x| x.is_finite()).then_some(q)
}

/// The root for `u` on the branch that starts at zero. If the branch ends before, where its tangent is singular, the
/// error is the fraction of `u` at its end.
pub(super) fn followed(
    body: &QuaternionBody<f64>,
    u: [f64; 3],
) -> Result<UnitQuaternion<f64>, f64> {
    let scaled = |part: f64| u.map(|x| x * part);
    let a = u.iter().fold(0.0, |sum, x| sum + x * x);
    if !a.is_finite() {
        return Err(f64::NAN);
    }
    let mut part = (body.moderate / a).sqrt().min(1.0);
    let begin = Equation::new::<false>(body, scaled(part));
    let s = begin.improved(begin.improved(begin.start()));
    let mut q = UnitQuaternion::normalised(begin.quaternion(s));
    let mut advance = LONGEST * part;
    let (_, mut tangent) = balance(body, scaled(part), &q);
    for _ in 0..MOST_TRIALS {
        if part >= 1.0 {
            return Ok(q);
        }
        let next = (part + advance).min(1.0);
        let taken = next - part;
        let found = solve(&tangent, &Vector3::from(scaled(taken)))
            .and_then(|change| corrected(body, scaled(next), &q, &change));
        match found {
            // At its end the branch turns back, and the determinant of its tangent changes sign. A root beyond may
            // belong to another branch and must be rejected.
            Some((root, there))
                if (0.7..1.4).contains(&(determinant(&there) / determinant(&tangent))) =>
            {
                (q, part, tangent) = (root, next, there);
                advance = (1.5 * taken).min(LONGEST);
            }
            _ => advance = 0.5 * taken,
        }
        if advance < RESOLUTION * part {
            return Err(part);
        }
    }
    Err(part)
}

/// The root near the tangent's prediction, and the tangent there. `None` unless the corrections are much smaller than
/// the predicted change, and each is much smaller than the previous one.
fn corrected(
    body: &QuaternionBody<f64>,
    u: [f64; 3],
    q: &UnitQuaternion<f64>,
    change: &Vector3<f64>,
) -> Option<(UnitQuaternion<f64>, Matrix3<f64>)> {
    let size = |v: &Vector3<f64>| largest(v.iter().copied());
    let moments = body.moments.iter().chain(&body.products);
    let scale = body.real.abs() + moments.fold(0.0, |sum, x| sum + x.abs());
    let mut last = size(change);
    if !last.is_finite() || last > 0.5 {
        return None;
    }
    let mut root = q.retract(change.as_slice());
    for _ in 0..MOST_ITERATIONS {
        let (residual, tangent) = balance(body, u, &root);
        let correction = solve(&tangent, &residual)?;
        let far = size(&correction);
        // A residual or correction at rounding level cannot be improved.
        if size(&residual) <= 2.0 * f64::EPSILON * scale || far <= 2.0 * f64::EPSILON {
            return Some((root, tangent));
        }
        if far > 0.2 * last {
            return None;
        }
        root = root.retract((-correction).as_slice());
        last = far;
    }
    None
}
