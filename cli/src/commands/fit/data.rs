//! The data of `clebsch fit`: observed quantities at nodes. Takes a CSV or npz file; gives numbers with their nodes.

use crate::case_file::archive::Archive;
use crate::derivatives::expression::{Expression, parts};
use crate::derivatives::problem::Problem;
use crate::terminal::bounded;
use crate::terminal::failure::Failure;
use crate::words::number::plain;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use std::path::Path;

/// How far a time may be from a node, in steps.
const AT_NODE: f64 = 1e-6;

/// The most steps to a datum.
const MOST_STEPS: f64 = 1e9;

/// An observed number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Datum {
    pub node: u64,
    /// The number of its column.
    pub column: usize,
    pub value: f64,
}

/// Observed quantities.
pub(super) struct Data {
    /// The quantities of the columns.
    pub columns: Vec<Expression>,
    /// All numbers, in the order of nodes.
    pub all: Vec<Datum>,
}

/// A table of columns with names.
struct Table {
    names: Vec<String>,
    /// One list for each name.
    columns: Vec<Vec<f64>>,
}

impl Data {
    /// Reads a file. `chosen` are the columns to use; by default all.
    ///
    /// # Errors
    /// Usage: the file cannot be read, or a name or a time is wrong.
    pub fn read(path: &Path, chosen: Option<&str>, problem: &Problem) -> Result<Self, Failure> {
        let is_npz = path.extension().is_some_and(|end| end == "npz");
        let table = if is_npz { npz(path)? } else { csv(path)? };
        let file = shown(path).to_string();
        let is_time = |name: &&String| matches!(name.as_str(), "t" | "time");
        let time = table.names.iter().position(|name| is_time(&name));
        let time = time.and_then(|at| table.columns.get(at)).ok_or_else(|| {
            Failure::Usage(format!(
                "{file} has no column `t` or `time`. Name the column of times so"
            ))
        })?;
        let nodes = nodes(time, problem.plan.case.h, &file)?;
        let wanted = chosen.map(parts);
        if let Some(wanted) = &wanted {
            for name in wanted {
                if !table.names.iter().any(|own| own == name) {
                    let known = table.names.iter().map(String::as_str);
                    return Err(Failure::Usage(format!(
                        "--columns {}: {file} has no such column{}",
                        shown(*name),
                        did_you_mean(name, known)
                    )));
                }
            }
        }
        let mut data = Data {
            columns: Vec::new(),
            all: Vec::new(),
        };
        for (name, values) in table.names.iter().zip(&table.columns) {
            let is_wanted = wanted
                .as_ref()
                .is_none_or(|own| own.contains(&name.as_str()));
            if is_time(&name) || name == "node" || !is_wanted {
                continue;
            }
            let option = format!("{file}, name of a column");
            let column = data.columns.len();
            data.columns
                .push(Expression::read(name, &problem.card, &option)?);
            let numbers = nodes
                .iter()
                .zip(values)
                .filter(|(_, value)| value.is_finite());
            data.all.extend(numbers.map(|(node, value)| Datum {
                node: *node,
                column,
                value: *value,
            }));
        }
        data.all.sort_by_key(|datum| datum.node);
        match data.all.is_empty() {
            true => Err(Failure::Usage(format!(
                "{file} has no observed numbers. Give columns named as those of trajectory.csv"
            ))),
            false => Ok(data),
        }
    }

    /// The last node with a number.
    pub fn last(&self) -> u64 {
        self.all.last().map_or(0, |datum| datum.node)
    }
}

/// The nodes of times.
fn nodes(times: &[f64], h: f64, file: &str) -> Result<Vec<u64>, Failure> {
    let each = times.iter().enumerate().map(|(row, time)| {
        let steps = time / h;
        let nearest = steps.round();
        if !(0.0..=MOST_STEPS).contains(&nearest) {
            return Err(Failure::Usage(format!(
                "{file}, row {}: time {time} is {steps} steps of h = {h}. Give times from 0 to {MOST_STEPS:e} steps",
                row + 1
            )));
        }
        // The range above makes the number a whole number.
        match (steps - nearest).abs() <= AT_NODE {
            true => Ok(nearest as u64),
            false => Err(Failure::Usage(format!(
                "{file}, row {}: time {time} is no node of steps h = {h}; the nearest is {}. Choose --h so that all times are \
                 nodes",
                row + 1,
                plain(nearest * h)
            ))),
        }
    });
    each.collect()
}

/// The columns of a CSV file. An empty cell is missing.
fn csv(path: &Path) -> Result<Table, Failure> {
    let text = bounded::text(path, "data file")?;
    let file = shown(path).to_string();
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    let (_, head) = lines.next().ok_or_else(|| {
        Failure::Usage(format!(
            "{file} is empty. Give a line of names, then lines of numbers"
        ))
    })?;
    let names: Vec<String> = parts(head.trim_start_matches('\u{feff}'))
        .iter()
        .map(|name| name.trim_matches('"').to_owned())
        .collect();
    let mut columns = vec![Vec::new(); names.len()];
    for (line, row) in lines {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            return Err(Failure::Usage(format!(
                "{file}, line {}: there are {} cells for {} names. Give one cell for each name",
                line + 1,
                cells.len(),
                names.len()
            )));
        }
        for ((cell, column), name) in cells.iter().zip(&mut columns).zip(&names) {
            column.push(match cell.parse::<f64>() {
                Ok(x) => x,
                Err(_) if cell.is_empty() => f64::NAN,
                Err(_) => {
                    return Err(Failure::Usage(format!(
                        "{file}, line {}, column `{}`: `{}` is not a number. Give a number, or leave the cell empty",
                        line + 1,
                        shown(name.as_str()),
                        shown(*cell)
                    )));
                }
            });
        }
    }
    Ok(Table { names, columns })
}

/// The columns of an npz file, with the same names as in a CSV file.
fn npz(path: &Path) -> Result<Table, Failure> {
    let archive = Archive::open(path).map_err(Failure::Usage)?;
    let mut table = Table {
        names: Vec::new(),
        columns: Vec::new(),
    };
    for name in archive.names() {
        let array = archive.array(name).map_err(Failure::Usage)?;
        let rows = array.shape.first().copied().unwrap_or(1);
        let inner = array.shape.get(1..).unwrap_or_default();
        let count: usize = inner.iter().product();
        let Some(total) = rows.checked_mul(count) else {
            continue;
        };
        let numbers = array.numbers(0, total);
        for at in 0..count {
            table.names.push(match inner {
                [] => name.to_owned(),
                [rows, cols] => {
                    let gap = if *rows > 9 || *cols > 9 { "_" } else { "" };
                    format!("{name}_{}{gap}{}", at / cols + 1, at % cols + 1)
                }
                _ => format!("{name}_{}", at + 1),
            });
            let own = numbers.iter().skip(at).step_by(count.max(1));
            table.columns.push(own.copied().collect());
        }
    }
    Ok(table)
}
