//! The orientation of three points, and whether a fourth is inside their circumcircle. Both are exact for positions in
//! whole grains. Double precision decides the sign of a determinant if rounding cannot change it; otherwise the
//! adaptive arithmetic of Shewchuk (1997) does.

use super::torus::Grains;
use robust::Coord;

/// Bounds of the rounding of the determinants below, relative to the sum of the sizes of their terms. They exceed the
/// bounds that Shewchuk proves.
const TURN: f64 = 4.5e-16;
const CIRCLE: f64 = 1.5e-15;

const ORIGIN: Coord<f64> = Coord { x: 0.0, y: 0.0 };

fn coord([x, y]: Grains) -> Coord<f64> {
    Coord { x, y }
}

/// Positive if `v` is to the left of `u`, seen from the origin; zero if the three points are collinear.
#[inline(always)]
pub(super) fn turn(u: Grains, v: Grains) -> f64 {
    let (one, other) = (u[0] * v[1], u[1] * v[0]);
    let turn = one - other;
    if turn.abs() > TURN * (one.abs() + other.abs()) {
        return turn;
    }
    robust::orient2d(ORIGIN, coord(u), coord(v))
}

/// Whether `w` is inside the circumcircle of the origin, `u` and `v`, which are counterclockwise.
#[inline(always)]
pub(super) fn in_circle(u: Grains, v: Grains, w: Grains) -> bool {
    let square = |a: Grains| a[0] * a[0] + a[1] * a[1];
    let [u2, v2, w2] = [square(u), square(v), square(w)];
    let minors = |a: Grains, b: Grains| (a[0] * b[1], a[1] * b[0]);
    let (uv, vu) = minors(u, v);
    let (vw, wv) = minors(v, w);
    let (wu, uw) = minors(w, u);
    let outside = w2 * (uv - vu) + u2 * (vw - wv) + v2 * (wu - uw);
    let size = w2 * (uv.abs() + vu.abs()) + u2 * (vw.abs() + wv.abs()) + v2 * (wu.abs() + uw.abs());
    if outside.abs() > CIRCLE * size {
        return outside < 0.0;
    }
    robust::incircle(ORIGIN, coord(u), coord(v), coord(w)) > 0.0
}
