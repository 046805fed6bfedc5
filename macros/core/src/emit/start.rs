//! The start of a trajectory: the state at node 0 from initial data, and the workspace of its steps. Takes the
//! derivation; gives the two functions from which the runtime's protocol builds `start`. For forced steps, the
//! protocol builds the second one itself and calls the tests.

use super::element::{self, Family, family};
use super::expression::{Bindings, Writer};
use super::items::{self, parameter_locals};
use super::names::{Names, field, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::at;
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::select_solver::Method;
use crate::expr::{self, Shift};
use proc_macro2::TokenStream;
use quote::quote;

/// The choice that a model leaves to the user.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// The order, by modified moments.
    Order,
    /// The solver; the model's own by default.
    Solver,
    /// The zero contribution.
    Nothing,
}

impl Choice {
    /// The choice of this model.
    pub fn of(d: &Derivation) -> Choice {
        if super::stepper::preprocessed(d) {
            Choice::Order
        } else if super::left_factor::default_solver(d).is_some() {
            Choice::Solver
        } else {
            Choice::Nothing
        }
    }

    /// The keyword of the protocol for the choice.
    pub fn word(self) -> TokenStream {
        match self {
            Choice::Order => quote!(order),
            Choice::Solver => quote!(solver),
            Choice::Nothing => quote!(nothing),
        }
    }

    /// The type of the choice.
    fn ty(self) -> TokenStream {
        match self {
            Choice::Order => quote!(Order),
            Choice::Solver => quote!(Option<Method>),
            Choice::Nothing => quote!(()),
        }
    }
}

/// `begin` and `prepared`, from which the runtime's protocol builds `start` and `workspace`.
pub(super) fn start(d: &Derivation, names: &Names) -> TokenStream {
    let (initial, state) = (item(d, "Initial"), item(d, "State"));
    let work = item(d, "Workspace");
    let used = Generics::of(d).used();
    let choice = Choice::of(d);
    let chosen = match choice {
        Choice::Nothing => quote!(_),
        Choice::Order | Choice::Solver => quote!(choice),
    };
    let choice = choice.ty();
    let begin = plain(d, names).is_none().then(|| {
        let begin = state_of(d, names);
        quote! {
            /// The state at node 0.
            fn begin(&self, initial: #initial #used) -> Result<#state #used, StartError> {
                #begin
            }
        }
    });
    if super::stepper::is_forced(d) {
        let tests = tests(d, names);
        let tests = is_tested(d).then(|| {
            quote! {
                /// Whether steps of `h` from `state` are defined.
                fn is_defined(&self, state: &#state #used, h: T) -> Result<(), StartError> {
                    #tests
                    Ok(())
                }
            }
        });
        return quote!(#begin #tests);
    }
    let prepared = workspace_of(d, names);
    let from = match prepared.to_string().contains("state") {
        true => quote!(state),
        false => quote!(_),
    };
    quote! {
        #begin

        /// The data with which steps of size `h` from `state` begin.
        fn prepared(&self, #from: &#state #used, h: T, #chosen: #choice) -> Result<#work #used, StartError> {
            #prepared
        }
    }
}

/// The fields from which the protocol builds the state at node 0, if the state contains elements and momenta only.
pub(super) fn plain(d: &Derivation, names: &Names) -> Option<TokenStream> {
    let list = d.spec.configurations.iter().enumerate();
    let alone = items::kept(d).is_empty()
        && items::ticks(d, names).is_empty()
        && d.spec.holds.is_empty()
        // On SO(n), n > 3, the momentum is a skew matrix.
        && list.clone().all(|(_, c)| !matches!(family(c), Family::Orthogonal(_)));
    let each = list.clone().map(|(i, c)| {
        let (element, momentum) = (own(d, c.element), per_configuration(d, "momentum", i));
        let given = element::momentum_field(d, i, c.side);
        let way = match c.side.is_body() {
            _ if element::about_body(c) => quote!(.carried),
            true => quote!(.to_space),
            false => TokenStream::new(),
        };
        quote!(#element, #momentum = #given #way)
    });
    let rests = list.flat_map(|(i, _)| element::rests(d, i).into_iter().flatten());
    let rests: Vec<_> = rests.collect();
    let rests = (!rests.is_empty()).then(|| quote!({ #(#rests),* }));
    alone.then(|| quote!(start { #(#each);* } #rests))
}

/// The state at node 0, as the body of a function of the initial data.
fn state_of(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let node = names.local("node");
    let (mut checks, mut fields) = (Vec::new(), Vec::new());
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let element = own(d, c.element);
        let momentum = per_configuration(d, "momentum", i);
        let given = element::momentum_field(d, i, c.side);
        let label = given.to_string();
        let name = &s.get(c.element).name;
        let numbers = element::numbers(d, i, quote!(initial.#element));
        let skew = matches!(family(c), Family::Orthogonal(_))
            .then(|| quote!(validate::skew(#label, &initial.#given.0)?;));
        checks.push(quote! {
            validate::finite(#name, #numbers)?;
            validate::finite(#label, initial.#given.0.as_slice())?;
            #skew
        });
        let rests = element::rests(d, i).into_iter().flatten();
        let value = match c.side.is_body() {
            _ if element::about_body(c) => quote!(initial.#given.carried(&initial.#element)),
            true => quote!(initial.#given.to_space(&initial.#element)),
            false => quote!(initial.#given),
        };
        fields.push(
            quote!(#element: initial.#element, #momentum: #value #(, #rests: SMatrix::zeros())*),
        );
    }
    let ticks = items::ticks(d, names).into_iter();
    fields.extend(ticks.map(|(_, amount, rest)| {
        let zero = element::zero(d, amount.shape());
        quote!(#rest: #zero)
    }));
    // Reference values: the inverse element acts on the value given at node 0.
    let mut references = TokenStream::new();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let own_name = own(d, a.quantity);
        let label = &s.get(a.quantity).name;
        if matches!(t, AdvectionRule::Defined(_)) {
            continue;
        }
        let shape = s.get(a.quantity).shape;
        checks.push(if shape.is_scalar() {
            quote!(validate::finite(#label, &[initial.#own_name])?;)
        } else if shape.is_vector() {
            quote!(validate::finite(#label, initial.#own_name.as_slice())?;)
        } else {
            quote!(validate::finite_entries(#label, &initial.#own_name)?;)
        });
        let local = variable(s, a.quantity);
        fields.push(field(d, a.quantity));
        let value = match t {
            AdvectionRule::Carried { reference, .. } => {
                let mut bindings = Bindings::new();
                let needed = expr::letters(reference);
                let elements: TokenStream = d
                    .spec
                    .configurations
                    .iter()
                    .filter(|c| needed.contains(&at(c.element, Shift::HERE)))
                    .map(|c| {
                        let (e, local) = (own(d, c.element), variable(s, c.element));
                        let value = element::matrix(c, quote!(initial.#e));
                        quote!(let #local = #value;)
                    })
                    .collect();
                let source = tagged(d, names, a.quantity, "start");
                bindings.bind(at(a.quantity, Shift::HERE), source.clone());
                let parameters = parameter_locals(d, quote!(self.parameters), &needed);
                let e = Writer {
                    symbols: s,
                    bindings: &bindings,
                }
                .write(reference);
                quote!({ #parameters #elements let #source = initial.#own_name; #e })
            }
            AdvectionRule::Defined(_) | AdvectionRule::Advanced => quote!(initial.#own_name),
        };
        references.extend(quote!(let #local = #value;));
    }
    fields.extend(super::holds::at_start(d));
    let admitted = super::holds::admitted(d, names);
    if !admitted.is_empty() {
        return quote! {
            #(#checks)*
            #references
            let state = #state { #(#fields,)* #node: 0 };
            #admitted
            Ok(state)
        };
    }
    quote! {
        #(#checks)*
        #references
        Ok(#state { #(#fields,)* #node: 0 })
    }
}

/// Whether the model tests the step size or the initial state.
pub(super) fn is_tested(d: &Derivation) -> bool {
    !tests(d, &Names::new(d)).is_empty()
}

/// The tests of the step size and of the initial state.
fn tests(d: &Derivation, names: &Names) -> TokenStream {
    let admitted = super::domain::of_step(d);
    let defined = super::domain::of_start(d, names);
    quote!(#admitted #defined)
}

/// The workspace of steps of size `h` from a state, as the body of a function of the state, `h` and the choice.
fn workspace_of(d: &Derivation, names: &Names) -> TokenStream {
    let work = item(d, "Workspace");
    let tests = tests(d, names);
    let fields = fields_of_workspace(d);
    let method = (Choice::of(d) == Choice::Solver)
        .then(|| quote!(let method = choice.unwrap_or(self.method);));
    quote! {
        #tests
        #method
        Ok(#work { h, #fields })
    }
}

fn fields_of_workspace(d: &Derivation) -> TokenStream {
    match d.solve.method {
        Method::FreeMoserVeselov => {
            let element = own(d, d.spec.configurations[0].element);
            let momentum = per_configuration(d, "momentum", 0);
            let references: Vec<_> = items::factor_references(d)
                .into_iter()
                .map(|id| own(d, id))
                .collect();
            let factor = match references.is_empty() {
                true => quote!(&self.factor),
                false => quote!(&self.factor(state)?),
            };
            quote! {
                solver: Free::start_of_order(#factor, &state.#element, &state.#momentum, h, choice)?
                    .solved_by(self.method),
                #(#references: state.#references,)*
            }
        }
        // The protocol writes these fields.
        Method::ForcedMoserVeselov => TokenStream::new(),
        Method::UnitQuaternions => {
            let factor = (!items::factor_references(d).is_empty())
                .then(|| quote!(factor: self.factor(state)?,));
            quote!(#factor edge: self.edge(state, h), here: *state)
        }
        Method::LeftFactor | Method::Davenport => super::left_factor::work_init(d),
        Method::Newton => quote!(search: newton::Search::from_rest(),),
        Method::Linear | Method::Blocks => super::blocks::work_init(d),
    }
}
