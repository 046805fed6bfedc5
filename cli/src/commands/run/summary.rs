//! The text that `clebsch run` prints about a run: its title, and lines below the table of invariants.
//! Takes a card, a plan and a finished run; gives text.

use crate::output::Finished;
use crate::plan::Plan;
use crate::plan::end;
use crate::terminal::failure::Failure;
use crate::words::lines::first_line;
use crate::words::number;
use crate::words::plain::{shown, steps};
use crate::words::width::paragraph;
use clebsch::card::Card;
use std::io::Write;

/// The column at which the texts of the derivation begin, after their names.
const INDENT: usize = 21;

/// How much a run prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verbosity {
    /// Warnings and errors only.
    Nothing,
    /// The case and the drift of invariants.
    Result,
    /// The derivation and the solver as well.
    All,
}

/// Prints the case; for [`Verbosity::All`] also the derivation and the method (`way`) that takes steps.
///
/// # Errors
/// As for writing.
pub(crate) fn title(
    out: &mut dyn Write,
    width: Option<usize>,
    card: &Card,
    plan: &Plan,
    (told, way): (Verbosity, &str),
) -> Result<(), Failure> {
    if told == Verbosity::Nothing {
        return Ok(());
    }
    let case = &plan.case;
    let mut say = |text: &str, indent: usize| {
        let text = paragraph(text, width, indent);
        out.write_all(text.as_bytes())
    };
    let order = plan.order.unwrap_or(card.order);
    if told == Verbosity::All {
        say(&format!("{}: {}", card.kebab, first_line(card.doc)), 2)?;
        for line in card.summary.trim().lines() {
            say(line, INDENT)?;
        }
        let reversible = match card.reversible {
            true => "reversible",
            false => "not reversible",
        };
        say(&format!("solver: {}; {reversible}", card.solver), 2)?;
        say(&format!("steps: {way}"), 2)?;
        if order > card.order {
            say(&card.method_of_order(order, plan.compensated), 2)?;
        }
    }
    let doc = first_line(&case.doc);
    let colon = if doc.is_empty() { "" } else { ": " };
    say(
        &format!("{}, case {}{colon}{doc}", card.kebab, shown(&case.name)),
        2,
    )?;
    let time = number::plain(end(case.h, case.steps));
    say(
        &format!(
            "h = {}, {}, to time {time}; order {order}",
            case.h,
            steps(case.steps)
        ),
        2,
    )?;
    for line in plan.starts(card) {
        say(&line, 2)?;
    }
    Ok(())
}

/// How accurately the steps are solved, and whether all steps were taken.
pub(crate) fn below_the_table(run: &Finished<'_>, made: u64) -> Vec<String> {
    let stopped = run.stopped.as_ref().map(|stopped| {
        let time = number::plain(stopped.time);
        let all = steps(run.plan.case.steps);
        format!(
            "stopped at node {} (time {time}), after {made} of {all}; the results end at this node",
            stopped.node
        )
    });
    let halved = run.halvings.filter(|h| h.steps > 0).map(|h| {
        format!(
            "subdivided steps: {} of {made}, into up to {} substeps; this run is not symplectic, and its energy may drift",
            steps(h.steps),
            h.parts
        )
    });
    let looked = (run.plan.every > 1).then(|| {
        format!(
            "drifts: sampled every {} nodes and at the last node (--every)",
            run.plan.every
        )
    });
    let stated = run.stated.as_ref().map(ToString::to_string);
    looked
        .into_iter()
        .chain(stated)
        .chain(halved)
        .chain(stopped)
        .collect()
}
