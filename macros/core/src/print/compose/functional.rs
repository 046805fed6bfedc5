//! Layouts of functionals and their derivatives: `f(x, y)`, `∇_x f(x, y)`, `Df(x)[u]` and `(Df(x))^T[s]`. A
//! derivative carries the name of its argument if that is a letter, otherwise the number of the argument.

use super::Composer;
use crate::expr::{Applied, Expr, Node};
use crate::print::layout::{Fence, Layout, Sign};
use crate::print::level::{Level, RankedLayout};
use crate::print::tex;

impl Composer<'_> {
    /// A value of a functional, or the pull-back of a seed.
    pub(super) fn functional(&self, a: &Applied, back: Option<(u8, &Expr)>) -> RankedLayout {
        let name = self.functional_name(a);
        let arguments = a.arguments.iter().map(|x| self.expression(x).layout);
        let value = self.applied(name, arguments.collect());
        let whole = |seed: &Expr| matches!(seed.node(), Node::Number(q) if q.is_one());
        let gradient = back.is_some_and(|(_, seed)| whole(seed));
        let mut row = Vec::new();
        for (which, _) in &a.along {
            row.push(self.differential(a, *which, false));
        }
        if let Some((which, _)) = back {
            row.push(self.differential(a, which, gradient));
        }
        if row.is_empty() {
            return value;
        }
        if a.arguments.len() > 1 {
            row.push(Layout::Sign(Sign::Operand));
        }
        row.push(value.layout);
        if !a.along.is_empty() {
            let along = a.along.iter().map(|(_, x)| self.expression(x).layout);
            row.push(Layout::fenced(Fence::Square, self.commas(along.collect())));
        }
        let derivative = RankedLayout::new(Layout::Row(row), Level::Gradient);
        match back {
            Some((_, seed)) if !gradient => {
                let transposed = derivative.raised(super::transposition(false)).layout;
                let seed = Layout::fenced(Fence::Square, self.expression(seed).layout);
                RankedLayout::new(Layout::Row(vec![transposed, seed]), Level::Prefix)
            }
            _ => derivative,
        }
    }

    fn functional_name(&self, a: &Applied) -> Layout {
        let f = self.symbols.functional(a.functional);
        match (self.stacked, &f.typeset) {
            (true, Some(latex)) => Layout::Typeset(latex.clone(), Box::new(tex::layout(latex))),
            _ => self.name(&f.name, None, None),
        }
    }

    /// `D`, or `∇` for a gradient; if there are several arguments, with the one it differentiates by.
    fn differential(&self, a: &Applied, which: u8, gradient: bool) -> Layout {
        let sign = match gradient {
            true => Layout::Sign(Sign::Nabla),
            false => Layout::Word("D".to_owned()),
        };
        if a.arguments.len() < 2 {
            return sign;
        }
        let own = a.arguments.get(usize::from(which));
        let letter = own.and_then(|x| match x.node() {
            Node::Letter(l) => Some(*l),
            _ => None,
        });
        let once = a.arguments.iter().filter(|x| Some(*x) == own).count() == 1;
        sign.subscript(match letter.filter(|_| once) {
            Some(l) => self.letter(l),
            None => Layout::Number((u32::from(which) + 1).to_string()),
        })
    }
}
