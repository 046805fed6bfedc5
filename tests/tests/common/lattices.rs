//! Lattices against actions whose sums over sites are typed by hand, as loops with their own indices.
//! Takes the derivation of a model with labels for chosen numbers of sites and ends; gives its momentum
//! at either end of a step and its residual, at random fields that solve nothing, against the variation
//! of the unreduced action by dual numbers. Then the typed action is changed by one sign or by one site
//! of one range: every such change that moves the action must be seen.

// Loops over sites read as the sums they were typed from.
#![allow(clippy::needless_range_loop)]

pub mod beam;
pub mod body_chain;
mod change;
pub mod compare;
pub mod held;
pub mod hoop;
pub mod rod;
pub mod scalars;
pub mod sets;
pub mod shallow_water;
pub mod sum;
pub mod tops;

use clebsch_core::Derivation;
use clebsch_core::lattice::Lattice;
use clebsch_core::pipeline::{derive_lattice, parse_source, representative};

/// Agreement asked of each component, relative to the largest summand of the variation of its own site.
/// A summand is rounded to some 1e-15 of what it is made of; differences of places along a line of 50
/// sites, exponentials and a few tens of summands lose three digits more, 1e-12 in all. What is wrong by
/// a sign, a factor or a site is wrong in the first digits.
const AGREEMENT: f64 = 1e-10;

/// How a line ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ends {
    /// Closed to a ring.
    Ring,
    /// These alternatives at the first and at the last site.
    Open(&'static str, &'static str),
}

impl Ends {
    /// How many nodes a line of `segments` has.
    fn nodes(self, segments: usize) -> usize {
        match self {
            Ends::Ring => segments,
            Ends::Open(..) => segments + 1,
        }
    }

    fn is_at(self, last: bool, name: &str) -> bool {
        match self {
            Ends::Ring => false,
            Ends::Open(first, at_last) => name == if last { at_last } else { first },
        }
    }
}

/// The natural ends of a line for which no other is stated.
pub const FREE: Ends = Ends::Open("free", "free");

/// Derives the model for so many sites of each label.
pub fn derived(text: &str, counts: &[(&str, usize)], ends: Ends) -> Derivation {
    let model = parse_source(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let lattice = Lattice::read(&model).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let mut choice = representative(&model, &lattice).unwrap_or_else(|e| panic!("{text}\n{e}"));
    for (label, count) in counts {
        choice = choice.with_count(&lattice, label, *count).unwrap();
    }
    choice = match ends {
        Ends::Ring => choice.with_ring(&lattice).unwrap(),
        Ends::Open(first, last) => {
            let held = choice.with_end(&lattice, false, first).unwrap();
            held.with_end(&lattice, true, last).unwrap()
        }
    };
    let found = derive_lattice(&model, &lattice, &choice);
    let (_, d) =
        found.unwrap_or_else(|e| panic!("{} {ends:?}\n{text}\n{e}", choice.words(&lattice)));
    d
}
