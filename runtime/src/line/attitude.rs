//! The attitude of one site: a rotation, or a unit quaternion that covers it. It is stored as four numbers, and the
//! matrix is computed when needed, because long lists of matrices exceed the caches.

use crate::saved::{Saved, Words};
use crate::solvers::moser_veselov::Poinsot;
use crate::{Real, Rotation, TurnedRotation, UnitQuaternion, linalg};
use nalgebra::{Matrix3, Vector3};

/// A rotation, body to space. It is stored as a quaternion whose sign is preserved along a trajectory, so that it can
/// also be read as an element of SU(2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude<T = f64> {
    rotation: Rotation<T>,
}

impl<T: Real> Attitude<T> {
    /// The attitude of a rotation.
    #[inline(always)]
    pub fn new(rotation: Rotation<T>) -> Self {
        Self { rotation }
    }

    /// The attitude of a unit quaternion.
    pub fn of_quaternion(element: UnitQuaternion<T>) -> Self {
        Self::new(element.rotation())
    }

    /// The attitude at the end of an edge.
    #[inline(always)]
    pub fn turned(turned: &TurnedRotation<T>) -> Self {
        Self {
            rotation: turned.rotation(),
        }
    }

    /// This attitude times the rotation of a vector ([`turn_of`](super::turn_of)) on the body side.
    #[inline(always)]
    #[must_use]
    pub fn moved(&self, v: &Vector3<T>) -> Self {
        let half = T::from_f64(0.5);
        let omega = [T::one(), v[0] * half, v[1] * half, v[2] * half];
        Self::turned(&self.rotation.turned(omega))
    }

    /// The rotation.
    #[inline(always)]
    pub fn rotation(&self) -> Rotation<T> {
        self.rotation
    }

    /// This attitude, with its quaternion multiplied by `sign`, which is 1 or -1.
    pub(crate) fn of_sign(&self, sign: T) -> Self {
        let q = self.rotation.quaternion().map(|x| x * sign);
        Self {
            rotation: Rotation::from_unit(q),
        }
    }

    /// The unit quaternion, with its current sign.
    #[inline(always)]
    pub fn unit_quaternion(&self) -> UnitQuaternion<T> {
        UnitQuaternion::covering(self.rotation)
    }

    /// The matrix of the rotation.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix3<T> {
        self.rotation.matrix()
    }
}

/// The relative quaternion `q* p`: the second frame relative to the first.
#[inline(always)]
pub fn between<T: Real>(from: &UnitQuaternion<T>, to: &UnitQuaternion<T>) -> UnitQuaternion<T> {
    from.to(to)
}

/// The derivative of the attitude at the end of an edge by an impulse at its start, both in body axes at their own
/// node: `h Ω^T (tr(S) Id - S)^-1` with `S = Ω J` and the step size `h`. The result is not finite at a fold of the edge
/// equation.
#[inline(always)]
pub fn turned_by<T: Real>(
    body: &Poinsot<T>,
    h: T,
    from: &Attitude<T>,
    to: &Attitude<T>,
) -> Matrix3<T> {
    let turn = from.matrix().tr_mul(&to.matrix());
    let factor = linalg::trace_complement(&(turn * body.matrix()));
    // The inverse is the adjugate, whose columns are cross products, divided by the determinant.
    let [a, b, c] = [0, 1, 2].map(|i| factor.row(i).transpose());
    let columns = [b.cross(&c), c.cross(&a), a.cross(&b)];
    let scale = h / a.dot(&columns[0]);
    turn.tr_mul(&Matrix3::from_columns(&columns)) * scale
}

impl Saved for Attitude<f64> {
    fn words(&mut self, words: &mut Words) {
        let Self { rotation } = self;
        rotation.words(words);
    }
}
