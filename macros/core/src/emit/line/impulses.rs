//! Momenta as scales of the totals of a chain. At equilibrium, neighbour forces cancel, and the momenta are only
//! their rounding errors, which are not a scale. Gives a state whose momenta are at least as large as the impulses at
//! its node.

use super::{Lines, Moving};
use crate::emit::impulses::at_node;
use crate::expr;
use proc_macro2::TokenStream;
use quote::quote;

/// The function; None if no force acts at a node.
pub(super) fn not_less_than_impulses(l: &Lines) -> Option<TokenStream> {
    let each: Vec<TokenStream> = l.moving().filter_map(|m| of_mover(l, &m)).collect();
    if each.is_empty() {
        return None;
    }
    let [name, state, work] = ["", "State", "Workspace"].map(|suffix| l.item(suffix));
    Some(quote! {
        impl<T: Real> #name<T> {
            /// The state with its momenta enlarged to at least the impulses at its node, for the scales of invariants.
            /// The impulses are those of the workspace that reached the state.
            #[doc(hidden)]
            pub fn not_less_than_impulses(&self, state: &#state<T>, work: &#work<T>) -> #state<T> {
                let mut enlarged = state.clone();
                let (at, pulls) = (&state.places, &work.pulls);
                let _ = (at, pulls);
                #(#each)*
                enlarged
            }
        }
    })
}

/// The momenta of one configuration.
fn of_mover(l: &Lines, m: &Moving) -> Option<TokenStream> {
    let d = m.outline();
    let s = &d.letters.symbols;
    let own: Vec<_> = d
        .balances
        .get(m.mover.index)
        .map(|b| at_node(s, &[], b))
        .into_iter()
        .flatten()
        .map(|e| expr::magnitude_by_differences(s, &expr::quaternion_components(s, &d.defined(&e))))
        .collect();
    let (lets, results) = l.computed(s, &l.of_site(d, &own), &own);
    let pulled = l.collected(&m.mover.name).into_iter();
    let sizes: Vec<TokenStream> = results
        .into_iter()
        .chain(pulled.map(|one| quote!(length(&#one))))
        .collect();
    if sizes.is_empty() {
        return None;
    }
    let (name, range) = (m.name(), super::step::range_name(m));
    let (rows, _) = m.dims();
    let step = super::locals::step(d);
    Some(quote! {
        {
            let [first, last] = self.#range();
            let #step = work.h;
            let _ = #step;
            line::fill(self.threads, &mut enlarged.momenta.#name[first..last], |i| {
                let site = first + i;
                #lets
                not_less(state.momenta.#name[site], (0, #rows), #(#sizes)+*)
            });
        }
    })
}
