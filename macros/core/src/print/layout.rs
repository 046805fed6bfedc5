//! The layout of mathematics: what stands beside, below, above or inside what. Brackets are
//! already decided; renderers spell it in their own signs.

use super::formula::Relation;

/// A piece of laid-out mathematics.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Layout {
    /// A letter in Unicode, or a name of several letters set as one.
    Identifier(String),
    /// A name that its declaration typesets: in LaTeX, and as far as its signs are known.
    Typeset(String, Box<Layout>),
    /// Digits, or a vulgar fraction.
    Number(String),
    /// An upright word: `tr`, `Id`, `Ad`.
    Word(String),
    /// Words of a sentence.
    Text(String),
    /// An operator or a separator.
    Sign(Sign),
    /// Side by side.
    Row(Vec<Layout>),
    /// Scripts on a base.
    Script {
        /// What carries them.
        base: Box<Layout>,
        /// Below right.
        sub: Option<Box<Layout>>,
        /// Above right.
        sup: Option<Box<Layout>>,
    },
    /// Numerator above denominator.
    Fraction(Box<Layout>, Box<Layout>),
    /// A square root.
    Root(Box<Layout>),
    /// A hat on top.
    Hat(Box<Layout>),
    /// Between brackets.
    Fenced(Fence, Box<Layout>),
    /// A matrix of entries, row by row, in its brackets.
    Grid(Vec<Vec<Layout>>),
    /// A place where a long line may break.
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
    /// The root sign where there is no bar over its argument.
    Root,
    /// `|` of an evaluation at a point.
    Bar,
    /// The star of a dual.
    Star,
    /// The wedge of a hat that is too long to be drawn.
    Wedge,
    /// The space between an operator and its argument.
    Apply,
    /// The space between an operator sign and what it acts on.
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

/// Which break of a line is taken first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Strength {
    /// Before a relation sign.
    Relation,
    /// Before a plus or minus, after a comma.
    Term,
    /// Before a further factor: where no term ends.
    Factor,
}

impl Layout {
    /// Side by side; one alone stays itself.
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

    /// With a superscript, beside the subscript if there is one.
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

    /// Whether it is higher than a line of letters.
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
