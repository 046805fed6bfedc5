//! `clebsch compare`: the generated stepper, the hand-written one and other methods. Takes a
//! model and a case; gives errors against a reference, drifts and times, as table, JSON, CSV and plot.

mod clock;
pub(crate) mod course;
mod draw;
pub(crate) mod score;

pub(crate) use score::{Curve, Score};

use crate::models::gallery::Gallery;
use crate::named::resolve::resolved;
use crate::output::Staging;
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::{DONE, FAILED, Failure};
use crate::trajectory::record::LARGEST;
use crate::words::columns::aligned;
use crate::words::lines::first_line;
use crate::words::plain::{shown, steps};
use crate::words::width::paragraph;
use clap::ArgMatches;
use clebsch::card::{Card, Settings};
use clebsch::record::Record;
use clebsch::solvers::Method;
use clebsch_comparisons::gallery::{Offer, Role, offers};
use course::Course;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;

/// Files of a comparison.
const FILES: [&str; 3] = ["comparison.csv", "comparison.json", "comparison.svg"];

/// A completed comparison.
pub(crate) struct Comparison {
    /// The reference for the errors, and its accuracy as far as it is known.
    pub reference: String,
    /// How the model's own stepper was obtained.
    pub made: StepperOrigin,
    /// The model's own stepper first, the reference last.
    pub scores: Vec<Score>,
}

/// Runs the command. If a method stops early, its row reports the part that it computed. If the generated
/// stepper stops early, the exit code equals the exit code of a run that stopped.
///
/// # Errors
/// Usage: the request is wrong. Failed: the generated stepper makes no step, or a file cannot be written.
pub fn compare(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    let resolved = resolved(gallery, matches, streams)?;
    let entry = &resolved.entry;
    let plan = Plan::new(&resolved, matches)?;
    let card = &entry.card_of(&plan.case);
    let as_json = matches.get_flag("json");
    let target = matches.get_one::<PathBuf>("out");
    let staging = target
        .map(|target| Staging::new(target, matches.get_flag("force"), &FILES))
        .transpose()?;
    let made = match resolved.compiled {
        true => StepperOrigin::Built,
        false => StepperOrigin::Read,
    };
    let done = against_all(card, &plan, made, streams.progress)?;
    let mut object = comparison_json(card, &plan, &done);
    let stopped = done.scores.first().and_then(|own| own.stopped.clone());
    let code = if stopped.is_some() { FAILED } else { DONE };
    let (mut files, mut place): (&[&str], _) = (&[], None);
    if let (Some(staging), Some(target)) = (staging, target) {
        write(&staging, card, &plan, &done, &object)?;
        place = Some(staging.commit().map(|()| shown(target))?);
        files = &FILES;
    }
    if as_json {
        if let Some(object) = object.as_object_mut() {
            object.insert("files".to_owned(), json!(files));
            let out = place.as_ref().map(ToString::to_string);
            object.insert("out".to_owned(), json!(out));
            object.insert("exit_code".to_owned(), json!(code));
            if let Some((_, why)) = &stopped {
                object.insert("error".to_owned(), json!(why));
            }
        }
        writeln!(streams.out, "{object}")?;
    } else {
        print(streams.out, card, &plan, &done, streams.width)?;
        if let Some(place) = place {
            let written = format!("written to {place}: {}", files.join(", "));
            let written = paragraph(&written, streams.width, 2);
            write!(streams.out, "\n{written}")?;
        }
    }
    // The exit code reports the stop as well, so a message that cannot be written is not lost.
    if let Some((_, why)) = &stopped {
        let _ = writeln!(streams.err, "clebsch: {why}");
    }
    Ok(code)
}

/// How the stepper of a model was obtained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepperOrigin {
    /// It was generated as Rust and compiled.
    Built,
    /// It was read from a file and is executed.
    Read,
}

impl StepperOrigin {
    /// The name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Built => "generated",
            Self::Read => "interpreted",
        }
    }
}

/// Compares all methods that are available for the model.
///
/// # Errors
/// As for the model's own stepper.
pub(crate) fn against_all(
    card: &Card,
    plan: &Plan,
    made: StepperOrigin,
    progress: bool,
) -> Result<Comparison, Failure> {
    // Other methods implement the equations of the gallery. A different model with the same name does not have such
    // methods.
    let shipped = clebsch_models::find(card.kebab);
    let offers = match shipped.is_some_and(|e| e.card.fingerprint == card.fingerprint) {
        true => offers(card.kebab),
        false => Vec::new(),
    };
    let size = Record::size(card, plan.case.steps, plan.every);
    let courses = 2 + offers.len() as u64;
    if size.saturating_mul(courses) > LARGEST {
        let every = plan
            .every
            .saturating_mul((size.saturating_mul(courses)).div_ceil(LARGEST));
        return Err(Failure::Usage(format!(
            "--every {}: the results would take too much memory; give --every {every} or more",
            plan.every
        )));
    }
    // One measure for all methods: the natural scales along the generated stepper's course.
    let (own, scales) = course::up_to_stop(card, plan, progress)?;
    let mut others: Vec<(Offer, Course)> = offers
        .into_iter()
        .map(|offer| (offer, course::other(card, plan, &offer)))
        .collect();
    let found = others
        .iter()
        .position(|(offer, course)| offer.role == Role::Reference && course.stopped.is_none());
    let reference = found.map(|index| others.remove(index));
    let (truth, said, last) = match reference {
        Some((offer, course)) => (
            course,
            format!("{}: {}", offer.name, offer.doc),
            (offer.name, offer.doc.to_owned(), clock::other(plan, &offer)),
        ),
        None => {
            // If the run stops early, the reference ends at the same node.
            let mut reached = plan.clone();
            if let Some((node, _)) = &own.stopped {
                reached.case.steps = node - 1;
            }
            let (course, accuracy) =
                course::extrapolated(card, &reached).map_err(|failure| match &own.stopped {
                    None => failure,
                    Some((_, why)) => Failure::Failed(why.clone()),
                })?;
            let doc = format!(
                "the {} stepper with steps h to h/8, extrapolated",
                made.name()
            );
            let why = if others.is_empty() {
                "this model has no hand-written equations"
            } else {
                "the reference of this model failed"
            };
            let said = format!(
                "extrapolated: {why}; the reference is {doc}. It tests the accuracy of the step, not the equations; the last term \
                 of the extrapolation is {accuracy:.0e}"
            );
            (course, said, ("extrapolated", doc, None))
        }
    };
    let score = |name: &str, doc: String, role, nanoseconds, course: Course| Score {
        name: name.to_owned(),
        doc,
        role,
        errors: score::errors(card, &course.record, &truth.record),
        drifts: score::drifts(card, &course.record, &scales),
        nanoseconds,
        stopped: course.stopped,
    };
    let order = plan.order.unwrap_or(card.order);
    let doc = format!("the stepper derived from the model, order {order}");
    let time = clock::generated(card, plan);
    let mut scores = vec![score(made.name(), doc, None, time, own)];
    for &higher in card.orders.iter().filter(|higher| **higher > order) {
        let mut plan = plan.clone();
        plan.order = Some(higher);
        plan.compensated &= Settings::COMPENSATED.contains(&higher);
        let course = course_or_why(card, &plan);
        let time = clock::generated(card, &plan);
        let doc = format!(
            "the same stepper, {}",
            card.method_of_order(higher, plan.compensated)
        );
        scores.push(score(
            &format!("{}-{higher}", made.name()),
            doc,
            None,
            time,
            course,
        ));
    }
    // If no solver is requested, the model takes its first solver.
    let own = plan
        .solver
        .map(Method::name)
        .or(card.solvers.first().copied());
    for name in card.solvers.iter().filter(|name| Some(**name) != own) {
        let mut plan = plan.clone();
        plan.solver = name.parse().ok();
        let course = course_or_why(card, &plan);
        let time = clock::generated(card, &plan);
        let doc = format!("the same stepper, solved by {name}");
        let name = format!("{}-{name}", made.name());
        scores.push(score(&name, doc, None, time, course));
    }
    for (offer, course) in others {
        let time = clock::other(plan, &offer);
        let doc = offer.doc.to_owned();
        scores.push(score(offer.name, doc, Some(offer.role), time, course));
    }
    let (name, doc, time) = last;
    let course = truth.clone();
    scores.push(score(name, doc, Some(Role::Reference), time, course));
    Ok(Comparison {
        reference: said,
        made,
        scores,
    })
}

/// The generated stepper with another solver or order. A case may be too stiff for the largest steps of a
/// composition, or beyond the reach of a solver. The row then gives the reason.
fn course_or_why(card: &Card, plan: &Plan) -> Course {
    match course::up_to_stop(card, plan, false) {
        Ok((course, _)) => course,
        Err(why) => Course {
            record: Record::default(),
            stopped: Some((0, why.to_string())),
        },
    }
}

fn print(
    out: &mut dyn Write,
    card: &Card,
    plan: &Plan,
    done: &Comparison,
    width: Option<usize>,
) -> io::Result<()> {
    let mut say = |text: String| out.write_all(paragraph(&text, width, 2).as_bytes());
    let case = &plan.case;
    let doc = first_line(&case.doc);
    let colon = if doc.is_empty() { "" } else { ": " };
    say(format!("{}: {}", card.kebab, first_line(card.doc)))?;
    say(format!("case {}{colon}{doc}", shown(&case.name)))?;
    let end = crate::plan::end(case.h, case.steps);
    say(format!(
        "h = {}, {}, to time {end}",
        case.h,
        steps(case.steps)
    ))?;
    say(format!("reference {}", done.reference))?;
    say(format!(
        "errors |x - reference| / largest |reference|, drifts |I - I(0)| / scale: maxima over {}",
        match plan.every {
            1 => "any node".to_owned(),
            every => format!("one node in {every}"),
        }
    ))?;
    writeln!(out)?;
    out.write_all(score::table(&done.scores, width).as_bytes())?;
    writeln!(out)?;
    let mut rows = Vec::new();
    for score in &done.scores {
        rows.push(vec![score.name.clone(), score.doc.clone()]);
        if let Some((node, why)) = &score.stopped {
            rows.push(vec![String::new(), format!("failed at node {node}: {why}")]);
        }
    }
    out.write_all(aligned(&rows, &[], width).as_bytes())
}

fn comparison_json(card: &Card, plan: &Plan, done: &Comparison) -> Value {
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "model": card.kebab,
        "fingerprint": format!("{:016x}", card.fingerprint),
        "case": plan.case.name,
        "h": plan.case.h,
        "steps": plan.case.steps,
        "every": plan.every,
        "arguments": plan.arguments,
        "reference": done.reference,
        "methods": done.scores.iter().map(|score| score.json(done.made)).collect::<Vec<_>>(),
    })
}

/// Writes the files of a comparison.
fn write(
    staging: &Staging,
    card: &Card,
    plan: &Plan,
    done: &Comparison,
    object: &Value,
) -> Result<(), Failure> {
    let [csv, json, svg] = FILES;
    staging.write(csv, |file| write_csv(file, &done.scores))?;
    let text = format!("{object:#}\n");
    staging.write(json, |file| file.write_all(text.as_bytes()))?;
    let drawn = draw::comparison(card, plan, done)
        .map_err(|error| Failure::Failed(format!("cannot draw {svg}: {error}")))?;
    staging.write(svg, |file| file.write_all(drawn.as_bytes()))
}

/// One line per method and sample: long form, as tools that draw want it.
fn write_csv(file: &mut dyn Write, scores: &[Score]) -> io::Result<()> {
    write!(file, "method,time")?;
    if let Some(first) = scores.first() {
        for curve in &first.errors {
            write!(file, ",error_{}", curve.name)?;
        }
        for curve in &first.drifts {
            write!(file, ",drift_{}", curve.name)?;
        }
    }
    writeln!(file)?;
    for score in scores {
        let curves: Vec<&Curve> = score.errors.iter().chain(&score.drifts).collect();
        let samples = curves.iter().map(|curve| curve.points.len()).min();
        for sample in 0..samples.unwrap_or(0) {
            let point = |curve: &&Curve| curve.points.get(sample).copied().unwrap_or_default();
            let time = curves.first().map(point).unwrap_or_default().0;
            write!(file, "{},{time:?}", score.name)?;
            for curve in &curves {
                write!(file, ",{:?}", point(curve).1)?;
            }
            writeln!(file)?;
        }
    }
    Ok(())
}
