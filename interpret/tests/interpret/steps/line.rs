//! A model with labels from the table, for several numbers of sites and ends.

use super::judge;
use super::judge::{Found, Wrong};
use super::quantity::{At, Draw, Quantity, Sites, What};
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::LineModel;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::pair::Pair;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::step::compare::Off;
use clebsch_oracle::oracle::step::{Action, Block, Motion, Problem, Table};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A model.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub text: &'static str,
    pub action: Action,
    pub given: &'static [Quantity],
    pub moving: &'static [Quantity],
    /// The quantities that a pinned end prescribes.
    pub pinned: &'static [&'static str],
    pub sites: &'static [Sites],
    /// The largest distance of sites whose velocities appear in one term.
    pub reach: usize,
    /// The number of failed steps, and the known deviations beyond the bound.
    pub refused: usize,
    pub known: Option<f64>,
}

/// Numbers by the names of quantities.
type Numbers = BTreeMap<String, Vec<f64>>;

fn choice(source: &str, (n, ends): Sites) -> ChainConfig {
    let model = pipeline::parse_source(source).expect("is a model");
    let lattice = Lattice::read(&model).expect("has labels");
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", n).expect("has sites");
    match ends {
        None => choice.with_ring(&lattice).expect("closes"),
        Some([first, last]) => {
            let choice = choice.with_end(&lattice, false, first).expect("begins so");
            choice.with_end(&lattice, true, last).expect("ends so")
        }
    }
}

impl Line {
    #[must_use]
    pub fn name(&self) -> &'static str {
        let mut words = self.text.split_whitespace();
        words.find(|w| *w == "model");
        words.next().unwrap_or("")
    }

    /// Whether an end condition prescribes this quantity at this site.
    fn is_held(&self, name: &str, at: At, site: usize, sites: Sites) -> bool {
        let Some([first, last]) = sites.1 else {
            return false;
        };
        let by = |end: &str, there: usize| end == "pinned" && site == there;
        let held = by(first, 0) || by(last, at.count(sites) - 1);
        self.pinned.contains(&name) && held
    }

    fn drawn(&self, draw: &Draw, source: &mut Source) -> Numbers {
        let mut out = Numbers::new();
        for (name, at, what) in self.given {
            let each = (0..at.count(draw.sites)).flat_map(|_| what.drawn(draw, source));
            out.insert((*name).to_owned(), each.collect());
        }
        for (name, at, what) in self.moving {
            let count = at.count(draw.sites);
            let each = (0..count).flat_map(|_| what.drawn(draw, source));
            out.insert((*name).to_owned(), each.collect());
            let (size, prefix) = what.momentum();
            let each = (0..count * size).map(|_| source.between(-1.0, 1.0) * draw.momentum);
            out.insert(format!("{prefix}{name}"), each.collect());
        }
        out
    }

    fn problem(&self, draw: &Draw, numbers: &Numbers) -> Problem {
        let (mut names, mut moving) = (Table::default(), Table::default());
        let exact = |list: &[f64]| list.iter().map(|x| Pair::constant(*x)).collect::<Vec<_>>();
        // The number of segments, and whether they form a ring; these are not data of the model.
        names.push("N", 1, [1, 1]);
        names.push("ring", 1, [1, 1]);
        let is_ring = f64::from(u8::from(draw.sites.1.is_none()));
        let mut given = exact(&[draw.sites.0 as f64, is_ring]);
        for (name, at, what) in self.given {
            names.push(name, at.count(draw.sites), what.shape());
            given.extend(exact(&numbers[*name]));
        }
        let (mut blocks, mut momenta) = (Vec::new(), Vec::new());
        let (mut told, mut start) = (Vec::new(), Vec::new());
        for (name, at, what) in self.moving {
            let count = at.count(draw.sites);
            let [rows, cols] = what.shape();
            let from = moving.count;
            moving.push(name, count, [rows, cols]);
            let (size, prefix) = what.momentum();
            let own = &numbers[&format!("{prefix}{name}")];
            for site in 0..count {
                let width = what.numbers();
                let [as_told, exactly] =
                    what.values(&numbers[*name][site * width..(site + 1) * width]);
                told.extend(as_told);
                start.extend(exactly);
                let held = self.is_held(name, *at, site, draw.sites);
                if !held {
                    momenta.extend(exact(&own[site * size..(site + 1) * size]));
                }
                blocks.push(Block {
                    site,
                    at: from + site * rows * cols,
                    rows,
                    cols,
                    motion: if held { Motion::Fixed } else { what.motion() },
                });
            }
        }
        Problem {
            action: self.action,
            h: draw.h,
            names,
            given,
            moving,
            blocks,
            told,
            start,
            momenta,
            reach: Some((self.reach, draw.sites.1.is_none().then_some(draw.sites.0))),
        }
    }

    /// One step of the model by loops over sites: moving quantities and momenta, in the form of the oracle.
    fn stepped(
        &self,
        model: &Arc<LineModel>,
        draw: &Draw,
        numbers: &Numbers,
    ) -> Result<(Vec<Pair>, Vec<f64>), String> {
        let choice = choice(self.text, draw.sites);
        let started = model.start(&choice, draw.h, &|name| numbers.get(name).cloned());
        let mut line = started.map_err(|e| e.to_string())?;
        line.step().map_err(|e| e.to_string())?;
        let (mut head, mut momenta) = (Vec::new(), Vec::new());
        for (name, at, what) in self.moving {
            let places = line.observe(name).ok_or("is not shown")?;
            let (size, prefix) = what.momentum();
            let own = line
                .observe(&format!("{prefix}{name}"))
                .ok_or("shows no momentum")?;
            let width = what.numbers();
            for site in 0..at.count(draw.sites) {
                let [as_told, _] = what.values(&places[site * width..(site + 1) * width]);
                head.extend(as_told);
                if !self.is_held(name, *at, site, draw.sites) {
                    momenta.extend(&own[site * size..(site + 1) * size]);
                }
            }
        }
        Ok((head, momenta))
    }

    /// Judges all numbers of sites and ends.
    #[must_use]
    pub fn judged(&self) -> Found {
        let mut found = Found::default();
        let model = match LineModel::read(self.text) {
            Ok(model) => model,
            Err(refused) => {
                found.wrong.push(Wrong(format!("is not read: {refused}")));
                return found;
            }
        };
        let mut source = Source::seeded(self.name().bytes().map(u64::from).sum());
        let scales = [[1.0, 1.0], [1e3, 1e3], [1.0, 1e-3]];
        for (k, sites) in self.sites.iter().enumerate() {
            for (j, h) in judge::STEPS.into_iter().enumerate() {
                let [mass, momentum] = scales[(j + k) % scales.len()];
                let draw = Draw {
                    sites: *sites,
                    h,
                    mass,
                    momentum,
                };
                let numbers = self.drawn(&draw, &mut source);
                let problem = self.problem(&draw, &numbers);
                let faults = k == 0 && j == 0;
                let step = (&draw, &numbers, &problem);
                self.step(&model, step, faults, &mut source, &mut found);
            }
        }
        found
    }

    fn step(
        &self,
        model: &Arc<LineModel>,
        (draw, numbers, problem): (&Draw, &Numbers, &Problem),
        faults: bool,
        source: &mut Source,
        found: &mut Found,
    ) {
        let what = format!("{draw:?}");
        let solved = problem.solve();
        let (head, momenta) = match self.stepped(model, draw, numbers) {
            Ok(both) => both,
            Err(refused) => {
                let reached = if solved.is_some() { "has a" } else { "has no" };
                let told = format!("{what} (the oracle {reached} root): {refused}");
                return found.refused.push(told);
            }
        };
        found.made += 1;
        let Some(solved) = solved else {
            found.lost += 1;
            return;
        };
        let bound = judge::bound(problem, &solved, source);
        let off = problem.off(&solved, &head, &momenta);
        found.off = found.off.worse(off);
        found.allowed = found.allowed.max(bound.increment).max(bound.momentum);
        let within = |off: &Off| off.increment <= bound.increment && off.momentum <= bound.momentum;
        if !within(&off) {
            found
                .wrong
                .push(Wrong(format!("{what}: {off:?}, allowed {bound:?}")));
        }
        if !faults {
            return;
        }
        for name in numbers.keys() {
            let held = self.pinned.contains(&name.as_str());
            let in_group =
                |(own, _, what): &Quantity| own == name && !matches!(what, What::Vector(_));
            if held || self.moving.iter().any(in_group) {
                continue;
            }
            let mut wrong = numbers.clone();
            if let Some(list) = wrong.get_mut(name) {
                list.iter_mut().for_each(|x| *x *= 1.0 + judge::FAULT);
            }
            if let Ok((head, momenta)) = self.stepped(model, draw, &wrong)
                && within(&problem.off(&solved, &head, &momenta))
            {
                found.unseen += 1;
                found.unseen_names.push(name.clone());
            }
        }
    }
}
