//! The step of a model whose velocities are found by Newton's method: residual and tangent are
//! both derived, all configurations are solved together.

use super::element::{self, Bundle, Family, family};
use super::equations::Equations;
use super::expression::Bindings;
use super::items::{advanced, letters_of, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::principal::Principal;
use super::sizes::Generics;
use super::step::{at, finish, here};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::carry::Carry;
use crate::derive::seen_from_body::outgoing;
use crate::expr::Shift;
use proc_macro2::TokenStream;
use quote::quote;

/// The type of what the tangent asks of a node, and `step`.
pub fn step(d: &Derivation, names: &Names) -> (TokenStream, TokenStream) {
    let s = &d.letters.symbols;
    let bodies = d.spec.configurations.len();
    let bundle = Bundle::of(d);
    let types: Vec<TokenStream> = (0..bodies).map(|i| element::ty(d, i)).collect();
    let elements = bundle.ty(&types);
    let used = Generics::of(d).used();
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let step = variable(s, d.spec.step);
    let (trial, mu, newton, found, solved) = (
        names.local("trial"),
        names.local("momenta"),
        names.local("iteration"),
        names.local("found"),
        names.local("solved"),
    );
    let from_body = d.solve.seen_from_body.as_ref();
    let side = |i: usize| match from_body {
        Some(_) => Side::Body,
        None => d.spec.configurations[i].side,
    };
    let momenta = match from_body {
        Some(list) => list.clone(),
        None => outgoing(&d.spec, &d.letters, &d.balances),
    };
    // Everything known at the node.
    let mut bindings = Bindings::new();
    let mut needed = letters_of(&momenta);
    for (i, c) in d.spec.configurations.iter().enumerate() {
        if side(i) == Side::Body && family(c) == Family::Rotation {
            needed.push(at(c.element, Shift::HERE));
        }
    }
    needed.extend(letters_of(d.carries.iter().flat_map(Carry::parts)));
    needed.extend(letters_of(advanced(d).map(|a| &a.update)));
    let mut all = with_transports(d, &needed, 0);
    all.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let locals = here(d, names, &needed, &mut bindings);
    // Node momenta.
    let node_momenta: Vec<TokenStream> = (0..bodies)
        .map(|i| {
            let field = per_configuration(d, "momentum", i);
            let c = &d.spec.configurations[i];
            let (element, own) = (variable(s, c.element), own(d, c.element));
            match (side(i), family(c)) {
                (Side::Body, Family::Rotation) => quote!(#element.tr_mul(&state.#field.0)),
                (Side::Body, _) => quote!(state.#field.to_body(&state.#own).0),
                (Side::Spatial, _) => quote!(state.#field.0),
            }
        })
        .collect();
    let solved_for = Equations {
        d,
        names,
        bindings: &bindings,
        trial: &trial,
        momenta: &mu,
    };
    let (known, equations) = solved_for.write(&momenta, &node_momenta);
    let (at_trial, residual_body, tangent_body) =
        (&equations.at_trial, &equations.residual, &equations.tangent);
    let principal = Principal {
        d,
        bindings: &bindings,
        equations: &equations,
        momenta: &mu,
        trial: &trial,
    };
    let (given, values) = (
        principal.packed(&equations.alone.given),
        principal.packed(&equations.alone.values),
    );
    let (lane, ended) = (names.local("lane"), names.local("ended"));
    let given_type = Principal::packed_type(d, &equations.alone.given);
    let (momenta_type, node_type) = (&equations.momenta, item(d, "Node"));
    let dimension = element::total(d);
    let functions = principal.functions();
    let remembered = quote!(work.search.remember(state.#node - 1, &#found););
    let mut after = bindings.clone();
    let matrices: TokenStream = (0..bodies)
        .map(|i| {
            let c = &d.spec.configurations[i];
            let (w, own) = (c.velocity, own(d, c.element));
            let name = tagged(d, names, w, "matrix");
            after.bind(at(w, Shift::HERE), name.clone());
            let part = bundle.part(quote!(#solved), i);
            match side(i) == c.side {
                true => quote!(let #name = #part.matrix();),
                false => quote!(let #name = (state.#own * #part * state.#own.inverse()).matrix();),
            }
        })
        .collect();
    let configurations = d.spec.configurations.iter().map(|c| &s.get(c.element).name);
    let solved_at = |i: usize| bundle.part(quote!(#solved), i);
    let rest = finish(d, names, &mut after, &solved_at, remembered);
    let head = super::domain::step_head(d);
    // A root beyond the edge of the domain is no principal one: what was met is said.
    let contact = super::domain::is_guarded(d).then(|| {
        let moves = d.spec.configurations.iter().enumerate().map(|(i, c)| {
            let (own, part) = (own(d, c.element), bundle.part(quote!(solved.element), i));
            match side(i) {
                Side::Body => quote!(moved.#own = state.#own * #part;),
                Side::Spatial => quote!(moved.#own = #part * state.#own;),
            }
        });
        quote! {
            if let Ok(solved) = &failed {
                let mut moved = state;
                #(#moves)*
                if let Err(contact) = self.stays_inside(&state, &moved, #step) {
                    return Err(self.left_domain(&state, #step, #newton.tries(), contact));
                }
            }
        }
    });
    let method = format!(" One step, in place. Solved thus: {}.", d.how_solved());
    // What cold functions are given is copied where they are called: a value whose address is taken
    // anywhere in the loop would live in memory.
    let step = quote! {
        #[doc = #method]
        ///
        /// # Errors
        /// When no velocity that follows from rest solves the equations: which of them fails, and
        /// which step could be solved; the state is then unchanged.
        #[inline]
        #head(&self, state: &mut #state #used, work: &mut #work #used) -> Result<(), StepError> {
            let #step = work.h;
            #parameters
            #locals
            #known
            let mut #newton = work.search.begin(state.#node, #values);
            let #found: newton::Solved<#elements> = loop {
                let #trial = #newton.trial();
                if #newton.wants_scale() {
                    #newton.set_scale(move |#lane| self.rounding(#step, &#given, &#mu, &#trial, #lane));
                }
                #at_trial
                if #newton.assess({ #residual_body }) {
                    #newton.set_tangent(&{ #tangent_body });
                }
                match #newton.correct() {
                    newton::Progress::Continue => {}
                    newton::Progress::Solved(#solved) if #newton.is_principal(&#solved.element) => break #solved,
                    #ended => {
                        if let Some(#solved) = self.settled(#step, *state, #given, #mu, &mut #newton, #ended)? {
                            break #solved;
                        }
                    }
                }
            };
            let #solved = #found.element;
            #matrices
            #rest
        }

        /// The solution to be taken where the one found is not known to be principal, or none was
        /// found. None where the iteration begins again, at the principal root.
        #[cold]
        #[inline(never)]
        fn settled(
            &self,
            #step: T,
            state: #state #used,
            given: #given_type,
            #mu: #momenta_type,
            #newton: &mut newton::Newton<'_, T, #elements, #node_type #used, #dimension>,
            #ended: newton::Progress<#elements>,
        ) -> Result<Option<newton::Solved<#elements>>, StepError> {
            let failed = match #ended {
                newton::Progress::Continue => return Ok(None),
                newton::Progress::Solved(solved) => Ok(solved),
                newton::Progress::Failed(e) => Err(e),
            };
            let asked = failed.as_ref().ok().map(|solved| &solved.element);
            let values = #newton.values();
            let traced = self.principal(#step, &given, &values, &#mu, #newton.certificate(), asked);
            let e = match (traced, failed) {
                (Ok(None), Ok(solved)) => return Ok(Some(solved)),
                (Ok(Some(root)), _) if #newton.restart(root) => return Ok(None),
                (Ok(_), Err(e)) => e,
                (Ok(_), Ok(_)) => #newton.unpolished(),
                (Err(fold), failed) => {
                    #contact
                    #newton.folded(fold, failed.err())
                }
            };
            Err(self.refused(state, #step, e))
        }

        /// Says which equation is worst, and which step could be solved.
        #[cold]
        #[inline(never)]
        fn refused(&self, state: #state #used, h: T, e: newton::NewtonError) -> StepError {
            const CONFIGURATIONS: &[&str] = &[#(#configurations),*];
            let e = e.explained(h, &CONFIGURATIONS, |h, search| {
                self.step(&mut { state }, &mut #work { h, search })
            });
            StepCause::from(e).at_node(state.#node)
        }

        #functions
    };
    (principal.node_type(), step)
}
