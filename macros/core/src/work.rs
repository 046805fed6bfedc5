//! The work of one derivation, counted, and the most of it that any model is given. Takes what is
//! made and evaluated on this thread; gives counts that are the same on every machine, and an end
//! to what would not end by itself. No clock is read.

#[cfg(test)]
mod tests;

use std::cell::Cell;

/// Most nodes of expressions that one derivation makes. A model of the gallery makes a tenth of a
/// million, the largest of 10 kB that are known to have a derivation one million.
pub const NODES: u64 = 3_000_000;

/// Most nodes of one expression, each counted as often as it occurs.
pub const LARGEST: u32 = 500_000;

/// Most products of numbers that the search for invariants takes at exact points.
pub const PRODUCTS: u64 = 30_000_000;

/// What one derivation has taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Work {
    /// Nodes of expressions made.
    pub nodes: u64,
    /// Products of terms in normal forms, long words counted by their length.
    pub terms: u64,
    /// Products of numbers at exact points.
    pub products: u64,
}

thread_local! {
    /// Whether work on this thread is bounded: while a model is derived it is.
    static BOUNDED: Cell<bool> = const { Cell::new(false) };
    static MADE: Cell<u64> = const { Cell::new(0) };
    static TAKEN: Cell<u64> = const { Cell::new(0) };
    /// How many times the work of an ordinary model is given: a lattice that is written out has the
    /// bodies of many.
    static ROOM: Cell<u64> = const { Cell::new(1) };
    /// Nodes of the expression that was too large to make; 0 where none was.
    static ASKED: Cell<u32> = const { Cell::new(0) };
}

/// More work than an ordinary model is given, until it is dropped.
pub(crate) struct Room {
    before: u64,
}

/// Gives so many times the work of an ordinary model.
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

/// How many times the work of an ordinary model the derivation at hand is given.
pub(crate) fn times() -> u64 {
    ROOM.get()
}

/// Most nodes of expressions that the derivation at hand makes.
fn nodes() -> u64 {
    NODES.saturating_mul(ROOM.get())
}

/// Most products of numbers that the search for invariants of the derivation at hand takes.
pub(crate) fn products() -> u64 {
    PRODUCTS.saturating_mul(ROOM.get())
}

/// The work of this thread from `begin` on, bounded until it is dropped.
pub(crate) struct Count {
    before: (bool, u64, u64),
}

impl Count {
    /// Begins to count from zero.
    pub(crate) fn begin() -> Count {
        ASKED.set(0);
        Count {
            before: (BOUNDED.replace(true), MADE.replace(0), TAKEN.replace(0)),
        }
    }

    /// What was taken so far, `terms` by normal forms.
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

/// Whether more nodes were asked for than a derivation is given: what was made since is void.
pub(crate) fn exhausted() -> bool {
    BOUNDED.get() && MADE.get() > nodes()
}

/// Books a node of an expression of this size; `false` when there is none left.
pub(crate) fn make(size: u32) -> bool {
    let made = MADE.get().saturating_add(1);
    MADE.set(match size > LARGEST {
        // One that is never walked to its end: the model is given up.
        true if BOUNDED.get() => {
            ASKED.set(ASKED.get().max(size));
            u64::MAX
        }
        _ => made,
    });
    !exhausted()
}

/// What was asked for beyond what a derivation is given, with the number and the limit.
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

/// Books products of numbers; `false` when there are none left.
pub(crate) fn take(products: usize) -> bool {
    TAKEN.set(TAKEN.get().saturating_add(products as u64));
    !cut_short()
}

/// Whether the search for invariants was cut short.
pub(crate) fn cut_short() -> bool {
    BOUNDED.get() && TAKEN.get() > products()
}
