//! `discrete_energy`: how the action of the step between two nodes falls when the step grows.
//! Takes the derived expression; gives a function of two consecutive states.

use super::expression::{Bindings, program};
use super::items::{letters_of, node_locals, parameter_locals, text, with_transports};
use super::names::{Names, item, own, variable};
use super::sizes::Generics;
use super::step::at;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::expr::Shift;
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// The function.
pub fn discrete_energy(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let energy = &d.integrability.discrete_energy;
    let (name, state) = (item(d, ""), item(d, "State"));
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let (before, after) = (names.local("before"), names.local("after"));
    let needed = letters_of([&energy.value]);
    let mut all = with_transports(d, &needed, 0);
    all.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let node = |source: &Ident, level: i8, bindings: &mut Bindings| {
        let element = |i: usize| {
            let e = own(d, d.spec.configurations[i].element);
            quote!(#source.#e.matrix())
        };
        let reference = |id| {
            let r = own(d, id);
            quote!(#source.#r)
        };
        node_locals(d, names, level, &needed, &element, &reference, bindings)
    };
    let here = node(&before, 0, &mut bindings);
    let mut velocities = TokenStream::new();
    for c in &d.spec.configurations {
        let (e, local) = (own(d, c.element), variable(s, c.velocity));
        let value = match c.side {
            Side::Body => quote!((#before.#e.inverse() * #after.#e).matrix()),
            Side::Spatial => quote!((#after.#e * #before.#e.inverse()).matrix()),
        };
        if needed.contains(&at(c.velocity, Shift::HERE)) {
            velocities.extend(quote!(let #local = #value;));
        }
        bindings.bind(at(c.velocity, Shift::HERE), local);
    }
    let next = node(&after, 1, &mut bindings);
    let p = schedule::program(s, std::slice::from_ref(&energy.value), "t");
    let (lets, values) = program(&p, &bindings);
    let (value, step) = (&values[0], variable(s, d.spec.step));
    let (how, why) = d.discrete_energy();
    let doc = format!(
        " The discrete energy of the edge between two consecutive states, `{}`: {how}, since {why}.",
        text(d, &energy.value),
    );
    quote! {
        impl #bound #name #used {
            #[doc = #doc]
            pub fn discrete_energy(
                &self,
                #step: T,
                #before: &#state #used,
                #after: &#state #used,
            ) -> T {
                #parameters
                #here
                #velocities
                #next
                #lets
                #value
            }
        }
    }
}
