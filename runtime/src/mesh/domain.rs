//! The domain of particles: a box, each direction of which is periodic or ends in walls.
//! Positions are stored unwrapped; computations from them wrap.

use crate::Real;

/// The boundary condition of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wall {
    /// The direction is periodic.
    Periodic,
    /// Reflecting walls at both ends.
    Solid,
}

impl Wall {
    /// The number of nodes of `cells` cells along a direction: `cells + 1` between walls, `cells` if periodic.
    #[must_use]
    pub fn nodes(self, cells: usize) -> usize {
        match self {
            Self::Periodic => cells,
            Self::Solid => cells + 1,
        }
    }
}

/// A box from the origin to its lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain<const D: usize> {
    /// Length along each direction.
    pub lengths: [f64; D],
    /// The boundary condition of each direction.
    pub walls: [Wall; D],
}

impl<const D: usize> Domain<D> {
    /// Periodic in every direction.
    pub fn torus(lengths: [f64; D]) -> Self {
        let walls = [Wall::Periodic; D];
        Self { lengths, walls }
    }

    /// Walls on all sides.
    pub fn basin(lengths: [f64; D]) -> Self {
        let walls = [Wall::Solid; D];
        Self { lengths, walls }
    }

    /// Whether a position is between all walls. Periodic directions are not checked.
    #[inline]
    pub fn is_inside<T: Real>(&self, place: &[T; D]) -> bool {
        let each = place.iter().zip(&self.lengths).zip(&self.walls);
        each.into_iter().all(|((x, length), wall)| {
            *wall == Wall::Periodic || (0.0..=*length).contains(&x.value())
        })
    }

    /// Its length, area or volume.
    pub fn measure(&self) -> f64 {
        self.lengths.iter().product()
    }
}

impl Domain<2> {
    /// Walls across the first direction, periodic along the second.
    pub fn channel(lengths: [f64; 2]) -> Self {
        let walls = [Wall::Solid, Wall::Periodic];
        Self { lengths, walls }
    }
}
