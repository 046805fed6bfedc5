//! Prepares a document for human readers: omits trivial equations, and spells names in sentences as in equations,
//! with Greek letters for Greek words.

use super::Page;
use super::document::{Block, Document, Inline, Section};
use super::formula::Formula;
use crate::expr::spelling;
use std::collections::BTreeMap;

/// The document in the form for human readers.
pub(super) fn for_readers(page: &Page, document: Document) -> Document {
    let names = Names::of(page);
    let sections = document.sections.into_iter().map(|section| {
        let blocks = section.blocks.into_iter();
        let blocks = blocks
            .filter_map(|b| telling(page, b))
            .map(|b| names.block(b));
        Section {
            blocks: blocks.collect(),
            ..section
        }
    });
    Document {
        sections: sections.collect(),
        ..document
    }
}

/// The block without trivial equations; `None` if it becomes empty. Equations with a label are kept.
fn telling(page: &Page, block: Block) -> Option<Block> {
    let Block::Equation {
        formula,
        tag,
        note,
        label,
    } = block
    else {
        return Some(block);
    };
    if label.is_none() && page.says_nothing(&formula) {
        return None;
    }
    let formula = match formula {
        Formula::Rows(rows) => {
            let rows = rows.into_iter().filter(|row| !page.says_nothing(row));
            Formula::Rows(rows.collect())
        }
        other => other,
    };
    Some(Block::Equation {
        formula,
        tag,
        note,
        label,
    })
}

/// The sign of a variation before a name.
const VARIATION: char = 'δ';

/// Names of symbols with Greek words, and their spelling in sentences.
struct Names(BTreeMap<String, String>);

impl Names {
    fn of(page: &Page) -> Names {
        let all = page.symbols.ids().map(|id| &page.symbols.get(id).name);
        let spelt = all.map(|name| (name.clone(), spelling::in_words(name)));
        Names(spelt.filter(|(name, spelt)| name != spelt).collect())
    }

    fn block(&self, block: Block) -> Block {
        if self.0.is_empty() {
            return block;
        }
        match block {
            Block::Equation {
                formula,
                tag,
                note,
                label,
            } => Block::Equation {
                formula,
                tag,
                note: note.map(|note| self.words(&note)),
                label,
            },
            block => block.with_parts(|part| match part {
                Inline::Plain(words) => Inline::Plain(self.words(&words)),
                other => other,
            }),
        }
    }

    /// Words in which names are spelt as in equations.
    fn words(&self, words: &str) -> String {
        let mut out = String::new();
        let mut name = String::new();
        for c in words.chars().map(Some).chain([None]) {
            match c {
                Some(c) if c.is_alphanumeric() || c == '_' => name.push(c),
                other => {
                    out.push_str(&self.word(&name));
                    name.clear();
                    out.extend(other);
                }
            }
        }
        out
    }

    /// A word of a sentence, which may be a name or the variation of one.
    fn word(&self, word: &str) -> String {
        let varied = word.strip_prefix(VARIATION).and_then(|of| self.0.get(of));
        match (self.0.get(word), varied) {
            (Some(spelt), _) => spelt.clone(),
            (None, Some(spelt)) => format!("{VARIATION}{spelt}"),
            (None, None) => word.to_owned(),
        }
    }
}
