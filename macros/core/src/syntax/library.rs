//! The functions that the library provides by path. Takes a path and the shapes of its arguments; gives an error if the
//! library has no such function.

use super::ast::{Name, SizedName};
use crate::diagnostic::{Diagnostic, Place};

/// The module of these functions.
const MODULE: &str = "clebsch::functions::";

/// The functions, with the shapes of their arguments. `interpret/src/library/functions.rs` runs the same functions.
pub const FUNCTIONS: [(&str, &[&str]); 2] = [
    ("carlson_rf", &["Sym"]),
    ("carlson_rf_of_invariants", &["Real", "Real", "Real"]),
];

/// Rejects a path into the library that names no function, and arguments that the function does not take. A path into
/// another crate is not known here.
pub(super) fn known(
    path: &Name,
    last: Place,
    arguments: &[SizedName],
    value: &SizedName,
) -> Result<(), Diagnostic> {
    let Some(name) = path.text.strip_prefix(MODULE) else {
        return Ok(());
    };
    let Some((_, shapes)) = FUNCTIONS.iter().find(|(own, _)| *own == name) else {
        return Err(Diagnostic::new(
            last,
            format!("clebsch has no function `{name}`"),
        )
        .help(
            "use `carlson_rf` of a `Sym<3>` or `carlson_rf_of_invariants` of three numbers, give an expression in quotes, or \
             name a function of your own crate",
        ));
    };
    let given = arguments.iter().map(|a| a.name.text.as_str());
    if given.eq(shapes.iter().copied()) && value.name.text == "Real" {
        return Ok(());
    }
    let takes = match shapes.len() {
        1 => "a `Sym<3>`",
        _ => "three numbers",
    };
    let stated = match shapes.len() {
        1 => "(Sym<3>): Real",
        _ => "(Real, Real, Real): Real",
    };
    Err(
        Diagnostic::new(last, format!("`{name}` takes {takes} and gives a number")).help(format!(
            "write for example `given RF{stated} = {MODULE}{name};`"
        )),
    )
}
