//! `clebsch equilibrium`: critical points of the energy at fixed conserved quantities, and their branches. Takes a
//! case; gives a table, JSON, CSV and a plot of the branch.

mod branch;
mod draw;
mod report;

use crate::derivatives::coordinates;
use crate::derivatives::energy::CaseEnergy;
use crate::derivatives::fixed::{self, Fixed, unproved};
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::models::gallery::{Case, Gallery};
use crate::output::results::Results;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, Failure};
use crate::terminal::waiting::Waiting;
use crate::words::columns::aligned;
use crate::words::number::{decimals, short};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch_analysis::{
    Definiteness, Equilibrium, EquilibriumError, Search, Variation, equilibrium as search,
};
use serde_json::{Map, Value, json};

/// Files of the command. The table and the picture show a branch.
const FILES: [&str; 3] = ["branch.csv", "equilibrium.json", "branch.svg"];

/// Runs the command.
///
/// # Errors
/// Usage: the request is wrong. Failed: the search finds none.
pub(crate) fn equilibrium(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let problem = Problem::new(gallery, matches, streams)?;
    let flow = problem.steps()?;
    let at_start = flow
        .start()
        .and_then(|at| flow.with(|own| own.invariants(&at)));
    let at_start = at_start.map_err(|why| problem.refused(&why))?;
    let option = matches.get_one::<String>("fix").map(String::as_str);
    let dimensions = flow.with(|own| own.dimensions());
    let fixed = fixed::fixed(&problem, &flow, option, &at_start, &dimensions)?;
    let continued = match matches.get_one::<String>("continue") {
        None => None,
        Some(text) => Some(branch::Request::read(text, &problem)?),
    };
    let results = Results::begin(matches, &FILES)?;
    if let Some(request) = continued {
        return branch::branch(&problem, &flow, fixed, request, results, matches, streams);
    }
    let energy = CaseEnergy::new(&problem, &flow, fixed.clone(), None)?;
    let start = flow.start();
    let found = {
        let _told = Waiting::showing("searching for an equilibrium".to_owned(), streams.progress);
        let values = energy
            .values(&start, 0.0)
            .map_err(|why| problem.refused(&why))?;
        search(&energy, &start, &values, 0.0, &Search::default())
            .map_err(|why| none(&problem, &why))?
    };
    let case = case_at(&problem, &flow, &found.state)?;
    let object = object(&problem, &case, &fixed, &found);
    let [_, json_name, _] = FILES;
    let written = results.end(&[(json_name, format!("{object:#}\n"))])?;
    let out = &mut *streams.out;
    if matches.get_flag("json") {
        writeln!(out, "{object}")?;
        return Ok(DONE);
    }
    let title = format!(
        "{}: critical point of the energy{}",
        problem.title(),
        at_fixed(&fixed)
    );
    out.write_all(paragraph(&title, streams.width, 2).as_bytes())?;
    writeln!(out)?;
    let own = &problem.plan.case.initial;
    out.write_all(
        coordinates::compared(&problem.card, own, &case.initial, streams.width).as_bytes(),
    )?;
    writeln!(out)?;
    if !fixed.is_empty() {
        let mut rows = vec![["fixed", "multiplier"].map(str::to_owned).to_vec()];
        let pairs = fixed.iter().zip(found.multipliers.iter());
        rows.extend(pairs.map(|(own, x)| vec![own.name.clone(), decimals(*x, 9)]));
        out.write_all(aligned(&rows, &[1], streams.width).as_bytes())?;
        writeln!(out)?;
    }
    let notes = [
        format!(
            "energy {:.12}; residual {} after {} iterations",
            found.energy,
            short(found.residual),
            found.iterations
        ),
        verdict(&found.variation, &unproved(&problem.card, &fixed)),
        eigenvalues(&found.variation),
    ];
    for line in notes.into_iter().chain(written) {
        out.write_all(paragraph(&line, streams.width, 2).as_bytes())?;
    }
    Ok(DONE)
}

/// The initial values of a state.
fn case_at(problem: &Problem, flow: &Steps, at: &State) -> Result<Case, Failure> {
    let case = &problem.plan.case;
    let found = at
        .clone()
        .and_then(|at| flow.with(|own| problem.case_at(case, own, &at)));
    found.map_err(|why| problem.refused(&why))
}

fn none(problem: &Problem, why: &EquilibriumError<clebsch::derivatives::NoDerivative>) -> Failure {
    match why {
        EquilibriumError::NoConvergence {
            residual,
            iterations,
            ..
        } => Failure::Failed(format!(
            "model `{}` has no equilibrium near the state of the case: after {iterations} iterations the residual is {}. Start \
             closer to one, or fix other quantities with --fix",
            problem.card.kebab,
            short(*residual)
        )),
        other => Failure::Failed(other.to_string()),
    }
}

/// `at fixed a, b`, for a title.
fn at_fixed(fixed: &[Fixed]) -> String {
    let names: Vec<&str> = fixed.iter().map(|own| own.name.as_str()).collect();
    match names.is_empty() {
        true => String::new(),
        false => format!(" at fixed {}", names.join(", ")),
    }
}

/// The verdict of the second variation on stability, with the fixed quantities that are not proved invariants.
fn verdict(variation: &Variation, unproved: &[&str]) -> String {
    if !unproved.is_empty() {
        return format!(
            "no verdict on stability: clebsch has not proved that the motion conserves {}, so the state need not be a steady motion. \
             Run it to see, or fix invariants only",
            unproved.join(", ")
        );
    }
    match variation.definiteness {
        Definiteness::Minimum => "stable: the second variation is positive definite".to_owned(),
        Definiteness::Maximum => "stable: the second variation is negative definite".to_owned(),
        // On a symplectic space, an odd number of negative directions means a real growth rate.
        Definiteness::Saddle { negative, positive } if negative % 2 == 1 && positive % 2 == 1 => {
            format!(
                "unstable: the second variation has an odd number of negative directions ({negative} negative, {positive} positive)"
            )
        }
        Definiteness::Saddle { negative, positive } => format!(
            "undecided: the second variation is indefinite ({negative} negative, {positive} positive directions). Use `clebsch \
             linearise` or `clebsch orbit`"
        ),
        Definiteness::Degenerate {
            null,
            negative,
            positive,
        } => format!(
            "undecided: the second variation has {null} null, {negative} negative and {positive} positive directions"
        ),
    }
}

/// The verdict on stability as one word.
fn word(variation: &Variation, unproved: &[&str]) -> &'static str {
    match stable(variation, unproved) {
        Some(true) => "stable",
        Some(false) => "unstable",
        None => "undecided",
    }
}

/// Whether the state is stable, if the second variation decides it.
fn stable(variation: &Variation, unproved: &[&str]) -> Option<bool> {
    if !unproved.is_empty() {
        return None;
    }
    match variation.definiteness {
        Definiteness::Minimum | Definiteness::Maximum => Some(true),
        Definiteness::Saddle { negative, positive } if negative % 2 == 1 && positive % 2 == 1 => {
            Some(false)
        }
        _ => None,
    }
}

/// The eigenvalues of the second variation as one line.
fn eigenvalues(variation: &Variation) -> String {
    let most = 12;
    let all = &variation.eigenvalues;
    let shown: Vec<String> = all.iter().take(most).map(|x| short(*x)).collect();
    let more = match all.len().saturating_sub(most) {
        0 => String::new(),
        more => format!(", and {more} more"),
    };
    let symmetric = match variation.symmetric {
        0 => String::new(),
        1 => "; one null direction is a symmetry".to_owned(),
        count => format!("; {count} null directions are symmetries"),
    };
    format!(
        "eigenvalues of the second variation: {}{more}{symmetric}",
        shown.join(", ")
    )
}

/// The initial values as JSON.
fn initial(problem: &Problem, case: &Case) -> Map<String, Value> {
    let fields = problem.card.initial.iter().zip(&case.initial);
    fields
        .map(|(field, values)| (field.ascii.to_owned(), json!(values)))
        .collect()
}

fn object(problem: &Problem, case: &Case, fixed: &[Fixed], found: &Equilibrium<State>) -> Value {
    let names: Vec<&str> = fixed.iter().map(|own| own.name.as_str()).collect();
    problem.object(json!({
        "state": initial(problem, case),
        "fixed": names,
        "multipliers": found.multipliers.as_slice(),
        "energy": found.energy,
        "residual": found.residual,
        "unproved": unproved(&problem.card, fixed),
        "stability": word(&found.variation, &unproved(&problem.card, fixed)),
        "stable": stable(&found.variation, &unproved(&problem.card, fixed)),
        "second_variation": found.variation.eigenvalues,
        "symmetric_directions": found.variation.symmetric,
    }))
}
