//! A model as data: what a command line, a test or a binding needs to know of it.
//! Emitted code gives one [`Card`] per model; it is read by whatever lists, starts and observes.

use crate::integrate::{CompositionOrder, Halvings};
use crate::kinetic::KineticWarning;
use crate::saved::Words;
use crate::solvers::Method;
use crate::{ParameterError, StartError, StepCause, StepError};
use core::fmt;

/// What sort of quantity a field is; it fixes how the numbers are read and checked.
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

    /// The same whose name in ASCII is another.
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
    /// What sort of quantity it is.
    pub kind: Kind,
    /// What it means, in a few words.
    pub doc: &'static str,
}

impl Field {
    /// The same with its name in ASCII.
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
    /// What is computed, such as `½ μ_k·ζ, where μ_k = I ζ`.
    pub formula: &'static str,
    /// Number of components.
    pub rows: usize,
    /// How well it is kept.
    pub conserved: Conserved,
}

impl Invariant {
    /// What oscillates without drift, with this many components.
    #[must_use]
    pub const fn bounded(name: &'static str, formula: &'static str, rows: usize) -> Self {
        Self {
            name,
            formula,
            rows,
            conserved: Conserved::Boundedly,
        }
    }

    /// What is kept to rounding, with this many components.
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

/// A named size of a model's matrices, such as `n`, and the one a card is for.
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
    /// The order of a step, one of [`Card::orders`]; that of the plain step where none is given.
    pub order: Option<u32>,
    /// The solver of the implicit step, one of [`Card::solvers`]; the model's own where none is given.
    pub solver: Option<Method>,
    /// Whether steps with modified moments are made symplectic with the attitude by a constant turn
    /// about the momentum; only for the orders of [`Settings::COMPENSATED`].
    pub compensated: bool,
    /// Whether single steps are only looked at, and none is gone on from. Of models that are read, the momenta at the start
    /// are then projected on held constraints, which refuse more than rounding across them otherwise; and the first step is
    /// not tried before it is made.
    pub inquiry: bool,
}

impl Settings {
    /// The orders of steps with modified moments that can be compensated: of order two nothing is
    /// missing, of order ten nothing that is known.
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

    /// The same steps, only to look at them: see [`Settings::inquiry`].
    #[must_use]
    pub fn to_inquire(self) -> Self {
        Self {
            inquiry: true,
            ..self
        }
    }

    /// The same steps, of the given order.
    #[must_use]
    pub fn of_order(self, order: u32) -> Self {
        Self {
            order: Some(order),
            ..self
        }
    }
}

/// The solver asked for, if one of those offered.
///
/// # Errors
/// [`OpenError::Solver`] for any other.
pub fn chosen_solver(
    settings: Settings,
    offered: &'static [&'static str],
) -> Result<Option<Method>, OpenError> {
    match settings.solver {
        Some(method) if !offered.contains(&method.name()) => Err(OpenError::Solver { offered }),
        other => Ok(other),
    }
}

/// Starts a trajectory from parameters, initial values (each field one vector, row-major) and the
/// way to step it.
///
/// # Errors
/// [`OpenError`] for a wrong number of values, bad parameters, an order that is not offered, or a
/// refused start.
pub type Open = &'static (
             dyn Fn(&[Vec<f64>], &[Vec<f64>], Settings) -> Result<Box<dyn Trajectory>, OpenError>
                 + Sync
         );

/// Gives the card of a model at other sizes, one for each dimension; none where the model does not
/// admit them.
pub type Resize = &'static (dyn Fn(&[usize]) -> Option<Card> + Sync);

/// Everything there is to know about a model without knowing its type.
#[derive(Clone, Copy)]
pub struct Card {
    /// The model's name, such as `HeavyTop`.
    pub name: &'static str,
    /// The name for command lines, such as `heavy-top`.
    pub kebab: &'static str,
    /// What the model is.
    pub doc: &'static str,
    /// The model's text as written.
    pub source: &'static str,
    /// A hash of the text and the generator, so that results can be traced to it.
    pub fingerprint: u64,
    /// What was derived, a few lines.
    pub summary: &'static str,
    /// How the implicit step is solved.
    pub solver: &'static str,
    /// Order of accuracy in the step size.
    pub order: u32,
    /// The orders that can be asked for, the plain step's first.
    pub orders: &'static [u32],
    /// Whether orders above the plain one come from modified moments; else from composition.
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
    /// The discrete energy of an edge, by what stands at its two ends: how the action of the step
    /// falls when the step grows. The model's `discrete_energy` gives its value.
    pub discrete_energy: Invariant,
    /// Starts a trajectory.
    pub open: Open,
    /// Names of the solvers among which [`Settings::solver`] chooses, the model's own first; none
    /// where there is no choice.
    pub solvers: &'static [&'static str],
    /// The named sizes of the model, with their values in this card; none for most models.
    pub dimensions: &'static [Dimension],
    /// The card of the same model at other sizes.
    pub sized: Resize,
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
    /// How steps of an order above the plain one are made, and what that costs in structure.
    #[must_use]
    pub fn method_of_order(&self, order: u32, compensated: bool) -> String {
        if self.preprocessed && compensated {
            format!(
                "order {order} by modified moments, compensated: Poisson in the momentum; \
                 symplectic with the attitude up to terms of h^11"
            )
        } else if self.preprocessed {
            format!(
                "order {order} by modified moments: Poisson in the momentum; symplectic with the \
                 attitude only up to the error of a step"
            )
        } else {
            let stages = CompositionOrder::of_number(order).map_or(1, |o| o.factors().len());
            format!(
                "order {order} by composing {stages} plain steps: symplectic, with the same \
                 invariants"
            )
        }
    }

    /// Of a model of one size whose steps are symmetric, of order two and of those that are composed of them, and leave
    /// no choice of a solver: how it is opened. The rest is for the model to say.
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

/// What [`Trajectory::step_in_parts`] calls for each part of a step: with the part's length as a share of the whole step,
/// and with all observables before and after it.
pub type PartSeen<'a> = dyn FnMut(f64, &[f64], &[f64]) + 'a;

/// A running trajectory whose model type is hidden.
///
/// Slices that are too short are filled as far as they go.
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

    /// Advances by one step as [`step`](Self::step) does, and shows each of the model's own steps that it is made of: its length as a share
    /// of the whole one, and all observables before and after it. One of modified moments, or made by halves, shows nothing.
    ///
    /// # Errors
    /// [`StepError`]; the state is then unchanged. Steps before the one that failed have been shown.
    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let none = vec![0.0; self.card().observable_count()];
        let [mut before, mut after] = [none.clone(), none];
        self.observe(&mut before);
        self.step()?;
        self.observe(&mut after);
        seen(1.0, &before, &after);
        Ok(())
    }

    /// The model's description; it tells how long the slices below must be.
    fn card(&self) -> &'static Card;

    /// What is wrong with the kinetic energy where the trajectory started, if anything: a warning,
    /// the trajectory runs all the same. Where its first step is refused, [`OpenError::Kinetic`] says so.
    fn kinetic_warning(&self) -> Option<KineticWarning> {
        None
    }

    /// How many steps were made by parts; none where a refused step ends a run, see
    /// [`Halved`](crate::integrate::Halved).
    fn halvings(&self) -> Option<Halvings> {
        None
    }

    /// Writes all observables, each row-major, one after another.
    fn observe(&self, out: &mut [f64]);

    /// Writes all components of all invariants.
    fn invariants(&self, out: &mut [f64]);

    /// Writes one size per component of the invariants: the sum of the absolute values of the terms it
    /// is made of at this node, or a bound of it; not negative. The largest along a run is the natural
    /// scale of the component, see [`Drift`](crate::integrate::Drift).
    fn scales(&self, out: &mut [f64]);

    /// Meets everything that changes from step to step: the state, and what steps remember.
    /// Put into a trajectory that was opened anew from the same data, it goes on to the last bit as the one
    /// it was taken from. A trajectory of your own refuses unless it says otherwise.
    fn words(&mut self, words: &mut Words) {
        words.refuse();
    }
}

/// Why [`Card::open`] refuses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OpenError {
    /// A parameter is unusable.
    Parameter(ParameterError),
    /// An initial value is unusable, or the first step is refused.
    Start(StartError),
    /// The first step is refused, and the kinetic energy is not positive definite, which may be why.
    Kinetic {
        /// Why the step is refused.
        refused: StepCause,
        /// What is wrong with the kinetic energy.
        warning: KineticWarning,
    },
    /// The model does not offer the solver that was named.
    Solver {
        /// Those it offers.
        offered: &'static [&'static str],
    },
    /// Too few or too many numbers.
    Count {
        /// The field, or `parameters` / `initial values` for the number of fields itself.
        field: &'static str,
        /// How many are needed.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// The model has no steps of this order.
    Order {
        /// What was asked for.
        asked: u32,
        /// What there is.
        offered: &'static [u32],
    },
    /// Steps of this kind are not compensated.
    Compensation {
        /// The order of the steps.
        order: u32,
        /// Whether the model's orders above the plain one come from modified moments.
        preprocessed: bool,
    },
    /// Steps cannot be made by parts: a run would not go on from what it observes.
    Unseen {
        /// The initial value that is no observable.
        field: &'static str,
    },
}

impl OpenError {
    /// The same error; where the first step is refused, with what is wrong with the kinetic energy.
    #[must_use]
    pub fn beside(self, warning: Option<KineticWarning>) -> Self {
        match (self, warning) {
            (Self::Start(StartError::Refused(refused)), Some(warning)) => {
                Self::Kinetic { refused, warning }
            }
            (other, _) => other,
        }
    }
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(error) => write!(f, "{error}"),
            Self::Start(error) => write!(f, "{error}"),
            Self::Kinetic { refused, warning } => {
                write!(f, "cannot take the first step: {refused}; {warning}")
            }
            Self::Solver { offered: [] } => {
                write!(f, "this model has one solver only, nothing is to be chosen")
            }
            Self::Solver { offered } => {
                write!(
                    f,
                    "no such solver; this model offers {}",
                    offered.join(", ")
                )
            }
            Self::Count {
                field,
                expected,
                found,
            } => write!(f, "`{field}` takes {expected} numbers, found {found}"),
            Self::Compensation {
                order,
                preprocessed,
            } => {
                write!(
                    f,
                    "steps of order {order} of this model are not compensated: "
                )?;
                match (preprocessed, order) {
                    (false, _) => write!(
                        f,
                        "they are made of its plain steps, and symplectic where those are; leave \
                         the compensation out"
                    ),
                    (true, 2) => write!(
                        f,
                        "they are symplectic as they are; leave the compensation out, or ask for \
                         order 4, 6 or 8"
                    ),
                    (true, _) => write!(
                        f,
                        "the series that is known ends there; leave the compensation out, or ask \
                         for order 4, 6 or 8"
                    ),
                }
            }
            Self::Unseen { field } => write!(
                f,
                "steps are not made by parts: `{field}` is given at the start and not observed later; take a shorter step"
            ),
            Self::Order { asked, offered } => {
                let list: Vec<String> = offered.iter().map(u32::to_string).collect();
                write!(
                    f,
                    "order {asked} is not offered; this model has order {}",
                    list.join(", ")
                )?;
                match offered {
                    [1] => write!(
                        f,
                        ": its step is not symmetric under time reversal, so a composition of it \
                         would gain nothing; `clebsch derive` shows which terms stand in the way: \
                         change them, by `node symmetric;` where they are taken at one end of the \
                         step, or by an assumption on the parameters"
                    ),
                    _ if asked % 2 == 1 => {
                        write!(
                            f,
                            ": the order of a symmetric step is even; ask for one of these"
                        )
                    }
                    _ => write!(f, "; ask for one of these"),
                }
            }
        }
    }
}

impl std::error::Error for OpenError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Parameter(error) => Some(error),
            Self::Start(error) => Some(error),
            Self::Kinetic { refused, .. } => Some(refused),
            Self::Solver { .. }
            | Self::Count { .. }
            | Self::Order { .. }
            | Self::Compensation { .. }
            | Self::Unseen { .. } => None,
        }
    }
}

impl From<ParameterError> for OpenError {
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

impl From<StartError> for OpenError {
    fn from(error: StartError) -> Self {
        Self::Start(error)
    }
}
