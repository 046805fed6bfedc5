//! Trajectories of chains as the command runs them: numbers in the order of a card.

use super::card::{Carded, Place};
use super::{LineTrajectory, Numbers, Unstarted};
use crate::text;
use clebsch::card::{Card, Field, OpenError, PartSeen, Settings, Trajectory, chosen_solver};
use clebsch::integrate::{Offer, Way, counted};
use clebsch::kinetic::KineticWarning;
use clebsch::line::LineError;
use clebsch::saved::{Saved, Words};
use clebsch::{ParameterError, StartError, StepCause, StepError};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::print::lowered;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The error of a step with its site.
pub(super) fn cause(e: LineError) -> StepCause {
    match e {
        LineError::Step {
            at, cause, works, ..
        } => StepCause::AtSite {
            at,
            // A run has at most one such error and ends with it.
            cause: Box::leak(Box::new(cause)),
            works,
        },
        LineError::Functional {
            quantity,
            cause,
            works,
            ..
        } => StepCause::Functional {
            quantity,
            cause,
            works,
        },
        _ => StepCause::Unread { what: "a line" },
    }
}

impl Carded {
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
        counted(card, parameters, initial)?;
        chosen_solver(settings, card.solvers)?;
        let way = Way::of(Offer::of(card), settings, card.orders)?;
        self.read(parameters, initial, |numbers| {
            self.started((way, settings), numbers)
        })
    }

    /// Calls `then` with the numbers of parameters and initial values by their names in the program.
    pub(super) fn read<R>(
        &self,
        parameters: &[Vec<f64>],
        initial: &[Vec<f64>],
        then: impl FnOnce(&Numbers<'_>) -> R,
    ) -> R {
        let mut given: BTreeMap<&str, Sites<'_>> = BTreeMap::new();
        let of_tables = [(&self.parameters, parameters), (&self.initial, initial)];
        for (places, lists) in of_tables {
            for (place, list) in places.iter().zip(lists) {
                let own = given.entry(place.key.as_str()).or_default();
                own.push((place.site.unwrap_or(0), list));
            }
        }
        // If an end prescribes an attitude, its parameter is the matrix of a quaternion; the first column is the
        // quaternion.
        let is_quaternion = |all: &Sites<'_>| all.iter().any(|(_, list)| list.len() == 4);
        let held = |list: &Vec<f64>| -> Vec<f64> { list.iter().step_by(4).copied().collect() };
        let read: BTreeMap<&str, Vec<(usize, Vec<f64>)>> = given
            .iter()
            .filter(|(_, all)| is_quaternion(all))
            .map(|(key, all)| {
                let of = |(site, list): &(usize, &Vec<f64>)| match list.len() {
                    16 => (*site, held(list)),
                    _ => (*site, (*list).clone()),
                };
                (*key, all.iter().map(of).collect())
            })
            .collect();
        for (key, all) in &read {
            given.insert(key, all.iter().map(|(site, list)| (*site, list)).collect());
        }
        let numbers = |name: &str| {
            let own = ascii(name);
            if let Some(all) = given.get(own.as_str()) {
                return self.numbers(name, all);
            }
            // If both ends have the parameter, return the value of the end that the name contains.
            let (key, end) = own.rsplit_once('_')?;
            let [first, last] = given.get(key)?.as_slice() else {
                return None;
            };
            let (first, last) = if first.0 < last.0 {
                (first, last)
            } else {
                (last, first)
            };
            match end {
                "0" => Some(first.1.clone()),
                "N" => Some(last.1.clone()),
                _ => None,
            }
        };
        then(&numbers)
    }

    fn started(
        &'static self,
        (way, settings): (Way, Settings),
        numbers: &Numbers<'_>,
    ) -> Result<Box<dyn Trajectory>, OpenError> {
        // The first substep of a composed step is shorter than the whole step.
        let h = match way {
            Way::Composed(order) => order
                .factors()
                .first()
                .map_or(settings.h, |f| settings.h * f),
            Way::Plain | Way::Modified(..) => settings.h,
        };
        let start = |h: f64| match settings.inquiry {
            true => self.model.start_projected(&self.choice, h, numbers),
            false => self.model.start(&self.choice, h, numbers),
        };
        let mut started = start(h);
        // If a substep fails, the whole step fails. The error of the whole step names a step size that succeeds.
        if let (
            Way::Composed(_),
            Err(Unstarted::Line(LineError::Step {
                works: Some(works), ..
            })),
        ) = (&way, &started)
        {
            started = start(*works);
        }
        let started = match way {
            Way::Composed(order) => started.and_then(|line| line.of_order(order, settings.h)),
            Way::Plain | Way::Modified(..) => started,
        };
        let line = started.map_err(|e| self.refused(e))?;
        let sites = |name: &str| self.sites.get(name).copied();
        let kinetic = self.model.kinetic_warning(&self.choice, numbers, sites);
        Ok(Box::new(Running {
            carded: self,
            order: self.order(),
            line: RefCell::new(line),
            kinetic,
        }))
    }

    /// The numbers of a quantity at all sites. If an end prescribes a configuration, its momentum is zero.
    fn numbers(&self, name: &str, all: &Sites<'_>) -> Option<Vec<f64>> {
        let mut all = all.clone();
        all.sort_by_key(|(site, _)| *site);
        let size = all.first().map_or(1, |(_, list)| list.len());
        let whole = self
            .moving_sites(name)
            .filter(|_| name.contains("momentum_"));
        let Some(whole) = whole else {
            return Some(
                all.iter()
                    .flat_map(|(_, list)| list.iter().copied())
                    .collect(),
            );
        };
        let mut out = vec![0.0; whole * size];
        for (site, list) in all {
            let own = out.get_mut(site * size..(site + 1) * size)?;
            for (slot, x) in own.iter_mut().zip(list) {
                *slot = *x;
            }
        }
        Some(out)
    }

    /// How many sites the configuration of a momentum has.
    fn moving_sites(&self, name: &str) -> Option<usize> {
        let (_, of) = name.rsplit_once("momentum_")?;
        self.sites.get(of).copied()
    }

    /// A formula in parameters. Parameters with a value at each site get the number of the site: `s J₅`.
    fn formula_at(&self, formula: &str, site: usize) -> String {
        let mark = lowered(&site.to_string()).unwrap_or_default();
        let (mut out, mut word) = (String::new(), String::new());
        for letter in formula.chars().chain([' ']) {
            if letter.is_alphanumeric() || letter == '_' {
                word.push(letter);
                continue;
            }
            out.push_str(&word);
            if self.sites.contains_key(&ascii(&word)) {
                out.push_str(&mark);
            }
            word.clear();
            out.push(letter);
        }
        out.trim_end().to_owned()
    }

    pub(super) fn refused(&self, e: Unstarted) -> OpenError {
        let at_start = |e: ParameterError| {
            let own = |f: &&Field| f.name == e.field || f.ascii == e.field;
            match self.card.initial.iter().any(|f| own(&f)) {
                true => OpenError::Start(StartError::Initial(e)),
                false => OpenError::Parameter(e),
            }
        };
        match e {
            Unstarted::Line(LineError::Parameter(e)) => at_start(e),
            Unstarted::Line(LineError::Site { at, error }) => at_start(ParameterError {
                field: text(&match error.field == at.quantity {
                    true => format!("{}_{}", at.quantity, at.site),
                    // Name a value computed from parameters by its formula, not by the quantity whose inertia it is.
                    false => self.formula_at(error.field, at.site),
                }),
                ..error
            }),
            Unstarted::Line(LineError::Length {
                quantity,
                expected,
                found,
                ..
            }) => OpenError::Count {
                field: quantity,
                expected,
                found,
            },
            Unstarted::Line(LineError::Count {
                count,
                found,
                least,
            }) => OpenError::Count {
                field: count,
                expected: least,
                found,
            },
            Unstarted::Line(e) => OpenError::Start(StartError::Refused(cause(e))),
            Unstarted::Missing(quantity) => OpenError::Count {
                field: text(&quantity),
                expected: 1,
                found: 0,
            },
            Unstarted::Components {
                quantity,
                components,
                found,
            } => OpenError::Count {
                field: text(&quantity),
                expected: components,
                found,
            },
        }
    }

    /// The index of the observer and the site, for each observable.
    pub(super) fn order(&self) -> Vec<(usize, usize)> {
        let names: Vec<String> = self.model.observers().map(|o| ascii(&o)).collect();
        let place = |p: &Place| {
            let observer = names.iter().position(|n| *n == p.key);
            (observer.unwrap_or(usize::MAX), p.site.unwrap_or(0))
        };
        self.observables.iter().map(place).collect()
    }
}

/// The values at sites, each with its number.
type Sites<'a> = Vec<(usize, &'a Vec<f64>)>;

/// A running trajectory.
struct Running {
    carded: &'static Carded,
    order: Vec<(usize, usize)>,
    line: RefCell<LineTrajectory>,
    kinetic: Option<KineticWarning>,
}

impl Running {
    /// Writes the invariants, or the sums of the sizes of their terms.
    fn sums(&self, line: &mut LineTrajectory, out: &mut [f64], sizes: bool) {
        let mut out = out.iter_mut();
        for invariant in self.carded.card.invariants {
            let values = match (invariant.name, sizes) {
                ("energy", false) => line.energies().map(|[k, p]| vec![k + p]),
                ("energy", true) => line.energy_sizes().map(|[k, p]| vec![k + p]),
                (name, false) => line.total(name),
                (name, true) => line.total_sizes(name),
            };
            let values = values.unwrap_or_default();
            for i in 0..invariant.rows {
                if let Some(slot) = out.next() {
                    *slot = values.get(i).copied().unwrap_or(f64::NAN);
                }
            }
        }
    }
}

/// Writes the observables of a chain, in the order of the card.
fn observed(carded: &Carded, order: &[(usize, usize)], line: &mut LineTrajectory, out: &mut [f64]) {
    let names = carded.model.observers();
    let all: Vec<Vec<f64>> = names
        .map(|name| line.observe(&name).unwrap_or_default())
        .collect();
    let mut out = out.iter_mut();
    for ((observer, site), field) in order.iter().zip(carded.card.observables) {
        let (list, size) = (all.get(*observer), field.count());
        for k in 0..size {
            let x = list.and_then(|l| l.get(site * size + k).copied());
            if let Some(slot) = out.next() {
                *slot = x.unwrap_or(f64::NAN);
            }
        }
    }
}

impl Trajectory for Running {
    fn node(&self) -> u64 {
        self.line.borrow().node()
    }

    fn time(&self) -> f64 {
        let line = self.line.borrow();
        line.h() * line.node() as f64
    }

    fn step(&mut self) -> Result<(), StepError> {
        let line = self.line.get_mut();
        let node = line.node();
        line.step().map_err(|e| cause(e).at_node(node))
    }

    fn step_in_parts(&mut self, seen: &mut PartSeen<'_>) -> Result<(), StepError> {
        let Self {
            carded,
            order,
            line,
            ..
        } = self;
        let none = vec![0.0; carded.card.observable_count()];
        let [mut before, mut after] = [none.clone(), none];
        let line = line.get_mut();
        observed(carded, order, line, &mut before);
        let node = line.node();
        let made = line.step_in_parts(&mut |share, line| {
            observed(carded, order, line, &mut after);
            seen(share, &before, &after);
            std::mem::swap(&mut before, &mut after);
        });
        made.map_err(|e| cause(e).at_node(node))
    }

    fn card(&self) -> &'static Card {
        &self.carded.card
    }

    fn observe(&self, out: &mut [f64]) {
        observed(self.carded, &self.order, &mut self.line.borrow_mut(), out);
    }

    fn kinetic_warning(&self) -> Option<KineticWarning> {
        self.kinetic
    }

    fn invariants(&self, out: &mut [f64]) {
        self.sums(&mut self.line.borrow_mut(), out, false);
    }

    fn scales(&self, out: &mut [f64]) {
        let mut line = self.line.borrow_mut();
        line.measured(|line| self.sums(line, out, true));
    }

    fn operations(&self) -> Option<String> {
        self.carded.model.operations()
    }

    fn words(&mut self, words: &mut Words) {
        self.line.get_mut().words(words);
    }
}
