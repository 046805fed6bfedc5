//! Attitudes: the axes of bodies and the vectors they carry on spheres, Euler angles against time.
//! Takes the samples of a run; gives what is drawn of each rotation, of each vector and of each body momentum.

use super::axis::Axis;
use super::curve::{Curve, Stroke};
use super::figure::Panel;
use super::sphere::{Course, Sphere, sheet};
use super::window::{Window, window};
use super::{Plot, caption, figure, letter, reduce};
use crate::output::Finished;
use crate::record::Samples;
use clebsch::card::{Field, Kind};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::scalar::largest;
use std::ops::Range;

/// Most spheres of a picture.
const MOST: usize = 9;

/// A momentum whose length changes by less than this part of it stays on its sphere.
const SAME_LENGTH: f64 = 1e-9;

/// Observables with their columns.
pub(crate) fn placed(
    fields: &'static [Field],
) -> impl Iterator<Item = (&'static Field, Range<usize>)> {
    let mut from = 0;
    fields.iter().map(move |field| {
        let columns = from..from + field.count();
        from = columns.end;
        (field, columns)
    })
}

/// The rotations among the observables.
fn rotations(run: &Finished<'_>) -> Vec<(&'static Field, Range<usize>)> {
    let turns = |field: &Field| {
        field.kind == Kind::UnitQuaternion || (field.kind == Kind::Rotation && field.count() == 9)
    };
    placed(run.card.observables)
        .filter(|(field, _)| turns(field))
        .collect()
}

/// The matrix body -> space of a rotation or a unit quaternion.
pub(crate) fn matrix(numbers: &[f64]) -> Option<Matrix3<f64>> {
    match *numbers {
        [w, x, y, z] => Some(Matrix3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        )),
        _ if numbers.len() == 9 => Some(Matrix3::from_row_slice(numbers)),
        _ => None,
    }
}

/// The rows of the samples shown, these columns of each.
fn rows<'a>(shown: Window<'a>, columns: &Range<usize>) -> impl Iterator<Item = &'a [f64]> {
    let columns = columns.clone();
    let rows = shown.record.observables.rows().take(shown.count);
    rows.filter_map(move |row| row.get(columns.clone()))
}

/// Spheres: of each rotation the body axis e₃ seen from space, of each vector of three components its direction, of each
/// body momentum its place on the sphere of its length, with lines of equal kinetic energy where those are known.
pub(crate) fn attitude(run: &Finished<'_>, samples: &Samples) -> Plot {
    let turning = rotations(run);
    if turning.is_empty() {
        return Ok(None);
    }
    let moves = |field: &Field| {
        [Kind::Vector, Kind::BodyMomentum].contains(&field.kind) && field.count() == 3
    };
    let moving = placed(run.card.observables).filter(|(field, _)| moves(field));
    let moving: Vec<(&Field, Range<usize>)> = moving.collect();
    let all: Vec<Range<usize>> = turning
        .iter()
        .chain(&moving)
        .map(|(_, c)| c.clone())
        .collect();
    let shown = window(samples, &all);
    let mut spheres = Vec::new();
    for (field, columns) in &turning {
        let axes = rows(shown, columns).filter_map(matrix);
        let name = field.name;
        let times = match field.kind {
            Kind::UnitQuaternion => format!("{name} e₃ {name}̄"),
            _ => format!("{name} e₃"),
        };
        spheres.push(Sphere {
            caption: format!("{times}: the body axis e₃ in space"),
            radius: 1.0,
            courses: vec![Course::of(axes.map(|turn| turn.column(2).into()))],
            contours: Vec::new(),
        });
    }
    for (field, columns) in &moving {
        let vectors: Vec<Vector3<f64>> =
            rows(shown, columns).map(Vector3::from_row_slice).collect();
        let lengths = || vectors.iter().map(Vector3::norm).filter(|x| x.is_finite());
        let longest = largest(lengths());
        let shortest = lengths().fold(f64::INFINITY, f64::min);
        if longest == 0.0 || !shortest.is_finite() {
            continue;
        }
        let name = letter(field);
        let on = longest - shortest <= SAME_LENGTH * longest;
        let length = super::axis::plain(rounded(longest));
        let contours = match field.kind {
            Kind::BodyMomentum if on => inverse_inertia(run).map_or_else(Vec::new, |inverse| {
                super::sphere::contours(longest, &|m| 0.5 * m.dot(&(inverse * m)))
            }),
            _ => Vec::new(),
        };
        let of = match moving.iter().filter(|(f, _)| letter(f) == name).count() {
            1 => String::new(),
            _ => format!(" ({})", field.name.replace('_', " ")),
        };
        let lines = if contours.is_empty() {
            ""
        } else {
            "; lines of equal kinetic energy"
        };
        spheres.push(Sphere {
            caption: match on {
                true => format!("{name}{of} on |{name}| = {length}{lines}"),
                false => format!("{name}{of} in the ball |{name}| ≤ {length}"),
            },
            radius: longest,
            courses: vec![Course::of(vectors.into_iter())],
            contours,
        });
    }
    spheres.truncate(MOST);
    let (title, subtitle) = super::titles(run, shown, "attitude");
    Ok(Some(sheet(&spheres, &title, &subtitle, run.plan.paper)))
}

/// Four digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// The inverse of the inertia `tr(J) Id - J`, where the model has one such J only.
fn inverse_inertia(run: &Finished<'_>) -> Option<Matrix3<f64>> {
    let card = run.card;
    let pairs = card.parameters.iter().zip(&run.plan.case.parameters);
    let mut second = pairs.filter(|(field, _)| {
        field.count() == 9 && [Kind::SecondMoments, Kind::Symmetric].contains(&field.kind)
    });
    let (_, numbers) = second.next()?;
    if second.next().is_some() {
        return None;
    }
    let j = Matrix3::from_row_slice(numbers.get(..9)?);
    (Matrix3::identity() * j.trace() - j).try_inverse()
}

/// Euler angles of each rotation, Λ = R₃(φ) R₁(θ) R₃(ψ) about space and body axes: precession and spin followed continuously, and nutation.
pub(crate) fn angles(run: &Finished<'_>, samples: &Samples) -> Plot {
    let turning = rotations(run);
    if turning.is_empty() {
        return Ok(None);
    }
    let all: Vec<Range<usize>> = turning.iter().map(|(_, columns)| columns.clone()).collect();
    let shown = window(samples, &all);
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let mut panels = Vec::new();
    for (field, columns) in &turning {
        let turns = rows(shown, columns).filter_map(matrix);
        let (mut precession, mut nutation, mut spin) = (Vec::new(), Vec::new(), Vec::new());
        for turn in turns {
            let [phi, theta, psi] = euler(&turn);
            precession.push(followed(precession.last().copied(), phi));
            nutation.push(theta);
            spin.push(followed(spin.last().copied(), psi));
        }
        let curve = |label: &str, number: usize, values: Vec<f64>| Curve {
            label: label.to_owned(),
            note: None,
            points: reduce::extremes(times, values.into_iter()),
            stroke: Stroke::number(number),
        };
        let name = field.name;
        let what = caption(field);
        let groups = [
            (
                format!("{what}; {name} = R₃(φ) R₁(θ) R₃(ψ)"),
                "angle (rad)",
                vec![
                    curve("φ precession", 0, precession),
                    curve("ψ spin", 1, spin),
                ],
            ),
            (
                format!("{name}: nutation"),
                "angle (rad)",
                vec![curve("θ nutation", 2, nutation)],
            ),
        ];
        for (caption, y_label, curves) in groups {
            panels.push(Panel {
                caption,
                y_label: y_label.to_owned(),
                y: Axis::around(&curves),
                curves,
                map: None,
                height: 200,
            });
        }
    }
    figure(run, shown, "Euler angles", panels)
}

/// φ, θ, ψ; θ from its sine and cosine, since the cosine alone loses half of the digits near 0 and π.
fn euler(r: &Matrix3<f64>) -> [f64; 3] {
    let sine = r[(0, 2)].hypot(r[(1, 2)]);
    // Upright, only the sum of both turns about the axis is known: the first has it.
    if sine < 1e-14 {
        return [r[(1, 0)].atan2(r[(0, 0)]), sine.atan2(r[(2, 2)]), 0.0];
    }
    [
        r[(0, 2)].atan2(-r[(1, 2)]),
        sine.atan2(r[(2, 2)]),
        r[(2, 0)].atan2(r[(2, 1)]),
    ]
}

/// The angle nearest to the one before.
fn followed(before: Option<f64>, angle: f64) -> f64 {
    let full = std::f64::consts::TAU;
    match before {
        Some(before) if before.is_finite() && angle.is_finite() => {
            angle + full * ((before - angle) / full).round()
        }
        _ => angle,
    }
}

#[cfg(test)]
mod tests {
    use super::{euler, followed, matrix};
    use clebsch::nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

    #[test]
    fn angles_give_the_rotation_back() {
        let upright = [(0.0, 0.0, 0.0), (0.4, 0.0, 0.0)];
        let others = [(0.3, 1.1, -2.0), (-3.0, 0.001, 0.5), (2.0, 3.1, 3.0)];
        for (phi, theta, psi) in upright.into_iter().chain(others) {
            let about = |axis: Vector3<f64>, angle: f64| {
                Rotation3::from_scaled_axis(axis * angle).into_inner()
            };
            let turn: Matrix3<f64> =
                about(Vector3::z(), phi) * about(Vector3::x(), theta) * about(Vector3::z(), psi);
            let found = euler(&turn);
            for (x, y) in found.into_iter().zip([phi, theta, psi]) {
                // Angles of a small nutation lose its digits.
                assert!((x - y).abs() < 1e-12, "{found:?}");
            }
            let q = UnitQuaternion::from_matrix(&turn);
            let Quaternion { coords } = *q.quaternion();
            let again = matrix(&[coords.w, coords.x, coords.y, coords.z]).expect("four numbers");
            assert!((again - turn).norm() < 1e-12, "{again}");
        }
        assert_eq!(followed(Some(6.0), -0.2), -0.2 + std::f64::consts::TAU);
        assert_eq!(followed(None, -0.2), -0.2);
    }
}
