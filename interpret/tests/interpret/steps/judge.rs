//! Judges one model: from random data, each step is run from the text and solved by the oracle. Wrong data must be
//! detected.

use super::data::{Data, Draw, drawn};
use super::posed::{observed, problem, turned};
use super::row::Row;
use clebsch::card::{Card, Field, Kind, Settings};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::step::compare::{Off, ROUNDING};
use clebsch_oracle::oracle::step::{Problem, Solved};

/// A step must be correct to twelve digits.
pub const WANTED: f64 = 1e-12;

/// If the data determine the step less accurately: a step takes several hundred operations, which round
/// independently, and each counts as a datum with a changed last bit.
pub const OPERATIONS: f64 = 32.0;

/// The relative error of a wrong datum.
pub const FAULT: f64 = 1e-6;

/// Steps, and scales of masses and momenta.
pub const STEPS: [f64; 3] = [0.1, 0.01, 0.001];
const SCALES: [[f64; 2]; 5] = [
    [1.0, 1.0],
    [1e3, 1e3],
    [1.0, 1e-3],
    [1e-3, 1e-3],
    [1e3, 1.0],
];

/// The error of one step.
#[derive(Clone, Debug)]
pub struct Wrong(pub String);

/// The measurements of a model.
#[derive(Clone, Debug, Default)]
pub struct Found {
    pub off: Off,
    /// The largest bound.
    pub allowed: f64,
    pub made: usize,
    /// The reasons why steps failed.
    pub refused: Vec<String>,
    /// Successful steps whose root the oracle does not reach from rest.
    pub lost: usize,
    pub wrong: Vec<Wrong>,
    /// Wrong data that remain undetected.
    pub unseen: usize,
    pub unseen_names: Vec<String>,
}

/// The end of one step of the model, or why it fails.
fn stepped(card: &Card, data: &Data, h: f64) -> Result<Vec<f64>, String> {
    let opened = (card.open)(&data.parameters, &data.initial, Settings::step(h));
    let mut trajectory = opened.map_err(|e| e.to_string())?;
    trajectory.step().map_err(|e| e.to_string())?;
    let mut all = vec![0.0; card.observable_count()];
    trajectory.observe(&mut all);
    Ok(all)
}

/// The bound of one step.
pub fn bound(problem: &Problem, solved: &Solved, source: &mut Source) -> Off {
    let response = problem.response(solved, source);
    let of = |x: f64| WANTED.max(OPERATIONS * x);
    Off {
        increment: of(response.increment),
        momentum: of(response.momentum.max(ROUNDING)),
    }
}

/// Judges a model.
pub fn judge(row: &Row) -> Found {
    let mut found = Found::default();
    let card = match clebsch_interpret::card(row.text) {
        Ok(card) => card,
        Err(refused) => {
            found.wrong.push(Wrong(format!("is not read: {refused}")));
            return found;
        }
    };
    let mut source = Source::seeded(row.name().bytes().map(u64::from).sum());
    let mut count = 0;
    for [mass, momentum] in SCALES {
        for h in STEPS {
            count += 1;
            let draw = Draw {
                h,
                mass,
                momentum,
                fine: count % 2 == 0,
            };
            let data = drawn(row, &card, &draw, &mut source);
            step(row, &card, &draw, &data, &mut source, &mut found);
        }
    }
    found
}

fn step(row: &Row, card: &Card, draw: &Draw, data: &Data, source: &mut Source, found: &mut Found) {
    let what = format!("{draw:?}");
    let problem = problem(row, card, draw, data);
    let solved = problem.solve();
    let all = match stepped(card, data, draw.h) {
        Ok(all) => all,
        Err(refused) => {
            let reached = if solved.is_some() { "has a" } else { "has no" };
            found
                .refused
                .push(format!("{what} (the oracle {reached} root): {refused}"));
            return;
        }
    };
    found.made += 1;
    let Some(solved) = solved else {
        found.lost += 1;
        return;
    };
    let bound = bound(&problem, &solved, source);
    let (head, momenta) = observed(card, &all);
    let off = problem.off(&solved, &head, &momenta);
    found.off = found.off.worse(off);
    found.allowed = found.allowed.max(bound.increment).max(bound.momentum);
    let within = |off: &Off| off.increment <= bound.increment && off.momentum <= bound.momentum;
    if !within(&off) {
        found
            .wrong
            .push(Wrong(format!("{what}: {off:?}, allowed {bound:?}")));
    }
    // Long steps make errors in forces visible.
    if draw.h == STEPS[0] && draw.mass == 1.0 && draw.momentum == 1.0 {
        let turned = turned(card, data, &problem, FAULT);
        for (name, wrong) in faults(card, data, source).into_iter().chain(turned) {
            if row.idle.contains(&name.as_str()) {
                continue;
            }
            let Ok(all) = stepped(card, &wrong, draw.h) else {
                continue;
            };
            let (head, momenta) = observed(card, &all);
            if within(&problem.off(&solved, &head, &momenta)) {
                found.unseen += 1;
                found.unseen_names.push(name);
            }
        }
    }
}

/// The data with a wrong value: one nonzero number of each field. Elements of groups are turned instead.
fn faults(card: &Card, data: &Data, source: &mut Source) -> Vec<(String, Data)> {
    let mut out = Vec::new();
    for (which, fields) in [card.parameters, card.initial].into_iter().enumerate() {
        for (i, field) in fields.iter().enumerate() {
            let in_group = [Kind::Rotation, Kind::UnitQuaternion, Kind::RigidMotion];
            if in_group.contains(&field.kind) {
                continue;
            }
            let mut wrong = data.clone();
            let list = match which {
                0 => &mut wrong.parameters[i],
                _ => &mut wrong.initial[i],
            };
            let others = (0..list.len()).filter(|k| list[*k] != 0.0);
            let others: Vec<usize> = others.collect();
            let Some(k) = source.choose(&others).copied() else {
                continue;
            };
            spoil(field, list, k);
            out.push((format!("{}[{k}]", field.name), wrong));
        }
    }
    out
}

/// Makes one number wrong; symmetric and skew matrices keep their structure.
fn spoil(field: &Field, list: &mut [f64], k: usize) {
    let (r, c) = (k / field.cols, k % field.cols);
    let across = match field.rows == field.cols {
        true => c * field.cols + r,
        false => k,
    };
    let sign = match (list[across] == list[k], list[across] == -list[k]) {
        (true, _) => Some(1.0),
        (_, true) => Some(-1.0),
        _ => None,
    };
    list[k] *= 1.0 + FAULT;
    if let Some(sign) = sign {
        list[across] = sign * list[k];
    }
}
