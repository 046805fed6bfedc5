//! Displayed equations of a document, single or as a group of consecutive equations under one number. Each has a
//! descriptive label. Sources become footnotes of the preceding sentence.

use super::characters::{prose, spelt, symbol_of};
use super::sources::citing;
use super::{Dialect, aligned, rows};
use crate::expr::symbol;
use crate::print::Page;
use crate::print::document::{Block, Document, Work};
use crate::print::name;
use unicode_normalization::UnicodeNormalization;

/// The LaTeX labels of all equations, by number.
pub(super) struct Labels(Vec<String>);

impl Labels {
    /// Builds labels from the name of the model and the name of the equation, or else from its section and position.
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
                // Two equations may have the same name.
                while names.contains(&name) {
                    name.push('b');
                }
                names.push(name);
            }
        }
        Labels(names)
    }

    /// The label of the equation with this number, counted from 1.
    pub(super) fn name(&self, number: usize) -> &str {
        let name = number.checked_sub(1).and_then(|i| self.0.get(i));
        name.map_or("eq:none", String::as_str)
    }
}

/// The name of an equation: `relation 4` is named after the varied symbol, and the first of a kind omits its number.
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

/// Words as part of a label: ASCII, lower case, with hyphens.
pub(super) fn slug(title: &str) -> String {
    // Accents are dropped, not transcribed.
    let bare: String = title
        .nfd()
        .filter(|c| !matches!(c, '\u{300}'..='\u{36f}'))
        .collect();
    let words = symbol::ascii(&name::letter(&bare)).to_lowercase();
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

/// The footnote with the sources of equations `from`, `from + 1`, ... in a work; empty if there are none.
pub(super) fn footnote(run: &[Block], from: usize, labels: &Labels, work: Option<&Work>) -> String {
    let several = run.len() > 1;
    let sources = run.iter().enumerate().filter_map(|(i, block)| {
        let Block::Equation { tag: Some(tag), .. } = block else {
            return None;
        };
        let source = cited(tag, work);
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

/// Turns `thesis (2.145) corrected: ...` into a citation of the work, followed by the remark.
fn cited(tag: &str, work: Option<&Work>) -> String {
    let place = work.and_then(|w| Some((w.key, tag.strip_prefix(w.named)?.strip_prefix(' ')?)));
    let Some((key, rest)) = place else {
        return said_of(tag);
    };
    let end = rest.find(')').map_or(rest.len(), |at| at + 1);
    let (place, said) = rest.split_at(end);
    let said = match said.strip_prefix(" corrected") {
        Some(how) => format!(", corrected{how}"),
        None => said.to_owned(),
    };
    let said = said_of(&said);
    format!(
        "\\cite[{}]{{{key}}}{said}",
        place
            .chars()
            .map(|c| symbol_of(c, true))
            .collect::<String>()
    )
}

/// Words with mathematics between dollar signs.
fn said_of(tag: &str) -> String {
    let pieces = tag.split('$').enumerate();
    pieces
        .map(|(i, piece)| match i % 2 {
            0 => citing(&prose(piece)),
            _ => format!("${}$", spelt(piece)),
        })
        .collect()
}

/// Consecutive equations, the first of which has the number `from`.
pub(super) fn displayed(page: &Page, run: &[Block], from: usize, labels: &Labels) -> String {
    let mut lines = Vec::new();
    let mut notes = Vec::new();
    for (i, block) in run.iter().enumerate() {
        let Block::Equation { formula, note, .. } = block else {
            continue;
        };
        let name = labels.name(from + i);
        lines.push((rows(page, formula, Dialect::Amsmath), name));
        if let Some(note) = note {
            let note = prose(note);
            notes.push(match run.len() {
                1 => note,
                _ => format!("\\eqref{{{name}}}: {}", lowered(&note)),
            });
        }
    }
    let mut out = match lines.as_slice() {
        [(rows, name)] if rows.len() <= TALL => {
            let formula = aligned(rows);
            format!("\\begin{{equation}}\\label{{{name}}}\n{formula}\n\\end{{equation}}\n")
        }
        [(rows, name)] => format!("{{\\allowdisplaybreaks\n{}}}\n", over_pages(rows, name)),
        several => {
            let groups = several.chunk_by(|a, b| a.0.len().max(b.0.len()) <= TALL);
            let groups: String = groups.map(group).collect();
            let count: usize = several.iter().map(|(rows, _)| rows.len()).sum();
            let breaks = if count > TALL {
                "\\allowdisplaybreaks"
            } else {
                ""
            };
            format!("\\begin{{subequations}}{breaks}\n{groups}\\end{{subequations}}\n")
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

/// A group of equations on separate lines, each short enough for a page, or one longer equation.
fn group(equations: &[(Vec<String>, &str)]) -> String {
    if let [(rows, name)] = equations
        && rows.len() > TALL
    {
        return over_pages(rows, name);
    }
    let rows = equations
        .iter()
        .map(|(rows, name)| format!("{} \\label{{{name}}}", aligned(rows)));
    let rows: Vec<String> = rows.collect();
    format!(
        "\\begin{{gather}}\n{}\n\\end{{gather}}\n",
        rows.join(" \\\\\n")
    )
}

/// A formula with more lines than this may break across pages: a third of a page of fractions.
const TALL: usize = 8;

/// An equation that may break across pages, numbered at its end.
fn over_pages(rows: &[String], name: &str) -> String {
    format!(
        "\\begin{{align}}\n{} \\label{{{name}}}\n\\end{{align}}\n",
        rows.join(" \\notag \\\\\n")
    )
}

/// A formula of a sentence, displayed on lines of its own, with the punctuation mark that follows it.
pub(super) fn unnumbered(rows: &[String], end: &str) -> String {
    match rows.len() <= TALL {
        true => format!("\n\\[\n{}{end}\n\\]\n", aligned(rows)),
        false => format!(
            "\n{{\\allowdisplaybreaks\n\\begin{{align*}}\n{}{end}\n\\end{{align*}}}}\n",
            rows.join(" \\\\\n")
        ),
    }
}

/// A sentence after a colon, in lower case.
fn lowered(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(letters).collect()
}
