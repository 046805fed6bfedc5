//! The step of a model whose velocities are found in several blocks. The values known at the node are computed once
//! for all blocks; then each block is solved by its own method, and all blocks advance to the next node. Takes the
//! derivation; gives the factors that the model stores, the workspace and `step`.

use super::constant_factors::Constant;
pub(super) use super::constant_factors::linear_solution;
use super::element::{self, Family, family};
use super::expression::{Bindings, program};
use super::force_at_node::at_nodes;
use super::items::{letters_of, parameter_locals, text, with_transports};
use super::left_factor::default_solver;
use super::momentum_update::seen_from_space;
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::newton::{JointUnknowns, onwards};
use super::single_body::{scaled_momentum, single_body_solution};
use super::sizes::Generics;
use super::step::{AtTheStart, at, finish, here, node_momentum, step_signature};
use super::workspace::filled;
pub(super) use super::workspace::{trial, work, work_init};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::blocks::Block;
use crate::derive::quaternionic::Quaternionic;
use crate::derive::select_solver::{Method, MoserVeselov, StepEquation};
use crate::derive::spatial_increment_form::{SpatialIncrementForm, displaced};
use crate::derive::two_sided_linear::TwoSidedLinear;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// The blocks with their numbers, starting at 1.
fn numbered(d: &Derivation) -> impl Iterator<Item = (usize, &Block)> {
    d.solve.blocks.iter().enumerate().map(|(i, b)| (i + 1, b))
}

/// The blocks that Newton's method solves, with their numbers.
pub(super) fn by_newton(d: &Derivation) -> impl Iterator<Item = (usize, &Block)> {
    numbered(d).filter(|(_, b)| b.is_newton())
}

/// The configuration and the Moser-Veselov equation of a block with one member.
fn exact<'a>(d: &'a Derivation, b: &'a Block) -> Option<(usize, &'a MoserVeselov)> {
    match (&b.method, b.members.as_slice()) {
        (Method::LeftFactor | Method::Davenport, [i]) => match &d.solve.riccati[*i] {
            StepEquation::Exact(mv) => Some((*i, mv)),
            _ => None,
        },
        _ => None,
    }
}

/// The numbers of the blocks whose bodies have the same constant factor as `b`, including `b`. Since none of them
/// depends on another, one call solves all. Empty if `b` is not such a block.
fn alike(d: &Derivation, b: &Block) -> Vec<usize> {
    let of_body = |b: &Block| {
        let own = exact(d, b).filter(|_| matches!(b.method, Method::LeftFactor));
        own.filter(|(i, _)| family(&d.spec.configurations[*i]) == Family::Rotation)
            .map(|(_, mv)| mv.factor.clone())
    };
    let factor = of_body(b);
    let all = numbered(d).filter(|(_, other)| factor.is_some() && of_body(other) == factor);
    all.map(|(n, _)| n).collect()
}

/// The configuration and the form of a block with a linear balance.
fn linear<'a>(d: &'a Derivation, b: &'a Block) -> Option<(usize, &'a TwoSidedLinear)> {
    // The balance of a constrained configuration is linear too, but contains a multiplier.
    match (&b.method, b.members.as_slice()) {
        (Method::Linear, [i]) => match &d.solve.riccati[*i] {
            StepEquation::Linear(form) => Some((*i, form)),
            _ => None,
        },
        _ => None,
    }
}

/// The linear form of the balance of a field that forms a block by itself.
pub(super) fn linear_field(d: &Derivation, i: usize) -> Option<&TwoSidedLinear> {
    let of_field = matches!(family(&d.spec.configurations[i]), Family::Field(_));
    let all = numbered(d).filter_map(|(_, b)| linear(d, b));
    all.filter(|_| of_field)
        .find(|(j, _)| *j == i)
        .map(|(_, form)| form)
}

/// For each configuration, the form of its balance in the spatial increment, if one exists.
fn all_displaced(d: &Derivation) -> Vec<Option<SpatialIncrementForm>> {
    let is_linear = |i: usize| numbered(d).any(|(_, b)| linear(d, b).is_some_and(|(j, _)| i == j));
    (0..d.spec.configurations.len())
        .map(|i| displaced(d, i).filter(|_| is_linear(i)))
        .collect()
}

/// The names of the inverses that the model stores for block `n`.
fn inverses(n: usize) -> [Ident; 2] {
    ["left", "right"].map(|side| format_ident!("inverse_{n}_{side}"))
}

/// The constant factors of the linear balance of a field.
fn constant<'a>(d: &'a Derivation, b: &'a Block) -> Option<Constant<'a>> {
    let (i, form) = linear(d, b)?;
    Constant::of(d, i, form)
}

/// The inverse of a constant factor, which the model stores.
pub(super) struct Inverse {
    /// The field's name.
    pub name: Ident,
    /// The factor.
    pub of: Expr,
}

/// The inverses that the model stores.
pub(super) fn kept_inverses(d: &Derivation) -> Vec<Inverse> {
    let names = &Names::new(d);
    match d.solve.method {
        Method::Blocks => {}
        Method::Newton => return super::newton::kept_inverses(d, names),
        _ => return Vec::new(),
    }
    let beforehand = each_newton(d, names, |_, t| super::newton::inverses(t));
    let forms = all_displaced(d);
    let of_block = |(n, b): (usize, &Block)| {
        let factors = match changed(d, b, &forms) {
            Some(form) => [&form.left, &form.right].map(|of| Some(of.clone())),
            None => constant(d, b)?.factors,
        };
        let named = inverses(n).into_iter().zip(factors);
        let kept = named.filter_map(|(name, of)| Some(Inverse { name, of: of? }));
        Some(kept.collect::<Vec<_>>())
    };
    let own = numbered(d).filter_map(of_block).flatten();
    own.chain(beforehand.into_iter().flatten()).collect()
}

/// The configuration and the equation of a block in unit quaternions.
fn quaternionic<'a>(d: &'a Derivation, b: &'a Block) -> Option<(usize, &'a Quaternionic)> {
    match (&b.method, b.members.as_slice()) {
        (Method::UnitQuaternions, [i]) => match &d.solve.riccati[*i] {
            StepEquation::Quaternionic(q) => Some((*i, q)),
            _ => None,
        },
        _ => None,
    }
}

/// A constant factor that the model stores.
pub(super) struct Factor<'a> {
    /// The field's name.
    pub name: Ident,
    /// The configuration to which the factor belongs.
    pub configuration: usize,
    /// The factor.
    pub value: &'a Expr,
    /// The real number `β` of the equation on SU(2).
    pub real: Option<&'a Expr>,
}

impl Factor<'_> {
    /// The expressions from which the field is computed.
    pub fn made_of(&self) -> impl Iterator<Item = &Expr> {
        [self.value].into_iter().chain(self.real)
    }
}

/// The constant factors that the model stores.
pub(super) fn factors(d: &Derivation) -> Vec<Factor<'_>> {
    let kept = numbered(d).filter_map(|(n, b)| {
        let own = |configuration, value, real| Factor {
            name: format_ident!("factor_{n}"),
            configuration,
            value,
            real,
        };
        match b.method {
            // Bodies with equal factors share one field.
            Method::LeftFactor if alike(d, b).first().is_some_and(|first| *first < n) => None,
            Method::LeftFactor => exact(d, b).map(|(i, mv)| own(i, &mv.factor, None)),
            _ => quaternionic(d, b).map(|(i, q)| own(i, &q.edge.factor, Some(&q.real))),
        }
    });
    kept.collect()
}

pub(super) fn search(n: usize) -> Ident {
    format_ident!("search_{n}")
}

/// Block `n`, solved by Newton's method; `block` is this block as a model of its own.
fn together<'a>(
    whole: &'a Derivation,
    names: &'a Names,
    n: usize,
    b: &'a Block,
    block: &'a Derivation,
) -> JointUnknowns<'a> {
    JointUnknowns {
        whole,
        block,
        members: &b.members,
        number: Some(n),
        names,
    }
}

/// Calls `f` with each block of Newton's method as a model of its own.
pub(super) fn each_newton<R>(
    d: &Derivation,
    names: &Names,
    mut f: impl FnMut(usize, &JointUnknowns) -> R,
) -> Vec<R> {
    by_newton(d)
        .map(|(n, b)| {
            let block = d.of_block(b);
            f(n, &together(d, names, n, b, &block))
        })
        .collect()
}

/// `step`, block by block.
pub(super) fn step(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let node = names.local("node");
    let step = variable(s, d.spec.step);
    let work = item(d, "Workspace");
    // Expressions known at the node, for all blocks.
    let mut known: Vec<Expr> = Vec::new();
    // Their positions in `known` that are forces on a body of a Moser-Veselov block, with the configuration.
    let mut acting: Vec<(usize, usize)> = Vec::new();
    let by_change = all_displaced(d);
    let mut needed: Vec<Letter> = onwards(d, &by_change);
    let seen = by_change.iter().flatten().filter_map(|f| f.seen.as_ref());
    needed.extend(letters_of(seen));
    let forces = at_nodes(d);
    let force_on = |i: usize| forces.iter().find(|f| f.configuration == i);
    for b in &d.solve.blocks {
        if let Some((i, form)) = linear(d, b) {
            let moved = by_change[i].as_ref().map(|form| &form.rest);
            match force_on(i) {
                Some(force) => needed.extend(force.needed()),
                None => known.push(moved.unwrap_or(&form.rest).clone()),
            }
            if by_change[i].is_none() && constant(d, b).is_none() {
                known.extend([&form.left, &form.right].map(Expr::clone));
            }
        }
        if let Some((i, q)) = quaternionic(d, b) {
            known.push(q.edge.rest.clone());
            needed.push(at(d.spec.configurations[i].element, Shift::HERE));
        }
        let Some((i, mv)) = exact(d, b) else { continue };
        acting.push((known.len(), i));
        known.push(mv.rest.clone());
        if matches!(b.method, Method::Davenport) {
            known.push(mv.factor.clone());
        }
        let c = &d.spec.configurations[i];
        if c.side.is_body() && family(c) == Family::Rotation {
            needed.push(at(c.element, Shift::HERE));
        }
    }
    let mut known: Vec<Expr> = known
        .iter()
        .map(|e| expr::factored(s, &schedule::displaced(s, e)))
        .collect();
    let mut in_space = Vec::new();
    for (place, i) in acting {
        if let Some(seen) = seen_from_space(d, i, Shift::HERE, &known[place]) {
            known[place] = expr::neg(seen);
            in_space.push(i);
        }
    }
    needed.extend(letters_of(&known));
    for list in each_newton(d, names, |_, t| t.needed()) {
        needed.extend(list);
    }
    needed.sort();
    needed.dedup();
    let mut letters = with_transports(d, &needed, 0);
    letters.extend(with_transports(d, &needed, 1));
    let parameters = parameter_locals(d, quote!(self.parameters), &letters);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let seen = from_space(d, names, &by_change, Shift::HERE, &mut bindings);
    let p = schedule::program(s, &known, "b");
    let (lets, values) = program(&p, &bindings);
    let mut values = values.into_iter();
    let mut after = bindings.clone();
    let (mut solves, mut beside) = (TokenStream::new(), TokenStream::new());
    let mut remembered = TokenStream::new();
    let mut found: Vec<TokenStream> = vec![TokenStream::new(); d.spec.configurations.len()];
    let mut refuses = false;
    let mut side_by_side: BTreeMap<usize, Vec<TokenStream>> = BTreeMap::new();
    for (n, b) in numbered(d) {
        if let (Some((i, form)), Some(moved)) = (linear(d, b), changed(d, b, &by_change)) {
            let c = &d.spec.configurations[i];
            let rest = values.next().filter(|_| !moved.rest.is_zero());
            let minus = rest.map(|rest| quote!(- (#rest)));
            let (element, momentum) = (own(d, c.element), per_configuration(d, "momentum", i));
            let [left, right] = inverses(n);
            let labels = [text(d, &form.left), text(d, &form.right)];
            let leaving = names.local(&format!("{momentum}_leaving"));
            let change = tagged(d, names, c.element, "change");
            solves.extend(quote! {
                let #leaving = state.#momentum.0 #minus;
                let #change = match displaced(
                    &state.#element, &(self.#left * #step), &#leaving, &self.#right, &[#(#labels),*],
                ) {
                    Ok(solved) => solved,
                    Err(e) => return Err(StepCause::Singular(e).at_node(state.#node)),
                };
            });
            after.bind(at(d.letters.direction[i], Shift::HERE), change.clone());
            found[i] = quote!(#change);
            continue;
        }
        if let Some((i, form)) = linear(d, b) {
            let rest = match force_on(i) {
                Some(force) => {
                    let local = force.local(d, names, 0);
                    solves.extend(force.here(d, names, &bindings));
                    Some(quote!(#local))
                }
                None => values.next().filter(|_| !form.rest.is_zero()),
            };
            let omega = variable(s, d.spec.configurations[i].velocity);
            let (at_node, minus) = (
                node_momentum(d, i, d.spec.configurations[i].side),
                rest.map(|rest| quote!(- (#rest))),
            );
            let known = quote!((#at_node #minus));
            let solved = match constant(d, b) {
                Some(kept) => Some(kept.solution(d, i, inverses(n), known)),
                None => {
                    let factors = values.next().zip(values.next());
                    factors.map(|(left, right)| linear_solution(d, i, form, left, known, right))
                }
            };
            solves.extend(quote! {
                let #omega = match #solved {
                    Ok(solved) => solved,
                    Err(e) => return Err(StepCause::Singular(e).at_node(state.#node)),
                };
            });
            found[i] = quote!(#omega);
            continue;
        }
        if let Some((i, mv)) = exact(d, b) {
            refuses = true;
            let rest = values.next().filter(|_| !mv.rest.is_zero());
            let factor = match b.method {
                Method::Davenport => values.next(),
                _ => None,
            };
            let omega = variable(s, d.spec.configurations[i].velocity);
            let scaled = scaled_momentum(d, i, rest, in_space.contains(&i), &step);
            let alike = alike(d, b);
            if let [first, _, ..] = alike.as_slice() {
                let turns = names.local(&format!("turns_{first}"));
                let before = side_by_side.entry(*first).or_default();
                let place = Literal::usize_unsuffixed(before.len());
                before.push(scaled);
                if before.len() == alike.len() {
                    let factor = format_ident!("factor_{first}");
                    solves.extend(quote! {
                        let #turns = match self.#factor.rotations(&[#(#before),*], work.method) {
                            Ok(solved) => solved,
                            Err(e) => return Err(self.refused(*state, work, e)),
                        };
                    });
                }
                found[i] = quote!(#turns[#place]);
                continue;
            }
            let solve = single_body_solution(d, n, i, &scaled, factor);
            solves.extend(quote! {
                let #omega = match #solve {
                    Ok(solved) => solved,
                    Err(e) => return Err(self.refused(*state, work, e)),
                };
            });
            found[i] = quote!(#omega);
            continue;
        }
        if let Some((i, q)) = quaternionic(d, b) {
            let rest = values.next().filter(|_| !q.edge.rest.is_zero());
            let minus = rest.map(|rest| quote!(- (#rest)));
            let omega = variable(s, d.spec.configurations[i].velocity);
            let at_node = node_momentum(d, i, Side::Body);
            let (factor, refused) = (format_ident!("factor_{n}"), format_ident!("refused_{n}"));
            solves.extend(quote! {
                let #omega = match self.#factor.velocity(&((#at_node #minus) * #step)) {
                    Ok(solved) => solved,
                    Err(e) => return Err(self.#refused(*state, work, e)),
                };
            });
            beside.extend(refusal(
                d,
                names,
                &refused,
                [quote!(QuaternionError), quote!(with_searched_steps)],
            ));
            found[i] = quote!(#omega);
            continue;
        }
        let block = d.of_block(b);
        let together = together(d, names, n, b, &block);
        let field = search(n);
        // The search of every other block is copied from its own field.
        let fields = filled(d, |m| match m == n {
            true => quote!(search),
            false => quote!(search.alike()),
        });
        let tried = quote!(#work { h, #fields });
        let code = together.code(&bindings, &field, &tried);
        let [solution, solved] = ["found", "solved"].map(|base| together.name(base));
        let (elements, known, solve) = (together.elements(), code.known, code.solve);
        solves.extend(quote! {
            let #solution: newton::Solved<#elements> = { #known #solve };
            let #solved = #solution.element;
        });
        solves.extend(together.matrices(&solved, &mut after));
        remembered.extend(quote!(work.#field.remember(state.#node - 1, &#solution);));
        for (k, i) in b.members.iter().enumerate() {
            found[*i] = together.part(quote!(#solved), k);
        }
        beside.extend(code.functions);
    }
    let moving = d.carries.iter().flat_map(|c| c.parts());
    let updates = super::items::advanced(d).map(|a| &a.update);
    let moving: Vec<&Expr> = moving.chain(updates).collect();
    for b in &d.solve.blocks {
        let alone = exact(d, b).map(|(i, _)| i);
        let alone = alone.or(quaternionic(d, b).map(|(i, _)| i));
        let Some(i) = alone.or(linear(d, b).map(|(i, _)| i)) else {
            continue;
        };
        if by_change[i].is_some() {
            continue;
        }
        let velocity = at(d.spec.configurations[i].velocity, Shift::HERE);
        if moving.iter().any(|e| expr::contains(e, velocity)) {
            let omega = &found[i];
            let name = tagged(d, names, velocity.symbol, "matrix");
            let matrix = element::matrix(&d.spec.configurations[i], omega.clone());
            solves.extend(quote!(let #name = #matrix;));
            after.bind(velocity, name);
        }
    }
    let solved = |i: usize| found[i].clone();
    let known = AtTheStart {
        by_change: &by_change,
        forces: &forces,
        computed: &p,
    };
    let rest = finish(d, names, &mut after, &solved, &known, remembered);
    let step_function = step_signature(
        d,
        quote! {
            let #step = work.h;
            #parameters
            #locals
            #seen
            #lets
            #solves
            #rest
        },
    );
    let refused = refuses.then(|| {
        refusal(
            d,
            names,
            &format_ident!("refused"),
            [quote!(Unsolved), quote!(with_searched_step)],
        )
    });
    quote!(#step_function #refused #beside)
}

/// The locals of quantities seen from space at a node; the letters of variations are bound to them.
pub(super) fn from_space(
    d: &Derivation,
    names: &Names,
    by_change: &[Option<SpatialIncrementForm>],
    shift: Shift,
    bindings: &mut Bindings,
) -> TokenStream {
    let s = &d.letters.symbols;
    let mut out = TokenStream::new();
    for (i, form) in by_change.iter().enumerate() {
        let Some(form) = form else { continue };
        let Some(seen) = form.seen.as_ref() else {
            continue;
        };
        let letter = at(d.letters.variation[i], shift);
        if !expr::contains(&form.rest, letter) && !expr::contains(&form.added, letter) {
            continue;
        }
        let tag = match shift == Shift::HERE {
            true => "seen",
            false => "seen_next",
        };
        let name = tagged(d, names, d.spec.configurations[i].element, tag);
        let value = expr::shift_time(s, seen, shift.time);
        let p = schedule::program(s, std::slice::from_ref(&value), "m");
        let (lets, values) = program(&p, bindings);
        out.extend(quote!(#lets let #name = #(#values)*;));
        bindings.bind(letter, name);
    }
    out
}

/// The spatial increment form of a block, if the block is solved in that form.
fn changed<'a>(
    d: &Derivation,
    b: &Block,
    forms: &'a [Option<SpatialIncrementForm>],
) -> Option<&'a SpatialIncrementForm> {
    let (i, _) = linear(d, b)?;
    forms[i].as_ref()
}

/// The function `name`, which reports how far the step exceeds a bound and which step size is possible. `error` is
/// the type of the solver's error, and `search` is its method that adds the possible step size.
fn refusal(
    d: &Derivation,
    names: &Names,
    name: &Ident,
    [error, search]: [TokenStream; 2],
) -> TokenStream {
    let (state, work) = (item(d, "State"), item(d, "Workspace"));
    let used = Generics::of(d).used();
    let node = names.local("node");
    let method = default_solver(d).map(|_| quote!(let method = work.method;));
    let trial = filled(d, |_| quote!(newton::Search::to_try()));
    quote! {
        /// Reports how far the step exceeds the bound, and a step size that succeeds.
        #[cold]
        #[inline(never)]
        fn #name(&self, state: #state #used, work: &#work #used, e: #error) -> StepError {
            #method
            let e = e.#search(work.h.value(), |h| {
                let h = T::from_f64(h);
                let made = self.step(&mut { state }, &mut #work { h, #trial });
                made.ok().map(|()| 0.0)
            });
            StepCause::from(e).at_node(state.#node)
        }
    }
}
