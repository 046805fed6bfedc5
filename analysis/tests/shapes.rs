//! A flow whose values have wrong shapes.

use crate::refusals::says;
use clebsch_analysis::{Flow, Invalid, Search, lyapunov, orbit};
use nalgebra::DMatrix;

#[test]
fn wrong_shapes() {
    struct Wrong;
    impl Flow for Wrong {
        type State = f64;
        type Error = std::fmt::Error;
        fn dimension(&self) -> usize {
            1
        }
        fn step(&self, at: &f64, _: f64) -> Result<f64, std::fmt::Error> {
            Ok(*at)
        }
        fn tangent(&self, at: &f64, _: f64) -> Result<(f64, DMatrix<f64>), std::fmt::Error> {
            Ok((*at, DMatrix::zeros(2, 1)))
        }
        fn moved(&self, at: &f64, by: &[f64]) -> f64 {
            at + by[0]
        }
        fn difference(&self, _: &f64, _: &f64) -> Vec<f64> {
            Vec::new()
        }
    }
    let error = lyapunov(&Wrong, &0.0, 1.0, 1, 1).unwrap_err();
    let shape = Invalid::Shape {
        what: "tangent of a step",
        shape: (2, 1),
        expected: (1, 1),
    };
    assert_eq!(error, shape.into());
    says(
        &orbit(&Wrong, &0.0, 1.0, 1, &Search::default()).unwrap_err(),
        "rows",
    );
}
