//! The gallery: one model, one file, each with its source, its statement, and named cases with
//! data. Everything else about a model is derived from its statement.

pub mod case;
pub mod free_body;
pub mod heavy_top;

pub use case::{Case, Entry};

/// All models, in order of their names.
pub fn gallery() -> Vec<Entry> {
    vec![free_body::entry(), heavy_top::entry()]
}

/// The model with this name, as the command line spells it (`heavy-top`).
pub fn find(kebab: &str) -> Option<Entry> {
    gallery().into_iter().find(|e| e.card.kebab == kebab)
}
