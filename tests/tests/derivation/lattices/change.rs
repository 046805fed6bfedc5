//! Changes of a typed action that a comparison must see.

/// What is changed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Change {
    None,
    /// The sign of the summand of this number.
    Sign(usize),
    /// The range of the sum of this number: the first site and the last one moved by so much.
    Range(usize, isize, isize),
}

/// Every change of the range of one sum at one of its ends by one site.
pub(super) const ENDS_MOVED: [(isize, isize); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];
