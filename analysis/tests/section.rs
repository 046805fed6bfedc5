//! Crossings with known times.

use crate::systems::{Plane, Splitting, oscillators};
use clebsch_analysis::{Direction, Section, SectionError, sections};
use std::f64::consts::PI;

type Image = Option<([f64; 2], [f64; 4])>;

/// Uniform motion.
fn uniform() -> Plane<impl Fn([f64; 2], f64) -> Image> {
    Plane(|[x, y]: [f64; 2], h| Some(([x + h * y, y], [1.0, h, 0.0, 1.0])))
}

fn section<'a, S>(value: &'a dyn Fn(&S) -> f64, direction: Direction) -> Section<'a, S> {
    Section {
        value,
        rate: None,
        direction,
    }
}

#[test]
fn zeros_of_an_oscillator() {
    let flow = Splitting::leapfrog(oscillators(1));
    let value = |z: &Vec<f64>| z[0];
    let start = vec![1.0, 0.0];
    let mut errors = Vec::new();
    for h in [0.1, 0.05] {
        let omega = 2.0 / h * (h / 2.0_f64).asin();
        let found = sections(
            &flow,
            &start,
            h,
            &section(&value, Direction::Both),
            10,
            1000,
        )
        .unwrap();
        assert!(found.complete && found.crossings.len() == 10);
        let mut worst = 0.0_f64;
        for (k, crossing) in found.crossings.iter().enumerate() {
            assert!(crossing.value.abs() < 1e-15 && crossing.state[0] == crossing.value);
            assert_eq!(crossing.upward, k % 2 == 1);
            // The nodes follow cos(omega t) exactly. Only the last step, which is shorter, differs.
            worst = worst.max((crossing.time - (PI / 2.0 + PI * k as f64) / omega).abs());
        }
        errors.push(worst);
    }
    // A step of leapfrog has an error of third order, at most h^3 / 12 here.
    assert!(
        errors[0] < 0.1_f64.powi(3) / 12.0 && errors[1] < 0.05_f64.powi(3) / 12.0,
        "{errors:?}"
    );
}

#[test]
fn directions() {
    let flow = Splitting::leapfrog(oscillators(1));
    let value = |z: &Vec<f64>| z[0];
    let start = vec![1.0, 0.0];
    let times = |direction, h| -> Vec<f64> {
        let found = sections(&flow, &start, h, &section(&value, direction), 2, 1000).unwrap();
        found
            .crossings
            .iter()
            .map(|crossing| crossing.time)
            .collect()
    };
    let near = |found: Vec<f64>, expected: [f64; 2]| {
        found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 0.01)
    };
    assert!(near(times(Direction::Down, 0.1), [0.5 * PI, 2.5 * PI]));
    assert!(near(times(Direction::Up, 0.1), [1.5 * PI, 3.5 * PI]));
    // Backwards in time, cos falls first as well.
    assert!(near(times(Direction::Down, -0.1), [-0.5 * PI, -2.5 * PI]));
}

#[test]
fn nodes_on_the_surface() {
    let value = |z: &[f64; 2]| z[0];
    let found = sections(
        &uniform(),
        &[-2.0, 1.0],
        1.0,
        &section(&value, Direction::Up),
        1,
        10,
    )
    .unwrap();
    assert!(found.crossings[0].time == 2.0 && found.crossings[0].state == [0.0, 1.0]);
    // A start on the surface is not a crossing, and neither is a touch.
    let error = sections(
        &uniform(),
        &[0.0, 1.0],
        1.0,
        &section(&value, Direction::Both),
        1,
        5,
    )
    .unwrap_err();
    assert_eq!(
        error,
        SectionError::Never {
            steps: 5,
            least: 0.0,
            largest: 5.0
        }
    );
    let square = |z: &[f64; 2]| z[0] * z[0];
    let error = sections(
        &uniform(),
        &[-2.0, 1.0],
        1.0,
        &section(&square, Direction::Both),
        1,
        5,
    )
    .unwrap_err();
    assert_eq!(
        error,
        SectionError::Never {
            steps: 5,
            least: 0.0,
            largest: 9.0
        }
    );
    // Between nodes, the root is a rounding away.
    let found = sections(
        &uniform(),
        &[-2.5, 1.0],
        1.0,
        &section(&value, Direction::Up),
        1,
        10,
    )
    .unwrap();
    assert!((found.crossings[0].time - 2.5).abs() < 1e-15);
}

#[test]
fn two_crossings_within_a_step_need_the_rate() {
    let value = |z: &[f64; 2]| z[0] * z[0] - 0.01;
    let rate = |z: &[f64; 2]| 2.0 * z[0] * z[1];
    let without = section(&value, Direction::Both);
    let error = sections(&uniform(), &[-2.5, 1.0], 1.0, &without, 2, 5).unwrap_err();
    assert!(matches!(error, SectionError::Never { steps: 5, .. }));
    let with = Section {
        value: &value,
        rate: Some(&rate),
        direction: Direction::Both,
    };
    let found = sections(&uniform(), &[-2.5, 1.0], 1.0, &with, 2, 5).unwrap();
    let times: Vec<f64> = found
        .crossings
        .iter()
        .map(|crossing| crossing.time)
        .collect();
    assert!(
        (times[0] - 2.4).abs() < 1e-14 && (times[1] - 2.6).abs() < 1e-14,
        "{times:?}"
    );
    assert!(!found.crossings[0].upward && found.crossings[1].upward);
    // A turn that stays on one side does not count as a crossing.
    let above = |z: &[f64; 2]| z[0] * z[0] + 0.01;
    let with = Section {
        value: &above,
        rate: Some(&rate),
        direction: Direction::Both,
    };
    assert!(sections(&uniform(), &[-2.5, 1.0], 1.0, &with, 2, 5).is_err());
}

#[test]
fn fewer_crossings_than_asked() {
    let value = |z: &[f64; 2]| z[0];
    let found = sections(
        &uniform(),
        &[-2.5, 1.0],
        1.0,
        &section(&value, Direction::Both),
        2,
        10,
    )
    .unwrap();
    assert!(!found.complete && found.crossings.len() == 1 && found.steps == 10);
    let error = sections(
        &uniform(),
        &[-2.5, 1.0],
        1.0,
        &section(&value, Direction::Down),
        2,
        10,
    )
    .unwrap_err();
    assert!(error.to_string().contains("direction"), "{error}");
}
