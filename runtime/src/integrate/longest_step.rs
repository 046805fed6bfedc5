//! The longest step with which small motions about the start stay small: 2/ω, ω the frequency of the fastest one.
//! Takes a model's card with its data; asks single steps from rest for forces and for the inverse of the mass.

mod extremes;
mod moves;
mod probe;
mod resting;
mod unknown;
mod waves;

pub use unknown::Unknown;

use crate::card::Card;
use crate::solvers::largest_step::search_of;
use core::cell::Cell;
use core::fmt;
use probe::Probe;

/// Steps of the inquiry in parts of the run's own: with ω h at most about 2, ω² h² of them is 4e-6 at most.
const SHORT: f64 = 1e-3;

/// A limit that is a smaller part of the run's step than this is asked for once more by shorter steps.
const FAR: f64 = 0.1;

/// By which parts of the step.
const SHORTER: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

/// Where nothing is seen to swing, by which multiples of the step: it may be far below all times of the motion.
const LONGER: [f64; 4] = [1e3, 1e6, 1e9, 1e12];

/// A growth that no step confirms is none where its square is a smaller part than this of that of the fastest motion.
const SLIGHT: f64 = 1e-3;

/// Growth in a step of which is warned: that of a body on its head takes many steps.
const GROWTH: f64 = 0.3;

/// Waves that turn by more than about 135 degrees from site to site alternate; of two neighbours alone that move against one another this
/// is 1.5.
const ALTERNATING: f64 = 1.7;

/// Of fewer configurations nothing is said of waves.
const WAVES: usize = 4;

/// What small motions about the start, at rest, ask of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongestStep {
    /// 2/ω, with ω the frequency of the fastest small motion; infinite where there is none that swings.
    pub step: f64,
    /// The rate at which the fastest growing one grows, in the inverse unit of time; 0 where none does.
    pub growth: f64,
    /// How many configurations were disturbed, each at every site.
    pub configurations: usize,
    /// By how much neighbours move against one another in the motion that grows fastest: 0 where they move alike, 2 where they
    /// alternate; 0 where none grows.
    pub alternating: f64,
}

/// How much is done to find the longest step.
#[derive(Clone, Copy)]
pub struct Effort<'a> {
    /// Whether the inquiry is given up, which is asked before each of its steps.
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
    /// All that can be done.
    pub const UNBOUNDED: Self = Self {
        ended: &|| false,
        far: true,
    };
}

/// Why the longest step is not known, although the fastest motion may be.
#[derive(Clone, Copy, Debug)]
struct Missed {
    why: Unknown,
    /// The time in which the fastest motion swings or grows; NaN where it is not known.
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
    /// Of a model in these data, each field one vector, row-major; `h` is a step of about the size that is asked of.
    ///
    /// Where constraints are held small motions are those along them, resisted by their reactions at the start too; momenta
    /// are projected by the model itself ([`crate::card::Settings::inquiry`]).
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

    /// The same with an effort that may be bounded.
    ///
    /// # Errors
    /// As [`LongestStep::of`]; [`Unknown::Unfinished`] where the inquiry was given up.
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
        // Which step could be made in place of one that is refused is of no use here, and takes a hundred trials.
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
            // Shorter steps are asked for limits below this one alone.
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
            // Where a step is refused, longer ones are too.
            let longer = longer.take_while(|found| found.as_ref().map_or_else(is_still, |_| true));
            let mut longer = longer.flatten().filter(|found| found.step > h.abs());
            return longer.next().ok_or(Unknown::Still);
        }
        // Of a step that is hundreds of times too long even a small part is no short one.
        let shorter = SHORTER.into_iter().filter_map(|part| asked(part).ok());
        let mut shorter = shorter.filter(|found| found.step < h.abs());
        shorter
            .next()
            .map_or(found.map_err(|missed| missed.why), Ok)
    }

    /// The same, asked by steps that are short beside `h`.
    fn asked(probe: &Probe<'_>, h: f64) -> Result<Self, Missed> {
        let [least, largest] = probe.extremes()?;
        // What does not swing within a hundred thousand steps of this size is the rounding of forces that are none, as
        // what is rounding beside the other.
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
        // A step of the model must move what it is told of as steps of this kind do. Where constraints turn in a step that
        // resolves what grows, only the other is known.
        let resolving = match probe.is_held() {
            true => step.min(1.0 / growth),
            false => 1.0 / growth,
        };
        let growing = grows && probe.is_left(&least, resolving) == Some(true);
        let swung = match swings {
            true => probe.is_left(&largest, step).ok_or(missed(Unknown::Far))?,
            false => true,
        };
        // What grows hardly beside the fastest may be the turn of forces with the frames that they are seen from.
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

    /// ω of the fastest small motion, in radians by the unit of time; 0 where there is none that swings.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        2.0 / self.step
    }

    /// The longest step over which the fastest growing motion grows by a third; infinite where none does.
    #[must_use]
    pub fn resolving(&self) -> f64 {
        GROWTH / self.growth
    }

    /// Whether what grows fastest alternates between neighbours: the shorter a wave the faster it grows, as where a sign makes the
    /// equations elliptic along the label.
    #[must_use]
    pub fn is_elliptic(&self) -> bool {
        self.configurations >= WAVES && self.growth > 0.0 && self.alternating > ALTERNATING
    }

    /// What is wrong with steps of `h`, if anything: they are too long, or a motion grows as they go on.
    #[must_use]
    pub fn warning(&self, h: f64) -> Option<String> {
        let h = h.abs();
        if self.is_elliptic() {
            return Some(format!(
                "small motions about the start, at rest, grow, and fastest those that alternate between neighbours, with the \
                 rate {:.3e}: is there a sign wrong in the potential energy, or in a term that joins neighbours? Where the label \
                 is a coordinate the problem is elliptic then: the more sites the faster this grows, whatever the step",
                self.growth
            ));
        }
        if h > self.step {
            return Some(format!(
                "the step h = {h} is {:.2} times the longest one that keeps small motions about the start small, \
                 {:.3e} (2/ω of the fastest): what is disturbed there grows in every step; take a shorter one",
                h / self.step,
                self.step
            ));
        }
        if h > self.resolving() {
            let a_step = match (h * self.growth).exp() {
                few if few < 1e3 => format!("{few:.2}"),
                many if many.is_finite() => format!("{many:.1e}"),
                _ => format!("exp({:.3e})", h * self.growth),
            };
            let grow = format!(
                "small motions about the start, at rest, grow with the rate {:.3e}, by a factor of {a_step} a step",
                self.growth
            );
            // A body on its head and a rod that is pulled along its length are unstable by right; between neighbours
            // what grows so fast is mostly a wrong sign.
            return Some(match self.configurations {
                1 => format!(
                    "{grow}: where the motion is near it, steps of h = {h} do not resolve how the start is left; those \
                     up to {:.3e} do",
                    self.resolving()
                ),
                _ => format!(
                    "{grow}: is there a sign wrong in the potential energy, or in a term that joins neighbours? Where \
                     the start is so unstable, steps of h = {h} do not resolve how it is left; those up to {:.3e} do",
                    self.resolving()
                ),
            });
        }
        None
    }
}
