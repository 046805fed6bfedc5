//! The edge that begins at a node of a motion in unit quaternions, and the node where it ends.
//! Takes the edge's momentum; gives the next attitude as soon as it can be used.

use super::shift::{Turn, change, turn};
use super::{QuaternionBody, QuaternionError};
use crate::solvers::moser_veselov::Edge;
use crate::{Real, TurnedRotation, UnitQuaternion};
use nalgebra::Vector3;

/// The attitude at the next node.
#[inline(always)]
fn turned<T: Real>(attitude: &UnitQuaternion<T>, turn: &Turn<T>) -> TurnedRotation<T> {
    attitude.rotation().turned_at(turn.omega, turn.per_square)
}

impl<T: Real> QuaternionBody<T> {
    /// The velocity of a step, in the body: the principal solution `w + v` of
    /// `w A v + v x A v + β v = h N / 2`, a quaternion of unit length. `h_n` is `h N`, the step times the
    /// momentum at the beginning of the edge, in the body.
    ///
    /// # Errors
    /// [`QuaternionError`] when there is none, in any lane, or the momentum is not finite.
    #[inline(always)]
    pub fn velocity(&self, h_n: &Vector3<T>) -> Result<UnitQuaternion<T>, QuaternionError> {
        let [[x, y, z]] = h_n.data.0;
        let scale = self.half_over_unit;
        match turn(self, [x * scale, y * scale, z * scale]) {
            Some(turn) => Ok(turned(&UnitQuaternion::identity(), &turn).unit_quaternion()),
            None => Err(QuaternionError::diagnose(self, h_n)),
        }
    }
}

impl<T: Real> Edge<T> {
    /// The attitude at the end of the edge, given the attitude at its start, in unit quaternions:
    /// the principal solution, body side.
    ///
    /// # Errors
    /// [`QuaternionError`] when there is none, in any lane, or the momentum is not finite.
    #[inline(always)]
    pub fn turn_in_quaternions(
        &self,
        body: &QuaternionBody<T>,
        h: T,
        attitude: &UnitQuaternion<T>,
    ) -> Result<TurnedRotation<T>, QuaternionError> {
        let scale = h * body.half_over_unit;
        let [[x, y, z]] = self.body().data.0;
        match turn(body, [x * scale, y * scale, z * scale]) {
            Some(turn) => Ok(turned(attitude, &turn)),
            None => Err(QuaternionError::diagnose(
                body,
                &Vector3::new(x * h, y * h, z * h),
            )),
        }
    }

    /// A step on which nothing else acts: the attitude where the edge ends, and the edge that begins there.
    ///
    /// In the body the momentum changes by `-(4/h) v x A v`. This is added to what the attitude where the edge begins
    /// makes of the momentum in space: rounding does not accumulate, and the next step waits only for `v`.
    ///
    /// # Errors
    /// As [`Edge::turn_in_quaternions`].
    #[inline(always)]
    pub fn free_in_quaternions(
        &self,
        body: &QuaternionBody<T>,
        h: T,
        attitude: &UnitQuaternion<T>,
    ) -> Result<(UnitQuaternion<T>, Self), QuaternionError> {
        let scale = h * body.half_over_unit;
        let ([[x, y, z]], space) = (self.body().data.0, self.space());
        match turn(body, [x * scale, y * scale, z * scale]) {
            Some(turn) => {
                let before = attitude.rotation().inverse_rotate(&space);
                let momentum = before + Vector3::from(change(body, scale, &turn));
                let next = turned(attitude, &turn).unit_quaternion();
                Ok((next, Self::new(momentum, space)))
            }
            None => Err(QuaternionError::diagnose(
                body,
                &Vector3::new(x * h, y * h, z * h),
            )),
        }
    }
}
