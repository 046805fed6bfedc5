//! Text: numbers, tables and lines for a reader, suggestions for mistyped names, and values as TOML. It does not
//! depend on models or files.

pub(crate) mod columns;
pub(crate) mod lines;
pub(crate) mod number;
pub(crate) mod plain;
pub(crate) mod step_method;
pub(crate) mod suggestion;
pub(crate) mod toml_value;
pub(crate) mod width;
