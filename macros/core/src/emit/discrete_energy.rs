//! `discrete_energy`: the negative derivative of the action of one step, between fixed nodes, with respect to the
//! step size. Takes the derived expression; gives a function of two consecutive states.

use super::between::{Edge, edge_between};
use super::expression::program;
use super::items::text;
use super::names::{Names, item, variable};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

pub fn discrete_energy(d: &Derivation, names: &Names) -> TokenStream {
    // For every action, the discrete energy divides by the step size twice.
    let mut symbols = d.letters.symbols.clone();
    symbols.keep_differences(true);
    let s = &symbols;
    let energy = &d.integrability.discrete_energy;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let (before, after) = (names.local("before"), names.local("after"));
    let wanted = std::slice::from_ref(&energy.value);
    let Edge {
        parameters,
        locals,
        bindings,
    } = edge_between(d, names, wanted, true);
    let p = schedule::program(s, wanted, "t");
    let (lets, values) = program(&p, &bindings);
    let (value, step) = (&values[0], variable(s, d.spec.step));
    let (how, why) = d.discrete_energy();
    let doc = format!(
        " The discrete energy of the edge between two consecutive states, `{}`: {how}, since {why}.",
        text(d, &energy.value),
    );
    quote! {
        #[doc = #doc]
            pub fn discrete_energy(
                &self,
                #step: T,
                #before: &#state #used,
                #after: &#state #used,
            ) -> T {
                #parameters
                #locals
                #lets
                #value
            }
    }
}
