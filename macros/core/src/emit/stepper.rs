//! The model as something that steps: the traits on which compositions of high order and ensembles are
//! written. Takes the derivation; gives the implementations.

use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::derive::recognise::Method;
use proc_macro2::TokenStream;
use quote::quote;

/// Whether the stepper's order is chosen by modified moments.
pub(super) fn preprocessed(d: &Derivation) -> bool {
    matches!(d.solve.method, Method::FreeMoserVeselov)
}

/// `Stepper`, and `Reversible` where the derivation has shown it.
pub fn traits(d: &Derivation, names: &Names) -> TokenStream {
    let (name, state, work) = (item(d, ""), item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let many = preprocessed(d).then(|| {
        let element = own(d, d.spec.configurations[0].element);
        let momentum = per_configuration(d, "momentum", 0);
        quote! {
            #[inline(always)]
            fn advance_many(&self, state: &mut Self::State, work: &mut Self::Workspace, count: u64) -> Result<(), StepError> {
                if let Err(e) = work.solver.follow_many(&mut state.#element, &state.#momentum, count) {
                    return Err(StepCause::from(e).at_node(state.#node));
                }
                state.#node += count;
                Ok(())
            }
        }
    });
    // Lanes side by side pass by what is tested after a step.
    let forced =
        matches!(d.solve.method, Method::ForcedMoserVeselov) && !super::domain::is_guarded(d);
    let lanes = forced.then(|| super::forced::side_by_side(d, names));
    let many = many.or_else(|| {
        forced.then(|| {
            quote! {
                #[inline(always)]
                fn advance_many(&self, state: &mut Self::State, work: &mut Self::Workspace, count: u64) -> Result<(), StepError> {
                    if T::LANES > 1 {
                        return advance_side_by_side(self, state, work, count);
                    }
                    for _ in 0..count {
                        self.step(state, work)?;
                    }
                    Ok(())
                }
            }
        })
    });
    let attempt = matches!(d.solve.method, Method::Newton | Method::Blocks).then(|| {
        let trial = super::blocks::trial(d, "to_try");
        quote! {
            #[cold]
            fn attempt(&self, state: &Self::State, h: T) -> Option<Self::State> {
                let mut moving = *state;
                self.step(&mut moving, &mut #trial).ok()?;
                Some(moving)
            }
        }
    });
    let reversible = d
        .reversible
        .then(|| quote!(impl #bound Reversible for #name #used {}));
    quote! {
        impl #bound Stepper for #name #used {
            type Scalar = T;
            type State = #state #used;
            type Workspace = #work #used;
            fn workspace(&self, state: &Self::State, h: T) -> Result<Self::Workspace, StartError> {
                self.prepare(state, h, Default::default())
            }
            #[inline(always)]
            fn advance(&self, state: &mut Self::State, work: &mut Self::Workspace) -> Result<(), StepError> {
                self.step(state, work)
            }
            #attempt
            #many
            fn node(state: &Self::State) -> u64 { state.#node }
            fn at_node(state: Self::State, node: u64) -> Self::State {
                #state { #node: node, ..state }
            }
        }
        #lanes
        #reversible
    }
}
