//! The edge that begins at a node of a forced motion, and the node where it ends.
//! Takes the edge's momentum; gives the next attitude as soon as it can be used.

use super::forced::turn;
use super::{MoserVeselovError, Poinsot};
use crate::{Real, Rotation, TurnedRotation};
use nalgebra::Vector3;

/// The momentum of an edge, in space and in the body at its first node.
///
/// A stepper makes it at the end of a step, when the quantities of the new node are at hand, and
/// keeps it for the next one: the solve waits for the body components, and for nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge<T = f64> {
    body: Apart<T>,
    space: Vector3<T>,
}

/// Three numbers, each alone in memory. Side by side they would be loaded in overlapping pairs,
/// which the processor cannot forward from the stores of the step before.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
struct Apart<T> {
    x: T,
    gap: u64,
    y: T,
    other_gap: u64,
    z: T,
}

impl<T: Real> Edge<T> {
    /// The edge with momentum `body` in the frame at its first node, `space` in space.
    #[inline(always)]
    pub fn new(body: Vector3<T>, space: Vector3<T>) -> Self {
        let [[x, y, z]] = body.data.0;
        let body = Apart {
            x,
            gap: 0,
            y,
            other_gap: 0,
            z,
        };
        Self { body, space }
    }

    /// The momentum of the edge, in the frame at its first node.
    #[inline(always)]
    pub fn body(&self) -> Vector3<T> {
        let Apart { x, y, z, .. } = self.body;
        Vector3::new(x, y, z)
    }

    /// The momentum of the edge, in space.
    #[inline(always)]
    pub fn space(&self) -> Vector3<T> {
        self.space
    }

    /// The attitude where the edge ends, given that where it begins: the principal solution of the
    /// Moser-Veselov equation, body side.
    ///
    /// # Errors
    /// As [`forced`](super::forced()).
    #[inline(always)]
    pub fn turn(
        &self,
        body: &Poinsot<T>,
        h: T,
        attitude: &Rotation<T>,
    ) -> Result<TurnedRotation<T>, MoserVeselovError> {
        let scale = h * body.half_over_unit;
        let Apart { x, y, z, .. } = self.body;
        match turn(body, [x * scale, y * scale, z * scale]) {
            Some(omega) => Ok(attitude.turned(omega)),
            None => Err(MoserVeselovError::diagnose(
                body,
                &Vector3::new(x * h, y * h, z * h),
            )),
        }
    }
}
