//! Derivatives by central differences, extrapolated from three distances.

use clebsch::derivatives::{Derivatives, Jacobian, Point};

/// The largest distance. The truncation error of the extrapolation is of order `DISTANCE^6`, about 1e-15; rounding divided
/// by the smallest distance is about 1e-12.
const DISTANCE: f64 = 2e-3;

/// The largest difference between exact derivatives and differences, in units of the largest derivative: a hundred times
/// the rounding of the differences.
pub const NEAR: f64 = 1e-10;

/// Extrapolates central differences of `f` at 0.
pub fn slope(f: &mut dyn FnMut(f64) -> Vec<f64>, distance: f64) -> Vec<f64> {
    let mut at = |d: f64| -> Vec<f64> {
        let (a, b) = (f(d), f(-d));
        a.iter().zip(&b).map(|(a, b)| (a - b) / (2.0 * d)).collect()
    };
    let [wide, half, quarter] = [distance, distance / 2.0, distance / 4.0].map(&mut at);
    let each = (0..wide.len()).map(|i| {
        let one = (4.0 * half[i] - wide[i]) / 3.0;
        let other = (4.0 * quarter[i] - half[i]) / 3.0;
        (16.0 * other - one) / 15.0
    });
    each.collect()
}

/// The derivative of `f` along each coordinate of a state.
pub fn columns(
    flow: &mut dyn Derivatives,
    at: &Point,
    f: &mut dyn FnMut(&mut dyn Derivatives, &Point) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    let count: usize = flow.dimensions().iter().sum();
    let mut column = |k: usize| {
        let mut along = |d: f64| {
            let mut by = vec![0.0; count];
            by[k] = d;
            let moved = flow.moved(at, &by).expect("a state nearby");
            f(flow, &moved)
        };
        slope(&mut along, DISTANCE)
    };
    (0..count).map(&mut column).collect()
}

/// The largest difference between a matrix and its columns, in units of its largest entry.
pub fn off(exact: &Jacobian, columns: &[Vec<f64>]) -> f64 {
    let flat: Vec<f64> = columns.concat();
    assert_eq!(flat.len(), exact.entries.len());
    off_by(&exact.entries, &flat)
}

/// The largest difference between two lists, in units of the largest number.
pub fn off_by(exact: &[f64], other: &[f64]) -> f64 {
    let size = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let pairs = exact.iter().zip(other);
    pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / size
}
