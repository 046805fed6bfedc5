//! One direction of a uniform grid: the coordinates and weights of its nodes, and the images of nodes beyond its
//! ends. Takes a length, a number of intervals and the boundary condition.

use super::super::{MeshError, Wall};
use crate::{ParameterError, Problem, Real};

/// A direction of a grid: from 0 to its length in equal intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    length: f64,
    intervals: usize,
    wall: Wall,
}

/// The position of a coordinate on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot<T> {
    /// Number of the interval.
    pub cell: usize,
    /// Position within it, in intervals from 0 to 1.
    pub fraction: T,
    /// Whether the coordinate is beyond a wall; `fraction` then belongs to its mirror image.
    pub mirrored: bool,
}

/// The largest number of intervals of an axis: interval numbers have 30 bits.
const MOST: usize = 1 << 30;

impl Axis {
    /// One interval of length 1.
    pub(super) const UNIT: Self = Self {
        length: 1.0,
        intervals: 1,
        wall: Wall::Periodic,
    };

    /// An axis.
    ///
    /// # Errors
    /// If the length is not positive and finite, or the number of intervals is zero or more than 2^30.
    pub fn new(length: f64, intervals: usize, wall: Wall) -> Result<Self, ParameterError> {
        let refused = |field, problem, remedy| ParameterError {
            field,
            problem,
            remedy,
        };
        if !(length > 0.0 && length.is_finite()) {
            return Err(refused(
                "domain",
                Problem::NotPositive { value: length },
                "give each direction of the domain a positive length",
            ));
        }
        if !(1..=MOST).contains(&intervals) {
            return Err(refused(
                "grid",
                Problem::AssumptionFails {
                    text: "1 <= intervals along each direction <= 2^30",
                },
                "give the grid at least one interval along each direction",
            ));
        }
        Ok(Self {
            length,
            intervals,
            wall,
        })
    }

    /// Number of intervals.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.intervals
    }

    /// Number of nodes: the number of intervals, plus one between walls.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.wall.nodes(self.intervals)
    }

    /// Length of an interval.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.length / self.intervals as f64
    }

    /// The boundary condition.
    #[must_use]
    pub fn wall(&self) -> Wall {
        self.wall
    }

    /// Coordinate of a node.
    #[must_use]
    pub fn coordinate(&self, node: usize) -> f64 {
        self.length * (node as f64 / self.intervals as f64)
    }

    /// Weight of a node in the trapezoid rule: the spacing, half of it on a wall.
    #[must_use]
    pub fn weight<T: Real>(&self, node: usize) -> T {
        let whole = T::from_f64(self.length) / T::from_f64(self.intervals as f64);
        match self.wall == Wall::Solid && (node == 0 || node == self.intervals) {
            true => whole * T::from_f64(0.5),
            false => whole,
        }
    }

    /// The node whose image is the padded point with index `padded`: the same node modulo the period, or its repeated
    /// mirror image in the walls.
    pub(super) fn image(&self, padded: usize, margin: usize) -> usize {
        let n = self.intervals;
        match self.wall {
            Wall::Periodic => (padded + margin * (n - 1)) % n,
            Wall::Solid => {
                // Even, with period 2n.
                let turned = (padded + margin * (2 * n - 1)) % (2 * n);
                turned.min(2 * n - turned)
            }
        }
    }

    /// Intervals per unit of length.
    #[inline(always)]
    pub(super) fn density<T: Real>(&self) -> T {
        T::from_f64(self.intervals as f64) / T::from_f64(self.length)
    }

    /// The interval that contains a coordinate, given in intervals from the origin: wrapped if periodic,
    /// mirrored if it is beyond a wall by at most one interval.
    #[inline(always)]
    pub(super) fn locate<T: Real>(&self, mut along: T) -> Result<Spot<T>, OutsideReason> {
        let n = self.intervals as f64;
        let mut at = along.value();
        let mut mirrored = false;
        if !(at >= 0.0 && at < n) {
            (along, mirrored) = self.returned(along)?;
            at = along.value();
        }
        let cell = (at as u32).min(self.intervals as u32 - 1);
        Ok(Spot {
            cell: cell as usize,
            fraction: along - T::from_f64(f64::from(cell)),
            mirrored,
        })
    }

    /// The coordinate mapped into the axis, and whether it is mirrored.
    #[cold]
    #[inline(never)]
    fn returned<T: Real>(&self, along: T) -> Result<(T, bool), OutsideReason> {
        let n = self.intervals as f64;
        let at = along.value();
        if !at.is_finite() {
            return Err(OutsideReason::Nowhere);
        }
        match self.wall {
            Wall::Periodic => {
                let shift = n * (at / n).floor();
                // If the coordinate is so far away that the product is not exact, take the exact remainder.
                let shift = match (0.0..=n).contains(&(at - shift)) {
                    true => shift,
                    false => at - at.rem_euclid(n),
                };
                Ok((along - T::from_f64(shift), false))
            }
            Wall::Solid if at == n => Ok((along, false)),
            Wall::Solid if (-1.0..0.0).contains(&at) => Ok((-along, true)),
            Wall::Solid if at > n && at <= n + 1.0 => Ok((T::from_f64(2.0 * n) - along, true)),
            Wall::Solid => Err(OutsideReason::By(self.spacing() * (-at).max(at - n))),
        }
    }
}

/// Why no interval contains a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OutsideReason {
    /// The coordinate is NaN or infinite.
    Nowhere,
    /// The coordinate is beyond a wall by this length.
    By(f64),
}

impl OutsideReason {
    /// This error, for the particle `site`.
    #[cold]
    pub(super) fn of(self, site: usize) -> MeshError {
        match self {
            Self::Nowhere => MeshError::NotFinite { site },
            Self::By(by) => MeshError::Outside { site, by },
        }
    }
}
