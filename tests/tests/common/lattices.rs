//! Chains against actions whose sums over sites are written by hand, as loops with their own indices. For given numbers of sites
//! and ends, compares the derived momentum at either end of a step and the residual with the variation of the unreduced action by
//! dual numbers, at random fields that solve nothing. Then changes the hand-written action by one sign, or one range by one site;
//! the comparison must detect every such change that moves the action.

// Loops over sites keep the shape of the sums.
#![allow(clippy::needless_range_loop)]

pub mod beam;
pub mod body_chain;
mod change;
pub mod compare;
pub mod hoop;
pub mod prescribed_end;
pub mod rod;
pub mod scalars;
pub mod sets;
pub mod shallow_water;
pub mod sum;
pub mod tops;

use clebsch_core::Derivation;
use clebsch_core::lattice::Lattice;
use clebsch_core::pipeline::{derive_lattice, parse_source, representative};

/// Required agreement of each component, relative to the largest summand of the variation at its site. A summand has a relative
/// rounding error of about 1e-15. Differences of positions along 50 sites, exponentials and a few tens of summands lose three more
/// digits, 1e-12 in all. A wrong sign, factor or site changes the first digits.
const AGREEMENT: f64 = 1e-10;

/// The ends of a chain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ends {
    /// Closed to a ring.
    Ring,
    /// These alternatives at the first and the last site.
    Open(&'static str, &'static str),
}

impl Ends {
    /// The number of nodes for this number of segments.
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

/// The natural ends of a chain, used if no others are stated.
pub const FREE: Ends = Ends::Open("free", "free");

/// Derives the model for the given number of sites of each label.
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
