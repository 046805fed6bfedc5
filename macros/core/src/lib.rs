//! The symbolic engine of clebsch: from the text of a model to its discrete equations, their
//! proof, their printed form and the Rust code that integrates them. An ordinary library on
//! `proc_macro2`, so that the macro, the command line and the tests run the very same code.

pub mod algebra;
pub mod check;
pub mod derive;
pub mod diagnostic;
pub mod document;
pub mod emit;
pub mod expr;
pub mod groups;
pub mod interpret;
pub mod lattice;
pub mod line;
pub mod lower;
pub mod pipeline;
pub mod print;
pub mod schedule;
pub mod syntax;
pub mod work;

pub use derive::Derivation;
pub use diagnostic::Errors;
pub use interpret::Assignment;
pub use pipeline::derive_source;
