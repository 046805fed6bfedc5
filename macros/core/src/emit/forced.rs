//! The step of a forced Moser-Veselov equation, or of its analogue on SU(2): one scalar equation is solved, then the
//! torques at the node are applied. Takes the derivation; gives the edge momentum and the torques on arrival, from
//! which the runtime's protocol makes the step. On SU(2) it gives `step` and the error messages too.

use super::element::{Family, family};
use super::expression::{Bindings, program};
use super::items::{self, letters_of, node_locals, parameter_locals, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::{at, here, step_signature};
use crate::algebra::Rational;
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::select_solver::MoserVeselov;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node, Shift};
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// The torques at the nodes.
struct Torques {
    /// At the first node of an edge, on that edge.
    leave: Expr,
    /// At the second node of the edge, evaluated there.
    arrive: Expr,
    /// Both at one node, in the body frame, if the model states them in space.
    seen: Option<Expr>,
}

/// The prepared factor that the solver takes.
pub(super) fn body(d: &Derivation) -> TokenStream {
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
    let kind = items::factor_type(d);
    let used = Generics::of(d).used();
    let torques = Torques {
        leave: expr::neg(mv.rest.clone()),
        // This method requires that `arrive` is known.
        arrive: mv
            .arrive
            .clone()
            .unwrap_or_else(|| expr::neg(mv.rest.clone())),
        seen: mv.torque.clone(),
    };
    if super::stepper::is_forced(d) {
        let arrived = kept(d, names, &torques);
        return quote!(#begin #arrived);
    }
    // On SO(3), another module emits the free body.
    let step = match torques.leave.is_zero() && torques.arrive.is_zero() {
        true => super::quaternionic::free(d, names),
        false => kept(d, names, &torques),
    };
    quote! {
        #step
        #begin

        /// Reports how far the step exceeds the bound, and a step size that succeeds.
        #[cold]
        fn refused(&self, state: #state #used, factor: &#kind, h: T, e: QuaternionError) -> StepError {
            let e = e.with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
            StepCause::from(e).at_node(state.#node)
        }
    }
}

/// The function that gives the edge starting at a node, for the first step from a state and for the search of a step
/// size.
fn begin(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let c = &d.spec.configurations[0];
    let momentum = per_configuration(d, "momentum", 0);
    let (mut element, own) = (variable(s, c.element), own(d, c.element));
    let mut bindings = Bindings::new();
    let mut needed = letters_of([&mv.rest]);
    let quaternion = family(c) == Family::Quaternion;
    let attitude = match quaternion {
        true => quote!(state.#own.rotation()),
        false => quote!(state.#own),
    };
    let mut turn = TokenStream::new();
    if c.side.is_body() && quaternion {
        element = names.local("turn");
        turn = quote!(let #element = #attitude.matrix(););
    } else if c.side.is_body() {
        needed.push(at(c.element, Shift::HERE));
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = here(d, names, &needed, &mut bindings);
    let step = variable(s, d.spec.step);
    let p = schedule::program(s, std::slice::from_ref(&mv.rest), "t");
    let (lets, values) = program(&p, &bindings);
    let [kick, space] = ["kick", "space"].map(|base| names.local(base));
    let edge = match c.side.is_body() {
        // The spatial momentum is used directly. A transformation to the body frame and back would add rounding
        // errors.
        true if mv.rest.is_zero() => {
            quote!(Edge::new(#element.tr_mul(&state.#momentum.0), state.#momentum.0))
        }
        true => quote! {
            let #kick = #(#values)*;
            Edge::new(#element.tr_mul(&state.#momentum.0) - #kick, state.#momentum.0 - #element * #kick)
        },
        false => {
            let rest = (!mv.rest.is_zero()).then(|| quote!(- (#(#values)*)));
            quote! {
                let #space = state.#momentum.0 #rest;
                Edge::new(#attitude.matrix().tr_mul(&#space), #space)
            }
        }
    };
    let used = Generics::of(d).used();
    quote! {
        /// The edge that begins at this state, for a step `h`.
        #[inline(never)]
        fn edge(&self, state: &#state #used, #step: T) -> Edge<T> {
            #parameters
            #locals
            #turn
            #lets
            #edge
        }
    }
}

/// The function that gives the next node and applies the torques where an edge ends. On SU(2) it is the whole step,
/// which takes its edge from the workspace and stores the next one there.
fn kept(d: &Derivation, names: &Names, torques: &Torques) -> TokenStream {
    let (leave, arrive) = (&torques.leave, &torques.arrive);
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[0];
    let (element, momentum) = (own(d, c.element), per_configuration(d, "momentum", 0));
    let [moved, mut next] = ["moved", "next"].map(|tag| tagged(d, names, c.element, tag));
    let quaternion = family(c) == Family::Quaternion;
    let [edge, following, space, momentum_next, node] =
        ["edge", "edge_next", "space", "momentum_next", "node"].map(|base| names.local(base));
    let step = variable(s, d.spec.step);
    // All torques act at the new node: those that arrive, and those that leave on the next edge. If the two are
    // equal, each is half their sum.
    let leave = expr::shift_time(s, leave, 1);
    let wanted: Vec<Expr> = if leave == *arrive {
        vec![prescaled(s, &expr::scale(Rational::integer(2), leave), &[])]
    } else {
        vec![prescaled(s, arrive, &[]), prescaled(s, &leave, &[])]
    };
    let mut needed = letters_of(&wanted);
    if !quaternion {
        needed.push(at(c.element, Shift::NEXT));
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 1));
    let mut bindings = Bindings::new();
    let reference = |id| {
        let r = own(d, id);
        quote!(state.#r)
    };
    let (at_node, onwards) = (at(c.element, Shift::HERE), at(c.element, Shift::NEXT));
    // The matrix is used at least twice, and forming it once costs less than rotating each vector.
    let solved = |_| quote!(#moved.matrix());
    let mut attitude = TokenStream::new();
    if quaternion {
        // Most quantities depend on a quaternion only through its rotation.
        let own = std::mem::replace(&mut next, names.local("turn_next"));
        let turn = solved(0);
        attitude.extend(quote!(let #next = #turn;));
        bindings.bind_rotation(onwards, next.clone());
        let carried = d.transports.iter().any(|t| match t {
            AdvectionRule::Defined(e) | AdvectionRule::Carried { value: e, .. } => {
                stands_alone(e, at_node)
            }
            AdvectionRule::Advanced => false,
        });
        if carried || wanted.iter().any(|e| stands_alone(e, onwards)) {
            attitude.extend(quote!(let #own = #moved.unit_quaternion().matrix();));
            bindings.bind(onwards, own);
        }
    }
    let locals = node_locals(d, names, 1, &needed, &solved, &reference, &mut bindings);
    let p = schedule::program(s, &wanted, "t");
    let (lets, values) = program(&p, &bindings);
    let seen = torques.seen.as_ref();
    let seen = seen.filter(|e| !(quaternion && stands_alone(e, at_node)));
    let seen = seen.map(|e| seen_from_body(d, names, e, &next, &needed));
    // The spatial momentum is known only at the end of the step. With the torque in the body frame, the next edge
    // need not wait for it.
    let from_body = |left: TokenStream| match &seen {
        Some((_, torque)) => quote!(#next.tr_mul(&#space) + #torque),
        None => quote!(#next.tr_mul(&#left)),
    };
    let seen_lets = seen.as_ref().map(|(lets, _)| lets);
    // The torques, then the momentum at the node unless it already has a name, then the edge that starts there.
    let (act, momentum_there, edge_there) = match values.as_slice() {
        [both] if c.side.is_body() => {
            let [torque, kick] = ["torque", "kick"].map(|base| names.local(base));
            (
                quote!(let #torque = #both; let #kick = #next * #torque;),
                Some(quote!(#space + #kick * T::from_f64(0.5))),
                quote!(Edge::new(#next.tr_mul(&#space) + #torque, #space + #kick)),
            )
        }
        [both] => {
            let [kick, left] = ["kick", "left"].map(|base| names.local(base));
            let body = from_body(quote!(#left));
            (
                quote!(#seen_lets let #kick = #both; let #left = #space + #kick;),
                Some(quote!(#space + #kick * T::from_f64(0.5))),
                quote!(Edge::new(#body, #left)),
            )
        }
        [arrived, kick] if c.side.is_spatial() => {
            let left = names.local("left");
            let body = from_body(quote!(#left));
            let acted = quote! {
                #seen_lets
                let #momentum_next = #space + #arrived;
                let #left = #momentum_next + #kick;
            };
            (acted, None, quote!(Edge::new(#body, #left)))
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
            (
                quote!(#(#named)* let #momentum_next = #space #arrived;),
                None,
                quote!(Edge::new(#next.tr_mul(&#space) #(#body)*, #momentum_next #left)),
            )
        }
    };
    let at_next = quote! {
        #parameters
        #attitude
        #locals
        #lets
        let #space = #edge.space();
        #act
    };
    if !quaternion {
        let momentum = momentum_there.unwrap_or_else(|| quote!(#momentum_next));
        let body = quote! {
            #at_next
            Moving { attitude: #moved.rotation(), momentum: SpatialMomentum(#momentum), edge: #edge_there }
        };
        return arrived(d, names, &moved, &body);
    }
    let factor = body(d);
    // References are constant. The fields that change are written in place and not read back.
    let follow = follow(d, names);
    let named = momentum_there.map(|momentum| quote!(let #momentum_next = #momentum;));
    let [turned, arrival] = ["turned", "arrival"].map(|base| names.local(base));
    let finite = [quote!(all_finite(&#momentum_next.0))];
    let finite = super::domain::finite_in_step(d, names, &finite);
    step_signature(
        d,
        quote! {
            #follow
            let #edge = &work.edge;
            let #turned = #edge.turn_in_quaternions(#factor, #step, &state.#element);
            let #moved = match #turned {
                Ok(turned) => turned,
                Err(e) => return Err(self.refused(*state, #factor, #step, e)),
            };
            #at_next
            #named
            let #following = #edge_there;
            let (#arrival, #momentum_next) = (#moved.unit_quaternion(), SpatialMomentum(#momentum_next));
            #finite
            (state.#element, work.here.#element) = (#arrival, #arrival);
            (state.#momentum, work.here.#momentum) = (#momentum_next, #momentum_next);
            state.#node += 1;
            work.edge = #following;
            Ok(())
        },
    )
}

/// The step size, and a renewed workspace if it belongs to another state.
pub(super) fn follow(d: &Derivation, names: &Names) -> TokenStream {
    let (node, step) = (
        names.local("node"),
        variable(&d.letters.symbols, d.spec.step),
    );
    let references = items::factor_references(d);
    let another = (!references.is_empty()).then(|| {
        // Compositions change the attitude in every step while the body stays the same.
        let same = unmoved(d, &references);
        quote! {
            if !(#(#same)&*) {
                work.factor = match self.factor(state) {
                    Ok(factor) => factor,
                    Err(_) => return Err(StepCause::not_finite("body").at_node(state.#node)),
                };
            }
        }
    });
    let moved_away = moved_away(d);
    quote! {
        let #step = work.h;
        if #moved_away {
            #another
            work.edge = self.edge(state, #step);
            work.here = *state;
        }
    }
}

/// Tests whether each reference has the same value in the state and in the workspace.
fn unmoved(d: &Derivation, references: &[SymbolId]) -> Vec<TokenStream> {
    let one = |id: &SymbolId| {
        let field = own(d, *id);
        match d.letters.symbols.get(*id).shape.is_scalar() {
            true => quote!((work.here.#field == state.#field)),
            false => quote!(same(&work.here.#field, &state.#field)),
        }
    };
    references.iter().map(one).collect()
}

/// Whether the workspace belongs to another state.
fn moved_away(d: &Derivation) -> TokenStream {
    let element = own(d, d.spec.configurations[0].element);
    let momentum = per_configuration(d, "momentum", 0);
    let equal = unmoved(d, &items::kept(d));
    let others = (!equal.is_empty()).then(|| quote!(|| !(#(#equal)&*)));
    quote! {
        work.here.#element != state.#element || work.here.#momentum != state.#momentum #others
    }
}

/// The function for the rest of the step, given the solved rotation of the edge.
fn arrived(d: &Derivation, names: &Names, moved: &Ident, body: &TokenStream) -> TokenStream {
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let (edge, step) = (
        names.local("edge"),
        variable(&d.letters.symbols, d.spec.step),
    );
    quote! {
        /// The next node and the edge that begins there, given the attitude there.
        #[inline(always)]
        fn arrived(&self, state: &#state #used, #edge: &Edge<T>, #step: T, #moved: TurnedRotation<T>) -> Moving<T> {
            #body
        }
    }
}

/// Whether a unit quaternion occurs in an expression other than through the rotation that it covers.
fn stands_alone(e: &Expr, element: Letter) -> bool {
    let is_element = |e: &Expr| matches!(e.node(), Node::Letter(l) if *l == element);
    match e.node() {
        Node::Letter(_) => is_element(e),
        Node::Map(Map::Rotation, a) if is_element(a) => false,
        _ => e.children().iter().any(|c| stands_alone(c, element)),
    }
}

/// The torque at the new node in the body frame, as a local and its name. The edge that starts there then need not
/// wait for the momentum in space.
fn seen_from_body(
    d: &Derivation,
    names: &Names,
    e: &Expr,
    next: &Ident,
    known: &[Letter],
) -> (TokenStream, Ident) {
    let s = &d.letters.symbols;
    let e = prescaled(s, e, &items::kept(d));
    let torque = names.local("torque");
    let mut bindings = Bindings::new();
    let c = &d.spec.configurations[0];
    let here = at(c.element, Shift::HERE);
    match family(c) {
        Family::Quaternion => bindings.bind_rotation(here, next.clone()),
        _ => bindings.bind(here, next.clone()),
    }
    let letters = expr::letters(&e);
    let mut references = TokenStream::new();
    for id in items::kept(d) {
        if letters.iter().any(|l| l.symbol == id) {
            let (field, local) = (own(d, id), tagged(d, names, id, "reference"));
            bindings.bind(at(id, Shift::HERE), local.clone());
            // The value at the node has bound the other references already.
            if !known.iter().any(|l| l.symbol == id) {
                references.extend(quote!(let #local = state.#field;));
            }
        }
    }
    let p = schedule::program(s, &[e], "b");
    let (lets, values) = program(&p, &bindings);
    (
        quote! {
            #references
            #lets
            let #torque = #(#values)*;
        },
        torque,
    )
}

/// Twice an expression, in the form of [`prescaled`].
pub(super) fn doubled(s: &Symbols, e: &Expr) -> Expr {
    prescaled(s, &expr::scale(Rational::integer(2), e.clone()), &[])
}

/// The expression with numeric factors multiplied into the constant factor of a vector product instead of the
/// product, so that they need not wait for the new node. `references` count as constants.
fn prescaled(s: &Symbols, e: &Expr, references: &[SymbolId]) -> Expr {
    let constant = |e: &Expr| {
        expr::letters(e).iter().all(|l| {
            let role = s.get(l.symbol).role;
            matches!(role, Role::Parameter | Role::Step) || references.contains(&l.symbol)
        })
    };
    let of = |e: &Expr| prescaled(s, e, references);
    match e.node() {
        Node::Neg(a) => expr::neg(of(a)),
        Node::Sum(terms) => expr::sum(terms.iter().map(of), e.shape()),
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
                Node::Sum(terms) => expr::sum(terms.iter().map(|t| of(&scaled(t))), e.shape()),
                Node::Cross(a, b) if constant(a) => expr::cross(scaled(a), b.clone()),
                Node::Cross(a, b) if constant(b) => expr::cross(a.clone(), scaled(b)),
                _ => e.clone(),
            }
        }
        _ => e.clone(),
    }
}
