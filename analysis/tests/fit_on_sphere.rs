//! A fit with parameters on a manifold.

use crate::systems::{Numbers, Undefined};
use clebsch_analysis::{Residuals, fit};
use nalgebra::{DMatrix, DVector, Vector3};

/// A direction on the sphere from its components along given vectors.
struct Compass {
    along: Vec<Vector3<f64>>,
    data: Vec<f64>,
}

impl Compass {
    fn frame(n: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let aside = if n.x.abs() < 0.6 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        let first = n.cross(&aside).normalize();
        [first, n.cross(&first)]
    }
}

impl Residuals for Compass {
    type Parameters = Vector3<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        2
    }

    fn residuals(&self, at: &Vector3<f64>) -> Result<DVector<f64>, Undefined> {
        // Half of the sphere is forbidden, so that long steps fail.
        match at.z > 0.0 {
            true => Ok(DVector::from_fn(self.data.len(), |i, _| {
                self.along[i].dot(at) - self.data[i]
            })),
            false => Err(Undefined),
        }
    }

    fn jacobian(&self, at: &Vector3<f64>) -> Result<DMatrix<f64>, Undefined> {
        let frame = Self::frame(at);
        Ok(DMatrix::from_fn(self.data.len(), 2, |i, j| {
            self.along[i].dot(&frame[j])
        }))
    }

    fn moved(&self, at: &Vector3<f64>, by: &[f64]) -> Vector3<f64> {
        let [first, second] = Self::frame(at);
        (at + by[0] * first + by[1] * second).normalize()
    }
}

#[test]
fn a_direction_on_the_sphere() {
    let mut numbers = Numbers(2);
    let truth = Vector3::new(0.6, 0.0, 0.8);
    let along: Vec<Vector3<f64>> = (0..20)
        .map(|_| Vector3::from_fn(|_, _| numbers.draw()))
        .collect();
    let data = along.iter().map(|v| v.dot(&truth)).collect();
    let problem = Compass { along, data };
    let start = Vector3::new(-0.7, 0.69, 0.1).normalize();
    let found = fit(&problem, &start).unwrap();
    // The data are exact, so that the residuals end at rounding.
    assert!(
        (found.parameters - truth).norm() < 1e-14 && found.residual < 1e-14,
        "{found:?}"
    );
    let end = found
        .moves
        .iter()
        .fold(start, |at, by| problem.moved(&at, by.as_slice()));
    assert_eq!(end, found.parameters);
    // A start at the solution is a solution.
    assert!(fit(&problem, &truth).unwrap().residual < 1e-14);
}
