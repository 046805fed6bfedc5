//! A derivation as a document: sections of paragraphs, numbered equations, lists and code.
//! Built by the derivation, printed by the renderers; holds no layout.

use super::formula::Formula;

/// A document on one model.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Document {
    /// Title.
    pub title: String,
    /// Sections in order.
    pub sections: Vec<Section>,
}

/// A section.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Section {
    /// Title.
    pub title: String,
    /// Blocks in order.
    pub blocks: Vec<Block>,
}

/// A block of a section.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Block {
    /// A paragraph.
    Paragraph(Vec<Inline>),
    /// A displayed equation; it is numbered when printed.
    Equation {
        /// What is displayed.
        formula: Formula,
        /// Where it comes from, e.g. `thesis (2.85)`.
        tag: Option<String>,
        /// A remark below it.
        note: Option<String>,
    },
    /// A bulleted list.
    List(Vec<Vec<Inline>>),
    /// Text printed as it is.
    Code(String),
}

/// A part of a sentence. Spaces between parts are written in the plain text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Inline {
    /// Words.
    Plain(String),
    /// Mathematics.
    Math(Formula),
}

impl From<&str> for Inline {
    fn from(text: &str) -> Self {
        Inline::Plain(text.to_owned())
    }
}

impl From<String> for Inline {
    fn from(text: String) -> Self {
        Inline::Plain(text)
    }
}

impl From<Formula> for Inline {
    fn from(formula: Formula) -> Self {
        Inline::Math(formula)
    }
}

impl Document {
    /// An empty document.
    pub fn titled(title: impl Into<String>) -> Document {
        Document {
            title: title.into(),
            sections: Vec::new(),
        }
    }

    /// Opens a section and returns it.
    pub fn section(&mut self, title: impl Into<String>) -> &mut Section {
        self.sections.push_mut(Section {
            title: title.into(),
            blocks: Vec::new(),
        })
    }
}

impl Section {
    /// Adds a paragraph.
    pub fn paragraph(&mut self, parts: impl IntoIterator<Item = Inline>) -> &mut Section {
        self.blocks
            .push(Block::Paragraph(parts.into_iter().collect()));
        self
    }

    /// Adds a paragraph of words only.
    pub fn text(&mut self, words: &str) -> &mut Section {
        self.paragraph([words.into()])
    }

    /// Adds an equation.
    pub fn equation(&mut self, formula: impl Into<Formula>) -> &mut Section {
        self.blocks.push(Block::Equation {
            formula: formula.into(),
            tag: None,
            note: None,
        });
        self
    }

    /// Adds an equation with its source.
    pub fn cited(&mut self, formula: impl Into<Formula>, source: &str) -> &mut Section {
        self.blocks.push(Block::Equation {
            formula: formula.into(),
            tag: Some(source.to_owned()),
            note: None,
        });
        self
    }

    /// Puts a remark below the last block, if that is an equation.
    pub fn noted(&mut self, remark: &str) -> &mut Section {
        if let Some(Block::Equation { note, .. }) = self.blocks.last_mut() {
            *note = Some(remark.to_owned());
        }
        self
    }

    /// Adds a bulleted list.
    pub fn list(&mut self, items: Vec<Vec<Inline>>) -> &mut Section {
        self.blocks.push(Block::List(items));
        self
    }

    /// Adds text that is printed as it is.
    pub fn code(&mut self, text: impl Into<String>) -> &mut Section {
        self.blocks.push(Block::Code(text.into()));
        self
    }
}
