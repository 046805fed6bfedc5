//! Distances of particles, and the bound that they put on the step. Takes a mesh and the speeds of waves; gives
//! distances and rates, with the sites where they are.

use super::mesh::Voronoi;
use crate::mesh::MeshError;

/// A number and the two neighbours it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// The number.
    pub value: f64,
    /// The neighbours.
    pub sites: [usize; 2],
}

impl Voronoi<f64> {
    /// The smallest distance of two particles, or of a particle and its own copy. The nearest are always neighbours.
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

    /// The largest speed over distance of two neighbours. If `speeds` are the wave speeds `sqrt(g h)` at particles, one
    /// step should be at most about half of its inverse. Waves of a depth that is smoothed over the length `alpha` are
    /// slower: for these you can use `1/alpha` instead of the inverse distance.
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
