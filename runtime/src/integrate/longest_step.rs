//! The stability limit of the step size: 2/ω, with ω the frequency of the fastest small motion about the initial
//! state. Takes a model's card with its data; takes single steps from rest to compute forces and the inverse of the
//! mass.

mod equilibrium;
mod extremes;
mod moves;
mod probe;
mod unknown;
mod waves;

pub use unknown::Unknown;

use crate::card::Card;
use crate::number_format::{Plain, Short};
use crate::solvers::largest_step::search_of;
use core::cell::Cell;
use core::fmt;
use probe::Probe;

/// Steps of the probe as a share of the run's step. If ω h is at most about 2, ω² h² of a probe step is at most 4e-6.
const SHORT: f64 = 1e-3;

/// If the limit is below this share of the run's step, the probe is repeated with shorter steps.
const FAR: f64 = 0.1;

/// The shares of the step for these repetitions.
const SHORTER: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

/// If no motion oscillates, the probe is repeated with these multiples of the step, which may be far shorter than all
/// times of the motion.
const LONGER: [f64; 4] = [1e3, 1e6, 1e9, 1e12];

/// A growth rate that a trial step does not confirm is ignored if its square is below this share of ω² of the fastest
/// motion.
const SLIGHT: f64 = 1e-3;

/// The growth rate times the step size above which clebsch warns. An inverted body falls over many steps and stays
/// below it.
const GROWTH: f64 = 0.3;

/// Waves whose phase changes by more than about 135 degrees from site to site alternate; for two neighbours that move
/// in opposite directions the value is 1.5.
const ALTERNATING: f64 = 1.7;

/// The smallest number of configurations for a warning about waves.
const WAVES: usize = 4;

/// The stability limit and the growth rate of small motions about the initial configuration, at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongestStep {
    /// 2/ω, where ω is the frequency of the fastest small motion; infinite if no motion oscillates.
    pub step: f64,
    /// The rate of the fastest growing small motion, in the inverse unit of time; 0 if no motion grows.
    pub growth: f64,
    /// The number of disturbed configurations; each site counts.
    pub configurations: usize,
    /// How much neighbours move against each other in the motion that grows fastest: 0 if they move alike, 2 if they
    /// alternate; 0 if no motion grows.
    pub alternating: f64,
}

/// The effort to find the stability limit.
#[derive(Clone, Copy)]
pub struct Effort<'a> {
    /// Returns whether to give up the search. The search calls it before each probe step.
    pub ended: &'a dyn Fn() -> bool,
    /// Whether limits thousands of times above the step are of interest.
    pub far: bool,
}

impl fmt::Debug for Effort<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Effort")
            .field("far", &self.far)
            .finish_non_exhaustive()
    }
}

impl Effort<'_> {
    /// A search without a time limit, also for limits far above the step.
    pub const UNBOUNDED: Self = Self {
        ended: &|| false,
        far: true,
    };
}

/// Why the stability limit is unknown. The time of the fastest motion may still be known.
#[derive(Clone, Copy, Debug)]
struct Missed {
    why: Unknown,
    /// The time in which the fastest motion oscillates or grows; NaN if it is unknown.
    fastest: f64,
}

impl From<Unknown> for Missed {
    fn from(why: Unknown) -> Self {
        Self {
            why,
            fastest: f64::NAN,
        }
    }
}

impl LongestStep {
    /// The limit for a model with these data, each field one vector, row-major. `h` is the approximate step size of the
    /// run.
    ///
    /// If the model has constraints, its small motions are tangent to them, and the constraint forces at the start
    /// count as stiffness. The model projects the momenta itself ([`crate::card::Settings::inquiry`]).
    ///
    /// # Errors
    /// [`Unknown`] with the reason.
    pub fn of(
        card: &Card,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        h: f64,
    ) -> Result<Self, Unknown> {
        Self::by(Effort::UNBOUNDED, card, parameters, initial, h)
    }

    /// As [`LongestStep::of`], with a bounded effort.
    ///
    /// # Errors
    /// As [`LongestStep::of`]; [`Unknown::Unfinished`] if the search was given up.
    pub fn by(
        effort: Effort<'_>,
        card: &Card,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        h: f64,
    ) -> Result<Self, Unknown> {
        let cut = Cell::new(false);
        let ended = || {
            cut.set(cut.get() || (effort.ended)());
            cut.get()
        };
        let effort = Effort {
            ended: &ended,
            ..effort
        };
        // Turns off the search for a shorter step after a failed one: it takes a hundred trials, and is not needed
        // here.
        let found = search_of(|| Self::sought(effort, [parameters, initial], card, h));
        match cut.get() {
            true => Err(Unknown::Unfinished),
            false => found.unwrap_or(Err(Unknown::Start)),
        }
    }

    fn sought(
        effort: Effort<'_>,
        [parameters, initial]: [&[Vec<f64>]; 2],
        card: &Card,
        h: f64,
    ) -> Result<Self, Unknown> {
        let asked = |part: f64| {
            let probe = Probe::new(card, parameters, initial, h * part * SHORT, effort.ended)?;
            Self::asked(&probe, h * part)
        };
        let found = asked(1.0);
        let has_an_end = match &found {
            Ok(found) => found.step > FAR * h.abs(),
            // Shorter probe steps serve only for smaller limits.
            Err(missed) => missed.fastest >= h.abs() || missed.why == Unknown::Kind,
        };
        if has_an_end {
            return found.map_err(|missed| missed.why);
        }
        let is_still = |missed: &Missed| missed.why == Unknown::Still;
        if found.as_ref().is_err_and(is_still) {
            if !effort.far {
                return Err(Unknown::Still);
            }
            let longer = LONGER.into_iter().map(asked);
            // If a step fails, longer steps fail too.
            let longer = longer.take_while(|found| found.as_ref().map_or_else(is_still, |_| true));
            let mut longer = longer.flatten().filter(|found| found.step > h.abs());
            return longer.next().ok_or(Unknown::Still);
        }
        // If the step is hundreds of times too long, even a small fraction of it is too long for the probe.
        let shorter = SHORTER.into_iter().filter_map(|part| asked(part).ok());
        let mut shorter = shorter.filter(|found| found.step < h.abs());
        shorter
            .next()
            .map_or(found.map_err(|missed| missed.why), Ok)
    }

    /// The limit, from probe steps that are short compared with `h`.
    fn asked(probe: &Probe<'_>, h: f64) -> Result<Self, Missed> {
        let [least, largest] = probe.extremes()?;
        // If a rate is below 2e-5 / h, or its square is below 1e-6 of the other square, it is only the rounding error
        // of vanishing forces.
        let rounding = (2.0e-5 / h).powi(2);
        let seen = |x: f64, beside: f64| x.abs() > rounding && x.abs() > 1e-6 * beside.abs();
        let swings = largest.square > 0.0 && seen(largest.square, least.square);
        let grows = least.square < 0.0 && seen(least.square, largest.square);
        let step = match swings {
            true => 2.0 / largest.square.sqrt(),
            false => f64::INFINITY,
        };
        let growth = match grows {
            true => (-least.square).sqrt(),
            false => 0.0,
        };
        if !swings && !grows {
            return Err(Unknown::Still.into());
        }
        let missed = |why| Missed {
            why,
            fastest: step.min(1.0 / growth),
        };
        // A trial step must move each motion as a Störmer-Verlet step does. If the model has constraints, their
        // directions change within a step that resolves slow growth, so the trial step is then not longer than the
        // limit.
        let resolving = match probe.is_held() {
            true => step.min(1.0 / growth),
            false => 1.0 / growth,
        };
        let growing = grows && probe.is_left(&least, resolving) == Some(true);
        let swung = match swings {
            true => probe.is_left(&largest, step).ok_or(missed(Unknown::Far))?,
            false => true,
        };
        // Growth that is slow compared with ω may come from forces that rotate with their frames.
        let slight = swings && least.square.abs() < SLIGHT * largest.square;
        let moved = swung && (!grows || growing || slight || probe.is_held() && swings);
        let growth = match growing {
            true => growth,
            false => 0.0,
        };
        let alternating = match growing {
            true => probe.shortness(&least),
            false => 0.0,
        };
        match moved {
            true => Ok(Self {
                step,
                growth,
                configurations: probe.moves.len(),
                alternating,
            }),
            false => Err(missed(Unknown::OtherSteps)),
        }
    }

    /// ω of the fastest small motion, in radians per unit of time; 0 if no motion oscillates.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        2.0 / self.step
    }

    /// The step size over which the fastest growing motion grows by a third; infinite if no motion grows.
    #[must_use]
    pub fn resolving(&self) -> f64 {
        GROWTH / self.growth
    }

    /// Whether the fastest growing motion alternates between neighbours. If so, shorter waves grow faster, as if a
    /// wrong sign made the equations elliptic along the label.
    #[must_use]
    pub fn is_elliptic(&self) -> bool {
        self.configurations >= WAVES && self.growth > 0.0 && self.alternating > ALTERNATING
    }

    /// A warning if steps of `h` exceed the stability limit, or do not resolve a growing motion.
    #[must_use]
    pub fn warning(&self, h: f64) -> Option<String> {
        let h = h.abs();
        if self.is_elliptic() {
            return Some(format!(
                "small motions about the initial configuration grow, fastest where they alternate between neighbours, with the \
                 rate {}: is the sign of the potential energy or of a coupling of neighbours wrong? If the label is a \
                 coordinate, the problem is elliptic, and the growth rate increases with the number of sites for any step",
                Short(self.growth)
            ));
        }
        if h > self.step {
            return Some(format!(
                "the step h = {} is {:.2} times the stability limit {} of small motions about the initial configuration \
                 (2/ω of the fastest mode): disturbances grow in every step; reduce h",
                Plain(h),
                h / self.step,
                Short(self.step)
            ));
        }
        if h > self.resolving() {
            let a_step = match (h * self.growth).exp() {
                few if few < 1e3 => format!("{few:.2}"),
                many if many.is_finite() => format!("{many:.1e}"),
                _ => format!("exp({})", Short(h * self.growth)),
            };
            let grow = format!(
                "small motions about the initial configuration grow with the rate {}, by a factor of {a_step} per step",
                Short(self.growth)
            );
            // An inverted body and a rod under tension are genuinely unstable; fast growth between neighbours
            // usually comes from a wrong sign.
            return Some(match self.configurations {
                1 => format!(
                    "{grow}: near that configuration, steps of h = {} do not resolve the growth; use at most {}",
                    Plain(h),
                    Short(self.resolving())
                ),
                _ => format!(
                    "{grow}: is the sign of the potential energy or of a coupling of neighbours wrong? If the instability is \
                     real, steps of h = {} do not resolve the growth; use at most {}",
                    Plain(h),
                    Short(self.resolving())
                ),
            });
        }
        None
    }
}
