//! `clebsch derive`: the equations of a model, from its text.
//! Takes a model of the gallery, a file or standard input; gives text, LaTeX, Markdown, Rust, JSON or a list of operations.

pub mod generated;
mod program;

use crate::commands::show::statement;
use crate::models::gallery::{Citations, Gallery};
use crate::named::resolve::{NamedModel, named};
use crate::terminal::Streams;
use crate::terminal::bounded;
use crate::terminal::failure::Failure;
use crate::words::lines::fitted;
use crate::words::plain::shown;
use clap::ArgMatches;
use clap::parser::ValueSource;
use clebsch_core::print::{Format, Style, code, standalone};
use clebsch_core::syntax::ast::Model;
use clebsch_core::{Derivation, derive_source, document, lattice, pipeline};
use std::io::Read;
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
    if text("format") == "program" {
        let program = program::program(gallery, text("model"), streams)?;
        streams.out.write_all(program.as_bytes())?;
        return Ok(());
    }
    let (name, source, mut citations) = source(gallery, text("model"), streams.input)?;
    if matches.get_flag("no-thesis") {
        citations = Citations::NONE;
    }
    let proofs = Proofs {
        explain: matches.get_flag("explain"),
        second: matches.get_flag("second-proof"),
        standalone: matches.get_flag("standalone"),
    };
    let format = format(matches)?;
    if proofs.second && !cfg!(feature = "second-proof") {
        return Err(Failure::Usage(WITHOUT_PROVER.to_owned()));
    }
    let name = shown(&name).to_string();
    let width = streams.width;
    let (derivation, warnings) =
        derived(&name, &source, citations, format, proofs, width).map_err(Failure::Usage)?;
    streams.out.write_all(derivation.as_bytes())?;
    // A warning that cannot be written is not lost: the derivation contains it.
    let _ = streams.err.write_all(warnings.as_bytes());
    Ok(())
}

/// An ordinary build omits the second prover, which would add a sixth to its time.
const WITHOUT_PROVER: &str = "this command was built without the second prover; build it with `cargo run --profile quick -p \
    clebsch-cli --features second-proof -- derive MODEL --second-proof`, or use `--explain` for the first proof";

/// The text of a model and its citations. A name of the gallery comes first, then a file, which has no
/// citations; `-` is standard input.
fn source(
    gallery: &Gallery,
    name: &str,
    input: &mut dyn Read,
) -> Result<(String, String, Citations), Failure> {
    if name == "-" {
        let text = bounded::stream(input, "standard input")?;
        if text.trim().is_empty() {
            return Err(Failure::Usage(
                "standard input is empty; with `-`, clebsch reads the text of a model from it"
                    .to_owned(),
            ));
        }
        return Ok(("standard input".to_owned(), text, Citations::NONE));
    }
    let named = named(gallery, name, "derive needs a model or its text")?;
    let text = statement(&named).to_owned();
    let (name, citations) = match named {
        NamedModel::Compiled(entry) => (entry.card.kebab.to_owned(), entry.citations),
        NamedModel::Text(text) => (text.name, Citations::NONE),
    };
    Ok((name, text, citations))
}

/// The proofs to print with the equations, in all formats except rust and json.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Proofs {
    /// The proof by normal forms.
    pub explain: bool,
    /// The proof of each step by equality saturation. It takes longer than everything else.
    pub second: bool,
    /// Whether LaTeX is a complete document.
    pub standalone: bool,
}

/// The requested format. `--standalone` implies LaTeX.
fn format(matches: &ArgMatches) -> Result<&str, Failure> {
    let format = matches
        .get_one::<String>("format")
        .map_or("", String::as_str);
    let given = matches.value_source("format") == Some(ValueSource::CommandLine);
    match (matches.get_flag("standalone"), given, format) {
        (false, ..) | (true, true, "latex" | "tex") => Ok(format),
        (true, false, _) => Ok("latex"),
        (true, true, _) => Err(Failure::Usage(format!(
            "`--standalone` prints LaTeX, not {format}; remove `--format`"
        ))),
    }
}

/// The largest width of plain text on a wider terminal.
const PAGE: usize = 100;

/// The derivation of the model text `source`, from the file or model `name`, with its citations and the requested
/// proofs. `format` is text, latex, markdown, rust or json, or the ending of such a file. Lines of plain text have at
/// most `width` characters. The second value contains the warnings, with line, column and caret.
pub(crate) fn derived(
    name: &str,
    source: &str,
    citations: Citations,
    format: &str,
    proofs: Proofs,
    width: Option<usize>,
) -> Result<(String, String), String> {
    let told = |errors: clebsch_core::Errors| format!("\n{}", errors.render(source, name));
    let model = pipeline::parse_source(source).map_err(told)?;
    if lattice::has_labels(&model) {
        return on_lattice(&model, source, name, format, proofs, width);
    }
    let derivation = pipeline::derive_model(&model).map_err(told)?;
    let warnings = derivation.render_warnings(source, name);
    let format = match format {
        "rust" | "rs" => return Ok((generated::rust(&derivation)?, warnings)),
        "latex" | "tex" => Format::Latex,
        "markdown" | "md" => Format::Markdown,
        "json" => Format::Json,
        _ => Format::Text,
    };
    let columns = width.unwrap_or(PAGE).min(PAGE);
    let mut printed =
        document::printed_telling(&derivation, format, columns, citations, Some(source));
    let proof = explanation(&derivation, proofs);
    if !proof.is_empty() && format != Format::Json {
        printed.push('\n');
        printed.push_str(&code(&proof, &Style::default(), format));
    }
    if proofs.standalone {
        printed = standalone(&printed, citations.work.as_ref());
    }
    if let (Format::Text, Some(width)) = (format, width) {
        printed = fitted(&printed, width);
    }
    Ok((printed, warnings))
}

/// The derivation of a model with labels.
fn on_lattice(
    model: &Model,
    source: &str,
    name: &str,
    format: &str,
    proofs: Proofs,
    width: Option<usize>,
) -> Result<(String, String), String> {
    let told = |errors: clebsch_core::Errors| format!("\n{}", errors.render(source, name));
    let format = match format {
        "rust" | "rs" => {
            let items = pipeline::emitted_line(model, source).map_err(told)?;
            let text = generated::formatted(items)?;
            return Ok((text, String::new()));
        }
        "latex" | "tex" => Format::Latex,
        "markdown" | "md" => Format::Markdown,
        "json" => Format::Json,
        _ => Format::Text,
    };
    let columns = width.unwrap_or(PAGE).min(PAGE);
    let printed = document::printed_lattice(model, source, format, columns).map_err(told)?;
    let mut text = printed.text;
    if proofs.standalone {
        text = standalone(&text, None);
    }
    if format == Format::Text && (proofs.explain || proofs.second) {
        let shortest = pipeline::derive_model(model).map_err(told)?;
        text.push_str(&format!("\n{}", explanation(&shortest, proofs)));
    }
    if let (Format::Text, Some(width)) = (format, width) {
        text = fitted(&text, width);
    }
    let warnings = printed.warnings.iter();
    let warnings = warnings.map(|w| w.diagnostic.render("warning", source, name));
    Ok((text, warnings.collect()))
}

/// The proof by normal form, and the proof of each of its steps by equality saturation.
fn explanation(derivation: &Derivation, proofs: Proofs) -> String {
    let mut text = String::new();
    if proofs.explain {
        text.push_str(&document::proof(derivation));
    }
    if proofs.second {
        if proofs.explain {
            text.push('\n');
        }
        text.push_str(&second_proof(derivation));
    }
    text
}

/// The proof of each step by equality saturation.
#[cfg(feature = "second-proof")]
fn second_proof(derivation: &Derivation) -> String {
    let mut text = "Second proof, by equality saturation (egg), step by step:\n".to_owned();
    for (i, line) in clebsch_prove::second_proof(derivation)
        .into_iter()
        .enumerate()
    {
        text.push_str(&format!("\n{:>3}. {line}\n", i + 1));
    }
    text
}

/// Empty: without the feature such a request is rejected earlier.
#[cfg(not(feature = "second-proof"))]
fn second_proof(_: &Derivation) -> String {
    String::new()
}

/// Writes the derivations of all models into a folder, one folder a model.
fn write_all(gallery: &Gallery, folder: &Path) -> Result<(), Failure> {
    if !folder.is_dir() {
        return Err(Failure::Usage(
            "there is no folder `generated` here: run this in the root folder of the project"
                .to_owned(),
        ));
    }
    for entry in &gallery.entries {
        let kebab = entry.card.kebab;
        let derivation = derive_source(entry.card.source)
            .map_err(|errors| Failure::Failed(errors.render(entry.card.source, kebab)))?;
        let files = generated::files(&derivation, entry.citations).map_err(Failure::Failed)?;
        let target = folder.join(kebab);
        std::fs::create_dir_all(&target)
            .map_err(|error| Failure::io(&format!("cannot make {}", shown(&target)), &error))?;
        for (file, contents) in files {
            replace_file(&target, &file, &contents)?;
        }
    }
    Ok(())
}

/// Writes a temporary file and renames it, so that a reader sees either the complete old file or the complete new
/// file.
fn replace_file(folder: &Path, file: &str, contents: &str) -> Result<(), Failure> {
    let (partial, target) = (folder.join(format!(".{file}.partial")), folder.join(file));
    std::fs::write(&partial, contents)
        .and_then(|()| std::fs::rename(&partial, &target))
        .map_err(|error| Failure::io(&format!("cannot write {}", shown(&target)), &error))
}
