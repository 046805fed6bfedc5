//! The model over any scalar, as data: what ensembles are gathered from and taken apart into.
//! Takes the derivation; gives the implementations for parameters, initial data, state and model, with
//! how a trajectory begins.

use super::items::kept;
use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::derive::recognise::Method;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// `OfScalars` for the data, `Model` for the model.
pub fn over_any_scalar(d: &Derivation, names: &Names) -> TokenStream {
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    let other = names.local("U");
    let other_used = g.used_over(&other);
    let node = names.local("node");
    let sizes = super::sizes::constants(&d.letters.symbols);

    let mut parameters: Vec<Ident> = d.spec.parameters.iter().map(|p| own(d, *p)).collect();
    if parameters.is_empty() {
        parameters.push(format_ident!("scalar"));
    }
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
    state.extend(super::holds::names_of_fields(d));
    let data = [
        ("Parameters", parameters, None),
        ("Initial", initial, None),
        ("State", state, Some(quote!(at #node))),
    ];
    let data = data.map(|(suffix, fields, rest)| {
        let name = item(d, suffix);
        quote!(::clebsch::of_scalars! { [#(#sizes)*] #name { #(#fields),* } #rest })
    });

    let (name, given) = (item(d, ""), item(d, "Parameters"));
    let (initial, state) = (item(d, "Initial"), item(d, "State"));
    let side_by_side = matches!(
        d.solve.method,
        Method::FreeMoserVeselov | Method::ForcedMoserVeselov
    ) && !super::domain::is_guarded(d);
    let choice = super::start::Choice::of(d);
    let chosen = match choice {
        super::start::Choice::Nothing => quote!(_),
        _ => quote!(choice),
    };
    let choice = choice.ty();
    let begin = super::start::state_of(d, names);
    let prepared = super::start::workspace_of(d, names);
    let asks = |tokens: &TokenStream| tokens.to_string().contains("state");
    let from = match asks(&prepared) {
        true => quote!(state),
        false => quote!(_),
    };
    let compensated = super::stepper::preprocessed(d).then(|| {
        quote! {
            fn compensated(work: Self::Workspace) -> Self::Workspace {
                work.compensated()
            }
        }
    });
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
                #begin
            }
            fn prepared(&self, #from: &#state #used, h: T, #chosen: Self::Choice) -> Result<Self::Workspace, StartError> {
                #prepared
            }
            #compensated
        }
    }
}
