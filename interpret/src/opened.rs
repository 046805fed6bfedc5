//! A model read from its text: the operations of all functions that a trajectory calls.

use crate::Refused;
use crate::code::{Places, Routine};
use crate::constants::Constants;
use crate::derivatives::TracedBody;
use crate::derived::{self, Body};
use crate::listing::FieldNames;
use crate::lower::{self, Shared, entry};
use crate::program::{Program, type_name};
use crate::recorded::Recordable;
use crate::signs::Agreement;
use crate::value::{Layout, Value};
use clebsch::card::Card;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// The places of values while a function of a model runs.
pub mod at {
    /// The model: parameters and prepared data.
    pub const MODEL: usize = 0;
    /// The state.
    pub const STATE: usize = 1;
    /// The workspace.
    pub const WORK: usize = 2;
    /// The step size.
    pub const STEP: usize = 3;
    /// The observables.
    pub const OUT: usize = 4;
    /// Further input.
    pub const GIVEN: usize = 5;
    /// The first local.
    pub const FIRST: usize = 6;
}

/// How an initial value is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialForm {
    /// A number.
    Number,
    /// A vector or a matrix.
    Matrix,
    /// An element or a momentum, by its type.
    Of(&'static str),
}

/// The functions of a model.
#[derive(Debug)]
pub struct Functions {
    /// From parameters to the model.
    pub new: Routine<f64>,
    /// From initial values to the state.
    pub begin: Routine<f64>,
    /// The same, with momenta projected on the constraints, if the model has constraints.
    pub projecting: Option<Routine<f64>>,
    /// The model with another solver, if you can choose one.
    pub with_solver: Option<Routine<f64>>,
    /// The workspace of a state, without a trial step.
    pub prepared: Routine<f64>,
    /// The workspace of a free body with compensated steps.
    pub compensated: Option<Routine<f64>>,
    /// A step that does not keep the previous state, for runs that need only the final state.
    pub attempt: Option<Routine<f64>>,
    /// One step.
    pub step: Routine<f64>,
    /// The observables.
    pub observe: Routine<f64>,
    /// The invariants.
    pub invariants: Routine<f64>,
    /// Their scales.
    pub scales: Routine<f64>,
    /// Checks the kinetic energy.
    pub kinetic: Option<Routine<f64>>,
}

/// A model that can be started.
#[derive(Debug)]
pub struct Opened {
    /// The values of its sizes, as declared.
    pub sizes: Vec<usize>,
    /// The card; the caller that opens the model sets its functions.
    pub card: Card,
    /// The functions.
    pub functions: Functions,
    /// The struct of the parameters.
    pub parameters: (Arc<Layout>, Vec<InitialForm>),
    /// The struct of the initial values.
    pub initial: (Arc<Layout>, Vec<InitialForm>),
    /// Quantities whose signs must agree along a chain, if the model is an expanded chain.
    pub signs: Vec<Agreement>,
    /// The index of the field name that counts the nodes of a state.
    pub node: u32,
    /// The names of fields.
    pub names: FieldNames,
    /// How many places the functions need.
    pub places: usize,
    /// The functions over the scalar that records them.
    pub recordable: OnceLock<Recordable>,
    /// The functions that are recorded with derivatives.
    pub traced: OnceLock<TracedBody>,
}

/// A derived text, and the items of its emitted program, which is the same for all sizes.
pub struct Text {
    /// The data of its derivation.
    pub body: Body,
    /// The emitted items.
    pub program: Program,
}

impl Text {
    /// Reads the emitted program.
    ///
    /// # Errors
    /// If the text of the program is not items. Emission never produces such a text.
    pub fn read(body: Body) -> Result<Self, Refused> {
        let program = derived::program(&body.program)?;
        Ok(Text { body, program })
    }
}

impl Opened {
    /// Reads a derived model at the given sizes, or at default sizes.
    ///
    /// # Errors
    /// [`Refused`] for models that need a build.
    pub fn read(text: &Text, sizes: Option<&[usize]>) -> Result<Self, Refused> {
        let Text { body, program } = text;
        let name = body.name.clone();
        let (values, chosen) = chosen_sizes(program, &name, sizes)?;
        let constants = Constants::new(program, &name, &values);
        let card = constants.card()?;
        let mut shared = Shared::new(program, values.clone());
        let functions = functions(&mut shared, &name).map_err(|refused| match refused {
            // An unsupported construct in Newton's method means an unsupported method.
            Refused::Construct(what) if body.has_newton => Refused::Method {
                model: name.clone(),
                method: format!("{} (at `{what}`)", card.solver),
            },
            other => other,
        })?;
        let all = [
            Some(&functions.new),
            Some(&functions.begin),
            functions.projecting.as_ref(),
            functions.with_solver.as_ref(),
            Some(&functions.prepared),
            functions.compensated.as_ref(),
            functions.attempt.as_ref(),
            Some(&functions.step),
            Some(&functions.observe),
            Some(&functions.invariants),
            Some(&functions.scales),
            functions.kinetic.as_ref(),
        ];
        let places = all.into_iter().flatten().map(|r| r.places).max();
        let parameters = given(&mut shared, &format!("{name}Parameters"))?;
        let initial = given(&mut shared, &format!("{name}Initial"))?;
        let node = shared.name(&node_name(program, &name));
        Ok(Opened {
            sizes: chosen,
            card,
            functions,
            parameters,
            initial,
            signs: Vec::new(),
            node,
            names: shared.names(),
            places: places.unwrap_or(at::FIRST),
            recordable: OnceLock::new(),
            traced: OnceLock::new(),
        })
    }

    /// The functions that are recorded with derivatives.
    pub fn traced(&'static self) -> &'static TracedBody {
        self.traced.get_or_init(|| TracedBody::of(self))
    }

    /// Places for its functions, with the model where they expect it.
    pub fn places(&self, model: Value<f64>) -> Places<f64> {
        let mut places = vec![Value::Unit; self.places];
        if let Some(place) = places.get_mut(at::MODEL) {
            *place = model;
        }
        places
    }
}

/// The field of a state that counts nodes: the only count in it.
fn node_name(program: &Program, name: &str) -> String {
    let fields = program.structs.get(&format!("{name}State"));
    let counts = fields.into_iter().flatten();
    let mut count = counts
        .filter(|(_, ty)| type_name(ty).as_deref() == Some("u64"))
        .map(|(field, _)| field.clone());
    count.next_back().unwrap_or_default()
}

type Chosen = (BTreeMap<String, usize>, Vec<usize>);

/// The values of the sizes by their names in the emitted code, and in the order of their declaration.
fn chosen_sizes(program: &Program, name: &str, sizes: Option<&[usize]>) -> Result<Chosen, Refused> {
    let none = BTreeMap::new();
    let constants = Constants::new(program, name, &none);
    let unknown = || Refused::Construct(format!("{name}::CARD"));
    let dimensions = constants.dimensions().ok_or_else(unknown)?;
    let names = constants.size_names().ok_or_else(unknown)?;
    let default = || dimensions.iter().map(|d| 3.clamp(d.from, d.to)).collect();
    let chosen: Vec<usize> = sizes.map_or_else(default, <[usize]>::to_vec);
    let admitted = chosen.len() == dimensions.len()
        && (chosen.iter().zip(&dimensions)).all(|(n, d)| (d.from..=d.to).contains(n));
    if !admitted {
        let list = dimensions.iter();
        let list = list.map(|d| format!("{} from {} to {}", d.name, d.from, d.to));
        return Err(Refused::Size {
            model: name.to_owned(),
            admitted: list.collect::<Vec<_>>().join(", "),
        });
    }
    let values = names.into_iter().zip(chosen.iter().copied()).collect();
    Ok((values, chosen))
}

/// The struct of an input, and how each field is read.
fn given(shared: &mut Shared<'_>, name: &str) -> Result<(Arc<Layout>, Vec<InitialForm>), Refused> {
    let layout = shared.layout(name)?;
    let fields = shared.program.structs.get(name);
    let reads = fields.into_iter().flatten().map(|(_, ty)| {
        match type_name(ty).unwrap_or_default().as_str() {
            "T" | "f64" => InitialForm::Number,
            "SMatrix" | "SVector" => InitialForm::Matrix,
            other => InitialForm::Of(crate::text(other)),
        }
    });
    Ok((layout, reads.collect()))
}

fn functions(shared: &mut Shared<'_>, name: &str) -> Result<Functions, Refused> {
    use at::{GIVEN, MODEL, OUT, STATE, STEP, WORK};
    let program = shared.program;
    let mut lower =
        |ty: &str, function: &str, given: &[usize]| entry(shared, (ty, function), given, at::FIRST);
    let mut where_given =
        |ty: &str, function: &str, given: &[usize]| match program.function(ty, function) {
            Some(_) => lower(ty, function, given).map(Some),
            None => Ok(None),
        };
    let with_solver = where_given(name, "with_solver", &[MODEL, GIVEN])?;
    let compensated = where_given(&format!("{name}Workspace"), "compensated", &[WORK])?;
    let attempt = where_given(name, "attempt", &[MODEL, STATE, STEP])?;
    let kinetic = where_given(name, "kinetic_warning", &[MODEL, STATE])?;
    // Only a model with constraints projects.
    let projecting = match program.function(name, "project") {
        Some(_) => Some(lower::projecting(shared, (name, "begin"), &[MODEL, GIVEN])?),
        None => None,
    };
    let mut lower =
        |function: &str, given: &[usize]| entry(shared, (name, function), given, at::FIRST);
    Ok(Functions {
        new: lower("new", &[GIVEN])?,
        begin: lower("begin", &[MODEL, GIVEN])?,
        projecting,
        with_solver,
        prepared: lower("prepared", &[MODEL, STATE, STEP, GIVEN])?,
        compensated,
        attempt,
        step: lower("step", &[MODEL, STATE, WORK])?,
        observe: lower("observe", &[MODEL, STATE, OUT])?,
        invariants: lower("invariants", &[MODEL, STATE, STEP, WORK, OUT])?,
        scales: lower("scales", &[MODEL, STATE, STEP, OUT])?,
        kinetic,
    })
}
