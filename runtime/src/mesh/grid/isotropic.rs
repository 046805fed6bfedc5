//! Smoothing by the inverse of the Helmholtz operator of the plane, `S = (1 - α²(∂_1² + ∂_2²))⁻¹`, with the discrete
//! second derivatives of the one-dimensional smoothers S_1, S_2. Since `α²∂_d² = 1 - S_d⁻¹`, the equation is
//! `(S_1⁻¹ + S_2⁻¹ - 1) S H = H`. The split smoother `S_1 S_2` as preconditioner turns it into
//! `(S_1 + S_2 - S_1 S_2) S H = S_1 S_2 H`. This matrix needs only the one-dimensional smoothers, is positive definite in
//! the weights of nodes, and its eigenvalues are at most 1. Conjugate gradients solve for plain numbers, Chebyshev's
//! iteration for other scalars: its constant coefficients preserve derivatives.

use super::super::{Functional, MeshError, Setting, Wall};
use super::axis::Axis;
use super::nodes::Nodes;
use super::periodic::is_plain;
use super::smoother::{Directions, Weights};
use crate::{ParameterError, Real};

/// Conjugate gradients stop at this residual, relative to the right side.
const TOLERANCE: f64 = 1e-15;

/// Most iterations. Their number grows as the smoothing length in units of the spacing, 20 for twice the spacing.
const MOST: usize = 10_000;

/// Isotropic smoothing of values at nodes in the plane, `mesh S: Real at n = smooth_isotropic(H, alpha);`: its argument
/// is the values of another functional, its data the smoothing length.
// Named as models write it.
#[allow(non_camel_case_types)]
#[derive(Clone, Debug)]
pub struct smooth_isotropic<T, const D: usize> {
    directions: Directions<T, D>,
    weights: Weights<T>,
    /// A bound below the eigenvalues.
    least: f64,
    residual: Vec<T>,
    direction: Vec<T>,
    image: Vec<T>,
    part: Vec<T>,
}

/// The smallest eigenvalue of a one-dimensional smoother, or less.
fn least_of(axis: &Axis, alpha: f64) -> f64 {
    let ratio = alpha / axis.spacing();
    let most = match axis.wall() {
        Wall::Solid => 12.0,
        Wall::Periodic => core::f64::consts::PI.powi(2),
    };
    1.0 / (1.0 + most * ratio * ratio)
}

impl<T: Real> smooth_isotropic<T, 2> {
    /// `image = (S_1 + S_2 - S_1 S_2) direction`.
    fn multiply(&mut self) {
        self.part.copy_from_slice(&self.direction);
        self.directions.smooth(0, &mut self.part);
        let all = self.image.iter_mut().zip(&self.direction).zip(&self.part);
        all.for_each(|((image, all), part)| *image = *all - *part);
        self.directions.smooth(1, &mut self.image);
        let all = self.image.iter_mut().zip(&self.part);
        all.for_each(|(image, part)| *image += *part);
    }

    /// Smooths in place.
    fn solve(&mut self, values: &mut [T]) -> Result<(), MeshError> {
        self.directions.smooth(1, values);
        self.directions.smooth(0, values);
        let size = self.weights.product(values, values).sqrt().value();
        self.direction.copy_from_slice(values);
        self.multiply();
        let all = self.residual.iter_mut().zip(values.iter()).zip(&self.image);
        all.for_each(|((residual, right), image)| *residual = *right - *image);
        match is_plain::<T>() {
            true => self.conjugate_gradients(values, size),
            false => self.chebyshev(values),
        }
    }

    fn conjugate_gradients(&mut self, found: &mut [T], size: f64) -> Result<(), MeshError> {
        self.direction.copy_from_slice(&self.residual);
        let mut square = self.weights.product(&self.residual, &self.residual);
        for _ in 0..MOST {
            // This includes components that are zero and remain zero.
            if square.value().sqrt() <= TOLERANCE * size {
                return Ok(());
            }
            self.multiply();
            let curvature = self.weights.product(&self.direction, &self.image);
            let length = square / curvature;
            add(found, &self.direction, length);
            add(&mut self.residual, &self.image, -length);
            let next = self.weights.product(&self.residual, &self.residual);
            if !next.is_finite() {
                break;
            }
            let share = next / square;
            for (direction, residual) in self.direction.iter_mut().zip(&self.residual) {
                *direction = *residual + *direction * share;
            }
            square = next;
        }
        Err(MeshError::NotConverged {
            iterations: MOST,
            residual: square.value().sqrt() / size,
            tolerance: TOLERANCE,
        })
    }

    /// The number of steps that reduces the largest error of any component to the unit roundoff of the scalar.
    fn chebyshev(&mut self, found: &mut [T]) -> Result<(), MeshError> {
        let (middle, half) = ((1.0 + self.least) / 2.0, (1.0 - self.least) / 2.0);
        if half == 0.0 {
            return Ok(());
        }
        let root = self.least.sqrt();
        let factor = (1.0 - root) / (1.0 + root);
        let steps = (T::EPSILON.ln() - core::f64::consts::LN_2) / factor.ln();
        if steps.is_nan() || steps > MOST as f64 {
            return Err(MeshError::NotConverged {
                iterations: 0,
                residual: 1.0,
                tolerance: T::EPSILON,
            });
        }
        let mut share = half / middle;
        self.direction.fill(T::zero());
        let (mut keep, mut take) = (0.0, 1.0 / middle);
        for _ in 0..steps.ceil() as usize {
            let (kept, taken) = (T::from_f64(keep), T::from_f64(take));
            for (direction, residual) in self.direction.iter_mut().zip(&self.residual) {
                *direction = *direction * kept + *residual * taken;
            }
            self.multiply();
            add(found, &self.direction, T::one());
            add(&mut self.residual, &self.image, -T::one());
            let next = 1.0 / (2.0 * middle / half - share);
            (keep, take) = (next * share, 2.0 * next / half);
            share = next;
        }
        Ok(())
    }
}

/// `to += factor from`.
fn add<T: Real>(to: &mut [T], from: &[T], factor: T) {
    let all = to.iter_mut().zip(from);
    all.for_each(|(to, from)| *to += *from * factor);
}

impl<T: Real> Functional<T, 2> for smooth_isotropic<T, 2> {
    type Argument = T;
    type Data<'a> = (T,);

    fn new(setting: &Setting<2>, (alpha,): (T,)) -> Result<Self, ParameterError> {
        let nodes = Nodes::new(setting)?;
        let least = nodes.axes().map(|axis| least_of(&axis, alpha.value()));
        let zeros = || vec![T::zero(); nodes.count()];
        Ok(Self {
            directions: Directions::new(setting, &nodes, alpha)?,
            weights: Weights::new(&nodes),
            least: least[0] + least[1] - least[0] * least[1],
            residual: zeros(),
            direction: zeros(),
            image: zeros(),
            part: zeros(),
        })
    }

    fn sites(&self) -> usize {
        self.residual.len()
    }

    fn value(&mut self, at: &[T], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(at, self.sites())?;
        MeshError::unless_of_length(out, self.sites())?;
        out.copy_from_slice(at);
        self.solve(out)
    }

    fn pull_back(&mut self, _: &[T], seed: &[T], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(seed, self.sites())?;
        MeshError::unless_of_length(out, self.sites())?;
        self.weights.divide(seed, out);
        self.solve(out)?;
        self.weights.multiply(out);
        Ok(())
    }
}
