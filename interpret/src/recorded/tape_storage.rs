//! The storage of recorded functions: their tapes, and the registers of the tapes.

use std::sync::{Arc, Mutex, PoisonError, RwLock};

/// Most tapes of a function: if decisions come out in more ways than these, the function itself is run.
pub const MOST: usize = 8;

/// The tapes of a function, the newest last; nothing for a try that failed.
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

    /// The result of the newest tape for which `computes` gives one, otherwise the result of a new recording.
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

    /// Runs something in registers that are free, or made now.
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
