//! Printers of expressions, formulas and whole documents as plain text, LaTeX, Markdown, MathML or JSON, and of
//! expressions as model text. Expressions are printed as they were written or named, never in an expanded normal
//! form.
//!
//! All formats share one path: [`formula`](mod@formula) and [`expr`](crate::expr) trees are composed into a layout,
//! with brackets, scripts and fractions decided, and each renderer only writes the layout.

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

/// The output format of a document.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Format {
    /// Plain text in Unicode for a terminal.
    Text,
    /// LaTeX with amsmath.
    Latex,
    /// Markdown with mathematics for GitHub.
    Markdown,
    /// Markdown with mathematics in MathML, for rustdoc.
    MathMl,
    /// JSON: the structure, with every formula as Unicode, LaTeX and MathML.
    Json,
}

/// How letters and lines are printed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Style {
    /// Name of the time index, the subscript of time-dependent letters. If empty, letters at the node of the equation
    /// do not have a subscript, and other letters show only their offset.
    pub time_index: String,
    /// Names of the label indices, for rods and particles; empty if the model does not have labels.
    pub label_indices: Vec<String>,
    /// Columns in a line of plain text.
    pub columns: usize,
    /// Points in a displayed line in LaTeX, Markdown and MathML: the text width minus the equation number.
    pub points: usize,
}

impl Default for Style {
    fn default() -> Self {
        Style {
            time_index: "k".to_owned(),
            label_indices: Vec::new(),
            columns: 100,
            // Class `article` has lines of 345 points.
            points: 310,
        }
    }
}

impl Style {
    /// The default style with this time index.
    pub fn new(time_index: &str) -> Style {
        Style {
            time_index: time_index.to_owned(),
            ..Style::default()
        }
    }
}

/// Prints a whole document, ending in a newline. Equations are numbered from 1 across all sections.
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

/// Prints one expression on one line: plain text; LaTeX for math mode, without dollar signs; Markdown and MathML as
/// used within a sentence; JSON as an object with the three notations.
pub fn expression(e: &Expr, symbols: &Symbols, style: &Style, format: Format) -> String {
    formula(&Formula::Expr(e.clone()), symbols, style, format)
}

/// Prints one formula on one line, in the formats of [`expression`].
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

/// Preformatted text, in the typewriter face of a format; unchanged in plain text.
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

/// Shared by all renderers: the symbols and the style.
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

    /// Whether an equation is trivial, such as `0 = 0`.
    fn says_nothing(&self, f: &Formula) -> bool {
        self.composer(false).says_nothing(f)
    }

    /// The layout with inline fractions, `a/b`.
    fn linear(&self, f: &Formula) -> layout::Layout {
        self.compose(f, false)
    }

    /// The layout with numerators above denominators.
    fn stacked(&self, f: &Formula) -> layout::Layout {
        self.compose(f, true)
    }
}
