//! Prints a case as a complete TOML file that parses to the same numbers, bit for bit. Takes a card and a case; gives
//! the text, with comments on shape, frame and units.

use super::motion::elements;
use super::velocity::Way;
use crate::models::constraints::{CONSTRAINTS_REMARK, has_constraints};
use crate::models::gallery::Case;
use crate::words::plain::shown;
use clebsch::card::{Card, Conserved, Field, Kind};
use clebsch_core::pipeline;
use std::fmt::Write as _;

/// The default bound on the drift of an exactly conserved invariant. Rounding adds at most about 1e-16 per step, so
/// the bound suffices for 1e4 steps of any stepper and 1e6 steps of a careful one.
pub(crate) const DEFAULT_BOUND: f64 = 1e-12;

/// The TOML text of `case`, of the model that is called `named` on the command line: its name, or a path.
#[must_use]
pub fn write(card: &Card, case: &Case, named: &str) -> String {
    let mut text = String::new();
    comment(
        &mut text,
        &format!("A case of the model {}; run it with", card.kebab),
    );
    comment(
        &mut text,
        &format!("  clebsch run {} --case THIS-FILE.toml", on_a_line(named)),
    );
    comment(
        &mut text,
        "Units: any consistent system. The model fixes none.",
    );
    let model = pipeline::parse_source(card.source).ok();
    if model.as_ref().is_some_and(has_constraints) {
        comment(&mut text, CONSTRAINTS_REMARK);
    }
    let mut line = |key: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{key} = {value}");
    };
    line("model", quoted(card.kebab));
    line("name", quoted(&case.name));
    line("doc", quoted(&case.doc));
    line("h", format!("{:?}     # step size, positive", case.h));
    line(
        "steps",
        format!("{}     # number of steps, at least 1", case.steps),
    );
    if let Some(model) = &model {
        super::functions::sample_table(&mut text, model, false);
    }
    table(&mut text, "parameters", card.parameters, &case.parameters);
    table(&mut text, "initial", card.initial, &case.initial);
    bounds(&mut text, card, &case.bounds);
    text
}

/// For a command line: a path with spaces is quoted.
fn on_a_line(named: &str) -> String {
    let named = shown(named).to_string();
    match named.contains(char::is_whitespace) {
        true => format!("'{named}'"),
        false => named,
    }
}

fn table(text: &mut String, name: &str, fields: &[Field], values: &[Vec<f64>]) {
    let _ = writeln!(text, "\n[{name}]");
    let elements = elements(fields);
    for (at, (field, numbers)) in fields.iter().zip(values).enumerate() {
        let element = elements.get(&at).and_then(|own| fields.get(*own));
        let keys = element.map(|element| instead(element, field, field.ascii));
        let keys = keys.filter(|keys| !keys.is_empty());
        let or = keys.map_or_else(String::new, |keys| format!("; or give {keys}"));
        comment(text, &format!("{}{or}", about(field)));
        let _ = writeln!(text, "{} = {}", field.ascii, value(field, numbers));
    }
}

/// The table of bounds: the given ones, and the others as comments.
pub(super) fn bounds(text: &mut String, card: &Card, given: &[(String, f64)]) {
    let _ = writeln!(text, "\n[bounds]");
    comment(
        text,
        "Bounds on the drift |I(t) - I(0)| / scale at all nodes (absolute if the scale is 0). If a drift exceeds its bound, the exit code is 3.",
    );
    for invariant in card.invariants {
        comment(text, &format!("{}: {}", invariant.name, invariant.formula));
        let stated = given.iter().find(|(name, _)| name == invariant.name);
        let _ = match (stated, invariant.conserved) {
            (Some((_, bound)), _) => writeln!(text, "{} = {bound:?}", invariant.name),
            (None, Conserved::Exactly) => writeln!(
                text,
                "# {} = {DEFAULT_BOUND:?}     # exactly conserved, up to rounding; this is the default bound",
                invariant.name
            ),
            (None, Conserved::Boundedly) => writeln!(
                text,
                "# {} = 1e-3     # oscillates within O(h^2); without a bound it is only reported",
                invariant.name
            ),
        };
    }
}

/// The keys of the velocities that may replace the momentum with this key.
pub(super) fn instead(element: &Field, momentum: &Field, key: &str) -> String {
    let ways = Way::ALL
        .into_iter()
        .filter(|way| way.is_of(element, momentum));
    let keys: Vec<String> = ways.filter_map(|way| way.key(key)).collect();
    keys.join(", ")
}

/// Shape and frame of a field, then the model's own words.
fn about(field: &Field) -> String {
    let Field { rows, cols, .. } = *field;
    let shape = match field.kind {
        Kind::Scalar => "a number".to_owned(),
        Kind::Vector => format!("vector of {rows}"),
        Kind::Symmetric => format!("symmetric {rows}x{cols} matrix, written in full"),
        Kind::SecondMoments => format!(
            "symmetric {rows}x{cols} matrix of second moments, written in full; or the inertia, \
             {} = {{ I = [a, b, c] }} or {{ I = matrix }}, where I = tr(J) Id - J",
            field.ascii
        ),
        Kind::Skew => format!("skew {rows}x{cols} matrix, written in full"),
        Kind::Diagonal => format!("diagonal {rows}x{cols} matrix, or its {rows} entries"),
        Kind::Matrix => format!("{rows}x{cols} matrix, row by row"),
        Kind::Rotation if rows != 3 => {
            format!("rotation body -> space: {rows}x{cols} matrix, row by row")
        }
        Kind::Rotation => {
            "rotation body -> space: 3x3 matrix, unit quaternion [w, x, y, z], { axis, angle }, { euler = \"zxz\", angles } about successive body axes, or { from, to }; angles in radians".to_owned()
        }
        Kind::UnitQuaternion => {
            "unit quaternion body -> space: [w, x, y, z], or another form of a rotation".to_owned()
        }
        Kind::RigidMotion => {
            format!(
                "rigid motion body -> space: homogeneous {rows}x{cols} matrix, or {{ rotation, position }}"
            )
        }
        Kind::BodyMomentum => "momentum at the first node, body frame".to_owned(),
        Kind::SpatialMomentum => "momentum at the first node, space frame".to_owned(),
        Kind::FieldMomentum => "momentum at the first node".to_owned(),
    };
    let written = if field.name == field.ascii {
        String::new()
    } else {
        format!("{}, ", field.name)
    };
    let doc = field.doc.split_whitespace().collect::<Vec<_>>().join(" ");
    if doc.is_empty() {
        format!("{written}{shape}")
    } else {
        format!("{written}{shape}: {doc}")
    }
}

fn value(field: &Field, numbers: &[f64]) -> String {
    if field.rows * field.cols == 1 {
        return numbers
            .first()
            .map_or_else(String::new, |x| format!("{x:?}"));
    }
    if field.cols == 1 {
        return list(numbers);
    }
    let rows: Vec<String> = numbers.chunks(field.cols).map(list).collect();
    format!("[\n    {},\n]", rows.join(",\n    "))
}

fn list(numbers: &[f64]) -> String {
    // `{:?}` is the shortest text that parses to the same f64.
    let numbers: Vec<String> = numbers.iter().map(|x| format!("{x:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

pub(super) fn comment(text: &mut String, words: &str) {
    let words: Vec<&str> = words.lines().collect();
    let _ = writeln!(text, "# {}", words.join(" "));
}

/// A basic string of TOML.
fn quoted(words: &str) -> String {
    let mut text = String::from("\"");
    for letter in words.chars() {
        match letter {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '\n' => text.push_str("\\n"),
            '\t' => text.push_str("\\t"),
            control if control.is_control() => {
                let _ = write!(text, "\\u{:04X}", u32::from(control));
            }
            plain => text.push(plain),
        }
    }
    text.push('"');
    text
}
