//! The inertia at a state, and whether it is positive there. Takes the quadratic form of the kinetic energy;
//! gives `inertia_at`, and `kinetic_warning`, which judges it once, when a trajectory starts.

use super::element;
use super::energy::{gradients, inertia};
use super::expression::Bindings;
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item};
use super::sizes::Generics;
use super::step::here;
use crate::derive::Derivation;
use proc_macro2::TokenStream;
use quote::quote;

/// `inertia_at`; nothing where the form is not known.
pub fn inertia_at(d: &Derivation, names: &Names) -> TokenStream {
    let Some(form) = &d.kinetic else {
        return TokenStream::new();
    };
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let gradients = gradients(d, &form.energy);
    let needed = letters_of(&gradients);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let inertia = inertia(d, &bindings, &gradients);
    let dimension = element::total(d);
    quote! {
        /// The Hessian of the kinetic energy in all velocities together, at the identity.
            fn inertia_at(&self, state: &#state #used) -> SMatrix<T, #dimension, #dimension> {
                #parameters
                #locals
                #inertia
                inertia
            }
    }
}

/// `kinetic_warning`, for models over `f64`; nothing where the form is not known.
pub fn kinetic_warning(d: &Derivation) -> TokenStream {
    if d.kinetic.is_none() {
        return TokenStream::new();
    }
    let state = item(d, "State");
    let plain = Generics::of(d).plain();
    let coordinates = element::offset(d, d.spec.configurations.len());
    quote! {
        /// What is wrong with the kinetic energy at a state, if anything: its Hessian should be positive
        /// definite.
        #[cold]
        pub fn kinetic_warning(&self, state: &#state #plain) -> Option<KineticWarning> {
            KineticWarning::of(&self.inertia_at(state), #coordinates)
        }
    }
}
