//! Lie algebras and their duals for a configuration: its letter of variation as an element of the
//! Lie algebra, and its momentum as the other end of an edge sees it. The groups' own part stands in
//! [`crate::groups`].

use crate::check::spec::Configuration;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::groups::Group;

/// The element of the Lie algebra that a letter of variation stands for.
pub fn element(symbols: &Symbols, group: Group, letter: SymbolId) -> Expr {
    group.element(expr::here(symbols, letter))
}

/// The momentum at the end of an edge as the start of the edge sees it: spatial momenta are one
/// and the same, body momenta are carried by the velocity.
pub fn seen_from_start(symbols: &Symbols, c: &Configuration, covector: Expr) -> Expr {
    if c.side.is_body() {
        let velocity = expr::here(symbols, c.velocity);
        c.group.to_space(symbols, &velocity, covector)
    } else {
        covector
    }
}

/// A letter of variation with the element of the Lie algebra it stands for, to substitute.
pub fn letter(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}
