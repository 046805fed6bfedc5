//! The tapes of one function of a trajectory, one for each outcome of its decisions.

use super::counts::Growth;
use super::ready::Ready;
use super::shared::{Kinds, SharedTapes};
use super::solves::{SolveBetweenTapes, TapeOutcome};
use super::tape_storage::MOST;
use crate::code::Places;
use crate::listing::{Section, numbered};
use std::sync::Arc;

/// A function as tapes, for one outcome of its decisions. Copies share the operations.
#[derive(Clone, Debug)]
pub struct OutcomeTape {
    /// The equations that the function solves, each with the tape before it.
    pub between: Vec<SolveBetweenTapes>,
    /// The last tape.
    pub last: Ready,
    /// How each count grows.
    pub growth: Vec<Growth>,
    /// The input of the last tape: the numbers at the node, then the solutions.
    pub numbers: Vec<f64>,
}

/// Where a function is evaluated.
pub struct Node<'a> {
    /// The numbers of state and workspace.
    pub numbers: &'a [f64],
    /// The first count.
    pub first: i64,
    /// The places that contain the model, the step size and the searches.
    pub places: &'a mut Places<f64>,
}

impl OutcomeTape {
    /// Sets the numbers of the model and of the step size. Returns nothing if there are too few.
    pub fn begin(&mut self, steady: &[f64]) -> Option<()> {
        self.between
            .iter_mut()
            .try_for_each(|solve| solve.begin(steady))?;
        self.last.begin(steady)
    }

    /// The solutions of the equations of the last evaluation.
    pub fn solutions(&self) -> Option<&[f64]> {
        let count: usize = self.between.iter().map(SolveBetweenTapes::solution).sum();
        self.numbers.get(self.numbers.len().checked_sub(count)?..)
    }

    /// Computes the function at a node.
    fn follows(&mut self, node: &mut Node) -> TapeOutcome {
        let given = match self.between.first() {
            Some(_) => node.numbers.len(),
            // The workspace comes last: its numbers may be more than the tape reads.
            None => self.last.inputs(),
        };
        let Some(own) = node.numbers.get(..given) else {
            return TapeOutcome::Elsewhere;
        };
        self.numbers.clear();
        self.numbers.extend_from_slice(own);
        for at in 0..self.between.len() {
            let went = match self.between.get_mut(at) {
                Some(next) => next.solve(&mut self.numbers, node.first, node.places),
                None => TapeOutcome::Unsolved,
            };
            if went != TapeOutcome::On {
                self.undo(at, node.places);
                return went;
            }
        }
        if !self.last.computes(&self.numbers) {
            self.undo(self.between.len(), node.places);
            return TapeOutcome::Elsewhere;
        }
        for solved in &self.between {
            solved.remember(node.first, node.places);
        }
        TapeOutcome::On
    }

    /// Resets the searches of the parts up to `at`.
    fn undo(&self, at: usize, places: &mut Places<f64>) {
        for solved in self.between.iter().take(at + 1).rev() {
            solved.undo(places);
        }
    }
}

/// Evaluations of a function before its first recording. A recording costs as much as tens of evaluations, which a call
/// for a few steps never saves.
pub const WARM_UP: u32 = 8;

/// The tapes of one function of a trajectory, the last used at the end.
#[derive(Debug)]
pub struct TapesByOutcome {
    /// The tapes of all trajectories of the model; `None` if the function is not recorded.
    shared: Option<&'static SharedTapes>,
    known: Vec<(Arc<OutcomeTape>, OutcomeTape)>,
    /// How many more outcomes this trajectory may meet before the function itself runs.
    left: usize,
    /// Evaluations by the function itself.
    evaluations: u32,
}

impl TapesByOutcome {
    /// No tapes yet.
    pub fn new(shared: Option<&'static SharedTapes>) -> Self {
        TapesByOutcome {
            shared,
            known: Vec::new(),
            left: MOST,
            evaluations: 0,
        }
    }

    /// Whether the function is not recorded and will not be.
    pub fn are_none(&self) -> bool {
        self.shared.is_none() || self.known.is_empty() && self.left == 0
    }

    /// The tapes of the newest outcome as text, given the names of the steady numbers, of the inputs and of the outputs.
    pub fn sections(&self, title: &str, [steady, inputs, outputs]: [&[String]; 3]) -> Vec<Section> {
        let Some((_, newest)) = self.known.last() else {
            return Vec::new();
        };
        let mut inputs = inputs.to_vec();
        let mut all = Vec::new();
        for (k, solve) in newest.between.iter().enumerate() {
            all.extend(solve.sections(steady, &inputs));
            let which = if k == 0 {
                String::new()
            } else {
                format!("{}", k + 1)
            };
            inputs.extend(numbered(&format!("velocity{which}"), solve.solution()));
        }
        all.extend(newest.last.sections(title, steady, &inputs, outputs));
        all
    }

    /// The tapes that have computed the function last.
    pub fn newest(&self) -> Option<&OutcomeTape> {
        self.known.last().map(|(_, tape)| tape)
    }

    /// The tapes that have just computed the function at a node. If no tape of this trajectory fits, a tape of another
    /// trajectory is tried, and then a new one is recorded. Returns `None` if the function itself must run: during the first
    /// evaluations, and if it cannot be recorded.
    pub fn found(
        &mut self,
        mut node: Node,
        make: impl FnOnce(&mut Places<f64>) -> Option<Arc<OutcomeTape>>,
    ) -> Option<&mut OutcomeTape> {
        for at in (0..self.known.len()).rev() {
            match self.known.get_mut(at)?.1.follows(&mut node) {
                TapeOutcome::On => {
                    if at + 1 < self.known.len() {
                        let way = self.known.remove(at);
                        self.known.push(way);
                    }
                    return self.known.last_mut().map(|(_, tape)| tape);
                }
                TapeOutcome::Elsewhere => {}
                TapeOutcome::Unsolved => return None,
            }
        }
        let shared = self.shared.filter(|_| self.left > 0)?;
        let kinds = Kinds::of(node.places)?;
        for other in shared.fitting(&kinds) {
            if self.known.iter().any(|(own, _)| Arc::ptr_eq(own, &other)) {
                continue;
            }
            match self.tried(other, &kinds, &mut node) {
                Some(TapeOutcome::On) => return self.known.last_mut().map(|(_, tape)| tape),
                Some(TapeOutcome::Unsolved) => return None,
                _ => {}
            }
        }
        self.evaluations = self.evaluations.saturating_add(1);
        if !shared.is_wanted(self.evaluations) {
            return None;
        }
        let made = make(node.places);
        let outcome = made.and_then(|made| self.tried(made, &kinds, &mut node));
        match outcome {
            Some(TapeOutcome::On) => self.known.last_mut().map(|(_, tape)| tape),
            _ => {
                self.left -= 1;
                None
            }
        }
    }

    /// Computes the function by a copy of these tapes, and keeps the copy if it fits.
    fn tried(
        &mut self,
        shared: Arc<OutcomeTape>,
        kinds: &Kinds,
        node: &mut Node,
    ) -> Option<TapeOutcome> {
        let mut own = OutcomeTape::clone(&shared);
        own.begin(&kinds.steady)?;
        let outcome = own.follows(node);
        if outcome == TapeOutcome::On {
            self.left = self.left.saturating_sub(1);
            self.known.push((shared, own));
        }
        Some(outcome)
    }
}
