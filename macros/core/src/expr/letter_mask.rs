//! Shortens the walk of an expression: it skips parts in which a letter cannot occur, and shared parts that it has
//! already visited. Each letter has one of 128 marks; letters may share a mark. An absent mark proves that the
//! letter is absent, and a present mark proves nothing.

use super::hashed::Words;
use super::{Expr, Letter};
use core::hash::BuildHasherDefault;
use std::collections::HashMap;
use std::sync::Arc;

/// Marks of the letters of an expression.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Marks([u64; 2]);

impl Marks {
    /// The mark of one letter.
    pub(super) fn of(letter: Letter) -> Marks {
        // The three time levels of a symbol have adjacent marks.
        let place = i64::from(letter.symbol.0) * 3 + i64::from(letter.shift.time);
        let place = place.rem_euclid(128) as usize;
        let mut marks = [0; 2];
        marks[place / 64] = 1 << (place % 64);
        Marks(marks)
    }

    /// The marks of several letters.
    pub(super) fn of_all(letters: impl IntoIterator<Item = Letter>) -> Marks {
        let marks = letters.into_iter().map(Marks::of);
        marks.fold(Marks::default(), Marks::with)
    }

    /// The marks of both sets.
    pub(super) fn with(self, other: Marks) -> Marks {
        Marks([self.0[0] | other.0[0], self.0[1] | other.0[1]])
    }

    /// Whether the sets have no mark in common.
    pub(super) fn are_apart(self, other: Marks) -> bool {
        self.0[0] & other.0[0] == 0 && self.0[1] & other.0[1] == 0
    }

    /// Whether this set contains all marks of `other`.
    pub(super) fn hold(self, other: Marks) -> bool {
        self.with(other) == self
    }

    /// Whether no letter is marked.
    pub(super) fn is_empty(self) -> bool {
        self == Marks::default()
    }
}

/// Whether all letters of a part may occur in the whole; if not, the part does not occur in the whole.
pub(crate) fn may_hold(whole: &Expr, part: &Expr) -> bool {
    whole.0.marks.hold(part.0.marks)
}

/// Whether a letter may occur; `false` proves that it does not.
pub(crate) fn may_contain(e: &Expr, letter: Letter) -> bool {
    !e.0.marks.are_apart(Marks::of(letter))
}

/// Results of one walk for shared parts. It owns these parts, so that no other expression can get the address of one
/// of them.
pub(super) struct Memo<T>(HashMap<usize, (Expr, T), BuildHasherDefault<Words>>);

/// Smaller parts are visited again, because that costs less than looking them up.
const SHARED: u32 = 8;

impl<T> Default for Memo<T> {
    fn default() -> Self {
        // Looked up, never iterated, so its order does not affect a result.
        Memo(HashMap::default())
    }
}

impl<T: Clone> Memo<T> {
    /// The result stored for this part.
    pub(super) fn get(&self, e: &Expr) -> Option<T> {
        let (_, found) = self.0.get(&place(e)?)?;
        Some(found.clone())
    }

    /// Stores the result for this part, if the part is shared.
    pub(super) fn keep(&mut self, e: &Expr, found: &T) {
        if let Some(place) = place(e) {
            self.0.insert(place, (e.clone(), found.clone()));
        }
    }
}

/// The address of a part that is worth looking up.
fn place(e: &Expr) -> Option<usize> {
    let shared = e.size() >= SHARED && Arc::strong_count(&e.0) > 1;
    shared.then(|| Arc::as_ptr(&e.0).addr())
}
