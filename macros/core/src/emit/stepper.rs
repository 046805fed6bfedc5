//! The model as something that steps: a workspace for any state, and the traits on which
//! compositions of high order and ensembles are written.
//! Takes the derivation; gives `workspace` and the implementations.

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

/// `start` and `workspace`, given the checks of the initial data with the state they lead to, and
/// the fields of a workspace.
pub(super) fn start(
    d: &Derivation,
    names: &Names,
    state_of: TokenStream,
    fields: TokenStream,
) -> TokenStream {
    let (initial, state, work) = (item(d, "Initial"), item(d, "State"), item(d, "Workspace"));
    let used = Generics::of(d).used();
    let (state, work) = (quote!(#state #used), quote!(#work #used));
    let bare = item(d, "Workspace");
    let at_node_0 = quote! {
        /// The state at node 0.
        fn at_node_0(&self, initial: #initial #used) -> Result<#state, StartError> {
            #state_of
        }
    };
    let admitted = super::domain::of_step(d);
    let defined = super::domain::of_start(d, names);
    let tried = quote! {
        validate::directed_step(h)?;
        #admitted
        let state = *state;
        #defined
        let work = #bare { h, #fields };
        // The first step is tried on a copy: what cannot run is refused here.
        let (mut trial, mut scratch) = (state, work);
        self.step(&mut trial, &mut scratch).map_err(|e| StartError::Refused(e.cause))?;
        Ok(work)
    };
    if preprocessed(d) {
        quote! {
            /// Starts a trajectory with step `h` from data at node 0; of order two, symplectic.
            ///
            /// # Errors
            /// Names the value that is not finite, or says why the first step cannot be solved and
            /// which step could.
            pub fn start(&self, initial: #initial #used, h: T) -> Result<(#state, #work), StartError> {
                self.start_of_order(initial, h, Order::Two)
            }

            /// As `start`, with steps of the given order: the moments are modified once, a step
            /// costs the same. Above two the step is Poisson in the momentum, but symplectic with
            /// the attitude only up to its error, unless the workspace is `compensated`.
            ///
            /// # Errors
            /// As `start`.
            pub fn start_of_order(&self, initial: #initial #used, h: T, order: Order) -> Result<(#state, #work), StartError> {
                validate::positive_step(h)?;
                let state = self.at_node_0(initial)?;
                Ok((state, self.workspace(&state, h, order)?))
            }

            #at_node_0

            /// A workspace for steps of `h`, of either sign, from any state.
            ///
            /// # Errors
            /// When `h` is zero or not finite, or the first step cannot be solved.
            pub fn workspace(&self, state: &#state, h: T, order: Order) -> Result<#work, StartError> {
                #tried
            }
        }
    } else if super::left_factor::default_solver(d).is_some() {
        quote! {
            /// Starts a trajectory with step `h` from data at node 0, with the model's solver.
            ///
            /// # Errors
            /// Names the value that is not finite, or says why the first step cannot be solved and
            /// which step could.
            pub fn start(&self, initial: #initial #used, h: T) -> Result<(#state, #work), StartError> {
                self.start_with(initial, h, self.method)
            }

            /// As `start`, with the solver named.
            ///
            /// # Errors
            /// As `start`; also when the solver does not serve this size or scalar.
            pub fn start_with(&self, initial: #initial #used, h: T, method: Method) -> Result<(#state, #work), StartError> {
                validate::positive_step(h)?;
                let state = self.at_node_0(initial)?;
                Ok((state, self.workspace_with(&state, h, method)?))
            }

            #at_node_0

            /// A workspace for steps of `h`, of either sign, from any state.
            ///
            /// # Errors
            /// When `h` is zero or not finite, or the first step cannot be solved.
            pub fn workspace(&self, state: &#state, h: T) -> Result<#work, StartError> {
                self.workspace_with(state, h, self.method)
            }

            /// The same with the solver named.
            ///
            /// # Errors
            /// When `h` is zero or not finite, or the first step cannot be solved.
            pub fn workspace_with(&self, state: &#state, h: T, method: Method) -> Result<#work, StartError> {
                #tried
            }
        }
    } else {
        quote! {
            /// Starts a trajectory with step `h` from data at node 0.
            ///
            /// # Errors
            /// Names the value that is not finite, or says why the first step cannot be solved and
            /// which step could.
            pub fn start(&self, initial: #initial #used, h: T) -> Result<(#state, #work), StartError> {
                validate::positive_step(h)?;
                let state = self.at_node_0(initial)?;
                Ok((state, self.workspace(&state, h)?))
            }

            #at_node_0

            /// A workspace for steps of `h`, of either sign, from any state.
            ///
            /// # Errors
            /// When `h` is zero or not finite, or the first step cannot be solved.
            pub fn workspace(&self, state: &#state, h: T) -> Result<#work, StartError> {
                #tried
            }
        }
    }
}

/// `Stepper`, and `Reversible` where the derivation has shown it.
pub fn traits(d: &Derivation, names: &Names) -> TokenStream {
    let (name, state, work) = (item(d, ""), item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let order = preprocessed(d).then(|| quote!(, Order::Two));
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
                self.workspace(state, h #order)
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
