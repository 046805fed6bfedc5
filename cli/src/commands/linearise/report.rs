//! Reports of a linearisation: tables, verdicts and JSON. Takes modes; gives texts.

use super::{Found, half, sure};
use crate::derivatives::coordinates;
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::output::results::csv;
use crate::terminal::failure::Failure;
use crate::words::columns::aligned;
use crate::words::number::short;
use clebsch_analysis::{Linear, Mode, Stability, Verdict};
use serde_json::{Value, json};

/// The largest number of modes that the terminal shows.
pub(super) const SHOWN: usize = 40;

pub(super) fn verdict(of: &Verdict) -> String {
    let growth = format!("growth {} with error {}", short(of.growth), short(of.error));
    match of.stability {
        Stability::Unstable => format!("unstable ({growth})"),
        Stability::Undecided => format!("undecided: a growth may be rounding ({growth})"),
        Stability::SpectrallyStable => "spectrally stable: no mode grows".to_owned(),
        Stability::Attracting => format!("attracting: all modes decay ({growth})"),
    }
}

pub(super) fn table(found: &Linear, width: Option<usize>) -> String {
    let head = [
        "mode",
        "frequency",
        "growth",
        "period",
        "continuous: frequency",
        "growth",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut limits = half(&found.limit_modes).into_iter();
    let number = |x: f64| {
        if x == 0.0 {
            "0".to_owned()
        } else {
            format!("{x:.9}")
        }
    };
    for (i, mode) in half(&found.modes).into_iter().enumerate().take(SHOWN) {
        let frequency = sure(mode.frequency, mode.error);
        let mut row = vec![
            (i + 1).to_string(),
            number(frequency),
            number(sure(mode.growth, mode.error)),
            match frequency > 0.0 {
                true => format!("{:.6}", std::f64::consts::TAU / frequency),
                false => "-".to_owned(),
            },
        ];
        row.extend(match limits.next() {
            Some(limit) => [
                sure(limit.frequency, limit.error),
                sure(limit.growth, limit.error),
            ]
            .map(number),
            None => ["-", "-"].map(str::to_owned),
        });
        rows.push(row);
    }
    aligned(&rows, &[0, 1, 2, 3, 4, 5], width)
}

/// The initial values of the case and of a state.
pub(super) fn state_table(
    problem: &Problem,
    flow: &Steps,
    at: &State,
    width: Option<usize>,
) -> Result<String, Failure> {
    let found = at
        .clone()
        .and_then(|at| flow.with(|own| problem.case_at(&problem.plan.case, own, &at)));
    let found = found.map_err(|why| problem.refused(&why))?;
    Ok(coordinates::compared(
        &problem.card,
        &problem.plan.case.initial,
        &found.initial,
        width,
    ))
}

pub(super) fn object(
    problem: &Problem,
    flow: &Steps,
    fixed: &Found,
    found: &Linear,
) -> Result<Value, Failure> {
    let mode = |mode: &Mode| {
        let parts = |part: &dyn Fn(&clebsch::nalgebra::Complex<f64>) -> f64| {
            mode.vector.iter().map(part).collect::<Vec<f64>>()
        };
        json!({
            "eigenvalue": [mode.eigenvalue.re, mode.eigenvalue.im],
            "frequency": mode.frequency,
            "growth": mode.growth,
            "error": mode.error,
            "vector": {"re": parts(&|z| z.re), "im": parts(&|z| z.im)},
        })
    };
    let modes = |all: &[Mode]| all.iter().map(mode).collect::<Vec<_>>();
    let dimensions = flow.with(|own| own.dimensions());
    let at = fixed
        .state
        .clone()
        .and_then(|at| flow.with(|own| problem.case_at(&problem.plan.case, own, &at)));
    let at = at.map_err(|why| problem.refused(&why))?;
    let initial = problem.card.initial.iter().zip(&at.initial);
    let initial: serde_json::Map<String, Value> = initial
        .map(|(field, values)| (field.ascii.to_owned(), json!(values)))
        .collect();
    Ok(problem.object(json!({
        "state": initial,
        "found_nearby": fixed.away.is_some(),
        "distance": fixed.away.unwrap_or(0.0),
        "displacement": found.residual,
        "coordinates": coordinates::local(&problem.card, &dimensions),
        "stability": format!("{:?}", found.verdict.stability),
        "modes": modes(&found.modes),
        "continuous": {
            "stability": format!("{:?}", found.limit_verdict.stability),
            "modes": modes(&found.limit_modes),
        },
    })))
}

pub(super) fn table_file(found: &Linear) -> String {
    let names = [
        "mode",
        "frequency",
        "growth",
        "error",
        "multiplier_re",
        "multiplier_im",
    ];
    let names = names.map(str::to_owned).to_vec();
    let rows = found.modes.iter().enumerate().map(|(i, mode)| {
        vec![
            i as f64 + 1.0,
            mode.frequency,
            mode.growth,
            mode.error,
            mode.eigenvalue.re,
            mode.eigenvalue.im,
        ]
    });
    csv(&names, rows)
}
