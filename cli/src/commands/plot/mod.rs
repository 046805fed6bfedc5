//! `clebsch plot`: any columns of a finished run, against time or against each other.
//! Takes the folder of a run and the names of columns; gives one SVG.

mod columns;
mod draw;

use crate::output::is_drawn;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::words::plain::shown;
use clap::ArgMatches;
use columns::{Columns, Series};
use std::fs;
use std::path::{Path, PathBuf};

/// Runs the command.
///
/// # Errors
/// Usage: there is no run in the folder, a column is unknown, or the range of time is empty. Failed: a file
/// cannot be read or written.
pub(crate) fn plot(matches: &ArgMatches, streams: &mut Streams<'_>) -> Result<u8, Failure> {
    let folder = matches
        .get_one::<PathBuf>("dir")
        .map_or(Path::new("."), PathBuf::as_path);
    let columns = Columns::open(folder)?;
    let listed = |key: &str| -> Vec<&str> {
        let all = matches.get_many::<String>(key).into_iter().flatten();
        all.flat_map(|text| split(text)).collect()
    };
    let (x, y) = (listed("x"), listed("y"));
    if y.is_empty() {
        writeln!(
            streams.out,
            "columns of {}; plot them with --y NAME, against time or with --x NAME",
            shown(folder)
        )?;
        for line in columns.described() {
            writeln!(streams.out, "  {line}")?;
        }
        return Ok(DONE);
    }
    let number = |key: &str| matches.get_one::<f64>(key).copied();
    let range = columns.range(number("from"), number("to"))?;
    let time = columns.series("time", &range)?;
    let mut up = Vec::new();
    for name in &y {
        up.extend(columns.all(name, &range)?);
    }
    let across = x.iter().map(|x| columns.series(x, &range));
    let across: Vec<Series> = across.collect::<Result<_, _>>()?;
    let title = columns.title();
    let drawn = match across.as_slice() {
        [] => draw::against_time(&title, &time, &up),
        // Pairs of columns, or all columns against one.
        own if own.len() == up.len() => draw::against(&title, &time, own, &up),
        [one] => draw::against(&title, &time, &vec![one.clone(); up.len()], &up),
        own => {
            return Err(Failure::Usage(format!(
                "{} columns along x and {} along y; give one --x for all, or one for each --y",
                own.len(),
                up.len()
            )));
        }
    };
    let drawn = drawn.map_err(|error| Failure::Failed(format!("cannot draw: {error}")))?;
    let name = match matches.get_one::<PathBuf>("out") {
        Some(name) if name.extension().is_none_or(|ending| ending != "svg") => {
            return Err(Failure::Usage(format!(
                "--out {}: pictures are SVG; give a name that ends in .svg, and convert it, for example with rsvg-convert",
                shown(name)
            )));
        }
        Some(name) => name.clone(),
        None => folder.join(file_name(&x, &y)),
    };
    written(&name, &drawn, matches.get_flag("force"))?;
    writeln!(streams.out, "written: {}", shown(&name))?;
    Ok(DONE)
}

/// Splits a list of names at commas outside brackets: `R[1,2],x` has two names.
fn split(text: &str) -> Vec<&str> {
    let mut depth = 0_usize;
    let between = |letter: char| {
        match letter {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        letter == ',' && depth == 0
    };
    let names = text.split(between).map(str::trim);
    names.filter(|name| !name.is_empty()).collect()
}

/// `plot-q.svg`, or `plot-q-p.svg` for p against q.
fn file_name(x: &[&str], y: &[&str]) -> String {
    let names: Vec<&str> = x.iter().chain(y).copied().collect();
    let plain = |c: char| {
        if c.is_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '_'
        }
    };
    let names = names
        .join("-")
        .chars()
        .map(plain)
        .take(80)
        .collect::<String>();
    format!("plot-{names}.svg")
}

/// Writes a picture completely, or not at all.
fn written(name: &Path, text: &str, force: bool) -> Result<(), Failure> {
    if name.exists() && !force && !is_drawn(name) {
        return Err(Failure::Usage(format!(
            "{} exists and is not a picture of `clebsch plot`; give another --out, or --force",
            shown(name)
        )));
    }
    let mut beside = name.as_os_str().to_owned();
    beside.push(".part");
    let beside = PathBuf::from(beside);
    let done = fs::write(&beside, text).and_then(|()| fs::rename(&beside, name));
    done.map_err(|error| {
        let _ = fs::remove_file(&beside);
        Failure::io(&format!("cannot write {}", shown(name)), &error)
    })
}
