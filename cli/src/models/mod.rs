//! The models of the gallery, and the meaning of the fields of a card.

pub(crate) mod constraints;
pub(crate) mod fields;
pub mod gallery;
