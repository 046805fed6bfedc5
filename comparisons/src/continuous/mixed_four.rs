//! Two bodies, a rigid motion and a point mass coupled by springs: the equations of Newton and Euler. The 33 components are y =
//! (three attitudes, three angular momenta about each centre, position and momentum of the rigid motion, position and momentum of
//! the point). All but the attitudes are in spatial axes.

use super::{Motion, inertia, inverse, spun};
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed, scaled};
use crate::handwritten::mixed_four::{Four, Momenta, Places};

/// The four bodies, with their inverse inertias.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joined {
    given: Four,
    inverses: [Matrix; 3],
}

/// The state as a vector.
pub fn state(places: &Places, momenta: &Momenta) -> [f64; 33] {
    let attitudes = places.attitudes.iter().flat_map(|q| q.0);
    let parts = [places.motion, momenta.motion, places.point, momenta.point];
    let all = attitudes
        .chain(momenta.angular.into_iter().flatten())
        .chain(parts.into_iter().flatten());
    let mut y = [0.0; 33];
    for (place, x) in y.iter_mut().zip(all) {
        *place = x;
    }
    y
}

/// The state from a vector.
pub fn read(y: &[f64; 33]) -> (Places, Momenta) {
    let vector = |at: usize| -> Vector { std::array::from_fn(|i| y[at + i]) };
    let quaternion = |at: usize| Quaternion(std::array::from_fn(|i| y[at + i]));
    let places = Places {
        attitudes: [quaternion(0), quaternion(4), quaternion(8)],
        motion: vector(21),
        point: vector(27),
    };
    let momenta = Momenta {
        angular: [vector(12), vector(15), vector(18)],
        motion: vector(24),
        point: vector(30),
    };
    (places, momenta)
}

impl Joined {
    /// The equations of these bodies.
    pub fn new(given: &Four) -> Self {
        Self {
            given: *given,
            inverses: given.poinsots.map(|j| inverse(&inertia(&j))),
        }
    }
}

impl Motion<33> for Joined {
    #[inline(always)]
    fn rate(&self, y: &[f64; 33], out: &mut [f64; 33]) {
        let (places, momenta) = read(y);
        let own = |at: usize| -> Vector {
            apply_transposed(&places.attitudes[at].matrix(), &momenta.angular[at])
        };
        let velocities: [Vector; 3] = std::array::from_fn(|at| apply(&self.inverses[at], &own(at)));
        let turning = places.attitudes.iter().zip(&velocities);
        let moving = Places {
            attitudes: std::array::from_fn(|_| Quaternion([0.0; 4])),
            motion: scaled(1.0 / self.given.motion_mass, &momenta.motion),
            point: self.given.point_velocity(&momenta.point),
        };
        *out = state(&moving, &self.given.pulled(&places));
        for (place, (q, omega)) in out.chunks_mut(4).zip(turning) {
            place.copy_from_slice(&spun(q, omega));
        }
    }
}
