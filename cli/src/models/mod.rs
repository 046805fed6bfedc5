//! The models that are offered, and what the fields of a model's card are.

pub(crate) mod fields;
pub mod gallery;
pub(crate) mod held;
