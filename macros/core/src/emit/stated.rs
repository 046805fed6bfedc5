//! What is known before an equation is solved, as statements. Takes names and their values; gives the code, where each
//! is found, and the same as a program, for what is computed after.

use super::expression::{Bindings, program};
use super::names::variable;
use super::step::at;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{Expr, Node, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// What is known under names.
pub(super) struct Stated {
    /// The statements that compute it.
    pub statements: TokenStream,
    /// Where it is found.
    pub bindings: Bindings,
    /// The same as a program.
    pub computed: schedule::Program,
}

/// The statements of what is known; `prefix` starts the names of what is shared.
pub(super) fn stated(
    s: &Symbols,
    known: Vec<(SymbolId, Expr)>,
    prefix: &str,
    bindings: &Bindings,
) -> Stated {
    let (names, values): (Vec<_>, Vec<Expr>) = known.into_iter().unzip();
    let mut p = schedule::program(s, &values, prefix);
    let (mut out, values) = program(&p, bindings);
    let mut found = bindings.clone();
    let results = std::mem::take(&mut p.results);
    for ((name, result), value) in names.into_iter().zip(results).zip(values) {
        match result.node() {
            // Another name for what has one already.
            Node::Letter(l) => found.bind(at(name, Shift::HERE), variable(&p.symbols, l.symbol)),
            _ => {
                let local = variable(s, name);
                out.extend(quote!(let #local = #value;));
                p.temporaries.push((name, result));
            }
        }
    }
    Stated {
        statements: out,
        bindings: found,
        computed: p,
    }
}
