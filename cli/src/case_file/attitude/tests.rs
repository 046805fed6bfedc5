//! One attitude in every form.

use super::numbers;
use clebsch::card::{Field, Kind};
use toml::de::DeValue;

const SPACE: Field = Kind::Rotation.field("R", [3, 3], "");

fn read(field: &Field, text: &str) -> Result<Vec<f64>, String> {
    let value = DeValue::parse(text).map_err(|e| e.to_string())?;
    numbers(field, value.get_ref(), &super::super::value::Nameless)
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
    let found = read(&SPACE, "{ euler = \"zxz\", angles = [0.3, 0.5, 0.7] }").expect("it reads");
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
