//! What a step leaves of its equations. Momenta are carried from node to node by what acts on them,
//! so that a bad solve does not show in what is conserved; it shows here.
//! Takes two lengths; says how they compare.

use crate::Real;
use crate::emitted::length;
use crate::scalar::largest;
use nalgebra::SMatrix;

/// A part of the equations of a step: the momentum carried to its end, less the one that its
/// velocity brings there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// The length of the difference.
    pub size: f64,
    /// The lengths of the terms it is made of, summed: rounding is `EPSILON` of it.
    pub scale: f64,
}

impl Residual {
    /// Of the momentum that is carried to the end of a step, and of the one that is brought there; `size` is
    /// that of the terms of the latter.
    #[must_use]
    pub fn between<T: Real, const R: usize, const C: usize>(
        carried: &SMatrix<T, R, C>,
        brought: &SMatrix<T, R, C>,
        size: T,
    ) -> Self {
        Self {
            size: length(&(carried - brought)).magnitude(),
            scale: length(carried).magnitude() + size.magnitude(),
        }
    }

    /// The same, its scale larger by the moment of what is carried with a lever arm.
    #[must_use]
    pub fn with_arm<T: Real>(self, moment: T) -> Self {
        let scale = self.scale + moment.magnitude();
        Self { scale, ..self }
    }

    /// The difference in units of its terms; zero where there are none, NaN where a number is.
    #[must_use]
    pub fn relative(&self) -> f64 {
        match self.scale == 0.0 && self.size == 0.0 {
            true => 0.0,
            false => self.size / self.scale,
        }
    }

    /// The largest of the parts of a step, each in units of its own terms; NaN where one is.
    #[must_use]
    pub fn largest(parts: &[Self]) -> f64 {
        largest(parts.iter().map(Self::relative))
    }
}
