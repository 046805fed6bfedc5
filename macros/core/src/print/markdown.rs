//! Markdown documents, with mathematics in LaTeX as GitHub renders it, or in MathML for rustdoc. Each paragraph is
//! one line, so that a change of a word changes one line.

use super::document::{Block, Document, Inline, plain};
use super::formula::Formula;
use super::latex::{self, Dialect};
use super::{Page, mathml};

/// The notation of mathematics.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Math {
    /// LaTeX between dollar signs and backticks, and in fenced blocks.
    GitHub,
    /// As MathML elements.
    MathMl,
}

/// A formula inside a sentence.
pub(super) fn inline_math(page: &Page, f: &Formula, math: Math) -> String {
    match math {
        Math::GitHub => format!("$`{}`$", latex::line(&page.stacked(f), Dialect::GitHub)),
        Math::MathMl => mathml::inline(page, f),
    }
}

/// A whole document.
pub(super) fn document(page: &Page, document: &Document, math: Math) -> String {
    let mut out = format!("# {}\n", text(&document.title));
    let mut number = 0usize;
    for section in &document.sections {
        out.push_str(&format!("\n## {}\n", text(&section.title)));
        for block in &section.blocks {
            out.push('\n');
            match block {
                Block::Paragraph(parts) => {
                    out.push_str(&format!("{}\n", sentence(page, parts, math)));
                }
                Block::List(items) => {
                    for item in items {
                        out.push_str(&format!("- {}\n", sentence(page, item, math)));
                    }
                }
                Block::Code(code) => out.push_str(&fenced(code, "text")),
                Block::Equation {
                    formula, tag, note, ..
                } => {
                    number += 1;
                    out.push_str(&equation(page, formula, number, math));
                    let tag = tag.as_ref().map(|t| format!("\\[{}\\]", text(&plain(t))));
                    let note = note.as_ref().map(|n| text(n));
                    let remark: Vec<String> = tag.into_iter().chain(note).collect();
                    if !remark.is_empty() {
                        out.push_str(&format!("\n{}\n", remark.join(" ")));
                    }
                }
            }
        }
    }
    out
}

fn equation(page: &Page, f: &Formula, number: usize, math: Math) -> String {
    match math {
        Math::GitHub => {
            let body = latex::display(page, f, Dialect::GitHub);
            fenced(&format!("{body} \\tag{{{number}}}"), "math")
        }
        // A `div` opens a block in which Markdown is not interpreted until the next empty line.
        Math::MathMl => format!(
            "<div style=\"display:flex;align-items:center;overflow-x:auto\">\
             <div style=\"flex:1\">{}</div><span>({number})</span></div>\n",
            mathml::display(page, f)
        ),
    }
}

/// A code block whose fence is longer than any inside it.
fn fenced(code: &str, language: &str) -> String {
    let longest = code.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest.max(2) + 1);
    format!(
        "{fence}{language}\n{}\n{fence}\n",
        code.trim_end_matches('\n')
    )
}

fn sentence(page: &Page, parts: &[Inline], math: Math) -> String {
    parts
        .iter()
        .map(|part| match part {
            Inline::Plain(words) | Inline::Notation { page: words, .. } => text(words),
            Inline::Code(code) => format!("`{}`", code.replace(['`', '\n'], " ")),
            Inline::Reference { number, .. } => format!("({number})"),
            Inline::Math(f) => inline_math(page, f, math),
        })
        .collect()
}

/// Words of a sentence on one line, with Markdown's special characters escaped.
fn text(words: &str) -> String {
    let mut out = String::new();
    for c in words.chars() {
        match c {
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '$' | '|' | '~' | '^' | '&'
            | '!' => {
                out.push('\\');
                out.push(c);
            }
            '\n' | '\t' | '\r' => out.push(' '),
            _ => out.push(c),
        }
    }
    // A sentence must not be read as a list item: `- ...`, `1. ...`.
    let digits = out.chars().take_while(char::is_ascii_digit).count();
    match out.chars().nth(digits) {
        Some('-' | '+') if digits == 0 => format!("\\{out}"),
        Some('.' | ')') if digits > 0 => {
            let (number, rest) = out.split_at(digits);
            format!("{number}\\{rest}")
        }
        _ => out,
    }
}
