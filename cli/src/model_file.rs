//! A model in a file: read, derived and executed without a build.
//! Takes a path; gives the model with a case of sample values, to start one's own from.

use crate::case_file;
use crate::case_file::labels::{self, Stated};
use crate::failure::Failure;
use crate::gallery::{Case, Entry, Gallery};
use crate::plain::shown;
use crate::plan;
use crate::sample::onto_constraints;
use crate::suggestion::did_you_mean;
use clebsch::card::{Card, Field, Kind};
use clebsch_core::lattice::Choice;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};
use clebsch_interpret::Refused;
use std::io::Write;
use std::path::Path;

/// More sites than this are not given sample values where a case has its own.
const LONG: usize = 256;

/// Whether a model's text is meant rather than its name.
pub(crate) fn is_meant(name: &str) -> bool {
    let path = Path::new(name);
    path.exists() || path.extension().is_some_and(|end| end == "clebsch")
}

/// The text of a model's file.
///
/// # Errors
/// Usage: there is no such file, or it cannot be read.
pub(crate) fn text(gallery: &Gallery, name: &str) -> Result<String, Failure> {
    if !Path::new(name).exists() {
        let known = gallery.entries.iter().map(|entry| entry.card.kebab);
        return Err(Failure::Usage(format!(
            "`{}` is neither a model nor a file{}",
            shown(name),
            did_you_mean(name, known)
        )));
    }
    std::fs::read_to_string(name).map_err(|error| {
        Failure::Usage(format!(
            "cannot read the model file {}: {error}",
            shown(name)
        ))
    })
}

/// The model of a file, with a case of sample values. What derives and is hardly meant is told to `err`.
///
/// # Errors
/// Usage: the file cannot be read, its text does not derive, or the model needs a build.
pub(crate) fn read(
    gallery: &Gallery,
    name: &str,
    case: Option<&str>,
    err: &mut dyn Write,
) -> Result<Entry, Failure> {
    let text = text(gallery, name)?;
    let name = shown(name).to_string();
    let in_file = case.filter(|c| plan::is_file(c));
    let case_text = in_file.map(plan::case_text).transpose()?;
    let of_case = in_file.zip(case_text.as_deref());
    let filled = case_file::functions::put_in(&text, of_case)?;
    let text = filled.text.as_str();
    let stated = Stated::read(text);
    let choice = match &stated {
        None => None,
        Some(stated) => chosen(stated, of_case)?,
    };
    let read = match &choice {
        None => clebsch_interpret::card_and_warnings(text),
        Some(choice) => clebsch_interpret::card_on_lattice(text, choice),
    };
    let (card, warnings) = read.map_err(|refused| match refused {
        Refused::Model(errors) => filled
            .wrong_in(&errors, of_case)
            .unwrap_or_else(|| Failure::Usage(format!("\n{}", errors.render(text, &name)))),
        other => Failure::Usage(format!("{name}: {other}")),
    })?;
    for warning in warnings {
        // What cannot be written there stands in the derivation too.
        let _ = write!(err, "{}", warning.diagnostic.render("warning", text, &name));
    }
    let cases = match stated.zip(choice) {
        None => vec![sample(&card, &name)],
        // Of a long line the values are those of a file.
        Some((stated, choice))
            if case.is_some()
                && (choice.counts.iter().any(|n| *n > LONG)
                    || !stated.lattice.meshes.is_empty()) =>
        {
            Vec::new()
        }
        Some((stated, choice)) => {
            // Of a case with values of its own no sample is asked.
            let sample = case_file::write_lattice(&card, &stated, &choice, &name);
            sample_on_lattice(&sample, &stated, &card)
                .into_iter()
                .collect()
        }
    };
    Ok(Entry { card, cases })
}

/// How many sites there are and how the line ends: as the case says, if one is given by a file.
fn chosen(stated: &Stated, case: Option<(&str, &str)>) -> Result<Option<Choice>, Failure> {
    match case {
        None => Ok(stated.default_choice()),
        Some((file, text)) => case_file::choice(file, text, stated),
    }
}

/// The sample case of a model with labels.
fn sample_on_lattice(text: &str, stated: &Stated, card: &Card) -> Result<Case, Failure> {
    let out = labels::written_out("sample", text, stated, card)?;
    let located = case_file::read_written_out("sample", &out, card)?;
    Ok(located.case)
}

/// Values that are admissible for most models, and of no further meaning.
fn sample(card: &Card, file: &str) -> Case {
    let turned = turns(card);
    let held = is_held(card);
    let values = |fields: &[Field]| {
        let sample = |f: &Field| match held && is_momentum(f) {
            true => vec![0.0; f.count()],
            false => of_field(f, turned),
        };
        fields.iter().map(sample).collect()
    };
    let mut case = Case {
        name: "sample".to_owned(),
        doc: format!(
            "sample values, to start a case of your own from: clebsch case {file} > my.toml"
        ),
        h: 0.01,
        steps: 1000,
        parameters: values(card.parameters),
        initial: values(card.initial),
        bounds: Vec::new(),
    };
    if let Ok(model) = pipeline::parse_source(card.source)
        && held
    {
        onto_constraints(&model, card, &mut case);
    }
    case
}

/// Whether the model of a card holds constraints.
pub(crate) fn is_held(card: &Card) -> bool {
    pipeline::parse_source(card.source).is_ok_and(|model| has_holds(&model))
}

/// What a case of such a model is told at its head.
pub(crate) const OF_HELD: &str = "Constraints are held: the initial configuration must satisfy them, and momenta must belong to velocities along them.";

/// Whether configurations are held by constraints, across which no momentum may point: samples are at rest.
pub(crate) fn has_holds(model: &Model) -> bool {
    let mut statements = model.statements.iter();
    statements.any(|s| matches!(s, Statement::Hold { .. }))
}

/// Whether it is the momentum of a configuration.
pub(crate) fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Whether bodies turn: momenta of square shape are skew.
pub(crate) fn turns(card: &Card) -> bool {
    card.initial.iter().any(|f| f.kind == Kind::Rotation)
}

/// An entry of the sample value of a field without labels' expressions.
pub(crate) fn sample_entry(field: &Field, turned: bool, i: usize, j: usize) -> f64 {
    let all = of_field(field, turned);
    all.get(i * field.cols + j).copied().unwrap_or(0.0)
}

/// Sample values of a field; `turned` where momenta of square shape are skew.
fn of_field(field: &Field, turned: bool) -> Vec<f64> {
    let (rows, cols) = (field.rows, field.cols);
    let square = rows == cols && rows > 1;
    let entry = |i: usize, j: usize| match field.kind {
        Kind::UnitQuaternion if cols == 1 => f64::from(u8::from(i == 0)),
        Kind::SecondMoments | Kind::Diagonal | Kind::Symmetric if i == j => (i + 1) as f64,
        Kind::Matrix | Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion if square => {
            f64::from(u8::from(i == j))
        }
        Kind::SecondMoments | Kind::Diagonal | Kind::Symmetric => 0.0,
        Kind::Skew => skew(i, j),
        Kind::BodyMomentum | Kind::SpatialMomentum if square && turned => 0.1 * skew(i, j),
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum => {
            0.1 / (1 + i + cols * j) as f64
        }
        _ => 1.0 / (1 + i * cols + j) as f64,
    };
    (0..rows)
        .flat_map(|i| (0..cols).map(move |j| (i, j)))
        .map(|(i, j)| entry(i, j))
        .collect()
}

fn skew(i: usize, j: usize) -> f64 {
    let size = 1.0 / (i + j).max(1) as f64;
    match i.cmp(&j) {
        std::cmp::Ordering::Less => -size,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => size,
    }
}
