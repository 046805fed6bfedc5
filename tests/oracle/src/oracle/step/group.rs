//! The groups of the oracle: bases of their Lie algebras, exponentials and exact elements, to 32 digits. Matrices are row-major.

use crate::oracle::dual::Number;
use crate::oracle::pair::Pair;

/// A basis matrix of `n` rows with these entries.
fn with(n: usize, entries: &[(usize, usize, f64)]) -> Vec<f64> {
    let mut out = vec![0.0; n * n];
    for (i, j, x) in entries {
        out[i * n + j] += x;
    }
    out
}

/// Rotations in `n` dimensions: the hat matrices of the axes for n = 3, otherwise one rotation for each entry below the diagonal.
#[must_use]
pub fn rotations(n: usize) -> Vec<Vec<f64>> {
    if n == 3 {
        let planes = [(2, 1), (0, 2), (1, 0)];
        return planes
            .map(|(i, j)| with(3, &[(i, j, 1.0), (j, i, -1.0)]))
            .to_vec();
    }
    let pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| with(n, &[(i, j, 1.0), (j, i, -1.0)]))
        .collect()
}

/// Linear maps in `n` dimensions: one entry each, row by row.
#[must_use]
pub fn linear_maps(n: usize) -> Vec<Vec<f64>> {
    let all = (0..n * n).map(|k| with(n, &[(k / n, k % n, 1.0)]));
    all.collect()
}

/// Unit quaternions as left-multiplication matrices: half of each imaginary unit.
#[must_use]
pub fn quaternions() -> Vec<Vec<f64>> {
    let units = crate::oracle::action::quaternions::halves();
    units.iter().map(|m| m.0.concat()).collect()
}

/// Rigid motions in `n` dimensions, as matrices of size n + 1: rotations, then translations.
#[must_use]
pub fn rigid_motions(n: usize) -> Vec<Vec<f64>> {
    let widened = |turn: &Vec<f64>| {
        let entries: Vec<(usize, usize, f64)> =
            (0..n * n).map(|k| (k / n, k % n, turn[k])).collect();
        with(n + 1, &entries)
    };
    let turns = rotations(n);
    let places = (0..n).map(|i| with(n + 1, &[(i, n, 1.0)]));
    turns.iter().map(widened).chain(places).collect()
}

/// The product of two matrices of `n` rows.
#[must_use]
pub fn product<T: Number>(n: usize, a: &[T], b: &[T]) -> Vec<T> {
    let entry = |i: usize, j: usize| {
        let each = (0..n).map(|k| a[i * n + k] * b[k * n + j]);
        each.fold(T::constant(0.0), |sum, x| sum + x)
    };
    (0..n * n).map(|k| entry(k / n, k % n)).collect()
}

/// The identity of size `n`.
#[must_use]
pub fn identity<T: Number>(n: usize) -> Vec<T> {
    let entry = |k: usize| T::constant(f64::from(u8::from(k / n == k % n)));
    (0..n * n).map(entry).collect()
}

/// The matrix exponential, by scaling and squaring of the power series.
#[must_use]
pub fn exponential(n: usize, a: &[Pair]) -> Vec<Pair> {
    let size = a.iter().fold(0.0_f64, |m, x| m.max(x.high.abs()));
    let halvings = (size.max(1e-30).log2().ceil() as i32 + 4).max(0);
    let factor = Pair::constant(0.5_f64.powi(halvings));
    let small: Vec<Pair> = a.iter().map(|x| *x * factor).collect();
    let mut total = identity(n);
    let mut term: Vec<Pair> = identity(n);
    for k in 1..24 {
        let next = product(n, &term, &small);
        let divisor = Pair::constant(f64::from(k));
        term = next.into_iter().map(|x| x / divisor).collect();
        total = total.iter().zip(&term).map(|(x, y)| *x + *y).collect();
    }
    for _ in 0..halvings {
        total = product(n, &total, &total);
    }
    total
}

/// The inverse, by Newton's iteration from the inverse in double precision.
#[must_use]
pub fn inverse(n: usize, a: &[Pair]) -> Vec<Pair> {
    let rows = (0..n).map(|i| (0..n).map(|j| a[i * n + j].high).collect());
    let factored = super::dense::Factored::of(rows.collect());
    let mut x = vec![Pair::constant(0.0); n * n];
    for j in 0..n {
        let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == j))).collect();
        for (i, value) in factored.solve(&unit).into_iter().enumerate() {
            x[i * n + j] = Pair::constant(value);
        }
    }
    for _ in 0..3 {
        let ax = product(n, a, &x);
        let twice = identity::<Pair>(n);
        let rest: Vec<Pair> = twice.iter().zip(&ax).map(|(i, y)| *i + *i - *y).collect();
        x = product(n, &x, &rest);
    }
    x
}

/// The orthogonal matrix closest to a matrix that is orthogonal in double precision.
#[must_use]
pub fn orthogonal(n: usize, a: &[f64]) -> Vec<Pair> {
    let mut x: Vec<Pair> = a.iter().map(|x| Pair::constant(*x)).collect();
    for _ in 0..3 {
        let inverse = inverse(n, &x);
        let mean = |k: usize| (x[k] + inverse[(k % n) * n + k / n]) * Pair::constant(0.5);
        x = (0..n * n).map(mean).collect();
    }
    x
}
