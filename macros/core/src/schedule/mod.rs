//! From expressions to programs close to Rust's operations. Common subexpressions become named temporaries, which are
//! computed once and use earlier temporaries only.

mod chain;
mod collected;
mod increment_form;
mod increments;
mod inverses;
mod loop_invariants;
mod pairs;
mod program;
mod transposed;
mod work;

pub use chain::{Bracketed, associate};
pub use increment_form::{
    at_rest, by_imaginary, displaced, divides_twice, is_difference, varies_with_rotations,
};
pub use loop_invariants::LoopInvariants;
pub use program::{Program, program, program_after};
pub use work::work;
