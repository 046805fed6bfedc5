//! Text: numbers, tables and lines for a reader, names that were meant, and values as TOML. Knows no model and no file.

pub(crate) mod columns;
pub(crate) mod lines;
pub(crate) mod number;
pub(crate) mod plain;
pub(crate) mod step_method;
pub(crate) mod suggestion;
pub(crate) mod toml_value;
pub(crate) mod width;
