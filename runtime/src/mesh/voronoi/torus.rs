//! Positions on a torus as whole numbers of grains. Sums, differences and shifts by periods are exact, so all copies of
//! a triangle give the same result. A grain is 2^-50 of the longer period.

/// The number of grains in the longer period. Positions within two periods, and their differences, are exact in double
/// precision.
const GRAINS: f64 = (1_u64 << 50) as f64;

/// Adding and subtracting this number rounds to the nearest whole number, for numbers up to 2^51.
const ROUND: f64 = 6_755_399_441_055_744.0; // 3 * 2^51

/// A vector in grains.
pub(super) type Grains = [f64; 2];

/// The periods, as lengths and in grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Torus {
    /// The periods as lengths.
    pub lengths: [f64; 2],
    /// The periods in grains.
    pub periods: Grains,
    per_length: f64,
}

impl Torus {
    /// A torus with these periods, which must be positive and finite.
    pub fn new(lengths: [f64; 2]) -> Self {
        let per_length = GRAINS / lengths[0].max(lengths[1]);
        let periods = lengths.map(|length| (length * per_length).round());
        Self {
            lengths,
            periods,
            per_length,
        }
    }

    /// The nearest position in grains; the coordinates must be within a few periods of the origin.
    #[inline(always)]
    pub fn place(&self, at: [f64; 2]) -> Grains {
        at.map(|x| (x * self.per_length + ROUND) - ROUND)
    }

    /// The vector between two positions, with the second shifted by `offset` periods.
    #[inline(always)]
    pub fn between(&self, from: Grains, to: Grains, offset: [i16; 2]) -> Grains {
        let along = |k: usize| to[k] - from[k] + f64::from(offset[k]) * self.periods[k];
        [along(0), along(1)]
    }

    /// The number of periods between two vectors that differ by whole periods.
    pub fn periods_between(&self, from: Grains, to: Grains) -> [i16; 2] {
        let along = |k: usize| ((to[k] - from[k]) / self.periods[k]).round() as i16;
        [along(0), along(1)]
    }
}
