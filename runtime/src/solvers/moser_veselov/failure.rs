//! The error of a step that is too long for the Moser-Veselov equation.
//! Takes the refused momentum; gives how far beyond the bound it is and what step would do.

use super::{Poinsot, largest_step, reach};
use crate::Real;
use core::fmt;
use nalgebra::Vector3;

/// The Moser-Veselov equation has no principal solution: the body would turn too far in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoserVeselovError {
    /// The scaled momentum over its exact bound: above 1 there is no solution. Of several lanes,
    /// the worst. NaN when the momentum is not finite.
    pub ratio: f64,
    /// The step size refused, where the caller knows it.
    pub h: Option<f64>,
    /// The largest step size that can be solved from the same state, where it is known; a free
    /// body's is `h / ratio`.
    pub largest_step: Option<f64>,
    /// Index (0, 1, 2) of the momentum component of largest `|h N_i| / I_ii`.
    pub component: usize,
    /// The lane all this is about: the worst, or that of the smallest step where it was searched.
    /// 0 for types without lanes.
    pub lane: usize,
}

/// The step offered is this little inside the bound: at the bound itself the quartic has a double
/// root, which rounding may remove.
const INSIDE: f64 = 1.0 - 1e-12;

impl MoserVeselovError {
    /// Diagnoses the refused `h N`; every lane is looked at.
    #[cold]
    #[inline(never)]
    pub(super) fn diagnose<T: Real>(body: &Poinsot<T>, h_n: &Vector3<T>) -> Self {
        let mut worst = Self {
            ratio: 0.0,
            h: None,
            largest_step: None,
            component: 0,
            lane: 0,
        };
        for lane in 0..T::LANES {
            let n = h_n.map(|x| x.lane(lane));
            let inertia = body.inertia();
            let mut largest = -1.0;
            let mut component = 0;
            for (i, x) in n.iter().enumerate() {
                let moment = inertia.get((i, i)).map_or(1.0, |x| x.lane(lane));
                let angle = (x / moment).abs();
                if angle > largest || angle.is_nan() {
                    largest = angle;
                    component = i;
                }
            }
            let ratio = reach(&body.lane(lane), &n);
            if ratio.is_nan() || ratio > worst.ratio {
                worst.ratio = ratio;
                worst.component = component;
                worst.lane = lane;
            }
            if ratio.is_nan() {
                break;
            }
        }
        worst
    }

    /// The same error with the step size that was refused, and the largest that would do.
    #[cold]
    #[must_use]
    pub fn with_steps(self, h: f64, largest_step: f64) -> Self {
        Self {
            h: Some(h),
            largest_step: Some(largest_step),
            ..self
        }
    }

    /// The same error for a momentum that does not depend on the step: the bound is linear in it.
    #[cold]
    #[must_use]
    pub fn with_linear_step<T: Real>(self, h: T) -> Self {
        let h = h.lane(self.lane);
        self.with_steps(h, h / self.ratio * INSIDE)
    }

    /// The same error for an edge momentum that depends on the step: the largest step is searched,
    /// lane by lane, and the smallest of them told.
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
            // NaN, which an infinite momentum gives, is told only if nothing else is.
            if told.largest_step.is_none_or(|smallest| largest < smallest) {
                told = Self {
                    lane,
                    ..told.with_steps(own_h, largest)
                };
            }
        }
        told
    }
}

impl fmt::Display for MoserVeselovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.ratio.is_nan() {
            return write!(
                f,
                "the momentum is NaN or infinite (component {})",
                self.component
            );
        }
        if self.lane > 0 {
            write!(f, "lane {}: ", self.lane)?;
        }
        write!(
            f,
            "the body turns too far in one step: the momentum is {:.6} times what the \
             Moser-Veselov equation can take (component {} is the largest)",
            self.ratio, self.component
        )?;
        match (self.h, self.largest_step) {
            (Some(h), Some(largest)) => {
                write!(
                    f,
                    "; reduce the step size from {h} to at most {largest:.6e}"
                )
            }
            _ => write!(f, "; reduce the step size"),
        }
    }
}

impl std::error::Error for MoserVeselovError {}
