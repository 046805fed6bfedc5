//! Models with labels for every number of sites: the program with loops over sites that is emitted for
//! them, executed. Takes the text of a model; gives chains that start from data at sites, and run.

mod card;
mod composed;
mod coordinates;
mod differentiated;
mod inputs;
mod kinetic;
mod node_values;
mod operations;
mod running;
mod trajectory;

pub(crate) use card::Carded;
pub use inputs::Numbers;
pub(crate) use inputs::extent;
pub use trajectory::LineTrajectory;

use crate::Refused;
use crate::cache::Cache;
use crate::code::{Places, Routine};
use crate::derived::{self, LoopProgram, Looped};
use crate::failure::Failure;
use crate::listing::FieldNames;
use crate::lower::{self, Shared, entry};
use crate::opened::at;
use crate::running::{put, run};
use crate::sites::Column;
use crate::value::Value;
use clebsch::line::LineError;
use clebsch::{Real, StepCause};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::ChainConfig;
use clebsch_core::line::Coordinates;
use core::fmt;
use inputs::{Ends, InputStruct};
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

/// Why a chain cannot start.
#[derive(Clone, Debug, PartialEq)]
pub enum Unstarted {
    /// A quantity is not given.
    Missing(String),
    /// The length of a list is not a multiple of the number of components.
    Components {
        /// The quantity.
        quantity: String,
        /// The number of components of a value.
        components: usize,
        /// The number of components found.
        found: usize,
    },
    /// A value is not valid, or the first step fails.
    Line(LineError),
}

impl From<LineError> for Unstarted {
    fn from(e: LineError) -> Self {
        Unstarted::Line(e)
    }
}

impl fmt::Display for Unstarted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(quantity) => write!(f, "`{quantity}` is missing"),
            Self::Components {
                quantity,
                components,
                found,
            } => write!(
                f,
                "`{quantity}` takes {components} numbers for each value, found {found}"
            ),
            Self::Line(e) => write!(f, "{e}"),
        }
    }
}

impl std::error::Error for Unstarted {}

/// Routines that evaluate quantities of a state, by name.
type Evaluators = Vec<(String, Routine<f64>)>;

/// A model with labels, from which you can start chains.
#[derive(Debug)]
pub struct LineModel {
    /// The name of the model.
    name: String,
    /// The names of the numbers of sites, one for each label, and whether one label is a chain.
    counts: Vec<String>,
    has_line: bool,
    parameters: InputStruct,
    sites: InputStruct,
    ends: Ends,
    initial: InputStruct,
    new: Routine<f64>,
    start: Routine<f64>,
    /// Like `start`, with initial momenta projected on the constraints; `None` without constraints.
    projecting: Option<Routine<f64>>,
    step: Routine<f64>,
    workspace: Routine<f64>,
    /// Whether a step solves for the velocities of all sites together.
    together: bool,
    /// The energy in the limit of small steps, if it is known.
    energies: Option<Routine<f64>>,
    energy_sizes: Option<Routine<f64>>,
    totals: Evaluators,
    total_sizes: Evaluators,
    /// The state that measures sizes, if impulses act at nodes.
    enlarged: Option<Routine<f64>>,
    observers: Evaluators,
    functionals: Evaluators,
    momenta: Evaluators,
    /// Name, number of components, and why it is conserved.
    conserved: Vec<(String, usize, String)>,
    /// The names of totals, and the terms that they sum over all sites, as text.
    densities: Vec<(String, String)>,
    node: u32,
    stamp: u32,
    names: FieldNames,
    places: usize,
    /// The group elements that the program stores in coordinates.
    coordinates: Vec<Coordinates>,
}

/// Why [`LineModel::read`] fails: the model is wrong, loops over sites do not support its form, or it needs a build.
#[derive(Debug)]
pub enum NoLine {
    /// Loops over sites do not support the form of the model; the reason.
    Form(String),
    /// Anything else.
    Refused(Refused),
}

impl From<Refused> for NoLine {
    fn from(refused: Refused) -> Self {
        NoLine::Refused(refused)
    }
}

impl fmt::Display for NoLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(why) => write!(f, "{why}"),
            Self::Refused(refused) => write!(f, "{refused}"),
        }
    }
}

impl std::error::Error for NoLine {}

impl LineModel {
    /// Reads the text of a model with labels.
    ///
    /// # Errors
    /// [`NoLine::Form`], if the model cannot run with loops over sites; [`NoLine::Refused`] for any other error.
    pub fn read(source: &str) -> Result<Arc<Self>, NoLine> {
        Self::read_with(source, &Cache::none())
    }

    /// Reads the text of a model with labels, whose program a cache may have. Each text is read once in a process.
    pub(crate) fn read_with(source: &str, cache: &Cache) -> Result<Arc<Self>, NoLine> {
        static KNOWN: RwLock<BTreeMap<String, Arc<LineModel>>> = RwLock::new(BTreeMap::new());
        let all = KNOWN.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = all.get(source) {
            return Ok(known.clone());
        }
        drop(all);
        let read = match derived::kept(cache, ("", source), || Looped::derive(source))? {
            Looped::Program(program) => Self::of(program)?,
            Looped::Form(why) => return Err(NoLine::Form(why)),
        };
        let mut all = KNOWN.write().unwrap_or_else(PoisonError::into_inner);
        Ok(all.entry(source.to_owned()).or_insert(read).clone())
    }

    fn of(line: LoopProgram) -> Result<Arc<Self>, Refused> {
        let (program, name) = (&derived::program(&line.items)?, line.name.as_str());
        let mut shared = Shared::new(program, BTreeMap::new());
        let item = |suffix: &str| format!("{name}{suffix}");
        let parameters = InputStruct::named(&mut shared, &item("Parameters"))?;
        let initial = InputStruct::named(&mut shared, &item("Initial"))?;
        let sites = InputStruct::named(&mut shared, &item("Sites"))?;
        let ends = Ends::of(&mut shared, name)?;
        let state = item("State");
        let own = |ty: &str, wanted: &dyn Fn(&str) -> bool| -> Vec<String> {
            let all = program
                .functions
                .keys()
                .filter(|(t, f)| t == ty && wanted(f));
            all.map(|(_, f)| f.clone()).collect()
        };
        let of_holds = |f: &str| held(&line, f).is_some();
        let totals = own(name, &|f| {
            line.totals.iter().any(|t| t.name == f) || of_holds(f)
        });
        let is_first = |i: &usize| {
            let name = |i: usize| line.totals.get(i).map(|t| &t.name);
            (0..*i).all(|before| name(before) != name(*i))
        };
        let functions = (0..line.totals.len()).filter(is_first);
        let conserved = functions
            .filter_map(|i| line.totals.get(i))
            .filter_map(|t| {
                let rows = rows(&program.function(name, &t.name)?.sig.output)?;
                Some((t.name.clone(), rows, t.reason.clone()))
            });
        let of_constraints = totals.iter().filter_map(|f| {
            let (multiplier, is_rate) = held(&line, f)?;
            let reason = match is_rate {
                true => format!(
                    "the rate of change of the constraint of {multiplier} vanishes: the momentum is projected at every node"
                ),
                false => format!("enforced by the multiplier {multiplier}"),
            };
            Some((ascii(f), 1, reason))
        });
        // With functionals, one site represents all sites.
        let sums = line.totals.iter().filter(|_| !line.has_functionals);
        let densities = sums.map(|t| (t.name.clone(), t.density.clone()));
        let conserved = conserved.chain(of_constraints.collect::<Vec<_>>());
        let observers = own(&state, &|f| f != "node");
        let functionals = own(name, &|f| f.starts_with("values_"));
        let momenta = own(name, &|f| f.starts_with("momenta_of_"));
        let mut lower =
            |ty: &str, f: &str, given: &[usize]| entry(&mut shared, (ty, f), given, at::FIRST);
        let new = lower(name, "new", &[at::GIVEN, at::OUT])?;
        let start = lower(name, "start", &[at::MODEL, at::GIVEN, at::STEP])?;
        let step = lower(name, "step", &[at::MODEL, at::STATE, at::WORK])?;
        let workspace = lower(name, "workspace", &[at::MODEL, at::STATE, at::STEP])?;
        let has_energies = program.function(name, "energies").is_some();
        let energies = match has_energies {
            true => Some(lower(name, "energies", &[at::MODEL, at::STATE])?),
            false => None,
        };
        let enlarge = "not_less_than_impulses";
        let enlarged = match program.function(name, enlarge) {
            Some(_) => Some(lower(name, enlarge, &[at::MODEL, at::STATE, at::WORK])?),
            None => None,
        };
        let mut asked =
            |ty: &str, names: Vec<String>, given: &[usize]| -> Result<Evaluators, Refused> {
                let all = names.into_iter();
                all.map(|f| Ok((f.clone(), lower(ty, &f, given)?)))
                    .collect()
            };
        let totals = asked(name, totals, &[at::MODEL, at::STATE])?;
        let observers = asked(&state, observers, &[at::STATE])?;
        let functionals = asked(name, functionals, &[at::MODEL, at::STATE])?;
        let momenta = asked(name, momenta, &[at::MODEL, at::GIVEN, at::OUT])?;
        let projecting = match line.holds.is_empty() {
            true => None,
            false => {
                let of = [at::MODEL, at::GIVEN, at::STEP];
                Some(lower::projecting(&mut shared, (name, "start"), &of)?)
            }
        };
        shared.by_size = true;
        let of = [at::MODEL, at::STATE];
        let energy_sizes = match has_energies {
            true => Some(entry(&mut shared, (name, "energies"), &of, at::FIRST)?),
            false => None,
        };
        let sized = totals.iter().map(|(f, _)| {
            // For constraints, another function computes the sizes of the terms.
            let own = match held(&line, f) {
                Some((multiplier, true)) => format!("constraint_rate_size_{multiplier}"),
                Some((multiplier, false)) => format!("constraint_size_{multiplier}"),
                None => f.clone(),
            };
            shared.by_length = held(&line, f).is_none();
            let routine = entry(&mut shared, (name, &own), &of, at::FIRST)?;
            Ok((f.clone(), routine))
        });
        let total_sizes = sized.collect::<Result<Evaluators, Refused>>()?;
        let spelt = |list: Evaluators| -> Evaluators {
            let all = list.into_iter();
            all.map(|(f, r)| match held(&line, &f) {
                Some(_) => (ascii(&f), r),
                None => (f, r),
            })
            .collect()
        };
        let (totals, total_sizes) = (spelt(totals), spelt(total_sizes));
        let (node, stamp) = (shared.name("node"), shared.name("stamp"));
        let of_state = totals.iter().chain(&observers).chain(&total_sizes);
        let of_state = of_state.chain(&functionals).chain(&momenta);
        let of_state = of_state.map(|(_, r)| r.places);
        let own = [&new, &start, &step, &workspace].into_iter();
        let own = own
            .chain(&energies)
            .chain(&energy_sizes)
            .chain(&enlarged)
            .chain(&projecting);
        let own = own.map(|r| r.places);
        let places = own.chain(of_state).max();
        Ok(Arc::new(LineModel {
            counts: line.counts.clone(),
            has_line: line.has_line,
            parameters,
            sites,
            ends,
            initial,
            new,
            start,
            projecting,
            step,
            workspace,
            together: line.is_together,
            energies,
            energy_sizes,
            totals,
            total_sizes,
            enlarged,
            observers,
            functionals,
            momenta,
            conserved: conserved.collect(),
            densities: densities.collect(),
            node,
            stamp,
            names: shared.names(),
            places: places.unwrap_or(at::FIRST),
            coordinates: line.coordinates.clone(),
            name: name.to_owned(),
        }))
    }

    /// The name of the model.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether velocities of all sites are found together.
    pub fn is_solved_together(&self) -> bool {
        self.together
    }

    /// Whether [`LineTrajectory::energies`] gives any.
    pub fn has_energies(&self) -> bool {
        self.energies.is_some()
    }

    /// The names of conserved totals, as [`LineTrajectory::total`] takes them.
    pub fn totals(&self) -> impl Iterator<Item = &str> {
        self.totals.iter().map(|(name, _)| name.as_str())
    }

    /// Conserved totals with the numbers of their components, and why they are conserved.
    pub fn conserved(&self) -> impl Iterator<Item = (&str, usize, &str)> {
        let all = self.conserved.iter();
        all.map(|(name, rows, reason)| (name.as_str(), *rows, reason.as_str()))
    }

    /// The terms that a total sums over all sites, as text. If end conditions change the sum, each variant is listed.
    pub(crate) fn densities(&self, name: &str) -> impl Iterator<Item = &str> {
        let own = self.densities.iter().filter(move |(own, _)| own == name);
        own.map(|(_, text)| text.as_str())
    }

    /// The names of the observables at sites, as [`LineTrajectory::observe`] takes them: moving quantities and their
    /// momenta, then the values of functionals of all sites.
    pub fn observers(&self) -> impl Iterator<Item = String> + '_ {
        let functionals = self.functionals.iter();
        let values = functionals.map(|(name, _)| name.strip_prefix("values_").unwrap_or(name));
        let own = self.observers.iter().map(|(name, _)| name.clone());
        let all = &self.coordinates;
        let own = own.filter(|name| all.iter().all(|c| coordinates::of(c, name).is_none()));
        let in_groups = all.iter().flat_map(coordinates::shown);
        own.chain(in_groups).chain(values.map(str::to_owned))
    }

    /// The names of the domain parameters of a model with particles, each with its number of values. They are the
    /// lengths of a torus, `domain` for a box, and the cells of a grid along each direction.
    pub fn space(&self) -> impl Iterator<Item = (&str, usize)> {
        self.sites.space()
    }

    /// The momenta of given velocities of a field of positions, if the model defines them. Lists contain one site after
    /// the other.
    ///
    /// # Errors
    /// As [`LineModel::start`].
    pub fn momenta(
        &self,
        choice: &ChainConfig,
        numbers: &Numbers<'_>,
        field: &str,
        velocities: &[f64],
    ) -> Result<Option<Vec<f64>>, Unstarted> {
        let name = format!("momenta_of_{field}");
        let Some((_, routine)) = self.momenta.iter().find(|(own, _)| *own == name) else {
            return Ok(None);
        };
        let mut places = vec![Value::Unit; self.places];
        let model = self.built(choice, numbers, &mut places)?;
        put(&mut places, at::MODEL, model);
        let velocities = |_: &str| Some(velocities.to_vec());
        let own = as_arrays(self.initial.one(field, numbers)?);
        put(&mut places, at::GIVEN, own);
        let own = as_arrays(self.initial.one(field, &velocities)?);
        put(&mut places, at::OUT, own);
        let all = run(routine, &mut places).map_err(Failure::line)?;
        Ok(Some(columns(&all).ok_or_else(|| unread().line())?))
    }

    /// The model with its parameters.
    fn built(
        &self,
        choice: &ChainConfig,
        numbers: &Numbers<'_>,
        places: &mut Places<f64>,
    ) -> Result<Value<f64>, Unstarted> {
        let [parameters, sites] = self.parameter_values(choice, numbers)?;
        put(places, at::GIVEN, parameters);
        put(places, at::OUT, sites);
        let model = run(&self.new, places).map_err(Failure::line)?;
        put(places, at::OUT, Value::Unit);
        Ok(model)
    }

    /// The parameters of the whole chain, then the parameters of sites and ends.
    fn parameter_values(
        &self,
        choice: &ChainConfig,
        numbers: &Numbers<'_>,
    ) -> Result<[Value<f64>; 2], Unstarted> {
        let ends = match self.has_line {
            true => self.ends.value(choice, numbers)?,
            false => Value::Unit,
        };
        let of_sites = |field: &str| match field {
            "ends" => Some(ends.clone()),
            field => inputs::counts(&self.counts, choice, field),
        };
        Ok([
            self.parameters.value(numbers, &|_| None)?,
            self.sites.value(numbers, &of_sites)?,
        ])
    }

    /// Starts a chain with step size `h`. `numbers` returns parameters and initial values by their names in the model,
    /// and momenta as `momentum_q` or `body_momentum_Λ`.
    ///
    /// # Errors
    /// [`Unstarted`] names the missing quantity, or the quantity and the site of a value that is not valid.
    pub fn start(
        self: &Arc<Self>,
        choice: &ChainConfig,
        h: f64,
        numbers: &Numbers<'_>,
    ) -> Result<LineTrajectory, Unstarted> {
        self.start_by(&self.start, choice, h, numbers)
    }

    /// Like [`LineModel::start`], but projects the momenta on the constraints, however large their normal part is.
    ///
    /// # Errors
    /// As [`LineModel::start`].
    pub fn start_projected(
        self: &Arc<Self>,
        choice: &ChainConfig,
        h: f64,
        numbers: &Numbers<'_>,
    ) -> Result<LineTrajectory, Unstarted> {
        let start = self.projecting.as_ref().unwrap_or(&self.start);
        self.start_by(start, choice, h, numbers)
    }

    fn start_by(
        self: &Arc<Self>,
        start: &Routine<f64>,
        choice: &ChainConfig,
        h: f64,
        numbers: &Numbers<'_>,
    ) -> Result<LineTrajectory, Unstarted> {
        for c in &self.coordinates {
            coordinates::admit(c, numbers)?;
        }
        let numbers: &Numbers<'_> = &|name| {
            let mut all = self.coordinates.iter();
            let own = all.find(|c| coordinates::of(c, name).is_some());
            match own {
                Some(c) => coordinates::given(c, name, numbers),
                None => numbers(name),
            }
        };
        let mut places = vec![Value::Unit; self.places];
        let model = self.built(choice, numbers, &mut places)?;
        put(&mut places, at::MODEL, model);
        put(
            &mut places,
            at::GIVEN,
            self.initial.value(numbers, &|_| None)?,
        );
        put(&mut places, at::STEP, Value::Real(h));
        let both = run(start, &mut places);
        let both = both.map_err(|e| coordinates::named(&self.coordinates, e.line()))?;
        put(&mut places, at::GIVEN, Value::Unit);
        let Value::List(both) = both else {
            return Err(Unstarted::Line(unread().line()));
        };
        for (value, place) in both.into_iter().zip([at::STATE, at::WORK]) {
            put(&mut places, place, value);
        }
        Ok(LineTrajectory {
            model: self.clone(),
            places,
            h,
            composed: None,
        })
    }
}

/// The multiplier whose constraint a function evaluates, and whether the function evaluates the rate of the
/// constraint.
fn held<'a>(line: &'a LoopProgram, function: &str) -> Option<(&'a str, bool)> {
    line.holds.iter().find_map(|h| {
        let own = function.strip_suffix(h.as_str())?;
        match own {
            "constraint_" => Some((h.as_str(), false)),
            "constraint_rate_" => Some((h.as_str(), true)),
            _ => None,
        }
    })
}

fn unread() -> Failure {
    let what = "the start of a line";
    Failure::Cause(StepCause::Unread { what })
}

/// The number of components of a total, from its type.
fn rows(output: &syn::ReturnType) -> Option<usize> {
    let syn::ReturnType::Type(_, ty) = output else {
        return None;
    };
    let sizes = inputs::sizes(ty);
    Some(sizes.into_iter().product())
}

/// Numbers as arrays of one entry, which is the form in states.
fn as_arrays(value: Value<f64>) -> Value<f64> {
    match value {
        Value::Sites(Column::Numbers(list)) => Value::Sites(Column::Arrays([1, 1], list)),
        other => other,
    }
}

/// The numbers of all sites, one site after the other.
fn columns<T: Real>(value: &Value<T>) -> Option<Vec<T>> {
    let Value::Sites(column) = value else {
        return None;
    };
    let mut all = Vec::new();
    for value in column.values() {
        all.extend(numbers(&value)?);
    }
    Some(all)
}

/// The numbers of a value: matrices and rotations in row-major order, unit quaternions as components.
fn numbers<T: Real>(value: &Value<T>) -> Option<Vec<T>> {
    Some(match value {
        Value::Real(x) => vec![*x],
        Value::Momentum(_, v) => v.as_slice().to_vec(),
        Value::Rotation(r) => r.matrix().transpose().as_slice().to_vec(),
        Value::Quaternion(q) => q.components().to_vec(),
        other => other.dense()?.transpose().data,
    })
}
