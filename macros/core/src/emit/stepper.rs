//! The interface of a stepper: the runtime's protocol around `begin`, `prepared` and `step`. Takes the derivation;
//! gives one macro call that names the model's types with their fields, the kind of step, and the observables.

use super::element::{self, Family, family};
use super::invariants::Form;
use super::items::{factor_references, kept};
use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::invariants::{Invariant, Kind};
use crate::derive::select_solver::Method;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Whether modified moments can raise the order of the stepper.
pub(super) fn preprocessed(d: &Derivation) -> bool {
    matches!(d.solve.method, Method::FreeMoserVeselov)
}

/// The protocol, and a short way to try a step if Newton's method or blocks solve it.
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
    let judged = match super::kinetic::judged(d) {
        Some(_) => {
            let coordinates = element::offset(d, d.spec.configurations.len());
            quote!(judged { #coordinates })
        }
        None => quote!(unjudged),
    };
    let solved = is_forced(d).then(|| forced(d));
    let start = super::start::plain(d, names);
    let observables = observables(d);
    let invariants = d.invariants.iter().map(|v| invariant(d, v));
    quote! {
        ::clebsch::stepper! {
            [#(#sizes)*] #name,
            #parameters { #(#of_parameters),* },
            #initial { #(#of_initial),* },
            #state { #(#of_state),* } at #node,
            #work { #(#of_work),* },
            #form { #(#moved),* } #choice #orders #judged #solved #start
            observables { #(#observables),* }
            invariants { #(#invariants),* }
        }
    }
}

/// Whether the protocol makes the steps, from the model's edges and its torques at the nodes.
pub(super) fn is_forced(d: &Derivation) -> bool {
    matches!(d.solve.method, Method::ForcedMoserVeselov)
}

/// The solution of a forced step, the quantities in its factor, and the tests at the start.
fn forced(d: &Derivation) -> TokenStream {
    let how = d.how_solved();
    let references = factor_references(d).into_iter().map(|id| own(d, id));
    let references: Vec<Ident> = references.collect();
    let of = (!references.is_empty()).then(|| quote!(, of #(#references)&*));
    let tests = super::start::is_tested(d).then(|| quote!(, tests is_defined));
    quote!((#how #of #tests))
}

/// The observables, in the order of the card.
fn observables(d: &Derivation) -> Vec<TokenStream> {
    let mut all = Vec::new();
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let element = own(d, c.element);
        all.push(quote!(state.#element));
        let sides = match c.group.is_additive() {
            true => &Side::BOTH[..1],
            false => &Side::BOTH[..],
        };
        let momenta = sides
            .iter()
            .map(|side| element::momentum_field(d, i, *side));
        all.extend(momenta.map(|momentum| quote!(state.#momentum)));
    }
    let advected = d.spec.advected.iter().map(|a| own(d, a.quantity));
    all.extend(advected.map(|quantity| quote!(#quantity)));
    let multipliers = d.spec.holds.iter().map(|hold| own(d, hold.multiplier));
    all.extend(multipliers.map(|multiplier| quote!(state.#multiplier)));
    all
}

/// The value of an invariant, in the syntax of the protocol.
fn invariant(d: &Derivation, v: &Invariant) -> TokenStream {
    if let Kind::SpatialMomentum(i) = v.kind {
        let c = &d.spec.configurations[i];
        let (element, momentum) = (own(d, c.element), element::spatial_momentum_field(d, i));
        // The state stores the spatial momentum. A drift shows in the momentum that the solver iterates in the body,
        // transformed to space.
        return match (&d.solve.method, family(c)) {
            (Method::FreeMoserVeselov, _) => quote!(work.#element.#momentum),
            (_, Family::Orthogonal(_)) => quote!(state.#momentum as skew),
            _ => quote!(state.#momentum),
        };
    }
    let name = format_ident!("{}", v.name);
    let shape = match super::invariants::form(d, v) {
        Form::Number | Form::Entries => TokenStream::new(),
        Form::Skew => quote!(as skew),
        Form::Spectrum => quote!(as spectrum),
    };
    match super::invariants::holds_step(d, v) {
        true => quote!(h.#name),
        false => quote!(#name #shape),
    }
}

/// The kind of step in the protocol, and the fields of the state that it changes.
fn form(d: &Derivation) -> (Ident, Vec<Ident>) {
    let c = &d.spec.configurations[0];
    let moved = [own(d, c.element), per_configuration(d, "momentum", 0)];
    // Steps in parallel lanes skip the tests after a step.
    let guarded = super::domain::is_guarded(d);
    let (form, moved) = match d.solve.method {
        Method::FreeMoserVeselov => ("free", moved.to_vec()),
        Method::ForcedMoserVeselov => {
            let references = kept(d).into_iter().map(|id| own(d, id));
            let form = match guarded {
                true => "forced_untested",
                false => "forced",
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

/// A function that tries one step, if the step has that form.
pub fn attempt(d: &Derivation) -> TokenStream {
    if form(d).0 != "tried" {
        return TokenStream::new();
    }
    let state = item(d, "State");
    let trial = super::blocks::trial(d, "to_try");
    let used = Generics::of(d).used();
    quote! {
        /// The state after a trial step of size `h`; `None` if it fails.
            #[cold]
            fn attempt(&self, state: &#state #used, h: T) -> Option<#state #used> {
                let mut moving = *state;
                self.step(&mut moving, &mut #trial).ok()?;
                Some(moving)
            }
    }
}
