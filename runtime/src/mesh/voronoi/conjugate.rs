//! Solves `(A + alpha^2 K) x = b`. Plain numbers use conjugate gradients with the diagonal as preconditioner (Hestenes
//! and Stiefel, 1952). Numbers with derivatives use Chebyshev iteration: it applies the same polynomial to every right
//! side, so derivatives converge with the values. Takes an initial guess; gives the number of iterations.

use super::rows::Rows;
use super::shared::Sums;
use crate::Real;
use crate::line::Threads;
use crate::mesh::MeshError;

/// The tolerance of the relative residual, in units of the rounding of one operation: 1e-12 in doubles.
const TOLERANCE: f64 = 1e-12 / (0.5 * f64::EPSILON);

/// The largest number of iterations.
const MOST: usize = 10_000;

/// The work vectors of the iteration.
#[derive(Clone, Debug)]
pub(super) struct Iteration<T> {
    residual: Vec<T>,
    direction: Vec<T>,
    image: Vec<T>,
    sums: Sums<T>,
}

impl<T: Real> Iteration<T> {
    pub fn new(sites: usize) -> Self {
        let zeros = vec![T::zero(); sites];
        Self {
            residual: zeros.clone(),
            direction: zeros.clone(),
            image: zeros,
            sums: Sums::new(sites),
        }
    }

    /// Sets the number of threads that share the loops of conjugate gradients.
    pub fn share(&mut self, threads: Threads) {
        self.sums.share(threads);
    }

    /// Solves from the initial guess in `x`; returns how many times the operator was applied.
    pub fn solve(
        &mut self,
        operator: &Rows<T>,
        right: &[T],
        x: &mut [T],
    ) -> Result<usize, MeshError> {
        if T::order() == 0 {
            self.conjugate(operator, right, x)
        } else {
            Ok(self.chebyshev(operator, right, x))
        }
    }

    fn conjugate(
        &mut self,
        operator: &Rows<T>,
        right: &[T],
        x: &mut [T],
    ) -> Result<usize, MeshError> {
        let tolerance = TOLERANCE * T::EPSILON;
        let size: f64 = right.iter().map(|b| (*b * *b).value()).sum();
        let bound = tolerance * tolerance * size;
        let Self {
            residual,
            direction,
            image,
            sums,
        } = self;
        let inverse = &operator.inverse;
        let [mut left, mut sum] = sums.over(residual, direction, |first, residual, direction| {
            let [mut left, mut sum] = [T::zero(); 2];
            for (k, (residual, direction)) in residual.iter_mut().zip(direction).enumerate() {
                let a = first + k;
                *residual = right[a] - operator.row(a, x);
                *direction = *residual * inverse[a];
                left += *residual * *residual;
                sum += *residual * *direction;
            }
            [left, sum]
        });
        for products in 1..=MOST {
            if left.value() <= bound {
                return Ok(products);
            }
            let [curvature, _] = sums.over(image, residual, |first, image, _| {
                let mut curvature = T::zero();
                for (k, image) in image.iter_mut().enumerate() {
                    *image = operator.row(first + k, direction);
                    curvature += *image * direction[first + k];
                }
                [curvature, T::zero()]
            });
            let length = sum / curvature;
            let before = sum;
            // Overwrites the image by the residual over the diagonal.
            [left, sum] = sums.over(residual, image, |first, residual, image| {
                let [mut left, mut sum] = [T::zero(); 2];
                for (k, (residual, image)) in residual.iter_mut().zip(image).enumerate() {
                    *residual -= length * *image;
                    *image = *residual * inverse[first + k];
                    left += *residual * *residual;
                    sum += *residual * *image;
                }
                [left, sum]
            });
            let share = sum / before;
            sums.over(x, direction, |first, x, direction| {
                for (k, (x, direction)) in x.iter_mut().zip(direction).enumerate() {
                    *x += length * *direction;
                    *direction = image[first + k] + share * *direction;
                }
                [T::zero(); 2]
            });
            if !left.is_finite() {
                break;
            }
        }
        Err(MeshError::NotConverged {
            iterations: MOST,
            residual: (left.value() / size).sqrt(),
            tolerance,
        })
    }

    /// Chebyshev iteration. The eigenvalues of the scaled operator lie between `least` and `2 - least` (Gershgorin),
    /// which determines the number of iterations. The whole iteration is repeated once for each order of derivatives.
    fn chebyshev(&mut self, operator: &Rows<T>, right: &[T], x: &mut [T]) -> usize {
        let shares = operator.areas.iter().zip(&operator.diagonal);
        let least = shares
            .map(|(area, diagonal)| (*area / *diagonal).value())
            .fold(1.0, f64::min);
        let width = (1.0 - least).max(1e-3);
        let rate = width / (1.0 + (1.0 - width * width).sqrt());
        let cycle = ((TOLERANCE * T::EPSILON * 1e-3).ln() / rate.ln()).ceil() as usize;
        for _ in 0..=T::order() {
            self.direction.fill(T::zero());
            // The weight in the three-term recurrence.
            let mut weight = 0.0;
            for k in 0..cycle {
                weight = match k {
                    0 => 1.0,
                    1 => 1.0 / (1.0 - width * width / 2.0),
                    _ => 1.0 / (1.0 - width * width * weight / 4.0),
                };
                let (fresh, kept) = (T::from_f64(weight), T::from_f64(weight - 1.0));
                for (a, residual) in self.residual.iter_mut().enumerate() {
                    *residual = (right[a] - operator.row(a, x)) * operator.inverse[a];
                }
                for (a, x) in x.iter_mut().enumerate() {
                    let step = fresh * self.residual[a] + kept * self.direction[a];
                    self.direction[a] = step;
                    *x += step;
                }
            }
        }
        cycle * (T::order() as usize + 1)
    }
}
