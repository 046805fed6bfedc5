//! Solvers of the implicit steps, one folder or file a solver; they know no models.
//! Each takes numbers of one step and gives the discrete velocity, or a typed error with numbers.

mod golden_section;
pub(crate) mod largest_step;
pub mod left_factor;
mod method;
pub mod moser_veselov;
pub mod newton;
pub mod two_sided;
pub mod unit_quaternions;

pub use method::{Method, NoSuchMethod};
