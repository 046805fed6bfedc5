//! Prints rigid motions by their parts. An equation between vectors of the Lie algebra or its dual becomes two, for
//! the angular and the linear part; homogeneous coordinates are printed by blocks. `in_parts` adds the letters of the
//! parts to a document and its symbols, and defines each letter where it first occurs. The derivation itself does not
//! change.

mod display;
mod document_scan;
mod lets;
mod letter_definitions;
mod names;
mod points;
mod rigid_motion_patterns;
mod split;
#[cfg(test)]
mod tests;

use crate::expr::symbol::Symbols;
use crate::expr::{Expr, Map, Node};
use crate::print::document::{Block, Document, Inline, Section};
use crate::print::formula::Formula;
use display::Display;
use names::Names;

/// How rigid motions and their momenta are printed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Motions {
    /// As their parts, with a letter for each part.
    InParts,
    /// As single letters.
    Whole,
}

/// Splits a document into parts and substitutes the model's names `lets`; returns it with its symbols. A document
/// without rigid motions and names is returned unchanged. With `sites`, letters are defined at one site for all.
pub fn in_parts(
    doc: Document,
    symbols: &Symbols,
    lets: &[(String, Expr)],
    motions: Motions,
    sites: bool,
) -> (Document, Symbols) {
    let mut concerned = !lets.is_empty();
    if motions == Motions::InParts {
        each_formula(&doc, &mut |f| {
            f.each_expression(&mut |e| concerned |= has_parts(e));
        });
    }
    if !concerned {
        return (doc, symbols.clone());
    }
    let mut page = Display::new(Names::new(symbols, &doc, lets, motions, sites));
    let Document {
        title,
        work,
        remarks,
        sections,
    } = doc;
    let sections = sections.into_iter().map(|s| section(&mut page, s));
    let doc = Document {
        title,
        work,
        remarks,
        sections: sections.collect(),
    };
    (doc, page.names.symbols)
}

/// Whether an expression contains a twist or a zero-padding inclusion.
fn has_parts(e: &Expr) -> bool {
    matches!(e.node(), Node::Inclusion(..) | Node::Map(Map::Twist, _))
        || e.children().into_iter().any(has_parts)
}

/// Visits every formula of a document, in order.
fn each_formula(doc: &Document, visit: &mut dyn FnMut(&Formula)) {
    let blocks = doc.sections.iter().flat_map(|s| &s.blocks);
    blocks.for_each(|block| each_of(block, visit));
}

fn each_of(block: &Block, visit: &mut dyn FnMut(&Formula)) {
    match block {
        Block::Equation { formula, .. } => visit(formula),
        Block::Paragraph(parts) => each_inline(parts, visit),
        Block::List(items) => items.iter().for_each(|i| each_inline(i, visit)),
        Block::Code(_) => {}
    }
}

fn each_inline(parts: &[Inline], visit: &mut dyn FnMut(&Formula)) {
    for part in parts {
        if let Inline::Math(f) = part {
            visit(f);
        }
    }
}

/// Splits a section into parts and defines new letters after the equations where they first occur.
fn section(page: &mut Display, section: Section) -> Section {
    let mut blocks: Vec<Block> = Vec::new();
    for block in section.blocks {
        let equation = matches!(block, Block::Equation { .. });
        // Keep consecutive equations together, and finish a sentence that contains equations first.
        if !equation && !goes_on(&block) {
            blocks.extend(page.names.introduced());
        }
        let block = paged(page, block);
        each_of(&block, &mut |f| page.names.printed(f));
        blocks.push(block);
    }
    blocks.extend(page.names.introduced());
    Section { blocks, ..section }
}

/// Whether a paragraph continues the previous sentence, or already defines its letters.
fn goes_on(block: &Block) -> bool {
    let Block::Paragraph(parts) = block else {
        return false;
    };
    matches!(parts.first(), Some(Inline::Plain(words))
        if words.starts_with(char::is_lowercase) || words.starts_with("Here "))
}

fn paged(page: &mut Display, block: Block) -> Block {
    match block {
        Block::Equation {
            formula,
            tag,
            note,
            label,
        } => Block::Equation {
            formula: page.displayed(&formula),
            tag,
            note,
            label,
        },
        block => block.with_parts(|part| match part {
            Inline::Math(f) => Inline::Math(page.inline(&f)),
            other => other,
        }),
    }
}
