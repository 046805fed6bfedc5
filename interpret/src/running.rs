//! Trajectories of models from files: the same calls in the same order as in emitted code.

use crate::code::{Exit, Places, Routine};
use crate::composed::Model;
use crate::failure::Failure;
use crate::listing;
use crate::opened::{InitialForm, Opened, at};
use crate::packed::Packed;
use crate::recorded::{Recordable, Recorded, Watched};
use crate::value::{Frame, Layout, MatrixGroup, Struct, Value};
use clebsch::card::{Card, Field, OpenError, PartSeen, Settings, Trajectory, chosen_solver};
use clebsch::integrate::{Composition, Offer, Way, counted};
use clebsch::kinetic::KineticWarning;
use clebsch::of_numbers::OfNumbers;
use clebsch::saved::{Saved, Words};
use clebsch::{ParameterError, StartError, StepError, validate};
use std::cell::RefCell;
use std::sync::Arc;

/// Runs a function; a missing value is an error of the step.
pub fn run(routine: &Routine<f64>, places: &mut Places<f64>) -> Result<Value<f64>, Failure> {
    let value = match routine.body.run(places) {
        Ok(value) => value,
        Err(Exit::Return(value)) => *value,
        Err(Exit::Unfit(what)) => Value::failed(clebsch::StepCause::Unread { what }),
    };
    match value {
        Value::Failed(e) => Err(*e),
        value => Ok(value),
    }
}

/// Puts a value into a place.
pub fn put(places: &mut Places<f64>, at: usize, value: Value<f64>) {
    if let Some(place) = places.get_mut(at) {
        *place = value;
    }
}

/// Takes a value out of its place.
pub fn take(places: &mut Places<f64>, at: usize) -> Value<f64> {
    places
        .get_mut(at)
        .map_or(Value::Unit, |p| std::mem::replace(p, Value::Unit))
}

/// A trajectory before its first step.
pub struct Begun {
    /// The places, with the model, the state and the step size.
    pub places: Places<f64>,
    /// The parameters.
    pub parameters: Value<f64>,
    /// The initial values.
    pub initial: Value<f64>,
    /// The warning about the kinetic energy, which may explain why a step fails.
    pub kinetic: Option<KineticWarning>,
}

impl Opened {
    /// Starts a trajectory.
    ///
    /// # Errors
    /// As the function of any card.
    pub fn open(
        &'static self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Box<dyn Trajectory>, OpenError> {
        let card = &self.card;
        let Begun {
            mut places,
            kinetic,
            ..
        } = self.begin(parameters, initial, settings)?;
        let steps = self
            .ways(card, &mut places, settings)
            .map_err(|e| e.beside(kinetic))?;
        let own_step = !matches!(steps, Steps::Composed(_));
        let recorded = Recorded::new(self.recordable(), own_step);
        Ok(Box::new(Running {
            opened: self,
            card,
            held: RefCell::new(TrajectoryStorage { places, recorded }),
            steps,
            h: settings.h,
            kinetic,
        }))
    }

    /// Builds the model and its initial state.
    ///
    /// # Errors
    /// As [`Opened::open`].
    pub fn begin(
        &self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Begun, OpenError> {
        let (card, f) = (&self.card, &self.functions);
        counted(card, parameters, initial)?;
        let mut places = self.places(Value::Unit);
        let own = collected(&self.parameters, card.parameters, parameters)?;
        put(&mut places, at::GIVEN, own.clone());
        let model = run(&f.new, &mut places).map_err(Failure::open)?;
        put(&mut places, at::MODEL, model);
        let mut initial = initial.to_vec();
        for signs in &self.signs {
            let made = signs.make(parameters, &mut initial);
            made.map_err(|e| OpenError::Start(StartError::Initial(e)))?;
        }
        let given = self.initial_values(&initial)?;
        put(&mut places, at::GIVEN, given.clone());
        let projecting = f.projecting.as_ref().filter(|_| settings.inquiry);
        let begin = projecting.unwrap_or(&f.begin);
        let state = run(begin, &mut places).map_err(Failure::start)?;
        put(&mut places, at::STATE, state.clone());
        // Check the kinetic energy before the first step, since it may explain why the step fails.
        let kinetic = match &f.kinetic {
            Some(kinetic) => match run(kinetic, &mut places).map_err(Failure::open)? {
                Value::Warning(warning) => Some(warning),
                _ => None,
            },
            None => None,
        };
        put(&mut places, at::STATE, state);
        put(&mut places, at::STEP, Value::Real(settings.h));
        if let Some(method) = chosen_solver(settings, card.solvers)?
            && let Some(with_solver) = &f.with_solver
        {
            put(&mut places, at::GIVEN, Value::Method(method));
            let model = run(with_solver, &mut places).map_err(Failure::open)?;
            put(&mut places, at::MODEL, model);
        }
        Ok(Begun {
            places,
            parameters: own,
            initial: given,
            kinetic,
        })
    }

    /// The initial values from lists of numbers, one for each field.
    pub fn initial_values(&self, initial: &[Vec<f64>]) -> Result<Value<f64>, OpenError> {
        collected(&self.initial, self.card.initial, initial)
    }

    /// The functions that are recorded as tapes.
    pub fn recordable(&'static self) -> &'static Recordable {
        let recordable = || Recordable::of(&self.functions, self.places);
        self.recordable.get_or_init(recordable)
    }

    /// Selects how steps are taken, from these settings.
    fn ways(
        &'static self,
        card: &'static Card,
        places: &mut Places<f64>,
        settings: Settings,
    ) -> Result<Steps, OpenError> {
        let f = &self.functions;
        let way = Way::of(Offer::of(card), settings, card.orders)?;
        let order = match way {
            Way::Composed(order) => order,
            Way::Plain | Way::Modified(..) => {
                let choice = match card.preprocessed {
                    true => Value::Order(way.moments()),
                    false => self.usual(),
                };
                self.prepare(places, settings, choice)?;
                if let (Way::Modified(_, true), Some(compensated)) = (way, &f.compensated) {
                    let work = run(compensated, places).map_err(Failure::open)?;
                    put(places, at::WORK, work);
                }
                return Ok(match way {
                    Way::Modified(..) => Steps::Modified,
                    _ => Steps::Plain,
                });
            }
        };
        let of = |at: usize| places.get(at).cloned().unwrap_or(Value::Unit);
        let model = Model {
            opened: self,
            model: of(at::MODEL),
            state: of(at::STATE),
        };
        let Some(state) = Packed::of(&model.state) else {
            return Err(OpenError::Order {
                asked: order.number(),
                offered: card.orders.get(..1).unwrap_or_default(),
            });
        };
        let composition = Composition::start(&model, &state, settings.h, order)?;
        put(places, at::WORK, Value::None);
        Ok(Steps::Composed(Box::new((model, composition))))
    }

    /// The default choice of a solver.
    pub fn usual(&self) -> Value<f64> {
        match self.functions.with_solver {
            Some(_) => Value::None,
            None => Value::Unit,
        }
    }

    /// Prepares the workspace of the state; the first step is tried on a copy, except in a probe of single steps.
    pub fn prepare(
        &self,
        places: &mut Places<f64>,
        settings: Settings,
        choice: Value<f64>,
    ) -> Result<(), StartError> {
        validate::directed_step(settings.h)?;
        put(places, at::GIVEN, choice);
        let state = places.get(at::STATE).cloned().unwrap_or(Value::Unit);
        let mut work = run(&self.functions.prepared, places).map_err(Failure::start)?;
        if settings.inquiry {
            only_try(&mut work);
            put(places, at::STATE, state);
            put(places, at::WORK, work);
            return Ok(());
        }
        put(places, at::STATE, state.clone());
        put(places, at::WORK, work.clone());
        run(&self.functions.step, places).map_err(|e| StartError::Refused(e.cause()))?;
        put(places, at::STATE, state);
        put(places, at::WORK, work);
        Ok(())
    }
}

/// The searches of a workspace follow roots from rest without a proof.
fn only_try(work: &mut Value<f64>) {
    match work {
        Value::Search(held) => held.only_try(),
        Value::Struct(all) => all.values.iter_mut().for_each(only_try),
        Value::List(all) => all.iter_mut().for_each(only_try),
        _ => {}
    }
}

/// The values of a struct from lists of numbers.
pub fn collected(
    (layout, reads): &(Arc<Layout>, Vec<InitialForm>),
    fields: &'static [Field],
    lists: &[Vec<f64>],
) -> Result<Value<f64>, OpenError> {
    let mut values = Vec::new();
    for ((read, field), list) in reads.iter().zip(fields).zip(lists) {
        values.push(one(*read, field, list)?);
    }
    values.resize(layout.fields.len(), Value::Unit);
    Ok(Value::Struct(Struct {
        layout: layout.clone(),
        values,
    }))
}

/// The value of a field, in the form that its type needs.
fn one(read: InitialForm, field: &'static Field, list: &[f64]) -> Result<Value<f64>, OpenError> {
    use clebsch::groups::{invertible_map, nearest_rotation};
    use clebsch::linalg::Dense;
    let (name, rows, cols) = (field.name, field.rows, field.cols);
    let matrix = || {
        if list.len() != rows * cols {
            return Err(OpenError::Count {
                field: name,
                expected: rows * cols,
                found: list.len(),
            });
        }
        let entry = |i: usize, j: usize| list.get(i * cols + j).copied().unwrap_or(f64::NAN);
        Ok(Dense::from_fn(rows, cols, entry))
    };
    let initial = |e: ParameterError| OpenError::Start(StartError::Initial(e));
    let wide = || OpenError::Count {
        field: name,
        expected: 64,
        found: list.len(),
    };
    let momentum = |frame| -> Result<Value<f64>, OpenError> {
        Value::momentum(frame, &Value::of(matrix()?)).ok_or_else(wide)
    };
    Ok(match read {
        InitialForm::Number => Value::Real(f64::of_numbers(name, list)?),
        InitialForm::Matrix => Value::of(matrix()?),
        InitialForm::Of(kind) => match kind {
            "Rotation" => Value::Rotation(OfNumbers::of_numbers(name, list)?),
            "UnitQuaternion" => Value::Quaternion(OfNumbers::of_numbers(name, list)?),
            "RigidMotion" => Value::Motion(Box::new(OfNumbers::of_numbers(name, list)?)),
            "PlaneMotion" => Value::Plane(Box::new(OfNumbers::of_numbers(name, list)?)),
            "Orthogonal" => {
                let nearest = nearest_rotation(&matrix()?);
                let nearest = nearest.map_err(|e| initial(e.in_field(name)))?;
                Value::Element(MatrixGroup::Orthogonal, nearest)
            }
            "Linear" => {
                let given = matrix()?;
                invertible_map(&given).map_err(|e| initial(e.in_field(name)))?;
                Value::Element(MatrixGroup::Linear, given)
            }
            "Additive" => Value::Element(MatrixGroup::Field, matrix()?),
            "BodyMomentum" | "BodyMomentumMatrix" | "BodyImpulse" | "BodyPlaneImpulse" => {
                momentum(Frame::Body)?
            }
            "FieldMomentum" => momentum(Frame::Field)?,
            _ => momentum(Frame::Spatial)?,
        },
    })
}

/// The method that takes steps.
enum Steps {
    /// The model's own step.
    Plain,
    /// The model's own step, with modified moments.
    Modified,
    /// A composition of the model's own steps.
    Composed(Box<(Model, Composition<Model>)>),
}

/// State and workspace, as values at places and as the numbers of tapes.
struct TrajectoryStorage {
    places: Places<f64>,
    recorded: Recorded,
}

impl TrajectoryStorage {
    /// The places, updated from the tapes.
    fn places(&mut self) -> &mut Places<f64> {
        self.recorded.write(&mut self.places);
        &mut self.places
    }

    /// The tapes continue from the values in the places.
    fn follow(&mut self) {
        self.recorded.follow();
    }

    /// The numbers of the state.
    fn packed(&mut self) -> Option<Packed> {
        let newer = self.recorded.packed();
        newer.or_else(|| self.places.get(at::STATE).and_then(Packed::of))
    }

    /// Sets the numbers of a state.
    fn put(&mut self, state: &Packed) {
        if self.recorded.put(state, &self.places) {
            return;
        }
        if let Some(here) = self.places.get_mut(at::STATE) {
            state.put(here);
        }
        self.follow();
    }

    /// Runs an observer of the state; its numbers are written to `out`.
    fn watch(&mut self, opened: &Opened, which: Watched, out: &mut [f64]) {
        if self.recorded.watch(which, &mut self.places, out) {
            return;
        }
        let f = &opened.functions;
        let routine = match which {
            Watched::Observables => &f.observe,
            Watched::Invariants => &f.invariants,
            Watched::Scales => &f.scales,
        };
        watch(self.places(), routine, out);
    }
}

/// A running trajectory.
struct Running {
    opened: &'static Opened,
    card: &'static Card,
    held: RefCell<TrajectoryStorage>,
    steps: Steps,
    h: f64,
    kinetic: Option<KineticWarning>,
}

impl Opened {
    fn node_of(&self, state: Option<&Value<f64>>) -> u64 {
        match state {
            Some(Value::Struct(s)) => match s.field(self.node) {
                Some(Value::Int(n)) => u64::try_from(*n).unwrap_or(0),
                _ => 0,
            },
            _ => 0,
        }
    }
}

impl Running {
    /// One step. After each of the model's own steps, calls `seen` with this step as a fraction of the whole step,
    /// and with the state.
    fn made(&mut self, seen: &mut dyn FnMut(f64, &mut TrajectoryStorage)) -> Result<(), StepError> {
        let held = self.held.get_mut();
        match &mut self.steps {
            Steps::Plain | Steps::Modified => {
                let TrajectoryStorage { places, recorded } = held;
                if !recorded.step(places) {
                    let places = held.places();
                    let node = self.opened.node_of(places.get(at::STATE));
                    let made = run(&self.opened.functions.step, places);
                    held.follow();
                    made.map_err(|e| e.step(node))?;
                }
                if let Steps::Plain = self.steps {
                    seen(1.0, held);
                }
            }
            Steps::Composed(both) => {
                let (model, composition) = &mut **both;
                let Some(mut packed) = held.packed() else {
                    return Ok(());
                };
                let made = composition.step_in_parts(model, &mut packed, |share, here| {
                    held.put(here);
                    seen(share, held);
                });
                // If the step fails, `packed` is the state before it.
                held.put(&packed);
                made?;
            }
        }
        Ok(())
    }
}

/// Runs an observer on the current state and writes its numbers to `out`.
fn watch(places: &mut Places<f64>, routine: &Routine<f64>, out: &mut [f64]) {
    let mut list = match take(places, at::OUT) {
        Value::List(list) => list,
        _ => Vec::with_capacity(out.len()),
    };
    list.clear();
    put(places, at::OUT, Value::List(list));
    let done = run(routine, places).is_ok();
    let Some(Value::List(list)) = places.get(at::OUT) else {
        return;
    };
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = match list.get(i) {
            Some(Value::Real(x)) if done => *x,
            _ => f64::NAN,
        };
    }
}

impl Trajectory for Running {
    fn node(&self) -> u64 {
        let held = self.held.borrow();
        let ahead = held.recorded.node();
        ahead.unwrap_or_else(|| self.opened.node_of(held.places.get(at::STATE)))
    }

    fn time(&self) -> f64 {
        self.h * self.node() as f64
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.made(&mut |_, _| {})
    }

    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let none = vec![0.0; self.card.observable_count()];
        let [mut before, mut after] = [none.clone(), none];
        let opened = self.opened;
        self.observe(&mut before);
        self.made(&mut |share, held| {
            held.watch(opened, Watched::Observables, &mut after);
            seen(share, &before, &after);
            std::mem::swap(&mut before, &mut after);
        })
    }

    fn card(&self) -> &'static Card {
        self.card
    }

    fn kinetic_warning(&self) -> Option<KineticWarning> {
        self.kinetic
    }

    fn observe(&self, out: &mut [f64]) {
        let mut held = self.held.borrow_mut();
        held.watch(self.opened, Watched::Observables, out);
    }

    fn invariants(&self, out: &mut [f64]) {
        let mut held = self.held.borrow_mut();
        held.watch(self.opened, Watched::Invariants, out);
    }

    fn scales(&self, out: &mut [f64]) {
        let mut held = self.held.borrow_mut();
        held.watch(self.opened, Watched::Scales, out);
    }

    fn operations(&self) -> Option<String> {
        let held = self.held.borrow();
        let sections = held.recorded.sections(&held.places, &self.opened.names);
        listing::text(&sections)
    }

    fn words(&mut self, words: &mut Words) {
        let held = self.held.get_mut();
        for at in [at::STATE, at::WORK] {
            match held.places().get_mut(at) {
                Some(value) => value.words(words),
                None => words.refuse(),
            }
        }
        held.follow();
        if let Steps::Composed(both) = &mut self.steps {
            both.1.workspaces_mut().for_each(|part| part.words(words));
        }
    }
}
