//! The step of a model whose velocities are found by Newton's method: residual and tangent are
//! both derived, all configurations are solved together.

use super::element::{self, Bundle, Family, family, stack};
use super::expression::{Bindings, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::{at, finish, here, update};
use crate::check::spec::Side;
use crate::derive::{Derivation, lie};
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// Node momenta by the outgoing edge, with everything at the end of the edge written by its start
/// and the velocities, so that the derivative with respect to the velocities is complete.
fn outgoing(d: &Derivation) -> Vec<Expr> {
    let s = &d.letters.symbols;
    let mut forward: Vec<(Letter, Expr)> = Vec::new();
    for c in &d.spec.configurations {
        forward.push((at(c.element, Shift::NEXT), c.update.clone()));
    }
    for a in &d.spec.advected {
        forward.push((at(a.quantity, Shift::NEXT), a.update.clone()));
    }
    let list = d.balances.iter();
    list.map(|b| expr::substitute(s, &b.outgoing, &forward))
        .collect()
}

/// `step`.
pub fn step(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let bodies = d.spec.configurations.len();
    let dimension = element::total(d);
    let bundle = Bundle::of(d);
    let covectors = element::covectors(d);
    let types: Vec<TokenStream> = (0..bodies).map(|i| element::ty(d, i)).collect();
    let elements = bundle.ty(&types);
    let used = Generics::of(d).used();
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let step = variable(s, d.spec.step);
    let (trial, residual, tangent, mu, scale, solved) = (
        names.local("trial"),
        names.local("residual"),
        names.local("tangent"),
        names.local("momenta"),
        names.local("scale"),
        names.local("solved"),
    );
    let momenta = outgoing(d);
    let gradients: Vec<Expr> = d
        .balances
        .iter()
        .map(|b| {
            let forward: Vec<(Letter, Expr)> = d
                .spec
                .advected
                .iter()
                .map(|a| (at(a.quantity, Shift::NEXT), a.update.clone()))
                .collect();
            expr::substitute(s, &b.gradient, &forward)
        })
        .collect();
    // Everything known at the node.
    let mut bindings = Bindings::new();
    let mut needed = letters_of(momenta.iter().chain(&gradients));
    for c in &d.spec.configurations {
        if c.side == Side::Body && family(c) == Family::Rotation {
            needed.push(at(c.element, Shift::HERE));
        }
    }
    let updates: Vec<Expr> = (0..bodies)
        .flat_map(|i| match update(d, i) {
            super::step::Update::Acted { leave, arrive } => vec![leave, arrive],
            super::step::Update::Added(e) | super::step::Update::Brought(e) => vec![e],
        })
        .collect();
    needed.extend(letters_of(&updates));
    let mut all = with_transports(d, &needed, 0);
    all.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let locals = here(d, names, &needed, &mut bindings);
    let velocity = |i: usize| variable(s, d.spec.configurations[i].velocity);
    let velocities: TokenStream = (0..bodies)
        .map(|i| {
            let (w, part) = (velocity(i), bundle.part(quote!(#trial), i));
            quote!(let #w = #part.matrix();)
        })
        .collect();
    // Node momenta.
    let node_momenta: Vec<TokenStream> = (0..bodies)
        .map(|i| {
            let field = per_configuration(d, "momentum", i);
            let c = &d.spec.configurations[i];
            let (element, own) = (variable(s, c.element), own(d, c.element));
            match (c.side, family(c)) {
                (Side::Body, Family::Rotation) => quote!(#element.tr_mul(&state.#field.0)),
                (Side::Body, _) => quote!(state.#field.to_body(&state.#own).0),
                (Side::Spatial, _) => quote!(state.#field.0),
            }
        })
        .collect();
    let node_momenta = bundle.value(&node_momenta);
    // Residual.
    let p = schedule::program(s, &momenta, "t");
    let (lets, values) = program(&p, &bindings);
    let parts: Vec<TokenStream> = values
        .iter()
        .enumerate()
        .map(|(i, v)| {
            let own = bundle.part(quote!(#mu), i);
            quote!((#v) - #own)
        })
        .collect();
    let parts = bundle.value(&parts);
    let stacked = stack(d, quote!(parts));
    let residual_closure = quote! {
        let #residual = |#trial: &#elements| {
            #velocities
            #lets
            let parts: #covectors = #parts;
            #stacked
        };
    };
    // Tangent: the derivative along Ω η for every basis element of every velocity.
    let mut columns = TokenStream::new();
    for j in 0..bodies {
        let w = d.spec.configurations[j].velocity;
        let eta = d.letters.direction[j];
        let group = d.spec.configurations[j].group;
        let change = expr::mul(expr::here(s, w), lie::element(s, group, eta));
        let derivatives: Vec<Expr> = momenta
            .iter()
            .map(|m| expr::directional(s, m, &[(at(w, Shift::HERE), change.clone())]))
            .collect();
        let p = schedule::program(s, &derivatives, "t");
        let (lets, values) = program(&p, &bindings);
        let eta = variable(s, eta);
        let column = if j == 0 {
            quote!(axis)
        } else {
            let offset = element::offset(d, j);
            quote!(#offset + axis)
        };
        let (directions, basis) = (
            element::coordinates(d, j),
            element::basis(d, j, quote!(axis)),
        );
        let values = bundle.value(&values);
        columns.extend(quote! {
            for axis in 0..#directions {
                let #eta = #basis;
                #lets
                let parts: #covectors = #values;
                matrix.set_column(#column, &#stacked);
            }
        });
    }
    let tangent_closure = quote! {
        let #tangent = |#trial: &#elements| {
            #velocities
            let mut matrix = SMatrix::<T, #dimension, #dimension>::zeros();
            #columns
            matrix
        };
    };
    // The natural size of the residual: the momenta and the gradients they are made of.
    let p = schedule::program(s, &gradients, "t");
    let (gradient_lets, gradient_values) = program(&p, &bindings);
    let sizes = gradient_values
        .iter()
        .map(|v| quote!(length(&(#v)).magnitude()));
    let momentum_parts: Vec<TokenStream> =
        (0..bodies).map(|i| bundle.part(quote!(#mu), i)).collect();
    let guess_names: TokenStream = quote! {
        let #trial = &work.guess;
        #velocities
    };
    let guess = quote!(work.guess = #solved;);
    let mut after = bindings.clone();
    let matrices: TokenStream = (0..bodies)
        .map(|i| {
            let w = d.spec.configurations[i].velocity;
            let name = tagged(d, names, w, "matrix");
            after.bind(at(w, Shift::HERE), name.clone());
            let part = bundle.part(quote!(#solved), i);
            quote!(let #name = #part.matrix();)
        })
        .collect();
    let solved_at = |i: usize| bundle.part(quote!(#solved), i);
    let rest = finish(d, names, &mut after, &solved_at, guess);
    let method = format!(" One step, in place. Solved thus: {}.", d.solve.reason);
    quote! {
        #[doc = #method]
        ///
        /// # Errors
        /// When the iteration does not converge, with its residual; the state is then unchanged.
        #[inline]
        pub fn step(&self, state: &mut #state #used, work: &mut #work #used) -> Result<(), StepError> {
            let #step = work.h;
            #parameters
            #locals
            let #mu: #covectors = #node_momenta;
            #residual_closure
            #tangent_closure
            let #scale = {
                #guess_names
                #gradient_lets
                let mut total = 0.0;
                #(total += length(&#momentum_parts).magnitude();)*
                #(total += #sizes;)*
                total
            };
            let #solved = match newton::solve(work.guess, #scale, #residual, #tangent) {
                Ok(found) => found.element,
                Err(e) => return Err(StepCause::from(e).at_node(state.#node)),
            };
            #matrices
            #rest
        }
    }
}
