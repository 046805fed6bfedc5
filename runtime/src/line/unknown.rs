//! The parts of the velocity of a site: one field, or one rotation. Emitted code lists them; they tell which components
//! turn, and which are measured by one length.

/// One field or one rotation among the velocities of a site.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unknown {
    components: usize,
    turns: bool,
}

/// A field with this many components.
#[must_use]
pub const fn field(components: usize) -> Unknown {
    Unknown {
        components,
        turns: false,
    }
}

/// A rotation, in terms of the three components of its vector.
#[must_use]
pub const fn rotation() -> Unknown {
    Unknown {
        components: 3,
        turns: true,
    }
}

impl Unknown {
    /// The number of components.
    #[must_use]
    #[inline(always)]
    pub const fn components(self) -> usize {
        self.components
    }

    /// Whether it is a rotation. The components of its vector have the absolute rounding error of numbers of size 1.
    #[inline(always)]
    pub(super) const fn turns(self) -> bool {
        self.turns
    }
}

/// The first component of each part, with the part.
#[inline(always)]
pub(super) fn starts(unknowns: &[Unknown]) -> impl Iterator<Item = (usize, Unknown)> {
    unknowns.iter().scan(0, |next, unknown| {
        let start = *next;
        *next += unknown.components;
        Some((start, *unknown))
    })
}

/// The components at which the vector of a rotation starts.
#[inline(always)]
pub(super) fn begins(unknowns: &[Unknown]) -> impl Iterator<Item = usize> {
    starts(unknowns).filter_map(|(start, unknown)| unknown.turns.then_some(start))
}
