//! `clebsch check`: whether a model derives and a case starts, without a run. Takes a model and a case; gives one
//! line for each check, or the first error.

use crate::models::gallery::Gallery;
use crate::named::cases::WhichCase;
use crate::named::resolve::{NamedModel, case_of, entry, resolve_model, resolved};
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clap::ArgMatches;
use clebsch::card::Card;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::Statement;

/// Runs the command.
///
/// # Errors
/// Usage: the model or the case is wrong; failed: the first step fails.
pub(crate) fn check(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    if let (NamedModel::Text(text), case) = resolve_model(gallery, matches)?
        && let Err(no_case) = case_of(&text, case)
    {
        let entry = entry(&text, &WhichCase::First, streams)?;
        writeln!(streams.out, "{}", derived(&entry.card))?;
        return Err(no_case);
    }
    let resolved = resolved(gallery, matches, streams)?;
    writeln!(streams.out, "{}", derived(&resolved.entry.card))?;
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

/// That a model derives, and how many configurations it states.
fn derived(card: &Card) -> String {
    let stated = pipeline::parse_source(card.source).map(|model| {
        let each = model.statements.iter().map(|s| match s {
            Statement::Group { .. } => 1,
            Statement::Field { names, .. } => names.len(),
            _ => 0,
        });
        each.sum::<usize>()
    });
    match stated {
        Ok(1) => format!("model {}: derived, 1 configuration", card.kebab),
        Ok(count) => format!("model {}: derived, {count} configurations", card.kebab),
        Err(_) => format!("model {}: derived", card.kebab),
    }
}

/// How many values a case gives.
fn count(card: &Card) -> String {
    let numbers =
        |fields: &[clebsch::card::Field]| -> usize { fields.iter().map(|f| f.count()).sum() };
    format!(
        "{} parameter values and {} initial values accepted",
        numbers(card.parameters),
        numbers(card.initial)
    )
}
