//! The workspace of a model whose velocities are found in several blocks: the searches of Newton's method, the
//! solver, and the forces at the node. Takes the derivation; gives its fields and their values.

use super::blocks::{by_newton, each_newton, search};
use super::force_at_node;
use super::left_factor::default_solver;
use super::names::{Names, item};
use crate::derive::Derivation;
use crate::derive::select_solver::Method;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The fields of the workspace, and its documentation.
pub(super) fn work(d: &Derivation, names: &Names) -> (TokenStream, &'static str) {
    let method = default_solver(d).map(|_| quote!(method: Method,));
    let searches = each_newton(d, names, |n, t| {
        let (field, ty) = (search(n), t.search_type());
        quote!(#field: #ty,)
    });
    let forces = force_at_node::fields(d);
    let forces = forces.iter().map(|(field, ty, _)| quote!(#field: #ty,));
    let forces: TokenStream = forces.collect();
    let doc = match (method.is_some(), searches.is_empty()) {
        (false, true) if !forces.is_empty() => {
            " The step size, and the forces at the node where the step starts."
        }
        (true, true) => " The step size and the solver.",
        (false, _) => {
            " The step size, and the last velocities as initial guesses for the next step."
        }
        (true, false) => {
            " The step size, the solver, and the last velocities as initial guesses for the next step."
        }
    };
    (quote!(#method #(#searches)* #forces), doc)
}

/// The values of those fields. `made` gives the value of each search, and the solver is in a local.
pub(super) fn filled(d: &Derivation, made: impl Fn(usize) -> TokenStream) -> TokenStream {
    let method = default_solver(d).map(|_| quote!(method,));
    let searches = by_newton(d).map(|(n, _)| {
        let (field, value) = (search(n), made(n));
        quote!(#field: #value,)
    });
    let forces = force_at_node::fields(d);
    let forces = forces.iter().map(|(field, _, none)| quote!(#field: #none,));
    quote!(#method #(#searches)* #(#forces)*)
}

/// The initial values of those fields.
pub(super) fn work_init(d: &Derivation) -> TokenStream {
    filled(d, |_| quote!(newton::Search::from_rest()))
}

/// The workspace of a trial step `h` of a model that Newton's method or several blocks solve, with the model's
/// solver. `constructor` is the constructor of each search.
pub(super) fn trial(d: &Derivation, constructor: &str) -> TokenStream {
    let work = item(d, "Workspace");
    let constructor = format_ident!("{constructor}");
    let made = quote!(newton::Search::#constructor());
    if matches!(d.solve.method, Method::Newton) {
        return quote!(#work { h, search: #made });
    }
    let method = default_solver(d).map(|_| quote!(let method = self.method;));
    let fields = filled(d, |_| made.clone());
    match method {
        Some(method) => quote!({ #method #work { h, #fields } }),
        None => quote!(#work { h, #fields }),
    }
}
