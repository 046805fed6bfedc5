//! Finds the model and the case that a command line names: a shipped model or a file, and one of its cases.

pub(crate) mod cases;
pub(crate) mod model_file;
pub(crate) mod resolve;
mod sample;
