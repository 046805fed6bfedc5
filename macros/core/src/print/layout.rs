//! The layout of mathematics: what is placed next to, below, above or inside what. Brackets are already decided;
//! renderers write the layout in their own notation.

use super::formula::Relation;

/// A piece of laid-out mathematics.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Layout {
    /// A letter in Unicode, or a name of several letters set as one.
    Identifier(String),
    /// A name with a declared typesetting: its LaTeX, and its layout as far as the commands are known.
    Typeset(String, Box<Layout>),
    /// Digits, or a vulgar fraction.
    Number(String),
    /// An upright word: `tr`, `Id`, `Ad`.
    Word(String),
    /// Words of a sentence.
    Text(String),
    /// An operator or a separator.
    Sign(Sign),
    /// Items next to each other.
    Row(Vec<Layout>),
    /// Scripts on a base.
    Script {
        /// The base.
        base: Box<Layout>,
        /// Subscript.
        sub: Option<Box<Layout>>,
        /// Superscript.
        sup: Option<Box<Layout>>,
    },
    /// Numerator above denominator.
    Fraction(Box<Layout>, Box<Layout>),
    /// A square root.
    Root(Box<Layout>),
    /// A hat on top.
    Hat(Box<Layout>),
    /// A layout in brackets.
    Fenced(Fence, Box<Layout>),
    /// A matrix of entries, row by row, with its brackets.
    Grid(Vec<Vec<Layout>>),
    /// A possible line break.
    Break(Strength),
}

/// Operators and separators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sign {
    Plus,
    Minus,
    /// A minus sign before the first term.
    Negative,
    /// A product, by juxtaposition.
    Times,
    Dot,
    Cross,
    Diamond,
    Slash,
    Comma,
    Nabla,
    Delta,
    Sum,
    /// The root sign without a bar over its argument.
    Root,
    /// The `|` of an evaluation at a point.
    Bar,
    /// The star of a dual.
    Star,
    /// The wedge that replaces a hat over a long argument.
    Wedge,
    /// The space between an operator and its argument.
    Apply,
    /// The space between an operator sign and its operand.
    Operand,
    /// A narrow space.
    Thin,
    /// A space between parts of a sentence.
    Wide,
    /// A sign inside a script, without spaces.
    Tight(char),
    Relation(Relation),
}

/// Brackets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Fence {
    Round,
    Square,
    Angle,
    Bars,
}

/// The kinds of line breaks, in order of preference.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Strength {
    /// Before a relation sign.
    Relation,
    /// Before a plus or minus sign, or after a comma.
    Term,
    /// Before a factor, within a term.
    Factor,
}

impl Layout {
    /// Items in a row; a single item is returned as it is.
    pub fn row(mut parts: Vec<Layout>) -> Layout {
        match (parts.len(), parts.pop()) {
            (1, Some(only)) => only,
            (_, last) => {
                parts.extend(last);
                Layout::Row(parts)
            }
        }
    }

    /// Between brackets.
    pub fn fenced(fence: Fence, inner: Layout) -> Layout {
        Layout::Fenced(fence, Box::new(inner))
    }

    /// With a subscript.
    pub fn subscript(self, sub: Layout) -> Layout {
        Layout::Script {
            base: Box::new(self),
            sub: Some(Box::new(sub)),
            sup: None,
        }
    }

    /// Adds a superscript, next to an existing subscript.
    pub fn superscript(self, sup: Layout) -> Layout {
        let (base, sub) = match self {
            Layout::Script {
                base,
                sub,
                sup: None,
            } => (base, sub),
            already @ Layout::Script { .. } => {
                (Box::new(Layout::fenced(Fence::Round, already)), None)
            }
            plain => (Box::new(plain), None),
        };
        Layout::Script {
            base,
            sub,
            sup: Some(Box::new(sup)),
        }
    }

    /// Whether it is taller than a line of letters.
    pub fn is_tall(&self) -> bool {
        match self {
            Layout::Fraction(..) | Layout::Grid(_) => true,
            Layout::Row(parts) => parts.iter().any(Layout::is_tall),
            Layout::Script { base, .. } => base.is_tall(),
            Layout::Root(a) | Layout::Hat(a) | Layout::Fenced(_, a) | Layout::Typeset(_, a) => {
                a.is_tall()
            }
            Layout::Identifier(_)
            | Layout::Number(_)
            | Layout::Word(_)
            | Layout::Text(_)
            | Layout::Sign(_)
            | Layout::Break(_) => false,
        }
    }
}
