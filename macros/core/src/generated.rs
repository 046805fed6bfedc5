//! The files of `generated/` for one model: its derivation as Markdown and LaTeX, and the emitted
//! Rust. The same bytes on every machine; a test checks that the committed ones are these.

use crate::derive::Derivation;
use crate::document::printed;
use crate::emit::emit;
use crate::pretty::pretty;
use crate::print::Format;

/// Names and contents of the files.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn files(d: &Derivation) -> Result<Vec<(String, String)>, String> {
    let note = "Written by `clebsch derive --write`. Do not edit.";
    Ok(vec![
        (
            "derivation.md".to_owned(),
            format!("<!-- {note} -->\n\n{}", printed(d, Format::Markdown)),
        ),
        (
            "derivation.tex".to_owned(),
            format!("% {note}\n{}", printed(d, Format::Latex)),
        ),
        (
            "stepper.rs".to_owned(),
            format!("// {note}\n\n{}", rust(d)?),
        ),
    ])
}

/// The emitted Rust, formatted, without the derivation in its documentation.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn rust(d: &Derivation) -> Result<String, String> {
    if let Some(refused) = crate::emit::refusal(d) {
        return Err(refused.text());
    }
    pretty(emit(d, false))
}
