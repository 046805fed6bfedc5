//! A trajectory that makes by two, four, eight steps of a part of its length what cannot be made by one. Takes a card and the
//! data of a run; gives a trajectory, and how many of its steps were made so. Such a run is no longer symplectic.

use crate::card::{Card, OpenError, PartSeen, Settings, Trajectory};
use crate::kinetic::KineticWarning;
use crate::saved::{Saved, Words};
use crate::{StartError, StepCause, StepError};

/// Most halvings of one step.
const DEEPEST: u32 = 16;

/// Steps that were made by parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Halvings {
    /// How many steps.
    pub steps: u64,
    /// The most parts that one of them took.
    pub parts: u64,
}

/// A trajectory whose refused steps are made by parts.
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
    /// The most steps that one step is tried by.
    pub const MOST_PARTS: u64 = 1 << DEEPEST;

    /// Starts a trajectory as [`Card::open`] does; where its first step is refused with a step of a part of the length.
    ///
    /// # Errors
    /// As [`Card::open`]; also where an initial value is none of the observables, from which a run goes on by parts.
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
                // The step that was asked for is the one to be told of.
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

    /// The trajectory one whole step further, by steps halved so often; or why not.
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

/// Why a first step is refused.
fn cause(error: &OpenError) -> Option<StepCause> {
    match error {
        OpenError::Start(StartError::Refused(refused)) | OpenError::Kinetic { refused, .. } => {
            Some(*refused)
        }
        _ => None,
    }
}

/// Where among the observables the numbers of a field begin.
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
        // After parts the whole step is tried first.
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
