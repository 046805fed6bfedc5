//! Elements of groups in a case: rotations by a matrix, a unit quaternion, an axis and an angle, Euler angles or two directions; rigid
//! motions by a rotation and a position. Takes a TOML value and the field it is for; gives the numbers of the field, row by row.

use super::value::{Numbers, Shape, entries, number, row, shape};
use crate::suggestion::did_you_mean;
use clebsch::card::{Field, Kind};
use clebsch::groups::Rotation;
use clebsch::nalgebra::{DMatrix, Matrix3, Vector3};
use toml::de::{DeTable, DeValue};

/// How far the norm of a quaternion may be from 1, and the products of columns of a matrix from those of unit vectors. Six digits
/// typed by hand pass, and matrices of single precision; a quaternion that was never normalised does not.
const ALLOWED: f64 = 1e-6;

/// What products of columns differ by from those of unit vectors in a matrix that is printed in full.
const ROUNDING: f64 = 1e-12;

/// Two directions are opposite if their sum is no longer than this.
const OPPOSITE: f64 = 1e-9;

/// The tables that state a rotation: the keys of each.
const TABLES: [&[&str]; 5] = [
    &["axis", "angle"],
    &["euler", "angles"],
    &["from", "to"],
    &["quaternion"],
    &["matrix"],
];

/// What to write for a rotation in space.
const OF_SPACE: &str = "a 3x3 matrix [[..], [..], [..]], a unit quaternion [w, x, y, z], { axis = [..], angle = .. }, \
                        { euler = \"zxz\", angles = [..] } or { from = [..], to = [..] }";

/// What to write for a field, in words.
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

/// Whether a value stands for an element by a table of its own.
pub(super) fn is_table(value: &DeValue<'_>) -> bool {
    value.as_table().is_some_and(|table| {
        let own = TABLES.iter().flat_map(|keys| keys.iter());
        own.chain(&["rotation", "position"])
            .any(|key| table.contains_key(*key))
    })
}

/// Whether a 4 x 4 matrix is that of the left multiplication by a quaternion, rather than a list of four quaternions.
pub(super) fn is_left_factor(value: &DeValue<'_>) -> bool {
    let matrix = Kind::Matrix.field("", [4, 4], "");
    let Ok(all) = entries(&matrix, value, &|_| None) else {
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
        (_, DeValue::Table(table)) if !table.is_empty() => by_table(table, of),
        _ => {
            let all = entries(field, value, of)?;
            Ok(Matrix3::from_row_slice(&orthonormal(all, 3)))
        }
    }
}

/// The rotation that a table states.
fn by_table(table: &DeTable<'_>, of: &Numbers<'_>) -> Result<Matrix3<f64>, String> {
    let found = TABLES.iter().find(|keys| {
        let mut keys = keys.iter();
        keys.any(|key| table.contains_key(*key))
    });
    let keys = found.copied().unwrap_or_default();
    for key in table.keys() {
        let asked = key.get_ref().as_ref();
        if !keys.contains(&asked) {
            let known = TABLES.iter().flat_map(|keys| keys.iter().copied());
            let hint = did_you_mean(asked, known);
            return Err(format!("unknown key `{asked}`{hint}; expected {OF_SPACE}"));
        }
    }
    let get = |key: &str| {
        let value = table.get(key).map(|v| v.get_ref());
        value.ok_or_else(|| format!("missing key `{key}` beside `{}`", other(keys, key)))
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

/// A vector of three numbers, made a unit one.
fn direction(key: &str, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vector3<f64>, String> {
    let field = Kind::Vector.field("", [3, 1], "");
    let all = entries(&field, value, of).map_err(|why| format!("{key}: {why}"))?;
    let vector = Vector3::from_column_slice(&all);
    let length = vector.norm();
    match length > 0.0 && length.is_finite() {
        true => Ok(vector / length),
        false => Err(format!("{key}: a direction has a length that is not zero")),
    }
}

/// The turn by an angle about a unit vector, by the right hand.
fn about(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = sine_and_cosine(angle);
    let hat = axis.cross_matrix();
    Matrix3::identity() * cosine + hat * sine + axis * axis.transpose() * (1.0 - cosine)
}

/// Sine and cosine, zero where they are zero but for the rounding of the angle: a quarter turn has zeros in its matrix.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let (sine, cosine) = angle.sin_cos();
    let rounding = f64::EPSILON * angle.abs().max(1.0);
    let exact = |x: f64| if x.abs() <= rounding { 0.0 } else { x };
    (exact(sine), exact(cosine))
}

/// The product of turns about coordinate axes in the order of the letters.
fn euler(
    axes: &DeValue<'_>,
    angles: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Matrix3<f64>, String> {
    let wrong = "euler: expected three axes, no two neighbours alike, such as \"zxz\" or \"zyx\"";
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

/// The shortest turn from one direction to another.
fn between(from: Vector3<f64>, to: Vector3<f64>) -> Result<Matrix3<f64>, String> {
    if (from + to).norm() <= OPPOSITE {
        return Err(
            "the directions are opposite, and half a turn about many axes takes one to the other: give { axis = [..], angle = \"pi\" }"
                .to_owned(),
        );
    }
    // The product of the reflections that take `from` to `-from` and `from + to` to its opposite.
    let middle = (from + to).normalize();
    let mirror = |n: Vector3<f64>| Matrix3::identity() - n * n.transpose() * 2.0;
    Ok(mirror(middle) * mirror(from))
}

/// The rotation of a quaternion, which is made a unit one.
fn unit(q: &[f64]) -> Result<Rotation, String> {
    let &[w, x, y, z] = q else {
        return Err(format!(
            "a quaternion has four numbers [w, x, y, z], found {}",
            q.len()
        ));
    };
    let norm = (w * w + x * x + y * y + z * z).sqrt();
    // Written so that NaN is refused.
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
    let (sine, cosine) = sine_and_cosine(angle);
    Ok(vec![cosine, -sine, sine, cosine])
}

/// A unit quaternion, by its four numbers or the matrix of its left multiplication, as the field asks.
fn quaternion(field: &Field, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vec<f64>, String> {
    if let Shape::Matrix(4, 4) = shape(value) {
        let matrix = Kind::Matrix.field("", [4, 4], "");
        if field.cols == 4 {
            return entries(&matrix, value, of);
        }
    }
    let q = match shape(value) {
        // The sign is that of the case: a quaternion and its opposite are two states.
        Shape::Vector(4) => {
            let own = row(value, of)?;
            unit(&own)?;
            let norm = own.iter().map(|x| x * x).sum::<f64>().sqrt();
            let by = if (norm - 1.0).abs() <= ROUNDING {
                1.0
            } else {
                norm
            };
            own.into_iter().map(|x| x / by).collect()
        }
        _ => {
            let as_matrix = Kind::Rotation.field("", [3, 3], "");
            let turn = rotation(&as_matrix, value, of).map_err(|why| {
                match why.split_once(", found ") {
                    Some((_, found)) => format!("expected {}, found {found}", expected(field)),
                    None => why,
                }
            })?;
            let turn = Rotation::from_matrix(&turn).map_err(|error| error.to_string())?;
            turn.quaternion().to_vec()
        }
    };
    let &[w, x, y, z] = q.as_slice() else {
        return Ok(q);
    };
    Ok(match field.cols {
        4 => vec![w, -x, -y, -z, x, w, -z, y, y, z, w, -x, z, -y, x, w],
        _ => q,
    })
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
                let own = table.get(key).map(|v| numbers_of(&field, v.get_ref(), of));
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
            let all = entries(field, value, of)?;
            let at = |i: usize, j: usize| all.get(i * (n + 1) + j).copied().unwrap_or_default();
            let block = (0..n * n).map(|k| at(k / n, k % n)).collect();
            let last: Vec<f64> = (0..=n).map(|j| at(n, j)).collect();
            let own = assembled(
                &orthonormal(block, n),
                &(0..n).map(|i| at(i, n)).collect::<Vec<_>>(),
            );
            // What is wrong with the last row the model says.
            return Ok(own.into_iter().take(n * (n + 1)).chain(last).collect());
        }
    };
    Ok(assembled(&turn, &place))
}

fn numbers_of(field: &Field, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<Vec<f64>, String> {
    super::value::numbers(field, value, of)
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

/// The nearest rotation to a matrix that was rounded; others are left to the model, which says what is wrong with them.
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
mod tests {
    use super::numbers;
    use clebsch::card::{Field, Kind};
    use toml::de::DeValue;

    const SPACE: Field = Kind::Rotation.field("R", [3, 3], "");

    fn read(field: &Field, text: &str) -> Result<Vec<f64>, String> {
        let value = DeValue::parse(text).map_err(|e| e.to_string())?;
        numbers(field, value.get_ref(), &|_| None)
    }

    fn off(a: &[f64], b: &[f64]) -> f64 {
        let each = a.iter().zip(b).map(|(x, y)| (x - y).abs());
        each.fold(f64::from(u8::from(a.len() != b.len())), f64::max)
    }

    /// A quarter turn about the third axis: e1 goes to e2.
    const QUARTER: [f64; 9] = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

    #[test]
    fn one_rotation_is_stated_in_every_way() {
        for text in [
            "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]",
            "[\"sqrt(1/2)\", 0, 0, \"sqrt(1/2)\"]",
            "{ axis = [0, 0, 2], angle = \"pi/2\" }",
            "{ euler = \"zxz\", angles = [\"pi/2\", 0, 0] }",
            "{ euler = \"zyx\", angles = [\"pi/2\", 0, 0] }",
            "{ from = [1, 0, 0], to = [0, 3, 0] }",
            "{ quaternion = [0.70710678, 0, 0, 0.70710678] }",
            "{ matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]] }",
        ] {
            let found = read(&SPACE, text).unwrap_or_else(|why| panic!("{text}: {why}"));
            assert!(off(&found, &QUARTER) < 1e-15, "{text}: {found:?}");
        }
    }

    #[test]
    fn euler_angles_are_turns_about_the_axes_of_the_body_in_their_order() {
        let (a, b, c) = (0.3_f64, 0.5_f64, 0.7_f64);
        let found =
            read(&SPACE, "{ euler = \"zxz\", angles = [0.3, 0.5, 0.7] }").expect("it reads");
        // The third column of R3(a) R1(b) R3(c), and the third row.
        assert!((found[2] - a.sin() * b.sin()).abs() < 1e-15);
        assert!((found[5] + a.cos() * b.sin()).abs() < 1e-15);
        assert!((found[6] - b.sin() * c.sin()).abs() < 1e-15);
        assert!((found[8] - b.cos()).abs() < 1e-15);
    }

    #[test]
    fn the_turn_between_two_directions_leaves_what_is_across() {
        let found = read(&SPACE, "{ from = [0, 0, 1], to = [1, 0, 0] }").expect("it reads");
        let expected = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0];
        assert!(off(&found, &expected) < 1e-15, "{found:?}");
        let why = read(&SPACE, "{ from = [0, 0, 1], to = [0, 0, -2] }").expect_err("opposite");
        assert!(why.contains("opposite"), "{why}");
    }

    #[test]
    fn what_was_rounded_becomes_a_rotation() {
        let product = |r: &[f64]| -> f64 { r.chunks(3).map(|row| row[0] * row[1]).sum() };
        let single = "[[0.36, 0.48, -0.8], [-0.8, 0.6000001, 0.0], [0.48, 0.64, 0.6]]";
        let found = read(&SPACE, single).expect("it reads");
        assert!(product(&found).abs() < 1e-15, "{found:?}");
        let q = Kind::UnitQuaternion.field("q", [4, 1], "");
        let found = read(&q, "[0.70710678, -0.70710678, 0, 0]").expect("it reads");
        let norm: f64 = found.iter().map(|x| x * x).sum();
        assert!((norm - 1.0).abs() < 1e-15 && found[1] < 0.0, "{found:?}");
        let found = read(&q, "{ axis = [0, 0, 1], angle = \"pi\" }").expect("it reads");
        assert!(off(&found, &[0.0, 0.0, 0.0, 1.0]) < 1e-15, "{found:?}");
        assert!(read(&q, "[0.7071, 0.7071, 0, 0]").is_err());
    }

    #[test]
    fn motions_have_a_rotation_and_a_position() {
        let g = Kind::RigidMotion.field("G", [3, 3], "");
        let found = read(&g, "{ rotation = \"pi/2\", position = [2, \"1/2\"] }").expect("it reads");
        assert!(off(&found, &[0.0, -1.0, 2.0, 1.0, 0.0, 0.5, 0.0, 0.0, 1.0]) < 1e-15);
        let why = read(&g, "{ rotation = 0, place = [2, 1] }").expect_err("no such key");
        assert!(why.contains("unknown key `place`"), "{why}");
    }
}
