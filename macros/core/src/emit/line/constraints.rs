//! Functions of a state that report on the constraints of all sites: their residuals and their rates of change.

use super::reactions::{count, count_of, none_moving, none_reached, ring, sides};
use super::step::range_name;
use super::{Lines, number};
use crate::line::ChainConstraint;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The residuals and rates of change of the constraints at a state, over all sites, and the scales for both.
pub(super) fn residual_functions(l: &Lines) -> TokenStream {
    if !l.is_held() {
        return TokenStream::new();
    }
    let (name, state, places, momenta) = (
        l.item(""),
        l.item("State"),
        l.item("Places"),
        l.item("Momenta"),
    );
    let velocities = l.item("Velocities");
    let bodies = l.bodies();
    let (none_moving, none_reached) = (none_moving(l, &bodies), none_reached(l));
    let moved = bodies.iter().map(|b| {
        let field = b.field();
        let [velocity, weight] = ["node_velocity", "weight"].map(|x| format_ident!("{x}_{field}"));
        let (ty, none, count) = (b.response(), b.none(), count_of(l, b));
        let range = b.first().map(range_name);
        let closed = ring(l);
        let around = match closed.to_string() == "false" {
            true => TokenStream::new(),
            false => quote!(if self.is_ring() { velocities.#field[#count] = velocities.#field[0]; }),
        };
        quote! {
            {
                let [first, last] = self.#range();
                let mut weights: Vec<#ty> = ::std::vec![#none; #count + 1];
                line::fill(self.threads, &mut weights[first..last], |i| self.#weight(h, first + i, at));
                line::fill(self.threads, &mut velocities.#field[first..last], |i| self.#velocity(h, first + i, at, momenta, &weights));
                #around
            }
        }
    });
    let moved: Vec<TokenStream> = moved.collect();
    let each = l.holds().map(|(k, h)| {
        let list = format_ident!("held_{k}");
        let [value, rate, size, rate_size] =
            ["constraint", "constraint_rate", "constraint_size", "constraint_rate_size"]
                .map(|x| format_ident!("{x}_{}", h.name));
        let (row, r, count) = (number(l.held_row(h)), number(h.components), count(l, h));
        let [left, right] = sides(l, h);
        let doc = format!(" The residual of `{left} = {right}` at this state: the square root of the sum of squares over all sites.");
        let doc_rate = format!(" The rate of change of the residual of `{left} = {right}`: the square root of the sum of squares over all sites.");
        let sizes = sizes(l, k, h);
        quote! {
            #[doc = #doc]
            pub fn #value(&self, state: &#state<T>) -> T {
                let (at,) = (&state.places,);
                line::sum(#count, |site| {
                    let value = self.#list(site, at).value;
                    value.dot(&value)
                }).sqrt()
            }

            #[doc = #doc_rate]
            pub fn #rate(&self, state: &#state<T>) -> T {
                let mut reached = #none_reached;
                self.reached(&state.places, &mut reached);
                let mut velocities = #none_moving;
                self.velocities_of_node(&state.places, &state.momenta, &mut velocities);
                line::sum(#count, |site| {
                    let value = self.held_rate(site, &reached, &velocities).fixed_rows::<#r>(#row).into_owned();
                    value.dot(&value)
                }).sqrt()
            }

            /// The size of its terms.
            #[doc(hidden)]
            pub fn #size(&self, state: &#state<T>) -> T {
                let (at,) = (&state.places,);
                line::sum(#count, |site| {
                    let size = self.#list(site, at).size;
                    size * size
                }).sqrt()
            }

            /// The size of its terms.
            #[doc(hidden)]
            pub fn #rate_size(&self, state: &#state<T>) -> T {
                let mut reached = #none_reached;
                self.reached(&state.places, &mut reached);
                let mut velocities = #none_moving;
                self.velocities_of_node(&state.places, &state.momenta, &mut velocities);
                line::sum(#count, |site| {
                    let size = #sizes;
                    size * size
                }).sqrt()
            }
        }
    });
    let each: Vec<TokenStream> = match l.holds_sums() {
        true => vec![super::totals::sum_constraint_functions(
            l,
            &none_reached,
            &none_moving,
        )],
        false => each.collect(),
    };
    quote! {
        impl<T: Real> #name<T> {
            /// The velocities that belong to the momenta at a node, in the limit of small steps.
            fn velocities_of_node(&self, at: &#places<T>, momenta: &#momenta<T>, velocities: &mut #velocities<T>) {
                let h = T::one();
                #(#moved)*
            }
            #(#each)*
        }
    }
}

/// The sum of the sizes of the terms of a rate of change.
fn sizes(l: &Lines, k: usize, h: &ChainConstraint) -> TokenStream {
    let bodies = l.bodies();
    let list = format_ident!("held_{k}");
    let each = h.reaches.iter().filter_map(|reach| {
        let b = bodies
            .iter()
            .find(|b| b.members.iter().any(|m| m.mover.name == reach.on))?;
        let [row, rows] = b.rows(&reach.on)?;
        let (body, by, row, rows) = (b.field(), number(reach.site), number(row), number(rows));
        let velocity =
            quote!(length(&velocities.#body[site + #by].fixed_rows::<#rows>(#row).into_owned()));
        let size = super::constraint_kernels::size_of(l, reach, &list);
        Some(quote!(#velocity * #size))
    });
    let each: Vec<TokenStream> = each.collect();
    quote!((#(#each)+*))
}
