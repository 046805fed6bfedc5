//! `clebsch derive`: the equations of a model, from its text.
//! Takes a model of the gallery or a file; gives text, LaTeX, Markdown, Rust or JSON.

use crate::Streams;
use crate::failure::Failure;
use crate::gallery::Gallery;
use crate::suggestion::did_you_mean;
use clap::ArgMatches;
use clebsch_core::print::Format;
use clebsch_core::{Derivation, derive_source, document, generated};
use std::path::Path;

/// Runs the command.
///
/// # Errors
/// Usage: neither a model nor a readable file, or a text that does not derive.
pub fn derive(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let text = |key: &str| matches.get_one::<String>(key).map_or("", String::as_str);
    if matches.get_flag("write") {
        return write_all(gallery, Path::new("generated"));
    }
    let (name, source) = source(gallery, text("model"))?;
    let (derivation, warnings) =
        derive_text(&name, &source, text("format"), matches.get_flag("explain"))
            .map_err(Failure::Usage)?;
    streams.out.write_all(derivation.as_bytes())?;
    // What cannot be written there is in the derivation too.
    let _ = streams.err.write_all(warnings.as_bytes());
    Ok(())
}

/// The text of a model: of the gallery when there is one of that name, else of the file.
fn source(gallery: &Gallery, name: &str) -> Result<(String, String), Failure> {
    let unknown = match gallery.find(name) {
        Ok(entry) => return Ok((entry.card.kebab.to_owned(), entry.card.source.to_owned())),
        Err(unknown) => unknown,
    };
    if !Path::new(name).exists() {
        let known = gallery.entries.iter().map(|entry| entry.card.kebab);
        return Err(match unknown {
            Failure::Usage(_) => Failure::Usage(format!(
                "`{name}` is neither a model nor a file{}",
                did_you_mean(name, known)
            )),
            other => other,
        });
    }
    let text = std::fs::read_to_string(name)
        .map_err(|error| Failure::Usage(format!("cannot read the model file {name}: {error}")))?;
    Ok((name.to_owned(), text))
}

/// The derivation of the model text `source` (of the file or model `name`) in the form `format`:
/// text, latex, markdown, rust or json. `explain` adds the proof, in all forms but rust and json.
/// Beside it the warnings, with line, column and caret.
///
/// # Errors
/// The engine's message with line, column and caret.
pub fn derive_text(
    name: &str,
    source: &str,
    format: &str,
    explain: bool,
) -> Result<(String, String), String> {
    let derivation =
        derive_source(source).map_err(|errors| format!("\n{}", errors.render(source, name)))?;
    let warnings = derivation.render_warnings(source, name);
    let format = match format {
        "rust" => return Ok((generated::rust(&derivation)?, warnings)),
        "latex" => Format::Latex,
        "markdown" => Format::Markdown,
        "json" => Format::Json,
        _ => Format::Text,
    };
    let mut printed = document::printed(&derivation, format);
    if explain && format != Format::Json {
        let proof = explanation(&derivation);
        match format {
            Format::Latex => {
                printed.push_str(&format!("\\begin{{verbatim}}\n{proof}\\end{{verbatim}}\n"));
            }
            Format::Markdown => printed.push_str(&format!("\n```text\n{proof}```\n")),
            Format::Text | Format::MathMl | Format::Json => printed.push_str(&format!("\n{proof}")),
        }
    }
    Ok((printed, warnings))
}

/// The proof by normal form, and what equality saturation makes of each of its steps.
fn explanation(derivation: &Derivation) -> String {
    let mut text = document::proof(derivation);
    text.push_str("\nSecond proof, by equality saturation (egg), step by step:\n");
    for (i, line) in document::second_proof(derivation).into_iter().enumerate() {
        text.push_str(&format!("\n{:>3}. {line}\n", i + 1));
    }
    text
}

/// Writes the derivations of all models into a folder, one folder a model.
fn write_all(gallery: &Gallery, folder: &Path) -> Result<(), Failure> {
    if !folder.is_dir() {
        return Err(Failure::Usage(
            "there is no folder `generated` here: run this in the root of the project".to_owned(),
        ));
    }
    for entry in &gallery.entries {
        let kebab = entry.card.kebab;
        let derivation = derive_source(entry.card.source)
            .map_err(|errors| Failure::Failed(errors.render(entry.card.source, kebab)))?;
        let files = generated::files(&derivation).map_err(Failure::Failed)?;
        let target = folder.join(kebab);
        std::fs::create_dir_all(&target)
            .map_err(|error| Failure::io(&format!("cannot make {}", target.display()), &error))?;
        for (file, contents) in files {
            replace_file(&target, &file, &contents)?;
        }
    }
    Ok(())
}

/// Writes beside the old file and renames, so that a reader sees the old or the new one whole.
fn replace_file(folder: &Path, file: &str, contents: &str) -> Result<(), Failure> {
    let (partial, target) = (folder.join(format!(".{file}.partial")), folder.join(file));
    std::fs::write(&partial, contents)
        .and_then(|()| std::fs::rename(&partial, &target))
        .map_err(|error| Failure::io(&format!("cannot write {}", target.display()), &error))
}
