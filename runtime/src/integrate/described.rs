//! One trajectory of any model, with its type hidden: starts from lists of numbers in the order of a card.
//! Takes the [`Described`] implementation of an emitted model; gives a trajectory for the command line and the tests.

use super::{Model, Steps, counted};
use crate::StepError;
use crate::card::{Card, OpenError, PartSeen, Settings, Trajectory};
use crate::kinetic::KineticWarning;
use crate::saved::{Saved, Words};

/// A model over plain numbers as its [`Card`] describes it. Slices of numbers are row-major, fields in
/// the order of the card.
pub trait Described: Model<Scalar = f64, State: Saved, Workspace: Saved> + Sized + 'static {
    /// The description.
    fn card() -> &'static Card;

    /// The model and its initial data from the fields of the card, which gives their number.
    ///
    /// # Errors
    /// Names the field that is not admissible, or has too few or too many numbers.
    fn read(
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
    ) -> Result<(Self, Self::Initial), OpenError>;

    /// The model with the requested solver, and its steps of the requested order.
    ///
    /// # Errors
    /// For an order or a solver that is not offered, and a first step that cannot be made.
    fn ways(
        self,
        state: &Self::State,
        settings: Settings,
    ) -> Result<(Self, Steps<Self>), OpenError>;

    /// A warning if the kinetic energy is not positive definite at a state.
    fn judged(&self, _state: &Self::State) -> Option<KineticWarning> {
        None
    }

    /// All observables.
    fn observe(&self, state: &Self::State, out: &mut [f64]);

    /// All invariants of steps of `h`; `work` is the workspace of plain steps.
    fn invariants(
        &self,
        state: &Self::State,
        h: f64,
        work: Option<&Self::Workspace>,
        out: &mut [f64],
    );

    /// Their sizes at `state`, in steps of `h`, see [`Trajectory::scales`].
    fn scales(&self, state: &Self::State, h: f64, out: &mut [f64]);
}

/// One trajectory of a model.
struct Running<M: Described> {
    model: M,
    state: M::State,
    steps: Steps<M>,
    h: f64,
    kinetic: Option<KineticWarning>,
}

/// Starts a trajectory: [`Card::open`] of the model `M`.
///
/// # Errors
/// [`OpenError`] for a wrong number of values, bad parameters, an order that is not offered, or a
/// refused start.
pub fn open<M: Described>(
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
) -> Result<Box<dyn Trajectory>, OpenError> {
    let card = M::card();
    counted(card, parameters, initial)?;
    let (model, initial) = M::read(parameters, initial)?;
    let state = model.begin(initial)?;
    // Judged before the first step is tried: it may be why that is refused.
    let kinetic = model.judged(&state);
    let (model, steps) = model
        .ways(&state, settings)
        .map_err(|e| e.beside(kinetic))?;
    Ok(Box::new(Running {
        model,
        state,
        steps,
        h: settings.h,
        kinetic,
    }))
}

/// [`Card::sized`] of a model `M` without named sizes.
pub fn only_size<M: Described>(sizes: &[usize]) -> Option<Card> {
    sizes.is_empty().then(|| *M::card())
}

impl<M: Described> Trajectory for Running<M> {
    fn node(&self) -> u64 {
        M::node(&self.state)
    }

    fn time(&self) -> f64 {
        self.h * self.node() as f64
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.steps.step(&self.model, &mut self.state)
    }

    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let Self { model, state, .. } = self;
        let none = vec![0.0; M::card().observable_count()];
        let [mut before, mut after] = [none.clone(), none];
        model.observe(state, &mut before);
        self.steps.step_in_parts(model, state, |share, state| {
            model.observe(state, &mut after);
            seen(share, &before, &after);
            core::mem::swap(&mut before, &mut after);
        })
    }

    fn card(&self) -> &'static Card {
        M::card()
    }

    fn kinetic_warning(&self) -> Option<KineticWarning> {
        self.kinetic
    }

    fn observe(&self, out: &mut [f64]) {
        self.model.observe(&self.state, out);
    }

    fn invariants(&self, out: &mut [f64]) {
        self.model
            .invariants(&self.state, self.h, self.steps.workspace(), out);
    }

    fn scales(&self, out: &mut [f64]) {
        self.model.scales(&self.state, self.h, out);
    }

    fn words(&mut self, words: &mut Words) {
        self.state.words(words);
        self.steps.words(words);
    }
}
