//! The tapes of one function of a trajectory, one for each outcome of its decisions.

use super::counts::Growth;
use super::load;
use super::solves::{SolveBetweenTapes, TapeOutcome};
use super::tape_storage::MOST;
use crate::code::Places;
use clebsch_program::{Frame, Machine};

/// A function as tapes, for one outcome of its decisions.
#[derive(Debug)]
pub struct OutcomeTape {
    /// The equations that the function solves, each with the tape before it.
    pub between: Vec<SolveBetweenTapes>,
    /// The last tape.
    pub machine: Machine,
    /// Its registers.
    pub frame: Frame<1>,
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
    /// The places that contain the searches.
    pub places: &'a mut Places<f64>,
}

impl OutcomeTape {
    /// Computes the function at a node.
    fn follows(&mut self, node: &mut Node) -> TapeOutcome {
        let given = match self.between.first() {
            Some(_) => node.numbers.len(),
            // The workspace comes last: its numbers may be more than the tape reads.
            None => self.machine.inputs(),
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
        let loaded = load(self.frame.inputs(), &self.numbers);
        if loaded.is_none() || !self.machine.run(&mut self.frame) {
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
const WARM_UP: u32 = 8;

/// The tapes of one function, one for each outcome, the last used at the end, and the number of outcomes that may
/// still be recorded.
#[derive(Debug)]
pub struct TapesByOutcome {
    known: Vec<OutcomeTape>,
    left: usize,
    /// Evaluations left before the first recording.
    warm_up: u32,
}

impl TapesByOutcome {
    /// No tapes yet; if the function does not `record`, there will never be any.
    pub fn new(records: bool) -> Self {
        TapesByOutcome {
            known: Vec::new(),
            left: if records { MOST } else { 0 },
            warm_up: WARM_UP,
        }
    }

    /// Whether the function is not recorded and will not be.
    pub fn are_none(&self) -> bool {
        self.known.is_empty() && self.left == 0
    }

    /// The tapes that have just computed the function at a node. If no tape fits, a new one is recorded. Returns `None` if
    /// the function itself must run: during its first evaluations, and if it cannot be recorded.
    pub fn found(
        &mut self,
        mut node: Node,
        make: impl FnOnce(&mut Places<f64>) -> Option<OutcomeTape>,
    ) -> Option<&mut OutcomeTape> {
        for at in (0..self.known.len()).rev() {
            match self.known.get_mut(at)?.follows(&mut node) {
                TapeOutcome::On => {
                    if at + 1 < self.known.len() {
                        let way = self.known.remove(at);
                        self.known.push(way);
                    }
                    return self.known.last_mut();
                }
                TapeOutcome::Elsewhere => {}
                TapeOutcome::Unsolved => return None,
            }
        }
        if self.left > 0 && self.warm_up > 0 {
            self.warm_up -= 1;
            return None;
        }
        self.left = self.left.checked_sub(1)?;
        let mut made = make(node.places)?;
        if made.follows(&mut node) != TapeOutcome::On {
            return None;
        }
        self.known.push(made);
        self.known.last_mut()
    }
}
