//! Linearises a model about its initial state at rest by finite differences of single steps: the forces of
//! disturbances, the velocities of momenta, and the projection of momenta on the constraints. Takes a card with its
//! data; gives lists over all degrees of freedom.

use super::extremes::{Motion, dot, numbers};
use super::moves::{self, Moves};
use super::unknown::Unknown;
use super::waves;
use crate::card::{Card, OpenError, Settings, Trajectory};
use crate::scalar::largest;
use std::cell::Cell;

/// The size of a disturbance, and of a momentum, relative to its unit: forces and velocities are assumed to be
/// linear in both. It is larger than the square root of the rounding unit, since models are nonlinear.
const PART: f64 = 1e-5;

/// Like `PART`, for a model with constraints, divided by the number of its configurations. The curvature of
/// constraints is measured by disturbances relative to the distance of neighbours, which is about that fraction of
/// the unit.
const PART_HELD: f64 = 1e-6;

/// The model has constraints if the projection removes more than this share of random momenta.
const TAKEN: f64 = 1e-9;

/// How many sizes of a momentum are tried, and the factor by which a failed size is reduced.
const SCALES: usize = 12;
const SLOWER: f64 = 1e-4;

/// If the displacement by a momentum is less than this fraction of the displacement that a smaller momentum predicts,
/// the momentum is too large to be linear. An example is a relativistic particle.
const STRAIGHT: f64 = 0.5;

/// The factor that reduces such a momentum, and the smallest final displacement, in units of the disturbances.
const SMALLER: f64 = 1e-2;
const SEEN: f64 = 1e-6;

/// Whether displacements are not proportional to scales, because the larger scale gives too small a displacement.
fn is_bent(one: (f64, f64), other: (f64, f64)) -> bool {
    let ((scale, way), (larger, farther)) = match one.0 < other.0 {
        true => (one, other),
        false => (other, one),
    };
    farther < STRAIGHT * way * larger / scale
}

pub(super) struct Probe<'a> {
    card: &'a Card,
    parameters: &'a [Vec<f64>],
    /// At rest.
    initial: Vec<Vec<f64>>,
    /// The momenta of the start at rest.
    resting: Vec<f64>,
    pub(super) moves: Vec<Moves>,
    /// The probe step.
    h: f64,
    /// The unit of disturbances of each degree of freedom.
    pub(super) units: Vec<f64>,
    /// The observables after a step from rest.
    rest: Vec<f64>,
    /// The state at rest for the comparison of forces: the start or, with constraints, the end of a step from the
    /// start.
    base: Vec<Vec<f64>>,
    /// The observables after a step from the base.
    pushed: Vec<f64>,
    /// Disturbances relative to their units.
    part: f64,
    /// Whether momenta are projected on constraints.
    held: bool,
    /// The velocities of the base, if disturbed states have other velocities.
    drift: Option<Vec<f64>>,
    /// Whether the model failed to step from one of the states.
    refused: Cell<bool>,
    /// Returns whether to give up the search.
    ended: &'a dyn Fn() -> bool,
}

impl<'a> Probe<'a> {
    pub(super) fn new(
        card: &'a Card,
        parameters: &'a [Vec<f64>],
        initial: &[Vec<f64>],
        h: f64,
        ended: &'a dyn Fn() -> bool,
    ) -> Result<Self, Unknown> {
        let moves = Moves::all(card).ok_or(Unknown::Kind)?;
        let mut initial = initial.to_vec();
        for body in &moves {
            let momentum = initial.get_mut(body.behind).ok_or(Unknown::Kind)?;
            momentum.fill(0.0);
        }
        let units = moves::units(&moves, &initial);
        let mut probe = Probe {
            card,
            parameters,
            base: initial.clone(),
            initial,
            resting: Vec::new(),
            moves,
            h,
            units,
            rest: Vec::new(),
            pushed: Vec::new(),
            part: PART,
            held: false,
            drift: None,
            refused: Cell::new(false),
            ended,
        };
        probe.resting = probe.given(&probe.initial);
        let step = probe.after(&probe.initial, h);
        probe.rest = step.ok_or(Unknown::Start)?;
        let p = numbers(probe.count());
        let along = probe.projected(&p).ok_or(Unknown::Start)?;
        let taken = largest(p.iter().zip(&along).map(|(a, b)| a - b));
        probe.held = taken > TAKEN * largest(p.iter().copied());
        if !probe.held {
            // The base is the start.
            probe.pushed.clone_from(&probe.rest);
            probe.drift = probe.drifting();
            return Ok(probe);
        }
        probe.part = PART_HELD / probe.moves.len() as f64;
        // The directions of constraints change along the motion, so a velocity at the start would act like a force.
        let start = probe.rested(&probe.initial);
        let start = start.unwrap_or_else(|| probe.initial.clone());
        probe.initial = probe.settled(start).ok_or(Unknown::Start)?;
        probe.resting = probe.given(&probe.initial);
        let step = probe.after(&probe.initial, h);
        probe.rest = step.ok_or(Unknown::Start)?;
        let base = probe.at_rest(&probe.rest);
        probe.base = base.ok_or(Unknown::Start)?;
        let step = probe.after(&probe.base, h);
        probe.pushed = step.ok_or(Unknown::Start)?;
        probe.drift = probe.drifting();
        Ok(probe)
    }

    /// The number of degrees of freedom.
    pub(super) fn count(&self) -> usize {
        self.moves.iter().map(Moves::count).sum()
    }

    /// The state for the comparison of forces.
    pub(super) fn base(&self) -> &[Vec<f64>] {
        &self.base
    }

    /// Disturbances relative to their units.
    pub(super) fn part(&self) -> f64 {
        self.part
    }

    /// The initial velocities of the base, if disturbed states have other initial velocities.
    pub(super) fn drift(&self) -> Option<&[f64]> {
        self.drift.as_deref()
    }

    /// The probe step.
    pub(super) fn step(&self) -> f64 {
        self.h
    }

    /// Whether momenta are projected on constraints.
    pub(super) fn is_held(&self) -> bool {
        self.held
    }

    /// The reason for a missing value: a failed step, otherwise the given reason.
    pub(super) fn why(&self, otherwise: Unknown) -> Unknown {
        match self.refused.get() {
            true => Unknown::Refused,
            false => otherwise,
        }
    }

    /// The trajectory from a state; momenta are projected.
    fn open(&self, initial: &[Vec<f64>], h: f64) -> Result<Box<dyn Trajectory>, OpenError> {
        (self.card.open)(self.parameters, initial, Settings::step(h).to_inquire())
    }

    /// The observables of a trajectory after `steps` steps.
    pub(super) fn observed(&self, initial: &[Vec<f64>], h: f64, steps: usize) -> Option<Vec<f64>> {
        if (self.ended)() {
            return None;
        }
        let mut trajectory = self.open(initial, h).ok()?;
        for _ in 0..steps {
            trajectory.step().ok()?;
        }
        let mut out = vec![0.0; self.card.observable_count()];
        trajectory.observe(&mut out);
        out.iter().all(|x| x.is_finite()).then_some(out)
    }

    /// The observables after one step of `h`.
    fn after(&self, initial: &[Vec<f64>], h: f64) -> Option<Vec<f64>> {
        let found = self.observed(initial, h, 1);
        self.refused.set(self.refused.get() || found.is_none());
        found
    }

    /// The observed momenta, in the order of the degrees of freedom.
    fn momenta<'o>(&'o self, observed: &'o [f64]) -> impl Iterator<Item = f64> + 'o {
        self.moves.iter().flat_map(|body| body.momenta(observed))
    }

    /// The momenta of a state, in the order of the degrees of freedom.
    fn given(&self, state: &[Vec<f64>]) -> Vec<f64> {
        let each = self.moves.iter();
        each.flat_map(|body| body.given(state)).collect()
    }

    /// Gives a state these momenta.
    fn give(&self, state: &mut [Vec<f64>], mut momenta: impl Iterator<Item = f64>) -> Option<()> {
        for body in &self.moves {
            *state.get_mut(body.behind)? = body.momentum_with(momenta.by_ref().take(body.count()));
        }
        Some(())
    }

    /// Adds momenta to a state.
    pub(super) fn push(&self, state: &mut [Vec<f64>], added: &[f64]) -> Option<()> {
        let own = self.given(state);
        self.give(state, own.iter().zip(added).map(|(own, p)| own + p))
    }

    /// The start with momenta.
    fn thrown(&self, p: &[f64], scale: f64) -> Option<Vec<Vec<f64>>> {
        let mut moved = self.initial.clone();
        let momenta = self.resting.iter().zip(p);
        self.give(&mut moved, momenta.map(|(own, x)| own + x * scale))?;
        Some(moved)
    }

    /// A state at rest in the observed configurations.
    fn at_rest(&self, observed: &[f64]) -> Option<Vec<Vec<f64>>> {
        let mut state = self.initial.clone();
        for body in &self.moves {
            let place = observed.get(body.place.clone())?;
            *state.get_mut(body.initial)? = place.to_vec();
        }
        self.settled(state)
    }

    /// A state with its momenta projected on the constraints. If the Lagrangian has terms linear in velocities, zero
    /// momenta may belong to a velocity that is not tangent to the constraints.
    fn settled(&self, mut state: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
        let along = self.observed(&state, self.h, 0)?;
        self.give(&mut state, self.momenta(&along))?;
        Some(state)
    }

    /// Momenta projected on the constraints at the start; unchanged without constraints.
    fn projected(&self, p: &[f64]) -> Option<Vec<f64>> {
        // A step from rest with these momenta can fail only because they are too large, for example if the mass is
        // much smaller than one.
        let mut scale = 1.0 / largest(p.iter().copied());
        if !scale.is_finite() {
            return Some(p.to_vec());
        }
        for _ in 0..SCALES {
            if let Some(start) = self.observed(&self.thrown(p, scale)?, self.h, 0) {
                let along = self.momenta(&start).zip(&self.resting);
                return Some(along.map(|(x, own)| (x - own) / scale).collect());
            }
            scale *= SLOWER;
        }
        None
    }

    /// Momenta projected on the constraints; without constraints they are returned unchanged.
    pub(super) fn along(&self, p: Vec<f64>) -> Option<Vec<f64>> {
        match self.held {
            true => self.projected(&p),
            false => Some(p),
        }
    }

    /// The stiffness times `v`, for a disturbance along the velocity `v` with momentum `p`: the force at the base
    /// minus the force at the disturbed state. The second list is the velocity that the disturbance causes at the
    /// same momenta, which contributes to this stiffness.
    pub(super) fn stiffness(&self, v: &[f64], p: &[f64]) -> Option<[Vec<f64>; 2]> {
        let scale = self.part / self.size(v);
        let disturbed = self.disturbed(v, p, scale)?;
        let after = self.after(&disturbed, self.h)?;
        let rest = self.forces(&self.base, &self.pushed);
        let change = rest.zip(self.forces(&disturbed, &after));
        let change = change.map(|(rest, after)| (rest - after) / scale).collect();
        Some([change, self.led(&disturbed, scale)?])
    }

    /// The mean forces in a step from a state to the observed momenta.
    fn forces<'o>(
        &'o self,
        state: &'o [Vec<f64>],
        after: &'o [f64],
    ) -> impl Iterator<Item = f64> + 'o {
        let before = self.moves.iter().flat_map(|body| body.given(state));
        let acted = self.momenta(after).zip(before);
        acted.map(|(after, before)| (after - before) / self.h)
    }

    /// The velocity of a momentum `p`: the displacement in a step with it, relative to a step from rest.
    pub(super) fn velocity(&self, p: &[f64]) -> Option<Vec<f64>> {
        // The displacement is known only after the step.
        let mut scale = self.part / largest(p.iter().copied());
        if !scale.is_finite() {
            return None;
        }
        let mut refused = false;
        // The previous scale with its displacement, and whether scales are reduced until displacements are proportional to them.
        let (mut before, mut bends) = (None, false);
        for _ in 0..SCALES {
            // A step may fail because the velocity is too large for the model, for example with a small mass.
            let thrown = self.thrown(p, scale)?;
            let Some(after) = self.observed(&thrown, self.h, 1) else {
                refused = true;
                scale *= SLOWER;
                continue;
            };
            let change = self.change(&self.rest, &after);
            let most = self.size(&change);
            let found = || change.iter().map(|x| x / (scale * self.h)).collect();
            let wanted = (0.01 * self.part..=100.0 * self.part).contains(&most);
            if wanted && !bends {
                return Some(found());
            }
            let now = (scale, most);
            let bent = before.is_some_and(|before| is_bent(before, now));
            if bends && !bent {
                return (most > SEEN * self.part).then(found);
            }
            bends |= bent;
            // A displacement at rounding level does not show whether the response is linear.
            before = (most > SEEN * self.part).then_some(now);
            scale *= if bends {
                SMALLER
            } else if most > 0.0 {
                self.part / most
            } else {
                1e6
            };
        }
        self.refused.set(self.refused.get() || refused);
        None
    }

    /// Whether a step of `h`, disturbed by this motion, leaves `1 - h² ω²/2` of it, as steps with the potential at
    /// the nodes do: one with it in the middle leaves `(4 - h² ω²)/(4 + h² ω²)`. Uses a fraction of the step if the
    /// whole step fails; `None` if the shorter step fails too.
    pub(super) fn is_left(&self, motion: &Motion, h: f64) -> Option<bool> {
        // The two schemes differ by a quarter of h² ω² for the whole step, by a tenth for half of it, by 0.03 for a
        // quarter.
        [(h, 0.1), (0.5 * h, 0.05), (0.25 * h, 0.015)]
            .into_iter()
            .find_map(|(h, near)| Some((self.left(motion, h)?, near)))
            .map(|((h, left), near)| {
                let square = h * h * motion.square;
                (left - (1.0 - 0.5 * square)).abs() < near * square.abs()
            })
    }

    /// The step, and the fraction of a motion that remains after it; `None` if the step fails.
    fn left(&self, motion: &Motion, h: f64) -> Option<(f64, f64)> {
        let scale = self.part / self.size(&motion.velocity);
        let moved = self.disturbed(&motion.velocity, &motion.momentum, scale)?;
        let led = dot(&motion.momentum, &self.led(&moved, scale)?);
        let [from, to] = [self.base.clone(), moved].map(|state| self.braced(state, h));
        let change = self.change(&self.after(&from?, h)?, &self.after(&to?, h)?);
        Some((h, dot(&motion.momentum, &change) / scale - h * led))
    }

    /// A state with the momentum that cancels the forces at the start over the first half of a step. A start that is
    /// not an equilibrium then stays in place, so that a long step shows only the disturbance.
    fn braced(&self, mut state: Vec<Vec<f64>>, h: f64) -> Option<Vec<Vec<f64>>> {
        let forces = self.forces(&self.base, &self.pushed);
        let against: Vec<f64> = forces.map(|f| -0.5 * h * f).collect();
        self.push(&mut state, &against)?;
        Some(state)
    }

    /// How much neighbours move against each other in a motion.
    pub(super) fn shortness(&self, motion: &Motion) -> f64 {
        let names = self.moves.iter();
        let names: Vec<&str> = names
            .map(|body| self.card.initial[body.initial].ascii)
            .collect();
        let pairs = waves::neighbours(&self.moves, &names);
        waves::shortness(&motion.velocity, &self.units, &pairs)
    }

    /// The largest component of a change in units of disturbances.
    pub(super) fn size(&self, change: &[f64]) -> f64 {
        largest(change.iter().zip(&self.units).map(|(x, unit)| x / unit))
    }

    /// The change of all configurations between two observations.
    pub(super) fn change(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let each = self.moves.iter().flat_map(|body| {
            let place = body.place.clone();
            moves::difference(body, &from[place.clone()], &to[place])
        });
        each.collect()
    }

    /// The start with a disturbance `scale` times `v`. For a model with constraints, the end of a step with the
    /// momentum `p`, which satisfies the constraints.
    pub(super) fn disturbed(&self, v: &[f64], p: &[f64], scale: f64) -> Option<Vec<Vec<f64>>> {
        if self.held {
            let thrown = self.thrown(p, scale / self.h)?;
            return self.at_rest(&self.after(&thrown, self.h)?);
        }
        let mut moved = self.initial.clone();
        let mut from = 0;
        for body in &self.moves {
            let own: Vec<f64> = v[from..from + body.count()]
                .iter()
                .map(|x| x * scale)
                .collect();
            from += body.count();
            moves::disturb(moved.get_mut(body.initial)?, body, &own)?;
        }
        Some(moved)
    }
}
