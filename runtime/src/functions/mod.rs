//! Functions that models take by name, `given f(Sym<3>): Real = clebsch::functions::carlson_rf;`: their values
//! and pull-backs, over every scalar. Your own function is a unit struct with the same two methods; its
//! pull-back is the derivative with respect to an argument, transposed and applied to a seed of the shape of
//! the value.

mod carlson;
mod jet;

pub use carlson::{carlson_rf, carlson_rf_of_invariants};
