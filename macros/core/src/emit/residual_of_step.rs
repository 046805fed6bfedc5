//! `residual`: what a step leaves of its equations. The momentum is carried, so that a bad solve
//! would not show in what is conserved; it shows here.
//! Takes the derivation; gives the function.

use super::expression::{Bindings, program};
use super::items::{letters_of, magnitude, node_locals, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::at;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::lie::IMPULSE;
use crate::derive::parts::rows;
use crate::derive::transport::Transport;
use crate::expr::{self, Expr, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `residual`.
pub(super) fn residual_of_step(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let (name, state) = (item(d, ""), item(d, "State"));
    let (before, after) = (names.local("before"), names.local("after"));
    let step = variable(s, d.spec.step);
    // What the edge brings, in parts that are measured by themselves, and the sizes of their terms.
    let (mut brought, mut sizes, mut carried) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (c, b)) in d.spec.configurations.iter().zip(&d.balances).enumerate() {
        let (field, own) = (per_configuration(d, "momentum", i), own(d, c.element));
        let momentum = match c.side {
            Side::Body => quote!(#after.#field.to_body(&#after.#own).0),
            Side::Spatial => quote!(#after.#field.0),
        };
        match b.incoming.shape() == IMPULSE {
            true => {
                for row in [0, 3] {
                    brought.push(rows(s, &b.incoming, row));
                    let row = Literal::u8_unsuffixed(row);
                    carried.push(quote!(rows_from::<T, 6, 3, 1>(&#momentum, #row)));
                }
            }
            false => {
                brought.push(b.incoming.clone());
                carried.push(momentum);
            }
        }
    }
    sizes.extend(brought.iter().map(|e| magnitude(s, e)));
    let all: Vec<Expr> = brought.iter().chain(&sizes).cloned().collect();
    let mut needed = letters_of(&all);
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        if matches!(t, Transport::Advanced) && needed.contains(&at(a.quantity, Shift::NEXT)) {
            needed.extend(expr::letters(&a.update));
        }
    }
    let mut letters = with_transports(d, &needed, 0);
    letters.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &letters);
    let mut bindings = Bindings::new();
    let mut locals = TokenStream::new();
    for c in &d.spec.configurations {
        let (own, name) = (own(d, c.element), tagged(d, names, c.velocity, "matrix"));
        let value = match c.side {
            Side::Body => quote!((#before.#own.inverse() * #after.#own).matrix()),
            Side::Spatial => quote!((#after.#own * #before.#own.inverse()).matrix()),
        };
        locals.extend(quote!(let #name = #value;));
        bindings.bind(at(c.velocity, Shift::HERE), name);
    }
    for (level, source) in [(0i8, &before), (1, &after)] {
        let element = |i: usize| {
            let e = own(d, d.spec.configurations[i].element);
            quote!(#source.#e.matrix())
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
    let p = schedule::program(s, &all, "t");
    let (lets, values) = program(&p, &bindings);
    let (values, sizes) = values.split_at(brought.len());
    let count = Literal::usize_unsuffixed(brought.len());
    let parts = values.iter().zip(sizes).zip(&carried);
    let parts = parts.map(|((value, size), momentum)| {
        quote! {{
            let momentum = #momentum;
            Residual {
                size: length(&(momentum - (#value))).magnitude(),
                scale: length(&momentum).magnitude() + (#size).magnitude(),
            }
        }}
    });
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    quote! {
        impl #bound #name #used {
            /// What the step of size `h` from one state to the next leaves of its equations: the
            /// momentum that is carried to the second state, less the one that the motion between
            /// them brings there. One part a configuration, angular and linear ones of a rigid
            /// motion apart, each with the size of the terms it is made of.
            pub fn residual(&self, #before: &#state #used, #after: &#state #used, #step: T) -> [Residual; #count] {
                #parameters
                #locals
                #lets
                let _ = #step;
                [#(#parts),*]
            }
        }
    }
}
