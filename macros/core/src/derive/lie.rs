//! Lie algebras and their duals for a configuration: its letter of variation as an element of the Lie algebra, and
//! its momentum transformed to the other end of an edge. The parts that depend on the group are in [`crate::groups`].

use crate::check::spec::Configuration;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::groups::Group;

/// The element of the Lie algebra that a letter of variation denotes.
pub fn element(symbols: &Symbols, group: Group, letter: SymbolId) -> Expr {
    group.element(expr::here(symbols, letter))
}

/// The momentum at the end of an edge, transformed to its start: spatial momenta are unchanged, body momenta are
/// transformed by the velocity.
pub fn seen_from_start(symbols: &Symbols, c: &Configuration, covector: Expr) -> Expr {
    if c.side.is_body() {
        let velocity = expr::here(symbols, c.velocity);
        c.group.to_space(symbols, &velocity, covector)
    } else {
        covector
    }
}

/// The letter of a variation at the current node, for substitutions.
pub fn letter(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}
