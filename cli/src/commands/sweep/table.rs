//! The table of a sweep: its columns, and its files from the rows on disk. Takes a card and the varied names; gives
//! sweep.csv, sweep.npz and sweep.json, whose bytes do not depend on how the points were divided.

use super::vary::Axis;
use crate::output::samples::Rows;
use crate::output::{Staging, arrays};
use crate::terminal::failure::Failure;
use clebsch::card::Card;
use clebsch::record::{self, Rows as _, npz};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Every file of a sweep.
pub(super) const FILES: [&str; 6] = [
    "sweep.csv",
    "sweep.npz",
    "sweep.json",
    crate::output::samples::NAME,
    crate::trajectory::checkpoint::NAME,
    crate::trajectory::checkpoint::UNFINISHED,
];

/// A point at which all steps were taken.
pub(super) const DONE: f64 = 0.0;
/// One that stopped before.
pub(super) const STOPPED: f64 = 1.0;
/// The status of a point whose values are rejected or whose first step fails.
pub(super) const REFUSED: f64 = 2.0;

/// The columns of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Columns {
    pub(super) names: Vec<String>,
    /// Which column is the status.
    status: usize,
}

impl Columns {
    /// The columns of a sweep.
    pub(super) fn of(card: &Card, axes: &[Axis]) -> Self {
        let mut all = vec!["point".to_owned()];
        all.extend(axes.iter().map(|axis| axis.quantity.name.clone()));
        let status = all.len();
        let told = ["status", "steps", "time", "within_bounds"];
        all.extend(told.map(str::to_owned));
        for invariant in card.invariants {
            let name = format!("drift_{}", invariant.name);
            match invariant.rows {
                1 => all.push(name),
                rows => all.extend((1..=rows).map(|row| format!("{name}_{row}"))),
            }
        }
        let observables = record::columns(card);
        all.extend(observables.into_iter().take(card.observable_count()));
        Self { names: all, status }
    }

    /// The columns in the header of a file.
    pub(super) fn read(header: &str) -> Option<Self> {
        let names: Vec<String> = header.split(',').map(str::to_owned).collect();
        let status = names.iter().position(|name| name == "status")?;
        Some(Self { names, status })
    }
}

/// The number of points for each status.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub(super) done: u64,
    pub(super) stopped: u64,
    pub(super) refused: u64,
    /// The number of the first point that was.
    pub(super) first_refused: Option<u64>,
    pub(super) beyond_bounds: u64,
}

impl Tally {
    /// In words.
    pub(super) fn text(&self) -> String {
        format!(
            "{} complete, {} stopped early, {} refused; {} with an invariant beyond its bound",
            self.done, self.stopped, self.refused, self.beyond_bounds
        )
    }

    /// The exit code: failed if a point was not completed; otherwise it states whether a bound was exceeded.
    pub(super) fn code(&self) -> u8 {
        match (self.stopped + self.refused, self.beyond_bounds) {
            (0, 0) => crate::terminal::failure::DONE,
            (0, _) => crate::terminal::failure::BOUND_LEFT,
            _ => crate::terminal::failure::FAILED,
        }
    }

    /// The numbers that [`Tally::json`] wrote.
    pub(super) fn read(points: &Value) -> Self {
        let number = |key: &str| points[key].as_u64().unwrap_or(0);
        Self {
            done: number("complete"),
            stopped: number("stopped"),
            refused: number("refused"),
            first_refused: None,
            beyond_bounds: number("beyond_bounds"),
        }
    }

    pub(super) fn json(&self) -> Value {
        json!({
            "complete": self.done,
            "stopped": self.stopped,
            "refused": self.refused,
            "beyond_bounds": self.beyond_bounds,
        })
    }
}

/// Writes the table in both forms; returns the number of points for each status.
pub(super) fn write(staging: &Staging, columns: &Columns, rows: &Rows) -> Result<Tally, Failure> {
    let [csv, npz, ..] = FILES;
    let mut tally = Tally::default();
    staging.write(csv, |file| {
        writeln!(file, "{}", columns.names.join(","))?;
        rows.each(&mut |row| {
            let number = |column: usize| row.get(column).map_or(f64::NAN, |x| f64::from_bits(*x));
            let status = number(columns.status);
            *(match status {
                s if s == DONE => &mut tally.done,
                s if s == STOPPED => &mut tally.stopped,
                _ => {
                    tally.first_refused = tally.first_refused.or(row.first().copied());
                    &mut tally.refused
                }
            }) += 1;
            tally.beyond_bounds += u64::from(number(columns.status + 3) == 0.0);
            let mut words = row.iter().take(columns.names.len());
            write!(file, "{}", words.next().copied().unwrap_or(0))?;
            for word in words {
                write!(file, ",{:?}", f64::from_bits(*word))?;
            }
            writeln!(file)
        })
    })?;
    staging.write(npz, |file| {
        npz::write(file, rows, &arrays::columns(&columns.names, rows.count()))
    })?;
    Ok(tally)
}

/// Writes the description; `sweep` is the object without results.
pub(super) fn describe(staging: &Staging, sweep: &Value, tally: &Tally) -> Result<Value, Failure> {
    let [csv, npz, json, ..] = FILES;
    let mut object = sweep.clone();
    object["results"] = json!({
        "complete": true,
        "points": tally.json(),
        "files": [csv, npz, json],
    });
    let text = format!("{object:#}\n");
    staging.write(json, |file: &mut io::BufWriter<_>| {
        file.write_all(text.as_bytes())
    })?;
    Ok(object)
}
