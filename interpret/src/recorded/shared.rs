//! The tapes of one function for all trajectories of a model. A tape takes the numbers of the model and the step size as
//! inputs, so that it also serves other parameters.

use super::decision_tree::{OutcomeTape, WARM_UP};
use super::traced::Traced;
use crate::code::{Places, Routine};
use crate::map_scalar::{alike, numbers};
use crate::opened::at;
use crate::value::Value;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

/// How many tapes are kept. Trajectories that need more record their own.
const MOST_SHARED: usize = 64;

/// The model, the step size, the state and the workspace of a trajectory.
#[derive(Debug)]
pub struct Kinds {
    /// The model, the step size, the state and the workspace. Only their kinds count.
    of: [Value<f64>; 4],
    /// The numbers of the model and of the step size.
    pub steady: Vec<f64>,
}

impl Kinds {
    /// The kinds of the values in these places. Returns nothing if the model has values that are not numbers.
    pub fn of(places: &Places<f64>) -> Option<Self> {
        let value = |at: usize| places.get(at).cloned().unwrap_or(Value::Unit);
        let of = [at::MODEL, at::STEP, at::STATE, at::WORK].map(value);
        let mut steady = Vec::new();
        let [model, step, ..] = &of;
        numbers(model, &mut steady)?;
        numbers(step, &mut steady)?;
        Some(Kinds { of, steady })
    }

    fn agree(&self, other: &Self) -> bool {
        let mut pairs = self.of.iter().zip(&other.of);
        pairs.all(|(a, b)| alike(&super::counts::uncounted(a), &super::counts::uncounted(b)))
    }
}

/// A tape for all trajectories.
#[derive(Debug)]
struct Shared {
    kinds: Kinds,
    /// Whether the tape has the numbers of the model and the step size as constants.
    is_bound: bool,
    tape: Arc<OutcomeTape>,
}

/// A function over the recording scalar, and its tapes.
#[derive(Debug)]
pub struct SharedTapes {
    /// The function.
    pub routine: Routine<Traced>,
    tapes: RwLock<Vec<Arc<Shared>>>,
    /// Evaluations of all trajectories that no tape computed. Not counted further if tapes serve one model only.
    evaluations: AtomicU32,
}

/// The count for a function whose tapes serve one model only.
const ONLY_OWN: u32 = u32::MAX;

impl SharedTapes {
    /// No tapes yet.
    pub fn new(routine: Routine<Traced>) -> Self {
        SharedTapes {
            routine,
            tapes: RwLock::default(),
            evaluations: AtomicU32::new(0),
        }
    }

    /// The tapes for values of these kinds, the newest first.
    pub fn fitting(&self, kinds: &Kinds) -> Vec<Arc<OutcomeTape>> {
        let tapes = self.tapes.read().unwrap_or_else(PoisonError::into_inner);
        let fits = |shared: &&Arc<Shared>| {
            let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
            let mut both = kinds.steady.iter().zip(&shared.kinds.steady);
            kinds.agree(&shared.kinds) && (!shared.is_bound || both.all(same))
        };
        let fitting = tapes.iter().rev().filter(fits);
        fitting.map(|shared| shared.tape.clone()).collect()
    }

    /// Whether to record the function, after this number of evaluations in a trajectory. Counts one more evaluation of all
    /// trajectories.
    pub fn is_wanted(&self, own: u32) -> bool {
        let all = self.evaluations.load(Ordering::Relaxed);
        if all == ONLY_OWN {
            return own > WARM_UP;
        }
        let all = self.evaluations.fetch_add(1, Ordering::Relaxed);
        all >= WARM_UP
    }

    /// Stores a new tape; `is_bound` if it serves one model only.
    pub fn store(&self, kinds: Kinds, is_bound: bool, tape: OutcomeTape) -> Arc<OutcomeTape> {
        if is_bound {
            self.evaluations.store(ONLY_OWN, Ordering::Relaxed);
        }
        let tape = Arc::new(tape);
        let mut tapes = self.tapes.write().unwrap_or_else(PoisonError::into_inner);
        if tapes.len() == MOST_SHARED {
            tapes.remove(0);
        }
        tapes.push(Arc::new(Shared {
            kinds,
            is_bound,
            tape: tape.clone(),
        }));
        tape
    }
}
