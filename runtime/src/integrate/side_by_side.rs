//! Steps of bodies side by side, in a loop over the lanes that does the arithmetic of one body. Takes a model over
//! lanes, its state and workspace; gives steps as long as one iteration suffices for each equation.

use super::Stepper;
use crate::scalar::InLanes;
use crate::solvers::moser_veselov::Edge;
use crate::{Real, Rotation, SpatialMomentum, StepError};

/// The quantities that a forced step changes: the body at a node, and the edge that begins there.
#[derive(Clone, Copy, Debug)]
pub struct Moving<T = f64> {
    /// The attitude.
    pub attitude: Rotation<T>,
    /// The momentum at the node.
    pub momentum: SpatialMomentum<T>,
    /// The edge that begins at the node.
    pub edge: Edge<T>,
}

impl<T: Real> Moving<T> {
    /// The body and its edge in one lane.
    #[inline(always)]
    pub fn from(&self, lane: usize) -> (Rotation<T::One>, Edge<T::One>) {
        (self.attitude.in_lane(lane), self.edge.in_lane(lane))
    }

    /// Writes one body to its lane; returns whether its momentum is finite.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, one: Moving<T::One>) -> bool {
        let [[x, y, z]] = one.momentum.0.data.0;
        self.attitude.set_one(lane, one.attitude);
        self.momentum.set_one(lane, one.momentum);
        self.edge.set_one(lane, one.edge);
        x.is_finite() & y.is_finite() & z.is_finite()
    }
}

/// A model whose easy steps can be computed lane by lane without a branch.
pub trait SideBySide: Stepper {
    /// The body and edge from which the next step begins. `None` if the workspace belongs to another
    /// state, or requests another solver.
    fn moving(
        &self,
        state: &Self::State,
        workspace: &Self::Workspace,
    ) -> Option<Moving<Self::Scalar>>;

    /// Writes `moving` back to the state and the workspace, `steps` nodes later.
    fn arrive(
        state: &mut Self::State,
        workspace: &mut Self::Workspace,
        moving: &Moving<Self::Scalar>,
        steps: u64,
    );

    /// Whether the body is given in principal axes.
    fn is_diagonal(&self, workspace: &Self::Workspace) -> bool;

    /// One step of every lane; returns whether all steps were easy. If not, `to` is meaningless.
    fn step_lanes<const DIAGONAL: bool>(
        &self,
        state: &Self::State,
        workspace: &Self::Workspace,
        from: &Moving<Self::Scalar>,
        to: &mut Moving<Self::Scalar>,
    ) -> bool;
}

/// Takes steps one after the other: easy ones in a loop over the lanes, others by the model's own step, with the same
/// result.
///
/// # Errors
/// As [`Stepper::advance`].
#[inline(always)]
pub fn advance_side_by_side<M: SideBySide>(
    model: &M,
    state: &mut M::State,
    workspace: &mut M::Workspace,
    count: u64,
) -> Result<(), StepError> {
    let mut left = count;
    while left > 0 {
        left -= match model.is_diagonal(workspace) {
            true => easy_steps::<M, true>(model, state, workspace, left),
            false => easy_steps::<M, false>(model, state, workspace, left),
        };
        if left > 0 {
            model.advance(state, workspace)?;
            left -= 1;
        }
    }
    Ok(())
}

/// Takes up to `most` easy steps; returns how many it took.
#[inline(always)]
fn easy_steps<M: SideBySide, const DIAGONAL: bool>(
    model: &M,
    state: &mut M::State,
    workspace: &mut M::Workspace,
    most: u64,
) -> u64 {
    let Some(mut here) = model.moving(state, workspace) else {
        return 0;
    };
    // Alternates between two buffers, so that a step that was not easy leaves its input unchanged.
    let mut there = here;
    let mut made = 0;
    while made < most {
        if !model.step_lanes::<DIAGONAL>(state, workspace, &here, &mut there) {
            break;
        }
        made += 1;
        if made == most || !model.step_lanes::<DIAGONAL>(state, workspace, &there, &mut here) {
            here = there;
            break;
        }
        made += 1;
    }
    if made > 0 {
        M::arrive(state, workspace, &here, made);
    }
    made
}
