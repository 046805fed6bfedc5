//! Principal axes of a body, in which a step needs the fewest operations. Takes the body; gives its
//! principal moments, the middle one second, and the rotation to its axes.

use super::Poinsot;
use crate::{Real, Rotation};
use nalgebra::Matrix3;

/// Jacobi's method squares the off-diagonal entries in each sweep: five sweeps reach double precision from any start,
/// six reach double-double.
const SWEEPS: usize = 8;

/// The principal frame of `I / unit`.
pub(super) struct PrincipalAxes<T> {
    /// Moments in units of the body; the second is between the two others.
    pub(super) moments: [T; 3],
    /// Principal components -> body components. Exactly the identity for a body that is already
    /// diagonal, with its middle moment second.
    pub(super) frame: Rotation<T>,
}

/// 1 in the lanes where `x` is positive, 0 in the others.
fn positive<T: Real>(x: T) -> T {
    x.where_positive(T::one())
}

/// The rotation about a coordinate axis with the given cosine and sine of half the angle.
fn about<T: Real>(axis: usize, cosine: T, sine: T) -> Rotation<T> {
    let at = |i: usize| if i == axis { sine } else { T::zero() };
    Rotation::normalised([cosine, at(0), at(1), at(2)])
}

impl<T: Real> PrincipalAxes<T> {
    /// The axes of a body, lane by lane. The derivative parts treat the frame as fixed, so use this for
    /// types without derivatives only.
    pub(super) fn of(body: &Poinsot<T>) -> Self {
        let [x, y, z] = body.moments;
        let [yz, xz, xy] = body.products;
        let inertia = Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z);
        let mut frame = Rotation::identity();
        // Recomputed from the given tensor each time, so that sweeps do not add up rounding.
        let entries = |frame: &Rotation<T>| {
            let r = frame.matrix();
            let [[a, h, g], [_, b, f], [_, _, c]] = (r.transpose() * (inertia * r)).data.0;
            ([a, b, c], [f, g, h])
        };
        for _ in 0..SWEEPS {
            let ([a, b, _], [_, _, h]) = entries(&frame);
            frame = frame * annihilator(2, a - b, h, body.s1);
            let ([_, b, c], [f, _, _]) = entries(&frame);
            frame = frame * annihilator(0, b - c, f, body.s1);
            let ([a, _, c], [_, g, _]) = entries(&frame);
            frame = frame * annihilator(1, c - a, g, body.s1);
        }
        let ([a, b, c], _) = entries(&frame);
        // If the second moment is not between the other two, exchanges it with the nearer one.
        let (down, up) = (b - a, b - c);
        let outside = positive(down * up);
        let far = positive(down * down - up * up);
        frame = frame * quarter(2, outside * (T::one() - far)) * quarter(0, outside * far);
        let ([a, b, c], _) = entries(&frame);
        Self {
            moments: [a, b, c],
            frame,
        }
    }
}

/// The smaller of the rotations about `axis` that make an off-diagonal entry vanish, given the difference of the two
/// diagonal entries; the identity if the entry is only rounding.
fn annihilator<T: Real>(axis: usize, difference: T, off: T, scale: T) -> Rotation<T> {
    let (one, half) = (T::one(), T::from_f64(0.5));
    let noise = scale * T::from_f64(0.25 * T::EPSILON);
    let active = positive(off * off - noise * noise);
    let ratio = active * (half * difference) / (active * off + (one - active));
    let sign = one - (positive(-ratio) + positive(-ratio));
    let tangent = active * sign / (sign * ratio + (one + ratio * ratio).sqrt());
    let cosine = one / (one + tangent * tangent).sqrt();
    let half_cosine = (half * (one + cosine)).sqrt();
    about(axis, half_cosine, half * tangent * cosine / half_cosine)
}

/// A quarter turn in the lanes where `mask` is 1.
fn quarter<T: Real>(axis: usize, mask: T) -> Rotation<T> {
    let side = T::from_f64(0.5).sqrt();
    about(axis, mask * side + (T::one() - mask), mask * side)
}
