//! Runtime of chains, rods and rings: the functions that steppers of models with labels call. Threads share loops over
//! sites by ranges, so results do not depend on the number of threads. Errors name the site.

mod attitude;
mod band;
mod blocks;
mod check;
mod columns;
mod ending;
mod error;
mod lanes;
mod multipliers;
mod part;
mod pivots;
mod root;
mod signs;
mod stamp;
mod sweep;
mod turn;
mod turning;
mod unknown;
mod window;

pub use attitude::{Attitude, between, turned_by};
pub use band::{Added, AnyBand, Band, Rows, Sums, Velocity, spread};
pub use check::{count_of, each, length_of, repeated, shorter};
pub use columns::{Attitudes, Columns, ColumnsPart, Edges, Numbered, array_from, once};
pub use error::{LineError, Place};
pub use lanes::{Change, Finite, Stage, fill_in_lanes, try_fill_in_lanes, update_in_lanes};
pub use multipliers::{Multipliers, NoReaction};
pub use part::{InColumns, LANES, Part};
pub use root::{NoRoot, root, root_of};
pub use signs::{agree, closes, turn_towards};
pub use stamp::Stamp;
pub use sweep::{Threads, fill, sum, total, try_each, try_fill, update};
pub use turn::turn_of;
pub use turning::Turning;
pub use unknown::{Unknown, field, rotation};
pub use window::{Stretch, Window, Windowed};
