//! Lays out a derivation as a section of a paper: model, constrained action, variations, Clebsch relations, balance
//! and momentum map, solution of a step, invariants, continuous limit. The result is one document; the printers turn
//! it into text, LaTeX, Markdown, MathML or JSON.

pub mod citations;
mod compose;
mod holds;
mod indexed_notation;
mod lattice;
mod motion;
mod outlook;
mod parts;
mod proof;
mod quaternionic;
mod scheme;
mod sheet;
mod solution;
mod source;
mod structure;

pub use citations::{Citations, Place, Work};
pub use compose::{DocumentExtras, document, document_telling};
pub use lattice::{
    CardWords, InvariantWords, Printed, card_words, default_choice, printed_lattice,
};
pub use proof::proof;
pub use source::source;

use crate::derive::Derivation;
use crate::derive::select_solver::StepEquation;
use crate::expr::Expr;
use crate::expr::symbol::Symbols;
use crate::print::document::Document;
use crate::print::{Format, Style, expression, render};

/// The print style of a model: its time index.
pub fn style(d: &Derivation) -> Style {
    Style::new(&d.spec.time_index)
}

/// Prints the derivation in a format, without citations.
pub fn printed(d: &Derivation, format: Format) -> String {
    printed_telling(d, format, Style::default().columns, Citations::NONE, None)
}

/// Prints the derivation in a format, with `citations` and the model text `stated`, if known. Plain text wraps at
/// `columns` where possible. LaTeX and Markdown begin with the scheme.
pub fn printed_telling(
    d: &Derivation,
    format: Format,
    columns: usize,
    citations: Citations,
    stated: Option<&str>,
) -> String {
    let style = Style {
        columns,
        ..style(d)
    };
    let told = DocumentExtras {
        citations,
        scheme: matches!(format, Format::Latex | Format::Markdown),
        stated,
    };
    let doc = document_telling(d, told);
    paged(doc, &d.letters.symbols, Some(&d.spec.lets), &style, format)
}

/// Prints a document in a format and substitutes the model's `let` names. Every format but text also splits rigid
/// motions and their momenta into parts. Pass `lets: None` for a model with sites.
fn paged(
    doc: Document,
    symbols: &Symbols,
    lets: Option<&[(String, Expr)]>,
    style: &Style,
    format: Format,
) -> String {
    let motions = match format {
        Format::Text => parts::Motions::Whole,
        _ => parts::Motions::InParts,
    };
    let sites = lets.is_none();
    let lets = lets.unwrap_or_default();
    let (doc, symbols) = parts::in_parts(doc, symbols, lets, motions, sites);
    render(&doc, &symbols, style, format)
}

/// A number that changes with the model's text or the engine's version (FNV-1a).
pub fn fingerprint(d: &Derivation) -> u64 {
    let text = format!("{} {}", env!("CARGO_PKG_VERSION"), source(d));
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, b| {
        (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Lines for the model's rustdoc: its own documentation, then the derivation in MathML if `derivation` is set.
pub fn rustdoc(d: &Derivation, derivation: bool) -> Vec<String> {
    let mut lines: Vec<String> = d.spec.docs.clone();
    if derivation {
        lines.push(String::new());
        lines.extend(printed(d, Format::MathMl).lines().map(str::to_owned));
    }
    if lines.is_empty() {
        lines.push(format!(" The model `{}`.", d.spec.name));
    }
    lines
}

/// Summarises the derivation in a few lines of plain text.
pub fn summary(d: &Derivation) -> String {
    let s = &d.letters.symbols;
    let st = style(d);
    let show = |e: &crate::expr::Expr| expression(e, s, &st, Format::Text);
    let show = |e: &crate::expr::Expr| show(&crate::expr::shown(s, e));
    let mut lines = Vec::new();
    if d.spec.scale.is_some() {
        let terms = crate::derive::action::summands(s, &d.spec.lagrangian);
        let physical = crate::expr::sum(terms, crate::expr::shape::Shape::SCALAR);
        lines.push(format!("physical             {}", show(&physical)));
    }
    lines.push(format!("discrete Lagrangian  {}", show(&d.action.total)));
    for (c, m) in d.spec.configurations.iter().zip(&d.momenta) {
        let name = &s.get(c.element).name;
        lines.push(format!("momentum of {name:<8} {}", show(&m.reduced)));
    }
    let riccati = d.solve.riccati.iter();
    let riccati = riccati.map(|r| riccati_words(r, &mut |e| show(e)));
    lines.push(format!(
        "Riccati form         {}",
        riccati.collect::<Vec<_>>().join("; ")
    ));
    let names: Vec<&str> = d.invariants.iter().map(|i| i.name.as_str()).collect();
    lines.push(format!("invariants           {}", names.join(", ")));
    lines.push(format!(
        "time reversal        {}",
        if d.reversible {
            "symmetric: second order"
        } else {
            "not symmetric: first order"
        }
    ));
    lines.push(format!("certificate          {}", d.certificate.summary()));
    lines.join("\n")
}

/// Describes the Riccati form of a balance.
fn riccati_words(r: &StepEquation, show: &mut dyn FnMut(&crate::expr::Expr) -> String) -> String {
    match r {
        StepEquation::Exact(mv) => format!("exact, C = {}", show(&mv.factor)),
        StepEquation::Coupled(mv) => format!("coupled, C = {}", show(&mv.factor)),
        StepEquation::Quaternionic(q) => format!(
            "none; in unit quaternions, A = {}, β = {}",
            show(&q.edge.factor),
            show(&q.real)
        ),
        StepEquation::Linear(form) => format!(
            "none; linear, L = {}, R = {}",
            show(&form.left),
            show(&form.right)
        ),
        StepEquation::None(why) => format!("none: {why}"),
    }
}
