//! Moser-Veselov equation that forms a block by itself: its right side and its solution. Takes the configuration and
//! the values of the forces at the node; gives expressions.

use super::element::{Family, family};
use super::left_factor::known_at_nodes;
use super::names::{per_configuration, variable};
use super::sizes::size;
use super::step::node_momentum;
use crate::derive::Derivation;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The step size times the edge momentum, which is the node momentum minus `rest`. If `in_space` is set, `rest` is
/// already the right side, in the frame of space.
pub(super) fn scaled_momentum(
    d: &Derivation,
    i: usize,
    rest: Option<TokenStream>,
    in_space: bool,
    step: &Ident,
) -> TokenStream {
    let c = &d.spec.configurations[i];
    if in_space {
        let (momentum, element) = (
            per_configuration(d, "momentum", i),
            variable(&d.letters.symbols, c.element),
        );
        let acting = rest.map(|acting| quote!(+ (#acting)));
        return quote!((#element.tr_mul(&(state.#momentum.0 #acting)) * #step));
    }
    let at_node = node_momentum(d, i, c.side);
    let minus = rest.map(|rest| quote!(- (#rest)));
    quote!(((#at_node #minus) * #step))
}

/// The solution of a Moser-Veselov equation that forms a block by itself.
pub(super) fn single_body_solution(
    d: &Derivation,
    n: usize,
    i: usize,
    scaled: &TokenStream,
    factor: Option<TokenStream>,
) -> TokenStream {
    let rotations = family(&d.spec.configurations[i]) == Family::Rotation;
    let prepared = format_ident!("factor_{n}");
    match (factor, rotations) {
        (Some(factor), _) => quote!(rotation_at(&(#factor), &#scaled, work.method)),
        (None, true) => quote!(self.#prepared.rotation(&#scaled, work.method)),
        // In a model that also has rotations of space, the chosen method may exist for rotations of space only.
        (None, false) if known_at_nodes(d) => {
            let n = size(&d.letters.symbols, d.spec.configurations[i].group.size());
            quote!(self.#prepared.solve(&skew_part(&#scaled), work.method.serving(#n)))
        }
        (None, false) => quote!(self.#prepared.solve(&skew_part(&#scaled), work.method)),
    }
}
