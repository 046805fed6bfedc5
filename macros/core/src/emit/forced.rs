//! The step of a forced Moser-Veselov equation: one quartic, then the node's torques.
//! Takes the derivation; gives `step`, the edge momentum and the words of a refusal.

use super::expression::{Bindings, program};
use super::items::{self, letters_of, node_locals, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::{Update, at, finish, here, step_signature, update};
use crate::algebra::Rational;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::recognise::{self, Method, MoserVeselov, Riccati};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// What leaves the first node of an edge and what arrives at its second, where the momentum of the
/// next edge can be made with the new node and kept.
fn torques(d: &Derivation) -> Option<(Expr, Expr)> {
    match (&d.solve.method, d.solve.riccati.first()) {
        (Method::ForcedMoserVeselov, Some(Riccati::Exact(mv))) if recognise::keeps_edge(mv) => {
            let arrive = mv.arrive.clone()?;
            Some((expr::neg(mv.rest.clone()), arrive))
        }
        _ => None,
    }
}

/// Whether the workspace keeps the edge that begins at the state.
pub(super) fn keeps_edge(d: &Derivation) -> bool {
    torques(d).is_some()
}

/// The body to solve with.
fn body(d: &Derivation) -> TokenStream {
    match items::factor_references(d).is_empty() {
        true => quote!(&self.factor),
        false => quote!(&work.factor),
    }
}

/// The functions of the stepper that make a step.
pub(super) fn step(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let state = item(d, "State");
    let node = names.local("node");
    let begin = begin(d, names, mv);
    let used = Generics::of(d).used();
    let (step, momentum) = match torques(d) {
        Some((leave, arrive)) => (
            kept(d, names, &leave, &arrive),
            quote!(self.edge(&state, trial).body()),
        ),
        None => (plain(d, names), quote!(self.edge_momentum(&state, trial))),
    };
    quote! {
        #step
        #begin

        /// Says how far the step is beyond the bound, and which step could be solved.
        #[cold]
        fn refused(&self, state: #state #used, factor: &Poinsot<T>, h: T, e: MoserVeselovError) -> StepError {
            let e = e.with_searched_step(factor, h, |trial| #momentum);
            StepCause::from(e).at_node(state.#node)
        }
    }
}

/// The edge that starts at a node, or its momentum where nothing else is kept: for the solve at a
/// given step, and for the search of a step.
fn begin(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let c = &d.spec.configurations[0];
    let momentum = per_configuration(d, "momentum", 0);
    let (element, own) = (variable(s, c.element), own(d, c.element));
    let mut bindings = Bindings::new();
    let mut needed = letters_of([&mv.rest]);
    if c.side == Side::Body {
        needed.push(at(c.element, Shift::HERE));
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = here(d, names, &needed, &mut bindings);
    let step = variable(s, d.spec.step);
    let p = schedule::program(s, std::slice::from_ref(&mv.rest), "t");
    let (lets, values) = program(&p, &bindings);
    let node_momentum = match c.side {
        Side::Body => quote!(#element.tr_mul(&state.#momentum.0)),
        Side::Spatial => quote!(state.#momentum.0),
    };
    let rest = (!mv.rest.is_zero()).then(|| quote!(- (#(#values)*)));
    let used = Generics::of(d).used();
    if keeps_edge(d) && c.side == Side::Spatial {
        let space = names.local("space");
        return quote! {
            /// The edge that begins at this state, for a step `h`.
            #[inline(never)]
            fn edge(&self, state: &#state #used, #step: T) -> Edge<T> {
                #parameters
                #locals
                #lets
                let #space = #node_momentum #rest;
                Edge::new(state.#own.matrix().tr_mul(&#space), #space)
            }
        };
    }
    if keeps_edge(d) {
        let kick = names.local("kick");
        // The spatial momentum is not taken through the body frame and back: each way would leave
        // its rounding in what is conserved.
        return quote! {
            /// The edge that begins at this state, for a step `h`.
            #[inline(never)]
            fn edge(&self, state: &#state #used, #step: T) -> Edge<T> {
                #parameters
                #locals
                #lets
                let #kick = #(#values)*;
                Edge::new(#node_momentum - #kick, state.#momentum.0 - #element * #kick)
            }
        };
    }
    quote! {
        /// The momentum of the edge that starts at this node, for a step `h`.
        #[inline]
        fn edge_momentum(&self, state: &#state #used, #step: T) -> SVector<T, 3> {
            #parameters
            #locals
            #lets
            #node_momentum #rest
        }
    }
}

/// The step that finds its edge in the workspace and leaves the next one there.
fn kept(d: &Derivation, names: &Names, leave: &Expr, arrive: &Expr) -> TokenStream {
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[0];
    let state = item(d, "State");
    let (element, momentum) = (own(d, c.element), per_configuration(d, "momentum", 0));
    let [moved, next] = ["moved", "next"].map(|tag| tagged(d, names, c.element, tag));
    let [edge, following, space, momentum_next, node] =
        ["edge", "edge_next", "space", "momentum_next", "node"].map(|base| names.local(base));
    let step = variable(s, d.spec.step);
    // Everything acts at the new node: what arrives there, and what leaves it on the next edge.
    // Where the two are equal, half their sum is each of them.
    let leave = expr::shift_time(s, leave, 1);
    let wanted: Vec<Expr> = if leave == *arrive {
        vec![prescaled(s, &expr::scale(Rational::integer(2), leave))]
    } else {
        vec![prescaled(s, arrive), prescaled(s, &leave)]
    };
    let mut needed = letters_of(&wanted);
    let mut element_next = at(c.element, Shift::HERE);
    element_next.shift.time = 1;
    needed.push(element_next);
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 1));
    let mut bindings = Bindings::new();
    let reference = |id| {
        let r = own(d, id);
        quote!(state.#r)
    };
    let solved = |_| quote!(#moved);
    let locals = node_locals(d, names, 1, &needed, &solved, &reference, &mut bindings);
    let p = schedule::program(s, &wanted, "t");
    let (lets, values) = program(&p, &bindings);
    let act = match values.as_slice() {
        [both] if c.side == Side::Body => {
            let [torque, kick] = ["torque", "kick"].map(|base| names.local(base));
            quote! {
                let #torque = #both;
                let #kick = #next * #torque;
                let #momentum_next = #space + #kick * T::from_f64(0.5);
                let #following = Edge::new(#next.tr_mul(&#space) + #torque, #space + #kick);
            }
        }
        [both] => {
            let [kick, left] = ["kick", "left"].map(|base| names.local(base));
            quote! {
                let #kick = #both;
                let #momentum_next = #space + #kick * T::from_f64(0.5);
                let #left = #space + #kick;
                let #following = Edge::new(#next.tr_mul(&#left), #left);
            }
        }
        [arrived, kick] if c.side == Side::Spatial => {
            let left = names.local("left");
            quote! {
                let #momentum_next = #space + #arrived;
                let #left = #momentum_next + #kick;
                let #following = Edge::new(#next.tr_mul(&#left), #left);
            }
        }
        _ => {
            let acting: Vec<_> = ["arrive", "leave"]
                .map(|base| names.local(base))
                .into_iter()
                .zip(&values)
                .zip(&p.results)
                .map(|((name, value), e)| (!e.is_zero()).then_some((name, value)))
                .collect();
            let named = acting.iter().flatten().map(|(n, v)| quote!(let #n = #v;));
            let body = acting.iter().flatten().map(|(n, _)| quote!(+ #n));
            let space_part = |i: usize| {
                let (n, _) = acting.get(i)?.as_ref()?;
                Some(quote!(+ #next * #n))
            };
            let (arrived, left) = (space_part(0), space_part(1));
            quote! {
                #(#named)*
                let #momentum_next = #space #arrived;
                let #following = Edge::new(#next.tr_mul(&#space) #(#body)*, #momentum_next #left);
            }
        }
    };
    let factor = body(d);
    let another = (!items::factor_references(d).is_empty()).then(|| {
        quote! {
            work.factor = match self.factor(state) {
                Ok(factor) => factor,
                Err(_) => return Err(StepCause::NotFinite { what: "body" }.at_node(state.#node)),
            };
        }
    });
    let references: Vec<_> = items::kept(d).into_iter().map(|id| own(d, id)).collect();
    let arrived_at = tagged(d, names, c.element, "arrived");
    // References do not change: what moves is written where it is.
    let (moved_away, arrived) = if references.is_empty() {
        (
            quote!(work.here != *state),
            quote! {
                *state = #state {
                    #element: #moved.rotation(),
                    #momentum: SpatialMomentum(#momentum_next),
                    #node: state.#node + 1,
                };
                work.here = *state;
            },
        )
    } else {
        let equal = items::kept(d).into_iter().map(|id| {
            let field = own(d, id);
            match s.get(id).shape.is_scalar() {
                true => quote!((work.here.#field == state.#field)),
                false => quote!(same(&work.here.#field, &state.#field)),
            }
        });
        (
            quote! {
                work.here.#element != state.#element
                    || work.here.#momentum != state.#momentum
                    || !(#(#equal)&*)
            },
            quote! {
                let (#arrived_at, #momentum_next) =
                    (#moved.rotation(), SpatialMomentum(#momentum_next));
                (state.#element, work.here.#element) = (#arrived_at, #arrived_at);
                (state.#momentum, work.here.#momentum) = (#momentum_next, #momentum_next);
                state.#node += 1;
            },
        )
    };
    step_signature(
        d,
        quote! {
            let #step = work.h;
            if #moved_away {
                #another
                work.edge = self.edge(state, #step);
                work.here = *state;
            }
            let #edge = &work.edge;
            let #moved = match #edge.turn(#factor, #step, &state.#element) {
                Ok(turned) => turned,
                Err(e) => return Err(self.refused(*state, #factor, #step, e)),
            };
            #parameters
            #locals
            #lets
            let #space = #edge.space();
            #act
            if !all_finite(&#momentum_next) {
                return Err(StepCause::NotFinite { what: "momentum" }.at_node(state.#node));
            }
            #arrived
            work.edge = #following;
            Ok(())
        },
    )
}

/// The same expression with its numbers multiplied into the constant factor of a vector product
/// rather than into the product: they need not wait for the new node.
fn prescaled(s: &Symbols, e: &Expr) -> Expr {
    let constant = |e: &Expr| {
        expr::letters(e)
            .iter()
            .all(|l| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step))
    };
    match e.node() {
        Node::Neg(a) => expr::neg(prescaled(s, a)),
        Node::Sum(terms) => expr::sum(terms.iter().map(|t| prescaled(s, t)), e.shape()),
        Node::Product(factors) => {
            let (numbers, others): (Vec<Expr>, Vec<Expr>) = factors
                .iter()
                .cloned()
                .partition(|f| f.shape().is_scalar() && constant(f));
            let scaled = |a: &Expr| expr::product(numbers.iter().chain([a]).cloned());
            let [only] = others.as_slice() else {
                return e.clone();
            };
            match only.node() {
                Node::Sum(terms) => {
                    expr::sum(terms.iter().map(|t| prescaled(s, &scaled(t))), e.shape())
                }
                Node::Cross(a, b) if constant(a) => expr::cross(scaled(a), b.clone()),
                Node::Cross(a, b) if constant(b) => expr::cross(a.clone(), scaled(b)),
                _ => e.clone(),
            }
        }
        _ => e.clone(),
    }
}

/// The step that keeps nothing but the step size.
fn plain(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[0];
    let edge = names.local("edge");
    let omega = variable(s, c.velocity);
    let step = variable(s, d.spec.step);
    let mut bindings = Bindings::new();
    let updates = update(d, 0);
    let list = match &updates {
        Update::Acted { leave, arrive } => vec![leave, arrive],
        Update::Added(e) | Update::Brought(e) => vec![e],
    };
    let uses_velocity = list
        .iter()
        .any(|e| expr::contains(e, at(c.velocity, Shift::HERE)));
    let mut needed: Vec<Letter> = letters_of(list.iter().copied());
    if let Update::Acted { leave, .. } = &updates
        && !leave.is_zero()
    {
        needed.push(at(c.element, Shift::HERE));
    }
    let mut all = with_transports(d, &needed, 0);
    all.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let locals = here(d, names, &needed, &mut bindings);
    let matrix = uses_velocity.then(|| {
        let name = tagged(d, names, c.velocity, "matrix");
        bindings.bind(at(c.velocity, Shift::HERE), name.clone());
        quote!(let #name = #omega.matrix();)
    });
    let rest = finish(
        d,
        names,
        &mut bindings,
        &|_| quote!(#omega),
        TokenStream::new(),
    );
    let factor = body(d);
    step_signature(
        d,
        quote! {
            let #step = work.h;
            let #edge = self.edge_momentum(state, #step);
            let #omega = match forced(#factor, &(#edge * #step)) {
                Ok(solved) => solved,
                Err(e) => return Err(self.refused(*state, #factor, #step, e)),
            };
            #matrix
            #parameters
            #locals
            #rest
        },
    )
}
