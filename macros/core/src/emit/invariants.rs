//! The derived invariants as functions of the state, with their natural scales.

use super::expression::{Bindings, Writer, program};
use super::items::{letters_of, parameter_locals, text, with_transports};
use super::names::{Names, item, per_configuration, variable};
use super::sizes::Generics;
use super::step::{at, here};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::invariants::{Invariant, Kind};
use crate::expr::{Letter, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// How an invariant is documented.
pub fn formula(d: &Derivation, v: &Invariant) -> String {
    match (&v.kind, &v.value, d.limit.as_ref()) {
        (Kind::SpatialMomentum(i), _, _) => {
            let c = &d.spec.configurations[*i];
            let element = &d.letters.symbols.get(c.element).name;
            match c.side {
                Side::Body => format!("{element} μ"),
                Side::Spatial => "m".to_owned(),
            }
        }
        (Kind::Energy, _, Ok(limit)) if limit.potential.is_zero() => "½ μ·I⁻¹μ".to_owned(),
        (Kind::Energy, _, Ok(limit)) => format!("½ μ·I⁻¹μ + {}", text(d, &limit.potential)),
        (_, Some(value), _) => text(d, value),
        (Kind::Number | Kind::Energy, _, _) => v.name.clone(),
    }
}

/// Locals for the node momenta among the letters.
fn momenta(d: &Derivation, needed: &[Letter], bindings: &mut Bindings) -> TokenStream {
    let mut out = TokenStream::new();
    for (i, (c, id)) in d
        .spec
        .configurations
        .iter()
        .zip(&d.letters.node_momentum)
        .enumerate()
    {
        let letter = at(*id, Shift::HERE);
        if !needed.contains(&letter) {
            continue;
        }
        let name = variable(&d.letters.symbols, *id);
        let method = per_configuration(
            d,
            match c.side {
                Side::Body => "body_momentum",
                Side::Spatial => "spatial_momentum",
            },
            i,
        );
        out.extend(quote!(let #name = state.#method().0;));
        bindings.bind(letter, name);
    }
    out
}

/// One function for every number, the energy, and all values and scales together.
pub fn invariants(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let (name, state) = (item(d, ""), item(d, "State"));
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let mut functions = TokenStream::new();
    for v in &d.invariants {
        let method = format_ident!("{}", v.name);
        let doc = format!(" `{}`: {}.", formula(d, v), v.reason);
        match (&v.kind, &v.value, d.limit.as_ref()) {
            (Kind::SpatialMomentum(_), _, _) => {}
            (Kind::Energy, _, Ok(limit)) => {
                functions.extend(super::energy::energy(d, names, limit))
            }
            (_, Some(value), _) => {
                let needed = letters_of([value]);
                let all = with_transports(d, &needed, 0);
                let parameters = parameter_locals(d, quote!(self.parameters), &all);
                let mut bindings = Bindings::new();
                let locals = here(d, names, &needed, &mut bindings);
                let mu = momenta(d, &needed, &mut bindings);
                let p = schedule::program(s, std::slice::from_ref(value), "t");
                let (lets, values) = program(&p, &bindings);
                let value = &values[0];
                functions.extend(quote! {
                    #[doc = #doc]
                    pub fn #method(&self, state: &#state #used) -> T {
                        #parameters
                        #locals
                        #mu
                        #lets
                        #value
                    }
                });
            }
            (Kind::Number | Kind::Energy, None, _) => {}
        }
    }
    quote!(impl #bound #name #used { #functions })
}

/// The scale of an invariant as a value of type `T`.
pub fn scale(d: &Derivation, names: &Names, v: &Invariant) -> TokenStream {
    let s = &d.letters.symbols;
    let Some(e) = &v.scale else {
        return quote!({
            let (kinetic, potential) = self.model.energies(state);
            kinetic.abs() + potential.abs()
        });
    };
    let needed = letters_of([e]);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.model.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let mu = momenta(d, &needed, &mut bindings);
    let value = Writer {
        symbols: s,
        bindings: &bindings,
    }
    .write(e);
    // Scales are taken on plain numbers.
    quote!({ type T = f64; #parameters #locals #mu let value: T = #value; value })
}
