//! Many independent bodies of one model, with different parameters and states.
//! Takes parameters and initial data of each; advances all of them, in cache and on all cores.
//!
//! A group holds `N` bodies in the lanes of vector registers. It takes all its steps before the next group begins, so
//! the cost per step does not grow with the size of the ensemble. Groups are independent: the result is bitwise
//! identical for any number of threads and any size of tasks.

mod dispatch;
mod failure;
mod group;

pub use dispatch::{InstructionSet, Work};
pub use failure::EnsembleError;

use super::{Model, Stepper};
use crate::{Lanes, StartError, StepError};
use failure::first;
use group::{Body, Group, Steps, Wide};

/// The default for the least number of groups in a task of a parallel run.
#[cfg(feature = "rayon")]
const BLOCK: usize = 4;

/// An ensemble of bodies, `N` of them side by side.
///
/// If the number of bodies is not a multiple of `N`, copies of the last body fill the remaining
/// lanes; you never see them.
///
/// With the feature `simd` the steps are compiled for several instruction sets, and clebsch selects the best one of
/// the processor at run time. Without it they are compiled for the instruction set of the build. The results are
/// bitwise identical: every lane rounds as plain numbers do, and products and sums are never fused.
///
/// Steps are bitwise identical to the steps that [`Stepper::advance_many`] takes with each body alone. Bodies whose
/// steps need iterations (see [`Model::SIDE_BY_SIDE`]) are stepped one by one: in lanes, all bodies would wait for
/// the slowest, which costs more than lanes save.
///
/// ```
/// use clebsch::integrate::Ensemble;
/// use clebsch::nalgebra::{Matrix3, Vector3};
/// use clebsch::{BodyMomentum, Rotation};
///
/// clebsch::model! {
///     model Pendulum3D {
///         param J: Sym<3>;
///         param w: Vec<3>;
///         group R: SO<3> velocity W;
///         advected g: Vec<3>;
///         constraint next(R) = R*W;
///         constraint next(g) = W^T*g;
///         lagrangian = -tr(J*W)/h - h*dot(w, g);
///     }
/// }
///
/// let bodies = (0..1000).map(|i| {
///     let x = f64::from(i) / 1000.0;
///     let parameters = Pendulum3DParameters {
///         J: Matrix3::from_diagonal(&Vector3::new(1.0, 1.0 + x, 1.5)),
///         w: Vector3::new(0.0, 0.0, x),
///     };
///     let initial = Pendulum3DInitial {
///         R: Rotation::identity(),
///         body_momentum: BodyMomentum(Vector3::new(0.1, x, 1.0)),
///         g: Vector3::z(),
///     };
///     (parameters, initial)
/// });
/// let mut pendulums = Ensemble::<Pendulum3D>::start(bodies, 0.1)?;
/// pendulums.run(200)?; // or run_parallel, on all cores
/// let energies: Vec<f64> = pendulums.observe(|model, state| model.energy(state)).collect();
/// let (parameters, state) = pendulums.body(7).ok_or("there are a thousand")?;
/// assert_eq!(energies[7], Pendulum3D::new(parameters)?.energy(&state));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<M: Model<Scalar = f64>, const N: usize = 16> {
    groups: Vec<Group<M, N>>,
    bodies: usize,
    steps: Steps<M::Choice>,
    instructions: InstructionSet,
    #[cfg(feature = "rayon")]
    block: usize,
}

impl<M: Model<Scalar = f64>, const N: usize> Ensemble<M, N> {
    /// The ensemble of these bodies, at node 0, with steps of `h`.
    ///
    /// # Errors
    /// Names the first body whose parameters or initial data are not admissible, or whose first
    /// step could not be made.
    pub fn start(
        bodies: impl IntoIterator<Item = (M::Parameters, M::Initial)>,
        h: f64,
    ) -> Result<Self, EnsembleError<StartError>> {
        Self::start_with(bodies, h, M::Choice::default())
    }

    /// As [`Ensemble::start`], with the option of the model's steps: for a free body, its order.
    ///
    /// # Errors
    /// As [`Ensemble::start`].
    pub fn start_with(
        bodies: impl IntoIterator<Item = (M::Parameters, M::Initial)>,
        h: f64,
        choice: M::Choice,
    ) -> Result<Self, EnsembleError<StartError>> {
        let begun = bodies.into_iter().enumerate().map(|(body, (p, initial))| {
            let state = M::of(p).map_err(StartError::from);
            let state = state.and_then(|model| model.begin(initial));
            state
                .map(|state| (p, state))
                .map_err(|cause| EnsembleError {
                    body,
                    among: 1,
                    failed: 1,
                    cause,
                })
        });
        let begun: Vec<Body<M>> = begun.collect::<Result<_, _>>()?;
        Self::resume(begun, h, choice)
    }

    /// An ensemble of running bodies, each at its own node, with steps of size `h` of either sign.
    ///
    /// # Errors
    /// Names the first body whose next step could not be made.
    pub fn resume(
        bodies: impl IntoIterator<Item = (M::Parameters, M::State)>,
        h: f64,
        choice: M::Choice,
    ) -> Result<Self, EnsembleError<StartError>> {
        let bodies: Vec<Body<M>> = bodies.into_iter().collect();
        let steps = Steps { h, choice };
        let groups = bodies
            .chunks(N.max(1))
            .enumerate()
            .filter_map(|(i, list)| Group::start(list, i * N, steps))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            groups,
            bodies: bodies.len(),
            steps,
            instructions: InstructionSet::default(),
            #[cfg(feature = "rayon")]
            block: BLOCK,
        })
    }

    /// This ensemble, with at least `groups` groups of bodies in each task of a parallel run.
    #[cfg(feature = "rayon")]
    #[must_use]
    pub fn with_block(self, groups: usize) -> Self {
        let block = groups.max(1);
        Self { block, ..self }
    }

    /// This ensemble, on the given instruction set if the processor has it.
    #[must_use]
    pub fn with_instructions(self, instructions: InstructionSet) -> Self {
        Self {
            instructions,
            ..self
        }
    }

    /// How many bodies there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bodies
    }

    /// Whether the ensemble is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bodies == 0
    }

    /// The parameters and the state of a body; `None` if the index is out of range.
    #[must_use]
    pub fn body(&self, index: usize) -> Option<(M::Parameters, M::State)> {
        if index >= self.bodies {
            return None;
        }
        let group = self.groups.get(index / N.max(1))?;
        group.body(index % N.max(1))
    }

    /// Parameters and states of all bodies, in the order of the bodies.
    pub fn bodies(&self) -> impl Iterator<Item = (M::Parameters, M::State)> + '_ {
        (0..self.bodies).filter_map(|i| self.body(i))
    }

    /// A number for every body, in their order, computed for all lanes at once:
    /// `ensemble.observe(|model, state| model.energy(state))`.
    pub fn observe(
        &self,
        number: impl Fn(&Wide<M, N>, &<Wide<M, N> as Stepper>::State) -> Lanes<N>,
    ) -> impl Iterator<Item = f64> {
        let lanes = self.groups.iter().flat_map(move |group| {
            let (model, state) = group.shown();
            number(model, &state).0
        });
        lanes.take(self.bodies)
    }

    /// `count` steps of every body, on this thread.
    ///
    /// # Errors
    /// Names the first body that failed. The bodies of its group are unchanged; all others have
    /// taken their steps.
    pub fn run(&mut self, count: u64) -> Result<(), EnsembleError<StepError>> {
        let task = self.task(count);
        first(
            self.groups
                .iter_mut()
                .enumerate()
                .filter_map(|(at, group)| task.advance(at, group)),
        )
    }

    /// As [`Ensemble::run`], on all threads of the current pool, with bitwise identical results.
    ///
    /// # Errors
    /// As [`Ensemble::run`].
    #[cfg(feature = "rayon")]
    pub fn run_parallel(&mut self, count: u64) -> Result<(), EnsembleError<StepError>> {
        use rayon::prelude::*;
        let task = self.task(count);
        let failures: Vec<_> = self
            .groups
            .par_iter_mut()
            .enumerate()
            .with_min_len(self.block)
            .filter_map(|(at, group)| task.advance(at, group))
            .collect();
        first(failures.into_iter())
    }

    fn task(&self, count: u64) -> Task<M::Choice> {
        Task {
            count,
            bodies: self.bodies,
            steps: self.steps,
            instructions: self.instructions,
        }
    }
}

/// The steps of one group.
struct Advance<'a, M: Model<Scalar = f64>, const N: usize> {
    group: &'a mut Group<M, N>,
    count: u64,
}

impl<M: Model<Scalar = f64>, const N: usize> Work for Advance<'_, M, N> {
    type Output = Result<(), StepError>;

    #[inline(always)]
    fn done(self) -> Self::Output {
        self.group.advance(self.count)
    }
}

/// The task of every group.
#[derive(Clone, Copy)]
struct Task<C> {
    count: u64,
    bodies: usize,
    steps: Steps<C>,
    instructions: InstructionSet,
}

impl<C: Copy> Task<C> {
    /// Advances the group at this index.
    fn advance<M: Model<Scalar = f64, Choice = C>, const N: usize>(
        &self,
        at: usize,
        group: &mut Group<M, N>,
    ) -> Option<EnsembleError<StepError>> {
        let steps = Advance {
            group: &mut *group,
            count: self.count,
        };
        let cause = self.instructions.run(steps).err()?;
        let first = at * N;
        let here = [first, self.bodies.saturating_sub(first).min(N)];
        Some(group.blame(self.count, here, self.steps, cause))
    }
}
