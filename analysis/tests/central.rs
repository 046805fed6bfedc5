//! Motion in a central field, with the angular momentum as a conserved quantity.

use crate::systems::Undefined;
use clebsch_analysis::{Definiteness, End, Energy, First, Track, continuation};
use nalgebra::{DMatrix, DVector};

/// H = |p|^2 / 2 + |q|^4 / 4 in the plane with angular momentum equal to the parameter.
pub struct Central;

impl Energy for Central {
    type State = Vec<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        4
    }

    fn constraints(&self) -> usize {
        1
    }

    fn first(&self, at: &Vec<f64>, l: f64) -> Result<First, Undefined> {
        let [x, y, p, q] = [at[0], at[1], at[2], at[3]];
        let square = x * x + y * y;
        Ok(First {
            energy: (p * p + q * q) / 2.0 + square * square / 4.0,
            gradient: DVector::from_vec(vec![square * x, square * y, p, q]),
            conserved: DVector::from_element(1, x * q - y * p - l),
            gradients: DMatrix::from_row_slice(1, 4, &[q, -p, -y, x]),
        })
    }

    fn second(
        &self,
        at: &Vec<f64>,
        _: f64,
        multipliers: &[f64],
    ) -> Result<DMatrix<f64>, Undefined> {
        let (x, y, w) = (at[0], at[1], multipliers[0]);
        let (a, b, c) = (3.0 * x * x + y * y, 2.0 * x * y, x * x + 3.0 * y * y);
        Ok(DMatrix::from_row_slice(
            4,
            4,
            &[
                a, b, 0.0, w, b, c, -w, 0.0, 0.0, -w, 1.0, 0.0, w, 0.0, 0.0, 1.0,
            ],
        ))
    }

    fn in_parameter(
        &self,
        _: &Vec<f64>,
        _: f64,
        _: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), Undefined> {
        Ok((DVector::zeros(4), DVector::from_element(1, -1.0)))
    }

    fn moved(&self, at: &Vec<f64>, by: &[f64]) -> Vec<f64> {
        at.iter().zip(by).map(|(x, y)| x + y).collect()
    }

    fn difference(&self, from: &Vec<f64>, to: &Vec<f64>) -> Vec<f64> {
        to.iter().zip(from).map(|(x, y)| x - y).collect()
    }

    fn symmetries(&self, at: &Vec<f64>) -> DMatrix<f64> {
        DMatrix::from_column_slice(4, 1, &[-at[1], at[0], -at[3], at[2]])
    }
}

#[test]
fn circular_orbits_grow_with_angular_momentum() {
    let start = vec![0.8, 0.6, -0.55, 0.85];
    let branch = continuation(
        &Central,
        &start,
        &[0.0],
        1.0,
        8.0,
        &Track::between(1.0, 8.0),
    )
    .unwrap();
    assert!(branch.end == End::Reached && branch.specials.is_empty());
    for point in &branch.points {
        // A circle of radius r has frequency r and angular momentum r^3.
        let r = point.state[0].hypot(point.state[1]);
        assert!((r - point.p.cbrt()).abs() < 1e-12, "{point:?}");
        assert!((point.multipliers[0] + r).abs() < 1e-12);
        assert_eq!(
            (point.variation.definiteness, point.variation.symmetric),
            (Definiteness::Minimum, 1)
        );
    }
}
