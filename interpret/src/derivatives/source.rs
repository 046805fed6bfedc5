//! The interface between derivatives and a model: its functions over the recording scalar, its start, and its steps.

use super::coordinates::LocalForm;
use crate::code::Places;
use crate::recorded::Traced;
use crate::value::Value;
use clebsch::StepError;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{NoDerivative, Point};
use clebsch::integrate::Way;

/// The functions of a model over the recording scalar. The model, the state, the workspace and the step size are in their places.
/// A function returns nothing if it cannot be recorded.
pub trait TracedFunctions: Send + Sync {
    /// Empty places.
    fn places(&self) -> Places<Traced>;

    /// The model, from the value of its parameters.
    fn model(
        &self,
        parameters: Value<Traced>,
        places: &mut Places<Traced>,
    ) -> Option<Value<Traced>>;

    /// The state that initial values begin.
    fn begin(&self, given: Value<Traced>, places: &mut Places<Traced>) -> Option<Value<Traced>>;

    /// Prepares the workspace of the state.
    fn prepare(&self, choice: &Value<f64>, places: &mut Places<Traced>) -> Option<()>;

    /// Takes a step.
    fn step(&self, places: &mut Places<Traced>) -> Option<()>;

    /// The observables, in the order of the card.
    fn observe(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>>;

    /// The invariants, in the order of the card.
    fn invariants(&self, places: &mut Places<Traced>) -> Option<Vec<Traced>>;
}

/// A model before its first step.
#[derive(Clone)]
pub struct Begun {
    pub model: Value<f64>,
    pub state: Value<f64>,
    /// The parameters, and the initial values, as the functions of the model take them.
    pub parameters: Value<f64>,
    pub initial: Value<f64>,
}

/// A step of one size, with its workspace.
pub trait Stepping: Send {
    /// Moves a state by one step. Returns the solutions of the equations of the step, if tapes took it.
    ///
    /// # Errors
    /// [`StepError`] if the step fails.
    fn advance(&mut self, state: &mut Point) -> Result<Option<Vec<f64>>, StepError>;
}

/// How the initial values are moved by local coordinates.
#[derive(Clone)]
pub struct Coordinates {
    /// How each field is moved.
    pub forms: Vec<LocalForm>,
    /// The number of coordinates of each initial value of the card.
    pub dimensions: Vec<usize>,
    /// For each coordinate in the order of the card, its place in the order of the fields.
    pub order: Vec<usize>,
}

/// A model that can be differentiated.
pub trait Source: Sync {
    /// Its card.
    fn card(&'static self) -> &'static Card;

    /// Its functions over the recording scalar.
    fn functions(&'static self) -> &'static dyn TracedFunctions;

    /// Starts from the data of a trajectory.
    ///
    /// # Errors
    /// As opening a trajectory.
    fn begin(
        &'static self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        settings: Settings,
    ) -> Result<Begun, NoDerivative>;

    /// The value of parameters, from one list for each field of the card. Nothing is checked.
    fn parameter_value(&self, lists: &[Vec<f64>]) -> Option<Value<f64>>;

    /// The initial values, from one list for each field of the card, given the lists of the parameters.
    ///
    /// # Errors
    /// [`NoDerivative::Open`] if a value is not valid.
    fn initial_value(
        &self,
        parameters: &[Vec<f64>],
        lists: &[Vec<f64>],
    ) -> Result<Value<f64>, NoDerivative>;

    /// How initial values are moved.
    fn coordinates(&self, initial: &Value<f64>) -> Result<Coordinates, NoDerivative>;

    /// The state that initial values begin.
    ///
    /// # Errors
    /// [`NoDerivative::Open`] if the values are not valid.
    fn state(
        &self,
        model: &Value<f64>,
        given: Value<f64>,
        h: f64,
    ) -> Result<Value<f64>, NoDerivative>;

    /// Sets the node of a state.
    fn set_node(&self, state: &mut Value<f64>, node: u64);

    /// The choice that workspaces are prepared with.
    fn choice(&self, way: Way) -> Value<f64>;

    /// Steps of one size from a state.
    ///
    /// # Errors
    /// [`NoDerivative::Open`] if the first step fails.
    fn stepping(
        &'static self,
        begun: &Begun,
        state: &Point,
        h: f64,
        choice: &Value<f64>,
    ) -> Result<Box<dyn Stepping>, NoDerivative>;
}
