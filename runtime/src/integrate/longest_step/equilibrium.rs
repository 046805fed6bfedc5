//! Probes of Lagrangians with terms linear in velocities, as of magnetic fields and rotating frames. The momenta of a
//! constrained start at rest are then not zero, and a disturbed state moves with the same momenta. Takes states;
//! gives momenta and velocities.

use super::extremes::{dot, numbers};
use super::probe::Probe;

/// Velocities are measured over this many probe steps.
const LONG: f64 = 100.0;

/// A state is at rest if it moves by less than this fraction of its unit in a probe step.
const STILL: f64 = 1e-9;

/// The fraction of the velocities of zero momenta that may remain, and the largest number of directions.
const LEFT: f64 = 1e-5;
const DIRECTIONS: usize = 50;

/// If a disturbed state moves by more than this fraction of the disturbance in a long step, terms linear in
/// velocities move it: forces would move it a hundred times less.
const LED: f64 = 1e-3;

impl Probe<'_> {
    /// The velocities at the start of a step from a state, from a long step and a step half as long: the contribution
    /// of forces grows with the square of the step.
    fn leaving(&self, state: &[Vec<f64>]) -> Option<Vec<f64>> {
        let h = LONG * self.step();
        let at = self.observed(state, h, 0)?;
        let whole = self.change(&at, &self.observed(state, h, 1)?);
        let half = self.change(&at, &self.observed(state, 0.5 * h, 1)?);
        let both = half.iter().zip(&whole);
        Some(both.map(|(half, whole)| (4.0 * half - whole) / h).collect())
    }

    /// The initial velocities of the base, if disturbed states have other initial velocities.
    pub(super) fn drifting(&self) -> Option<Vec<f64>> {
        let p = self.along(numbers(self.count()))?;
        let v = self.velocity(&p)?;
        let disturbed = self.disturbed(&v, &p, self.part() / self.size(&v))?;
        let from = self.leaving(self.base())?;
        let led = self.faster(&disturbed, &from)?;
        let moved = self.size(&led) * LONG * self.step().abs();
        (moved > LED * self.part()).then_some(from)
    }

    /// The velocity of a state disturbed by `scale` times a motion, minus the velocity of the base at the same momenta,
    /// divided by `scale`.
    pub(super) fn led(&self, disturbed: &[Vec<f64>], scale: f64) -> Option<Vec<f64>> {
        let Some(from) = self.drift() else {
            return Some(vec![0.0; self.count()]);
        };
        let led = self.faster(disturbed, from)?;
        Some(led.iter().map(|w| w / scale).collect())
    }

    /// The velocities of a state minus the velocities `from`.
    fn faster(&self, state: &[Vec<f64>], from: &[f64]) -> Option<Vec<f64>> {
        let to = self.leaving(state)?;
        Some(to.iter().zip(from).map(|(to, from)| to - from).collect())
    }

    /// A state near rest: the same positions with momenta that nearly cancel its velocities; `None` if the state is
    /// already at rest. By conjugate gradients for the inverse of the mass.
    pub(super) fn rested(&self, state: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let mut left = self.leaving(state)?;
        let first = self.size(&left);
        if first * self.step().abs() < STILL {
            return None;
        }
        let (mut slowest, mut found) = (first, None);
        let (mut now, mut direction, mut before) = (state.to_vec(), vec![0.0; left.len()], 0.0);
        for _ in 0..DIRECTIONS.min(self.count()) {
            let square = dot(&left, &left);
            let again = if before > 0.0 { square / before } else { 0.0 };
            before = square;
            let next = left.iter().zip(&direction);
            direction = next.map(|(v, d)| again * d - v).collect();
            let length = square / dot(&direction, &self.velocity(&direction)?);
            if !length.is_finite() {
                break;
            }
            let push: Vec<f64> = direction.iter().map(|d| length * d).collect();
            self.push(&mut now, &push)?;
            left = self.leaving(&now)?;
            if self.size(&left) < slowest {
                slowest = self.size(&left);
                found = Some(now.clone());
            }
            if slowest <= LEFT * first {
                break;
            }
        }
        found
    }
}
