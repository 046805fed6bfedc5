//! The inertia at a state. When a trajectory starts, the runtime tests once whether the kinetic energy is positive
//! there. Takes the quadratic form of the kinetic energy; gives `inertia_at`.

use super::element;
use super::energy::{gradients, inertia_alone};
use super::expression::Bindings;
use super::items::letters_of;
use super::names::{Names, item};
use super::sizes::Generics;
use super::step::seen;
use crate::derive::Derivation;
use crate::derive::kinetic::Kinetic;
use proc_macro2::TokenStream;
use quote::quote;

/// The form that the runtime tests, if it is known. A Lagrangian of first order has none.
pub fn judged(d: &Derivation) -> Option<&Kinetic> {
    d.kinetic.as_ref().filter(|k| !k.first_order)
}

/// `inertia_at`; empty if there is no form to test.
pub fn inertia_at(d: &Derivation, names: &Names) -> TokenStream {
    let Some(form) = judged(d) else {
        return TokenStream::new();
    };
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let gradients = gradients(d, &form.energy);
    let needed = letters_of(&gradients);
    let mut bindings = Bindings::new();
    let locals = seen(d, names, &needed, &mut bindings);
    let inertia = inertia_alone(d, &bindings, &gradients);
    let dimension = element::total(d);
    quote! {
        /// The Hessian of the kinetic energy in all velocities together, at the identity.
            fn inertia_at(&self, state: &#state #used) -> SMatrix<T, #dimension, #dimension> {
                #locals
                #inertia
            }
    }
}
