//! `clebsch orbit`: a periodic orbit near the state of a case, with its stability. Takes a case and a period; gives a
//! table, JSON, and a case file of the orbit.

use crate::case_file;
use crate::derivatives::coordinates;
use crate::derivatives::flow::State;
use crate::derivatives::problem::Problem;
use crate::models::gallery::{Case, Gallery};
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{decimals, plain, short};
use crate::words::plain::shown;
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch_analysis::{Flow, Orbit, Search, orbit as search};
use serde_json::json;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A multiplier this many errors outside the unit circle is unstable.
const CERTAIN: f64 = 10.0;

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: the search or a step fails.
pub(crate) fn orbit(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let period = matches.get_one::<f64>("period").copied().unwrap_or(1.0);
    let target = matches.get_one::<PathBuf>("write-case");
    let mut problem = Problem::new(gallery, matches, streams)?;
    if let Some(target) = target {
        writable(&problem, target)?;
    }
    let steps = steps(&problem, period, matches)?;
    problem.plan.case.steps = steps as u64;
    problem.plan.case.h = period / steps as f64;
    let h = problem.plan.case.h;
    let flow = problem.steps()?;
    let found = {
        let _told = Waiting::showing("searching for the orbit".to_owned(), streams.progress);
        search(&flow, &flow.start(), h, steps, &Search::default())
    };
    let found = found.map_err(|why| Failure::Failed(why.to_string()))?;
    let at = found.state.clone();
    let case = at.and_then(|at| flow.with(|own| problem.case_at(&problem.plan.case, own, &at)));
    let case = case.map_err(|why| problem.refused(&why))?;
    let away = flow.difference(&flow.start(), &found.state);
    let away = away.iter().map(|x| x * x).sum::<f64>().sqrt();
    let written = match target {
        None => None,
        Some(target) => {
            write_case(&problem, &case, period, target, matches)?;
            Some(format!(
                "written to {}; `clebsch run` follows the orbit",
                shown(target)
            ))
        }
    };
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        let initial = problem.card.initial.iter().zip(&case.initial);
        let initial: serde_json::Map<String, serde_json::Value> = initial
            .map(|(field, values)| (field.ascii.to_owned(), json!(values)))
            .collect();
        let multipliers = found.floquet.values.iter().zip(&found.floquet.errors);
        let object = problem.object(json!({
            "period": period,
            "steps": steps,
            "state": initial,
            "distance": away,
            "residual": found.residual,
            "size": found.size,
            "is_equilibrium": found.size <= STILL,
            "multipliers": multipliers
                .map(|(z, error)| json!({"re": z.re, "im": z.im, "error": error}))
                .collect::<Vec<_>>(),
            "pairing_defect": found.pairing_defect,
            "stable": unstable(&found) == 0,
        }));
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!(
        "{}: periodic orbit of period {}, {steps} steps of {}",
        problem.title(),
        plain(period),
        plain(h)
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    let own = &problem.plan.case.initial;
    out.write_all(
        coordinates::compared(&problem.card, own, &case.initial, streams.width).as_bytes(),
    )?;
    writeln!(out)?;
    out.write_all(multipliers(&found, streams.width).as_bytes())?;
    writeln!(out)?;
    for line in notes(&found, away).into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// An orbit of at most this size is an equilibrium.
const STILL: f64 = 1e-6;

/// The number of steps of a period: the option, or the nearest to the step size of the case.
fn steps(problem: &Problem, period: f64, matches: &ArgMatches) -> Result<usize, Failure> {
    let asked = matches.get_one::<u64>("steps").copied();
    let steps = match asked {
        Some(steps) => steps as f64,
        None => (period / problem.plan.case.h).round(),
    };
    // Larger counts would run for days.
    match (1.0..=1e9).contains(&steps) {
        true => Ok(steps as usize),
        false => Err(Failure::Usage(format!(
            "--period {period}: this is {steps} steps of h = {}. Give another period, or the number of --steps",
            problem.plan.case.h
        ))),
    }
}

/// How many multipliers are outside the unit circle.
fn unstable(found: &Orbit<State>) -> usize {
    let all = found.floquet.values.iter().zip(&found.floquet.errors);
    all.filter(|(z, error)| z.norm() > 1.0 + CERTAIN * **error)
        .count()
}

fn multipliers(found: &Orbit<State>, width: Option<usize>) -> String {
    let head = [
        "multiplier",
        "real part",
        "imaginary part",
        "modulus",
        "error",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut all: Vec<_> = found
        .floquet
        .values
        .iter()
        .zip(&found.floquet.errors)
        .collect();
    all.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
    for (i, (z, error)) in all.into_iter().enumerate() {
        rows.push(vec![
            (i + 1).to_string(),
            decimals(z.re, 9),
            decimals(z.im, 9),
            decimals(z.norm(), 9),
            format!("{error:.1e}"),
        ]);
    }
    aligned(&rows, &[0, 1, 2, 3, 4], width)
}

fn notes(found: &Orbit<State>, away: f64) -> Vec<String> {
    let mut notes = vec![format!(
        "The state is {} from the state of the case, and returns to itself up to {}.",
        short(away),
        short(found.residual)
    )];
    // The residual of an equilibrium is the same after every step.
    if found.size <= STILL {
        notes.push("The orbit is an equilibrium, which has every period. `clebsch linearise` gives its modes.".to_owned());
    }
    notes.push(match unstable(found) {
        0 => "No multiplier is outside the unit circle: the orbit is spectrally stable.".to_owned(),
        1 => "One multiplier is outside the unit circle: the orbit is unstable.".to_owned(),
        count => format!("{count} multipliers are outside the unit circle: the orbit is unstable."),
    });
    notes.push(format!(
        "Multipliers of a symplectic motion come in pairs z, 1/z; the defect of this pairing is {}.",
        short(found.pairing_defect)
    ));
    notes
}

/// Checks the file of `--write-case` before the search.
fn writable(problem: &Problem, target: &Path) -> Result<(), Failure> {
    if problem.plan.choice.is_some() {
        return Err(Failure::Usage(format!(
            "--write-case: the cases of `{}` have site data, which clebsch does not write. Use --json for the state",
            problem.card.kebab
        )));
    }
    if target.extension().is_none_or(|end| end != "toml") {
        return Err(Failure::Usage(format!(
            "--write-case {}: a case file ends in .toml. Give such a name",
            shown(target)
        )));
    }
    match target.exists() {
        true => Err(Failure::Usage(format!(
            "--write-case {}: the file exists. Give another name, or remove it",
            shown(target)
        ))),
        false => Ok(()),
    }
}

fn write_case(
    problem: &Problem,
    case: &Case,
    period: f64,
    target: &Path,
    matches: &ArgMatches,
) -> Result<(), Failure> {
    let named = matches
        .get_one::<String>("model")
        .map_or("", String::as_str);
    let model = match named.strip_suffix(&format!(":{}", problem.plan.case.name)) {
        Some(model) => model,
        None => named,
    };
    let stem = target.file_stem().unwrap_or_default().to_string_lossy();
    let case = Case {
        name: stem.into_owned(),
        doc: format!(
            "periodic orbit of period {} near the case {}",
            plain(period),
            problem.plan.case.name
        ),
        ..case.clone()
    };
    let text = case_file::write(&problem.card, &case, model);
    let put = || File::create_new(target)?.write_all(text.as_bytes());
    put().map_err(|error| Failure::io(&format!("cannot write {}", shown(target)), &error))?;
    Ok(())
}
