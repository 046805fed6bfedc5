//! `clebsch collect`: joins the parts of a sweep. The table is identical to the table of an undivided sweep,
//! byte for byte.
//! Takes the folders of all parts in any order; gives one, or reports a part that is missing or belongs to
//! another sweep.

use super::points::Points;
use super::table::{self, Columns};
use crate::output::{self, Staging};
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clap::ArgMatches;
use serde_json::Value;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// The description of a sweep that is complete.
pub(super) fn description(folder: &Path) -> Result<Value, String> {
    let [_, _, json, ..] = table::FILES;
    let text = fs::read_to_string(folder.join(json)).map_err(|error| {
        format!("this is not the folder of a sweep: {json} cannot be read: {error}")
    })?;
    text.parse::<Value>()
        .map_err(|error| format!("{json} is damaged: {error}"))
}

/// A part: its folder, its first point, and the point after its last.
struct Part<'a> {
    folder: &'a PathBuf,
    first: u64,
    end: u64,
}

/// Runs the command.
///
/// # Errors
/// Usage: a part is missing, given twice, damaged or from another sweep. Failed: a file cannot be read or
/// written.
pub(crate) fn collect(matches: &ArgMatches, streams: &mut Streams<'_>) -> Result<u8, Failure> {
    let folders: Vec<&PathBuf> = matches
        .get_many::<PathBuf>("parts")
        .into_iter()
        .flatten()
        .collect();
    let Some(target) = matches.get_one::<PathBuf>("out") else {
        return Err(Failure::Usage(
            "--out DIR: give a folder for the table".to_owned(),
        ));
    };
    let mut whole: Option<(Value, &PathBuf)> = None;
    let mut parts = Vec::new();
    let mut of = 0;
    for folder in folders {
        let wrong = |why: String| Failure::Usage(format!("{}: {why}", shown(folder)));
        let mut own = description(folder).map_err(wrong)?;
        let shard = own["shard"].take();
        let number = |key: &str| shard[key].as_u64();
        let (Some(first), Some(end), Some(count)) = (number("first"), number("end"), number("of"))
        else {
            return Err(wrong(
                "this is the table of a whole sweep, not of a part".to_owned(),
            ));
        };
        if let Some(object) = own.as_object_mut() {
            object.remove("results");
        }
        match &whole {
            None => whole = Some((own, folder)),
            Some((known, _)) if *known == own && of == count => {}
            Some((known, other)) => {
                let keys = known.as_object().into_iter().flatten();
                let mut differs = keys.filter(|(key, value)| own.get(key.as_str()) != Some(value));
                let key = differs
                    .next()
                    .map_or("number of parts", |(key, _)| key.as_str());
                return Err(wrong(format!(
                    "it belongs to another sweep than {}: its {key} differs",
                    shown(*other)
                )));
            }
        }
        of = count;
        parts.push(Part { folder, first, end });
    }
    parts.sort_by_key(|part| (part.first, part.end));
    let Some((description, _)) = whole else {
        return Err(Failure::Usage("give the folders of the parts".to_owned()));
    };
    let all = description["points"].as_u64().unwrap_or(0);
    let mut next = 0;
    for part in &parts {
        if part.first > next {
            break;
        }
        if part.first < next {
            return Err(Failure::Usage(format!(
                "{}: this part is given twice",
                shown(part.folder)
            )));
        }
        next = part.end;
    }
    if next != all {
        return Err(Failure::Usage(format!(
            "the part that starts with point {next} is missing: {} of {of} parts are given",
            parts.len()
        )));
    }
    let staging = Staging::new(target, matches.get_flag("force"), &table::FILES)?;
    let mut header: Option<String> = None;
    let mut points: Option<(Points, Columns)> = None;
    for part in &parts {
        let [csv, ..] = table::FILES;
        let path = part.folder.join(csv);
        let failed =
            |error: std::io::Error| Failure::io(&format!("cannot read {}", shown(&path)), &error);
        let damaged = || Failure::Usage(format!("{}: it is damaged or was changed", shown(&path)));
        let mut lines = BufReader::new(File::open(&path).map_err(failed)?).lines();
        let first = lines.next().ok_or_else(damaged)?.map_err(failed)?;
        if *header.get_or_insert_with(|| first.clone()) != first {
            return Err(damaged());
        }
        let (points, columns) = match &mut points {
            Some(points) => points,
            none => {
                let columns = Columns::read(&first).ok_or_else(damaged)?;
                let opened = Points::open(staging.folder(), columns.names.len(), all);
                none.insert((opened.map_err(failed)?, columns))
            }
        };
        let mut expected = part.first;
        for line in lines {
            let line = line.map_err(failed)?;
            let row = row(&line, expected).ok_or_else(damaged)?;
            if row.len() != columns.names.len() {
                return Err(damaged());
            }
            points.put(expected, &row).map_err(failed)?;
            expected += 1;
        }
        if expected != part.end {
            return Err(damaged());
        }
    }
    let Some((points, columns)) = points else {
        return Err(Failure::Usage("give the folders of the parts".to_owned()));
    };
    let rows = points
        .into_rows(staging.folder())
        .map_err(|error| Failure::io(&format!("cannot write into {}", shown(target)), &error))?;
    let tally = table::write(&staging, &columns, &rows)?;
    let object = table::describe(&staging, &description, &tally)?;
    staging.commit()?;
    output::remove_what_resumes(target);
    super::tell(&object, &tally, target, matches.get_flag("json"), streams)
}

/// The words of a line: the numbers are written so that they parse to the same bits.
fn row(line: &str, point: u64) -> Option<Vec<u64>> {
    let mut cells = line.split(',');
    if cells.next()?.parse() != Ok(point) {
        return None;
    }
    let mut row = vec![point];
    for cell in cells {
        let number: f64 = cell.parse().ok()?;
        row.push(if number.is_nan() { f64::NAN } else { number }.to_bits());
    }
    Some(row)
}
