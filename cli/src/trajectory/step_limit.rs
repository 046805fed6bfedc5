//! What small motions about the start ask of a step, told before it is taken.
//! Takes a card with its plan; gives the frequency of the fastest motion and the longest step, or why there is none.

use crate::models::held;
use crate::plan::Plan;
use crate::words::number::plain;
use clap::ArgMatches;
use clebsch::card::Card;
use clebsch::integrate::{Effort, LongestStep, Unknown};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Most numbers of initial values of which the longest step is sought: each of some sixty openings reads them all.
const SOUGHT: usize = 20_000;

/// The same where constraints are held, whose steps are searches and of which twice as many are taken.
const SOUGHT_HELD: usize = 5_000;

/// The option that says how long is searched.
const OPTION: &str = "--stability-limit";

/// For how long the stability limit is searched; zero for no search.
pub(crate) fn patience(matches: &ArgMatches) -> Duration {
    let seconds = matches.get_one::<f64>("stability-limit").copied();
    // A number of seconds that no clock counts to is no bound.
    Duration::try_from_secs_f64(seconds.unwrap_or(1.0)).unwrap_or(Duration::MAX)
}

/// What is known of the longest step before a run.
#[derive(Clone, Debug)]
pub(crate) enum StepLimit {
    /// It is told: where sites move one another, or the step is not far below what is too long.
    Known(LongestStep),
    /// Of a line it would be told, but is not sought.
    NotSought(String),
    /// The search was given up after so long.
    Cut(Duration),
    /// Nothing is to be said.
    Silent,
}

impl StepLimit {
    /// Of a plain step, which the others are made of, where it is found within this time. No step of a run depends on it.
    pub(crate) fn of(card: &Card, plan: &Plan, patience: Duration) -> Self {
        if patience.is_zero() {
            return Self::Silent;
        }
        let case = &plan.case;
        let has_sites = plan.choice.is_some();
        let numbers: usize = case.initial.iter().map(Vec::len).sum();
        let is_held = held::is_held(card);
        let most = match is_held {
            true => SOUGHT_HELD,
            false => SOUGHT,
        };
        let why = if numbers > most {
            format!("the state has {numbers} numbers, more than {most}")
        } else {
            let begun = Instant::now();
            let effort = Effort {
                ended: &|| begun.elapsed() >= patience,
                // Of one that is far above the step nothing is told where there are no sites.
                far: has_sites,
            };
            let found = LongestStep::by(effort, card, &case.parameters, &case.initial, case.h);
            let near = |limit: &LongestStep| {
                case.h.abs() > 0.5 * limit.step || limit.warning(case.h).is_some()
            };
            match found {
                Ok(limit) if has_sites || near(&limit) => return Self::Known(limit),
                Err(Unknown::Unfinished) => return Self::Cut(patience),
                Err(why) if has_sites => why.to_string(),
                Ok(_) | Err(_) => return Self::Silent,
            }
        };
        match has_sites {
            true => Self::NotSought(why),
            false => Self::Silent,
        }
    }

    /// What is wrong with steps of `h`, if anything.
    pub(crate) fn warning(&self, h: f64) -> Option<String> {
        match self {
            Self::Known(limit) => limit.warning(h),
            Self::NotSought(_) | Self::Cut(_) | Self::Silent => None,
        }
    }

    /// A line above a run with steps of `h`.
    pub(crate) fn told(&self, h: f64) -> Option<String> {
        let short = |x: f64| plain(three_digits(x));
        match self {
            Self::Known(limit) if limit.step.is_finite() => Some(format!(
                "fastest small motion about the start, at rest: frequency ω = {}; longest step 2/ω = {}, of which h is {}",
                short(limit.frequency()),
                short(limit.step),
                short(h.abs() / limit.step),
            )),
            Self::NotSought(why) => Some(format!(
                "longest step of small motions about the start: not computed, since {why}"
            )),
            Self::Cut(patience) => Some(format!(
                "stability limit of the step size: not found within {} s; {OPTION} SECONDS searches longer",
                plain(patience.as_secs_f64())
            )),
            Self::Known(_) | Self::Silent => None,
        }
    }

    /// The same numbers for programs; null where there are none.
    pub(crate) fn json(&self, h: f64) -> Value {
        match self {
            Self::Known(limit) if limit.step.is_finite() => json!({
                "frequency": limit.frequency(),
                "step": limit.step,
                "share": h.abs() / limit.step,
            }),
            _ => Value::Null,
        }
    }
}

fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
