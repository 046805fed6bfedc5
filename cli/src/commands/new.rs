//! `clebsch new`: a model and a case of your own to start from, copied from a model of the gallery or from a template.
//! Takes a name; gives NAME.clebsch and NAME.toml, or nothing if one of them exists.

use crate::commands::show::{case_text, statement};
use crate::models::gallery::{Gallery, declared};
use crate::named::resolve::{named, parts};
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clap::ArgMatches;
use clebsch_interpret::Refused;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use toml::de::DeTable;

/// Two bodies and a spring: the default model.
const TEMPLATE: [&str; 2] = [
    include_str!("new/template.clebsch"),
    include_str!("new/template.toml"),
];

/// Runs the command.
///
/// # Errors
/// Usage: the name is invalid, the model to copy is unknown, or the file exists. Failed: the file cannot be
/// written.
pub(crate) fn new(
    gallery: &Gallery,
    matches: &ArgMatches,
    streams: &mut Streams<'_>,
) -> Result<(), Failure> {
    let argument = |key: &str| matches.get_one::<String>(key).map(String::as_str);
    let name = argument("name").unwrap_or_default();
    let name = name.strip_suffix(".clebsch").unwrap_or(name);
    let declared = camel(name)?;
    admitted(&declared)?;
    let (text, case) = match argument("from") {
        None => (TEMPLATE[0].to_owned(), TEMPLATE[1].to_owned()),
        Some(from) => {
            let (from, case) = parts(from, None)?;
            let named = named(gallery, from, "`--from` needs a model")?;
            let case = case_text(&named, case, streams)?;
            (statement(&named).trim_end().to_owned() + "\n", case)
        }
    };
    let text = renamed(&text, &declared);
    let files = [
        (PathBuf::from(format!("{name}.clebsch")), text),
        (
            PathBuf::from(format!("{name}.toml")),
            case_of(&case, name, &declared),
        ),
    ];
    if let Some((taken, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(Failure::Usage(format!(
            "{} exists; choose another name, or remove the file",
            shown(taken)
        )));
    }
    for (at, (path, text)) in files.iter().enumerate() {
        if let Err(error) = written(path, text) {
            // Half of the pair is of no use.
            for (path, _) in files.iter().take(at) {
                let _ = std::fs::remove_file(path);
            }
            return Err(Failure::Failed(format!(
                "cannot write {}: {error}",
                shown(path)
            )));
        }
    }
    let name = shown(name);
    writeln!(
        streams.out,
        "wrote {name}.clebsch, the model, and {name}.toml, its numbers; edit both, then\n\x20 clebsch check {name}.clebsch    \
         finds errors in them\n\x20 clebsch derive {name}.clebsch   prints the equations of motion\n\x20 clebsch run \
         {name}.clebsch --out out/{name}"
    )?;
    Ok(())
}

fn written(path: &Path, text: &str) -> std::io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(text.as_bytes())
}

/// The name that the model's text declares: `my-top` gives `MyTop`.
fn camel(name: &str) -> Result<String, Failure> {
    let stem = Path::new(name).file_name().unwrap_or_default();
    let stem = stem.to_string_lossy();
    let mut out = String::new();
    for word in stem.split(['-', '_', ' ']) {
        let mut letters = word.chars();
        out.extend(letters.next().into_iter().flat_map(char::to_uppercase));
        out.extend(letters);
    }
    let fits = out.chars().all(|c| c.is_ascii_alphanumeric())
        && out.starts_with(|c: char| c.is_ascii_alphabetic());
    if !fits {
        return Err(Failure::Usage(format!(
            "`{}` cannot be the name of a model; use letters, digits and `-`, starting with a letter, such as my-top",
            shown(name)
        )));
    }
    Ok(out)
}

/// Rejects names that the language or the emitted code uses, such as `Self` and `Vec`.
fn admitted(declared: &str) -> Result<(), Failure> {
    let text = renamed(TEMPLATE[0], declared);
    let Err(Refused::Model(errors)) = clebsch_interpret::card_and_warnings(&text) else {
        return Ok(());
    };
    let why = errors.iter().next().map(|d| d.message.clone());
    Err(Failure::Usage(format!(
        "{}; choose another name for the model, such as my-{}",
        why.unwrap_or_else(|| format!("`{declared}` cannot be the name of a model")),
        declared.to_lowercase()
    )))
}

/// The text of a model with another name.
fn renamed(text: &str, name: &str) -> String {
    let Some(old) = declared(text) else {
        return text.to_owned();
    };
    let declares = |line: &str| {
        let (_, rest) = line.split_once("model ")?;
        let at = line.len() - rest.len();
        let is_comment = line.trim_start().starts_with("//");
        let own = rest.strip_prefix(old.as_str())?;
        let ends = !own.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        (ends && !is_comment).then_some(at)
    };
    let mut done = false;
    let lines = text.split_inclusive('\n').map(|line| match declares(line) {
        Some(at) if !done => {
            done = true;
            let own = line.get(at + old.len()..).unwrap_or_default();
            format!("{}{name}{own}", line.get(..at).unwrap_or_default())
        }
        _ => line.to_owned(),
    });
    lines.collect()
}

/// A case of the new model: comments at its start say how to run it, and the rest is unchanged.
fn case_of(case: &str, name: &str, model: &str) -> String {
    let head: usize = case
        .split_inclusive('\n')
        .take_while(|line| line.starts_with('#'))
        .map(str::len)
        .sum();
    let body = case.get(head..).unwrap_or_default();
    let span = DeTable::parse(body)
        .ok()
        .and_then(|table| Some(table.get_ref().get("model")?.span()));
    let body = match span {
        Some(span) => format!(
            "{}\"{model}\"{}",
            body.get(..span.start).unwrap_or_default(),
            body.get(span.end..).unwrap_or_default()
        ),
        None => body.to_owned(),
    };
    let stem = Path::new(name).file_name().unwrap_or_default();
    let stem = stem.to_string_lossy();
    format!(
        "# A case of {stem}; run it with\n#   clebsch run {stem}.clebsch\n# Units: any consistent system.\n{body}"
    )
}
