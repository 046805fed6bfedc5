//! The program of a step: the operations that a case runs, counted and listed. Takes a model and a case; gives one section
//! for each recorded function.

use crate::models::gallery::{self, Gallery};
use crate::named::cases::{NamedCases, WhichCase};
use crate::named::model_file::ModelText;
use crate::named::resolve::{NamedModel, case_of, entry, named, parts, written};
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::words::number::plain;

/// Steps before the program is listed. Functions are recorded after some steps, so that a short run does not wait for it.
const STEPS: usize = 12;

/// The program of MODEL or MODEL:CASE as text.
///
/// # Errors
/// Usage: the model or the case is unknown or wrong. Failed: a step fails, or the model runs without a recorded program.
pub(super) fn program(
    gallery: &Gallery,
    name: &str,
    streams: &mut Streams<'_>,
) -> Result<String, Failure> {
    if name == "-" {
        return Err(Failure::Usage(
            "a text from standard input has no case; save it as NAME.clebsch, with a case NAME.toml".to_owned(),
        ));
    }
    let (name, case) = parts(name, None)?;
    let (text, case) = match named(gallery, name, "derive needs a model or its text")? {
        NamedModel::Compiled(entry) => {
            let text = ModelText {
                name: entry.card.kebab.to_owned(),
                text: entry.card.source.to_owned(),
                cases: NamedCases::default(),
                is_path: false,
                cache: gallery.cache.clone(),
            };
            (text, WhichCase::Text(written(entry, case)?))
        }
        NamedModel::Text(text) => {
            let case = case_of(&text, case)?;
            (text, case)
        }
    };
    let entry = entry(&text, &case, streams)?;
    let plan = match &case {
        WhichCase::Text(text) => Plan::of_text(&entry, text, true)?,
        _ => Plan::of(gallery::case(&entry, None)?, 1),
    };
    let card = entry.card_of(&plan.case);
    let mut trajectory = plan.open(&card)?;
    let mut observed = vec![0.0; card.observable_count()];
    let mut invariants = vec![0.0; card.invariant_count()];
    for _ in 0..STEPS {
        let stepped = trajectory.step();
        stepped.map_err(|error| Failure::Failed(error.to_string()))?;
        trajectory.observe(&mut observed);
        trajectory.invariants(&mut invariants);
        trajectory.scales(&mut invariants);
    }
    let Some(sections) = trajectory.operations() else {
        return Err(Failure::Failed(format!(
            "`{}` has no recorded program: its steps run functions of the runtime. `--format rust` prints the emitted code",
            card.kebab
        )));
    };
    let is_listed = |line: &str| line.starts_with("step") || line.starts_with("loop");
    let remark = match sections.lines().any(is_listed) {
        true => "",
        false => "\nthe step is a function of the runtime, which is not recorded",
    };
    Ok(format!(
        "program of {}, case {}, h = {}; any parameters and step size with these decisions\nrotations are unit quaternions; a \
         number of the model such as factor.1 is prepared from the parameters{remark}\n\n{sections}",
        card.kebab,
        plan.case.name,
        plain(plan.case.h)
    ))
}
