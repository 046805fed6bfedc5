//! Printers: expressions, formulas and whole documents as plain text, LaTeX, Markdown, MathML or
//! JSON, and expressions as model text. What is printed is always the expression that was written
//! or named, never an expanded normal form.
//!
//! One path serves every format: [`formula`](mod@formula) and [`expr`](crate::expr) trees are composed to a
//! layout (brackets, scripts, fractions; decided once), which each renderer only spells.

mod compose;
pub mod document;
pub mod formula;
mod json;
mod latex;
mod layout;
mod level;
mod lines;
mod listing;
mod markdown;
mod mathml;
mod name;
mod read;
mod statement;
#[cfg(test)]
mod tests;
mod tex;
mod unicode;
mod width;

use crate::expr::Expr;
use crate::expr::symbol::Symbols;
use compose::Composer;
use document::Document;
use formula::Formula;

pub use latex::standalone;
pub use statement::statement;
pub use unicode::lowered;

/// What a document is written in.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Format {
    /// Plain text in Unicode for a terminal.
    Text,
    /// LaTeX with the package amsmath.
    Latex,
    /// Markdown with mathematics as GitHub shows it.
    Markdown,
    /// Markdown with mathematics in MathML, for rustdoc.
    MathMl,
    /// JSON: the structure, with every formula as Unicode, LaTeX and MathML.
    Json,
}

/// How letters and lines are printed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Style {
    /// Name of the time index; letters that live in time bear it as subscript. Empty: no
    /// subscript where the equation stands, only the offset elsewhere.
    pub time_index: String,
    /// Names of the label indices, for rods and particles; empty where a model has none.
    pub label_indices: Vec<String>,
    /// Columns of a line of plain text.
    pub columns: usize,
    /// Points of a displayed line in LaTeX, Markdown and MathML: the width of a page, less the number of an equation.
    pub points: usize,
}

impl Default for Style {
    fn default() -> Self {
        Style {
            time_index: "k".to_owned(),
            label_indices: Vec::new(),
            columns: 100,
            // The lines of the class `article` have 345.
            points: 310,
        }
    }
}

impl Style {
    /// The usual style with this time index.
    pub fn new(time_index: &str) -> Style {
        Style {
            time_index: time_index.to_owned(),
            ..Style::default()
        }
    }
}

/// A whole document, ending in a newline. Equations are numbered from 1 through all sections.
pub fn render(document: &Document, symbols: &Symbols, style: &Style, format: Format) -> String {
    let page = Page { symbols, style };
    let document = &read::for_readers(&page, document.clone()).numbered();
    match format {
        Format::Text => unicode::document(&page, document),
        Format::Latex => latex::document(&page, document),
        Format::Markdown => markdown::document(&page, document, markdown::Math::GitHub),
        Format::MathMl => markdown::document(&page, document, markdown::Math::MathMl),
        Format::Json => json::document(&page, document),
    }
}

/// One expression on one line: plain text; LaTeX for math mode, without dollar signs; Markdown and
/// MathML as they stand inside a sentence; JSON as an object of the three spellings.
pub fn expression(e: &Expr, symbols: &Symbols, style: &Style, format: Format) -> String {
    formula(&Formula::Expr(e.clone()), symbols, style, format)
}

/// One formula on one line, as [`expression`] prints.
pub fn formula(f: &Formula, symbols: &Symbols, style: &Style, format: Format) -> String {
    let page = Page { symbols, style };
    match format {
        Format::Text => unicode::line(&page.linear(f)),
        Format::Latex => latex::line(&page.stacked(f), latex::Dialect::Amsmath),
        Format::Markdown => markdown::inline_math(&page, f, markdown::Math::GitHub),
        Format::MathMl => markdown::inline_math(&page, f, markdown::Math::MathMl),
        Format::Json => json::formula(&page, f),
    }
}

/// Plain text as it stands, in the typewriter face of a format; as it is on a terminal.
pub fn code(text: &str, style: &Style, format: Format) -> String {
    let symbols = Symbols::default();
    let page = Page {
        symbols: &symbols,
        style,
    };
    match format {
        Format::Latex => latex::listing(&page, text),
        Format::Markdown | Format::MathMl => format!("```text\n{text}```\n"),
        Format::Text | Format::Json => text.to_owned(),
    }
}

/// What every renderer needs: the symbols and the style.
struct Page<'a> {
    symbols: &'a Symbols,
    style: &'a Style,
}

impl Page<'_> {
    fn composer(&self, stacked: bool) -> Composer<'_> {
        Composer {
            symbols: self.symbols,
            style: self.style,
            stacked,
        }
    }

    fn compose(&self, f: &Formula, stacked: bool) -> layout::Layout {
        self.composer(stacked).formula(f).layout
    }

    /// Whether an equation says nothing, as `0 = 0` does.
    fn says_nothing(&self, f: &Formula) -> bool {
        self.composer(false).says_nothing(f)
    }

    /// The layout with fractions on the line, `a/b`.
    fn linear(&self, f: &Formula) -> layout::Layout {
        self.compose(f, false)
    }

    /// The layout with numerators above denominators.
    fn stacked(&self, f: &Formula) -> layout::Layout {
        self.compose(f, true)
    }
}
