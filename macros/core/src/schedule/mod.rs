//! From expressions to programs near Rust's operations: common sub-expressions become named
//! temporaries, computed once, in an order in which each uses only those before it.

mod chain;
mod collected;
mod increments;
mod inverses;
mod known;
mod pairs;
mod program;
mod rest;
mod transposed;
mod work;

pub use chain::{Bracketed, associate};
pub use known::Known;
pub use program::{Program, program, program_after};
pub use rest::{
    at_rest, by_imaginary, displaced, divides_twice, is_difference, varies_with_rotations,
};
pub use work::work;
