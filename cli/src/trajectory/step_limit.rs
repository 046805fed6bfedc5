//! The stability limit of the step size, found before the first step.
//! Takes a card with its plan; gives the highest frequency of small motions about the start and the stability
//! limit, or why there is none.

use crate::models::constraints;
use crate::plan::Plan;
use crate::words::number::plain;
use clap::ArgMatches;
use clebsch::card::Card;
use clebsch::integrate::{Effort, LongestStep, Unknown};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// The largest number of initial values for which the limit is searched: each of about sixty starts reads all of
/// them.
const SOUGHT: usize = 20_000;

/// The largest number with constraints. Their steps are iterative, and the search takes twice as many.
const SOUGHT_HELD: usize = 5_000;

/// The option that bounds the time of the search.
const OPTION: &str = "--stability-limit";

/// For how long the stability limit is searched; zero for no search.
pub(crate) fn patience(matches: &ArgMatches) -> Duration {
    let seconds = matches.get_one::<f64>("stability-limit").copied();
    // A number of seconds too large for a duration means no time limit.
    Duration::try_from_secs_f64(seconds.unwrap_or(1.0)).unwrap_or(Duration::MAX)
}

/// The stability limit, as far as it is known before a run.
#[derive(Clone, Debug)]
pub(crate) enum StepLimit {
    /// The limit is known. It is reported if the model has sites, if the step size is more than half of it, or
    /// if a warning applies.
    Known(LongestStep),
    /// The model has sites, but the limit was not searched for or not found, with the reason.
    NotSought(String),
    /// The search reached its time limit.
    Cut(Duration),
    /// Nothing is reported.
    Silent,
}

impl StepLimit {
    /// Searches for the limit of a plain step, of which compositions consist, for at most this time. The result
    /// does not change the run.
    pub(crate) fn of(card: &Card, plan: &Plan, patience: Duration) -> Self {
        if patience.is_zero() {
            return Self::Silent;
        }
        let case = &plan.case;
        let has_sites = plan.choice.is_some();
        let numbers: usize = case.initial.iter().map(Vec::len).sum();
        let is_held = constraints::card_has_constraints(card);
        let most = match is_held {
            true => SOUGHT_HELD,
            false => SOUGHT,
        };
        let why = if numbers > most {
            format!("the state has {numbers} numbers, and the search supports {most}")
        } else {
            let begun = Instant::now();
            let effort = Effort {
                ended: &|| begun.elapsed() >= patience,
                // Without sites, a limit far above the step size is not reported, so it need not be found.
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

    /// A warning if steps of `h` exceed the stability limit, or if small motions grow.
    pub(crate) fn warning(&self, h: f64) -> Option<String> {
        match self {
            Self::Known(limit) => limit.warning(h),
            Self::NotSought(_) | Self::Cut(_) | Self::Silent => None,
        }
    }

    /// A line above a run with steps of `h`.
    pub(crate) fn summary_line(&self, h: f64) -> Option<String> {
        let short = |x: f64| plain(three_digits(x));
        match self {
            Self::Known(limit) if limit.step.is_finite() => Some(format!(
                "fastest small motion about the initial configuration: ω = {}; stability limit 2/ω = {}; h is {} of it",
                short(limit.frequency()),
                short(limit.step),
                short(h.abs() / limit.step),
            )),
            Self::NotSought(why) => Some(format!(
                "stability limit of small motions: not computed, since {why}"
            )),
            Self::Cut(patience) => Some(format!(
                "stability limit of the step size: not found within {} s; {OPTION} SECONDS searches longer",
                plain(patience.as_secs_f64())
            )),
            Self::Known(_) | Self::Silent => None,
        }
    }

    /// The limit as JSON; null if it is unknown.
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
