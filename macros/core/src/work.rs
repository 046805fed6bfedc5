//! Counts the work of one derivation and enforces a limit. It counts expression nodes and exact evaluations on the
//! current thread; the counts do not depend on the machine, and no clock is read.

#[cfg(test)]
mod tests;

use std::cell::Cell;

/// Maximum number of expression nodes in one derivation. Gallery models need about 100,000; the largest known
/// derivable models of 10 kB need one million.
pub const NODES: u64 = 3_000_000;

/// Maximum number of nodes of one expression, counted with repetition.
pub const LARGEST: u32 = 500_000;

/// Maximum number of multiplications at exact points in the search for invariants.
pub const PRODUCTS: u64 = 30_000_000;

/// The work of one derivation.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Work {
    /// Expression nodes created.
    pub nodes: u64,
    /// Products of terms in normal forms, weighted by the length of words.
    pub terms: u64,
    /// Multiplications at exact points.
    pub products: u64,
}

thread_local! {
    /// Whether work on this thread is limited, which is the case during a derivation.
    static BOUNDED: Cell<bool> = const { Cell::new(false) };
    static MADE: Cell<u64> = const { Cell::new(0) };
    static TAKEN: Cell<u64> = const { Cell::new(0) };
    /// The current limit, as a multiple of the ordinary one. An expanded chain gets a larger limit, since it has many
    /// bodies.
    static ROOM: Cell<u64> = const { Cell::new(1) };
    /// Nodes of the expression that exceeded the limit; 0 if there is none.
    static ASKED: Cell<u32> = const { Cell::new(0) };
}

/// Raises the work limit until it is dropped.
pub(crate) struct Room {
    before: u64,
}

/// Raises the work limit to a multiple of the ordinary one.
pub(crate) fn room(times: u64) -> Room {
    Room {
        before: ROOM.replace(times.max(1)),
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        ROOM.set(self.before);
    }
}

/// The current limit as a multiple of the ordinary one.
pub(crate) fn times() -> u64 {
    ROOM.get()
}

/// The current limit on expression nodes.
fn nodes() -> u64 {
    NODES.saturating_mul(ROOM.get())
}

/// The current limit on multiplications in the search for invariants.
pub(crate) fn products() -> u64 {
    PRODUCTS.saturating_mul(ROOM.get())
}

/// Counts and limits the work of this thread from `begin` until it is dropped.
pub(crate) struct Count {
    before: (bool, u64, u64),
}

impl Count {
    /// Starts counting from zero.
    pub(crate) fn begin() -> Count {
        ASKED.set(0);
        Count {
            before: (BOUNDED.replace(true), MADE.replace(0), TAKEN.replace(0)),
        }
    }

    /// The work so far; `terms` is the count of the normal forms.
    pub(crate) fn work(&self, terms: u64) -> Work {
        Work {
            nodes: MADE.get(),
            terms,
            products: TAKEN.get(),
        }
    }
}

impl Drop for Count {
    fn drop(&mut self) {
        let (bounded, made, taken) = self.before;
        BOUNDED.set(bounded);
        MADE.set(made);
        TAKEN.set(taken);
    }
}

/// Whether the node limit was exceeded; results created after that are invalid.
pub(crate) fn exhausted() -> bool {
    BOUNDED.get() && MADE.get() > nodes()
}

/// Counts an expression node of this size; `false` if the limit is exceeded.
pub(crate) fn make(size: u32) -> bool {
    let made = MADE.get().saturating_add(1);
    MADE.set(match size > LARGEST {
        // Such an expression is never traversed: the derivation is abandoned.
        true if BOUNDED.get() => {
            ASKED.set(ASKED.get().max(size));
            u64::MAX
        }
        _ => made,
    });
    !exhausted()
}

/// Describes the exceeded limit, with the requested number and the limit.
pub(crate) fn excess() -> Option<String> {
    let asked = ASKED.get();
    match (exhausted(), cut_short()) {
        (true, _) if asked > 0 => Some(format!(
            "an expression of its derivation has {asked} nodes, and the limit is {LARGEST}"
        )),
        (true, _) => Some(format!(
            "its derivation makes more than {} nodes of expressions, which is the limit",
            nodes()
        )),
        (_, true) => Some(format!(
            "its derivation needs more than {} products of numbers, which is the limit",
            products()
        )),
        _ => None,
    }
}

/// Counts multiplications; `false` if the limit is exceeded.
pub(crate) fn take(products: usize) -> bool {
    TAKEN.set(TAKEN.get().saturating_add(products as u64));
    !cut_short()
}

/// Whether the search for invariants was cut short.
pub(crate) fn cut_short() -> bool {
    BOUNDED.get() && TAKEN.get() > products()
}
