//! The error of a step that is too long for the Moser-Veselov equation. Takes the failed momentum;
//! gives its ratio to the bound, and the step size that would succeed.

use super::forced::turn;
use super::preprocess::preprocessed;
use super::{Order, Poinsot, largest_step, reach};
use crate::Real;
use crate::number_format::{Short, Times, in_lane, not_finite, shorter};
use crate::solvers::Method;
use core::fmt;
use nalgebra::Vector3;

/// The step is too long for the Moser-Veselov equation to have a principal solution: the body would
/// turn too far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoserVeselovError {
    /// The scaled momentum over its exact bound, in the worst lane. Above 1 the principal solution does
    /// not exist. NaN if the momentum is not finite.
    pub ratio: f64,
    /// The step size that failed, if the caller knows it.
    pub h: Option<f64>,
    /// The largest step size that succeeds from the same state, if it is known; for a free body it is
    /// `h / ratio`.
    pub largest_step: Option<f64>,
    /// Index (0, 1, 2) of the momentum component of largest `|h N_i| / I_ii`.
    pub component: usize,
    /// `|h N_i| / I_ii` of that component; at most one for a rotation about that axis alone. `I_ii` is the moment of
    /// inertia of a body, or the stiffness of a rod stepped along its length.
    pub share: f64,
    /// The order of the step. Above two, the ratio belongs to the modified moments, and is infinite if
    /// these are not positive.
    pub order: Order,
    /// The solver, `kappa` unless you selected another.
    pub solver: Method,
    /// The lane of these numbers: the worst lane, or the lane of the smallest step if steps were
    /// searched. 0 for types without lanes.
    pub lane: u32,
}

/// The suggested step size is inside the bound by this relative margin: at the bound itself the
/// quartic has a double root, which rounding may remove.
const INSIDE: f64 = 1.0 - 1e-12;

impl MoserVeselovError {
    /// Diagnoses the failed `h N`, over all lanes.
    #[cold]
    #[inline(never)]
    pub(super) fn diagnose<T: Real>(body: &Poinsot<T>, h_n: &Vector3<T>) -> Self {
        let mut worst = Self {
            ratio: 0.0,
            h: None,
            largest_step: None,
            component: 0,
            share: 0.0,
            order: Order::Two,
            solver: Method::Kappa,
            lane: 0,
        };
        for lane in 0..T::LANES {
            let (body, n) = (body.lane(lane), h_n.map(|x| x.lane(lane)));
            let ratio = reach(&body, &n);
            if ratio.is_nan() || ratio > worst.ratio {
                worst.ratio = ratio;
                worst.component = fastest(body.moments, &n);
                worst.share = share(&body, &n, worst.component);
                worst.lane = index(lane);
            }
            if ratio.is_nan() {
                break;
            }
        }
        worst
    }

    /// Diagnoses a failed trajectory of a higher order, from `h mu` at its start: the modified
    /// moments depend on the step, so the largest step is searched.
    #[cold]
    #[inline(never)]
    pub(super) fn diagnose_order<T: Real>(
        body: &Poinsot<T>,
        h_mu: &Vector3<T>,
        h: T,
        order: Order,
    ) -> Self {
        let mut told: Option<Self> = None;
        for lane in 0..T::LANES {
            let (body, n, h) = (body.lane(lane), h_mu.map(|x| x.lane(lane)), h.lane(lane));
            let solved = |modified: &Poinsot<f64>, scale: f64| {
                turn(modified, modified.scaled(&(n * scale))).map(|_| 0.0)
            };
            let largest = INSIDE
                * largest_step(h, |trial| {
                    let scale = trial / h;
                    let u = body.scaled(&(n * scale));
                    solved(&preprocessed(&body, u, order)?, scale)
                });
            let ratio = match preprocessed(&body, body.scaled(&n), order) {
                _ if !n.iter().all(|x| x.is_finite()) => f64::NAN,
                Some(modified) => largest_step(1.0, |scale| solved(&modified, scale)).recip(),
                None => f64::INFINITY,
            };
            if told
                .and_then(|e| e.largest_step)
                .is_none_or(|smallest| largest < smallest)
            {
                let component = fastest(body.moments, &n);
                told = Some(Self {
                    ratio,
                    h: Some(h),
                    largest_step: Some(largest),
                    component,
                    share: share(&body, &n, component),
                    order,
                    solver: Method::Kappa,
                    lane: index(lane),
                });
            }
        }
        told.unwrap_or_else(|| Self::diagnose(body, h_mu))
    }

    /// The failure of another solver.
    #[cold]
    #[inline(never)]
    pub(super) fn of_solver<T: Real>(method: Method, body: &Poinsot<T>, h_n: &Vector3<T>) -> Self {
        Self {
            solver: method,
            ..Self::diagnose(body, h_n)
        }
    }

    /// This error with the failed step size, and the largest step size that succeeds.
    #[cold]
    #[must_use]
    pub fn with_steps(self, h: f64, largest_step: f64) -> Self {
        Self {
            h: Some(h),
            largest_step: Some(largest_step),
            ..self
        }
    }

    /// This error for a momentum that does not depend on the step size: the bound is linear in the step size.
    #[cold]
    #[must_use]
    pub fn with_linear_step<T: Real>(self, h: T) -> Self {
        let h = h.lane(self.lane as usize);
        self.with_steps(h, h / self.ratio * INSIDE)
    }

    /// This error for an edge momentum that depends on the step size: searches the largest step size of
    /// every lane, and reports the smallest of these.
    #[cold]
    #[must_use]
    pub fn with_searched_step<T: Real>(
        self,
        body: &Poinsot<T>,
        h: T,
        edge_momentum: impl Fn(T) -> Vector3<T>,
    ) -> Self {
        let mut told = self;
        for lane in 0..T::LANES {
            let (own_body, own_h) = (body.lane(lane), h.lane(lane));
            let largest = largest_step(own_h, |trial| {
                let n = edge_momentum(T::from_f64(trial)) * T::from_f64(trial);
                Some(reach(&own_body, &n.map(|x| x.lane(lane))))
            });
            // NaN in a later lane is ignored: the comparison is false.
            if told.largest_step.is_none_or(|smallest| largest < smallest) {
                told = Self {
                    lane: index(lane),
                    ..told.with_steps(own_h, largest)
                };
            }
        }
        told
    }
}

/// The index of a lane as a small number.
pub(in crate::solvers) fn index(lane: usize) -> u32 {
    u32::try_from(lane).unwrap_or(u32::MAX)
}

/// The index of the largest `|h N_i| / I_ii`.
pub(in crate::solvers) fn fastest(moments: [f64; 3], h_n: &Vector3<f64>) -> usize {
    let (mut largest, mut component) = (-1.0, 0);
    for (i, (x, moment)) in h_n.iter().zip(moments).enumerate() {
        let angle = (x / moment).abs();
        if angle > largest || angle.is_nan() {
            (largest, component) = (angle, i);
        }
    }
    component
}

/// `|h N_i| / I_ii`.
fn share(body: &Poinsot<f64>, h_n: &Vector3<f64>, i: usize) -> f64 {
    (h_n[i] / body.unit / body.moments[i]).abs()
}

impl fmt::Display for MoserVeselovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.ratio.is_nan() {
            return not_finite(f, self.component, self.h.zip(self.largest_step));
        }
        in_lane(f, self.lane)?;
        if self.solver != Method::Kappa && self.ratio <= 1.0 {
            return write!(
                f,
                "solver {} found no solution although the momentum is only {:.6} of its bound, or does not support this \
                 scalar; use kappa",
                self.solver, self.ratio
            );
        }
        if self.ratio.is_infinite() {
            write!(
                f,
                "the body rotates too far in one step for order {}: its modified moments are no longer positive",
                self.order
            )?;
        } else {
            write!(
                f,
                "step too large: the momentum exceeds the solvability bound of the Moser-Veselov \
                 equation by a factor {} (component {} is the largest",
                Times(self.ratio),
                self.component + 1
            )?;
            let i = self.component + 1;
            write!(f, ": |h N_{i}| = {} I_{i}{i})", Short(self.share))?;
            if self.order != Order::Two {
                write!(f, ", with the moments of order {}", self.order)?;
            }
        }
        shorter(f, self.h.zip(self.largest_step))
    }
}

impl std::error::Error for MoserVeselovError {}
