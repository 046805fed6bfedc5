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
    /// The velocity of a step, in the body frame: the principal solution `w + v`, a unit quaternion, of
    /// `w A v + v x A v + β v = h N / 2`. `h_n` is the step size times the momentum `N` at the start of the edge, in
    /// the body frame.
    ///
    /// # Errors
    /// [`QuaternionError`] if the equation is unsolvable in some lane or the momentum is not finite.
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
    /// The attitude at the end of the edge, given the attitude at its start, by the principal solution on the body
    /// side.
    ///
    /// # Errors
    /// [`QuaternionError`] if the equation is unsolvable in some lane or the momentum is not finite.
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

    /// A step without other forces. Returns the attitude at the end of the edge, and the edge that starts there.
    ///
    /// In the body frame the momentum changes by `-(4/h) v x A v`. The change is added to the spatial momentum as seen
    /// from the attitude at the start of the edge. Rounding therefore does not accumulate, and the next step waits only
    /// for `v`.
    ///
    /// # Errors
    /// The errors of [`Edge::turn_in_quaternions`].
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
