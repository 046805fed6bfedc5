//! Chains, rods and rings: what emitted steppers of models with labels call. Loops over sites, which
//! threads share by ranges of sites, so that no result depends on their number; errors that name
//! the site; what moves at a site.

mod attitude;
mod band;
mod blocks;
mod check;
mod error;
mod multipliers;
mod pivots;
mod root;
mod signs;
mod stamp;
mod sweep;
mod turn;

pub use attitude::{Attitude, between, turned_by};
pub use band::{Added, AnyBand, Band, Rows, Sums, Velocity, spread};
pub use check::{count_of, each, length_of, repeated, shorter};
pub use error::{LineError, Place};
pub use multipliers::{Multipliers, NoReaction};
pub use root::{NoRoot, root, root_of};
pub use signs::{agree, closes, turn_towards};
pub use stamp::Stamp;
pub use sweep::{Threads, fill, sum, total, try_each, try_fill, update};
pub use turn::turn_of;
