//! Elements of groups in a case: rotations by a matrix, a unit quaternion, an axis and an angle, Euler angles or two directions; rigid
//! motions by a rotation and a position. Takes a TOML value and the field it is for; gives the numbers of the field, row by row.

mod tables;

use super::value::{self, Nameless, Numbers, Shape, entries, number, row, shape};
use clebsch::card::{Field, Kind};
use clebsch::groups::Rotation;
use clebsch::nalgebra::{DMatrix, Matrix3};
use toml::de::DeValue;

/// Tolerance for the norm of a quaternion and for the products of the columns of a rotation matrix. Six digits
/// typed by hand and matrices of single precision pass. A quaternion that was never normalised does not.
const ALLOWED: f64 = 1e-6;

/// Error of the products of columns in a rotation matrix that is printed with all digits.
const ROUNDING: f64 = 1e-12;

/// The accepted forms of a rotation in space, for messages.
const OF_SPACE: &str = "a 3x3 matrix [[..], [..], [..]], a unit quaternion [w, x, y, z], { axis = [..], angle = .. }, \
                        { euler = \"zxz\", angles = [..] } or { from = [..], to = [..] }";

/// The accepted forms of a value of `field`, for messages.
pub(super) fn expected(field: &Field) -> String {
    let n = field.rows;
    match (field.kind, n) {
        (Kind::UnitQuaternion, _) => {
            OF_SPACE.replace("a 3x3 matrix [[..], [..], [..]], a", "a")
                + ", or the 3x3 matrix of the rotation"
        }
        (Kind::Rotation, 3) => OF_SPACE.to_owned(),
        (Kind::Rotation, 2) => "the angle, or a 2x2 matrix [[..], [..]]".to_owned(),
        (Kind::RigidMotion, _) => format!(
            "{{ rotation = .., position = [..] }} or the homogeneous {n}x{n} matrix [[..], ..]"
        ),
        _ => format!("a {n}x{n} matrix [[..], ..]"),
    }
}

/// The numbers of an element of a group.
pub(super) fn numbers(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    match (field.kind, field.rows) {
        (Kind::Rotation, 3) => rotation(field, value, of).map(|r| by_rows(&r)),
        (Kind::Rotation, 2) => plane(field, value, of),
        (Kind::UnitQuaternion, _) => quaternion(field, value, of),
        (Kind::RigidMotion, n) => motion(field, n - 1, value, of),
        (_, n) => entries(field, value, of).map(|all| orthonormal(all, n)),
    }
}

/// Converts the numbers of an array: a matrix, or a quaternion.
pub(super) fn of_array(
    field: &Field,
    numbers: &[f64],
    shape: &[usize],
) -> Result<Vec<f64>, String> {
    match (field.kind, shape) {
        (Kind::UnitQuaternion, [4, 4]) => Ok(numbers.to_vec()),
        (Kind::UnitQuaternion, _) => of_quaternion(field, numbers),
        (Kind::Rotation, [4]) => unit(numbers).map(|r| by_rows(&r.matrix())),
        (Kind::RigidMotion, _) => Ok(homogeneous(numbers, field.rows - 1)),
        _ => Ok(orthonormal(numbers.to_vec(), field.rows)),
    }
}

/// Whether a key is one of the tables that state a rotation.
pub(crate) fn is_key_of_rotation(key: &str) -> bool {
    tables::keys().any(|known| known == key)
}

/// Whether a value is a table that describes a rotation or a rigid motion.
pub(super) fn is_table(value: &DeValue<'_>) -> bool {
    value.as_table().is_some_and(|table| {
        let own = tables::keys().chain(["rotation", "position"]);
        own.into_iter().any(|key| table.contains_key(key))
    })
}

/// Whether a 4 x 4 matrix is a left multiplication by a quaternion, rather than a list of four quaternions.
pub(super) fn is_left_factor(value: &DeValue<'_>) -> bool {
    let matrix = Kind::Matrix.field("", [4, 4], "");
    let Ok(all) = entries(&matrix, value, &Nameless) else {
        return false;
    };
    let at = |i: usize, j: usize| all.get(4 * i + j).copied().unwrap_or_default();
    let near = |x: f64, y: f64| (x - y).abs() <= ALLOWED;
    (1..4).all(|i| near(at(i, i), at(0, 0)) && near(at(0, i), -at(i, 0)))
}

/// A rotation in space.
fn rotation(field: &Field, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Matrix3<f64>, String> {
    match (shape(value), value) {
        (Shape::Vector(4), _) => unit(&row(value, of)?).map(|r| r.matrix()),
        (_, DeValue::Table(table)) if !table.is_empty() => tables::rotation(table, of),
        _ => {
            let all = entries(field, value, of)?;
            Ok(Matrix3::from_row_slice(&orthonormal(all, 3)))
        }
    }
}

/// The rotation of a quaternion, which is normalised.
fn unit(q: &[f64]) -> Result<Rotation, String> {
    let &[w, x, y, z] = q else {
        return Err(format!(
            "a quaternion has four numbers [w, x, y, z], found {}",
            q.len()
        ));
    };
    let norm = (w * w + x * x + y * y + z * z).sqrt();
    // A NaN norm fails this comparison.
    let near = (norm - 1.0).abs() <= ALLOWED;
    if !near {
        return Err(format!(
            "the quaternion has norm {norm}; divide by it (a rotation needs norm 1 within {ALLOWED:e})"
        ));
    }
    let by = match (norm - 1.0).abs() <= ROUNDING {
        true => 1.0,
        false => norm,
    };
    let found = Rotation::from_quaternion([w / by, x / by, y / by, z / by]);
    found.map_err(|error| error.to_string())
}

/// A rotation of the plane: its angle, or its matrix.
fn plane(field: &Field, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vec<f64>, String> {
    let angle = match (shape(value), value) {
        (Shape::Number | Shape::Text, _) => value,
        (_, DeValue::Table(table)) if table.len() == 1 && table.contains_key("angle") => {
            table.get("angle").map_or(value, |v| v.get_ref())
        }
        _ => return entries(field, value, of).map(|all| orthonormal(all, 2)),
    };
    let angle = number(angle, of)?;
    let (sine, cosine) = tables::sine_and_cosine(angle);
    Ok(vec![cosine, -sine, sine, cosine])
}

/// A unit quaternion, given by its four numbers or by a matrix, in the form that the field requires.
fn quaternion(field: &Field, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vec<f64>, String> {
    if let Shape::Matrix(4, 4) = shape(value) {
        let matrix = Kind::Matrix.field("", [4, 4], "");
        if field.cols == 4 {
            return entries(&matrix, value, of);
        }
    }
    if let Shape::Vector(4) = shape(value) {
        return of_quaternion(field, &row(value, of)?);
    }
    let as_matrix = Kind::Rotation.field("", [3, 3], "");
    let turn = rotation(&as_matrix, value, of).map_err(|why| match why.split_once(", found ") {
        Some((_, found)) => format!("expected {}, found {found}", expected(field)),
        None => why,
    })?;
    let turn = Rotation::from_matrix(&turn).map_err(|error| error.to_string())?;
    Ok(as_asked(field, turn.quaternion().to_vec()))
}

/// A unit quaternion with the sign that the case gives: a quaternion and its opposite are two states.
fn of_quaternion(field: &Field, own: &[f64]) -> Result<Vec<f64>, String> {
    unit(own)?;
    let norm = own.iter().map(|x| x * x).sum::<f64>().sqrt();
    let by = if (norm - 1.0).abs() <= ROUNDING {
        1.0
    } else {
        norm
    };
    Ok(as_asked(field, own.iter().map(|x| x / by).collect()))
}

/// A quaternion by its numbers, or by the matrix of its left multiplication.
fn as_asked(field: &Field, q: Vec<f64>) -> Vec<f64> {
    match (field.cols, q.as_slice()) {
        (4, &[w, x, y, z]) => vec![w, -x, -y, -z, x, w, -z, y, y, z, w, -x, z, -y, x, w],
        _ => q,
    }
}

/// A rigid motion of `n` dimensions: its homogeneous matrix, or its rotation and its position.
fn motion(
    field: &Field,
    n: usize,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    let (turn, place) = match value {
        DeValue::Table(table) if is_table(value) => {
            let keys = ["rotation", "position"];
            let unknown = table.keys().find(|k| !keys.contains(&k.get_ref().as_ref()));
            if let Some(key) = unknown {
                return Err(format!(
                    "unknown key `{}`; expected {}",
                    key.get_ref(),
                    expected(field)
                ));
            }
            let inner = |key: &str, field: Field| {
                let own = table
                    .get(key)
                    .map(|v| value::numbers(&field, v.get_ref(), of));
                own.map(|read| read.map_err(|why| format!("{key}: {why}")))
                    .transpose()
            };
            let turn = inner("rotation", Kind::Rotation.field("", [n, n], ""))?;
            let place = inner("position", Kind::Vector.field("", [n, 1], ""))?;
            let identity = || {
                (0..n * n)
                    .map(|k| f64::from(u8::from(k / n == k % n)))
                    .collect()
            };
            (
                turn.unwrap_or_else(identity),
                place.unwrap_or_else(|| vec![0.0; n]),
            )
        }
        _ => {
            return Ok(homogeneous(&entries(field, value, of)?, n));
        }
    };
    Ok(assembled(&turn, &place))
}

/// The homogeneous matrix in `n` dimensions with its rotation made orthonormal. The last row is copied; the
/// model checks it.
fn homogeneous(all: &[f64], n: usize) -> Vec<f64> {
    let at = |i: usize, j: usize| all.get(i * (n + 1) + j).copied().unwrap_or_default();
    let block = (0..n * n).map(|k| at(k / n, k % n)).collect();
    let place: Vec<f64> = (0..n).map(|i| at(i, n)).collect();
    let own = assembled(&orthonormal(block, n), &place);
    let last = (0..=n).map(|j| at(n, j));
    own.into_iter().take(n * (n + 1)).chain(last).collect()
}

/// The homogeneous matrix of a rotation and a position.
fn assembled(turn: &[f64], place: &[f64]) -> Vec<f64> {
    let n = place.len();
    let entry = |k: usize| match (k / (n + 1), k % (n + 1)) {
        (i, j) if i < n && j < n => turn.get(i * n + j).copied().unwrap_or_default(),
        (i, _) if i < n => place.get(i).copied().unwrap_or_default(),
        (_, j) => f64::from(u8::from(j == n)),
    };
    (0..(n + 1) * (n + 1)).map(entry).collect()
}

fn by_rows(m: &Matrix3<f64>) -> Vec<f64> {
    m.transpose().iter().copied().collect()
}

/// The nearest rotation, if a matrix is orthonormal up to rounding. Other matrices are unchanged; the model
/// reports them.
fn orthonormal(all: Vec<f64>, n: usize) -> Vec<f64> {
    let mut m = DMatrix::from_row_slice(n, n, &all);
    let defect = |m: &DMatrix<f64>| (m.transpose() * m - DMatrix::identity(n, n)).amax();
    let off = defect(&m);
    if !(off > ROUNDING && off <= 2.0 * ALLOWED) {
        return all;
    }
    // Newton's method for the polar factor squares the defect.
    const ROUNDS: usize = 3;
    for _ in 0..ROUNDS {
        let gram = m.transpose() * &m;
        m = &m * (DMatrix::identity(n, n) * 1.5 - gram * 0.5);
    }
    m.transpose().iter().copied().collect()
}

#[cfg(test)]
mod tests;
