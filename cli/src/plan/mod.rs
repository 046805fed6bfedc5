//! The plan of a run: a case of the gallery or of a file, with the options that override it.
//! Takes the matches of `clebsch run`; gives the plan, and places error messages in its file.

mod invalid_values;

use crate::case_file::stated::Stated;
use crate::case_file::{self, Located, Motion, undefined};
use crate::models::gallery::{self, Case, Entry};
use crate::named::cases::{CaseText, WhichCase};
use crate::named::resolve::Resolved;
use crate::overrides;
use crate::plan::invalid_values::{Origin, parameter_report};
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clap::ArgMatches;
use clebsch::card::{Card, Field, OpenError, Settings, Trajectory};
use clebsch::integrate::Halved;
use clebsch::solvers::Method;
use clebsch::{ParameterError, StartError};
use clebsch_core::lattice::ChainConfig;
use serde_json::{Value, json};

/// By default, the largest number of nodes written: a plot shows no more, and the files stay at a few
/// megabytes.
const SAMPLES: u64 = 10_000;

/// The time at the last node, for print.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn end(h: f64, steps: u64) -> f64 {
    h * steps as f64
}

/// A run before it starts.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The case, options applied.
    pub case: Case,
    /// The order of a step, if one is requested.
    pub order: Option<u32>,
    /// Every how many nodes the trajectory is written.
    pub every: u64,
    /// The options that determine the results, as given; `null` for missing options.
    pub arguments: Value,
    /// The requested solver.
    pub solver: Option<Method>,
    /// Whether steps with modified moments are compensated.
    pub compensated: bool,
    /// Whether failed steps are subdivided.
    pub halve: bool,
    /// Whether pictures are drawn for a column of a paper.
    pub paper: bool,
    /// Whether samples are written as text regardless of their number.
    pub csv: bool,
    /// The number of sites of a model with labels, and its end conditions.
    pub choice: Option<ChainConfig>,
    /// Whether another step size keeps the end time of the case, rather than the number of steps.
    pub keeps_time: bool,
    /// The names of the quantities that `--set` set.
    set: Vec<String>,
    /// For a case read from a file: its name, and the line of each key.
    origin: Option<Origin>,
    /// The initial velocities, and the configurations at rest.
    pub(crate) motion: Motion,
}

impl Plan {
    /// Reads the case, a name or a file, and applies the options.
    ///
    /// # Errors
    /// Usage: an unknown case, an unreadable or wrong file.
    pub(crate) fn new(resolved: &Resolved<'_>, matches: &ArgMatches) -> Result<Self, Failure> {
        let entry = &*resolved.entry;
        let typed = matches.get_one::<String>("case");
        let every = matches.try_get_one::<u64>("every").ok().flatten().copied();
        let order = matches.get_one::<u32>("order").copied();
        let is_set = |flag: &str| matches.try_get_one::<bool>(flag).ok().flatten() == Some(&true);
        let compensated = matches.get_flag("compensated");
        let halve = matches.get_flag("halve");
        let solver = match matches.get_one::<String>("solver") {
            None => None,
            Some(name) => match name.parse::<Method>() {
                Ok(method) => Some(method),
                Err(_) => {
                    let offered = entry.card.solvers;
                    let error = OpenError::Solver { offered };
                    return Err(Failure::Usage(format!("--solver {}: {error}", shown(name))));
                }
            },
        };
        let size = matches.get_one::<u64>("dim").copied();
        let cards = of_size(entry, size)?;
        let (mut case, origin, choice, mut motion) = match &resolved.case {
            WhichCase::Text(text) => {
                let located = read(text, &cards, true)?;
                let origin = Some((located.file, located.lines));
                (located.case, origin, located.choice, located.motion)
            }
            named => {
                let asked = match named {
                    WhichCase::Named(name) => Some(name.as_str()),
                    _ => None,
                };
                let stated = Stated::read(entry.card.source);
                let choice = stated.as_ref().and_then(case_file::default_choice);
                let case = case_of_size(entry, asked, size)?.clone();
                (case, None, choice, Motion::default())
            }
        };
        let card = entry.card_of(&case);
        let h = case.h;
        let text = resolved.case.text().map(|case| case.text.as_str());
        let set = overrides::apply(&mut case, &mut motion, &card, text, matches)?;
        if case.steps == 0 {
            return Err(case_file::no_steps(
                origin.as_ref().map_or("", |(file, _)| file.as_str()),
            ));
        }
        if !set.is_empty() || h.to_bits() != case.h.to_bits() {
            start(&mut motion, &card, choice.as_ref(), &mut case)?;
        }
        let steps = matches.get_one::<u64>("steps").copied();
        Ok(Self {
            every: every.unwrap_or_else(|| Self::default_every(case.steps)),
            case,
            order,
            arguments: json!({
                "model": matches.get_one::<String>("model").map_or(entry.card.kebab, String::as_str),
                "case": typed,
                "steps": steps,
                "until": overrides::until(matches),
                "h": matches.get_one::<f64>("h"),
                "set": overrides::set(matches).collect::<Vec<_>>(),
                "order": order,
                "every": every,
                "solver": solver.map(Method::name),
                "compensated": compensated,
                "halve": halve,
                "dim": size,
            }),
            solver,
            compensated,
            halve,
            paper: is_set("paper"),
            csv: is_set("csv"),
            choice,
            keeps_time: steps.is_none(),
            set,
            origin,
            motion,
        })
    }

    /// The case of a text, without options. `has_sites` is true if the model has labels.
    ///
    /// # Errors
    /// Usage: a mistake in the case.
    pub(crate) fn of_text(
        entry: &Entry,
        case: &CaseText,
        has_sites: bool,
    ) -> Result<Self, Failure> {
        let located = read(case, &entry.cards(), has_sites)?;
        Ok(Self {
            choice: located.choice,
            origin: Some((located.file, located.lines)),
            motion: located.motion,
            ..Self::of(&located.case, 1)
        })
    }

    /// The default of `every` for this number of steps.
    pub(crate) fn default_every(steps: u64) -> u64 {
        steps.div_ceil(SAMPLES).max(1)
    }

    /// The case with another step size, up to the same time unless the number of steps is requested.
    #[must_use]
    pub fn with_step(mut self, h: f64) -> Self {
        let time = end(self.case.h, self.case.steps);
        self.case.h = h;
        if self.keeps_time {
            self.case.steps = overrides::steps_to(time, h).unwrap_or(self.case.steps);
        }
        self
    }

    /// The case without options, with every `every`-th node recorded.
    #[must_use]
    pub fn of(case: &Case, every: u64) -> Self {
        Self {
            case: case.clone(),
            order: None,
            every: every.max(1),
            arguments: Value::Null,
            solver: None,
            compensated: false,
            halve: false,
            paper: false,
            csv: false,
            choice: None,
            keeps_time: true,
            set: Vec::new(),
            origin: None,
            motion: Motion::default(),
        }
    }

    /// Computes momenta from velocities again, after a change of parameters or of the configuration.
    ///
    /// # Errors
    /// Usage: there are no momenta for these velocities.
    pub(crate) fn start_anew(&mut self, card: &Card) -> Result<(), Failure> {
        start(&mut self.motion, card, self.choice.as_ref(), &mut self.case)
    }

    /// The lines about momenta that were computed from velocities.
    pub(crate) fn starts(&self, card: &Card) -> Vec<String> {
        self.motion.momentum_lines(card, &self.case)
    }

    /// Starts the trajectory.
    ///
    /// # Errors
    /// Usage: the model rejects the data; the message has their file and line, if any. Failed: the data are
    /// valid, but the solver fails in the first step.
    pub fn open(&self, card: &Card) -> Result<Box<dyn Trajectory>, Failure> {
        let Case {
            parameters,
            initial,
            h,
            ..
        } = &self.case;
        let settings = Settings {
            order: self.order,
            solver: self.solver,
            compensated: self.compensated,
            ..Settings::step(*h)
        };
        let opened = match self.halve {
            true => Halved::open(card, parameters, initial, settings)
                .map(|t| Box::new(t) as Box<dyn Trajectory>),
            false => (card.open)(parameters, initial, settings),
        };
        opened.map_err(|error| match error {
            OpenError::Parameter(wrong) | OpenError::Start(StartError::Initial(wrong)) => {
                let place = self.place(card, &wrong);
                let sample = self.sample().unwrap_or_default();
                Failure::Usage(format!(
                    "{place}: {}; {}{sample}",
                    wrong.problem, wrong.remedy
                ))
            }
            OpenError::Start(StartError::Refused(cause)) => {
                let undefined = cause
                    .is_not_finite()
                    .then(|| undefined(card, self.choice.as_ref(), &self.case));
                Failure::Failed(match undefined.flatten() {
                    Some(found) => format!(
                        "cannot take the first step: {found}; change the initial values or parameters at that point"
                    ),
                    None => format!("cannot take the first step: {cause}"),
                })
            }
            OpenError::Kinetic { .. } => Failure::Failed(error.to_string()),
            OpenError::Solver { .. } => {
                let name = self.solver.map_or("", Method::name);
                Failure::Usage(format!("--solver {}: {error}", shown(name)))
            }
            OpenError::Compensation { .. } => Failure::Usage(format!("--compensated: {error}")),
            OpenError::Unseen { .. } => Failure::Usage(format!("--halve: {error}")),
            _ => Failure::Usage(error.to_string()),
        })
    }

    /// If a model file runs with placeholder values, the advice on how to give other values.
    fn sample(&self) -> Option<String> {
        let model = self.arguments.get("model")?.as_str()?;
        let is_sample = self.origin.is_none() && self.case.name == "sample";
        is_sample.then(|| {
            let model = shown(model);
            format!(
                "; these are sample values: save them with `clebsch case {model} > my.toml`, edit them, and run with `--case \
                 my.toml`"
            )
        })
    }

    /// The location of the wrong value: `top.toml:7: parameters.J`. A value computed from parameters is reported by
    /// these parameters.
    fn place(&self, card: &Card, wrong: &ParameterError) -> String {
        if wrong.field == "h" && self.arguments.get("h").is_some_and(Value::is_number) {
            return "--h".to_owned();
        }
        let is_set = |name: &&String| name.split('.').next() == Some(wrong.field);
        if let Some(name) = self.set.iter().find(is_set) {
            return format!("--set {}", shown(name));
        }
        let of = |table: &str, fields: &[Field]| {
            let named = |field: &&Field| field.name == wrong.field || field.ascii == wrong.field;
            let field = fields.iter().find(named)?;
            Some(format!("{table}.{}", field.ascii))
        };
        // A case may give a value prescribed at an end among the initial values.
        let lines = self.origin.as_ref().map(|(_, lines)| lines);
        let among_initial = |key: &String| lines.is_some_and(|l| l.contains_key(key));
        let held = of("initial", card.parameters).filter(among_initial);
        let key = held
            .or_else(|| of("parameters", card.parameters))
            .or_else(|| of("initial", card.initial));
        let made = || parameter_report(card, &self.case, self.origin.as_ref(), wrong.field);
        if let Some(place) = key.is_none().then(made).flatten() {
            return place;
        }
        let key = key.unwrap_or_else(|| wrong.field.to_owned());
        // A momentum that was computed from a velocity is reported under the key of the velocity.
        let momentum = key.strip_prefix("initial.");
        let at = momentum.and_then(|own| card.initial.iter().position(|f| f.ascii == own));
        let velocity = at.and_then(|at| self.motion.key_of(at));
        let named = velocity.map_or_else(|| key.clone(), |own| format!("initial.{own}"));
        match &self.origin {
            None => format!("case `{}`: {named}", shown(&self.case.name)),
            Some((file, lines)) => match case_file::line_of(lines, &key) {
                Some(line) => format!("{}:{line}: {named}", shown(file)),
                None => format!("{}: {named}", shown(file)),
            },
        }
    }
}

/// Computes the momenta of a case from its velocities.
fn start(
    motion: &mut Motion,
    card: &Card,
    choice: Option<&ChainConfig>,
    case: &mut Case,
) -> Result<(), Failure> {
    let put = motion.put(card, choice, case);
    put.map_err(|wrong| Failure::Usage(format!("initial.{}: {}", wrong.key, wrong.why)))
}

/// Reads the case of a file with the first card whose fields match it. If no card fits, the error for the first card
/// is returned. If `may_have_sites` is true, the labels of the model are read from its text.
fn read(case: &CaseText, cards: &[Card], may_have_sites: bool) -> Result<Located, Failure> {
    let CaseText { file, text } = case;
    let mut first = None;
    for card in cards {
        let stated = may_have_sites.then(|| Stated::read(card.source));
        let stated = stated.flatten();
        match case_file::read_of(file, text, card, stated.as_ref()) {
            Ok(located) => return Ok(located),
            Err(error) => first = first.or(Some(error)),
        }
    }
    Err(first.unwrap_or_else(|| Failure::Usage(format!("{}: the model has no card", shown(file)))))
}

/// The cards of the model: all cards, or the cards with this size.
fn of_size(entry: &Entry, size: Option<u64>) -> Result<Vec<Card>, Failure> {
    let cards = entry.cards();
    let Some(size) = size else { return Ok(cards) };
    let has = |card: &&Card| card.dimensions.iter().any(|d| d.value as u64 == size);
    let fitting: Vec<Card> = cards.iter().filter(has).copied().collect();
    if fitting.is_empty() {
        let model = entry.card.kebab;
        let dimensions = entry.card.dimensions.iter();
        let admitted: Vec<String> = dimensions
            .map(|d| format!("{} from {} to {}", d.name, d.from, d.to))
            .collect();
        return Err(Failure::Usage(match admitted.is_empty() {
            true => format!("--dim {size}: the matrices of `{model}` have a fixed size"),
            false => format!("--dim {size}: `{model}` takes {}", admitted.join(", ")),
        }));
    }
    Ok(fitting)
}

/// The requested case; without a name, the first case of the requested size.
fn case_of_size<'a>(
    entry: &'a Entry,
    asked: Option<&str>,
    size: Option<u64>,
) -> Result<&'a Case, Failure> {
    let has = |case: &&Case| {
        let card = entry.card_of(case);
        size.is_none_or(|n| card.dimensions.iter().any(|d| d.value as u64 == n))
    };
    match (asked, size) {
        (None, Some(n)) => entry.cases.iter().find(has).ok_or_else(|| {
            Failure::Usage(format!(
                "--dim {n}: the model has no case of that size; give one with --case FILE.toml"
            ))
        }),
        (Some(name), Some(n)) => match gallery::case(entry, asked)? {
            case if has(&case) => Ok(case),
            _ => Err(Failure::Usage(format!(
                "--dim {n}: case `{}` has another size",
                shown(name)
            ))),
        },
        (_, None) => gallery::case(entry, asked),
    }
}
