//! Smoothing on a grid by the inverse of a Helmholtz operator, direction after direction: `S = S_1 S_2`, where each
//! factor is `(1 - α²∂²)⁻¹`, by finite elements between walls, by Fourier components along a periodic direction. The
//! factors commute, and S is self-adjoint with the weights w of nodes, `Σ w a S b = Σ w b S a`: the transposed
//! derivative is `w S w⁻¹`. Takes values at nodes, gives values at nodes; it preserves `Σ w H` and constants.

use super::super::length::check_length;
use super::super::{Functional, MeshError, Setting, Wall};
use super::bounded::Bounded;
use super::nodes::Nodes;
use super::periodic::Periodic;
use crate::scalar::largest;
use crate::{ParameterError, Real};

/// The smoother of one direction.
#[derive(Clone, Debug)]
enum AxisSmoother<T> {
    Bounded(Bounded<T>),
    Periodic(Periodic<T>),
}

/// One-dimensional smoothers along each direction.
#[derive(Clone, Debug)]
pub(super) struct Directions<T, const D: usize> {
    along: [AxisSmoother<T>; D],
    /// Nodes along each direction.
    nodes: [usize; D],
}

impl<T: Real, const D: usize> Directions<T, D> {
    /// For the smoothing length `alpha`.
    pub fn new(setting: &Setting<D>, nodes: &Nodes<D>, alpha: T) -> Result<Self, ParameterError> {
        check_length(alpha, &setting.domain)?;
        let along = nodes.axes().map(|axis| match axis.wall() {
            Wall::Solid => AxisSmoother::Bounded(Bounded::new(&axis, alpha)),
            Wall::Periodic => AxisSmoother::Periodic(Periodic::new(&axis, alpha)),
        });
        let nodes = nodes.axes().map(|axis| axis.nodes());
        Ok(Self { along, nodes })
    }

    /// Smooths along one direction.
    pub fn smooth(&mut self, d: usize, values: &mut [T]) {
        let width = self.nodes.iter().skip(d + 1).product();
        match (&mut self.along[d], width) {
            (AxisSmoother::Bounded(one), 1) => one.along(values),
            (AxisSmoother::Periodic(one), 1) => one.along(values),
            (one, _) => {
                for block in values.chunks_exact_mut(self.nodes[d] * width) {
                    match one {
                        AxisSmoother::Bounded(one) => one.across(block, width),
                        AxisSmoother::Periodic(one) => one.across(block, width),
                    }
                }
            }
        }
    }
}

/// Twice the largest spacing of the grid: the default smoothing length.
///
/// # Errors
/// As [`Nodes::new`].
pub fn smoothing_length<const D: usize>(setting: &Setting<D>) -> Result<f64, ParameterError> {
    let nodes = Nodes::new(setting)?;
    let spacings = nodes.axes().iter().map(|axis| axis.spacing());
    Ok(2.0 * largest(spacings))
}

/// The weights of nodes and their reciprocals, which transpose a self-adjoint operator.
#[derive(Clone, Debug)]
pub(super) struct Weights<T>(Vec<(T, T)>);

impl<T: Real> Weights<T> {
    pub fn new<const D: usize>(nodes: &Nodes<D>) -> Self {
        let all = nodes.weights::<T>().into_iter();
        Self(all.map(|w| (w, T::one() / w)).collect())
    }

    /// `Σ w a b`, in the order of nodes.
    pub fn product(&self, a: &[T], b: &[T]) -> T {
        let all = self.0.iter().zip(a.iter().zip(b));
        all.fold(T::zero(), |sum, ((w, _), (a, b))| sum + *w * *a * *b)
    }

    /// `out = seed / w`.
    pub fn divide(&self, seed: &[T], out: &mut [T]) {
        let all = out.iter_mut().zip(seed).zip(&self.0);
        all.for_each(|((out, seed), (_, inverse))| *out = *seed * *inverse);
    }

    /// `out = w out`.
    pub fn multiply(&self, out: &mut [T]) {
        let all = out.iter_mut().zip(&self.0);
        all.for_each(|(out, (w, _))| *out *= *w);
    }
}

/// Smoothing of values at nodes, direction after direction, `mesh S: Real at n = smooth(H, alpha);`: its argument is the
/// values of another functional, its data the smoothing length. In one dimension, or with `alpha = 0`, the same as
/// [`smooth_isotropic`](super::smooth_isotropic).
// Named as models write it.
#[allow(non_camel_case_types)]
#[derive(Clone, Debug)]
pub struct smooth<T, const D: usize> {
    directions: Directions<T, D>,
    weights: Weights<T>,
}

impl<T: Real, const D: usize> smooth<T, D> {
    fn apply(&mut self, values: &mut [T]) {
        for d in (0..D).rev() {
            self.directions.smooth(d, values);
        }
    }
}

impl<T: Real, const D: usize> Functional<T, D> for smooth<T, D> {
    type Argument = T;
    type Data<'a> = (T,);

    fn new(setting: &Setting<D>, (alpha,): (T,)) -> Result<Self, ParameterError> {
        let nodes = Nodes::new(setting)?;
        Ok(Self {
            directions: Directions::new(setting, &nodes, alpha)?,
            weights: Weights::new(&nodes),
        })
    }

    fn sites(&self) -> usize {
        self.weights.0.len()
    }

    fn value(&mut self, at: &[T], out: &mut [T]) -> Result<(), MeshError> {
        let sites = self.sites();
        MeshError::unless_of_length(at, sites)?;
        MeshError::unless_of_length(out, sites)?;
        out.copy_from_slice(at);
        self.apply(out);
        Ok(())
    }

    fn pull_back(&mut self, _: &[T], seed: &[T], out: &mut [T]) -> Result<(), MeshError> {
        let sites = self.sites();
        MeshError::unless_of_length(seed, sites)?;
        MeshError::unless_of_length(out, sites)?;
        self.weights.divide(seed, out);
        self.apply(out);
        self.weights.multiply(out);
        Ok(())
    }
}
