//! One value of a case file: a number, a vector, a matrix or a rotation.
//! Takes a TOML value and the field it is for; gives its numbers row-major, or what is wrong with it.
//! Shapes are checked here; symmetry, orthogonality and the like by the model that is opened with them.

use clebsch::card::{Field, Kind};
use clebsch::groups::Rotation;
use toml::Spanned;
use toml::de::DeValue;

/// How far the norm of a quaternion may be from 1. Six digits typed by hand pass; a quaternion that
/// was never normalised does not.
const QUATERNION: f64 = 1e-6;

/// What to write for a field, in words.
pub(super) fn expected(field: &Field) -> String {
    let Field { rows, cols, .. } = *field;
    match field.kind {
        _ if rows * cols == 1 => "a number".to_owned(),
        Kind::Rotation if rows == 3 => {
            "a 3x3 matrix [[..], [..], [..]] or a unit quaternion [w, x, y, z]".to_owned()
        }
        Kind::Diagonal => format!("the {rows} diagonal entries [a, ..] or a {rows}x{cols} matrix"),
        Kind::SecondMoments => format!(
            "a symmetric {rows}x{cols} matrix [[..], ..], written in full{}",
            super::inertia::words(field)
        ),
        Kind::Symmetric => format!("a symmetric {rows}x{cols} matrix [[..], ..], written in full"),
        Kind::Skew => format!("a skew {rows}x{cols} matrix [[..], ..], written in full"),
        _ if cols == 1 => format!("a vector of {rows} numbers [a, ..]"),
        _ => format!("a {rows}x{cols} matrix [[..], ..]"),
    }
}

/// The numbers of `field`, row-major; a rotation as its matrix.
pub(super) fn numbers(field: &Field, value: &DeValue<'_>) -> Result<Vec<f64>, String> {
    let Field { rows, cols, .. } = *field;
    let (flat, one) = (cols == 1, rows * cols == 1);
    match shape(value) {
        Shape::Number if one => Ok(vec![number(value)?]),
        Shape::Vector(n) if flat && !one && n == rows => row(value),
        Shape::Vector(4) if field.kind == Kind::Rotation && rows == 3 => quaternion(&row(value)?),
        Shape::Vector(n) if field.kind == Kind::Diagonal && n == rows => {
            Ok(on_diagonal(&row(value)?))
        }
        Shape::Matrix(r, c) if !flat && (r, c) == (rows, cols) => {
            let mut entries = Vec::with_capacity(rows * cols);
            for line in items(value) {
                entries.extend(row(line.get_ref())?);
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

/// A finite number; integers count.
pub(super) fn number(value: &DeValue<'_>) -> Result<f64, String> {
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
        other => return Err(format!("expected a number, found {}", shape(other).words())),
    };
    match parsed {
        Some(number) if number.is_finite() => Ok(number),
        Some(number) => Err(format!("{number} is not a finite number")),
        None => Err("this number is out of range".to_owned()),
    }
}

enum Shape {
    Number,
    Vector(usize),
    Matrix(usize, usize),
    Ragged,
    Other(&'static str),
}

impl Shape {
    fn words(&self) -> String {
        match self {
            Self::Number => "one number".to_owned(),
            Self::Vector(n) => format!("a vector of {n} numbers"),
            Self::Matrix(rows, cols) => format!("a {rows}x{cols} matrix"),
            Self::Ragged => "an array that is neither a vector nor a matrix of numbers".to_owned(),
            Self::Other(kind) => format!("a value of type {kind}"),
        }
    }
}

fn shape(value: &DeValue<'_>) -> Shape {
    let is_number = |value: &DeValue<'_>| value.is_integer() || value.is_float();
    if is_number(value) {
        return Shape::Number;
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

fn items<'a, 'i>(value: &'a DeValue<'i>) -> &'a [Spanned<DeValue<'i>>] {
    value.as_array().map_or(&[], |array| array)
}

fn row(value: &DeValue<'_>) -> Result<Vec<f64>, String> {
    items(value)
        .iter()
        .map(|item| number(item.get_ref()))
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

fn quaternion(q: &[f64]) -> Result<Vec<f64>, String> {
    let &[w, x, y, z] = q else {
        return Err("a quaternion has four numbers".to_owned());
    };
    let norm = (w * w + x * x + y * y + z * z).sqrt();
    // Written so that NaN is refused.
    let unit = (norm - 1.0).abs() <= QUATERNION;
    if !unit {
        return Err(format!(
            "the quaternion has norm {norm}; divide by it (a rotation needs norm 1 within {QUATERNION:e})"
        ));
    }
    let rotation = Rotation::from_quaternion([w, x, y, z]).map_err(|error| error.to_string())?;
    Ok(rotation.matrix().transpose().iter().copied().collect())
}
