//! A model as data, for command lines, tests and language bindings.
//! Emitted code provides one [`Card`] per model. Read it to list, start and observe models.

mod open_error;

pub use open_error::OpenError;

use crate::StepError;
use crate::derivatives::Differentiate;
use crate::integrate::{CompositionOrder, Halvings};
use crate::kinetic::KineticWarning;
use crate::saved::Words;
use crate::solvers::Method;
use core::fmt;

/// The type of a quantity. It determines how clebsch reads and checks the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Scalar,
    /// A column of numbers.
    Vector,
    /// A symmetric matrix.
    Symmetric,
    /// The symmetric matrix J of the second moments of a body, whose inertia is `tr(J) Id - J`.
    SecondMoments,
    /// A skew matrix.
    Skew,
    /// A diagonal matrix.
    Diagonal,
    /// Any matrix.
    Matrix,
    /// A rotation body -> space, given by its matrix.
    Rotation,
    /// A unit quaternion body -> space, given as its components `(w, x, y, z)`.
    UnitQuaternion,
    /// A rigid motion body -> space, given as its homogeneous matrix of sixteen numbers.
    RigidMotion,
    /// Momentum in body axes: angular; for a rigid motion angular, then linear.
    BodyMomentum,
    /// Momentum in spatial axes: angular; for a rigid motion angular, then linear.
    SpatialMomentum,
    /// Momentum of a field, of its shape.
    FieldMomentum,
}

impl Kind {
    /// A quantity of this kind with these rows and columns, whose name is ASCII.
    #[must_use]
    pub const fn field(self, name: &'static str, size: [usize; 2], doc: &'static str) -> Field {
        self.spelt(name, name, size, doc)
    }

    /// A quantity of this kind whose ASCII name differs from its name.
    #[must_use]
    pub const fn spelt(
        self,
        name: &'static str,
        ascii: &'static str,
        [rows, cols]: [usize; 2],
        doc: &'static str,
    ) -> Field {
        Field {
            name,
            ascii,
            rows,
            cols,
            kind: self,
            doc,
        }
    }
}

/// A parameter, an initial value or an observable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The name as the model writes it, such as `Λ`.
    pub name: &'static str,
    /// The name in ASCII, such as `Lambda`, for files and command lines.
    pub ascii: &'static str,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns; 1 for scalars and vectors.
    pub cols: usize,
    /// The type of the quantity.
    pub kind: Kind,
    /// A short description.
    pub doc: &'static str,
}

impl Field {
    /// This field, with the ASCII name `ascii`.
    #[must_use]
    pub const fn spelt(self, ascii: &'static str) -> Self {
        Self { ascii, ..self }
    }

    /// How many numbers the field has.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.rows * self.cols
    }
}

/// How well the stepper keeps an invariant of the continuous system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conserved {
    /// To rounding.
    Exactly,
    /// It oscillates within `O(h^2)` and does not drift, as the energy of a forced system does.
    Boundedly,
}

/// A conserved quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Invariant {
    /// The name in ASCII, such as `energy`.
    pub name: &'static str,
    /// The formula, such as `½ μ_k·ζ, where μ_k = I ζ`.
    pub formula: &'static str,
    /// Number of components.
    pub rows: usize,
    /// How well it is conserved.
    pub conserved: Conserved,
}

impl Invariant {
    /// An invariant of `rows` components that oscillates without drift.
    #[must_use]
    pub const fn bounded(name: &'static str, formula: &'static str, rows: usize) -> Self {
        Self {
            name,
            formula,
            rows,
            conserved: Conserved::Boundedly,
        }
    }

    /// An invariant of `rows` components that is conserved to rounding.
    #[must_use]
    pub const fn exact(name: &'static str, formula: &'static str, rows: usize) -> Self {
        Self {
            name,
            formula,
            rows,
            conserved: Conserved::Exactly,
        }
    }
}

/// A named size of a model's matrices, such as `n`, with its value in a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// The name as the model writes it.
    pub name: &'static str,
    /// The smallest size the model admits.
    pub from: usize,
    /// The largest.
    pub to: usize,
    /// The size of this card.
    pub value: usize,
}

/// How a trajectory is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The step size, in the unit of time of the model.
    pub h: f64,
    /// The order of a step, one of [`Card::orders`]. `None` selects the order of the plain step.
    pub order: Option<u32>,
    /// The solver of the implicit step, one of [`Card::solvers`]. `None` selects the model's default.
    pub solver: Option<Method>,
    /// Whether a constant rotation about the momentum makes steps with modified moments symplectic
    /// in momentum and attitude. Available for the orders of [`Settings::COMPENSATED`].
    pub compensated: bool,
    /// Whether you only inspect single steps and never continue a run. If so, a model that is read from its text
    /// projects the initial momenta on its constraints, and does not try the first step in advance. Otherwise it
    /// rejects initial momenta that are not tangent to its constraints up to rounding.
    pub inquiry: bool,
}

impl Settings {
    /// The orders of steps with modified moments that can be compensated. Steps of order two need no
    /// compensation; the series of the compensation ends before order ten.
    pub const COMPENSATED: [u32; 3] = [4, 6, 8];

    /// Plain steps of `h`.
    #[must_use]
    pub fn step(h: f64) -> Self {
        Self {
            h,
            order: None,
            solver: None,
            compensated: false,
            inquiry: false,
        }
    }

    /// These steps, for inspection only: see [`Settings::inquiry`].
    #[must_use]
    pub fn to_inquire(self) -> Self {
        Self {
            inquiry: true,
            ..self
        }
    }

    /// These steps, with the given order.
    #[must_use]
    pub fn of_order(self, order: u32) -> Self {
        Self {
            order: Some(order),
            ..self
        }
    }
}

/// The requested solver, if the model offers it.
///
/// # Errors
/// [`OpenError::Solver`] if the model does not offer it.
pub fn chosen_solver(
    settings: Settings,
    offered: &'static [&'static str],
) -> Result<Option<Method>, OpenError> {
    match settings.solver {
        Some(method) if !offered.contains(&method.name()) => Err(OpenError::Solver { offered }),
        other => Ok(other),
    }
}

/// Starts a trajectory from parameters and initial values (each field one vector, row-major).
///
/// # Errors
/// [`OpenError`] for a wrong number of values, bad parameters, an unknown order, or a failed start.
pub type Open = &'static (
             dyn Fn(&[Vec<f64>], &[Vec<f64>], Settings) -> Result<Box<dyn Trajectory>, OpenError>
                 + Sync
         );

/// Gives the card of a model at other sizes, one for each dimension. `None` if the model does not
/// admit these sizes.
pub type Resize = &'static (dyn Fn(&[usize]) -> Option<Card> + Sync);

/// The complete description of a model without its Rust type.
#[derive(Clone, Copy)]
pub struct Card {
    /// The model's name, such as `HeavyTop`.
    pub name: &'static str,
    /// The name for command lines, such as `heavy-top`.
    pub kebab: &'static str,
    /// A description of the model.
    pub doc: &'static str,
    /// The model's text as written.
    pub source: &'static str,
    /// A hash of the text and the generator, by which results can be traced to the model.
    pub fingerprint: u64,
    /// A summary of the derivation, in a few lines.
    pub summary: &'static str,
    /// How the implicit step is solved.
    pub solver: &'static str,
    /// Order of accuracy in the step size.
    pub order: u32,
    /// The orders that you can request, the order of the plain step first.
    pub orders: &'static [u32],
    /// Whether orders above the plain order come from modified moments; otherwise they come from composition.
    pub preprocessed: bool,
    /// Whether a step with `-h` undoes a step with `h`.
    pub reversible: bool,
    /// The parameters, in the order [`Card::open`] takes them.
    pub parameters: &'static [Field],
    /// The initial values, in the order [`Card::open`] takes them.
    pub initial: &'static [Field],
    /// The observables, in the order [`Trajectory::observe`] gives them.
    pub observables: &'static [Field],
    /// The invariants, in the order [`Trajectory::invariants`] gives them.
    pub invariants: &'static [Invariant],
    /// The discrete energy of an edge, computed from the states at its two ends: minus the derivative of the action
    /// with respect to the step size. The model's `discrete_energy` gives its value.
    pub discrete_energy: Invariant,
    /// Starts a trajectory.
    pub open: Open,
    /// Names of the solvers that [`Settings::solver`] can select, the model's default first. Empty if
    /// the model offers a single solver.
    pub solvers: &'static [&'static str],
    /// The named sizes of the model, with their values in this card; none for most models.
    pub dimensions: &'static [Dimension],
    /// The card of the same model at other sizes.
    pub sized: Resize,
    /// Starts a trajectory with its derivatives. `None` for compiled models: read their text with `clebsch-interpret`.
    pub differentiate: Option<Differentiate>,
}

impl fmt::Debug for Card {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Card")
            .field("name", &self.name)
            .field("fingerprint", &self.fingerprint)
            .field("dimensions", &self.dimensions)
            .finish_non_exhaustive()
    }
}

impl Card {
    /// Describes how steps of a higher order are composed, and which structure they lose.
    #[must_use]
    pub fn method_of_order(&self, order: u32, compensated: bool) -> String {
        if self.preprocessed && compensated {
            format!(
                "order {order} by modified moments, compensated: Poisson in the momentum; \
                 symplectic in momentum and attitude up to terms of h^11"
            )
        } else if self.preprocessed {
            format!(
                "order {order} by modified moments: Poisson in the momentum; symplectic in momentum \
                 and attitude only up to the error of a step"
            )
        } else {
            let stages = CompositionOrder::of_number(order).map_or(1, |o| o.factors().len());
            format!(
                "order {order} by composing {stages} plain steps: symplectic, with the same \
                 invariants"
            )
        }
    }

    /// A template for the card of a model without named sizes: symmetric steps of order two, compositions of order
    /// 4, 6 and 8, and a single solver. The model sets the remaining fields.
    #[must_use]
    pub const fn plain(open: Open, sized: Resize) -> Card {
        Card {
            name: "",
            kebab: "",
            doc: "",
            source: "",
            fingerprint: 0,
            summary: "",
            solver: "",
            order: 2,
            orders: &[2, 4, 6, 8],
            preprocessed: false,
            reversible: true,
            parameters: &[],
            initial: &[],
            observables: &[],
            invariants: &[],
            discrete_energy: Invariant::bounded("discrete_energy", "", 1),
            open,
            solvers: &[],
            dimensions: &[],
            sized,
            differentiate: None,
        }
    }

    /// How many numbers one sample of all observables has.
    #[must_use]
    pub fn observable_count(&self) -> usize {
        self.observables.iter().map(Field::count).sum()
    }

    /// How many components all invariants have together.
    #[must_use]
    pub fn invariant_count(&self) -> usize {
        self.invariants.iter().map(|invariant| invariant.rows).sum()
    }
}

/// The callback of [`Trajectory::step_in_parts`]. It receives the length of a substep as a fraction of the whole
/// step, and all observables before and after the substep.
pub type PartSeen<'a> = dyn FnMut(f64, &[f64], &[f64]) + 'a;

/// A running trajectory of a model whose Rust type is hidden.
///
/// A slice that is too short receives only the first numbers.
pub trait Trajectory: Send {
    /// The node the state is at; 0 at the start.
    fn node(&self) -> u64;

    /// The time at that node, `node * h`.
    fn time(&self) -> f64;

    /// Advances by one step.
    ///
    /// # Errors
    /// [`StepError`]; the state is then unchanged.
    fn step(&mut self) -> Result<(), StepError>;

    /// Advances by one step as [`step`](Self::step) does, and calls `seen` for each of the model's own steps within
    /// it. `seen` receives the length as a fraction of the whole step, and all observables before and after. Steps
    /// with modified moments and subdivided steps do not call `seen`.
    ///
    /// # Errors
    /// [`StepError`]; the state is then unchanged. If a substep fails, `seen` was already called for the substeps
    /// before it.
    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let none = vec![0.0; self.card().observable_count()];
        let [mut before, mut after] = [none.clone(), none];
        self.observe(&mut before);
        self.step()?;
        self.observe(&mut after);
        seen(1.0, &before, &after);
        Ok(())
    }

    /// The model's description; it determines how long the slices below must be.
    fn card(&self) -> &'static Card;

    /// A warning if the kinetic energy is not positive definite at the initial state. The trajectory
    /// runs despite the warning. If its first step fails, [`OpenError::Kinetic`] carries the
    /// warning.
    fn kinetic_warning(&self) -> Option<KineticWarning> {
        None
    }

    /// How many steps were halved. `None` if a failed step ends a run, see [`Halved`](crate::integrate::Halved).
    fn halvings(&self) -> Option<Halvings> {
        None
    }

    /// Writes all observables, each row-major, one after another.
    fn observe(&self, out: &mut [f64]);

    /// Writes all components of all invariants.
    fn invariants(&self, out: &mut [f64]);

    /// Writes one size per component of the invariants: the sum of the absolute values of its terms at
    /// this node, or an upper bound of that sum. The maximum over a run is the natural scale of the
    /// component, see [`Drift`](crate::integrate::Drift).
    fn scales(&self, out: &mut [f64]);

    /// The operations of a step and of what is evaluated at nodes, as text; `None` if they are not recorded (yet).
    fn operations(&self) -> Option<String> {
        None
    }

    /// Reads or writes everything that changes from step to step: the state, and the memory of the solver.
    /// If you restore it into a trajectory opened from the same data, the run continues bit for bit.
    /// The default implementation refuses to save.
    fn words(&mut self, words: &mut Words) {
        words.refuse();
    }
}
