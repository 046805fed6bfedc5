//! Initial data, the state at a node and the workspace of a step. Takes the derivation; gives the structs and their
//! accessors.

use super::element;
use super::expression::ty;
use super::items::{factor_references, kept};
use super::names::{Names, item, own, per_configuration};
use super::sizes::Generics;
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::select_solver::Method;
use proc_macro2::{Ident, Spacing, TokenStream, TokenTree};
use quote::{format_ident, quote};

/// Initial data, state and workspace.
pub fn state(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let (initial, state, work) = (item(d, "Initial"), item(d, "State"), item(d, "Workspace"));
    let node = names.local("node");
    let (mut given, mut kept_fields, mut access) = (Vec::new(), Vec::new(), Vec::new());
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let element = own(d, c.element);
        let momentum = per_configuration(d, "momentum", i);
        let [body, spatial] = Side::BOTH.map(|side| element::momentum_field(d, i, side));
        let name = &s.get(c.element).name;
        let doc = format!(" `{name}` at node 0: body -> space.");
        let kind = element::ty(d, i);
        let [of_body, of_space] = Side::BOTH.map(|side| element::momentum(d, i, side));
        let rests = element::rests(d, i).map(|[place, of_momentum]| {
            let (t, covector) = (element::rest_ty(d, i), element::kept_array(d, i));
            quote!(, #place: #t, #of_momentum: #covector)
        });
        let kept = element::kept(d, i);
        if c.group.is_additive() {
            let [start, here] = ["at node 0", "at this node"].map(|at| format!(" `{name}` {at}."));
            given.push(quote! {
                #[doc = #start] pub #element: #kind,
                #[doc = " Its momentum at node 0."] pub #spatial: #of_space
            });
            kept_fields.push(quote!(#element: #kind, #momentum: #kept #rests));
            access.push(quote! {
                #[doc = #here]
                pub fn #element(&self) -> #kind { self.#element }
                /// Its momentum at this node.
                pub fn #spatial(&self) -> #of_space { self.#momentum }
            });
            continue;
        }
        given.push(if c.side.is_body() {
            quote! {
                #[doc = #doc] pub #element: #kind,
                #[doc = " Momentum at node 0, in the body frame."] pub #body: #of_body
            }
        } else {
            quote! {
                #[doc = #doc] pub #element: #kind,
                #[doc = " Momentum at node 0, in the space frame."] pub #spatial: #of_space
            }
        });
        kept_fields.push(quote!(#element: #kind, #momentum: #kept #rests));
        let seen = match element::about_body(c) {
            true => quote!(self.#momentum.to_space(&self.#element)),
            false => quote!(self.#momentum),
        };
        let doc = format!(" `{name}` at this node: body -> space.");
        access.push(quote! {
            #[doc = #doc]
            pub fn #element(&self) -> #kind { self.#element }
            /// The momentum at this node, in the space frame.
            pub fn #spatial(&self) -> #of_space { #seen }
            /// The momentum at this node, in the body frame.
            pub fn #body(&self) -> #of_body { self.#momentum.to_body(&self.#element) }
        });
    }
    for id in kept(d) {
        let (field, t) = (own(d, id), ty(s, s.get(id).shape));
        let doc = format!(" `{}` at node 0.", s.get(id).name);
        given.push(quote!(#[doc = #doc] pub #field: #t));
        kept_fields.push(quote!(#field: #t));
    }
    let ticks = super::items::ticks(d, names).into_iter();
    kept_fields.extend(ticks.map(|(_, amount, rest)| {
        let t = ty(s, amount.shape());
        quote!(#rest: #t)
    }));
    let (held, shown) = super::holds::fields(d);
    kept_fields.extend(held);
    access.extend(shown);
    let g = Generics::of(d);
    let (declared, bound, used) = (g.declared(), g.bound(), g.used());
    let (work_field, work_doc) = workspace(d, names);
    let list = &d.spec.configurations;
    let place = match list.iter().any(element::is_placed) {
        true => {
            " Positions and their momenta are stored as two numbers, the second below the rounding of the first."
        }
        false => "",
    };
    let about = match list.iter().any(element::about_body) {
        true => " (of a rigid motion about the body's own origin)",
        false => "",
    };
    let state_doc = format!(
        " The state at one node, which can be compared and saved. The momentum is stored in the space frame{about}, advected quantities as their values at the identity, so that rounding errors do not accumulate.{place}"
    );
    let summary = matches!(d.solve.method, Method::Newton).then(|| {
        quote! {
            impl #bound #work #used {
                /// The tangents and corrections of the last step, and the residual before its last correction.
                pub fn solved(&self) -> newton::Summary {
                    self.search.last()
                }
            }
        }
    });
    quote! {
        /// Initial data.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #initial #declared { #(#given,)* }

        #[doc = #state_doc]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #state #declared { #(#kept_fields,)* #node: u64 }

        impl #bound #state #used {
            #(#access)*
        }

        #[doc = #work_doc]
        #[derive(Clone, Copy, Debug)]
        pub struct #work #declared { h: T, #work_field }

        #summary
    }
}

/// The fields of the workspace after the step size, and their documentation.
fn workspace(d: &Derivation, names: &Names) -> (TokenStream, &'static str) {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    match d.solve.method {
        Method::FreeMoserVeselov if !factor_references(d).is_empty() => {
            let kept = factor_references(d).into_iter().map(|id| {
                let (field, t) = (own(d, id), ty(s, s.get(id).shape));
                quote!(#field: #t)
            });
            (
                quote!(solver: Free<T>, #(#kept,)*),
                " The step size and the constants of the trajectory. A step from any other state computes the constants again.",
            )
        }
        Method::FreeMoserVeselov => (
            quote!(solver: Free<T>,),
            " The step size and the constants of the trajectory. A step from any other state computes the constants again.",
        ),
        Method::ForcedMoserVeselov if !factor_references(d).is_empty() => (
            quote!(method: Method, factor: Poinsot<T>, edge: Edge<T>, here: #state #used,),
            " The step size, the solver, the left factor, and the momentum of the edge that begins at the state `here`. A step from any other state computes them again.",
        ),
        Method::ForcedMoserVeselov => (
            quote!(method: Method, edge: Edge<T>, here: #state #used,),
            " The step size, the solver, and the momentum of the edge that begins at the state `here`. A step from any other state computes the momentum again.",
        ),
        Method::UnitQuaternions => {
            let kind = super::items::factor_type(d);
            let factor = (!factor_references(d).is_empty()).then(|| quote!(factor: #kind,));
            (
                quote!(#factor edge: Edge<T>, here: #state #used,),
                " The step size, and the momentum of the edge that begins at the state `here`. A step from any other state computes the momentum again.",
            )
        }
        Method::LeftFactor | Method::Davenport => super::left_factor::work(d),
        Method::Newton => {
            let search = super::newton::search_of_all(d, names);
            (
                quote!(search: #search,),
                " The step size, and the last velocities as initial guesses for the next step.",
            )
        }
        Method::Linear | Method::Blocks => super::blocks::work(d, names),
    }
}

/// The names of the fields of the workspace; snapshots contain all of them.
pub(super) fn remembered(d: &Derivation, names: &Names) -> Vec<Ident> {
    let (fields, _) = workspace(d, names);
    [format_ident!("h")]
        .into_iter()
        .chain(fields_of(&fields))
        .collect()
}

/// The names of the fields in `a: A, b: B<C>,`: the identifiers before a single colon.
fn fields_of(fields: &TokenStream) -> Vec<Ident> {
    let trees: Vec<TokenTree> = fields.clone().into_iter().collect();
    let names = trees.windows(3).filter_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(colon), _]
            if colon.as_char() == ':' && colon.spacing() == Spacing::Alone =>
        {
            Some(name.clone())
        }
        _ => None,
    });
    names.collect()
}
