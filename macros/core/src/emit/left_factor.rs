//! The step of a Moser-Veselov equation whose left factor is constant in either frame, or known at the node: the edge
//! momentum, the selected solver, the torques at the node. Takes the derivation; gives the fields of the workspace,
//! `step` and the error messages.

use super::element::{self, Family, family};
use super::expression::{Bindings, Writer, program, ty as quantity};
use super::items::{advanced, letters_of, parameter_locals, text, with_transports};
use super::names::{Names, item, own, tagged, variable};
use super::sizes::{Generics, size};
use super::step::{AtTheStart, at, finish, here, node_momentum, step_signature};
use crate::derive::Derivation;
use crate::derive::blocks::Block;
use crate::derive::momentum_update::MomentumUpdate;
use crate::derive::select_solver::{Method, MoserVeselov};
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// The type of the prepared factor.
fn ty(d: &Derivation, i: usize) -> TokenStream {
    let n = size(&d.letters.symbols, d.spec.configurations[i].group.size());
    quote!(LeftFactor<#n, T>)
}

/// The type of the prepared factor of a configuration, and the constructor of the factor.
pub(super) fn prepared(d: &Derivation, i: usize, e: &Expr) -> (TokenStream, TokenStream) {
    let none = Bindings::new();
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings: &none,
    };
    let (value, label) = (writer.write(e), text(d, e));
    (
        ty(d, i),
        quote!(LeftFactor::new(#value).map_err(|e| e.in_field(#label))),
    )
}

/// Whether the user can choose the solver.
fn chooses(d: &Derivation) -> bool {
    match d.solve.method {
        Method::FreeMoserVeselov
        | Method::ForcedMoserVeselov
        | Method::LeftFactor
        | Method::Davenport => true,
        Method::Blocks => d.solve.blocks.iter().any(Block::has_factor),
        Method::UnitQuaternions | Method::Linear | Method::Newton => false,
    }
}

/// The default solver.
fn default(d: &Derivation) -> TokenStream {
    let n = size(&d.letters.symbols, d.spec.configurations[0].group.size());
    match d.solve.method {
        Method::Davenport => quote!(Method::Davenport),
        Method::Blocks if known_at_nodes(d) => quote!(Method::Davenport),
        Method::Blocks => {
            let exact = d.solve.blocks.iter().filter(|b| b.has_factor());
            let sizes = exact.flat_map(|b| &b.members).map(|i| {
                let n = size(&d.letters.symbols, d.spec.configurations[*i].group.size());
                quote!(#n == 3)
            });
            quote!(Method::of_size(if #(#sizes)&&* { 3 } else { 4 }))
        }
        _ => quote!(Method::of_size(#n)),
    }
}

/// Whether a block has a factor that varies from node to node.
pub(super) fn known_at_nodes(d: &Derivation) -> bool {
    let mut blocks = d.solve.blocks.iter();
    blocks.any(|b| matches!(b.method, Method::Davenport))
}

/// The default solver, if the user can choose one.
pub(super) fn default_solver(d: &Derivation) -> Option<TokenStream> {
    chooses(d).then(|| default(d))
}

/// The model's field for the solver, and its initial value.
pub(super) fn of_model(d: &Derivation) -> (TokenStream, TokenStream) {
    let Some(default) = default_solver(d) else {
        return Default::default();
    };
    (quote!(method: Method,), quote!(method: #default,))
}

/// The names of the available solvers, the default one first.
pub(super) fn offered(d: &Derivation) -> Option<TokenStream> {
    let mut exact = d.solve.blocks.iter().filter(|b| b.has_factor());
    let of_space = |i: &usize| family(&d.spec.configurations[*i]) == Family::Rotation;
    Some(match (chooses(d), family(&d.spec.configurations[0])) {
        (false, _) => return None,
        (true, _) if known_at_nodes(d) => quote!(&Method::DAVENPORT_FIRST),
        (true, _) if matches!(d.solve.method, Method::Blocks) => {
            match exact.all(|b| b.members.iter().all(of_space)) {
                true => quote!(&Method::NAMES),
                false => quote!(&Method::ANY_SIZE),
            }
        }
        (true, Family::Rotation) if matches!(d.solve.method, Method::Davenport) => {
            quote!(&Method::DAVENPORT_FIRST)
        }
        (true, Family::Rotation) => quote!(&Method::NAMES),
        (true, Family::Orthogonal(n)) => {
            let n = size(&d.letters.symbols, n);
            quote!(if #n == 3 { &Method::NAMES } else { &Method::ANY_SIZE })
        }
        (
            true,
            Family::Linear(_) | Family::Quaternion | Family::Coordinates(_) | Family::Field(_),
        ) => return None,
    })
}

/// The advected quantities in the factor.
fn references(e: &Expr, d: &Derivation) -> Vec<SymbolId> {
    let mut list: Vec<SymbolId> = expr::letters(e).iter().map(|l| l.symbol).collect();
    list.retain(|id| d.letters.symbols.get(*id).role == Role::Advected);
    list.sort();
    list.dedup();
    list
}

/// The reference values of those quantities in a state.
fn made_of(d: &Derivation, turned: &Expr) -> TokenStream {
    let list = references(turned, d).into_iter().map(|id| {
        let field = own(d, id);
        quote!(state.#field)
    });
    quote!((#(#list,)*))
}

/// The fields of the workspace, and its documentation.
pub(super) fn work(d: &Derivation) -> (TokenStream, &'static str) {
    let Some(turned) = &d.solve.turned else {
        return (quote!(method: Method,), " The step size and the solver.");
    };
    let s = &d.letters.symbols;
    let kind = ty(d, 0);
    let types = references(turned, d)
        .into_iter()
        .map(|id| quantity(s, s.get(id).shape));
    (
        quote!(method: Method, factor: #kind, made_of: (#(#types,)*),),
        " The step size, the solver, and the left factor in the body frame. If the state has another left factor, a step computes it again.",
    )
}

/// The initial values of those fields.
pub(super) fn work_init(d: &Derivation) -> TokenStream {
    let Some(turned) = &d.solve.turned else {
        return quote!(method,);
    };
    let (made_of, label) = (made_of(d, turned), text(d, turned));
    quote! {
        method,
        factor: self.factor_at(state).map_err(|e| e.in_field(#label))?,
        made_of: #made_of,
    }
}

/// The function that gives the factor at a node, or in the body frame.
fn factor_at(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    if let Some(turned) = &d.solve.turned {
        let mut bindings = Bindings::new();
        let locals: TokenStream = references(turned, d)
            .into_iter()
            .map(|id| {
                let (name, field) = (variable(s, id), own(d, id));
                bindings.bind(at(id, Shift::HERE), name.clone());
                quote!(let #name = state.#field;)
            })
            .collect();
        let needed = expr::letters(turned);
        let parameters = parameter_locals(d, quote!(self.parameters), &needed);
        let value = Writer {
            symbols: s,
            bindings: &bindings,
        }
        .write(turned);
        let kind = ty(d, 0);
        return quote! {
            /// The left factor in the body frame, where it is constant along the motion.
            #[cold]
            fn factor_at(&self, state: &#state #used) -> Result<#kind, LeftFactorError> {
                #parameters
                #locals
                LeftFactor::new(#value)
            }
        };
    }
    if !matches!(d.solve.method, Method::Davenport) {
        return TokenStream::new();
    }
    let mut bindings = Bindings::new();
    let needed = letters_of([&mv.factor]);
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = here(d, names, &needed, &mut bindings);
    let p = schedule::program(s, std::slice::from_ref(&mv.factor), "t");
    let (lets, values) = program(&p, &bindings);
    let step = variable(s, d.spec.step);
    quote! {
        /// The left factor at this node, for a step `h`.
        #[inline]
        fn factor_at(&self, state: &#state #used, #step: T) -> SMatrix<T, 3, 3> {
            #parameters
            #locals
            #lets
            #(#values)*
        }
    }
}

/// The edge momentum, in the frame in which the equation is solved.
fn edge_momentum(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let s = &d.letters.symbols;
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let c = &d.spec.configurations[0];
    let own = own(d, c.element);
    let mut bindings = Bindings::new();
    let mut needed = letters_of([&mv.rest]);
    let matrix = c.side.is_body() && family(c) == Family::Rotation;
    if matrix {
        needed.push(at(c.element, Shift::HERE));
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = here(d, names, &needed, &mut bindings);
    let step = variable(s, d.spec.step);
    let p = schedule::program(s, std::slice::from_ref(&mv.rest), "t");
    let (lets, values) = program(&p, &bindings);
    let node_momentum = node_momentum(d, 0, c.side);
    let rest = (!mv.rest.is_zero()).then(|| quote!(- (#(#values)*)));
    let value = match (d.solve.turned.is_some(), family(c)) {
        (false, _) => quote!(#node_momentum #rest),
        (true, Family::Rotation) => quote!(state.#own.inverse_rotate(&(#node_momentum #rest))),
        (true, _) => quote!(state.#own.covector_to_body(&(#node_momentum #rest))),
    };
    let covector = element::covector(d, 0);
    let frame = match d.solve.turned.is_some() {
        true => {
            " The momentum, in the body frame, of the edge that starts at this node, for the step size `h`."
        }
        false => " The momentum of the edge that starts at this node, for a step `h`.",
    };
    quote! {
        #[doc = #frame]
        #[inline]
        fn edge_momentum(&self, state: &#state #used, #step: T) -> #covector {
            #parameters
            #locals
            #lets
            #value
        }
    }
}

/// The functions of the stepper that make a step.
pub(super) fn step(d: &Derivation, names: &Names, mv: &MoserVeselov) -> TokenStream {
    let s = &d.letters.symbols;
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let c = &d.spec.configurations[0];
    let node = names.local("node");
    let rotations = family(c) == Family::Rotation;
    let (factor, momentum) = (factor_at(d, names, mv), edge_momentum(d, names, mv));
    let step = variable(s, d.spec.step);
    let edge = names.local("edge");
    let omega = variable(s, c.velocity);
    let prepared = match d.solve.turned.is_some() {
        true => quote!(work.factor),
        false => quote!(self.factor),
    };
    let scaled = match rotations {
        true => quote!((#edge * #step)),
        false => quote!(skew_part(&(#edge * #step))),
    };
    let solve = match (d.solve.method.clone(), rotations) {
        (Method::Davenport, _) => {
            quote!(rotation_at(&self.factor_at(state, #step), &#scaled, work.method))
        }
        (_, true) => quote!(#prepared.rotation(&#scaled, work.method)),
        (_, false) => quote!(#prepared.solve(&#scaled, work.method)),
    };
    let ratio = match (d.solve.method.clone(), rotations) {
        (Method::Davenport, _) => quote!(reach_of(&self.factor_at(state, trial), &hat(&momentum))),
        (_, true) => quote!(#prepared.reach(&hat(&momentum))),
        (_, false) => quote!(#prepared.reach(&momentum)),
    };
    let remake = d.solve.turned.as_ref().map(|turned| {
        let made_of = made_of(d, turned);
        quote! {
            if work.made_of != #made_of {
                match self.factor_at(state) {
                    Ok(made) => work.factor = made,
                    Err(e) => return Err(StepCause::Factor(e).at_node(state.#node)),
                }
                work.made_of = #made_of;
            }
        }
    });
    let mut bindings = Bindings::new();
    let list: Vec<&Expr> = d.carries.iter().flat_map(MomentumUpdate::parts).collect();
    let velocity = at(c.velocity, Shift::HERE);
    let onwards = || list.iter().copied().chain(advanced(d).map(|a| &a.update));
    let uses_velocity = onwards().any(|e| expr::contains(e, velocity));
    let mut needed: Vec<Letter> = letters_of(onwards());
    if let [MomentumUpdate::Through { leave, .. }] = d.carries.as_slice()
        && c.side.is_body()
        && rotations
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
        bindings.bind(velocity, name.clone());
        // The solver may have found the velocity in the body frame.
        match d.solve.turned {
            Some(_) => {
                let own = own(d, c.element);
                quote!(let #name = (state.#own * #omega * state.#own.inverse()).matrix();)
            }
            None => quote!(let #name = #omega.matrix();),
        }
    });
    let rest = finish(
        d,
        names,
        &mut bindings,
        &|_| quote!(#omega),
        &AtTheStart {
            by_change: &[],
            forces: &[],
            computed: &schedule::Program::none(&d.letters.symbols),
        },
        TokenStream::new(),
    );
    let work = item(d, "Workspace");
    let step_function = step_signature(
        d,
        quote! {
            let #step = work.h;
            #remake
            let #edge = self.edge_momentum(state, #step);
            let #omega = match #solve {
                Ok(solved) => solved,
                Err(e) => return Err(self.refused(state, work, e)),
            };
            #matrix
            #parameters
            #locals
            #rest
        },
    );
    quote! {
        #step_function
        #momentum
        #factor

        /// Reports how far the step exceeds the bound, and a step size that succeeds.
        #[cold]
        fn refused(&self, state: &#state #used, work: &#work #used, e: Unsolved) -> StepError {
            let ratio = |trial: f64| {
                let trial = T::from_f64(trial);
                let momentum = self.edge_momentum(state, trial) * trial;
                Some(#ratio)
            };
            StepCause::from(e.with_searched_step(work.h.value(), ratio)).at_node(state.#node)
        }
    }
}
