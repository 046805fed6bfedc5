//! The edge that begins at a node of a motion in unit quaternions, and the node where it ends.
//! Takes the edge's momentum; gives the next attitude as soon as it can be used.

use super::shift::turn;
use super::{QuaternionBody, QuaternionError};
use crate::solvers::moser_veselov::Edge;
use crate::{Real, TurnedRotation, UnitQuaternion};
use nalgebra::Vector3;

impl<T: Real> Edge<T> {
    /// The attitude where the edge ends, given that where it begins, in unit quaternions: the
    /// principal solution, body side.
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
            Some(omega) => Ok(attitude.rotation().turned(omega)),
            None => Err(QuaternionError::diagnose(
                body,
                &Vector3::new(x * h, y * h, z * h),
            )),
        }
    }
}
