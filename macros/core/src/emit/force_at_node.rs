//! What acts on a field at a node, where the momentum of the next node is that of this one less what acts at both: it
//! is computed once for each node where it is much work, and the workspace keeps it for the step that starts there.
//! Takes the derivation; gives the fields of the workspace and the statements.

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

/// Operations from which on a force is kept: to compare the placement and to load it takes about as long as this many.
const WORTH: u64 = 150;

/// The force of a configuration at a node.
pub(super) struct AtNode {
    /// The configuration.
    pub configuration: usize,
    /// The momentum of a node at rest.
    pub force: Expr,
    /// What it is made of at the node.
    made_of: Vec<Letter>,
}

/// Those that are much work.
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
        // Others are computed together with what acts elsewhere, of which they may have parts in common.
        let is_kept = work >= WORTH && arrays && !moving.is_empty() && !force.shape().is_scalar();
        is_kept.then_some(AtNode {
            configuration: i,
            force,
            made_of: moving,
        })
    }

    /// What it needs of the node.
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

    /// The fields for what it was computed from.
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

    /// The local of its value at the start of the edge, or at its end.
    pub fn local(&self, d: &Derivation, names: &Names, time: i8) -> Ident {
        let end = if time == 0 { "" } else { "_next" };
        names.local(&format!("force_on_{}{end}", self.element(d)))
    }

    /// Its value at an end of the edge: statements, and an expression behind them.
    fn computed(&self, d: &Derivation, time: i8, bindings: &Bindings) -> TokenStream {
        let s = &d.letters.symbols;
        let force = expr::shift_time(s, &self.force, time);
        let p = schedule::program(s, std::slice::from_ref(&force), "f");
        let (lets, values) = program(&p, bindings);
        quote!(#lets #(#values)*)
    }

    /// The statement that finds it where the step starts.
    pub fn here(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (local, value) = (self.local(d, names, 0), self.computed(d, 0, bindings));
        let field = self.field(d);
        let known = self.sources(d).into_iter().map(|(l, source)| {
            let here = bindings.local(&d.letters.symbols, l);
            quote!(same(&work.#source, &#here))
        });
        quote!(let #local = if #(#known)&&* { work.#field } else { #value };)
    }

    /// The statement that finds it where the step ends.
    pub fn next(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (local, value) = (self.local(d, names, 1), self.computed(d, 1, bindings));
        quote!(let #local = { #value };)
    }

    /// The statements that keep it for the next step.
    pub fn remembered(&self, d: &Derivation, names: &Names, bindings: &Bindings) -> TokenStream {
        let (field, local) = (self.field(d), self.local(d, names, 1));
        let sources = self.sources(d).into_iter().map(|(l, source)| {
            let there = bindings.local(&d.letters.symbols, at(l.symbol, Shift::NEXT));
            quote!(work.#source = #there;)
        });
        quote!(work.#field = #local; #(#sources)*)
    }
}

/// The fields of the workspace, and their values before anything is known: no placement is equal to one that is no
/// number.
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
