//! Finds the objects that a command line names: a model of the gallery or a file, and one of its cases.

pub(crate) mod cases;
pub(crate) mod model_file;
pub(crate) mod resolve;
mod sample;
