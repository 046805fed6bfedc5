//! The Helmholtz smoother along a periodic direction: each Fourier component is divided by `1 + α²k²`, where k is its
//! wave number. Plain numbers use a real fast Fourier transform. Other scalars use a convolution with the kernel of
//! the same operator, in quadratic time: values agree to rounding, and the convolution, unlike the transform, also
//! propagates derivatives.

use super::axis::Axis;
use super::bounded::BLOCK;
use crate::Real;
use core::any::TypeId;
use core::fmt;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::sync::Arc;

/// The smoother of one periodic direction.
#[derive(Clone, Debug)]
pub(super) struct Periodic<T> {
    nodes: usize,
    way: Way<T>,
    block: Vec<T>,
}

#[derive(Clone, Debug)]
enum Way<T> {
    Transformed(Box<Transformed>),
    /// `1 - S` as a kernel, and a row to be convolved.
    Convolved(Vec<T>, Vec<T>),
}

/// Plans of the transforms, and their workspace.
#[derive(Clone)]
struct Transformed {
    to: Arc<dyn RealToComplex<f64>>,
    from: Arc<dyn ComplexToReal<f64>>,
    /// `1 - S` for each component, divided by the number of nodes.
    symbol: Vec<f64>,
    row: Vec<f64>,
    components: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// Whether a scalar is a plain number.
pub(super) fn is_plain<T: 'static>() -> bool {
    TypeId::of::<T>() == TypeId::of::<f64>()
}

impl fmt::Debug for Transformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Plans do not implement `Debug`.
        let mut all = f.debug_struct("Transformed");
        all.field("symbol", &self.symbol).finish_non_exhaustive()
    }
}

impl<T: Real> Periodic<T> {
    /// For the smoothing length `alpha`.
    pub fn new(axis: &Axis, alpha: T) -> Self {
        let nodes = axis.nodes();
        // `1 - S` for the component with this wave number.
        let whole = full_angle::<T>() * axis.density::<T>() / T::from_f64(nodes as f64);
        let symbol = |waves: usize| {
            let ratio = alpha * whole * T::from_f64(waves as f64);
            let square = ratio * ratio;
            square / (T::one() + square)
        };
        let way = match is_plain::<T>() {
            true => {
                let share = |waves: usize| symbol(waves).value() / nodes as f64;
                let symbol = (0..=nodes / 2).map(share).collect();
                Way::Transformed(Box::new(Transformed::new(nodes, symbol)))
            }
            false => Way::Convolved(kernel(nodes, symbol), vec![T::zero(); nodes]),
        };
        Self {
            nodes,
            way,
            block: vec![],
        }
    }

    /// Smooths along each row; a row has one value for each node.
    pub fn along(&mut self, values: &mut [T]) {
        for row in values.chunks_exact_mut(self.nodes) {
            match &mut self.way {
                Way::Transformed(transformed) => transformed.smooth(row),
                Way::Convolved(kernel, copy) => convolve(kernel, copy, row),
            }
        }
    }

    /// Smooths across rows of this length: `values` has one row for each node.
    pub fn across(&mut self, values: &mut [T], width: usize) {
        let nodes = self.nodes;
        if width == 0 || values.len() != nodes * width {
            return;
        }
        let mut block = core::mem::take(&mut self.block);
        for first in (0..width).step_by(BLOCK) {
            let count = BLOCK.min(width - first);
            block.resize(nodes * count, T::zero());
            for (i, row) in values.chunks_exact(width).enumerate() {
                for (c, value) in row[first..first + count].iter().enumerate() {
                    block[c * nodes + i] = *value;
                }
            }
            self.along(&mut block);
            for (i, row) in values.chunks_exact_mut(width).enumerate() {
                for (c, value) in row[first..first + count].iter_mut().enumerate() {
                    *value = block[c * nodes + i];
                }
            }
        }
        self.block = block;
    }
}

/// 2π in the precision of the scalar: a zero of the sine, after one Newton step.
fn full_angle<T: Real>() -> T {
    let near = T::from_f64(core::f64::consts::PI);
    let half = near + near.sin();
    half + half
}

/// Coefficients of the circulant matrix with the eigenvalues `symbol(waves)`.
fn kernel<T: Real>(nodes: usize, symbol: impl Fn(usize) -> T) -> Vec<T> {
    let step = full_angle::<T>() / T::from_f64(nodes as f64);
    let cosines: Vec<T> = (0..nodes)
        .map(|p| (step * T::from_f64(p as f64)).cos())
        .collect();
    let symbols: Vec<T> = (0..nodes).map(|k| symbol(k.min(nodes - k))).collect();
    let share = T::one() / T::from_f64(nodes as f64);
    let coefficient = |j: usize| {
        let terms = symbols.iter().enumerate();
        let sum = terms.fold(T::zero(), |sum, (k, s)| sum + *s * cosines[k * j % nodes]);
        sum * share
    };
    (0..nodes).map(coefficient).collect()
}

/// Subtracts the convolution with a kernel from a row.
fn convolve<T: Real>(kernel: &[T], copy: &mut [T], row: &mut [T]) {
    copy.copy_from_slice(row);
    let nodes = row.len();
    for (i, out) in row.iter_mut().enumerate() {
        let (ahead, behind) = kernel.split_at(nodes - i);
        let all = copy.iter().skip(i).zip(ahead);
        let all = all.chain(copy.iter().zip(behind));
        *out -= all.fold(T::zero(), |sum, (value, k)| sum + *value * *k);
    }
}

impl Transformed {
    /// Takes `1 - S` for each component, divided by the number of nodes. Not generic, so that transforms are compiled
    /// only once.
    fn new(nodes: usize, symbol: Vec<f64>) -> Self {
        let mut planner = RealFftPlanner::<f64>::new();
        let to = planner.plan_fft_forward(nodes);
        let from = planner.plan_fft_inverse(nodes);
        let scratch = to.get_scratch_len().max(from.get_scratch_len());
        Self {
            row: to.make_input_vec(),
            components: to.make_output_vec(),
            scratch: vec![Complex::default(); scratch],
            symbol,
            to,
            from,
        }
    }

    fn smooth<T: Real>(&mut self, row: &mut [T]) {
        for (plain, value) in self.row.iter_mut().zip(row.iter()) {
            *plain = value.value();
        }
        let (to, from) = (self.to.get_scratch_len(), self.from.get_scratch_len());
        let first = self.to.process_with_scratch(
            &mut self.row,
            &mut self.components,
            &mut self.scratch[..to],
        );
        for (component, symbol) in self.components.iter_mut().zip(&self.symbol) {
            *component *= *symbol;
        }
        let second = self.from.process_with_scratch(
            &mut self.components,
            &mut self.row,
            &mut self.scratch[..from],
        );
        // Rejects NaN, and lengths other than the planned one.
        if first.and(second).is_err() {
            self.row.fill(f64::NAN);
        }
        for (plain, value) in self.row.iter().zip(row) {
            *value -= T::from_f64(*plain);
        }
    }
}
