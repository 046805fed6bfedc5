//! The letters of an edge, computed from the states at its two ends. Takes expressions of an edge; gives the
//! parameters, the statements that bind their letters, and the bindings.

use super::element;
use super::expression::Bindings;
use super::items::{advanced, letters_of, node_locals, parameter_locals, with_transports};
use super::names::{Names, own, tagged, variable};
use super::step::at;
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::expr::{self, Expr, Shift};
use proc_macro2::TokenStream;
use quote::quote;

/// The code that precedes the evaluation of expressions of an edge.
pub(super) struct Edge {
    pub(super) parameters: TokenStream,
    pub(super) locals: TokenStream,
    pub(super) bindings: Bindings,
}

/// Binds the letters of `wanted` to the states named `before` and `after`. Velocities are computed from the elements
/// of both states. If `asks` is set, advected quantities come from the model's own functions.
pub(super) fn edge_between(d: &Derivation, names: &Names, wanted: &[Expr], asks: bool) -> Edge {
    let (before, after) = (names.local("before"), names.local("after"));
    let mut needed = letters_of(wanted);
    for a in advanced(d) {
        if needed.contains(&at(a.quantity, Shift::NEXT)) {
            needed.extend(expr::letters(&a.update));
        }
    }
    let mut asked = TokenStream::new();
    let mut bindings = Bindings::new();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        for (shift, state) in [(Shift::HERE, &before), (Shift::NEXT, &after)] {
            let letter = at(a.quantity, shift);
            if !asks || !needed.contains(&letter) || matches!(t, AdvectionRule::Advanced) {
                continue;
            }
            let function = own(d, a.quantity);
            let local = match shift {
                Shift::NEXT => tagged(d, names, a.quantity, "next"),
                _ => variable(&d.letters.symbols, a.quantity),
            };
            asked.extend(quote!(let #local = self.#function(#state);));
            bindings.bind(letter, local);
            needed.retain(|l| *l != letter);
        }
    }
    let mut all = with_transports(d, &needed, 0);
    all.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    // A quantity that its constraint advances may depend on the other advected quantities.
    let mut locals = asked;
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let (own, name) = (own(d, c.element), tagged(d, names, c.velocity, "matrix"));
        let velocity = element::velocity_between(c);
        let value = match element::rests(d, i) {
            Some([rest, _]) => quote! {
                #before.#own.velocity_between(&#before.#rest, &#after.#own, &#after.#rest)
            },
            None => quote!(#before.#own.#velocity(&#after.#own)),
        };
        let value = element::matrix(c, value);
        locals.extend(quote!(let #name = #value;));
        bindings.bind(at(c.velocity, Shift::HERE), name);
    }
    for (level, source) in [(0i8, &before), (1, &after)] {
        let element = |i: usize| {
            let c = &d.spec.configurations[i];
            let e = own(d, c.element);
            element::matrix(c, quote!(#source.#e))
        };
        let reference = |id| {
            let r = own(d, id);
            quote!(#before.#r)
        };
        locals.extend(node_locals(
            d,
            names,
            level,
            &needed,
            &element,
            &reference,
            &mut bindings,
        ));
    }
    Edge {
        parameters,
        locals,
        bindings,
    }
}
