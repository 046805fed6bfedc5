//! Rotations that tables state: `{ axis = [..], angle = .. }`, `{ euler = "zxz", angles = [..] }`, `{ from = [..], to = [..] }`. Takes the
//! table; gives the matrix.

use super::{orthonormal, unit};
use crate::case_file::value::{Numbers, entries, number, row};
use crate::words::suggestion::did_you_mean;
use clebsch::card::Kind;
use clebsch::nalgebra::{Matrix3, Vector3};
use toml::de::{DeTable, DeValue};

/// Two unit directions are opposite if the length of their sum is at most this.
const OPPOSITE: f64 = 1e-9;

/// The tables that describe a rotation: the keys of each.
const TABLES: [&[&str]; 5] = [
    &["axis", "angle"],
    &["euler", "angles"],
    &["from", "to"],
    &["quaternion"],
    &["matrix"],
];

/// The keys of all tables.
pub(super) fn keys() -> impl Iterator<Item = &'static str> {
    TABLES.iter().flat_map(|keys| keys.iter().copied())
}

/// The rotation that a table states.
pub(super) fn rotation(table: &DeTable<'_>, of: &Numbers<'_>) -> Result<Matrix3<f64>, String> {
    let found = TABLES.iter().find(|keys| {
        let mut keys = keys.iter();
        keys.any(|key| table.contains_key(*key))
    });
    let keys = found.copied().unwrap_or_default();
    for key in table.keys() {
        let asked = key.get_ref().as_ref();
        if keys.contains(&asked) {
            continue;
        }
        return Err(match self::keys().any(|key| key == asked) {
            true => format!(
                "`{asked}` and `{}` give two rotations: give one of them",
                keys.first().copied().unwrap_or_default()
            ),
            false => format!("unknown key `{asked}`{}", did_you_mean(asked, self::keys())),
        });
    }
    let get = |key: &str| {
        let value = table.get(key).map(|v| v.get_ref());
        value.ok_or_else(|| format!("missing key `{key}` in addition to `{}`", other(keys, key)))
    };
    match keys {
        ["axis", _] => {
            let axis = direction("axis", get("axis")?, of)?;
            let angle = number(get("angle")?, of).map_err(|why| format!("angle: {why}"))?;
            Ok(about(axis, angle))
        }
        ["euler", _] => euler(get("euler")?, get("angles")?, of),
        ["from", _] => {
            let from = direction("from", get("from")?, of)?;
            between(from, direction("to", get("to")?, of)?)
        }
        ["quaternion"] => {
            let own = get("quaternion")?;
            let numbers = row(own, of).map_err(|why| format!("quaternion: {why}"))?;
            unit(&numbers).map(|r| r.matrix())
        }
        _ => {
            let field = Kind::Matrix.field("", [3, 3], "");
            let all =
                entries(&field, get("matrix")?, of).map_err(|why| format!("matrix: {why}"))?;
            Ok(Matrix3::from_row_slice(&orthonormal(all, 3)))
        }
    }
}

fn other<'k>(keys: &[&'k str], key: &str) -> &'k str {
    let mut others = keys.iter().filter(|k| **k != key);
    others.next().copied().unwrap_or_default()
}

/// A vector of three numbers, normalised.
fn direction(key: &str, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vector3<f64>, String> {
    let field = Kind::Vector.field("", [3, 1], "");
    let all = entries(&field, value, of).map_err(|why| format!("{key}: {why}"))?;
    let vector = Vector3::from_column_slice(&all);
    let length = vector.norm();
    match length > 0.0 && length.is_finite() {
        true => Ok(vector / length),
        false => Err(format!("{key}: a direction must have a non-zero length")),
    }
}

/// The right-handed rotation by an angle about a unit vector.
fn about(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = sine_and_cosine(angle);
    let hat = axis.cross_matrix();
    Matrix3::identity() * cosine + hat * sine + axis * axis.transpose() * (1.0 - cosine)
}

/// Sine and cosine. Values within the rounding error of the angle are set to zero, so that a quarter turn has
/// exact zeros.
pub(super) fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let (sine, cosine) = angle.sin_cos();
    let rounding = f64::EPSILON * angle.abs().max(1.0);
    let exact = |x: f64| if x.abs() <= rounding { 0.0 } else { x };
    (exact(sine), exact(cosine))
}

/// The product of rotations about coordinate axes, in the order of the letters.
fn euler(
    axes: &DeValue<'_>,
    angles: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Matrix3<f64>, String> {
    let wrong =
        "euler: expected three axes, each different from its neighbour, such as \"zxz\" or \"zyx\"";
    let letters = axes.as_str().ok_or(wrong)?.to_lowercase();
    let axes: Option<Vec<usize>> = letters.chars().map(|c| "xyz".find(c)).collect();
    let axes = axes.ok_or(wrong)?;
    let alike = axes.windows(2).any(|two| two.first() == two.last());
    if axes.len() != 3 || alike {
        return Err(wrong.to_owned());
    }
    let field = Kind::Vector.field("", [3, 1], "");
    let angles = entries(&field, angles, of).map_err(|why| format!("angles: {why}"))?;
    let each = axes.iter().zip(angles);
    Ok(each.fold(Matrix3::identity(), |before, (axis, angle)| {
        let mut unit = Vector3::zeros();
        if let Some(entry) = unit.get_mut(*axis) {
            *entry = 1.0;
        }
        before * about(unit, angle)
    }))
}

/// The smallest rotation from one direction to another.
fn between(from: Vector3<f64>, to: Vector3<f64>) -> Result<Matrix3<f64>, String> {
    if (from + to).norm() <= OPPOSITE {
        return Err(
            "the directions are opposite, so the rotation is not unique: give { axis = [..], angle = \"pi\" }"
                .to_owned(),
        );
    }
    // The product of the reflections that take `from` to `-from` and `from + to` to its opposite.
    let middle = (from + to).normalize();
    let mirror = |n: Vector3<f64>| Matrix3::identity() - n * n.transpose() * 2.0;
    Ok(mirror(middle) * mirror(from))
}
