//! Euler angles of rotations: against time, of many sites as maps over sites and time.
//! Takes the samples of a run; gives precession, nutation and spin of each.

use super::attitude::{Placed, QuantityColumns, grouped, rotations, rows};
use super::axis::Axis;
use super::curve::{Curve, Stroke};
use super::figure::Panel;
use super::window::{Window, window};
use super::{Plot, caption, figure, reduce, sites};
use crate::output::Finished;
use crate::output::attitude::matrix;
use crate::trajectory::record::Samples;
use clebsch::nalgebra::Matrix3;
use std::ops::Range;

/// The largest number of sites that have two charts each.
const FEW: usize = 3;

/// Sine of the nutation below which rounding shows in precession and spin.
const UPRIGHT: f64 = 1e-6;

/// Sine of the nutation below which a body is near the vertical: there, small motions change precession and spin by
/// large angles.
const NEAR: f64 = 0.05;

/// If a body is near the vertical more often than this, or in more than this fraction of the samples, precession and
/// spin do not describe its motion.
const PASSAGES: usize = 2;
const STAY: f64 = 0.1;

/// Half turns in both directions count as equally near up to this fraction of a turn.
const HALF: f64 = 1e-3;

/// Euler angles of each rotation, Λ = R₃(φ) R₁(θ) R₃(ψ) about space and body axes: precession and spin followed continuously, and nutation.
pub(crate) fn angles(run: &Finished<'_>, samples: &Samples) -> Plot {
    let turning = rotations(run);
    if turning.is_empty() {
        return Ok(None);
    }
    let all: Vec<Range<usize>> = turning.iter().map(|(_, columns)| columns.clone()).collect();
    let shown = window(samples, &all);
    let mut panels = Vec::new();
    for kin in grouped(run, turning) {
        let meaning = |own: &Placed| Meaning::of(rows(shown, &own.1).filter_map(matrix));
        match kin.members.len() {
            ..=FEW => {
                for (_, own) in &kin.members {
                    panels.extend(curves(own, shown, meaning(own)));
                }
            }
            // The maps show only angles that are meaningful at every site.
            _ => {
                let all = kin.members.iter().map(|(_, own)| meaning(own));
                panels.extend(maps(&kin, shown, all.fold(Meaning::All, Meaning::least)));
            }
        }
    }
    if panels.is_empty() {
        return Ok(None);
    }
    figure(run, shown, "Euler angles", panels)
}

/// Which angles describe how a body moves. When its third axis passes the vertical, precession and spin jump by
/// half a turn although the motion does not. Their curves then show the chart, not the body. Near the upward
/// vertical their sum remains defined.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Meaning {
    /// None: the body passes the downward vertical repeatedly, where no sum of the angles is defined.
    Nothing,
    /// Nutation and the sum: the body passes the upward vertical repeatedly, or stays near it.
    Sum,
    /// All three.
    All,
}

impl Meaning {
    fn least(self, other: Self) -> Self {
        self.min(other)
    }

    /// Classifies the attitudes at the samples.
    fn of(turns: impl Iterator<Item = Matrix3<f64>>) -> Self {
        let mut up = Passages::default();
        let mut down = Passages::default();
        let mut count = 0;
        let mut before: Option<Matrix3<f64>> = None;
        for turn in turns {
            count += 1;
            // The body passed the vertical between two samples if the horizontal part of the axis is reversed
            // by a small rotation.
            let across = |r: &Matrix3<f64>| [r[(0, 2)], r[(1, 2)]];
            let round = before.is_some_and(|b| {
                let ([x, y], [u, v]) = (across(&b), across(&turn));
                x * u + y * v < 0.0 && (b.transpose() * turn).trace() > 2.4
            });
            let near = across(&turn).iter().map(|x| x * x).sum::<f64>() < NEAR * NEAR;
            let upward = turn[(2, 2)] > 0.0;
            up.sample(near && upward, round && upward);
            down.sample(near && !upward, round && !upward);
            before = Some(turn);
        }
        match (up.often(count), down.often(count)) {
            (_, true) => Meaning::Nothing,
            (true, false) => Meaning::Sum,
            (false, false) => Meaning::All,
        }
    }
}

/// How often a body comes near the vertical.
#[derive(Default)]
struct Passages {
    number: usize,
    samples: usize,
    is_near: bool,
}

impl Passages {
    fn sample(&mut self, near: bool, round: bool) {
        if (near || round) && !self.is_near {
            self.number += 1;
        }
        self.samples += usize::from(near);
        self.is_near = near || round;
    }

    fn often(&self, count: usize) -> bool {
        self.number > PASSAGES || self.samples as f64 > STAY * count as f64
    }
}

/// The angles of one rotation against time.
fn curves((field, columns): &Placed, shown: Window<'_>, meaning: Meaning) -> Vec<Panel> {
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let (mut precession, mut nutation, mut spin) = (Vec::new(), Vec::new(), Vec::new());
    let mut sum = Vec::new();
    for turn in rows(shown, columns).filter_map(matrix) {
        let [phi, theta, psi] = euler(&turn);
        precession.push(followed(precession.last().copied(), phi));
        nutation.push(theta);
        spin.push(followed(spin.last().copied(), psi));
        let [.., whole] = determined(&turn);
        sum.push(followed(sum.last().copied(), whole));
    }
    let curve = |label: &str, number: usize, values: Vec<f64>| Curve {
        label: label.to_owned(),
        note: None,
        points: reduce::extremes(times, values.into_iter()),
        stroke: Stroke::number(number),
    };
    let panel = |caption: String, curves: Vec<Curve>| Panel {
        caption,
        y_label: "angle (rad)".to_owned(),
        y: Axis::around(&curves),
        curves,
        map: None,
        height: 200,
    };
    let name = field.name;
    let turning = format!("{}; {name} = R₃(φ) R₁(θ) R₃(ψ)", caption(field));
    let first = match meaning {
        Meaning::Nothing => return Vec::new(),
        Meaning::Sum => panel(
            format!("{turning}; at upright attitudes φ and ψ are undetermined"),
            vec![curve("φ + ψ", 0, sum)],
        ),
        Meaning::All => {
            let both = vec![
                curve("φ precession", 0, precession),
                curve("ψ spin", 1, spin),
            ];
            panel(turning, both)
        }
    };
    let nutation = vec![curve("θ nutation", 2, nutation)];
    vec![first, panel(format!("{name}: nutation"), nutation)]
}

/// The angles of the rotations at many sites, over sites and time. The sum φ + ψ is included: for an upright
/// body only the sum is defined.
fn maps(kin: &QuantityColumns, shown: Window<'_>, meaning: Meaning) -> Vec<Panel> {
    let times = shown.record.times.get(..shown.count).unwrap_or_default();
    let mut all = [const { Rows::new() }; 4];
    for (site, (_, columns)) in sites::shown(&kin.members) {
        let mut own = [const { Vec::new() }; 4];
        for row in rows(shown, columns) {
            let angles = matrix(row).map_or([f64::NAN; 4], |turn| determined(&turn));
            for (list, angle) in own.iter_mut().zip(angles) {
                list.push(angle);
            }
        }
        for (rows, own) in all.iter_mut().zip(own) {
            rows.push((site.unwrap_or_default(), own));
        }
    }
    let name = &kin.name;
    let [theta, phi, psi, turn] = all;
    let map = |caption: String, rows| sites::mapped(caption, &kin.index, times, rows, 1.0);
    let turning = |what: &str, upright: &str, rows: Rows| {
        let white = rows
            .iter()
            .flat_map(|(_, row)| row)
            .any(|angle| angle.is_nan());
        let white = if white { upright } else { "" };
        match continued(&rows) {
            Some(rows) => map(format!("{what} of {name}, in rad{white}"), rows),
            None => map(format!("{what} of {name}, in rad modulo 2π{white}"), rows),
        }
    };
    let tilt = map(
        format!("nutation θ of {name} = R₃(φ) R₁(θ) R₃(ψ), in rad"),
        theta,
    );
    let sum = turning("φ + ψ", "; white where θ = π", turn);
    match meaning {
        Meaning::Nothing => Vec::new(),
        Meaning::Sum => vec![tilt, sum],
        Meaning::All => vec![
            tilt,
            turning("precession φ", "; white where θ = 0, π", phi),
            turning("spin ψ", "; white where θ = 0, π", psi),
            sum,
        ],
    }
}

/// Sites with an angle at each sample.
type Rows = Vec<(usize, Vec<f64>)>;

/// The angles without jumps of 2π. `None` if an angle is undefined at some sample, or changes by more than π/2
/// from one sample to the next. Full turns cannot be counted then, for example if a body passes the vertical.
fn continued(rows: &Rows) -> Option<Rows> {
    let follow = |row: &Vec<f64>| {
        let mut out: Vec<f64> = Vec::with_capacity(row.len());
        for angle in row {
            let before = out.last().copied();
            let angle = followed(before, *angle);
            let near = before.is_none_or(|b| (angle - b).abs() < std::f64::consts::FRAC_PI_2);
            out.push(Some(angle).filter(|a| near && a.is_finite())?);
        }
        Some(out)
    };
    let each = rows.iter().map(|(site, row)| Some((*site, follow(row)?)));
    each.collect()
}

/// θ, φ, ψ and φ + ψ; NaN if an angle is undefined.
fn determined(r: &Matrix3<f64>) -> [f64; 4] {
    let [phi, theta, psi] = euler(r);
    // (1 + cos θ) times sine and cosine of the sum: accurate at small θ, unlike φ and ψ.
    let sum = (r[(1, 0)] - r[(0, 1)]).atan2(r[(0, 0)] + r[(1, 1)]);
    match theta.sin() < UPRIGHT {
        false => [theta, phi, psi, sum],
        true if theta < 1.0 => [theta, f64::NAN, f64::NAN, sum],
        true => [theta, f64::NAN, f64::NAN, f64::NAN],
    }
}

/// φ, θ, ψ. θ is computed from its sine and cosine, since the cosine loses half of the digits near 0 and π.
fn euler(r: &Matrix3<f64>) -> [f64; 3] {
    let sine = r[(0, 2)].hypot(r[(1, 2)]);
    // In the upright position only the sum of both angles is known: it becomes the first angle.
    if sine < 1e-14 {
        return [r[(1, 0)].atan2(r[(0, 0)]), sine.atan2(r[(2, 2)]), 0.0];
    }
    [
        r[(0, 2)].atan2(-r[(1, 2)]),
        sine.atan2(r[(2, 2)]),
        r[(2, 0)].atan2(r[(2, 1)]),
    ]
}

/// The angle nearest to the one before. In a plane through the vertical, precession and spin jump by half a turn.
/// Both directions are equally near; the direction towards zero is chosen, so that jumps do not accumulate.
fn followed(before: Option<f64>, angle: f64) -> f64 {
    let full = std::f64::consts::TAU;
    let Some(before) = before.filter(|before| before.is_finite() && angle.is_finite()) else {
        return angle;
    };
    let turns = (before - angle) / full;
    let sides = [turns.floor(), turns.ceil()].map(|whole| angle + full * whole);
    if (turns - turns.floor() - 0.5).abs() > HALF {
        return angle + full * turns.round();
    }
    let [below, above] = sides;
    if below.abs() <= above.abs() {
        below
    } else {
        above
    }
}

#[cfg(test)]
mod tests {
    use super::{Meaning, determined, euler, followed, matrix};
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
        // Back and forth through the vertical.
        let quarter = std::f64::consts::FRAC_PI_2;
        let mut angle = quarter;
        for k in 0..20 {
            let turned = if k % 2 == 0 { -quarter } else { quarter };
            angle = followed(Some(angle), turned * (1.0 + 1e-15));
            assert!((angle.abs() - quarter).abs() < 1e-12, "{angle}");
        }
    }

    #[test]
    fn angles_mean_nothing_where_the_vertical_is_passed_again_and_again() {
        let turn =
            |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle).into_inner();
        let all = |of: &dyn Fn(f64) -> Matrix3<f64>| {
            Meaning::of((0..400).map(|k| of(0.05 * f64::from(k))))
        };
        // A top that precesses, a sleeping one, a pendulum through the upward vertical, and one through both.
        let tilted =
            |t: f64| turn(Vector3::z(), t) * turn(Vector3::x(), 0.6 + 0.1 * (3.0 * t).sin());
        assert_eq!(
            all(&|t| tilted(t) * turn(Vector3::z(), 5.0 * t)),
            Meaning::All
        );
        assert_eq!(all(&|t| turn(Vector3::z(), t)), Meaning::Sum);
        assert_eq!(all(&|t| turn(Vector3::x(), t.sin())), Meaning::Sum);
        assert_eq!(all(&|t| turn(Vector3::x(), 2.0 * t)), Meaning::Nothing);
        // The samples on both sides of a passage are far from the vertical.
        assert_eq!(
            all(&|t| turn(Vector3::x(), (13.0 * t).sin() * 0.3)),
            Meaning::Sum
        );
    }

    #[test]
    fn upright_the_sum_of_both_turns_is_known() {
        let turn =
            |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle).into_inner();
        let upright = turn(Vector3::z(), 0.7) * turn(Vector3::x(), 1e-9);
        let [theta, phi, psi, sum] = determined(&upright);
        assert!(theta < 1e-8 && phi.is_nan() && psi.is_nan());
        assert!((sum - 0.7).abs() < 1e-12, "{sum}");
        let inclined = turn(Vector3::z(), 0.7) * turn(Vector3::x(), 0.3) * turn(Vector3::z(), 0.2);
        for (x, y) in determined(&inclined).into_iter().zip([0.3, 0.7, 0.2, 0.9]) {
            assert!((x - y).abs() < 1e-12, "{x} {y}");
        }
        assert!(determined(&turn(Vector3::x(), std::f64::consts::PI))[3].is_nan());
    }
}
