//! The free rigid body on the sphere of its momenta: a flow on a manifold with charts.

use clebsch_analysis::{Flow, Search, Stability, linear, lyapunov, orbit};
use nalgebra::{DMatrix, Matrix3, Rotation3, SMatrix, Unit, Vector3};
use std::convert::Infallible;
use std::f64::consts::PI;

const INERTIA: Vector3<f64> = Vector3::new(1.0, 2.0, 3.0);

/// A symmetric composition of the exact flows of the three terms of the energy. Each is a rotation about an axis.
struct Body;

fn frame(m: &Vector3<f64>) -> SMatrix<f64, 3, 2> {
    let aside = if m.x.abs() < 0.6 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let first = m.cross(&aside).normalize();
    SMatrix::from_columns(&[first, m.cross(&first)])
}

impl Flow for Body {
    type State = Vector3<f64>;
    type Error = Infallible;

    fn dimension(&self) -> usize {
        2
    }

    fn step(&self, at: &Vector3<f64>, h: f64) -> Result<Vector3<f64>, Infallible> {
        self.tangent(at, h).map(|(next, _)| next)
    }

    fn tangent(
        &self,
        at: &Vector3<f64>,
        h: f64,
    ) -> Result<(Vector3<f64>, DMatrix<f64>), Infallible> {
        let (mut m, mut derivative) = (*at, Matrix3::identity());
        for (axis, part) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            // dm/dt = m x (m_i / I_i) e_i turns m about the axis, backwards.
            let mut e = Vector3::zeros();
            e[axis] = 1.0;
            let rate = -part * h / INERTIA[axis];
            let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(e), rate * m[axis]);
            m = turn * m;
            derivative = (turn.matrix() + rate * e.cross(&m) * e.transpose()) * derivative;
        }
        let local = frame(&m).transpose() * derivative * frame(at);
        Ok((m, DMatrix::from_column_slice(2, 2, local.as_slice())))
    }

    fn moved(&self, at: &Vector3<f64>, by: &[f64]) -> Vector3<f64> {
        (at + frame(at) * SMatrix::<f64, 2, 1>::new(by[0], by[1])).normalize()
    }

    fn difference(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Vec<f64> {
        (frame(from).transpose() * to / to.dot(from))
            .as_slice()
            .to_vec()
    }
}

#[test]
fn modes_at_the_axes() {
    for axis in 0..3 {
        let mut at = Vector3::zeros();
        at[axis] = 1.0;
        let found = linear(&Body, &at, 0.2, true).unwrap();
        let product: f64 = (0..3)
            .filter(|&i| i != axis)
            .map(|i| 1.0 / INERTIA[axis] - 1.0 / INERTIA[i])
            .product();
        // The square of the frequency. The limit has the rounding of a tangent over a step of about 0.01.
        match axis {
            1 => {
                assert!((found.limit_modes[0].growth - (-product).sqrt()).abs() < 1e-12);
                assert_eq!(found.limit_verdict.stability, Stability::Unstable);
            }
            _ => {
                assert!((found.limit_modes[1].frequency - product.sqrt()).abs() < 1e-12);
                assert_eq!(found.limit_verdict.stability, Stability::SpectrallyStable);
            }
        }
        // The step keeps the area of the sphere.
        assert!((found.modes[0].eigenvalue * found.modes[1].eigenvalue - 1.0).norm() < 1e-14);
    }
}

#[test]
fn periodic_orbit_about_the_long_axis() {
    // Small orbits have the period 2 pi / sqrt(1/3), larger ones a longer period.
    let (period, steps) = (1.05 * 2.0 * PI * 3.0_f64.sqrt(), 60);
    let start = Vector3::new(0.9, 0.3, -0.2).normalize();
    let found = orbit(
        &Body,
        &start,
        period / steps as f64,
        steps,
        &Search::default(),
    )
    .unwrap();
    assert!(found.residual < 1e-13 && found.size > 0.2, "{found:?}");
    assert!(
        (found.state.norm() - 1.0).abs() < 1e-15 && found.pairing_defect < 1e-12,
        "{found:?}"
    );
    assert!(
        found.floquet.values.iter().all(|x| (x - 1.0).norm() < 1e-5),
        "{found:?}"
    );
}

#[test]
fn a_regular_motion_has_no_exponent() {
    let found = lyapunov(
        &Body,
        &Vector3::new(0.5, 0.6, 0.7).normalize(),
        0.1,
        20_000,
        2,
    )
    .unwrap();
    // The tangent grows like the time t = 2000: ln(t) / t = 0.004.
    assert!(found.exponents[0].abs() < 0.006, "{:?}", found.exponents);
    assert!(
        (found.exponents[0] + found.exponents[1]).abs() < 1e-3,
        "{:?}",
        found.exponents
    );
}
