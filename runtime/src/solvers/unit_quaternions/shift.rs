//! The scalar unknown `s` of the equation in unit quaternions, and the resulting velocity. Takes the body and
//! `u = h N / 2`; gives the quaternion, or `None` if the equation is unsolvable.
//!
//! Divided by `det I`, the equation is `Q(s) = β (|(det, n)| - det)` with the quartic `Q = u . n - s det` of the
//! Moser-Veselov equation. `det` and `|n|^2` are polynomials of third and fourth degree in `s`.

use super::body::QuaternionBody;
use super::branch;
use crate::Real;
use crate::solvers::moser_veselov::{dot, symmetric_times};

/// One iteration from the series is exact to rounding while `y = (1 + |β|/I) |u|^2 / I^2`, `I` the
/// smallest moment, is below this: it leaves less than `7e-18 (y/0.02)^12` of `I` (the largest of
/// thousands of random bodies, in fifty digits).
pub(super) const EASY: f64 = 0.02;

/// Below this, one step of Newton's method suffices, if the step is small.
pub(super) const QUICK: f64 = 0.002;

/// The largest step of the iteration, relative to the smallest moment, after which the result is
/// exact: the error is of the order of its square, and of its product with the error of its slope,
/// 9 y^3.
pub(super) const EXACT: f64 = 1e-9;

/// Below this, two iterations leave less than 1e-30 of `I`, and the principal branch is far from its end.
pub(super) const MODERATE: f64 = 0.1;

/// A rotation from one node to the next, not yet normalised.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn<T> {
    /// The quaternion, with any length.
    pub(super) omega: [T; 4],
    /// The inverse of its squared length.
    pub(super) per_square: T,
}

impl<T: Real> Turn<T> {
    #[inline(always)]
    pub(super) fn new(omega: [T; 4]) -> Self {
        let [w, x, y, z] = omega;
        Self {
            omega,
            per_square: T::one() / ((w * w + x * x) + (y * y + z * z)),
        }
    }
}

/// `|(det, n)|` and its derivatives need `det` and `|n|^2` as polynomials.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation<T> {
    real: T,
    /// `u . I u / det I`.
    twice: T,
    /// `tr I |u|^2 / det I`.
    pull: T,
    energy: T,
    /// `|I^-1 u|^2`, the leading part of `|n|^2`, and the leading part of its derivative.
    leading: T,
    leaning: T,
    zeroth: T,
    second: T,
    /// `Q`, by powers of `s`, up to the third; the fourth is `zeroth`.
    quartic: [T; 4],
    /// `det`, up to the second; the third is `-zeroth`.
    determinant: [T; 3],
    /// `|n|^2`.
    length: [T; 5],
    /// `n = n_0 + s n_1 + s^2 u / det I`.
    constant: [T; 3],
    linear: [T; 3],
    u: [T; 3],
}

/// `(I u) x u` over `det I`, with `I u` for bodies not given in principal axes. Using differences of moments avoids
/// cancellation if the moments are nearly equal.
#[inline(always)]
fn gyroscopic<T: Real, const DIAGONAL: bool>(
    body: &QuaternionBody<T>,
    [x, y, z]: [T; 3],
    [i, j, k]: [T; 3],
) -> [T; 3] {
    if DIAGONAL {
        let [p, q, r] = body.differences;
        [p * (y * z), q * (z * x), r * (x * y)]
    } else {
        [j * z - k * y, k * x - i * z, i * y - j * x].map(|x| x * body.zeroth)
    }
}

/// The change `-(4/h) v x A v` of the momentum `N` in the body, with `scale = h / (2 unit)`.
#[inline(always)]
pub(super) fn change<T: Real>(body: &QuaternionBody<T>, scale: T, turn: &Turn<T>) -> [T; 3] {
    let [_, x, y, z] = turn.omega;
    let n = [x, y, z];
    let gyro = if body.is_diagonal() {
        gyroscopic::<T, true>(body, n, n)
    } else {
        let image = symmetric_times::<T, false>(body.moments, body.products, n);
        gyroscopic::<T, false>(body, n, image)
    };
    let factor = T::from_f64(2.0) / (scale * body.zeroth) * turn.per_square;
    gyro.map(|x| factor * x)
}

impl<T: Real> Equation<T> {
    #[inline(always)]
    pub(super) fn new<const DIAGONAL: bool>(body: &QuaternionBody<T>, u: [T; 3]) -> Self {
        let (one, zeroth) = (T::one(), body.zeroth);
        let a = dot(u, u);
        let image = symmetric_times::<T, DIAGONAL>(body.moments, body.products, u);
        let inverse =
            symmetric_times::<T, DIAGONAL>(body.inverse_moments, body.inverse_products, u);
        let linear = symmetric_times::<T, DIAGONAL>(body.linear_moments, body.linear_products, u);
        let gyro = gyroscopic::<T, DIAGONAL>(body, u, image);
        let square = zeroth * a;
        let constant = [0, 1, 2].map(|i: usize| (inverse[i] + gyro[i]) + square * u[i]);
        let energy = dot(u, inverse);
        let start = energy + square * a;
        let twice = zeroth * dot(u, image);
        let pull = body.first * a;
        let lead = one + twice;
        let cross = square * lead - body.first * start;
        let fourth = zeroth * square;
        let third = zeroth * twice - body.first * square;
        Self {
            real: body.real,
            twice,
            pull,
            energy,
            leading: dot(inverse, inverse),
            leaning: (square - body.first * energy) * T::from_f64(2.0),
            zeroth,
            second: body.second,
            quartic: [
                start,
                -(one + pull),
                body.second + (square + square),
                -body.first,
            ],
            determinant: [lead, -(body.second + square), body.first],
            length: [
                dot(constant, constant),
                cross + cross,
                dot(linear, linear) + zeroth * (start + start),
                third + third,
                fourth,
            ],
            constant,
            linear,
            u: u.map(|x| x * zeroth),
        }
    }

    /// The first terms of the series of `s`; the error is of sixth degree in `u`.
    #[inline(always)]
    pub(super) fn start(&self) -> T {
        let half = T::from_f64(0.5) * self.real;
        let ([start, ..], [length, ..], f) = (self.quartic, self.length, self.leading);
        let s = self.energy - half * f;
        let bend = s * self.second - (self.twice + T::from_f64(0.25) * f);
        let fourth = s * (s * self.second - self.pull) - half * (f * bend + s * self.leaning);
        // The leading terms are exact, and they become available last.
        (start - half * length) + fourth
    }

    /// One Newton step from `s`: its change, and the resulting rotation.
    ///
    /// The slope comes from the series of `|(det, n)|`, with a relative error of `9 y^3`. The quaternion is computed to
    /// first degree in the change, so neither the quaternion nor the division by its length waits for the change.
    #[inline(always)]
    pub(super) fn quick(&self, s: T) -> (T, Turn<T>) {
        let (two, three, four) = (T::from_f64(2.0), T::from_f64(3.0), T::from_f64(4.0));
        let (half, quarter) = (T::from_f64(0.5), T::from_f64(0.25));
        let (square, z, b) = (s * s, self.zeroth, self.real);
        let [d0, d1, d2] = self.determinant;
        let det = (d0 + d1 * s) + square * (d2 - z * s);
        let fall = (d1 + (two * d2) * s) - (three * z) * square;
        let [m0, m1, m2, m3, m4] = self.length;
        let n = (m0 + m1 * s) + square * ((m2 + m3 * s) + m4 * square);
        let rise = (m1 + (two * m2) * s) + square * (three * m3 + (four * m4) * s);
        let [q0, q1, q2, q3] = self.quartic;
        let quartic = (q0 + q1 * s) + square * ((q2 + q3 * s) + z * square);
        let along = (q1 + (two * q2) * s) + square * (three * q3 + (four * z) * s);
        // |(det, n)| - det, for a determinant near 1.
        let excess = (half * n) * ((two - det) - quarter * n);
        let near = det + excess;
        let slope = along * near + b * (fall * excess - half * rise);
        let per_slope = near / slope;
        let length = det * det + n;
        let per_length = T::one() / length;
        let stretch = ((det + det) * fall + rise) * per_length;
        let value = (quartic + b * det) - b * length.sqrt();
        let change = -(value * per_slope);
        let at = |i: usize| {
            let here = (self.constant[i] + s * self.linear[i]) + square * self.u[i];
            here + change * (self.linear[i] + (s + s) * self.u[i])
        };
        let turn = Turn {
            omega: [det + change * fall, at(0), at(1), at(2)],
            per_square: per_length * (T::one() - change * stretch),
        };
        (change, turn)
    }

    /// The equation at `s` and its first three derivatives, each divided by the factorial of its order.
    #[inline(always)]
    pub(super) fn taylor(&self, s: T) -> [T; 4] {
        let (two, three, four, six) = (
            T::from_f64(2.0),
            T::from_f64(3.0),
            T::from_f64(4.0),
            T::from_f64(6.0),
        );
        let half = T::from_f64(0.5);
        let square = s * s;
        let z = self.zeroth;
        let [q0, q1, q2, q3] = self.quartic;
        let quartic = [
            (q0 + q1 * s) + square * ((q2 + q3 * s) + z * square),
            (q1 + (two * q2) * s) + square * (three * q3 + (four * z) * s),
            (q2 + (three * q3) * s) + (six * z) * square,
            q3 + (four * z) * s,
        ];
        let [d0, d1, d2] = self.determinant;
        let det = [
            (d0 + d1 * s) + square * (d2 - z * s),
            (d1 + (two * d2) * s) - (three * z) * square,
            d2 - (three * z) * s,
            -z,
        ];
        let [m0, m1, m2, m3, m4] = self.length;
        let n = [
            (m0 + m1 * s) + square * ((m2 + m3 * s) + m4 * square),
            (m1 + (two * m2) * s) + square * (three * m3 + (four * m4) * s),
            (m2 + (three * m3) * s) + (six * m4) * square,
            m3 + (four * m4) * s,
        ];
        // Half the Taylor coefficients of the square of the length.
        let length = (det[0] * det[0] + n[0]).sqrt();
        let inverse = T::one() / length;
        let p1 = det[0] * det[1] + half * n[1];
        let p2 = (half * (det[1] * det[1]) + det[0] * det[2]) + half * n[2];
        let p3 = (det[1] * det[2] + det[0] * det[3]) + half * n[3];
        let l1 = p1 * inverse;
        let l2 = (p2 - half * (l1 * l1)) * inverse;
        let l3 = (p3 - l1 * l2) * inverse;
        let b = self.real;
        [
            quartic[0] - b * (length - det[0]),
            quartic[1] - b * (l1 - det[1]),
            quartic[2] - b * (l2 - det[2]),
            quartic[3] - b * (l3 - det[3]),
        ]
    }

    /// One step of fourth order: the Newton step and the next two terms of the inverse series.
    #[inline(always)]
    pub(super) fn improved(&self, s: T) -> T {
        let [value, slope, second, third] = self.taylor(s);
        let inverse = T::one() / slope;
        let newton = -(value * inverse);
        let bend = -(second * inverse);
        let twist = (bend + bend) * bend - third * inverse;
        let square = newton * newton;
        (s + newton) + square * (bend + newton * twist)
    }

    /// The quaternion `(det, n)` over `det I`, not normalised.
    #[inline(always)]
    pub(super) fn quaternion(&self, s: T) -> [T; 4] {
        let square = s * s;
        let [d0, d1, d2] = self.determinant;
        let det = (d0 + d1 * s) + square * (d2 - self.zeroth * s);
        let n = |i: usize| (self.constant[i] + s * self.linear[i]) + square * self.u[i];
        [det, n(0), n(1), n(2)]
    }
}

/// The principal solution for `u = h N / (2 unit)`.
#[inline(always)]
pub(super) fn turn<T: Real>(body: &QuaternionBody<T>, u: [T; 3]) -> Option<Turn<T>> {
    // One branch, with straight-line code on both sides.
    if body.is_diagonal() {
        principal::<T, true>(body, u)
    } else {
        principal::<T, false>(body, u)
    }
}

#[inline(always)]
fn principal<T: Real, const DIAGONAL: bool>(
    body: &QuaternionBody<T>,
    u: [T; 3],
) -> Option<Turn<T>> {
    if quick::<T>() {
        let equation = Equation::new::<DIAGONAL>(body, u);
        let (change, turn) = equation.quick(equation.start());
        // This form treats NaN as neither small nor exact.
        let small = (dot(u, u) - body.quick).nowhere_positive();
        if small & (change * change - body.exact).nowhere_positive() {
            return Some(turn);
        }
    }
    branch::turn(body, u)
}

/// Whether one step of Newton's method with an approximate slope may be exact to rounding.
pub(super) fn quick<T: Real>() -> bool {
    T::order() == 0 && T::EPSILON > 1e-20
}
