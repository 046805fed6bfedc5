//! The force on a field at a node, if the momentum update subtracts the forces at both nodes of the edge. An
//! expensive force is computed once per node: the workspace stores it for the step that starts there. Takes the
//! derivation; gives the fields of the workspace and the statements.

use super::blocks::linear_field;
use super::element;
use super::expression::{Bindings, program, ty};
use super::items::letters_of;
use super::names::{Names, own};
use super::step::at;
use crate::algebra::Algebra;
use crate::derive::Derivation;
use crate::derive::momentum_update::MomentumUpdate;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The number of operations from which on the workspace stores a force. Comparing the field and loading the force
/// takes about as long.
const WORTH: u64 = 150;

/// The force of a configuration at a node.
pub(super) struct AtNode {
    /// The configuration.
    pub configuration: usize,
    /// The force that the balance subtracts at the node.
    pub force: Expr,
    /// The letters at the node on which it depends.
    made_of: Vec<Letter>,
}

/// The forces that are worth storing.
pub(super) fn at_nodes(d: &Derivation) -> Vec<AtNode> {
    (0..d.spec.configurations.len())
        .filter_map(|i| AtNode::of(d, i))
        .collect()
}

impl AtNode {
    fn of(d: &Derivation, i: usize) -> Option<AtNode> {
        let form = linear_field(d, i)?;
        let MomentumUpdate::Kept(added) = &d.carries[i] else {
            return None;
        };
        let s = &d.letters.symbols;
        let at_both = expr::add(form.rest.clone(), expr::shift_time(s, &form.rest, 1));
        let here = |l: &Letter| l.shift == Shift::HERE;
        let letters = expr::letters(&form.rest);
        let algebra = Algebra::new(s);
        let same = !form.rest.is_zero()
            && letters.iter().all(here)
            && algebra.is_zero(&expr::add(added.clone(), at_both))
            && !algebra.exhausted();
        if !same {
            return None;
        }
        let moving = |l: &&Letter| matches!(s.get(l.symbol).role, Role::Element | Role::Advected);
        let moving: Vec<Letter> = letters.iter().filter(moving).copied().collect();
        let force = expr::factored(s, &schedule::displaced(s, &form.rest));
        let work = schedule::work(&schedule::program(s, std::slice::from_ref(&force), "f"));
        let arrays = moving.iter().all(|l| {
            let mut all = d.spec.configurations.iter();
            let group = all
                .find(|c| c.element == l.symbol)
                .map(|c| c.group.is_additive());
            group.unwrap_or(true) && !s.get(l.symbol).shape.is_scalar()
        });
        // Scalar and cheap forces are computed with the other forces, with which they may share subexpressions.
        let is_kept = work >= WORTH && arrays && !moving.is_empty() && !force.shape().is_scalar();
        is_kept.then_some(AtNode {
            configuration: i,
            force,
            made_of: moving,
        })
    }

    /// The letters at the node that the force needs.
    pub fn needed(&self) -> Vec<Letter> {
        letters_of(std::slice::from_ref(&self.force))
    }

    fn element(&self, d: &Derivation) -> Ident {
        own(d, d.spec.configurations[self.configuration].element)
    }

    /// The field of the workspace.
    fn field(&self, d: &Derivation) -> Ident {
        format_ident!("force_on_{}", self.element(d))
    }

    /// The fields of the workspace with the values from which the force was computed.
    fn sources(&self, d: &Derivation) -> Vec<(Letter, Ident)> {
        let element = self.element(d);
        let all = self.made_of.iter();
        all.map(|l| {
            (
                *l,
                format_ident!("force_on_{}_at_{}", element, own(d, l.symbol)),
            )
        })
        .collect()
    }

    /// The local of its value at the start (`time` 0) or at the end of the edge.
    pub fn local(&self, d: &Derivation, names: &Names, time: i8) -> Ident {
        let end = if time == 0 { "" } else { "_next" };
        names.local(&format!("force_on_{}{end}", self.element(d)))
    }

    /// The force at an end of the edge: statements followed by an expression.
    fn computed(&self, d: &Derivation, time: i8, bindings: &Bindings) -> TokenStream {
        let s = &d.letters.symbols;
        let force = expr::shift_time(s, &self.force, time);
        let p = schedule::program(s, std::slice::from_ref(&force), "f");
        let (lets, values) = program(&p, bindings);
        quote!(#lets #(#values)*)
    }

    /// The statement that gives it at the start of the step.
    pub fn here(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (local, value) = (self.local(d, names, 0), self.computed(d, 0, bindings));
        let field = self.field(d);
        let known = self.sources(d).into_iter().map(|(l, source)| {
            let here = bindings.local(&d.letters.symbols, l);
            quote!(same(&work.#source, &#here))
        });
        quote!(let #local = if #(#known)&&* { work.#field } else { #value };)
    }

    /// The statement that computes it at the end of the step.
    pub fn next(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (local, value) = (self.local(d, names, 1), self.computed(d, 1, bindings));
        quote!(let #local = { #value };)
    }

    /// The statements that store it for the next step.
    pub fn remembered(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (field, local) = (self.field(d), self.local(d, names, 1));
        let sources = self.sources(d).into_iter().map(|(l, source)| {
            let there = bindings.local(&d.letters.symbols, at(l.symbol, Shift::NEXT));
            quote!(work.#source = #there;)
        });
        quote!(work.#field = #local; #(#sources)*)
    }
}

/// The fields of the workspace with their types and initial values. The initial values are NaN, which differs from
/// every field value.
pub(super) fn fields(d: &Derivation) -> Vec<(Ident, TokenStream, TokenStream)> {
    let s = &d.letters.symbols;
    let mut out = Vec::new();
    for f in at_nodes(d) {
        let sources = f.sources(d).into_iter();
        let sources = sources.map(|(l, source)| (source, s.get(l.symbol).shape));
        let all = [(f.field(d), f.force.shape())].into_iter().chain(sources);
        out.extend(all.map(|(name, shape)| {
            let none = element::zero(d, shape);
            (name, ty(s, shape), quote!(#none * (T::one() / T::zero())))
        }));
    }
    out
}
