//! The error of a step that is too long for the equation in unit quaternions. Takes the failed momentum; gives its
//! ratio to the bound, and the step size that would succeed.

use super::QuaternionBody;
use super::branch::followed;
use crate::Real;
use crate::number_format::{Times, in_lane, not_finite, shorter};
use crate::solvers::moser_veselov::{fastest, index, largest_step};
use core::fmt;
use nalgebra::Vector3;

/// The step is too long for the equation to have a principal solution: the body would rotate too far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuaternionError {
    /// The scaled momentum over its bound, along its direction, in the worst lane. Above 1 the
    /// principal solution does not exist. NaN if the momentum is not finite.
    pub ratio: f64,
    /// The step size that failed, if the caller knows it.
    pub h: Option<f64>,
    /// The largest step size that succeeds from the same state, if it is known.
    pub largest_step: Option<f64>,
    /// Index (0, 1, 2) of the momentum component of largest `|h N_i| / I_ii`.
    pub component: usize,
    /// The lane of these numbers. 0 for types without lanes.
    pub lane: u32,
}

/// The relative margin between the suggested step size and the bound, at which the root is double.
const INSIDE: f64 = 1.0 - 1e-10;

impl QuaternionError {
    /// Diagnoses the failed `h N`, over all lanes.
    #[cold]
    #[inline(never)]
    pub(super) fn diagnose<T: Real>(body: &QuaternionBody<T>, h_n: &Vector3<T>) -> Self {
        let mut worst = Self {
            ratio: 0.0,
            h: None,
            largest_step: None,
            component: 0,
            lane: 0,
        };
        for lane in 0..T::LANES {
            let (body, n) = (body.lane(lane), h_n.map(|x| x.lane(lane)));
            let ratio = reach(&body, &n);
            if ratio.is_nan() || ratio > worst.ratio {
                worst.ratio = ratio;
                worst.component = fastest(body.moments, &n);
                worst.lane = index(lane);
            }
            if ratio.is_nan() {
                break;
            }
        }
        worst
    }

    /// This error with the failed step size, and the largest step size for which all equations, solved
    /// together, succeed: `ratio` of a trial step is then at most 1.
    #[cold]
    #[must_use]
    pub fn with_searched_steps(self, h: f64, ratio: impl Fn(f64) -> Option<f64>) -> Self {
        Self {
            h: Some(h),
            largest_step: Some(largest_step(h, ratio)),
            ..self
        }
    }

    /// This error with the failed step size and the largest step size that succeeds, the smallest over the
    /// lanes; `edge_momentum` is `N` for a trial step.
    #[cold]
    #[must_use]
    pub fn with_searched_step<T: Real>(
        self,
        body: &QuaternionBody<T>,
        h: T,
        edge_momentum: impl Fn(T) -> Vector3<T>,
    ) -> Self {
        let mut told = self;
        for lane in 0..T::LANES {
            let (body, h) = (body.lane(lane), h.lane(lane));
            let at = |trial: f64| edge_momentum(T::from_f64(trial)).map(|x| x.lane(lane));
            let solved = |trial: f64| reach(&body, &(at(trial) * trial)) < 1.0;
            let ratio = reach(&body, &(at(h) * h));
            let largest = if at(h) == at(0.5 * h) && ratio.is_finite() {
                // A momentum that does not depend on the step: the bound is linear in it.
                h / ratio.max(1.0)
            } else {
                largest_step(h, |trial| Some(if solved(trial) { 0.0 } else { 2.0 }))
            };
            let largest = largest * INSIDE;
            // NaN in a later lane is ignored: the comparison is false.
            if told.largest_step.is_none_or(|smallest| largest < smallest) {
                told = Self {
                    h: Some(h),
                    largest_step: Some(largest),
                    lane: index(lane),
                    ..told
                };
            }
        }
        told
    }
}

/// The ratio of `h N` to its bound; 0 if a solution exists, NaN if `h N` is not finite.
fn reach(body: &QuaternionBody<f64>, h_n: &Vector3<f64>) -> f64 {
    let [[x, y, z]] = h_n.data.0;
    let s = body.half_over_unit;
    match followed(body, [x * s, y * s, z * s]) {
        Ok(_) => 0.0,
        Err(part) => part.recip(),
    }
}

impl fmt::Display for QuaternionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.ratio.is_nan() {
            return not_finite(f, self.component, self.h.zip(self.largest_step));
        }
        in_lane(f, self.lane)?;
        write!(
            f,
            "step too large: the momentum exceeds the solvability bound of the equation in unit \
             quaternions by a factor {} (component {} is the largest)",
            Times(self.ratio),
            self.component + 1
        )?;
        shorter(f, self.h.zip(self.largest_step))
    }
}

impl std::error::Error for QuaternionError {}
