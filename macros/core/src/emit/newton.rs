//! The step of a model whose velocities are found by Newton's method: residual and tangent are
//! both derived, all configurations are solved together.

use super::expression::{Bindings, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item, per_configuration, tagged, variable};
use super::step::{at, finish, here, update};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
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
    let (count, dimension) = (
        Literal::usize_unsuffixed(bodies),
        Literal::usize_unsuffixed(3 * bodies),
    );
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
        if c.side == Side::Body {
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
            let (w, i) = (velocity(i), Literal::usize_unsuffixed(i));
            quote!(let #w = #trial[#i].matrix();)
        })
        .collect();
    // Node momenta.
    let node_momenta = (0..bodies).map(|i| {
        let field = per_configuration(d, "momentum", i);
        let c = &d.spec.configurations[i];
        let element = variable(s, c.element);
        match c.side {
            Side::Body => quote!(#element.tr_mul(&state.#field.0)),
            Side::Spatial => quote!(state.#field.0),
        }
    });
    // Residual.
    let p = schedule::program(s, &momenta, "t");
    let (lets, values) = program(&p, &bindings);
    let parts = values.iter().enumerate().map(|(i, v)| {
        let i = Literal::usize_unsuffixed(i);
        quote!((#v) - #mu[#i])
    });
    let stacked = stack(bodies, quote!(parts));
    let residual_closure = quote! {
        let #residual = |#trial: &[Rotation<T>; #count]| {
            #velocities
            #lets
            let parts: [SVector<T, 3>; #count] = [#(#parts),*];
            #stacked
        };
    };
    // Tangent: the derivative along Ω η for every basis element of every velocity.
    let mut columns = TokenStream::new();
    for j in 0..bodies {
        let w = d.spec.configurations[j].velocity;
        let eta = d.letters.direction[j];
        let change = expr::mul(expr::here(s, w), expr::here(s, eta));
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
            let offset = Literal::usize_unsuffixed(3 * j);
            quote!(#offset + axis)
        };
        columns.extend(quote! {
            for axis in 0..3 {
                let #eta = basis::<T>(axis);
                #lets
                let parts: [SVector<T, 3>; #count] = [#(#values),*];
                matrix.set_column(#column, &#stacked);
            }
        });
    }
    let tangent_closure = quote! {
        let #tangent = |#trial: &[Rotation<T>; #count]| {
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
    let indices: Vec<Literal> = (0..bodies).map(Literal::usize_unsuffixed).collect();
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
            let i = Literal::usize_unsuffixed(i);
            quote!(let #name = #solved[#i].matrix();)
        })
        .collect();
    let solved_at = |i: usize| {
        let i = Literal::usize_unsuffixed(i);
        quote!(#solved[#i])
    };
    let rest = finish(d, names, &mut after, &solved_at, guess);
    let method = format!(" One step, in place. Solved thus: {}.", d.solve.reason);
    quote! {
        #[doc = #method]
        ///
        /// # Errors
        /// When the iteration does not converge, with its residual; the state is then unchanged.
        #[inline]
        pub fn step(&self, state: &mut #state<T>, work: &mut #work<T>) -> Result<(), StepError> {
            let #step = work.h;
            #parameters
            #locals
            let #mu: [SVector<T, 3>; #count] = [#(#node_momenta),*];
            #residual_closure
            #tangent_closure
            let #scale = {
                #guess_names
                #gradient_lets
                let mut total = 0.0;
                #(total += length(&#mu[#indices]).magnitude();)*
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

/// Several vectors on top of each other.
pub(super) fn stack(count: usize, parts: TokenStream) -> TokenStream {
    if count == 1 {
        return quote!(#parts[0]);
    }
    let dimension = Literal::usize_unsuffixed(3 * count);
    quote!(SVector::<T, #dimension>::from_fn(|i, _| #parts[i / 3][i % 3]))
}
