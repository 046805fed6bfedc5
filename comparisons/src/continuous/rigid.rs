//! A rigid body about a fixed point, free or in fields that are constant in space: Euler's equations mu' = mu x omega + torque,
//! omega = I^-1 mu, with the attitude as a quaternion. Seven equations, y = (w, x, y, z, mu).

use super::{Motion, inertia, inverse, spun};
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed, cross};

/// The field that acts on the body. Field vectors are in spatial axes, all others in body axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// No field.
    None,
    /// Potential energy: the sum of arm . (attitude^T direction) over pairs (arm, direction), such as
    /// weight and vertical.
    Uniform(Vec<(Vector, Vector)>),
    /// Potential energy a . K a / 2 with a = attitude^T axis.
    Quadratic {
        /// K, symmetric.
        matrix: Matrix,
        /// The axis.
        axis: Vector,
    },
}

/// The body and its field.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    inverse: Matrix,
    field: Field,
}

impl RigidBody {
    /// A body with this Poinsot matrix in this field.
    pub fn new(poinsot: &Matrix, field: Field) -> Self {
        Self {
            inverse: inverse(&inertia(poinsot)),
            field,
        }
    }

    /// The torque in body axes. A potential U(a) with a = attitude^T direction gives a x grad U.
    fn torque(&self, q: &Quaternion) -> Vector {
        let seen = |direction: &Vector| apply_transposed(&q.matrix(), direction);
        match &self.field {
            Field::None => [0.0; 3],
            Field::Uniform(pairs) => pairs.iter().fold([0.0; 3], |sum, (arm, direction)| {
                let one = cross(&seen(direction), arm);
                std::array::from_fn(|i| sum[i] + one[i])
            }),
            Field::Quadratic { matrix, axis } => {
                let a = seen(axis);
                cross(&a, &apply(matrix, &a))
            }
        }
    }
}

impl Motion<7> for RigidBody {
    #[inline(always)]
    fn rate(&self, y: &[f64; 7], out: &mut [f64; 7]) {
        let [w, x, yy, z, a, b, c] = *y;
        let (q, mu) = (Quaternion([w, x, yy, z]), [a, b, c]);
        let omega = apply(&self.inverse, &mu);
        let [qw, qx, qy, qz] = spun(&q, &omega);
        let turned = cross(&mu, &omega);
        let torque = self.torque(&q);
        *out = [
            qw,
            qx,
            qy,
            qz,
            turned[0] + torque[0],
            turned[1] + torque[1],
            turned[2] + torque[2],
        ];
    }
}
