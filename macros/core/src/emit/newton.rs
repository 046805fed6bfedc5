//! The step of a model whose velocities are found by Newton's method: residual and tangent are
//! both derived, all configurations are solved together.

use super::element::{self, Bundle, Family, family};
use super::equations::Equations;
use super::expression::{Bindings, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::{at, finish, here};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::carry::Carry;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// Node momenta by the outgoing edge, with everything at the end of the edge written by its start
/// and the velocities, so that the derivative with respect to the velocities is complete.
fn outgoing(d: &Derivation) -> Vec<Expr> {
    let forward = d.spec.end_of_edge();
    let list = d.balances.iter();
    list.map(|b| expr::substitute(&d.letters.symbols, &b.outgoing, &forward))
        .collect()
}

/// `step`.
pub fn step(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let bodies = d.spec.configurations.len();
    let bundle = Bundle::of(d);
    let types: Vec<TokenStream> = (0..bodies).map(|i| element::ty(d, i)).collect();
    let elements = bundle.ty(&types);
    let used = Generics::of(d).used();
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let step = variable(s, d.spec.step);
    let (trial, mu, momentum, newton, found, solved) = (
        names.local("trial"),
        names.local("momenta"),
        names.local("momentum"),
        names.local("iteration"),
        names.local("found"),
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
    needed.extend(letters_of(d.carries.iter().flat_map(Carry::parts)));
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
    let solved_for = Equations {
        d,
        names,
        bindings: &bindings,
        trial: &trial,
        momenta: &mu,
    };
    let (known, equations) = solved_for.write(&momenta, &node_momenta);
    let (at_trial, residual_body, tangent_body) =
        (equations.at_trial, equations.residual, equations.tangent);
    // The natural size of the residual: the momenta and the gradients they are made of.
    let p = schedule::program(s, &gradients, "t");
    let (gradient_lets, gradient_values) = program(&p, &bindings);
    let sizes = gradient_values
        .iter()
        .map(|v| quote!(length(&(#v)).magnitude()));
    let momentum_parts = &equations.momenta;
    let remembered = quote!(work.search.remember(state.#node - 1, &#found););
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
    let configurations = d.spec.configurations.iter().map(|c| &s.get(c.element).name);
    let solved_at = |i: usize| bundle.part(quote!(#solved), i);
    let rest = finish(d, names, &mut after, &solved_at, remembered);
    let head = super::domain::step_head(d);
    let method = format!(" One step, in place. Solved thus: {}.", d.how_solved());
    quote! {
        #[doc = #method]
        ///
        /// # Errors
        /// When the iteration does not converge: which equation is worst, and which step could be
        /// solved; the state is then unchanged.
        #[inline]
        #head(&self, state: &mut #state #used, work: &mut #work #used) -> Result<(), StepError> {
            let #step = work.h;
            #parameters
            #locals
            #known
            let #momentum = #(size_of(&#momentum_parts))+*;
            let mut #newton = work.search.begin(state.#node, #momentum);
            let #found: newton::Solved<#elements> = loop {
                let #trial = #newton.trial();
                if #newton.wants_scale() {
                    #velocities
                    #gradient_lets
                    #newton.set_scale(#(#sizes)+*);
                }
                #at_trial
                if #newton.assess({ #residual_body }) {
                    #newton.set_tangent(&{ #tangent_body });
                }
                match #newton.correct() {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(solved) => break solved,
                    newton::Progress::Failed(e) => return Err(self.refused(*state, #step, e)),
                }
            };
            let #solved = #found.element;
            #matrices
            #rest
        }

        /// Says which equation is worst, and which step could be solved.
        #[cold]
        #[inline(never)]
        fn refused(&self, state: #state #used, h: T, e: newton::NewtonError) -> StepError {
            let e = e.explained(h, &[#(#configurations),*], |h| {
                let (mut trial, search) = (state, newton::Search::to_try());
                self.step(&mut trial, &mut #work { h, search })
            });
            StepCause::from(e).at_node(state.#node)
        }
    }
}
