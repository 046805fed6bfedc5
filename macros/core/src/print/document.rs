//! A derivation as a document: sections of paragraphs, numbered equations, lists and code. The derivation builds it
//! and the renderers print it; it does not contain layout.

use super::formula::Formula;

/// A document about one model.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Document {
    /// Title.
    pub title: String,
    /// The work that the sources of equations refer to.
    pub work: Option<Work>,
    /// Warnings about the model as data, for programs that read documents.
    pub remarks: Vec<Remark>,
    /// Sections in order.
    pub sections: Vec<Section>,
}

/// A cited work, with its bibliography entries.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Work {
    /// Its name in sentences: `thesis` in `thesis (2.85)`.
    pub named: &'static str,
    /// Its key for `\cite`.
    pub key: &'static str,
    /// Its BibTeX entry.
    pub entry: &'static str,
    /// Its text in `thebibliography`.
    pub item: &'static str,
}

/// A remark on a model, with its position in the model's text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Remark {
    /// A topic word that is stable across versions.
    pub topic: &'static str,
    /// The problem.
    pub message: String,
    /// Suggested fixes.
    pub help: Vec<String>,
    /// Line and column in the text of the model, counted from 1, if known.
    pub at: (usize, usize),
}

/// A section.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Section {
    /// Title.
    pub title: String,
    /// Whether it belongs in an appendix.
    pub appendix: bool,
    /// Blocks in order.
    pub blocks: Vec<Block>,
}

/// A block of a section.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Block {
    /// A paragraph.
    Paragraph(Vec<Inline>),
    /// A displayed equation; printing numbers it.
    Equation {
        /// The formula.
        formula: Formula,
        /// Its source, e.g. `thesis (2.85)`; text between dollar signs is mathematics.
        tag: Option<String>,
        /// A remark below it.
        note: Option<String>,
        /// The label by which [`Inline::Reference`] refers to it.
        label: Option<String>,
    },
    /// A bulleted list.
    List(Vec<Vec<Inline>>),
    /// Preformatted text.
    Code(String),
}

/// A part of a sentence. `Plain` text includes the spaces between parts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Inline {
    /// Words.
    Plain(String),
    /// Code from a model's text.
    Code(String),
    /// Words on notation that differs between plain text and typeset formats.
    Notation {
        /// In plain text.
        line: String,
        /// In typeset formats.
        page: String,
    },
    /// Mathematics.
    Math(Formula),
    /// The number of an equation.
    Reference {
        /// Its label.
        label: String,
        /// Its number; 0 until the document is numbered.
        number: usize,
    },
}

/// The source of an equation as plain words.
pub(super) fn plain(tag: &str) -> String {
    tag.replace('$', "")
}

impl Block {
    /// Applies `change` to every part of the block's sentences. Equations and code stay unchanged.
    #[must_use]
    pub fn with_parts(self, mut change: impl FnMut(Inline) -> Inline) -> Block {
        let mut sentence =
            |parts: Vec<Inline>| -> Vec<Inline> { parts.into_iter().map(&mut change).collect() };
        match self {
            Block::Paragraph(parts) => Block::Paragraph(sentence(parts)),
            Block::List(items) => Block::List(items.into_iter().map(sentence).collect()),
            other => other,
        }
    }
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

impl Inline {
    /// Parses a sentence in which text between backticks is code.
    pub fn marked(text: &str) -> Vec<Inline> {
        let pieces = text.split('`').enumerate();
        pieces
            .filter(|(_, piece)| !piece.is_empty())
            .map(|(i, piece)| match i % 2 {
                0 => Inline::Plain(piece.to_owned()),
                _ => Inline::Code(piece.to_owned()),
            })
            .collect()
    }

    /// Parses a sentence in which a name between dollar signs is mathematics; the name may have a minus sign.
    pub fn with_names(text: &str) -> Vec<Inline> {
        let name = |piece: &str| match piece.strip_prefix('-') {
            Some(rest) => Formula::neg(Formula::name(rest)),
            None => Formula::name(piece),
        };
        let pieces = text.split('$').enumerate();
        pieces
            .map(|(i, piece)| match i % 2 {
                0 => Inline::Plain(piece.to_owned()),
                _ => Inline::Math(name(piece)),
            })
            .collect()
    }

    /// A reference to the equation with this label.
    pub fn reference(label: &str) -> Inline {
        Inline::Reference {
            label: label.to_owned(),
            number: 0,
        }
    }
}

impl Document {
    /// Fills the equation numbers into the references.
    pub fn numbered(&self) -> Document {
        let equations = self.sections.iter().flat_map(|s| &s.blocks);
        let labels: Vec<Option<&String>> = equations
            .filter_map(|b| match b {
                Block::Equation { label, .. } => Some(label.as_ref()),
                Block::Paragraph(_) | Block::List(_) | Block::Code(_) => None,
            })
            .collect();
        let number_of = |wanted: &String| {
            let place = labels.iter().position(|l| *l == Some(wanted));
            place.map_or(0, |i| i + 1)
        };
        let fill = |parts: &mut Vec<Inline>| {
            for part in parts {
                if let Inline::Reference { label, number } = part {
                    *number = number_of(label);
                }
            }
        };
        let mut out = self.clone();
        for block in out.sections.iter_mut().flat_map(|s| &mut s.blocks) {
            match block {
                Block::Paragraph(parts) => fill(parts),
                Block::List(items) => items.iter_mut().for_each(fill),
                Block::Equation { .. } | Block::Code(_) => {}
            }
        }
        out
    }

    /// An empty document.
    pub fn titled(title: impl Into<String>) -> Document {
        Document {
            title: title.into(),
            work: None,
            remarks: Vec::new(),
            sections: Vec::new(),
        }
    }

    /// Opens a section and returns it.
    pub fn section(&mut self, title: impl Into<String>) -> &mut Section {
        self.sections.push_mut(Section {
            title: title.into(),
            appendix: false,
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

    /// Adds a paragraph of plain words.
    pub fn text(&mut self, words: &str) -> &mut Section {
        self.paragraph([words.into()])
    }

    /// Adds an equation.
    pub fn equation(&mut self, formula: impl Into<Formula>) -> &mut Section {
        self.blocks.push(Block::Equation {
            formula: formula.into(),
            tag: None,
            note: None,
            label: None,
        });
        self
    }

    /// Adds an equation with its source.
    pub fn cited(&mut self, formula: impl Into<Formula>, source: &str) -> &mut Section {
        self.blocks.push(Block::Equation {
            formula: formula.into(),
            tag: Some(source.to_owned()),
            note: None,
            label: None,
        });
        self
    }

    /// Adds a remark to the last block, if that block is an equation.
    pub fn noted(&mut self, remark: &str) -> &mut Section {
        if let Some(Block::Equation { note, .. }) = self.blocks.last_mut() {
            *note = Some(remark.to_owned());
        }
        self
    }

    /// Sets the reference label of the last block, if that block is an equation.
    pub fn labelled(&mut self, name: &str) -> &mut Section {
        if let Some(Block::Equation { label, .. }) = self.blocks.last_mut() {
            *label = Some(name.to_owned());
        }
        self
    }

    /// Adds an equation, with its source if there is one.
    pub fn sourced(&mut self, formula: impl Into<Formula>, source: Option<String>) -> &mut Section {
        match source {
            Some(source) => self.cited(formula, &source),
            None => self.equation(formula),
        }
    }

    /// Adds a bulleted list.
    pub fn list(&mut self, items: Vec<Vec<Inline>>) -> &mut Section {
        self.blocks.push(Block::List(items));
        self
    }

    /// Adds preformatted text.
    pub fn code(&mut self, text: impl Into<String>) -> &mut Section {
        self.blocks.push(Block::Code(text.into()));
        self
    }
}
