//! Values known before an equation is solved, as statements. Takes names and their values; gives the code, the locals
//! of the names, and the same values as a program for later expressions.

use super::expression::{Bindings, program};
use super::names::variable;
use super::step::at;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{Expr, Node, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// Known values and their names.
pub(super) struct PrecomputedValues {
    /// The statements that compute the values.
    pub statements: TokenStream,
    /// The locals of the values.
    pub bindings: Bindings,
    /// The values as a program.
    pub computed: schedule::Program,
}

/// The statements of the known values; `prefix` starts the names of shared subexpressions.
pub(super) fn stated(
    s: &Symbols,
    known: Vec<(SymbolId, Expr)>,
    prefix: &str,
    bindings: &Bindings,
) -> PrecomputedValues {
    let (names, values): (Vec<_>, Vec<Expr>) = known.into_iter().unzip();
    let mut p = schedule::program(s, &values, prefix);
    let (mut out, values) = program(&p, bindings);
    let mut found = bindings.clone();
    let results = std::mem::take(&mut p.results);
    for ((name, result), value) in names.into_iter().zip(results).zip(values) {
        match result.node() {
            // The value already has a local.
            Node::Letter(l) => found.bind(at(name, Shift::HERE), variable(&p.symbols, l.symbol)),
            _ => {
                let local = variable(s, name);
                out.extend(quote!(let #local = #value;));
                p.temporaries.push((name, result));
            }
        }
    }
    PrecomputedValues {
        statements: out,
        bindings: found,
        computed: p,
    }
}
