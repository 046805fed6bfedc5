//! One value of a case file: a number, a vector, a matrix or an element of a group.
//! Takes a TOML value and its field; gives its numbers row-major, or an error.
//! A number may be an expression in quotes.
//! This module checks shapes. The model checks symmetry, orthogonality and the like when it is opened.

use super::attitude;
use super::names::evaluated;
pub(super) use super::names::{Nameless, Numbers};
use clebsch::card::{Field, Kind};
use toml::Spanned;
use toml::de::DeValue;

/// The accepted forms of a value of `field`, for messages.
pub(super) fn expected(field: &Field) -> String {
    let Field { rows, cols, .. } = *field;
    match field.kind {
        _ if rows * cols == 1 => "a number".to_owned(),
        Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion => attitude::expected(field),
        Kind::Diagonal => format!("the {rows} diagonal entries [a, ..] or a {rows}x{cols} matrix"),
        Kind::SecondMoments => format!(
            "a symmetric {rows}x{cols} matrix [[..], ..], written in full, or the inertia: {{ I = [a, b, c] }} for principal \
             moments, {{ I = [[..], ..] }} for a matrix"
        ),
        Kind::Symmetric => format!("a symmetric {rows}x{cols} matrix [[..], ..], written in full"),
        Kind::Skew => format!("a skew {rows}x{cols} matrix [[..], ..], written in full"),
        _ if cols == 1 => format!("a vector of {rows} numbers [a, ..]"),
        _ => format!("a {rows}x{cols} matrix [[..], ..]"),
    }
}

/// The numbers of `field`, row-major; a rotation as its matrix.
pub(super) fn numbers(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    match is_element(field) {
        true => attitude::numbers(field, value, of),
        false => entries(field, value, of),
    }
}

/// Converts the numbers of an array, which has one of the shapes accepted for `field`, to the numbers of
/// `field`.
pub(super) fn of_array(
    field: &Field,
    numbers: &[f64],
    shape: &[usize],
) -> Result<Vec<f64>, String> {
    match field.kind {
        _ if is_element(field) => attitude::of_array(field, numbers, shape),
        Kind::Diagonal if shape.len() == 1 => Ok(on_diagonal(numbers)),
        _ => Ok(numbers.to_vec()),
    }
}

/// Whether a field is an element of a group.
pub(super) fn is_element(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion
    )
}

/// The numbers of a field that is given by its entries.
pub(super) fn entries(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    let Field { rows, cols, .. } = *field;
    let (flat, one) = (cols == 1, rows * cols == 1);
    match shape(value) {
        Shape::Number | Shape::Text if one => Ok(vec![number(value, of)?]),
        Shape::Vector(n) if flat && !one && n == rows => row(value, of),
        Shape::Vector(n) if field.kind == Kind::Diagonal && n == rows => {
            Ok(on_diagonal(&row(value, of)?))
        }
        Shape::Matrix(r, c) if !flat && (r, c) == (rows, cols) => {
            let mut entries = Vec::with_capacity(rows * cols);
            for line in items(value) {
                entries.extend(row(line.get_ref(), of)?);
            }
            Ok(entries)
        }
        found => Err(format!(
            "expected {}, found {}",
            expected(field),
            found.words()
        )),
    }
}

/// A finite number; integers count, and expressions in quotes.
pub(super) fn number(value: &DeValue<'_>, of: &Numbers<'_>) -> Result<f64, String> {
    let parsed = match value {
        // An integer beyond f64's exact range is rounded, as a float literal would be.
        DeValue::Integer(text) =>
        {
            #[allow(clippy::cast_precision_loss)]
            i128::from_str_radix(text.as_str(), text.radix())
                .ok()
                .map(|integer| integer as f64)
        }
        DeValue::Float(text) => text.as_str().parse::<f64>().ok(),
        DeValue::String(text) => return evaluated(text, of),
        other => return Err(format!("expected a number, found {}", shape(other).words())),
    };
    match parsed {
        Some(number) if number.is_finite() => Ok(number),
        Some(number) => Err(format!("{number} is not a finite number")),
        None => Err("this number is out of range".to_owned()),
    }
}

pub(super) enum Shape {
    Number,
    /// An expression.
    Text,
    Vector(usize),
    Matrix(usize, usize),
    Ragged,
    /// A table that describes a file.
    File,
    Other(&'static str),
}

/// The form of an array of a file, for messages.
pub(super) const OF_FILES: &str = "write an array of a file as { npz = \"out/trajectory.npz\", key = \"q\" }; numpy.savez writes such files";

/// Whether a table names a file.
pub(super) fn names_a_file(value: &DeValue<'_>) -> bool {
    const KEYS: [&str; 8] = ["csv", "npy", "file", "path", "txt", "dat", "h5", "json"];
    let table = value.as_table();
    table.is_some_and(|table| KEYS.iter().any(|key| table.contains_key(*key)))
}

impl Shape {
    pub(super) fn words(&self) -> String {
        match self {
            Self::Number => "one number".to_owned(),
            Self::Text => "an expression in quotes, which is one number".to_owned(),
            Self::Vector(n) => format!("a vector of {n} numbers"),
            Self::Matrix(rows, cols) => format!("a {rows}x{cols} matrix"),
            Self::Ragged => "an array that is neither a vector nor a matrix of numbers".to_owned(),
            Self::File => format!("a table of another form; {OF_FILES}"),
            Self::Other(kind) => format!("a value of type {kind}"),
        }
    }
}

pub(super) fn shape(value: &DeValue<'_>) -> Shape {
    let is_number = |value: &DeValue<'_>| value.is_integer() || value.is_float() || value.is_str();
    if value.is_str() {
        return Shape::Text;
    }
    if is_number(value) {
        return Shape::Number;
    }
    if names_a_file(value) {
        return Shape::File;
    }
    if !value.is_array() {
        return Shape::Other(value.type_str());
    }
    let items = items(value);
    if items.iter().all(|item| is_number(item.get_ref())) {
        return Shape::Vector(items.len());
    }
    let mut widths = items.iter().map(|item| match shape(item.get_ref()) {
        Shape::Vector(n) => Some(n),
        _ => None,
    });
    match widths.next().flatten() {
        Some(first) if widths.all(|width| width == Some(first)) => {
            Shape::Matrix(items.len(), first)
        }
        _ => Shape::Ragged,
    }
}

pub(super) fn items<'a, 'i>(value: &'a DeValue<'i>) -> &'a [Spanned<DeValue<'i>>] {
    value.as_array().map_or(&[], |array| array)
}

pub(super) fn row(value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vec<f64>, String> {
    items(value)
        .iter()
        .map(|item| number(item.get_ref(), of))
        .collect()
}

fn on_diagonal(entries: &[f64]) -> Vec<f64> {
    let n = entries.len();
    let mut matrix = vec![0.0; n * n];
    for (slot, &entry) in matrix.iter_mut().step_by(n + 1).zip(entries) {
        *slot = entry;
    }
    matrix
}
