//! The tapes of one function of a trajectory, one for each way in which its decisions came out.

use super::kept::MOST;
use super::load;
use clebsch_program::{Frame, Machine};

/// A function as a tape, by how it decided where it was recorded.
#[derive(Debug)]
pub struct Way {
    /// The tape.
    pub machine: Machine,
    /// Its registers.
    pub frame: Frame<1>,
    /// By how much each count grows.
    pub growth: Vec<i64>,
}

impl Way {
    /// Computes on these numbers; false where a decision comes out otherwise.
    fn follows(&mut self, numbers: &[f64]) -> bool {
        // The workspace comes last: its numbers may be more than the tape reads.
        let own = numbers.get(..self.machine.inputs());
        let loaded = own.and_then(|own| load(self.frame.inputs(), own));
        loaded.is_some() && self.machine.run(&mut self.frame)
    }
}

/// The ways of one function, that used last at the end, and how many more are recorded.
#[derive(Debug)]
pub struct Ways {
    known: Vec<Way>,
    left: usize,
}

impl Ways {
    /// None yet; none at all, unless the function `records`.
    pub fn new(records: bool) -> Self {
        Ways {
            known: Vec::new(),
            left: if records { MOST } else { 0 },
        }
    }

    /// Whether there is none, and none is recorded.
    pub fn are_none(&self) -> bool {
        self.known.is_empty() && self.left == 0
    }

    /// The way that computes the function at these numbers, and has done so. If there is none, one is recorded.
    pub fn found(
        &mut self,
        numbers: &[f64],
        make: impl FnOnce() -> Option<Way>,
    ) -> Option<&mut Way> {
        let known = self.known.iter_mut().rposition(|way| way.follows(numbers));
        match known {
            Some(at) if at + 1 == self.known.len() => {}
            Some(at) => {
                let way = self.known.remove(at);
                self.known.push(way);
            }
            None if self.left > 0 => {
                self.left -= 1;
                let mut made = make()?;
                if !made.follows(numbers) {
                    return None;
                }
                self.known.push(made);
            }
            None => return None,
        }
        self.known.last_mut()
    }
}
