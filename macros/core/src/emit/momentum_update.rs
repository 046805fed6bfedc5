//! The momentum of the next node: the forces on the edge are added to the momentum of this node. Takes the momentum
//! updates and the values of the forces; gives the statements.

use super::element::{self, Family, family};
use super::names::{Names, own, per_configuration, tagged, variable};
use crate::check::spec::Configuration;
use crate::derive::Derivation;
use crate::derive::momentum_update::MomentumUpdate;
use crate::derive::spatial_increment_form::SpatialIncrementForm;
use crate::expr::{self, Expr, Shift};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// The value of the force at one end of an edge.
pub(super) struct EdgeForce {
    pub(super) value: TokenStream,
    /// Whether the value is in the frame of space although the momentum is stated in the body.
    pub(super) in_space: bool,
}

/// The force on a rotation stated in the body, in the frame of space, if that form needs fewer rotations of vectors.
/// `shift` selects the end of the edge.
pub(super) fn seen_from_space(d: &Derivation, i: usize, shift: Shift, e: &Expr) -> Option<Expr> {
    let (s, c) = (&d.letters.symbols, &d.spec.configurations[i]);
    let turns = c.side.is_body() && family(c) == Family::Rotation;
    let attitude = expr::shift_time(s, &expr::here(s, c.element), shift.time);
    turns.then(|| expr::turned(s, &attitude, e)).flatten()
}

/// The statements that compute one momentum, and those that store it.
pub(super) struct MomentumStatements {
    pub(super) found: TokenStream,
    pub(super) stored: TokenStream,
    /// The local with the components of the momentum.
    pub(super) value: Ident,
}

/// The names of one configuration in a step.
struct Body<'a> {
    c: &'a Configuration,
    /// The field of its element in the state, and the element at the end of the edge.
    element: Ident,
    moved: Ident,
    /// For rotations: the matrices of both elements.
    here: Ident,
    next: Ident,
    /// For rigid motions: the velocity that was solved for.
    velocity: Ident,
    /// The field of its momentum.
    field: Ident,
}

/// The momentum of configuration `i`. `values` gives the values of the parts of its momentum update, in order.
pub(super) fn carried(
    d: &Derivation,
    names: &Names,
    i: usize,
    values: &mut impl Iterator<Item = EdgeForce>,
) -> MomentumStatements {
    let c = &d.spec.configurations[i];
    let body = Body {
        c,
        element: own(d, c.element),
        moved: tagged(d, names, c.element, "moved"),
        here: variable(&d.letters.symbols, c.element),
        next: tagged(d, names, c.element, "next"),
        velocity: tagged(d, names, c.element, "velocity"),
        field: per_configuration(d, "momentum", i),
    };
    let value = names.local(&format!("{}_next", body.field));
    let kind = element::kept_name(d, i);
    let (u, field) = (&d.carries[i], &body.field);
    let parts: Vec<Option<EdgeForce>> = u
        .parts()
        .into_iter()
        .map(|e: &Expr| {
            let value = values.next();
            value.filter(|_| !e.is_zero())
        })
        .collect();
    let acts = match element::rests(d, i) {
        Some([_, rest]) => body.added_forces(u, &parts).map(|acts| (rest, acts)),
        None => None,
    };
    match acts {
        Some((rest, acts)) => {
            let left = names.local(&format!("{field}_rest"));
            MomentumStatements {
                found: quote! {
                    let (#value, #left) = added(&state.#field.0, &state.#rest, &(#acts));
                },
                stored: quote!(state.#field = #kind(#value); state.#rest = #left;),
                value,
            }
        }
        None => {
            let whole = body.whole(u, &parts);
            MomentumStatements {
                found: quote!(let #value = #whole;),
                stored: quote!(state.#field = #kind(#value);),
                value,
            }
        }
    }
}

/// The momentum of configuration `i` if it was solved in the spatial increment form: the force of the edge is added
/// to the momentum that leaves the node.
pub(super) fn gained(
    d: &Derivation,
    names: &Names,
    i: usize,
    form: &SpatialIncrementForm,
    values: &mut impl Iterator<Item = EdgeForce>,
) -> MomentumStatements {
    let field = per_configuration(d, "momentum", i);
    let [value, leaving] = ["next", "leaving"].map(|tag| names.local(&format!("{field}_{tag}")));
    let added = values.next().filter(|_| !form.added.is_zero());
    let added = added.map(|EdgeForce { value, .. }| quote!(+ #value));
    let kind = element::kept_name(d, i);
    MomentumStatements {
        found: quote!(let #value = #leaving #added;),
        stored: quote!(state.#field = #kind(#value);),
        value,
    }
}

impl Body<'_> {
    /// The increment of a momentum stored in two numbers. None if the update is not a sum.
    fn added_forces(&self, u: &MomentumUpdate, parts: &[Option<EdgeForce>]) -> Option<TokenStream> {
        let values = parts.iter().map(|a| a.as_ref().map(|a| a.value.clone()));
        let values: Vec<Option<TokenStream>> = values.collect();
        let Body {
            element,
            moved,
            field,
            velocity,
            ..
        } = self;
        let present: Vec<&TokenStream> = values.iter().flatten().collect();
        if self.c.group.is_additive() {
            let acts = quote!(#(#present)+*);
            return (!present.is_empty()).then(|| element::array(self.c, acts));
        }
        let (MomentumUpdate::Through { straight, .. }, [leave, arrive]) = (u, values.as_slice())
        else {
            return None;
        };
        let left = leave.is_some().then(|| quote!(leaving));
        let gained = (!straight).then(|| {
            let left = left.clone().map(|left| quote!(+ #left));
            quote!(state.#element.gained_along(&#velocity, &(state.#field.0 #left)))
        });
        let arrived = arrive
            .as_ref()
            .map(|e| quote!(#moved.covector_turned(&(#e))));
        let all: Vec<TokenStream> = [left, gained, arrived].into_iter().flatten().collect();
        let leaving = leave
            .as_ref()
            .map(|e| quote!(let leaving = state.#element.covector_turned(&(#e));));
        let acts = quote!(#(#all)+*);
        let acts = match leaving {
            Some(leaving) => quote!({ #leaving #acts }),
            None => acts,
        };
        (!all.is_empty()).then_some(acts)
    }

    /// The momentum of the next node.
    fn whole(&self, u: &MomentumUpdate, parts: &[Option<EdgeForce>]) -> TokenStream {
        let Body {
            element,
            moved,
            field,
            c,
            ..
        } = self;
        let part = |k: usize| parts.get(k).and_then(Option::as_ref);
        let plus = |e: Option<&EdgeForce>| e.map(|EdgeForce { value, .. }| quote!(+ #value));
        let old = element::value(c, quote!(state.#field.0));
        let value = match (c.side.is_body(), u) {
            _ if c.group.is_additive() => {
                let (a, b) = (plus(part(0)), plus(part(1)));
                quote!(#old #a #b)
            }
            (true, MomentumUpdate::Through { .. }) => {
                let left = part(0).map(|e| self.turned(&quote!(state.#element), &self.here, e));
                let arrived = part(1).map(|e| self.turned(&quote!(#moved), &self.next, e));
                quote!(state.#field.0 #left #arrived)
            }
            (true, MomentumUpdate::Kept(_)) => {
                let added = plus(part(0));
                let (there, back) = match element::about_body(c) {
                    true => (quote!(covector_turned), quote!(covector_turned_back)),
                    false => (quote!(covector_to_space), quote!(covector_to_body)),
                };
                quote!(#moved.#there(&(state.#element.#back(&state.#field.0) #added)))
            }
            (false, MomentumUpdate::Kept(_)) => {
                let added = plus(part(0));
                quote!(#old #added)
            }
            (false, MomentumUpdate::Through { .. }) => {
                let (left, arrived) = (plus(part(0)), plus(part(1)));
                quote! {
                    #moved.covector_to_space(
                        &state.#element.covector_to_body(&(state.#field.0 #left))
                    ) #arrived
                }
            }
        };
        element::array(c, value)
    }

    /// The force on the body, added in the frame of space.
    fn turned(&self, element: &TokenStream, matrix: &Ident, acting: &EdgeForce) -> TokenStream {
        let EdgeForce { value, in_space } = acting;
        match family(self.c) {
            _ if *in_space => quote!(+ #value),
            Family::Rotation => quote!(+ #matrix * (#value)),
            Family::Field(_) => quote!(+ #value),
            Family::Orthogonal(_)
            | Family::Linear(_)
            | Family::Quaternion
            | Family::Coordinates(_) => {
                quote!(+ #element.covector_to_space(&(#value)))
            }
        }
    }
}
