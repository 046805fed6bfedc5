//! Checks that a step stays in the domain of every function of the model, and keeps linear maps invertible. Takes
//! values at both ends of a step; gives an error that names the domain, and the time at which the motion left it.

mod segment;

use crate::groups::{Additive, Group, Linear};
use crate::linalg::{Dense, determinant, singular_ratio, singular_ratio_of};
use crate::number_format::Plain;
use crate::scalar::Real;
use crate::solvers::largest_step::search_of;
use core::fmt;
use nalgebra::SMatrix;

/// The smallest ratio of singular values at which a map still counts as invertible: below it, the inverse would have
/// at most four correct digits.
pub const LEAST_RATIO: f64 = 1e-12;

/// If the squared entries of `V - 1` add up to less than this, every real eigenvalue of the velocity
/// `V` is positive. An eigenvalue of zero needs a sum of at least one.
const NEAR: f64 = 0.98;

/// Why a step left the domain of its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Met {
    /// A linear map becomes singular: the straight line from one node to the next meets `det = 0`.
    Singular {
        /// The configuration.
        configuration: &'static str,
    },
    /// A linear map is singular to working precision at the end of the step.
    NearlySingular {
        /// The configuration.
        configuration: &'static str,
        /// Its smallest over its largest singular value.
        ratio: f64,
    },
    /// The argument of a function leaves its domain.
    Outside {
        /// The function and its argument.
        call: &'static Call,
        /// The argument at the start of the step; for an edge, the argument at rest.
        before: f64,
        /// The argument at the end of the step; for an edge, the argument at the velocity of the step.
        after: f64,
    },
}

/// A step that left the domain of its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Why the step left the domain.
    pub met: Met,
    /// The time of contact as a fraction of the step, from 0 to 1: where the straight line between the nodes meets
    /// `det = 0`, or where the interpolated argument meets its bound. `None` if the velocity itself is outside.
    pub share: Option<f64>,
    /// The size of the failed step.
    pub h: f64,
    /// How often the step was halved before a trial succeeded; 0 if none succeeded.
    pub halvings: u16,
    /// The lane; 0 for types without lanes.
    pub lane: u8,
}

impl Contact {
    /// Whether an argument left its domain between finite values. If so, this explains numbers after the step that
    /// are not finite. If the step overflows instead, the time of contact is meaningless.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self.met {
            // If the end of the step overflows, the fraction is `None`, not finite or zero.
            Met::Singular { .. } => self.share.is_some_and(|s| s.is_finite() && s > 0.0),
            Met::NearlySingular { .. } => false,
            Met::Outside { before, after, .. } => before.is_finite() && after.is_finite(),
        }
    }

    fn new<T: Real>(met: Met, share: Option<f64>, h: T, lane: usize) -> Self {
        Self {
            met,
            share,
            h: h.lane(lane),
            halvings: 0,
            lane: u8::try_from(lane).unwrap_or(u8::MAX),
        }
    }

    /// The time from the node before the step to the contact.
    #[must_use]
    pub fn after_node(&self) -> Option<f64> {
        self.share.map(|s| s * self.h)
    }

    /// A smaller step size for which a trial from the same state succeeded, if there is one.
    #[must_use]
    pub fn works(&self) -> Option<f64> {
        (self.halvings > 0).then(|| self.h * 0.5_f64.powi(i32::from(self.halvings)))
    }

    /// This contact, with a smaller step size for which `try_step` succeeds, if halving finds one.
    #[cold]
    #[must_use]
    pub fn with_trials<T: Real>(self, h: T, try_step: impl Fn(T) -> bool) -> Self {
        // Step sizes more than a thousand times the distance to the contact are not tried.
        let far = self.share.map_or(0.0, |share| -(1e3 * share).log2());
        let first = if (1.0..1000.0).contains(&far) {
            far as u16
        } else {
            1
        };
        // A trial that leaves the domain does not search for a step size itself.
        let found = search_of(|| {
            (first..first + 20).find(|k| try_step(h * T::from_f64(0.5_f64.powi(i32::from(*k)))))
        });
        Self {
            halvings: found.flatten().unwrap_or(0),
            ..self
        }
    }
}

impl fmt::Display for Contact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.lane > 0 {
            write!(f, "lane {}: ", self.lane)?;
        }
        match self.met {
            Met::Singular { configuration } => write!(
                f,
                "`{configuration}` becomes singular: its determinant reaches 0"
            )?,
            Met::NearlySingular {
                configuration,
                ratio,
            } => write!(
                f,
                "`{configuration}` becomes singular: its smallest singular value is {ratio:.1e} of its largest, needed \
                 {LEAST_RATIO:e}"
            )?,
            Met::Outside { call, before, .. } if self.share == Some(0.0) => {
                return write!(
                    f,
                    "`{}` is {before} at this node, outside the domain of {}: change the state or the parameters",
                    call.argument, call.function
                );
            }
            Met::Outside {
                call,
                before,
                after,
            } => write!(
                f,
                "`{}` leaves the domain of {}: it changes from {before} to {after}",
                call.argument, call.function
            )?,
        }
        if let Some(after) = self.after_node() {
            write!(
                f,
                ", at time {} after the start of a step of {}",
                Plain(after),
                Plain(self.h)
            )?;
        }
        match self.works() {
            Some(works) => write!(f, "; a step of {} from this state succeeds", Plain(works)),
            None => write!(
                f,
                "; start where the motion stays inside the domain, or add a potential that keeps it there"
            ),
        }
    }
}

impl std::error::Error for Contact {}

/// Whether a linear map stays invertible from one node to the next: the straight line between them does not meet
/// `det = 0`, not even twice, and the end is far enough from it.
///
/// # Errors
/// [`Contact`] of the first lane that does not.
#[inline]
pub fn invertible<T: Real, const N: usize>(
    configuration: &'static str,
    before: &Linear<N, T>,
    after: &Linear<N, T>,
    h: T,
) -> Result<(), Contact> {
    let end = after.matrix();
    let squares = |a: &SMatrix<T, N, N>| a.iter().fold(T::zero(), |sum, x| sum + *x * *x);
    // |det A| <= s_min |A|^(n-1), hence the ratio of singular values is at least |det A| / |A|^n.
    let (det, size) = (determinant(&end), squares(&end));
    let exponent = i32::try_from(N).unwrap_or(i32::MAX);
    let least = T::from_f64(LEAST_RATIO * LEAST_RATIO) * size.powi(exponent);
    let margin = det * det - least;
    // If |Q'^-1 (Q' - Q)| is below one, every real eigenvalue of the velocity is positive. The cofactors
    // of Q' together are at most N^(1/2) (|Q'|^2 / (N - 1))^((N - 1)/2).
    let (moved, others) = (squares(&(end - before.matrix())), (N - 1) as f64);
    let cofactors = (size * T::from_f64(1.0 / others)).powi(exponent - 1) * T::from_f64(N as f64);
    let near = det * det * T::from_f64(NEAR) - moved * cofactors;
    if near.exceeds(T::zero()) && margin.exceeds(T::zero()) {
        return Ok(());
    }
    let v = before.body_velocity(after).matrix();
    let away = v - SMatrix::identity();
    if squares(&away).is_below(NEAR) && margin.exceeds(T::zero()) {
        return Ok(());
    }
    let lane_of = |lane: usize| {
        let of = move |a: &SMatrix<T, N, N>| a.map(|x| x.lane(lane));
        let share = segment::contact(&of(&v));
        (share, move || singular_ratio(&of(&end)))
    };
    closely(configuration, h, T::LANES, lane_of)
}

/// Like `invertible`, for maps whose size is known only at run time, given by their matrices.
///
/// # Errors
/// [`Contact`] of the first lane that does not.
pub fn invertible_of<T: Real>(
    configuration: &'static str,
    before: &Dense<T>,
    after: &Dense<T>,
    h: T,
) -> Result<(), Contact> {
    let n = after.rows;
    let (det, size) = (after.determinant(), after.squares());
    let exponent = i32::try_from(n).unwrap_or(i32::MAX);
    let least = T::from_f64(LEAST_RATIO * LEAST_RATIO) * size.powi(exponent);
    let margin = det * det - least;
    let (moved, others) = (after.minus(before).squares(), (n - 1) as f64);
    let cofactors = (size * T::from_f64(1.0 / others)).powi(exponent - 1) * T::from_f64(n as f64);
    let near = det * det * T::from_f64(NEAR) - moved * cofactors;
    if near.exceeds(T::zero()) && margin.exceeds(T::zero()) {
        return Ok(());
    }
    let back = before.small_inverse();
    let v = back.unwrap_or_else(|| Dense::unknown(n, n)).times(after);
    if v.minus_one().squares().is_below(NEAR) && margin.exceeds(T::zero()) {
        return Ok(());
    }
    let lane_of = |lane: usize| {
        let of = move |a: &Dense<T>| Dense {
            rows: a.rows,
            cols: a.cols,
            data: a.data.iter().map(|x| x.lane(lane)).collect::<Vec<f64>>(),
        };
        let share = segment::contact_of(&of(&v));
        (share, move || singular_ratio_of(of(after).columns()))
    };
    closely(configuration, h, T::LANES, lane_of)
}

/// Like `invertible`, for a field of square matrices of which the model takes the inverse or the
/// logarithm of the determinant.
///
/// # Errors
/// [`Contact`] of the first lane that does not.
#[inline]
pub fn field_invertible<T: Real, const N: usize>(
    field: &'static str,
    before: &Additive<N, N, T>,
    after: &Additive<N, N, T>,
    h: T,
) -> Result<(), Contact> {
    let linear = |a: &Additive<N, N, T>| Linear::stepped(a.matrix());
    invertible(field, &linear(before), &linear(after), h)
}

/// Tests each lane by the eigenvalues of the velocity and the singular values of the matrix at the end of the step.
#[cold]
#[inline(never)]
fn closely<T: Real, R: Fn() -> f64>(
    configuration: &'static str,
    h: T,
    lanes: usize,
    lane_of: impl Fn(usize) -> (Option<f64>, R),
) -> Result<(), Contact> {
    for lane in 0..lanes {
        let (share, ratio) = lane_of(lane);
        if let Some(share) = share {
            let met = Met::Singular { configuration };
            return Err(Contact::new(met, Some(share), h, lane));
        }
        let ratio = ratio();
        // This also rejects NaN.
        let enough = ratio >= LEAST_RATIO;
        if !enough {
            let met = Met::NearlySingular {
                configuration,
                ratio,
            };
            return Err(Contact::new(met, Some(1.0), h, lane));
        }
    }
    Ok(())
}

/// A function with a restricted domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Function {
    /// A logarithm.
    Log,
    /// A square root.
    Sqrt,
    /// Another power.
    Power,
    /// A quotient.
    Quotient,
    /// The inverse of a matrix; its argument is the determinant.
    Inverse,
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Log => "log",
            Self::Sqrt => "sqrt",
            Self::Power => "a power",
            Self::Quotient => "a quotient",
            Self::Inverse => "an inverse",
        })
    }
}

/// A function and its argument, as the model writes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// The function.
    pub function: Function,
    /// Its argument.
    pub argument: &'static str,
}

/// The condition on the argument of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Domain {
    /// A logarithm, a root below a quotient: positive.
    Positive,
    /// A root: zero or positive.
    NotNegative,
    /// A quotient, an inverse: not zero, and not through zero from one node to the next.
    NotZero,
}

/// Whether a number is positive in all lanes, or negative in all.
fn has_one_sign<T: Real>(x: T) -> bool {
    x.exceeds(T::zero()) || (-x).exceeds(T::zero())
}

impl Domain {
    fn holds(self, x: f64) -> bool {
        match self {
            Self::Positive => x > 0.0 && x.is_finite(),
            Self::NotNegative => x >= 0.0 && x.is_finite(),
            Self::NotZero => x != 0.0 && x.is_finite(),
        }
    }

    /// The condition as a sentence.
    #[must_use]
    pub fn needs(self) -> &'static str {
        match self {
            Self::Positive => "positive",
            Self::NotNegative => "zero or positive",
            Self::NotZero => "different from zero",
        }
    }

    /// Whether all lanes of a number are inside.
    pub fn admits<T: Real>(self, x: T) -> bool {
        let inside = match self {
            Self::Positive => x.exceeds(T::zero()),
            Self::NotNegative => (-x).nowhere_positive(),
            Self::NotZero => has_one_sign(x),
        };
        inside && x.is_finite() || (0..T::LANES).all(|lane| self.holds(x.lane(lane)))
    }

    /// Whether an argument is inside at both nodes of a step, and between them.
    ///
    /// # Errors
    /// [`Contact`] of the first lane where it is not.
    #[inline]
    pub fn at_nodes<T: Real>(
        self,
        call: &'static Call,
        before: T,
        after: T,
        h: T,
    ) -> Result<(), Contact> {
        let zero = T::zero();
        let stays = || {
            before.exceeds(zero) && after.exceeds(zero)
                || (-before).exceeds(zero) && (-after).exceeds(zero)
        };
        if self.admits(before) && self.admits(after) && (self != Self::NotZero || stays()) {
            return Ok(());
        }
        for lane in 0..T::LANES {
            let (from, to) = (before.lane(lane), after.lane(lane));
            let crossed = self == Self::NotZero && (from < 0.0) != (to < 0.0);
            if self.holds(from) && self.holds(to) && !crossed {
                continue;
            }
            let share = match self.holds(from) {
                true => (from / (from - to)).clamp(0.0, 1.0),
                false => 0.0,
            };
            let met = Met::Outside {
                call,
                before: from,
                after: to,
            };
            let share = (!share.is_nan()).then_some(share);
            return Err(Contact::new(met, share, h, lane));
        }
        Ok(())
    }

    /// Whether an argument is inside its domain at the velocity of a step; `rest` is its value at rest, and the
    /// argument must not have crossed zero since.
    ///
    /// # Errors
    /// [`Contact`] of the first lane where it is not.
    #[inline]
    pub fn on_edge<T: Real>(
        self,
        call: &'static Call,
        rest: T,
        moving: T,
        h: T,
    ) -> Result<(), Contact> {
        let stays = || (-(rest * moving)).nowhere_positive();
        if self.admits(moving) && (self != Self::NotZero || stays()) {
            return Ok(());
        }
        for lane in 0..T::LANES {
            let (from, to) = (rest.lane(lane), moving.lane(lane));
            let crossed = self == Self::NotZero && from * to < 0.0;
            if self.holds(to) && !crossed {
                continue;
            }
            let met = Met::Outside {
                call,
                before: from,
                after: to,
            };
            return Err(Contact::new(met, None, h, lane));
        }
        Ok(())
    }
}
