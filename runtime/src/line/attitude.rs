//! The attitude of one site: a rotation with its matrix, which the site and its neighbours read.

use crate::saved::{Saved, Words};
use crate::{Real, Rotation, TurnedRotation};
use nalgebra::Matrix3;

/// A rotation, body to space, and its matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude<T = f64> {
    rotation: Rotation<T>,
    matrix: Matrix3<T>,
}

impl<T: Real> Attitude<T> {
    /// The attitude of a rotation.
    pub fn new(rotation: Rotation<T>) -> Self {
        Self {
            matrix: rotation.matrix(),
            rotation,
        }
    }

    /// The attitude at the end of an edge.
    #[inline(always)]
    pub fn turned(turned: &TurnedRotation<T>) -> Self {
        Self {
            rotation: turned.rotation(),
            matrix: turned.matrix(),
        }
    }

    /// The rotation.
    #[inline(always)]
    pub fn rotation(&self) -> Rotation<T> {
        self.rotation
    }

    /// Its matrix.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix3<T> {
        self.matrix
    }
}

impl Saved for Attitude<f64> {
    fn words(&mut self, words: &mut Words) {
        let Self { rotation, matrix } = self;
        rotation.words(words);
        matrix.words(words);
    }
}
