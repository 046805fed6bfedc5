//! The edge that begins at a node of a forced motion, and the node where it ends.
//! Takes the edge's momentum; gives the next attitude as soon as it can be used.

use super::forced::{principal_at_once, turn};
use super::{MoserVeselovError, Poinsot};
use crate::scalar::lane_view::{in_lanes, set_all};
use crate::solvers::Method;
use crate::solvers::left_factor::rotation_at;
use crate::{Real, Rotation, TurnedRotation};
use nalgebra::Vector3;

/// The momentum of an edge, in space and in the body at its first node.
///
/// A stepper computes the edge at the end of a step, when the quantities of the new node are available, and stores it
/// for the next step: the solve then waits only for the body components.
///
/// Aligned so that no pair of numbers crosses a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Edge<T = f64> {
    body: Paired<T>,
    space: Paired<T>,
}

/// Three numbers, stored as a pair and a single number. If they were adjacent, they would be loaded as overlapping
/// pairs, which the processor cannot forward from the stores of the previous step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
struct Paired<T> {
    pair: [T; 2],
    gap: u64,
    alone: T,
}

in_lanes!(Paired { pair, alone; gap });
in_lanes!(Edge { body, space });
crate::saved!([] Paired { pair, gap, alone });
crate::saved!([] Edge { body, space });

impl<T: Real> Paired<T> {
    #[inline(always)]
    fn new(v: Vector3<T>) -> Self {
        let [[x, y, z]] = v.data.0;
        Self {
            pair: [x, y],
            gap: 0,
            alone: z,
        }
    }

    #[inline(always)]
    fn set_one(&mut self, lane: usize, one: Paired<T::One>) {
        set_all(&mut self.pair, lane, one.pair);
        self.alone.set_lane(lane, one.alone);
    }

    #[inline(always)]
    fn get(&self) -> [T; 3] {
        let [x, y] = self.pair;
        [x, y, self.alone]
    }
}

impl<T: Real> Edge<T> {
    /// The edge with momentum `body` in the frame at its first node, `space` in space.
    #[inline(always)]
    pub fn new(body: Vector3<T>, space: Vector3<T>) -> Self {
        Self {
            body: Paired::new(body),
            space: Paired::new(space),
        }
    }

    /// The edge with momentum `space` in space, at a first node of this attitude.
    #[inline(always)]
    pub fn of_space(space: Vector3<T>, attitude: &Rotation<T>) -> Self {
        Self::new(attitude.matrix().tr_mul(&space), space)
    }

    /// The momentum of the edge, in the frame at its first node.
    #[inline(always)]
    pub fn body(&self) -> Vector3<T> {
        self.body.get().into()
    }

    /// The momentum of the edge, in space.
    #[inline(always)]
    pub fn space(&self) -> Vector3<T> {
        self.space.get().into()
    }

    /// The attitude at the end of the edge, given the attitude at its start: the principal solution
    /// of the Moser-Veselov equation, body side.
    ///
    /// # Errors
    /// The errors of [`forced`](super::forced()).
    #[inline(always)]
    pub fn turn(
        &self,
        body: &Poinsot<T>,
        h: T,
        attitude: &Rotation<T>,
    ) -> Result<TurnedRotation<T>, MoserVeselovError> {
        let scale = h * body.half_over_unit;
        let [x, y, z] = self.body.get();
        match turn(body, [x * scale, y * scale, z * scale]) {
            Some(omega) => Ok(attitude.turned(omega)),
            None => Err(MoserVeselovError::diagnose(
                body,
                &Vector3::new(x * h, y * h, z * h),
            )),
        }
    }

    /// Like [`Edge::turn`], with one iteration for the root of the quartic; also returns whether that
    /// suffices. The code is free of branches, so that a loop over many bodies vectorises. Set
    /// `DIAGONAL` if the body is given in principal axes. If one iteration does not suffice, the result
    /// is meaningless.
    #[inline(always)]
    pub fn turn_at_once<const DIAGONAL: bool>(
        &self,
        body: &Poinsot<T>,
        h: T,
        attitude: &Rotation<T>,
    ) -> (TurnedRotation<T>, bool) {
        let scale = h * body.half_over_unit;
        let [x, y, z] = self.body.get();
        let u = [x * scale, y * scale, z * scale];
        let (omega, found) = principal_at_once::<T, DIAGONAL>(body, u);
        (attitude.turned(omega), found)
    }

    /// Writes the edge of one lane.
    #[inline(always)]
    pub(crate) fn set_one(&mut self, lane: usize, one: Edge<T::One>) {
        self.body.set_one(lane, one.body);
        self.space.set_one(lane, one.space);
    }

    /// Like [`Edge::turn`], with the solver `method`, which prepares the body anew.
    ///
    /// # Errors
    /// The errors of [`Edge::turn`]; also if the solver does not support this scalar.
    #[cold]
    #[inline(never)]
    pub fn turn_by(
        &self,
        method: Method,
        body: &Poinsot<T>,
        h: T,
        attitude: &Rotation<T>,
    ) -> Result<TurnedRotation<T>, MoserVeselovError> {
        let h_n = self.body() * h;
        match rotation_at(body.matrix(), &h_n, method) {
            Ok(omega) => Ok(attitude.turned(omega.quaternion())),
            Err(_) => Err(MoserVeselovError::of_solver(method, body, &h_n)),
        }
    }
}
