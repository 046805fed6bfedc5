//! Fits with known parameters and covariance.

use crate::systems::{Numbers, Undefined};
use clebsch_analysis::{FitError, Residuals, fit};
use nalgebra::{DMatrix, DVector};

/// A curve with parameters in R^n: gives the residual and its n derivatives at each of `count` points.
struct Curve<C> {
    dimension: usize,
    count: usize,
    curve: C,
}

impl<C: Fn(usize, &[f64]) -> (f64, Vec<f64>)> Residuals for Curve<C> {
    type Parameters = Vec<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn residuals(&self, at: &Vec<f64>) -> Result<DVector<f64>, Undefined> {
        Ok(DVector::from_fn(self.count, |i, _| (self.curve)(i, at).0))
    }

    fn jacobian(&self, at: &Vec<f64>) -> Result<DMatrix<f64>, Undefined> {
        Ok(DMatrix::from_fn(self.count, self.dimension, |i, j| {
            (self.curve)(i, at).1[j]
        }))
    }

    fn moved(&self, at: &Vec<f64>, by: &[f64]) -> Vec<f64> {
        at.iter().zip(by).map(|(x, y)| x + y).collect()
    }
}

#[test]
fn a_line_with_its_covariance() {
    // Points at x = 0 .. 9 with residuals of +-0.1 that are orthogonal to 1 and x: +, -, -, + repeated, then zeros.
    let noise = |i: usize| {
        if i < 8 {
            0.1 * [1.0, -1.0, -1.0, 1.0][i % 4]
        } else {
            0.0
        }
    };
    let curve = move |i: usize, c: &[f64]| {
        let x = i as f64;
        (c[0] + c[1] * x - (2.0 + 0.5 * x + noise(i)), vec![1.0, x])
    };
    let found = fit(
        &Curve {
            dimension: 2,
            count: 10,
            curve,
        },
        &vec![0.0, 0.0],
    )
    .unwrap();
    assert!((found.parameters[0] - 2.0).abs() < 1e-14 && (found.parameters[1] - 0.5).abs() < 1e-14);
    let variance = 8.0 * 0.01 / 8.0;
    assert!((found.variance.unwrap() - variance).abs() < 1e-15);
    // sum 1 = 10, sum x = 45, sum x^2 = 285, determinant 825.
    let truth = DMatrix::from_row_slice(2, 2, &[285.0, -45.0, -45.0, 10.0]) * (variance / 825.0);
    let covariance = found.covariance().unwrap();
    assert!((&covariance - &truth).amax() < 1e-15, "{covariance}");
    assert!((found.standard_errors().unwrap()[1] - truth[(1, 1)].sqrt()).abs() < 1e-15);
    assert!((found.correlation()[(0, 1)] + 45.0 / 2850.0_f64.sqrt()).abs() < 1e-14);
    assert!((found.moves.iter().map(|x| x[1]).sum::<f64>() - 0.5).abs() < 1e-14);
}

#[test]
fn decay_with_noise() {
    let mut numbers = Numbers(1);
    let data: Vec<f64> = (0..50)
        .map(|i| 3.0 * (-0.7 * 0.1 * i as f64).exp() + 0.01 * numbers.draw())
        .collect();
    let curve = |i: usize, c: &[f64]| {
        let t = 0.1 * i as f64;
        let e = (-c[1] * t).exp();
        (c[0] * e - data[i], vec![e, -c[0] * t * e])
    };
    let problem = Curve {
        dimension: 2,
        count: 50,
        curve,
    };
    for start in [vec![1.0, 0.1], vec![10.0, 3.0], vec![0.1, -0.5]] {
        let found = fit(&problem, &start).unwrap();
        let errors = found.standard_errors().unwrap();
        // Uniform noise in +-0.01 has the deviation 0.01 / sqrt(3).
        assert!((found.variance.unwrap().sqrt() - 0.01 / 3.0_f64.sqrt()).abs() < 0.001);
        assert!(
            (found.parameters[0] - 3.0).abs() < 4.0 * errors[0],
            "{found:?}"
        );
        assert!(
            (found.parameters[1] - 0.7).abs() < 4.0 * errors[1],
            "{found:?}"
        );
        // The covariance, from the normal equations.
        let j = problem.jacobian(&found.parameters).unwrap();
        let (a, b, c) = (
            j.column(0).norm_squared(),
            j.column(0).dot(&j.column(1)),
            j.column(1).norm_squared(),
        );
        let truth = found.variance.unwrap() / (a * c - b * b)
            * DMatrix::from_row_slice(2, 2, &[c, -b, -b, a]);
        assert!((found.covariance().unwrap() - &truth).amax() < 1e-12 * truth.amax());
        // The gradient vanishes up to the square root of the rounding.
        let r = problem.residuals(&found.parameters).unwrap();
        assert!(j.tr_mul(&r).amax() < 1e-6 * j.norm() * r.norm());
    }
}

#[test]
fn undetermined_parameters_are_named() {
    // Only the product of the first two parameters matters.
    let curve = |i: usize, c: &[f64]| {
        let x = i as f64;
        (
            c[0] * c[1] * x + c[2] - 3.0 * x - 1.0,
            vec![c[1] * x, c[0] * x, 1.0],
        )
    };
    let error = fit(
        &Curve {
            dimension: 3,
            count: 6,
            curve,
        },
        &vec![1.0, 2.0, 0.0],
    )
    .unwrap_err();
    let FitError::Undetermined { combination, ratio } = &error else {
        panic!("{error}")
    };
    assert!(
        combination[2].abs() < 1e-10 && combination[0] * combination[1] < -0.1 && *ratio < 1e-10,
        "{error}"
    );
    let unused = |i: usize, c: &[f64]| (c[0] - i as f64, vec![1.0, 0.0]);
    let error = fit(
        &Curve {
            dimension: 2,
            count: 6,
            curve: unused,
        },
        &vec![1.0, 2.0],
    )
    .unwrap_err();
    assert_eq!(
        error,
        FitError::Undetermined {
            combination: vec![0.0, 1.0],
            ratio: 0.0
        }
    );
}

#[test]
fn a_fit_without_a_minimum() {
    let curve = |_: usize, c: &[f64]| (1.0 + (-c[0]).exp(), vec![-(-c[0]).exp()]);
    let error = fit(
        &Curve {
            dimension: 1,
            count: 2,
            curve,
        },
        &vec![0.0],
    )
    .unwrap_err();
    assert!(
        matches!(error, FitError::NoConvergence { cosine, .. } if cosine > 0.9),
        "{error}"
    );
}

#[test]
fn as_many_residuals_as_parameters_have_no_variance() {
    let curve = |i: usize, c: &[f64]| (c[i] - 1.0, vec![[1.0, 0.0], [0.0, 1.0]][i].to_vec());
    let found = fit(
        &Curve {
            dimension: 2,
            count: 2,
            curve,
        },
        &vec![5.0, 7.0],
    )
    .unwrap();
    assert!(
        found.variance.is_none()
            && found.standard_errors().is_none()
            && found.correlation()[(0, 0)] == 1.0
    );
}
