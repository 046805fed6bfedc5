//! `step`: the momentum of the edge from the node momentum, the solution, the new element, and the momentum of the
//! next node.

use super::element::{self, Family, family};
use super::expression::{Bindings, Writer, program};
use super::force_at_node::AtNode;
use super::items::{self, kept, letters_of, node_locals, parameter_locals, with_transports};
use super::momentum_update::{EdgeForce, carried, gained, seen_from_space};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::momentum_update::MomentumUpdate;
use crate::derive::select_solver::{Method, StepEquation};
use crate::derive::spatial_increment_form::SpatialIncrementForm;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

pub(super) fn at(symbol: crate::expr::symbol::SymbolId, shift: Shift) -> Letter {
    Letter { symbol, shift }
}

/// The functions `start` and `step`, and the accessors.
pub fn start_and_step(d: &Derivation, names: &Names) -> TokenStream {
    let name = item(d, "");
    let start = super::start::start(d, names);
    let factor = items::factor_of_state(d);
    let access = advected_access(d, names);
    let held = super::holds::functions(d, names);
    let step = match (&d.solve.method, d.solve.riccati.first()) {
        (Method::FreeMoserVeselov, _) => free_step(d, names),
        (Method::ForcedMoserVeselov, Some(StepEquation::Exact(mv))) => {
            super::forced::step(d, names, mv)
        }
        (Method::UnitQuaternions, Some(StepEquation::Quaternionic(q))) => {
            super::forced::step(d, names, &q.edge)
        }
        (Method::LeftFactor | Method::Davenport, Some(StepEquation::Exact(mv))) => {
            super::left_factor::step(d, names, mv)
        }
        (Method::Blocks, _) => super::blocks::step(d, names),
        _ => super::newton::step(d, names),
    };
    let tested = super::domain::tested_step(d, names);
    let g = Generics::of(d);
    let (bound, used) = (g.bound(), g.used());
    quote! {
        impl #bound #name #used {
            #start
            #factor
            #tested
            #step
            #held
            #access
        }
    }
}

pub(super) fn step_signature(d: &Derivation, body: TokenStream) -> TokenStream {
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let method = d.how_solved();
    let head = super::domain::step_head(d);
    let doc = format!(" One step, in place. Method: {method}.");
    let used = Generics::of(d).used();
    quote! {
        #[doc = #doc]
        ///
        /// # Errors
        /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
        #[inline]
        #head(&self, state: &mut #state #used, work: &mut #work #used) -> Result<(), StepError> {
            #body
        }
    }
}

fn free_step(d: &Derivation, names: &Names) -> TokenStream {
    let element = own(d, d.spec.configurations[0].element);
    let momentum = per_configuration(d, "momentum", 0);
    let node = names.local("node");
    let references: Vec<_> = items::factor_references(d)
        .into_iter()
        .map(|id| own(d, id))
        .collect();
    // The state may belong to another trajectory and therefore to another body.
    let another = (!references.is_empty()).then(|| {
        quote! {
            if !(#(same(&work.#references, &state.#references))&*) {
                let Ok(factor) = self.factor(state) else {
                    return Err(StepCause::not_finite("body").at_node(state.#node));
                };
                if let Err(e) = work.solver.restart_as(&factor, &state.#element, &state.#momentum) {
                    return Err(StepCause::from(e).at_node(state.#node));
                }
                #(work.#references = state.#references;)*
            }
        }
    });
    step_signature(
        d,
        quote! {
            #another
            if let Err(e) = work.solver.follow(&mut state.#element, &state.#momentum) {
                return Err(StepCause::from(e).at_node(state.#node));
            }
            state.#node += 1;
            Ok(())
        },
    )
}

/// Locals at the node where the step starts.
pub(super) fn here(
    d: &Derivation,
    names: &Names,
    needed: &[Letter],
    bindings: &mut Bindings,
) -> TokenStream {
    let element = |i: usize| {
        let c = &d.spec.configurations[i];
        let e = own(d, c.element);
        element::matrix(c, quote!(state.#e))
    };
    let reference = |id| {
        let r = own(d, id);
        quote!(state.#r)
    };
    node_locals(d, names, 0, needed, &element, &reference, bindings)
}

/// Locals and parameters for functions of a state other than the step. They call the model's functions for advected
/// quantities.
pub(super) fn seen(
    d: &Derivation,
    names: &Names,
    needed: &[Letter],
    bindings: &mut Bindings,
) -> TokenStream {
    let s = &d.letters.symbols;
    let (mut asked, mut others) = (TokenStream::new(), needed.to_vec());
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let letter = at(a.quantity, Shift::HERE);
        if needed.contains(&letter) && !matches!(t, AdvectionRule::Advanced) {
            let (local, function) = (variable(s, a.quantity), own(d, a.quantity));
            asked.extend(quote!(let #local = self.#function(state);));
            bindings.bind(letter, local);
            others.retain(|l| *l != letter);
        }
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &others);
    let locals = here(d, names, &others, bindings);
    // A quantity that its constraint advances may depend on those values.
    quote!(#parameters #asked #locals)
}

/// The momentum of configuration `i` at the node where the step starts, in the frame of `side`.
pub(super) fn node_momentum(d: &Derivation, i: usize, side: Side) -> TokenStream {
    let c = &d.spec.configurations[i];
    let momentum = per_configuration(d, "momentum", i);
    let (element, own) = (variable(&d.letters.symbols, c.element), own(d, c.element));
    match (side.is_body(), family(c)) {
        (true, Family::Rotation) => quote!(#element.tr_mul(&state.#momentum.0)),
        (true, _) => quote!(state.#momentum.to_body(&state.#own).0),
        (false, _) if element::about_body(c) => {
            quote!(state.#momentum.to_space(&state.#own).0)
        }
        (false, _) => element::value(c, quote!(state.#momentum.0)),
    }
}

/// Values computed at the node where a step starts.
pub(super) struct AtTheStart<'a> {
    /// The spatial increment forms of the configurations that were solved in that form.
    pub by_change: &'a [Option<SpatialIncrementForm>],
    /// The forces on fields at a node that the workspace stores from step to step.
    pub forces: &'a [AtNode],
    /// The other named values.
    pub computed: &'a schedule::Program,
}

/// The end of every step: new elements, quantities of the next node, momenta, and the test that they are finite.
pub(super) fn finish(
    d: &Derivation,
    names: &Names,
    bindings: &mut Bindings,
    solved: &dyn Fn(usize) -> TokenStream,
    known: &AtTheStart,
    remembered: TokenStream,
) -> TokenStream {
    let s = &d.letters.symbols;
    let forms = known.by_change;
    let force_on = |i: usize| known.forces.iter().find(|f| f.configuration == i);
    let by_change = |i: usize| forms.get(i).and_then(Option::as_ref);
    // The forces, and the nodes at which their form in the frame of space may be used.
    let parts = d.carries.iter().enumerate();
    let parts = parts.flat_map(|(i, carry)| match (by_change(i), carry) {
        (Some(form), _) => vec![(None, &form.added)],
        (None, MomentumUpdate::Kept(_)) if force_on(i).is_some() => Vec::new(),
        (None, MomentumUpdate::Kept(added)) => vec![(None, added)],
        (None, MomentumUpdate::Through { leave, arrive, .. }) => vec![
            (Some((i, Shift::HERE)), leave),
            (Some((i, Shift::NEXT)), arrive),
        ],
    });
    let (places, wanted): (Vec<_>, Vec<Expr>) = parts.map(|(at, e)| (at, e.clone())).unzip();
    let mut needed = letters_of(&wanted);
    for force in known.forces {
        let there = |l: Letter| at(l.symbol, Shift::NEXT);
        needed.extend(force.needed().into_iter().map(there));
    }
    let seen = forms.iter().flatten().filter_map(|form| form.seen.as_ref());
    let seen: Vec<Expr> = seen.map(|e| expr::shift_time(s, e, 1)).collect();
    needed.extend(letters_of(&seen));
    let advanced: Vec<_> = items::advanced(d).map(|a| a.quantity).collect();
    needed.extend(advanced.iter().map(|q| at(*q, Shift::NEXT)));
    let mut out = TokenStream::new();
    let mut assignments = TokenStream::new();
    let mut finite = Vec::new();
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let moved = tagged(d, names, c.element, "moved");
        let element = own(d, c.element);
        let omega = solved(i);
        // The solver may have found the velocity in the body frame.
        let side = match d.solve.finds_body_velocity(i) {
            true => Side::Body,
            false => c.side,
        };
        assignments.extend(quote!(state.#element = #moved;));
        if let Some([rest, _]) = element::rests(d, i) {
            let left = tagged(d, names, c.element, "rest");
            // The momentum of a rigid motion needs its velocity again.
            let velocity = tagged(d, names, c.element, "velocity");
            let asked = c.group.rigid().is_some() && !element::is_straight(d, i);
            let (named, velocity) = match asked {
                true => (quote!(let #velocity = #omega;), quote!(#velocity)),
                false => (TokenStream::new(), quote!((#omega))),
            };
            out.extend(quote! {
                #named
                let (#moved, #left) = state.#element.moved(&#velocity, &state.#rest);
            });
            assignments.extend(quote!(state.#rest = #left;));
            continue;
        }
        let end = match by_change(i) {
            Some(_) => quote!(state.#element.changed(&#omega)),
            None => element::advanced(c, side, quote!(state.#element), omega),
        };
        out.extend(quote!(let #moved = #end;));
    }
    let element = |i: usize| {
        let c = &d.spec.configurations[i];
        let moved = tagged(d, names, c.element, "moved");
        element::matrix(c, quote!(#moved))
    };
    let reference = |id| {
        let r = own(d, id);
        quote!(state.#r)
    };
    // Rotated torques need the matrices of both nodes.
    for (c, u) in d.spec.configurations.iter().zip(&d.carries) {
        if let (MomentumUpdate::Through { leave, arrive, .. }, Family::Rotation) = (u, family(c))
            && c.side.is_body()
        {
            if !leave.is_zero() {
                needed.push(at(c.element, Shift::HERE));
            }
            if !arrive.is_zero() {
                needed.push(at(c.element, Shift::NEXT));
            }
        }
    }
    out.extend(node_locals(
        d, names, 1, &needed, &element, &reference, bindings,
    ));
    let acting = wanted.iter().zip(places).map(|(e, place)| {
        let e = expr::factored(s, &schedule::displaced(s, e));
        let seen = place.and_then(|(i, end)| seen_from_space(d, i, end, &e));
        (seen.is_some(), seen.unwrap_or(e))
    });
    let (in_space, factored): (Vec<bool>, Vec<Expr>) = acting.unzip();
    out.extend(super::blocks::from_space(
        d,
        names,
        forms,
        Shift::NEXT,
        bindings,
    ));
    let p = schedule::program_after(known.computed, &factored, "t");
    let (lets, values) = program(&p, bindings);
    out.extend(lets);
    let acting = values.into_iter().zip(in_space);
    let mut acting = acting.map(|(value, in_space)| EdgeForce { value, in_space });
    let mut kept_forces = TokenStream::new();
    for i in 0..d.spec.configurations.len() {
        let carried = match (by_change(i), force_on(i)) {
            (Some(form), _) => gained(d, names, i, form, &mut acting),
            (None, None) => carried(d, names, i, &mut acting),
            (None, Some(force)) => {
                let [here, next] = [0, 1].map(|time| force.local(d, names, time));
                out.extend(force.next(d, names, bindings));
                kept_forces.extend(force.remembered(d, names, bindings));
                let both = EdgeForce {
                    value: quote!(-(#here + #next)),
                    in_space: false,
                };
                carried(d, names, i, &mut [both].into_iter())
            }
        };
        let value = carried.value;
        out.extend(carried.found);
        assignments.extend(carried.stored);
        finite.push(quote!(all_finite(&#value)));
    }
    let ticks = items::ticks(d, names);
    for q in &advanced {
        let (field, next) = (own(d, *q), tagged(d, names, *q, "next"));
        if let Some((_, amount, rest)) = ticks.iter().find(|(tick, ..)| tick == q) {
            let kept = tagged(d, names, *q, "kept");
            let writer = Writer {
                symbols: s,
                bindings,
            };
            let value = writer.write(amount);
            let sum = match amount.shape().is_scalar() {
                true => quote!(added_number(state.#field, state.#rest, #value)),
                false => quote!(added(&state.#field, &state.#rest, &(#value))),
            };
            out.extend(quote!(let (#kept, #rest) = #sum;));
            assignments.extend(quote!(state.#field = #kept; state.#rest = #rest;));
            continue;
        }
        assignments.extend(quote!(state.#field = #next;));
    }
    let node = names.local("node");
    let finite = super::domain::finite_in_step(d, names, &finite);
    let held = super::holds::after_step(d, names);
    quote! {
        #out
        #finite
        #assignments
        #kept_forces
        #held
        state.#node += 1;
        #remembered
        Ok(())
    }
}

/// The advected quantities at a node, as functions of the state.
fn advected_access(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let mut out = TokenStream::new();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let letter = at(a.quantity, Shift::HERE);
        let mut needed = with_transports(d, &[letter], 0);
        let parameters = parameter_locals(d, quote!(self.parameters), &needed);
        needed.retain(|l| *l != letter);
        let mut bindings = Bindings::new();
        let locals = here(d, names, &needed, &mut bindings);
        let reference = |id| {
            let kept = own(d, id);
            quote!(state.#kept)
        };
        let (found, value) = items::advected_value(d, names, a, t, 0, &reference, &bindings);
        let name = own(d, a.quantity);
        let t = super::expression::ty(s, s.get(a.quantity).shape);
        let doc = format!(" `{name}` at the node of this state.");
        out.extend(quote! {
            #[doc = #doc]
            #[inline]
            pub fn #name(&self, state: &#state #used) -> #t {
                #parameters
                #locals
                #found
                #value
            }
        });
    }
    debug_assert!(kept(d).len() <= d.spec.advected.len());
    out
}
