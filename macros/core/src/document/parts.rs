//! A derivation with rigid motions as a page prints it: equations between vectors of the Lie algebra or its
//! dual as two, of the angular and of the linear part; homogeneous coordinates by their blocks. Takes a
//! document and its symbols; gives both with the letters of the parts, each introduced where it first stands.
//! Only what is printed changes.

mod display;
mod found;
mod lets;
mod names;
mod points;
mod read;
mod said;
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
    /// By their parts, in letters of their own.
    InParts,
    /// As they are.
    Whole,
}

/// The same document in parts and with the names of the model, `lets`, with the symbols that it is printed by; as it is
/// where no rigid motion and no name occurs. Letters of many `sites` are introduced at one.
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

/// Whether something in it is of rigid motions or a zero-padding inclusion.
fn has_parts(e: &Expr) -> bool {
    matches!(e.node(), Node::Inclusion(..) | Node::Map(Map::Twist, _))
        || e.children().into_iter().any(has_parts)
}

/// Every formula of a document, in order.
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

/// A section in parts: new letters are introduced behind the equations that hold them first.
fn section(page: &mut Display, section: Section) -> Section {
    let mut blocks: Vec<Block> = Vec::new();
    for block in section.blocks {
        let equation = matches!(block, Block::Equation { .. });
        // Equations in a row stay in a row, and a sentence that an equation stands in is ended first.
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

/// Whether a paragraph goes on with the sentence before, or says what its letters are.
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
