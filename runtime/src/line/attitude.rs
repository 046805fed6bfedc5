//! The attitude of one site: a rotation, or a unit quaternion over it. Stored as four numbers, from which each reader computes
//! the matrix: long lists of matrices would not fit into the caches.

use crate::saved::{Saved, Words};
use crate::solvers::moser_veselov::Poinsot;
use crate::{Real, Rotation, TurnedRotation, UnitQuaternion, linalg};
use nalgebra::{Matrix3, Vector3};

/// A rotation, body to space. The quaternion that it is kept by has a sign, which stays what
/// it is along a motion: read as a unit quaternion it is an element of SU(2).
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

/// The quaternion from one to another, `q* p`: the second frame seen from the first.
#[inline(always)]
pub fn between<T: Real>(from: &UnitQuaternion<T>, to: &UnitQuaternion<T>) -> UnitQuaternion<T> {
    from.to(to)
}

/// How the attitude at the end of an edge turns, seen from there, by an impulse at its start, seen from there: with
/// `S = Ω J` and `h` the step, `h Ω^T (tr(S) Id - S)^-1`. The result is not finite if the equation of the edge has
/// a fold there.
#[inline(always)]
pub fn turned_by<T: Real>(
    body: &Poinsot<T>,
    h: T,
    from: &Attitude<T>,
    to: &Attitude<T>,
) -> Matrix3<T> {
    let turn = from.matrix().tr_mul(&to.matrix());
    let factor = linalg::trace_complement(&(turn * body.matrix()));
    // The inverse by its adjugate: three columns that are cross products, over the determinant.
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
