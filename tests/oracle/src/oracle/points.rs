//! Random points of the oracle, reproducible from a seed: rotations, vectors and matrices of order one, and the values of a model's
//! names as plain data.

use super::square::Square;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::array::from_fn;

/// The number in an environment variable, for longer runs than the suite; `usual` if the variable is absent or not a number.
#[must_use]
pub fn asked_for(variable: &str, usual: u64) -> u64 {
    let asked = std::env::var(variable).ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(usual)
}

/// A seeded source of random numbers.
#[derive(Clone, Debug)]
pub struct Source(Xoshiro256PlusPlus);

impl Source {
    /// The source of a seed.
    #[must_use]
    pub fn seeded(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in `[low, high)`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        // 53 random bits fill the mantissa of a number in [0, 1).
        let unit = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// An integer below `count`; 0 if `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.0.next_u64() % (count.max(1) as u64)).unwrap_or(0)
    }

    /// True `percent` times in a hundred.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// One of the choices, uniformly.
    pub fn choose<'a, T>(&mut self, choices: &'a [T]) -> Option<&'a T> {
        choices.get(self.below(choices.len()))
    }

    /// A vector with entries in `(-1, 1)`.
    pub fn vector<const N: usize>(&mut self) -> [f64; N] {
        from_fn(|_| self.between(-1.0, 1.0))
    }

    /// A matrix with entries in `(-1, 1)`.
    pub fn matrix<const N: usize>(&mut self) -> Square<f64, N> {
        Square(from_fn(|_| self.vector()))
    }

    /// A symmetric matrix with entries in `(-1, 1)`.
    pub fn symmetric<const N: usize>(&mut self) -> Square<f64, N> {
        let matrix: Square<f64, N> = self.matrix();
        Square::from_entries(|i, j| {
            if i <= j {
                matrix.0[i][j]
            } else {
                matrix.0[j][i]
            }
        })
    }

    /// A skew matrix with entries in `(-1, 1)`.
    pub fn skew<const N: usize>(&mut self) -> Square<f64, N> {
        let matrix: Square<f64, N> = self.matrix();
        Square::from_entries(|i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => matrix.0[i][j],
            std::cmp::Ordering::Equal => 0.0,
            std::cmp::Ordering::Greater => -matrix.0[j][i],
        })
    }

    /// A symmetric matrix with eigenvalues between 0.3 and 2; not diagonal.
    pub fn positive<const N: usize>(&mut self) -> Square<f64, N> {
        let frame = self.orthogonal::<N>();
        let spectrum: [f64; N] = from_fn(|_| self.between(0.3, 2.0));
        let product = Square::from_entries(|i, j| frame.0[i][j] * spectrum[j]) * frame.transpose();
        // Exactly symmetric, because constructors may check it.
        Square::from_entries(|i, j| product.0[i.min(j)][i.max(j)])
    }

    /// A rotation of N dimensions: orthogonal with determinant 1, far from the identity.
    pub fn orthogonal<const N: usize>(&mut self) -> Square<f64, N> {
        let mut rows = self.matrix::<N>().0;
        // Modified Gram-Schmidt, twice: a single pass leaves an error of the condition number times rounding.
        for _ in 0..2 {
            for i in 0..N {
                for j in 0..i {
                    let (row, earlier) = (rows[i], rows[j]);
                    let along = super::square::dot(&row, &earlier);
                    for c in 0..N {
                        rows[i][c] -= along * earlier[c];
                    }
                }
                let length = super::square::dot(&rows[i], &rows[i]).sqrt();
                rows[i] = rows[i].map(|entry| entry / length);
            }
        }
        if Square(rows).determinant() < 0.0 {
            rows[0] = rows[0].map(|entry| -entry);
        }
        Square(rows)
    }

    /// An invertible matrix with a determinant of at least 0.3 in magnitude.
    pub fn invertible<const N: usize>(&mut self) -> Square<f64, N> {
        loop {
            let matrix = Square::identity() + self.matrix().scaled(0.7);
            if matrix.determinant().abs() > 0.3 {
                return matrix;
            }
        }
    }
}

/// A derivative, with the size of its summands.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The derivative along each direction, one configuration after another.
    pub derivative: Vec<f64>,
    /// The natural scale: the sum over all summands of the larger of the summand and its largest derivative. The directions rotate
    /// by one radian, so both are comparable; the value matters if derivatives cancel.
    pub scale: f64,
}

impl Variation {
    /// The largest difference of a component, relative to the natural scale. Infinite for different lengths and for non-finite
    /// values, which must not count as agreement.
    #[must_use]
    pub fn disagreement(&self, found: &[f64]) -> f64 {
        if self.derivative.len() != found.len() {
            return f64::INFINITY;
        }
        let each = self.derivative.iter().zip(found);
        let each = each.map(|(expected, found)| (expected - found).abs() / self.scale);
        let each = each.map(|x| if x.is_finite() { x } else { f64::INFINITY });
        each.fold(0.0, |worst: f64, x| worst.max(x))
    }
}

/// The value of one name of a model.
#[derive(Clone, Debug)]
pub struct NamedValue {
    /// The name as written in the model.
    pub name: String,
    /// The node relative to the node of the residual: -1, 0 or 1; 0 for parameters.
    pub shift: i8,
    /// Rows of the value.
    pub rows: usize,
    /// Columns of the value.
    pub cols: usize,
    /// The entries, row by row.
    pub data: Vec<f64>,
}

impl NamedValue {
    /// A scalar parameter.
    #[must_use]
    pub fn scalar(name: &str, value: f64) -> Self {
        Self {
            name: name.to_owned(),
            shift: 0,
            rows: 1,
            cols: 1,
            data: vec![value],
        }
    }

    /// A column.
    #[must_use]
    pub fn column<const N: usize>(name: &str, shift: i8, value: &[f64; N]) -> Self {
        Self {
            name: name.to_owned(),
            shift,
            rows: N,
            cols: 1,
            data: value.to_vec(),
        }
    }

    /// A square matrix.
    #[must_use]
    pub fn square<const N: usize>(name: &str, shift: i8, value: &Square<f64, N>) -> Self {
        Self {
            name: name.to_owned(),
            shift,
            rows: N,
            cols: N,
            data: value.0.concat(),
        }
    }

    /// One matrix at each of the three nodes.
    #[must_use]
    pub fn at_nodes<const N: usize>(name: &str, values: [Square<f64, N>; 3]) -> Vec<Self> {
        [-1, 0, 1]
            .iter()
            .zip(&values)
            .map(|(&shift, value)| Self::square(name, shift, value))
            .collect()
    }

    /// One column at each of the three nodes.
    #[must_use]
    pub fn columns_at_nodes<const N: usize>(name: &str, values: [[f64; N]; 3]) -> Vec<Self> {
        [-1, 0, 1]
            .iter()
            .zip(&values)
            .map(|(&shift, value)| Self::column(name, shift, value))
            .collect()
    }
}
