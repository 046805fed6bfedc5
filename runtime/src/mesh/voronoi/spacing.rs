//! Distances of particles, and the bound that waves put on the step size. Takes a mesh and wave speeds; gives distances
//! and rates, with the sites at which they occur.

use super::mesh::Voronoi;
use crate::mesh::MeshError;

/// A value that belongs to two neighbouring sites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// The value.
    pub value: f64,
    /// The neighbours.
    pub sites: [usize; 2],
}

impl Voronoi<f64> {
    /// The smallest distance between two particles, or between a particle and its own copy. The closest particles are
    /// always neighbours.
    #[must_use]
    pub fn nearest(&self) -> Between {
        let mut nearest = Between {
            value: f64::INFINITY,
            sites: [0; 2],
        };
        for face in self.faces() {
            let value = face.edge.norm();
            if value < nearest.value {
                nearest = Between {
                    value,
                    sites: face.sites,
                };
            }
        }
        nearest
    }

    /// The largest ratio of speed to distance of two neighbours. If `speeds` are the wave speeds `sqrt(g h)` at the
    /// particles, one step should be at most about half the inverse. If the depth is smoothed over the length `alpha`,
    /// waves are slower, and you can use `1/alpha` instead of the inverse distance.
    ///
    /// # Errors
    /// [`MeshError::Count`].
    pub fn fastest(&self, speeds: &[f64]) -> Result<Between, MeshError> {
        MeshError::unless_of_length(speeds, self.sites())?;
        let mut fastest = Between {
            value: 0.0,
            sites: [0; 2],
        };
        for face in self.faces() {
            let [a, b] = face.sites;
            let value = 0.5 * (speeds[a] + speeds[b]) / face.edge.norm();
            if value > fastest.value || value.is_nan() {
                fastest = Between {
                    value,
                    sites: face.sites,
                };
            }
        }
        Ok(fastest)
    }
}
