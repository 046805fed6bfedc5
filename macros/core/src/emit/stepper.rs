//! The model as something that steps: the protocol of the runtime around `begin`, `prepared` and `step`.
//! Takes the derivation; gives the one call that names the model's types, their fields and its way of stepping.

use super::items::{factor_references, kept};
use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::derive::recognise::Method;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Whether the stepper's order is chosen by modified moments.
pub(super) fn preprocessed(d: &Derivation) -> bool {
    matches!(d.solve.method, Method::FreeMoserVeselov)
}

/// The protocol, and a short way to try a step where blocks or Newton's method find it.
pub fn protocol(d: &Derivation, names: &Names) -> TokenStream {
    let [name, parameters, initial, state, work] =
        ["", "Parameters", "Initial", "State", "Workspace"].map(|suffix| item(d, suffix));
    let sizes = super::sizes::constants(&d.letters.symbols);
    let node = names.local("node");
    let [of_parameters, of_initial, of_state] = fields(d);
    let of_work = super::state::remembered(d, names);
    let (form, moved) = form(d);
    let choice = super::start::Choice::of(d).word();
    let orders = match (preprocessed(d), super::invariants::composes(d)) {
        (true, _) => quote!(modified),
        (false, true) => quote!(symmetric),
        (false, false) => quote!(none),
    };
    let judged = match d.kinetic {
        Some(_) => quote!(judged),
        None => quote!(unjudged),
    };
    quote! {
        ::clebsch::stepper! {
            [#(#sizes)*] #name,
            #parameters { #(#of_parameters),* },
            #initial { #(#of_initial),* },
            #state { #(#of_state),* } at #node,
            #work { #(#of_work),* },
            #form { #(#moved),* } #choice #orders #judged
        }
    }
}

/// How a step is made, in the words of the protocol, and the fields of the state that it moves.
fn form(d: &Derivation) -> (Ident, Vec<Ident>) {
    let c = &d.spec.configurations[0];
    let moved = [own(d, c.element), per_configuration(d, "momentum", 0)];
    // Lanes side by side pass by what is tested after a step.
    let guarded = super::domain::is_guarded(d);
    let of_state = !factor_references(d).is_empty();
    let (form, moved) = match d.solve.method {
        Method::FreeMoserVeselov => ("free", moved.to_vec()),
        Method::ForcedMoserVeselov if !guarded => {
            let references = kept(d).into_iter().map(|id| own(d, id));
            let form = if of_state {
                "forced_of_state"
            } else {
                "forced"
            };
            (form, moved.into_iter().chain(references).collect())
        }
        Method::Newton | Method::Blocks => ("tried", Vec::new()),
        _ => ("explicit", Vec::new()),
    };
    (format_ident!("{form}"), moved)
}

/// The fields of parameters, initial data and state.
fn fields(d: &Derivation) -> [Vec<Ident>; 3] {
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
    let ticks = super::items::ticks(d, &Names::new(d)).into_iter();
    state.extend(ticks.map(|(_, _, rest)| rest));
    state.extend(super::holds::names_of_fields(d));
    [parameters, initial, state]
}

/// A short way to try a step, where it has one.
pub fn attempt(d: &Derivation) -> TokenStream {
    if form(d).0 != "tried" {
        return TokenStream::new();
    }
    let state = item(d, "State");
    let trial = super::blocks::trial(d, "to_try");
    let used = Generics::of(d).used();
    quote! {
        /// The state after a step of `h` that is tried, or none.
            #[cold]
            fn attempt(&self, state: &#state #used, h: T) -> Option<#state #used> {
                let mut moving = *state;
                self.step(&mut moving, &mut #trial).ok()?;
                Some(moving)
            }
    }
}
