//! Whether the kinetic energy is positive at a state. Takes the quadratic form of the derivation;
//! gives `kinetic_warning`, which evaluates its matrix once, when a trajectory starts.

use super::element::{self, Bundle, stack};
use super::expression::{Bindings, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item, variable};
use super::sizes::Generics;
use super::step::here;
use crate::derive::Derivation;
use crate::derive::kinetic;
use crate::expr::Expr;
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// `kinetic_warning`, for models over `f64`; nothing where the form is not known.
pub fn kinetic_warning(d: &Derivation, names: &Names) -> TokenStream {
    let Some(form) = &d.kinetic else {
        return TokenStream::new();
    };
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let plain = Generics::of(d).plain();
    let bodies = d.spec.configurations.len();
    let bundle = Bundle::of(d);
    let covectors = element::covectors(d);
    let gradients: Vec<Expr> = kinetic::gradients(&d.letters, &form.energy)
        .into_iter()
        .zip(&d.spec.configurations)
        .map(|(y, c)| c.group.of_gradient(&d.letters.symbols, y))
        .collect();
    let needed = letters_of(&gradients);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let p = schedule::program(s, &gradients, "t");
    let (lets, values) = program(&p, &bindings);
    let values = bundle.value(&values);
    let stacked = stack(d, quote!(parts));
    let columns = (0..bodies).map(|j| {
        let directions = d.letters.variation.iter().enumerate().map(|(i, xi)| {
            let name = variable(s, *xi);
            let t = super::expression::ty(s, s.get(*xi).shape);
            let value = match i == j {
                true => element::basis(d, i, quote!(axis)),
                false if s.get(*xi).shape.is_scalar() => quote!(T::zero()),
                false => quote!(SMatrix::zeros()),
            };
            quote!(let #name: #t = #value;)
        });
        let count = element::coordinates(d, j);
        let column = match j {
            0 => quote!(axis),
            _ => {
                let offset = element::offset(d, j);
                quote!(#offset + axis)
            }
        };
        quote! {
            for axis in 0..#count {
                #(#directions)*
                #lets
                let parts: #covectors = #values;
                inertia.set_column(#column, &#stacked);
            }
        }
    });
    let (dimension, coordinates) = (element::total(d), element::offset(d, bodies));
    quote! {
        /// What is wrong with the kinetic energy at a state, if anything: its Hessian in all
        /// velocities together, at the identity, should be positive definite.
        #[cold]
        #[allow(unused_variables)]
        pub fn kinetic_warning(&self, state: &#state #plain) -> Option<KineticWarning> {
            type T = f64;
            #parameters
            #locals
            let mut inertia = SMatrix::<T, #dimension, #dimension>::zeros();
            #(#columns)*
            KineticWarning::of(&inertia, #coordinates)
        }
    }
}
