//! LaTeX: formulas for math mode, and documents as a section of a paper. Only amsmath is required; the output
//! contains only ASCII and Latin letters.

mod characters;
mod equations;
mod sources;

use super::Page;
use super::document::{Block, Document, Inline};
use super::formula::{Formula, Relation};
use super::layout::{Fence, Layout, Sign};
use super::lines::{self, Piece};
use super::listing;
use super::width::{Size, upright, width};
use characters::{identifier, joined, prose, symbol_of, text};
use equations::Labels;
use sources::citing;

pub use sources::standalone;

/// The set of commands to use.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Dialect {
    /// LaTeX with amsmath.
    Amsmath,
    /// The subset that GitHub renders, which rejects `\operatorname`.
    GitHub,
}

/// A layout on one line.
pub(super) fn line(layout: &Layout, dialect: Dialect) -> String {
    let go = |l: &Layout| line(l, dialect);
    match layout {
        Layout::Identifier(s) => identifier(s),
        Layout::Typeset(latex, _) => format!("{{{latex}}}"),
        Layout::Number(s) => s.chars().map(|c| symbol_of(c, false)).collect(),
        Layout::Word(s) => word(s, dialect),
        Layout::Text(s) => format!("\\text{{{}}}", text(s)),
        Layout::Sign(s) => sign(*s),
        Layout::Row(parts) => joined(parts.iter().map(go)),
        Layout::Script { base, sub, sup } => {
            let mut out = match **base {
                Layout::Row(_) | Layout::Script { .. } => format!("{{{}}}", go(base)),
                _ => go(base),
            };
            if let Some(sub) = sub {
                out.push_str(&format!("_{{{}}}", go(sub)));
            }
            if let Some(sup) = sup {
                out.push_str(&format!("^{{{}}}", go(sup)));
            }
            out
        }
        Layout::Fraction(a, b) => format!("\\frac{{{}}}{{{}}}", go(a), go(b)),
        Layout::Root(a) => format!("\\sqrt{{{}}}", go(a)),
        Layout::Hat(a) => {
            let command = match &**a {
                Layout::Identifier(s) if s.chars().count() == 1 => "hat",
                _ => "widehat",
            };
            format!("\\{command}{{{}}}", go(a))
        }
        Layout::Fenced(fence, inner) => {
            let (open, close) = sized(*fence, inner.is_tall());
            joined([open, go(inner), close].into_iter())
        }
        Layout::Grid(rows) => {
            let row = |r: &Vec<Layout>| r.iter().map(go).collect::<Vec<_>>().join(" & ");
            let rows: Vec<String> = rows.iter().map(row).collect();
            format!(
                "\\begin{{pmatrix}} {} \\end{{pmatrix}}",
                rows.join(" \\\\ ")
            )
        }
        Layout::Break(_) => String::new(),
    }
}

fn sign(sign: Sign) -> String {
    let command = match sign {
        Sign::Plus => " + ",
        Sign::Minus => " - ",
        Sign::Negative => "-",
        Sign::Times | Sign::Thin => "\\,",
        Sign::Wide => "\\;",
        Sign::Dot => " \\cdot ",
        Sign::Cross => " \\times ",
        Sign::Diamond => " \\diamond ",
        Sign::Slash => "/",
        Sign::Comma => ", ",
        Sign::Nabla => "\\nabla",
        Sign::Delta => "\\delta ",
        Sign::Sum => "\\sum",
        Sign::Root => "\\surd",
        Sign::Bar => "\\Big|",
        Sign::Star => "*",
        Sign::Wedge => "\\wedge",
        Sign::Apply | Sign::Operand => "",
        Sign::Tight(c) => return symbol_of(c, false),
        Sign::Relation(r) => return format!(" {} ", relation(r)),
    };
    command.to_owned()
}

fn relation(r: Relation) -> &'static str {
    match r {
        Relation::Equal => "=",
        Relation::Defined => ":=",
        Relation::Carried => "\\to",
        Relation::Identical => "\\equiv",
        Relation::Approximate => "\\approx",
        Relation::Member => "\\in",
        Relation::Less => "<",
        Relation::AtMost => "\\le",
        Relation::Greater => ">",
        Relation::AtLeast => "\\ge",
        Relation::Implies => "\\implies",
    }
}

fn brackets(fence: Fence) -> (&'static str, &'static str) {
    match fence {
        Fence::Round => ("(", ")"),
        Fence::Square => ("[", "]"),
        Fence::Angle => ("\\langle", "\\rangle"),
        Fence::Bars => ("\\lvert", "\\rvert"),
    }
}

fn word(s: &str, dialect: Dialect) -> String {
    let escaped = text(s);
    match (s, dialect) {
        ("det" | "exp" | "log" | "sin" | "cos" | "sinh" | "cosh" | "tanh", _) => format!("\\{s}"),
        ("T", _) => "\\mathsf{T}".to_owned(),
        (
            "tr" | "sym" | "skew" | "diag" | "vee" | "hat" | "Ad" | "ad" | "adj" | "sign",
            Dialect::Amsmath,
        ) => {
            format!("\\operatorname{{{escaped}}}")
        }
        // An operator would place its scripts below and above.
        (
            "tr" | "sym" | "skew" | "diag" | "vee" | "hat" | "Ad" | "ad" | "adj" | "sign",
            Dialect::GitHub,
        ) => {
            format!("\\mathop{{\\mathrm{{{escaped}}}}}\\nolimits")
        }
        _ => format!("\\mathrm{{{escaped}}}"),
    }
}

fn pieces(list: &[Piece], dialect: Dialect) -> String {
    let mut parts: Vec<String> = Vec::new();
    let mut rest = list;
    while let Some((piece, after)) = rest.split_first() {
        rest = after;
        match piece {
            Piece::Whole(layout) => parts.push(line(layout, dialect)),
            Piece::Open(fence, tall) => match lines::enclosed(after) {
                Some((inside, beyond)) => {
                    let (open, close) = sized(*fence, *tall);
                    parts.extend([open, pieces(inside, dialect), close]);
                    rest = beyond;
                }
                // `\left` and `\right` must be on the same line.
                None => parts.push(parted("l", brackets(*fence).0, *tall)),
            },
            Piece::Close(fence, tall) => parts.push(parted("r", brackets(*fence).1, *tall)),
            Piece::Break(..) => {}
        }
    }
    joined(parts.into_iter())
}

/// Brackets that scale with their content if it is tall.
fn sized(fence: Fence, tall: bool) -> (String, String) {
    let (open, close) = brackets(fence);
    if tall {
        (format!("\\left{open}"), format!("\\right{close}"))
    } else {
        (open.to_owned(), close.to_owned())
    }
}

/// One bracket of a pair whose brackets are on different lines.
fn parted(side: &str, bracket: &str, tall: bool) -> String {
    let size = if tall { "Bigg" } else { "big" };
    format!("\\{size}{side}{bracket}")
}

/// A displayed formula, in an `aligned` environment if it takes several lines.
pub(super) fn display(page: &Page, f: &Formula, dialect: Dialect) -> String {
    aligned(&rows(page, f, dialect))
}

/// The lines of a formula as one block.
fn aligned(rows: &[String]) -> String {
    match rows {
        [only] => only.clone(),
        several => format!(
            "\\begin{{aligned}}\n{}\n\\end{{aligned}}",
            several.join(" \\\\\n")
        ),
    }
}

/// The lines of a displayed formula; several are aligned at `&`.
fn rows(page: &Page, f: &Formula, dialect: Dialect) -> Vec<String> {
    if let Formula::Rows(parts) = f {
        let layouts: Vec<Layout> = parts.iter().map(|part| page.stacked(part)).collect();
        let groups = lines::group(&layouts, page.style.points);
        let each = groups.iter().flat_map(|part| aligned_rows(part, dialect));
        return each.collect();
    }
    let layout = page.stacked(f);
    match lines::typeset(&layout, page.style.points) {
        Some(broken) => aligned_rows(&broken, dialect),
        None => vec![line(&layout, dialect)],
    }
}

/// Lines with their alignment mark `&`.
fn aligned_rows(broken: &lines::Lines, dialect: Dialect) -> Vec<String> {
    let mut rows = Vec::new();
    for (i, row) in broken.lines.iter().enumerate() {
        let text = pieces(&row.pieces, dialect);
        let left = if i == 0 {
            pieces(&broken.left, dialect)
        } else {
            String::new()
        };
        // `{}` makes the sign at the start of a line a binary operator.
        let start = if i == 0 || row.relation {
            String::new()
        } else {
            "\\quad ".repeat(row.depth + 1) + "{}"
        };
        // A bracket there would be read as an argument of the environment.
        let guard = if left.starts_with('[') { "{}" } else { "" };
        rows.push(format!("{guard}{left} &{start}{text}").trim().to_owned());
    }
    rows
}

/// A whole document: a section with labelled equations. Consecutive equations without words between them share a
/// number.
pub(super) fn document(page: &Page, document: &Document) -> String {
    let mut out = String::new();
    let title = text(&document.title);
    let letters = document.title.chars().map(upright).sum::<usize>();
    // Names of models cannot be hyphenated: a title of several lines is set ragged right.
    out.push_str(
        &match letters * HEADING / 100 > 10 * (page.style.points + NUMBER) {
            true => format!("\\section[{title}]{{\\raggedright {title}}}\n"),
            false => format!("\\section{{{title}}}\n"),
        },
    );
    let labels = Labels::of(page, document);
    let mut number = 1usize;
    for section in &document.sections {
        let title = text(&section.title);
        out.push_str(&match section.appendix {
            true => format!("\n\\subsection*{{Appendix: {}}}\n", title.to_lowercase()),
            false => format!("\n\\subsection{{{title}}}\n"),
        });
        let is_equation = |b: &Block| matches!(b, Block::Equation { .. });
        for run in section
            .blocks
            .chunk_by(|a, b| is_equation(a) && is_equation(b))
        {
            let Some(block) = run.first() else { continue };
            // An empty line before an equation would end its paragraph, and one after it would split a sentence that
            // continues.
            if !is_equation(block) && !goes_on(block) {
                out.push('\n');
            }
            match block {
                Block::Paragraph(parts) => {
                    out.push_str(&format!("{}\n", sentence(page, &labels, parts)))
                }
                Block::List(items) => {
                    // Items begin with names and formulas, which cannot be broken; allow loose lines.
                    out.push_str("\\begin{itemize}\\emergencystretch=3em\n");
                    for item in items {
                        out.push_str(&format!("  \\item{{}} {}\n", sentence(page, &labels, item)));
                    }
                    out.push_str("\\end{itemize}\n");
                }
                Block::Code(code) => out.push_str(&listing(page, code)),
                Block::Equation { .. } => {
                    // The footnote follows the sentence that leads to the equations.
                    let end = out.trim_end_matches('\n').len();
                    out.insert_str(
                        end,
                        &equations::footnote(run, number, &labels, document.work.as_ref()),
                    );
                    out.push_str(&equations::displayed(page, run, number, &labels));
                    number += run.len();
                }
            }
        }
    }
    sources::needs(&out, document.work.as_ref()) + &out
}

/// Width of the larger, bold letters of a heading in percent of text letters, slightly reduced for the section
/// number.
const HEADING: usize = 185;

/// Whether a paragraph continues a sentence, that is, begins with a lower-case letter.
fn goes_on(block: &Block) -> bool {
    let Block::Paragraph(parts) = block else {
        return false;
    };
    matches!(parts.first(), Some(Inline::Plain(words)) if words.starts_with(char::is_lowercase))
}

fn sentence(page: &Page, labels: &Labels, parts: &[Inline]) -> String {
    let mut out = String::new();
    let mut rest = parts.iter().peekable();
    // Length of the punctuation mark that is already part of a formula.
    let mut taken = 0;
    while let Some(part) = rest.next() {
        let before = std::mem::take(&mut taken);
        let said = match part {
            Inline::Plain(words) | Inline::Notation { page: words, .. } => {
                citing(&prose(words.get(before..).unwrap_or_default()))
            }
            Inline::Code(code) => format!("\\texttt{{{}}}", text(code)),
            Inline::Reference { number, .. } => format!("\\eqref{{{}}}", labels.name(*number)),
            Inline::Math(f) => {
                let layout = page.stacked(f);
                if width(&layout, Size::Text) <= 10 * page.style.points * INLINE / 100 {
                    format!("${}$", line(&layout, Dialect::Amsmath))
                } else {
                    let end = match rest.peek() {
                        Some(Inline::Plain(words)) if words.starts_with([',', '.', ';', ':']) => {
                            words.get(..1).unwrap_or_default()
                        }
                        _ => "",
                    };
                    taken = end.len();
                    equations::unnumbered(&rows(page, f, Dialect::Amsmath), end)
                }
            }
        };
        if said.starts_with('\n') {
            out.truncate(out.trim_end_matches(' ').len());
        }
        out.push_str(&said);
    }
    out
}

/// The share of a line, in percent, that inline mathematics may occupy; a longer formula is displayed on its own.
const INLINE: usize = 50;

/// Code in a typewriter face; `verbatim` does not support Greek letters.
pub(super) fn listing(page: &Page, code: &str) -> String {
    // Lines of code do not reserve space for an equation number.
    let limit = 10 * (page.style.points + NUMBER);
    let rows: Vec<String> = listing::fitted(code, limit, &typewriter)
        .iter()
        .map(|row| format!("\\mbox{{{}}}", text(row).replace(' ', "~")))
        .collect();
    format!(
        "\\begin{{flushleft}}\\ttfamily\n{}\n\\end{{flushleft}}\n",
        rows.join("\\\\\n")
    )
}

/// Points reserved for the number of an equation.
const NUMBER: usize = 35;

/// The width of a code character in tenths of a point; a character outside the typewriter face is set as mathematics.
fn typewriter(c: char) -> usize {
    match c {
        '<' | '>' | '|' => 78,
        _ if c.is_ascii() => 53,
        _ => 79,
    }
}
