//! Steps of high order, composed of several symmetric steps of order two. Takes a model shown to be
//! reversible, a state, a step size and an order; advances the state.
//!
//! Each factor is a step of the model itself, so a composition conserves everything that a step conserves: the
//! symplectic form of the full phase space, momentum maps, Casimirs. With a one-sided node rule the order would
//! silently fall to one; such a model is not [`Reversible`], and its composition does not compile.

use super::{Reversible, Stepper};
use crate::solvers::largest_step::{confirmed_step, largest_step};
use crate::solvers::left_factor::Unsolved;
use crate::solvers::moser_veselov::MoserVeselovError;
use crate::solvers::newton::NewtonError;
use crate::solvers::unit_quaternions::QuaternionError;
use crate::{Real, StartError, StepCause, StepError};
use core::fmt;

/// The order of a composition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum CompositionOrder {
    /// Five steps (Suzuki, Phys. Lett. A 146 (1990) 319).
    Four,
    /// Nine steps (Kahan and Li, Math. Comp. 66 (1997) 1089).
    Six,
    /// Seventeen steps (Kahan and Li).
    Eight,
}

/// The first half of the factors of order six, and the middle factor.
const SIX: [f64; 5] = [
    0.392_161_444_007_314_1,
    0.332_599_136_789_359_43,
    -0.706_246_172_557_639_3,
    0.082_213_596_293_550_8,
    0.798_543_990_934_83,
];

/// The first half of the factors of order eight, and the middle factor.
const EIGHT: [f64; 9] = [
    0.130_202_483_088_890_07,
    0.561_162_981_775_108_4,
    -0.389_474_962_644_847_27,
    0.158_841_906_555_155_6,
    -0.395_903_894_133_237_57,
    0.184_539_640_978_315_7,
    0.258_374_387_686_322_04,
    0.295_011_723_609_310_3,
    -0.605_508_533_830_034_6,
];

impl CompositionOrder {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Four, Self::Six, Self::Eight];

    /// As a number.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Four => 4,
            Self::Six => 6,
            Self::Eight => 8,
        }
    }

    /// The order with this number, if there is one.
    #[must_use]
    pub fn of_number(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|o| o.number() == number)
    }

    /// The distinct factors of the step: a palindrome whose middle is the last element.
    fn half(self) -> Vec<f64> {
        match self {
            Self::Four => {
                let outer = 1.0 / (4.0 - 4.0_f64.cbrt());
                vec![outer, outer, 1.0 - 4.0 * outer]
            }
            Self::Six => SIX.to_vec(),
            Self::Eight => EIGHT.to_vec(),
        }
    }

    /// The factors of the step; they add up to one.
    #[must_use]
    pub fn factors(self) -> Vec<f64> {
        let mut factors = self.half();
        let mirrored: Vec<f64> = factors.iter().rev().skip(1).copied().collect();
        factors.extend(mirrored);
        factors
    }
}

impl fmt::Display for CompositionOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number())
    }
}

/// One factor of the step, and the workspace of the substeps with this factor.
#[derive(Clone, Debug)]
struct Stage<W> {
    factor: f64,
    workspace: W,
}

/// A trajectory of a model, in composed steps.
#[derive(Clone, Debug)]
pub struct Composition<S: Stepper> {
    stages: Vec<Stage<S::Workspace>>,
    h: S::Scalar,
}

impl<S: Reversible> Composition<S> {
    /// Prepares composed steps of size `h` from `state`. Nothing is allocated later.
    ///
    /// # Errors
    /// If one of its stages fails from `state`.
    pub fn start(
        model: &S,
        state: &S::State,
        h: S::Scalar,
        order: CompositionOrder,
    ) -> Result<Self, StartError> {
        let factors = order.factors();
        let stages = factors.iter().map(|&factor| {
            let workspace = model
                .workspace(state, h * S::Scalar::from_f64(factor))
                .map_err(|e| match e {
                    StartError::Refused(cause) => {
                        let share = feasible(model, state, h, &factors, &cause);
                        StartError::Refused(in_all(cause, h, share))
                    }
                    other => other,
                })?;
            Ok(Stage { factor, workspace })
        });
        Ok(Self {
            stages: stages.collect::<Result<_, StartError>>()?,
            h,
        })
    }
}

impl<S: Stepper> Composition<S> {
    /// The workspaces of the stages, in their order.
    pub fn workspaces_mut(&mut self) -> impl Iterator<Item = &mut S::Workspace> {
        self.stages.iter_mut().map(|stage| &mut stage.workspace)
    }

    /// One composed step, in place; it counts as one node.
    ///
    /// # Errors
    /// When one of its steps cannot be solved, with the numbers of the composed step; the state is
    /// then unchanged.
    #[inline]
    pub fn step(&mut self, model: &S, state: &mut S::State) -> Result<(), StepError> {
        self.step_in_parts(model, state, |_, _| {})
    }

    /// One composed step that calls `seen` after each stage, with its factor and the state.
    ///
    /// # Errors
    /// As [`Composition::step`].
    #[inline]
    pub fn step_in_parts(
        &mut self,
        model: &S,
        state: &mut S::State,
        mut seen: impl FnMut(f64, &S::State),
    ) -> Result<(), StepError> {
        let node = S::node(state);
        let mut moving = *state;
        for stage in &mut self.stages {
            if let Err(e) = model.advance(&mut moving, &mut stage.workspace) {
                let factors: Vec<f64> = self.stages.iter().map(|stage| stage.factor).collect();
                let share = feasible(model, state, self.h, &factors, &e.cause);
                return Err(in_all(e.cause, self.h, share).at_node(node));
            }
            seen(stage.factor, &moving);
        }
        *state = S::at_node(moving, node + 1);
        Ok(())
    }
}

/// The largest share of the step size `h` for which a step from this state succeeds, by bisection. A shorter step
/// passes through other states, so the limit of the failed stage does not determine it.
#[cold]
#[inline(never)]
fn feasible<S: Stepper>(
    model: &S,
    state: &S::State,
    h: S::Scalar,
    factors: &[f64],
    refused: &StepCause,
) -> f64 {
    let part = |share: f64| move |factor: &f64| h * S::Scalar::from_f64(share * factor);
    let tried = |share| {
        let parts = factors.iter().map(part(share));
        composed(state, parts, |from, h| model.attempt(from, h))
    };
    let made = |share| {
        let parts = factors.iter().map(part(share));
        composed(state, parts, |from, h| {
            let (mut moving, mut workspace) = (*from, model.workspace(from, h).ok()?);
            model.advance(&mut moving, &mut workspace).ok()?;
            Some(moving)
        })
    };
    match refused {
        StepCause::Newton(_) => confirmed_step(&tried, &made),
        _ => largest_step(1.0, tried),
    }
}

/// Zero unless all stages succeed one after the other, and each of them also succeeds from the first state.
fn composed<S: Copy, T: Copy>(
    state: &S,
    steps: impl Iterator<Item = T>,
    step: impl Fn(&S, T) -> Option<S>,
) -> Option<f64> {
    let mut moving = *state;
    for h in steps {
        step(state, h)?;
        moving = step(&moving, h)?;
    }
    Some(0.0)
}

/// The cause, with the numbers of the composed step instead of the failed stage, and the fraction of the step that is
/// possible.
fn in_all<T: Real>(cause: StepCause, h: T, share: f64) -> StepCause {
    let in_lane = |lane: usize| {
        let h = h.lane(lane);
        (Some(h), Some(h * share))
    };
    match cause {
        StepCause::MoserVeselov(e) => {
            let (h, largest_step) = in_lane(e.lane as usize);
            StepCause::MoserVeselov(MoserVeselovError {
                h,
                largest_step,
                ..e
            })
        }
        StepCause::Quaternions(e) => {
            let (h, largest_step) = in_lane(e.lane as usize);
            StepCause::Quaternions(QuaternionError {
                h,
                largest_step,
                ..e
            })
        }
        StepCause::LeftFactor(e) => {
            let (h, largest_step) = in_lane(usize::from(e.lane));
            StepCause::LeftFactor(Unsolved {
                h,
                largest_step,
                ..e
            })
        }
        StepCause::Newton(e) => {
            let (h, largest_step) = in_lane(usize::from(e.lane));
            StepCause::Newton(NewtonError {
                h,
                largest_step,
                ..e
            })
        }
        other => other,
    }
}
