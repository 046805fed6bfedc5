//! Operator precedence of layouts. All brackets are added here.

use super::layout::{Fence, Layout};

/// Precedence levels, loosest binding first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Level {
    /// Words and lists.
    Loose,
    /// A relation.
    Relation,
    /// A sum.
    Sum,
    /// One term with a minus sign before it.
    Signed,
    /// `a × b`, `a ◇ b`.
    Infix,
    /// `a · b`.
    Dot,
    /// A product.
    Product,
    /// A quotient with a slash.
    Slash,
    /// `Ad*_g μ`, a sum over an index.
    Application,
    /// `∇ℓ`.
    Gradient,
    /// `δa`, `√a`, a fraction.
    Prefix,
    /// A letter, a call, anything in brackets.
    Atom,
}

/// A layout and its precedence.
#[derive(Clone, Debug)]
pub(super) struct RankedLayout {
    pub layout: Layout,
    pub level: Level,
}

impl RankedLayout {
    pub fn new(layout: Layout, level: Level) -> RankedLayout {
        RankedLayout { layout, level }
    }

    pub fn atom(layout: Layout) -> RankedLayout {
        RankedLayout::new(layout, Level::Atom)
    }

    fn bracketed_unless(self, bare: bool) -> Layout {
        if bare {
            self.layout
        } else {
            Layout::fenced(Fence::Round, self.layout)
        }
    }

    /// As a term of a sum, after its sign.
    pub fn term(self) -> Layout {
        let bare = self.level > Level::Signed;
        self.bracketed_unless(bare)
    }

    /// As a factor; only the `last` factor may be open to the right.
    pub fn factor(self, last: bool) -> Layout {
        let bare = match self.level {
            Level::Loose | Level::Relation | Level::Sum | Level::Signed | Level::Infix => false,
            Level::Dot | Level::Product | Level::Slash | Level::Application | Level::Gradient => {
                last
            }
            Level::Prefix | Level::Atom => true,
        };
        self.bracketed_unless(bare)
    }

    /// As an operand of `·`, `×` or `◇`.
    pub fn operand(self) -> Layout {
        let bare = self.level >= Level::Gradient;
        self.bracketed_unless(bare)
    }

    /// As the base of a superscript.
    pub fn base(self) -> Layout {
        let bare = self.level == Level::Atom;
        self.bracketed_unless(bare)
    }

    /// Before a slash.
    pub fn before_slash(self) -> Layout {
        let bare = matches!(self.level, Level::Product | Level::Prefix | Level::Atom);
        self.bracketed_unless(bare)
    }

    /// After a slash.
    pub fn after_slash(self) -> Layout {
        let bare = self.level >= Level::Prefix;
        self.bracketed_unless(bare)
    }

    /// With a superscript.
    pub fn raised(self, sup: Layout) -> RankedLayout {
        RankedLayout::atom(self.base().superscript(sup))
    }
}
