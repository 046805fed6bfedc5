//! A trajectory that retries a failed step as 2, 4, 8, ... substeps. Takes a card and the data of a run; gives a
//! trajectory, and the number of steps that were subdivided. A run with substeps is not symplectic.

use crate::card::{Card, OpenError, PartSeen, Settings, Trajectory};
use crate::kinetic::KineticWarning;
use crate::saved::{Saved, Words};
use crate::{StartError, StepCause, StepError};

/// The maximum number of halvings of one step.
const DEEPEST: u32 = 16;

/// The steps that were subdivided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Halvings {
    /// The number of subdivided steps.
    pub steps: u64,
    /// The largest number of substeps of one step.
    pub parts: u64,
}

/// A trajectory that retries failed steps as substeps.
pub struct Halved {
    card: Card,
    parameters: Vec<Vec<f64>>,
    initial: Vec<Vec<f64>>,
    settings: Settings,
    inner: Box<dyn Trajectory>,
    /// How often the step of `inner` is halved.
    depth: u32,
    node: u64,
    made: Halvings,
}

impl Halved {
    /// The maximum number of substeps of one step.
    pub const MOST_PARTS: u64 = 1 << DEEPEST;

    /// Starts a trajectory as [`Card::open`] does. If the first step fails, it starts with substeps.
    ///
    /// # Errors
    /// As [`Card::open`]; also if an initial value is not among the observables, since substeps start from these.
    pub fn open(
        card: &Card,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Halved, OpenError> {
        let unseen = card.initial.iter().find(|f| place(card, f.ascii).is_none());
        if let Some(field) = unseen {
            return Err(OpenError::Unseen { field: field.name });
        }
        let opened =
            (0..=DEEPEST).map(|depth| (depth, opened(card, parameters, initial, settings, depth)));
        let mut refused = None;
        for (depth, trajectory) in opened {
            match trajectory {
                Ok(inner) => {
                    return Ok(Halved {
                        card: *card,
                        parameters: parameters.to_vec(),
                        initial: initial.to_vec(),
                        settings,
                        inner,
                        depth,
                        node: 0,
                        made: Halvings::default(),
                    });
                }
                Err(error) if cause(&error).is_none() => return Err(error),
                // The error reports the full step, not a substep.
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        Err(refused.unwrap_or(OpenError::Start(StartError::Refused(
            StepCause::NotFinite { what: "step" },
        ))))
    }

    /// The state as initial values.
    fn here(&self) -> Vec<Vec<f64>> {
        let mut seen = vec![0.0; self.card.observable_count()];
        self.inner.observe(&mut seen);
        let values = self.card.initial.iter().map(|field| {
            let from = place(&self.card, field.ascii).unwrap_or(0);
            seen.get(from..from + field.count())
                .unwrap_or_default()
                .to_vec()
        });
        values.collect()
    }

    /// The trajectory after one whole step in `2^depth` substeps, or the cause of the failure.
    fn by_parts(&self, from: &[Vec<f64>], depth: u32) -> Result<Box<dyn Trajectory>, StepCause> {
        let started = opened(&self.card, &self.parameters, from, self.settings, depth);
        let mut inner = started
            .map_err(|error| cause(&error).unwrap_or(StepCause::NotFinite { what: "state" }))?;
        for _ in 0..1u64 << depth {
            inner.step().map_err(|error| error.cause)?;
        }
        Ok(inner)
    }
}

fn opened(
    card: &Card,
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
    depth: u32,
) -> Result<Box<dyn Trajectory>, OpenError> {
    let h = settings.h / f64::from(1u32 << depth);
    (card.open)(parameters, initial, Settings { h, ..settings })
}

/// Why a first step fails; `None` for other errors.
fn cause(error: &OpenError) -> Option<StepCause> {
    match error {
        OpenError::Start(StartError::Refused(refused)) | OpenError::Kinetic { refused, .. } => {
            Some(*refused)
        }
        _ => None,
    }
}

/// The index of the first number of a field among the observables.
fn place(card: &Card, ascii: &str) -> Option<usize> {
    let wanted = card.initial.iter().find(|f| f.ascii == ascii)?;
    let mut from = 0;
    for field in card.observables {
        if field.ascii == ascii && (field.rows, field.cols) == (wanted.rows, wanted.cols) {
            return Some(from);
        }
        from += field.count();
    }
    None
}

impl Trajectory for Halved {
    fn node(&self) -> u64 {
        self.node
    }

    #[allow(clippy::cast_precision_loss)]
    fn time(&self) -> f64 {
        self.settings.h * self.node as f64
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.step_in_parts(&mut |_, _, _| {})
    }

    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let mut refused = None;
        if self.depth == 0 {
            match self.inner.step_in_parts(seen) {
                Ok(()) => {
                    self.node += 1;
                    return Ok(());
                }
                Err(error) => refused = Some(error.cause),
            }
        }
        let from = self.here();
        // After a subdivided step, the next step is tried undivided first.
        let least = u32::from(self.depth == 0);
        for depth in least..=DEEPEST {
            match self.by_parts(&from, depth) {
                Ok(inner) => {
                    (self.inner, self.depth) = (inner, depth);
                    self.node += 1;
                    if depth > 0 {
                        self.made.steps += 1;
                        self.made.parts = self.made.parts.max(1 << depth);
                    }
                    return Ok(());
                }
                Err(cause) => refused = refused.or(Some(cause)),
            }
        }
        let cause = refused.unwrap_or(StepCause::NotFinite { what: "step" });
        Err(cause.at_node(self.node))
    }

    fn card(&self) -> &'static Card {
        self.inner.card()
    }

    fn kinetic_warning(&self) -> Option<KineticWarning> {
        self.inner.kinetic_warning()
    }

    fn observe(&self, out: &mut [f64]) {
        self.inner.observe(out);
    }

    fn invariants(&self, out: &mut [f64]) {
        self.inner.invariants(out);
    }

    fn scales(&self, out: &mut [f64]) {
        self.inner.scales(out);
    }

    fn halvings(&self) -> Option<Halvings> {
        Some(self.made)
    }

    fn words(&mut self, words: &mut Words) {
        let mut depth = self.depth;
        depth.words(words);
        if depth != self.depth {
            match opened(
                &self.card,
                &self.parameters,
                &self.initial,
                self.settings,
                depth.min(DEEPEST),
            ) {
                Ok(inner) => (self.inner, self.depth) = (inner, depth),
                Err(_) => words.refuse(),
            }
        }
        self.inner.words(words);
        self.node.words(words);
        self.made.steps.words(words);
        self.made.parts.words(words);
    }
}
