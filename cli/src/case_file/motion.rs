//! The initial motion of a case without momenta: velocities, or rest. Takes the velocities by the fields of a
//! card; computes the momenta from the action and stores them in the case.

mod extreme;

use super::keys::at_site;
use super::velocity::{Way, momentum_of, suffix};
use crate::models::fields::is_momentum;
use crate::models::gallery::Case;
use crate::words::number::short;
use clebsch::card::{Card, Field, Kind};
use clebsch_check::{
    Legendre, NoMomentum, Setup, Stated, Undefined, Velocities, Velocity, onto_constraints,
};
use clebsch_core::lattice::ChainConfig;
use clebsch_core::pipeline;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// The largest number of momenta at rest that are reported.
const MOST_TOLD: usize = 4;

/// A velocity that the case gives.
#[derive(Clone, Debug)]
pub(super) struct Start {
    /// The index of the momentum's field.
    pub momentum: usize,
    pub way: Way,
    /// The key as the case has it.
    pub key: String,
    pub line: usize,
    pub numbers: Vec<f64>,
}

/// How the configurations without a given momentum start.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motion {
    pub(super) given: Vec<Start>,
    /// The indices of the momenta whose configurations start at rest.
    pub(super) resting: Vec<usize>,
    /// The report, if a configuration was moved onto its constraints.
    onto: Option<String>,
}

/// A velocity that cannot be used, with the reason.
pub(crate) struct Wrong {
    pub key: String,
    pub line: usize,
    pub why: String,
}

impl Motion {
    /// Whether every momentum is given.
    pub(crate) fn is_empty(&self) -> bool {
        self.given.is_empty() && self.resting.is_empty()
    }

    /// Moves the configuration of a case onto its constraints, if it satisfies them to eight digits, and computes the
    /// momenta of the case from its parameters and configuration.
    pub(crate) fn put(
        &mut self,
        card: &Card,
        choice: Option<&ChainConfig>,
        case: &mut Case,
    ) -> Result<(), Wrong> {
        if let Some(told) = onto(card, choice, case) {
            self.onto = Some(told);
        }
        if self.is_empty() {
            return Ok(());
        }
        for at in &self.resting {
            let count = card.initial.get(*at).map_or(0, Field::count);
            if let Some(own) = case.initial.get_mut(*at) {
                *own = vec![0.0; count];
            }
        }
        match self.momenta(card, choice, case) {
            Ok(found) => {
                for (at, numbers) in found {
                    if let Some(own) = case.initial.get_mut(at) {
                        *own = numbers;
                    }
                }
                Ok(())
            }
            // A configuration at rest has momentum zero, unless the action has terms linear in velocities.
            Err(_) if self.given.is_empty() => Ok(()),
            Err(why) => {
                let is_lost = matches!(why, NoMomentum::Lost(_) | NoMomentum::NoLimit);
                let extreme = is_lost.then(|| self.extreme(card, choice, case)).flatten();
                let zero = match &why {
                    NoMomentum::Lost(name) => self.zero(card, choice, case, name),
                    _ => None,
                };
                let mut wrong = self.wrong(card, why, zero);
                if let Some(extreme) = extreme {
                    wrong.why = extreme;
                }
                Err(wrong)
            }
        }
    }

    fn momenta(
        &self,
        card: &Card,
        choice: Option<&ChainConfig>,
        case: &Case,
    ) -> Result<Vec<(usize, Vec<f64>)>, NoMomentum> {
        let elements = elements(card.initial);
        let element = |momentum: usize| {
            let at = elements.get(&momentum)?;
            card.initial.get(*at)
        };
        let mut velocities = Velocities::new();
        for start in &self.given {
            if let Some(own) = element(start.momentum) {
                let velocity: &mut Velocity = velocities.entry(own.name.to_owned()).or_default();
                start.way.add(own, &start.numbers, velocity);
            }
        }
        let free: BTreeSet<usize> = self.all_momenta().collect();
        let known: Vec<String> = elements
            .keys()
            .filter(|at| !free.contains(at))
            .filter_map(|at| Some(element(*at)?.name.to_owned()))
            .collect();
        let legendre = legendre(card, choice, case)?;
        let node: Vec<f64> = case.initial.iter().flatten().copied().collect();
        let found = legendre.momenta(&node, &velocities, &known)?;
        let found: HashMap<String, Vec<f64>> =
            found.into_iter().map(|m| (m.name, m.components)).collect();
        let each = free.into_iter().filter_map(|at| {
            let own = element(at)?;
            let components = found.get(own.name)?;
            Some((at, momentum_of(own, card.initial.get(at)?, components)))
        });
        Ok(each.collect())
    }

    /// The momenta that the case does not give.
    fn all_momenta(&self) -> impl Iterator<Item = usize> {
        let given = self.given.iter().map(|start| start.momentum);
        given.chain(self.resting.iter().copied())
    }

    /// The parameter that is 0 and thereby removes the kinetic energy of a configuration.
    fn zero(
        &self,
        card: &Card,
        choice: Option<&ChainConfig>,
        case: &Case,
        lost: &str,
    ) -> Option<&'static str> {
        let all = card.parameters.iter().zip(&case.parameters).enumerate();
        let mut zero = all.filter(|(_, (_, own))| own.iter().all(|x| *x == 0.0));
        zero.find_map(|(at, (field, _))| {
            let mut other = case.clone();
            for (k, x) in other.parameters.get_mut(at)?.iter_mut().enumerate() {
                let on_diagonal = field.cols <= 1 || k / field.cols == k % field.cols;
                *x = f64::from(u8::from(on_diagonal));
            }
            let found = self.momenta(card, choice, &other);
            let still = matches!(&found, Err(NoMomentum::Lost(name)) if name == lost);
            (!still).then_some(field.ascii)
        })
    }

    fn wrong(&self, card: &Card, why: NoMomentum, zero: Option<&str>) -> Wrong {
        let named = |name: &str| {
            let elements = elements(card.initial);
            let own = |start: &&Start| {
                let at = elements.get(&start.momentum);
                at.and_then(|at| card.initial.get(*at))
                    .is_some_and(|f| f.name == name)
            };
            self.given.iter().find(own)
        };
        let first = match &why {
            NoMomentum::Coupled(name, _) | NoMomentum::Lost(name) => named(name),
            _ => None,
        };
        let start = first.or_else(|| self.given.first());
        let momentum = start.and_then(|s| card.initial.get(s.momentum));
        let momentum = momentum.map_or("the momentum", |f| f.ascii);
        let why = match why {
            NoMomentum::Unread(why) => {
                format!(
                    "clebsch cannot evaluate the action of this model ({why}); give `{momentum}`"
                )
            }
            NoMomentum::NoLimit => format!(
                "the action of this model has no limit of small steps, so a velocity gives no momentum; give `{momentum}`"
            ),
            NoMomentum::Across(hold, site, rate) => {
                let site = site.map_or_else(String::new, |s| format!(" at site {s}"));
                format!(
                    "the velocities violate the constraint `{hold}`{site}: its left side minus its right side changes at the \
                     rate {}. Give velocities for which this rate is zero",
                    short(rate)
                )
            }
            NoMomentum::Lost(name) => match zero {
                Some(zero) => format!(
                    "the momentum does not depend on this velocity, because the parameter `{zero}` of the kinetic energy is 0; \
                     give `{zero}` another value"
                ),
                None => lost(card, &name, momentum),
            },
            NoMomentum::Coupled(_, other) => format!(
                "the momentum also depends on the velocity of `{other}`, but the case gives its momentum; give both velocities \
                 or both momenta"
            ),
        };
        Wrong {
            key: start.map_or_else(String::new, |s| s.key.clone()),
            line: start.map_or(0, |s| s.line),
            why,
        }
    }

    /// The indices of the velocities that a case gives under a name, at one site or at all sites, and the field
    /// of one of them.
    pub(crate) fn named(&self, name: &str, card: &Card) -> Option<(Vec<usize>, Field)> {
        let of = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
            let all = self.given.iter().enumerate();
            all.filter(|(_, start)| is(&start.key))
                .map(|(at, _)| at)
                .collect()
        };
        let mut own = of(&|key| key == name);
        if own.is_empty() {
            own = of(&|key| quantity(key) == name);
        }
        let first = self.given.get(*own.first()?)?;
        let momentum = card.initial.get(first.momentum)?;
        let elements = elements(card.initial);
        let element = card.initial.get(*elements.get(&first.momentum)?)?;
        Some((own, first.way.field(element, momentum)))
    }

    /// The key of the velocity that gives a momentum.
    pub(crate) fn key_of(&self, momentum: usize) -> Option<&str> {
        let own = self.given.iter().find(|start| start.momentum == momentum);
        own.map(|start| start.key.as_str())
    }

    /// Replaces the momentum that the case gives by a velocity. `None` if `name` is not the key of a velocity,
    /// or if the case already gives this velocity.
    pub(crate) fn give(
        &mut self,
        name: &str,
        card: &Card,
        numbers: &[f64],
    ) -> Option<Result<(), String>> {
        if self.named(name, card).is_some() {
            return None;
        }
        let found = velocities(name, card);
        let (.., count) = found.first()?;
        if *count != numbers.len() {
            return Some(Err(format!(
                "the case gives the momentum instead of this velocity, which has {count} numbers; give all of them, separated by commas"
            )));
        }
        for (momentum, way, key, _) in found {
            self.given
                .retain(|start| start.momentum != momentum || is_beside(start.way, way));
            self.gives(momentum);
            self.given.push(Start {
                momentum,
                way,
                key,
                line: 0,
                numbers: numbers.to_vec(),
            });
        }
        Some(Ok(()))
    }

    /// Sets an entry of a velocity.
    pub(crate) fn set(&mut self, velocity: usize, entry: usize, value: f64) {
        let own = self.given.get_mut(velocity);
        if let Some(x) = own.and_then(|start| start.numbers.get_mut(entry)) {
            *x = value;
        }
    }

    /// Records that a momentum is given.
    pub(crate) fn gives(&mut self, momentum: usize) {
        self.resting.retain(|at| *at != momentum);
    }

    /// The lines about momenta that a run prints.
    pub(crate) fn momentum_lines(&self, card: &Card, case: &Case) -> Vec<String> {
        let mut out: Vec<QuantityMomenta<'_>> = Vec::new();
        for start in &self.given {
            let Some(field) = card.initial.get(start.momentum) else {
                continue;
            };
            let (name, key) = (quantity(field.ascii), quantity(&start.key));
            match out.iter_mut().find(|told| told.name == name) {
                Some(told) => {
                    told.momenta.insert(start.momentum);
                    if !told.keys.contains(&key) {
                        told.keys.push(key);
                    }
                }
                None => out.push(QuantityMomenta {
                    name,
                    keys: vec![key],
                    momenta: BTreeSet::from([start.momentum]),
                }),
            }
        }
        let is_zero = |at: &usize| {
            case.initial
                .get(*at)
                .is_some_and(|own| own.iter().all(|x| *x == 0.0))
        };
        let mut zero: Vec<&str> = self
            .resting
            .iter()
            .filter(|at| is_zero(at))
            .filter_map(|at| Some(quantity(card.initial.get(*at)?.ascii)))
            .collect();
        zero.dedup();
        let zero = zero.into_iter().map(|name| {
            format!("initial {name} is zero: the case gives neither this momentum nor a velocity")
        });
        let zero: Vec<String> = zero.collect();
        let lines = out.into_iter().map(|told| {
            let value = match (told.momenta.len(), told.momenta.first()) {
                (1, Some(at)) => {
                    let numbers = case.initial.get(*at).map(Vec::as_slice);
                    format!(": {}", list(numbers.unwrap_or_default()))
                }
                (count, _) => format!(" ({count} momenta)"),
            };
            format!(
                "initial {} from {}{value}",
                told.name,
                told.keys.join(" and ")
            )
        });
        let resting = self.resting.iter().filter_map(|at| {
            let numbers = case.initial.get(*at)?;
            let moves = numbers.iter().any(|x| *x != 0.0);
            // Only nonzero momenta are listed here; the lines about zero momenta are above.
            let field = card.initial.get(*at).filter(|_| moves)?;
            Some(format!(
                "initial {} of rest: {}",
                field.ascii,
                list(numbers)
            ))
        });
        let onto = self.onto.iter().cloned();
        onto.chain(lines)
            .chain(zero)
            .chain(resting.take(MOST_TOLD))
            .collect()
    }
}

/// The message for a velocity on which its momentum does not depend.
fn lost(card: &Card, name: &str, momentum: &str) -> String {
    let own = card.initial.iter().find(|f| f.name == name);
    let quantity = quantity(own.map_or(name, |f| f.ascii));
    let example = own
        .filter(|f| matches!(f.kind, Kind::Scalar | Kind::Vector))
        .map(|f| {
            let square = match f.count() {
                1 => format!("(next({quantity}) - {quantity})^2"),
                _ => format!("dot(next({quantity}) - {quantity}, next({quantity}) - {quantity})"),
            };
            format!(", as in `m*{square}/(2*h)`")
        });
    format!(
        "no momentum depends on this velocity: for these parameters the Lagrangian has no kinetic energy of `{quantity}`. \
         Divide its kinetic energy by the step once{}, or give `{momentum}`",
        example.unwrap_or_default()
    )
}

/// The velocities that a key names. For each: the momentum that it replaces, its key with the site, and its
/// number of entries.
fn velocities(name: &str, card: &Card) -> Vec<(usize, Way, String, usize)> {
    let mut places: Vec<(usize, usize)> = elements(card.initial).into_iter().collect();
    places.sort_unstable();
    let mut found = Vec::new();
    for (momentum, element) in places {
        let (Some(own), Some(of)) = (card.initial.get(momentum), card.initial.get(element)) else {
            continue;
        };
        for way in Way::ALL.into_iter().filter(|way| way.is_of(of, own)) {
            let key = way.key(own.ascii).unwrap_or_default();
            if key == name || quantity(&key) == name {
                found.push((momentum, way, key, way.field(of, own).count()));
            }
        }
    }
    found
}

/// Whether a key names a velocity of the model.
pub(crate) fn is_velocity(name: &str, card: &Card) -> bool {
    !velocities(name, card).is_empty()
}

/// The keys of all velocities of a model, without sites.
pub(crate) fn velocity_keys(card: &Card) -> Vec<String> {
    let mut places: Vec<(usize, usize)> = elements(card.initial).into_iter().collect();
    places.sort_unstable();
    let mut known: HashSet<(&str, Way)> = HashSet::new();
    let mut keys = Vec::new();
    for (momentum, element) in places {
        let (Some(own), Some(of)) = (card.initial.get(momentum), card.initial.get(element)) else {
            continue;
        };
        let ways = Way::ALL.into_iter().filter(|way| way.is_of(of, own));
        for way in ways.filter(|way| known.insert((quantity(own.ascii), *way))) {
            keys.extend(way.key(quantity(own.ascii)));
        }
    }
    keys
}

/// Whether a configuration has both velocities: a rigid motion has the rate of its position and an angular
/// velocity.
fn is_beside(a: Way, b: Way) -> bool {
    (a == Way::Rate) != (b == Way::Rate)
}

/// The momenta of one quantity.
struct QuantityMomenta<'a> {
    name: &'a str,
    /// The keys that give its velocities.
    keys: Vec<&'a str>,
    momenta: BTreeSet<usize>,
}

/// The key of a quantity without its site.
fn quantity(key: &str) -> &str {
    at_site(key).map_or(key, |(quantity, _)| quantity)
}

fn list(numbers: &[f64]) -> String {
    let short = |x: &f64| {
        let rounded = format!("{x:.7e}").parse::<f64>().unwrap_or(*x);
        match rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) {
            true => format!("{rounded}"),
            false => format!("{rounded:e}"),
        }
    };
    match numbers {
        [x] => short(x),
        all => format!("({})", all.iter().map(short).collect::<Vec<_>>().join(", ")),
    }
}

/// The configuration of each momentum, as indices of fields.
pub(super) fn elements(fields: &[Field]) -> HashMap<usize, usize> {
    let places: HashMap<&str, usize> = fields
        .iter()
        .enumerate()
        .map(|(at, field)| (field.ascii, at))
        .collect();
    let each = fields.iter().enumerate().filter_map(|(at, field)| {
        if !is_momentum(field) {
            return None;
        }
        let own = match suffix(field.ascii)? {
            // There is one configuration, before its momentum.
            "" => at.checked_sub(1)?,
            name => *places.get(name.strip_prefix('_')?)?,
        };
        Some((at, own))
    });
    each.collect()
}

/// The statement of the model of a case, and the data of the case with these fields as state.
///
/// # Errors
/// Why the statement cannot be evaluated.
pub(crate) fn statement(
    card: &Card,
    choice: Option<&ChainConfig>,
    case: &Case,
    state: &[Field],
) -> Result<(Arc<Stated>, Setup), String> {
    let stated = stated(card)?;
    let fields = card.parameters.iter().map(|f| (f.name, f.rows, f.cols));
    let parameters = fields.zip(case.parameters.iter().map(Vec::as_slice));
    let state = state.iter().map(|f| (f.name, f.rows, f.cols));
    let mut setup = Setup::new(case.h, parameters, state);
    if let Some(choice) = choice {
        setup.counts.clone_from(&choice.counts);
        (setup.periodic, setup.ends) = (choice.periodic, choice.ends);
    }
    Ok((stated, setup))
}

/// The sizes of a model by name.
type Sizes = Vec<(String, usize)>;

/// A text with its sizes, and its statement or the reason why it cannot be evaluated.
type Read = (&'static str, Sizes, Result<Arc<Stated>, String>);

thread_local! {
    /// The statement that this thread read last. All cases of a sweep have the same model.
    static READ: RefCell<Option<Read>> = const { RefCell::new(None) };
}

/// The statement of a card's text.
fn stated(card: &Card) -> Result<Arc<Stated>, String> {
    let sizes = card.dimensions.iter();
    let sizes: Sizes = sizes.map(|d| (d.name.to_owned(), d.value)).collect();
    let known = READ.with_borrow(|last| {
        let is_own = |(text, own, _): &&Read| std::ptr::eq(*text, card.source) && *own == sizes;
        last.as_ref()
            .filter(is_own)
            .map(|(.., found)| found.clone())
    });
    if let Some(found) = known {
        return found;
    }
    let model = pipeline::parse_source(card.source);
    let model = model.map_err(|_| "the text of the model is not available".to_owned());
    let found = model.and_then(|model| Ok(Arc::new(Stated::read(&model, &sizes)?)));
    READ.set(Some((card.source, sizes, found.clone())));
    found
}

/// The Legendre transform of a case, which evaluates its action.
fn legendre(card: &Card, choice: Option<&ChainConfig>, case: &Case) -> Result<Legendre, String> {
    let (stated, setup) = statement(card, choice, case, card.initial)?;
    Ok(Legendre::new(stated, setup))
}

/// Moves a configuration onto its constraints if its digits were rounded too far to satisfy them. Returns the
/// report.
fn onto(card: &Card, choice: Option<&ChainConfig>, case: &mut Case) -> Option<String> {
    // Cases of models without constraints are not evaluated.
    if !card.source.contains("hold") {
        return None;
    }
    let (stated, setup) = statement(card, choice, case, card.initial).ok()?;
    let node: Vec<f64> = case.initial.iter().flatten().copied().collect();
    let moved = onto_constraints(&stated, &setup, &node).ok()??;
    let mut numbers = moved.node.into_iter();
    for own in &mut case.initial {
        for (x, found) in own.iter_mut().zip(numbers.by_ref()) {
            *x = found;
        }
    }
    Some(format!(
        "the initial configuration was moved onto its constraints, by at most {:.1e}: `{}` was violated by {:.1e}",
        moved.by, moved.name, moved.off
    ))
}

/// The part of the action that is undefined at the start, if it can be found.
pub(crate) fn undefined(
    card: &Card,
    choice: Option<&ChainConfig>,
    case: &Case,
) -> Option<Undefined> {
    let (stated, setup) = statement(card, choice, case, card.initial).ok()?;
    let node: Vec<f64> = case.initial.iter().flatten().copied().collect();
    Undefined::find(&stated, &setup, &node).ok()?
}
