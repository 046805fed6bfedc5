//! The radix-2 fast Fourier transform in two directions; each length is a power of two. Complex numbers are pairs, and the last
//! direction is contiguous.

use core::f64::consts::TAU;

/// A complex number: real and imaginary part.
pub(super) type Complex = [f64; 2];

/// Tables for a transform of fixed lengths.
#[derive(Clone, Debug)]
pub(super) struct Fourier {
    lengths: [usize; 2],
    /// `exp(-2πi k / n)` for each direction.
    roots: [Vec<Complex>; 2],
    column: Vec<Complex>,
}

fn product(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

impl Fourier {
    /// For lengths that are powers of two; otherwise `None`.
    pub fn new(lengths: [usize; 2]) -> Option<Self> {
        let roots = |n: usize| {
            let angle = |k: usize| -TAU * k as f64 / n as f64;
            (0..n / 2)
                .map(|k| [angle(k).cos(), angle(k).sin()])
                .collect()
        };
        lengths.iter().all(|n| n.is_power_of_two()).then(|| Self {
            lengths,
            roots: lengths.map(roots),
            column: vec![[0.0; 2]; lengths[0]],
        })
    }

    /// `Σ_x values_x exp(-i k x)` in place, with wave numbers in the order 0, 1, ..., -2, -1.
    pub fn forwards(&mut self, values: &mut [Complex]) {
        let [rows, width] = self.lengths;
        for row in values.chunks_exact_mut(width) {
            transform(row, &self.roots[1]);
        }
        for j in 0..width {
            for i in 0..rows {
                self.column[i] = values[i * width + j];
            }
            transform(&mut self.column, &self.roots[0]);
            for i in 0..rows {
                values[i * width + j] = self.column[i];
            }
        }
    }

    /// The inverse, in place.
    pub fn backwards(&mut self, values: &mut [Complex]) {
        for [_, imaginary] in values.iter_mut() {
            *imaginary = -*imaginary;
        }
        self.forwards(values);
        let share = 1.0 / values.len() as f64;
        for [real, imaginary] in values.iter_mut() {
            (*real, *imaginary) = (*real * share, -*imaginary * share);
        }
    }

    /// The signed wave number of each component along a direction.
    pub fn waves(&self, d: usize) -> impl Iterator<Item = f64> + use<> {
        let n = self.lengths[d];
        (0..n).map(move |k| match 2 * k <= n {
            true => k as f64,
            false => k as f64 - n as f64,
        })
    }
}

/// Decimation in time, in place.
fn transform(values: &mut [Complex], roots: &[Complex]) {
    let n = values.len();
    if n < 2 {
        return;
    }
    let shift = usize::BITS - n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> shift;
        if i < j {
            values.swap(i, j);
        }
    }
    let mut half = 1;
    while half < n {
        let stride = n / (2 * half);
        for block in values.chunks_exact_mut(2 * half) {
            let (first, second) = block.split_at_mut(half);
            for (k, (a, b)) in first.iter_mut().zip(second).enumerate() {
                let turned = product(*b, roots[k * stride]);
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_sum_and_returns() {
        let mut fourier = Fourier::new([8, 4]).expect("powers of two");
        let value = |i: usize| [(i as f64 * 1.3).sin(), (i as f64 * 0.7).cos()];
        let start: Vec<Complex> = (0..32).map(value).collect();
        let mut found = start.clone();
        fourier.forwards(&mut found);
        for (k, found) in found.iter().enumerate() {
            let mut sum = [0.0; 2];
            for (i, value) in start.iter().enumerate() {
                let waves = (k / 4 * (i / 4)) as f64 / 8.0 + (k % 4 * (i % 4)) as f64 / 4.0;
                let term = product(*value, [(TAU * waves).cos(), -(TAU * waves).sin()]);
                sum = [sum[0] + term[0], sum[1] + term[1]];
            }
            assert!((found[0] - sum[0]).abs() + (found[1] - sum[1]).abs() < 1e-13);
        }
        fourier.backwards(&mut found);
        for (a, b) in found.iter().zip(&start) {
            assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-15 * 8.0);
        }
        assert!(Fourier::new([12, 8]).is_none());
    }
}
