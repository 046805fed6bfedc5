//! Terms of an expression: summands at any depth on which the value depends linearly. Dropping a term shows whether
//! it matters; flipping its sign is the smallest sign error.

use super::symbol::Symbols;
use super::{Expr, Map, Node, neg, rebuild, sum, zero};

/// An expression that differs from another by one term.
pub struct Change {
    /// The changed expression.
    pub changed: Expr,
    /// The term.
    pub term: Expr,
    /// Whether its sign was flipped; otherwise it was dropped.
    pub flipped: bool,
}

/// Every way to drop or flip one term. An expression that is not a sum is itself one term.
pub fn changes(symbols: &Symbols, e: &Expr) -> Vec<Change> {
    let mut out = Vec::new();
    collect(symbols, e, true, &mut out);
    out
}

fn collect(symbols: &Symbols, e: &Expr, whole: bool, out: &mut Vec<Change>) {
    let terms = match e.node() {
        Node::Sum(list) => list.clone(),
        _ if whole => vec![e.clone()],
        _ => Vec::new(),
    };
    for (i, term) in terms.iter().enumerate() {
        for (new, flipped) in [(zero(e.shape()), false), (neg(term.clone()), true)] {
            let mut list = terms.clone();
            list[i] = new;
            out.push(Change {
                changed: sum(list, e.shape()),
                term: term.clone(),
                flipped,
            });
        }
    }
    for (i, child) in e.children().into_iter().enumerate() {
        if !is_linear(e, i) {
            continue;
        }
        let mut inner = Vec::new();
        collect(symbols, child, false, &mut inner);
        for c in inner {
            let mut position = 0;
            let changed = rebuild(symbols, e, &mut |x| {
                position += 1;
                if position == i + 1 {
                    c.changed.clone()
                } else {
                    x.clone()
                }
            });
            out.push(Change { changed, ..c });
        }
    }
}

/// Whether the value depends linearly on the child at this position, with the others fixed.
fn is_linear(e: &Expr, child: usize) -> bool {
    match e.node() {
        Node::Sum(_)
        | Node::Neg(_)
        | Node::Product(_)
        | Node::Transpose(_)
        | Node::Trace(_)
        | Node::Dot(..)
        | Node::Cross(..)
        | Node::Hat(_)
        | Node::Vee(_)
        | Node::Part(..)
        | Node::Map(
            Map::Real | Map::Imaginary | Map::Pure | Map::Twist | Map::Diagonal | Map::DiagonalOf,
            _,
        ) => true,
        Node::Quotient(..) => child == 0,
        // Derivatives are linear in their directions and their seed.
        Node::Given(a) | Node::PullBack(a, ..) => child >= a.arguments.len(),
        Node::Number(_)
        | Node::Constant(_)
        | Node::Letter(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Power(..)
        | Node::Inverse(_)
        | Node::Det(_)
        | Node::Adjugate(_)
        | Node::Call(..)
        | Node::Map(Map::Rotation | Map::Translation, _) => false,
    }
}
