//! Represents the attitude of a free body along its trajectory as a rotation about its spatial momentum. Takes the
//! scaled body momentum, step by step; gives the attitude on request.
//!
//! The spatial momentum is constant, so the direction of the momentum in the body and one angle about it determine an
//! attitude. Let `s(u)` be the shortest rotation that takes the direction of `u` to an axis `e`. Every attitude is
//! then `g z s(u)`: `g` is constant, `z` a rotation about `e`. A step multiplies `z`, as a complex number, by
//! `(|u| det + d_e n_e) + i (kappa det + |u| n_e)` over its length: the components of `s(u) (det, n)` along `1` and
//! `e`, with `u . n = kappa det` and the third row of `(d - hat u) n = det u`. This takes six products instead of the
//! twenty products and a root of a quaternion product, and rounding of `z` can only rotate the body about its
//! momentum.
//!
//! The axis `e` is the principal axis around which the momentum moves, so `s(u)` stays away from half turns.

use super::Poinsot;
use super::cayley::{Orbit, Pencil};
use super::kappa::choose;
use crate::{Real, Rotation};

/// The constants of one trajectory, and the current `z`. The axes of the solver are relabelled (by a half turn or a
/// quarter turn about the second axis) so that `e` is the third axis and `u_e` is not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phase<T> {
    /// 1 if `e` is the first axis of the solver, 0 if it is the third.
    first: T,
    /// The sign of `u_e` in the axes of the solver.
    sign: T,
    /// `|u|`; 1 for a body at rest.
    length: T,
    kappa: T,
    /// Maps components in the solver's axes to components in the given axes.
    frame: Rotation<T>,
    /// Maps components in the given axes to components in the relabelled axes.
    tail: Rotation<T>,
    /// `g`.
    base: Rotation<T>,
    /// `z`.
    turn: [T; 2],
    /// Whether `base` and `turn` belong to the current attitude.
    current: bool,
}

/// The constants of a step, in the relabelled axes.
#[derive(Clone, Copy)]
pub(super) struct Path<T> {
    adjugate: [T; 3],
    differences: [T; 3],
    determinant: [T; 2],
    /// `d_e / |u|` and `kappa / |u|`.
    along: T,
    across: T,
}

/// A state between projections.
#[derive(Clone, Copy)]
pub(super) struct Moving<T> {
    pub(super) u: [T; 3],
    pub(super) turn: [T; 2],
}

crate::saved!([] Phase { first, sign, length, kappa, frame, tail, base, turn, current });

impl<T: Real> Phase<T> {
    /// A trajectory with this `|u|^2` and `kappa`. `frame` maps components in the solver's axes to components in the
    /// given axes.
    pub(super) fn new(frame: Rotation<T>, square: T, kappa: T) -> Self {
        let (zero, one) = (T::zero(), T::one());
        let moving = square.where_positive(one);
        Self {
            first: zero,
            sign: one,
            length: (square + (one - moving)).sqrt(),
            kappa,
            frame,
            tail: Rotation::identity(),
            base: Rotation::identity(),
            turn: [one, zero],
            current: false,
        }
    }

    /// Marks the attitude or the position on the trajectory as changed from outside.
    #[inline(always)]
    pub(super) fn lost(&mut self) {
        self.current = false;
    }

    /// Chooses the axis for the momentum `u`, and continues the trajectory at `attitude`.
    #[inline(never)]
    fn found(&mut self, body: &Poinsot<T>, attitude: &Rotation<T>, u: [T; 3]) {
        let (zero, one) = (T::zero(), T::one());
        let ([i, _, k], [p, _, r]) = (body.moments, body.differences);
        // The momentum moves around the axis along which its component never vanishes.
        let (round_first, round_third) = (u[0] * u[0] * (r * k), u[2] * u[2] * (p * i));
        let difference = round_first * round_first - round_third * round_third;
        self.first = difference.where_positive(one);
        let negative = (-choose(self.first, u[0], u[2])).where_positive(one);
        self.sign = one - (negative + negative);
        let side = T::from_f64(0.5).sqrt();
        let relabelling = Rotation::from_unit([
            choose(self.first, side, one - negative),
            zero,
            choose(self.first, -(self.sign * side), negative),
            zero,
        ]);
        self.tail = relabelling * self.frame.inverse();
        let upright = self.upright(self.relabelled(u)) * self.tail;
        self.base = *attitude * upright.inverse();
        self.turn = [one, zero];
        self.current = true;
    }

    /// Converts to the relabelled axes.
    #[inline(always)]
    pub(super) fn relabelled(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let (first, sign) = (self.first, self.sign);
        [sign * choose(first, -z, x), y, sign * choose(first, x, z)]
    }

    /// Converts to the solver's axes.
    #[inline(always)]
    pub(super) fn solver_axes(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let (first, sign) = (self.first, self.sign);
        [sign * choose(first, z, x), y, sign * choose(first, -x, z)]
    }

    /// Continues the trajectory of a body in principal axes, with the middle moment second, at `attitude`, where the
    /// momentum is `u`; also computes the constants of its steps.
    #[inline(always)]
    pub(super) fn taken_up(
        &mut self,
        (body, pencil, orbit): (&Poinsot<T>, &Pencil<T>, &Orbit<T>),
        attitude: &Rotation<T>,
        u: [T; 3],
    ) -> (Path<T>, Moving<T>) {
        if !self.current {
            self.found(body, attitude, u);
        }
        let first = self.first;
        let exchange = |[x, y, z]: [T; 3]| [choose(first, z, x), y, choose(first, x, z)];
        // Exchanging two axes changes the signs of the differences.
        let handed = T::one() - (first + first);
        let [_, _, d] = exchange(pencil.d_moments());
        let per_length = T::one() / self.length;
        let path = Path {
            adjugate: exchange(orbit.adjugate()),
            differences: exchange(body.differences).map(|x| handed * x),
            determinant: orbit.determinant(),
            along: d * per_length,
            across: self.kappa * per_length,
        };
        let moving = Moving {
            u: self.relabelled(u),
            turn: self.turn,
        };
        (path, moving)
    }

    /// Leaves this representation and returns the attitude.
    #[inline(always)]
    pub(super) fn left_at(&mut self, moving: &Moving<T>) -> Rotation<T> {
        self.turn = moving.turn;
        let (o, [cosine, sine]) = (T::zero(), normalised(moving.turn));
        let turn = Rotation::from_unit([cosine, o, o, sine]);
        let upright = self.upright(moving.u).compose_raw(&self.tail);
        self.base.compose_raw(&turn).compose_raw(&upright)
    }

    /// `s(u)`.
    #[inline(always)]
    fn upright(&self, [x, y, z]: [T; 3]) -> Rotation<T> {
        Rotation::normalised([self.length + z, y, -x, T::zero()])
    }
}

#[inline(always)]
fn normalised<T: Real>([x, y]: [T; 2]) -> [T; 2] {
    let scale = T::one() / (x * x + y * y).sqrt();
    [x * scale, y * scale]
}

impl<T: Real> Path<T> {
    /// One step; also a number that is finite if and only if `u` is.
    #[inline(always)]
    pub(super) fn step(&self, moving: &Moving<T>) -> (Moving<T>, T) {
        let ([x, y, z], [cosine, sine]) = (moving.u, moving.turn);
        let ([a, b, c], [p, q, r]) = (self.adjugate, self.differences);
        let n = [
            a * x + (p * y) * z,
            b * y + (q * z) * x,
            c * z + (r * x) * y,
        ];
        let [constant, factor] = self.determinant;
        let det = constant + factor * (y * y);
        let [nx, ny, nz] = n;
        let norm = (det * det + nx * nx) + (ny * ny + nz * nz);
        let twice = T::from_f64(2.0) / norm;
        let (along, across) = (det + self.along * nz, self.across * det + nz);
        let moved = Moving {
            u: [
                x + (p * (ny * nz)) * twice,
                y + (q * (nz * nx)) * twice,
                z + (r * (nx * ny)) * twice,
            ],
            turn: [
                cosine * along - sine * across,
                cosine * across + sine * along,
            ],
        };
        (moved, norm)
    }
}

impl<T: Real> Moving<T> {
    /// Normalises the rotation, whose length a step may change by a large factor.
    #[inline(always)]
    pub(super) fn repair(&mut self) {
        self.turn = normalised(self.turn);
    }
}
