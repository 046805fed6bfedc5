//! The model over any scalar, as data: what ensembles are gathered from and taken apart into.
//! Takes the derivation; gives the implementations for parameters, initial data, state and model.

use super::items::kept;
use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::derive::recognise::Method;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// `OfScalars` for the data, `Model` for the model.
pub fn over_any_scalar(d: &Derivation, names: &Names) -> TokenStream {
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let other = names.local("U");
    let other_used = g.used_over(&other);
    let node = names.local("node");

    let parameters: Vec<Ident> = d.spec.parameters.iter().map(|p| own(d, *p)).collect();
    let no_parameters = parameters
        .is_empty()
        .then(|| quote!(scalar: ::core::marker::PhantomData));
    let (mut initial, mut state) = (Vec::new(), Vec::new());
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let element = own(d, c.element);
        let given = super::element::momentum_field(d, i, c.side);
        initial.extend([element.clone(), given]);
        state.extend([element, per_configuration(d, "momentum", i)]);
        state.extend(super::element::rests(d, i).into_iter().flatten());
    }
    for id in kept(d) {
        initial.push(own(d, id));
        state.push(own(d, id));
    }
    let node = quote!(#node: self.#node);
    let data = [
        ("Parameters", parameters, no_parameters),
        ("Initial", initial, None),
        ("State", state, Some(node)),
    ];
    let data = data.map(|(suffix, fields, rest)| {
        let name = item(d, suffix);
        quote! {
            impl #bound ::clebsch::OfScalars for #name #used {
                type Scalar = T;
                type Over<#other: Real> = #name #other_used;
                fn over<#other: Real>(&self, change: &mut impl FnMut(T) -> #other) -> #name #other_used {
                    #name { #(#fields: self.#fields.over(change),)* #rest }
                }
            }
        }
    });

    let (name, given) = (item(d, ""), item(d, "Parameters"));
    let (initial, state) = (item(d, "Initial"), item(d, "State"));
    let side_by_side = matches!(
        d.solve.method,
        Method::FreeMoserVeselov | Method::ForcedMoserVeselov
    ) && !super::domain::is_guarded(d);
    let (choice, chosen, passed) = if super::stepper::preprocessed(d) {
        (quote!(Order), quote!(order), Some(quote!(, order)))
    } else {
        (quote!(()), quote!(_), None)
    };
    quote! {
        #(#data)*

        impl #bound ::clebsch::integrate::Model for #name #used {
            type Parameters = #given #used;
            type Initial = #initial #used;
            type Choice = #choice;
            type Over<#other: Real> = #name #other_used;
            const SIDE_BY_SIDE: bool = #side_by_side;
            fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
                Self::new(parameters)
            }
            fn given(&self) -> &Self::Parameters {
                &self.parameters
            }
            fn begin(&self, initial: Self::Initial) -> Result<#state #used, StartError> {
                self.at_node_0(initial)
            }
            fn prepare(&self, state: &#state #used, h: T, #chosen: Self::Choice) -> Result<Self::Workspace, StartError> {
                self.workspace(state, h #passed)
            }
        }
    }
}
