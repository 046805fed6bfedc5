//! `residual`: what a step leaves of its equations. The momentum is carried, so that a bad solve
//! would not show in what is conserved; it shows here.
//! Takes the derivation; gives the function.

use super::between::{Edge, edge_between};
use super::element;
use super::expression::program;
use super::names::{Names, item, own, per_configuration, variable};
use super::sizes::{Generics, size};
use super::step::at;
use crate::derive::Derivation;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `residual`.
pub(super) fn residual_of_step(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let (before, after) = (names.local("before"), names.local("after"));
    let step = variable(s, d.spec.step);
    // What the edge brings, in parts that are measured by themselves, and the sizes of their terms.
    let (mut brought, mut carried) = (Vec::new(), Vec::new());
    let held = super::holds::left_over(d);
    for (i, (c, b)) in d.spec.configurations.iter().zip(&d.balances).enumerate() {
        let (field, own) = (per_configuration(d, "momentum", i), own(d, c.element));
        let incoming = match held.kicks.get(i) {
            Some(kick) => expr::add(b.incoming.clone(), kick.clone()),
            None => b.incoming.clone(),
        };
        let momentum = if c.side.is_body() {
            quote!(#after.#field.to_body(&#after.#own).0)
        } else {
            element::value(c, quote!(#after.#field.0))
        };
        match c.group.rigid() {
            Some(rigid) => {
                let whole = size(s, c.group.variation().0.rows);
                let [_, (first, count)] = rigid.rows();
                let taken = |of: TokenStream, at: u8, count| {
                    let (at, count) = (Literal::u8_unsuffixed(at), size(s, count));
                    quote!(rows_from::<T, #whole, #count, 1>(&#of, #at))
                };
                for (at, rows) in rigid.rows() {
                    brought.push(expr::taken_rows(s, &incoming, at, rows));
                    // In space the angular part is carried about its origin, with the lever arm.
                    // In the body it gains the moment of its way.
                    let lever = match element::rests(d, i) {
                        None => Some(quote!(length(&#after.#own.translation))),
                        Some(_) if element::is_straight(d, i) => None,
                        Some([rest, _]) => {
                            let velocity = quote! {
                                #before.#own.velocity_between(&#before.#rest, &#after.#own, &#after.#rest)
                            };
                            Some(quote!(length(&#before.#own.way(&#velocity))))
                        }
                    };
                    let arm = lever.filter(|_| at == 0).map(|lever| {
                        let linear = taken(quote!(#after.#field.0), first, count);
                        quote!(.with_arm(#lever * length(&#linear)))
                    });
                    carried.push((taken(momentum.clone(), at, rows), arm));
                }
            }
            None => {
                brought.push(incoming);
                carried.push((element::array(c, momentum), None));
            }
        }
    }
    for (value, zero) in held.values {
        brought.push(value);
        carried.push((zero, None));
    }
    let paths = paths(d);
    let momenta = brought.len() - held.sizes.len();
    let sizes = brought
        .iter()
        .take(momenta)
        .map(|e| expr::magnitude_between(s, e, &paths))
        .chain(held.sizes);
    let all: Vec<Expr> = brought.iter().cloned().chain(sizes).collect();
    let Edge {
        parameters,
        locals,
        mut bindings,
    } = edge_between(d, names, &all, true);
    let arrivals = super::holds::arrivals(d, &after, &mut bindings);
    let p = schedule::program(s, &all, "t");
    let (lets, values) = program(&p, &bindings);
    let (values, sizes) = values.split_at(brought.len());
    let count = Literal::usize_unsuffixed(brought.len());
    let values = values
        .iter()
        .zip(&brought)
        .map(|(value, e)| match e.shape().is_scalar() {
            true => quote!(SVector::<T, 1>::new(#value)),
            false => value.clone(),
        });
    let parts = values.zip(sizes).zip(&carried);
    let parts = parts.map(|((value, size), (momentum, arm))| {
        quote!(Residual::between(&(#momentum), &(#value), #size) #arm)
    });
    let used = Generics::of(d).used();
    quote! {
        /// What a step of `h` leaves of its equations: the momentum carried to the second state, less what the motion
            /// between them brings there. One part a configuration, angular and linear ones of a rigid motion apart, each with
            /// the size of its terms: those of a spatial velocity are the two elements it is made from, as they are stored.
            pub fn residual(&self, #before: &#state #used, #after: &#state #used, #step: T) -> [Residual; #count] {
                #parameters
                #locals
                #arrivals
                #lets
                [#(#parts),*]
            }
    }
}

/// For each velocity of what has a place in one number the distances of its two ends from the origin
/// of space: what is stored is rounded to them.
fn paths(d: &Derivation) -> Vec<(Letter, Expr)> {
    let s = &d.letters.symbols;
    let list = d.spec.configurations.iter();
    list.filter(|c| !element::is_placed(c))
        .filter_map(|c| {
            let size = |shift| {
                let element = expr::letter(s, c.element, shift);
                Some(expr::length(s, &c.group.place(s, &element)?))
            };
            let path = expr::add(size(Shift::HERE)?, size(Shift::NEXT)?);
            Some((at(c.velocity, Shift::HERE), path))
        })
        .collect()
}
