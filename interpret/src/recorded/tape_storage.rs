//! The storage of recorded functions: their tapes, and the registers of the tapes.

use std::sync::{Arc, Mutex, PoisonError, RwLock};

/// Maximum number of tapes of a function: if its decisions have more outcomes, the function itself is run.
pub const MOST: usize = 8;

/// The tapes of a function, the newest last; `None` for a failed recording.
#[derive(Debug)]
pub struct Tapes<T> {
    tried: RwLock<Vec<Option<Arc<T>>>>,
}

impl<T> Tapes<T> {
    /// None yet.
    pub fn new() -> Self {
        Tapes {
            tried: RwLock::default(),
        }
    }

    /// The first result of `computes`, trying the newest tape first; otherwise the result of a new recording.
    pub fn compute<V>(
        &self,
        computes: impl Fn(&T) -> Option<V>,
        record: impl FnOnce() -> Option<T>,
    ) -> Option<V> {
        let tried = self.tried.read().unwrap_or_else(PoisonError::into_inner);
        let mut known = tried.iter().rev().flatten();
        if let Some(value) = known.find_map(|tape| computes(tape)) {
            return Some(value);
        }
        let count = tried.len();
        drop(tried);
        if count >= MOST {
            return None;
        }
        let made = record().map(Arc::new);
        let mut tried = self.tried.write().unwrap_or_else(PoisonError::into_inner);
        tried.push(made.clone());
        drop(tried);
        computes(&*made?)
    }
}

/// Registers that are not in use. Trajectories of several threads share a tape.
#[derive(Debug)]
pub struct Pool<F> {
    free: Mutex<Vec<F>>,
}

impl<F> Pool<F> {
    /// None yet.
    pub fn new() -> Self {
        Pool {
            free: Mutex::default(),
        }
    }

    /// Calls a function with free registers, or with new ones.
    pub fn with<V>(&self, make: impl FnOnce() -> F, run: impl FnOnce(&mut F) -> V) -> V {
        let free = self
            .free
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop();
        let mut frame = free.unwrap_or_else(make);
        let value = run(&mut frame);
        self.free
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(frame);
        value
    }
}
