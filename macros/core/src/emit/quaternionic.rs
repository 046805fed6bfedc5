//! The step of a free body in unit quaternions: one scalar equation, and no torque at the node. Takes the derivation;
//! gives `step`.

use super::forced::{body, follow};
use super::names::{Names, own, tagged, variable};
use super::step::step_signature;
use crate::derive::Derivation;
use proc_macro2::TokenStream;
use quote::quote;

/// The step keeps the spatial momentum; the body momentum follows from the velocity.
pub(super) fn free(d: &Derivation, names: &Names) -> TokenStream {
    let c = &d.spec.configurations[0];
    let element = own(d, c.element);
    let next = tagged(d, names, c.element, "next");
    let [edge, solved, node] = ["edge_next", "solved", "node"].map(|base| names.local(base));
    let step = variable(&d.letters.symbols, d.spec.step);
    let (factor, follow) = (body(d), follow(d, names));
    step_signature(
        d,
        quote! {
            #follow
            let #solved = work.edge.free_in_quaternions(#factor, #step, &state.#element);
            let (#next, #edge) = match #solved {
                Ok(next) => next,
                Err(e) => return Err(self.refused(*state, #factor, #step, e)),
            };
            (state.#element, work.here.#element) = (#next, #next);
            state.#node += 1;
            work.edge = #edge;
            Ok(())
        },
    )
}
