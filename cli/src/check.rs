//! `clebsch check`: whether a model derives and a case starts, without a run.
//! Takes a model and a case; gives one line for each thing that was checked, or the first error.

use crate::Streams;
use crate::failure::Failure;
use crate::gallery::Gallery;
use crate::plain::shown;
use crate::plan::Plan;
use crate::resolve_model::resolved;
use clap::ArgMatches;
use clebsch::card::Card;

/// Runs the command.
///
/// # Errors
/// Usage: the model or the case is wrong; failed: the first step fails.
pub(crate) fn check(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let model = resolved.entry.card;
    writeln!(streams.out, "model {}: derived", model.kebab)?;
    let plan = Plan::new(&resolved, matches)?;
    let card = resolved.entry.card_of(&plan.case);
    for line in plan.starts(&card) {
        writeln!(streams.out, "{line}")?;
    }
    let mut trajectory = plan.open(&card)?;
    let name = shown(&plan.case.name);
    writeln!(streams.out, "case {name}: {}", count(&card))?;
    if let Some(warning) = trajectory.kinetic_warning() {
        writeln!(streams.err, "clebsch: warning: {warning}")?;
    }
    trajectory
        .step()
        .map_err(|error| Failure::Failed(error.to_string()))?;
    writeln!(streams.out, "first step: solved")?;
    Ok(())
}

/// How many values a case gives.
fn count(card: &Card) -> String {
    let numbers =
        |fields: &[clebsch::card::Field]| -> usize { fields.iter().map(|f| f.count()).sum() };
    format!(
        "{} numbers of parameters and {} of initial values accepted",
        numbers(card.parameters),
        numbers(card.initial)
    )
}
