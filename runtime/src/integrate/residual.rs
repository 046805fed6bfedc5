//! What a step leaves of its equations. Momenta are carried from node to node by what acts on them,
//! so that a bad solve does not show in what is conserved; it shows here.
//! Takes two lengths; says how they compare.

use crate::scalar::largest;

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
