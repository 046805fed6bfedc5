//! Carlson's integral R_F in terms of principal invariants, with derivatives. Takes invariants or a symmetric matrix;
//! gives half the integral of `1/sqrt(t^3 + I1 t^2 + I2 t + I3)` over positive t, by tanh-sinh quadrature.

use crate::functions::square_root;
use crate::matrix::Matrix;
use crate::number::Number;

/// The number of points on each side of the middle, and their distance. Close to a sphere, the rule is exact to
/// rounding.
const POINTS: i32 = 110;
const APART: f64 = 0.045;

/// The function of this path.
#[must_use]
pub fn named(path: &str, values: &[Matrix]) -> Option<Number> {
    let name = path.rsplit("::").next().unwrap_or(path).trim();
    match (name, values) {
        ("carlson_rf", [m]) => {
            let trace = m.trace();
            let square = m.times(m)?.trace();
            let second = trace.times(&trace).minus(&square);
            let second = second.times(&Number::exact(0.5));
            Some(of_invariants(&trace, &second, &m.determinant()?))
        }
        ("carlson_rf_of_invariants", [a, b, c]) => Some(of_invariants(
            a.as_number()?,
            b.as_number()?,
            c.as_number()?,
        )),
        _ => None,
    }
}

/// With `t = l exp(pi/2 sinh x)` the integrand falls off twice exponentially on both sides.
fn of_invariants(first: &Number, second: &Number, third: &Number) -> Number {
    let length = (first.value / 3.0).abs().max(f64::MIN_POSITIVE);
    let mut sum = Number::default();
    for k in -POINTS..=POINTS {
        let x = f64::from(k) * APART;
        let t = length * (std::f64::consts::FRAC_PI_2 * x.sinh()).exp();
        if !t.is_normal() || t > 1e100 {
            continue;
        }
        let weight = t * std::f64::consts::FRAC_PI_2 * x.cosh() * APART * 0.5;
        let at = Number::exact(t);
        let cubic = at
            .plus(first)
            .times(&at)
            .plus(second)
            .times(&at)
            .plus(third);
        sum = sum.plus(&Number::within(weight, 1e-15 * weight).over(&square_root(&cubic)));
    }
    // The error of the quadrature rule.
    sum.error += 1e-15 * sum.value.abs();
    for slope in &mut sum.slopes {
        slope.error += 1e-15 * slope.value.abs();
    }
    sum
}
