//! Displayed equations of a document: one by one, or several in a row as a group under one number, each with a name
//! that says what it is. Sources in the thesis are footnotes of the sentence before.

use super::characters::{prose, symbol_of};
use super::{Dialect, display};
use crate::expr::symbol;
use crate::print::Page;
use crate::print::document::{Block, Document};
use crate::print::name;

/// The thesis, as `\cite` calls it.
const KEY: &str = "dixon2007";

/// Its entry in a bibliography.
const ENTRY: &str = "@phdthesis{dixon2007, author = {Dixon, M. F.}, title = {Geometric integrators for continuum dynamics}, \
     school = {Imperial College London}, year = {2007}}";

/// The names of all equations by their number.
pub(super) struct Labels(Vec<String>);

impl Labels {
    /// Names made of the model's and of what an equation is called, or of its section and place there.
    pub(super) fn of(page: &Page, document: &Document) -> Labels {
        let model = document.title.split(':').next().unwrap_or_default();
        let model = slug(model);
        let mut names: Vec<String> = Vec::new();
        for section in &document.sections {
            let mut place = 0;
            for block in &section.blocks {
                let Block::Equation { label, .. } = block else {
                    continue;
                };
                place += 1;
                let own = match label {
                    Some(label) => slug(&called(page, label)),
                    None => format!("{}-{place}", slug(&section.title)),
                };
                let mut name = format!("eq:{model}:{own}");
                // Two equations that are called alike.
                while names.contains(&name) {
                    name.push('b');
                }
                names.push(name);
            }
        }
        Labels(names)
    }

    /// That of the equation with this number, counted from 1.
    pub(super) fn name(&self, number: usize) -> &str {
        let name = number.checked_sub(1).and_then(|i| self.0.get(i));
        name.map_or("eq:none", String::as_str)
    }
}

/// What an equation is called: `relation 4` by the symbol that is varied, the first of its kind without a number.
fn called(page: &Page, label: &str) -> String {
    let varied = label.strip_prefix("relation ").and_then(|id| {
        let id: u32 = id.parse().ok()?;
        let mut ids = page.symbols.ids();
        ids.find(|s| s.0 == id)
    });
    match varied {
        Some(symbol) => format!("variation of {}", page.symbols.get(symbol).name),
        None => label.strip_suffix(" 0").unwrap_or(label).to_owned(),
    }
}

/// Words as part of a label: ASCII, small, with hyphens.
pub(super) fn slug(title: &str) -> String {
    let words = symbol::ascii(&name::letter(title)).to_lowercase();
    let mut out = String::new();
    for c in words.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(c);
        } else if !out.is_empty() && !out.ends_with('-') {
            out.push('-');
        }
    }
    out.trim_end_matches('-').to_owned()
}

/// The head of a document: what it needs, and the entry that its footnotes cite.
pub(super) fn preamble(document: &Document) -> String {
    let mut blocks = document.sections.iter().flat_map(|s| &s.blocks);
    let cites = blocks.any(|b| matches!(b, Block::Equation { tag: Some(_), .. }));
    match cites {
        true => format!("% Needs \\usepackage{{amsmath}}, and in the bibliography\n% {ENTRY}\n"),
        false => "% Needs \\usepackage{amsmath}.\n".to_owned(),
    }
}

/// The footnote with the sources of equations `from`, `from + 1`, ... in the thesis; none where they have none.
pub(super) fn footnote(run: &[Block], from: usize, labels: &Labels) -> String {
    let several = run.len() > 1;
    let sources = run.iter().enumerate().filter_map(|(i, block)| {
        let Block::Equation { tag: Some(tag), .. } = block else {
            return None;
        };
        let source = cited(tag);
        Some(match several {
            true => format!("\\eqref{{{}}}: {source}", labels.name(from + i)),
            false => source,
        })
    });
    let sources: Vec<String> = sources.collect();
    match sources.is_empty() {
        true => String::new(),
        false => format!("\\footnote{{{}.}}", sources.join("; ")),
    }
}

/// `thesis (2.145) corrected: ...` as a citation with what is said of it.
fn cited(tag: &str) -> String {
    let Some(rest) = tag.strip_prefix("thesis ") else {
        return prose(tag);
    };
    let end = rest.find(')').map_or(rest.len(), |at| at + 1);
    let (place, said) = rest.split_at(end);
    let said = match said.strip_prefix(" corrected") {
        Some(how) => format!(", corrected{how}"),
        None => said.to_owned(),
    };
    let said = said
        .replace("times -1/h", "times $-1/h$")
        .replace("times -h", "times $-h$");
    let pieces = said.split('$').enumerate();
    let said: String = pieces
        .map(|(i, piece)| match i % 2 {
            0 => prose(piece),
            _ => format!("${piece}$"),
        })
        .collect();
    format!(
        "\\cite[{}]{{{KEY}}}{said}",
        place
            .chars()
            .map(|c| symbol_of(c, true))
            .collect::<String>()
    )
}

/// Equations in a row, the first of which has the number `from`.
pub(super) fn displayed(page: &Page, run: &[Block], from: usize, labels: &Labels) -> String {
    let mut rows = Vec::new();
    let mut notes = Vec::new();
    for (i, block) in run.iter().enumerate() {
        let Block::Equation { formula, note, .. } = block else {
            continue;
        };
        let name = labels.name(from + i);
        rows.push((display(page, formula, Dialect::Amsmath), name));
        if let Some(note) = note {
            let note = prose(note);
            notes.push(match run.len() {
                1 => note,
                _ => format!("\\eqref{{{name}}}: {}", lowered(&note)),
            });
        }
    }
    let mut out = match rows.as_slice() {
        [(formula, name)] => {
            format!("\\begin{{equation}}\\label{{{name}}}\n{formula}\n\\end{{equation}}\n")
        }
        _ => {
            let rows = rows
                .iter()
                .map(|(formula, name)| format!("{formula} \\label{{{name}}}"));
            format!(
                "\\begin{{subequations}}\n\\begin{{gather}}\n{}\n\\end{{gather}}\n\\end{{subequations}}\n",
                rows.collect::<Vec<_>>().join(" \\\\\n")
            )
        }
    };
    if !notes.is_empty() {
        let end = if run.len() > 1 { "." } else { "" };
        let notes: Vec<&str> = notes
            .iter()
            .map(|n| match run.len() {
                1 => n.as_str(),
                _ => n.trim_end_matches('.'),
            })
            .collect();
        out.push_str(&format!("\\noindent {}{end}\n", notes.join("; ")));
    }
    out
}

/// A sentence that goes on behind a colon.
fn lowered(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(letters).collect()
}
