//! Exact derivatives of steps, of observed quantities and of whole runs, for a model whose Rust type is hidden.
//!
//! States have local coordinates: a rotation or a rigid motion `g` is moved to `g retract(xi)` (coordinates in the body
//! frame), and every other initial value is moved entry by entry. They are the coordinates of [`Card::initial`](crate::card::Card),
//! in its order, so a state of a heavy top has three coordinates of its attitude and three of its body momentum.

use crate::card::{Card, OpenError};
use crate::{StartError, StepError};
use core::fmt;

/// A state of a model at a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The numbers of the state, in the model's own form. Only the model that made them reads them.
    pub numbers: Vec<f64>,
    /// The node.
    pub node: u64,
}

/// A matrix of derivatives, column after column.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    /// The number of rows.
    pub rows: usize,
    /// The number of columns.
    pub cols: usize,
    /// The entries, column after column.
    pub entries: Vec<f64>,
}

/// The gradient of a cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// With respect to each entry of each parameter, row-major. Entries that must be equal (of a symmetric matrix) or
    /// opposite (of a skew matrix) share their derivative evenly.
    pub parameters: Vec<Vec<f64>>,
    /// With respect to the local coordinates of each initial value.
    pub initial: Vec<Vec<f64>>,
    /// With respect to the step size, for a fixed number of steps.
    pub step: f64,
}

/// A cost: a sum over nodes of functions of the observables and the invariants there.
pub trait Cost {
    /// Whether the cost depends on this node.
    fn is_at(&self, node: u64) -> bool;

    /// Adds to `weights` the derivative of the cost with respect to each observable at a node, and to `of_invariants` the
    /// derivative with respect to each component of the invariants. Called once for each node, the last node first.
    fn weigh(&mut self, node: u64, seen: &Seen<'_>, weights: &mut [f64], of_invariants: &mut [f64]);
}

/// The observables and invariants at a node.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The observables, in the order of [`Trajectory::observe`](crate::card::Trajectory::observe).
    pub observables: &'a [f64],
    /// The invariants, in the order of [`Trajectory::invariants`](crate::card::Trajectory::invariants).
    pub invariants: &'a [f64],
}

/// Why a derivative does not exist, or is not found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoDerivative {
    /// The trajectory cannot start.
    Open(OpenError),
    /// A step of the run fails.
    Step(StepError),
    /// A function of the model cannot be recorded with its derivatives.
    Unrecorded {
        /// The quantity that the function computes.
        what: &'static str,
    },
    /// A chain whose group elements the program stores in coordinates.
    InCoordinates,
    /// An initial value is not among the observables, so states do not have local coordinates.
    Unseen {
        /// The initial value.
        field: &'static str,
    },
    /// The state has too many numbers.
    TooLarge {
        /// The number of its numbers.
        numbers: usize,
        /// The largest number.
        most: usize,
    },
}

impl fmt::Display for NoDerivative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open(e) => write!(f, "{e}"),
            Self::Step(e) => write!(f, "{e}"),
            Self::Unrecorded { what } => write!(
                f,
                "clebsch cannot differentiate {what} of this model; a function given as Rust code, or a state on the \
                 boundary of its domain, is the usual reason"
            ),
            Self::Unseen { field } => write!(
                f,
                "the observables do not give the initial value `{field}`, so the states of this model do not have \
                 coordinates; only gradients exist"
            ),
            Self::TooLarge { numbers, most } => write!(
                f,
                "a state has {numbers} numbers, and clebsch differentiates states of at most {most}; use fewer sites"
            ),
            Self::InCoordinates => write!(
                f,
                "clebsch stores the group elements of this chain in coordinates, and does not differentiate such chains yet; \
                 use fewer sites, or rotations and positions in place of rigid motions"
            ),
        }
    }
}

impl std::error::Error for NoDerivative {}

impl From<StepError> for NoDerivative {
    fn from(e: StepError) -> Self {
        Self::Step(e)
    }
}

impl From<OpenError> for NoDerivative {
    fn from(e: OpenError) -> Self {
        Self::Open(e)
    }
}

impl From<StartError> for NoDerivative {
    fn from(e: StartError) -> Self {
        Self::Open(OpenError::Start(e))
    }
}

/// A trajectory with its derivatives.
pub trait Derivatives: Send {
    /// The description of the model.
    fn card(&self) -> &'static Card;

    /// The step size.
    fn h(&self) -> f64;

    /// The same model with steps of another size, which may be negative.
    ///
    /// # Errors
    /// [`NoDerivative::Open`] if the step size is not a finite number other than zero.
    fn with_step(&self, h: f64) -> Result<Box<dyn Derivatives>, NoDerivative>;

    /// The initial state.
    fn start(&self) -> Point;

    /// The number of local coordinates of each initial value; their sum is the number of local coordinates of a state.
    fn dimensions(&self) -> Vec<usize>;

    /// The observables of a state.
    ///
    /// # Errors
    /// [`NoDerivative::Unrecorded`].
    fn observe(&mut self, at: &Point) -> Result<Vec<f64>, NoDerivative>;

    /// The invariants of a state.
    ///
    /// # Errors
    /// [`NoDerivative::Unrecorded`].
    fn invariants(&mut self, at: &Point) -> Result<Vec<f64>, NoDerivative>;

    /// The state moved by local coordinates.
    ///
    /// # Errors
    /// [`NoDerivative::Open`] if the moved state is not a state of the model.
    fn moved(&mut self, at: &Point, by: &[f64]) -> Result<Point, NoDerivative>;

    /// The local coordinates at `from` that move it nearest to `to`.
    ///
    /// # Errors
    /// As [`Derivatives::moved`].
    fn difference(&mut self, from: &Point, to: &Point) -> Result<Vec<f64>, NoDerivative>;

    /// One step.
    ///
    /// # Errors
    /// [`NoDerivative::Step`] if the step fails.
    fn step(&mut self, at: &Point) -> Result<Point, NoDerivative>;

    /// One step and its derivative: columns are local coordinates before the step, rows after it.
    ///
    /// # Errors
    /// [`NoDerivative`] if the step fails or cannot be differentiated.
    fn tangent(&mut self, at: &Point) -> Result<(Point, Jacobian), NoDerivative>;

    /// The derivative of the observables (rows) in local coordinates (columns).
    ///
    /// # Errors
    /// [`NoDerivative::Unrecorded`].
    fn observed(&mut self, at: &Point) -> Result<Jacobian, NoDerivative>;

    /// The derivative of the invariants (rows) in local coordinates (columns).
    ///
    /// # Errors
    /// [`NoDerivative::Unrecorded`].
    fn conserved(&mut self, at: &Point) -> Result<Jacobian, NoDerivative>;

    /// The second derivative of the sum of the components of the invariants with these weights, in the local coordinates
    /// that [`Derivatives::moved`] takes.
    ///
    /// # Errors
    /// [`NoDerivative::Unrecorded`].
    fn curvature(&mut self, at: &Point, weights: &[f64]) -> Result<Jacobian, NoDerivative>;

    /// The gradient of a cost of the first `steps` steps from the start. It takes about five times as long as the steps,
    /// and stores about twice the square root of the number of states (Griewank, 1992).
    ///
    /// # Errors
    /// [`NoDerivative`] if a step fails or cannot be differentiated.
    fn gradient(&mut self, steps: u64, cost: &mut dyn Cost) -> Result<Gradient, NoDerivative>;
}

/// Starts a trajectory with derivatives, from the same data as [`Open`](crate::card::Open).
pub type Differentiate = &'static (
             dyn Fn(
    &[Vec<f64>],
    &[Vec<f64>],
    crate::card::Settings,
) -> Result<Box<dyn Derivatives>, NoDerivative>
                 + Sync
         );
