//! Kernels of what acts on a site at a node: its own potential and what neighbours add, before the node
//! and after it; of blocks of fields, what the edge adds.

use super::locals::{Places, step};
use super::pulls::{field, front};
use super::velocities::taken_apart;
use super::{Lines, Moving, number};
use crate::algebra::Rational;
use crate::expr::{self, Expr};
use crate::line::How;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// What acts at a node.
pub(super) enum Acting {
    /// One covector: half of it before the node, half of it after.
    Halves,
    /// Two covectors.
    Both,
}

/// What acts of the site itself at a node: at the end of the edge that comes, at the start of the one
/// that leaves.
fn own(m: &Moving) -> [Expr; 2] {
    let d = m.outline();
    let s = &d.letters.symbols;
    let at_node = |e: &Expr| d.defined(&expr::shift_time(s, e, -1));
    match &m.mover.how {
        How::Rotation { leave, arrive, .. } => [at_node(arrive), d.defined(leave)],
        How::Field { form, arrive } => [at_node(arrive), d.defined(&expr::neg(form.rest.clone()))],
        How::System { .. } | How::Newton { .. } => {
            let shape = d.balances[m.mover.index].outgoing.shape();
            [expr::zero(shape), expr::zero(shape)]
        }
    }
}

impl Lines<'_> {
    /// Whether halves act: the shares are equal, of the site itself and of its neighbours.
    pub(super) fn acting(&self, m: &Moving) -> Acting {
        let [arrive, leave] = own(m);
        let [before, after] = self.line.shares;
        match arrive == leave && before == after {
            true => Acting::Halves,
            false => Acting::Both,
        }
    }

    /// What neighbours add to a configuration at a site, term by term.
    pub(super) fn collected(&self, name: &str) -> Vec<TokenStream> {
        let mut terms: Vec<TokenStream> = Vec::new();
        for (n, pull) in self.line.pulls.iter().enumerate() {
            let array = format_ident!("pull_{}", n + 1);
            for f in pull.forces.iter().filter(|f| f.on == name) {
                let by = number(front(pull) - f.site);
                let field = field(name, f.site);
                terms.push(quote!(pulls.#array[site + #by].#field));
            }
        }
        let of_functionals = self.line.meshed.iter().flat_map(|m| &m.forces);
        if of_functionals.into_iter().any(|f| f.on == name) {
            let array = super::meshes::collected(name);
            terms.push(quote!(pulls.#array[site]));
        }
        terms
    }
}

/// The name of the kernel.
pub(super) fn kernel(m: &Moving) -> Ident {
    format_ident!("acted_{}", m.mover.name)
}

/// The name of the kernel of what the edge adds.
pub(super) fn edge_kernel(m: &Moving) -> Ident {
    format_ident!("added_{}", m.mover.name)
}

/// The kernels.
pub(super) fn acting(l: &Lines) -> TokenStream {
    let name = l.item("");
    let each = l.moving().map(|m| one(l, m));
    let each: Vec<TokenStream> = each.collect();
    let added = l.moving().map(|m| added(l, m));
    let added: Vec<TokenStream> = added.collect();
    quote!(impl<T: Real> #name<T> { #(#each)* #(#added)* })
}

fn one(l: &Lines, m: Moving) -> TokenStream {
    let d = m.outline();
    let s = &d.letters.symbols;
    let (kernel, places, pulls, t) = (kernel(&m), l.item("Places"), l.item("Pulls"), m.covector());
    let h = step(d);
    let [arrive, leave] = own(&m);
    let halves = matches!(l.acting(&m), Acting::Halves);
    let wanted: Vec<Expr> = match halves {
        true => vec![crate::emit::forced::doubled(s, &leave)],
        false => vec![arrive, leave],
    };
    let wanted: Vec<Expr> = wanted.iter().map(|e| expr::parted(s, e)).collect();
    let (lets, results) = l.computed(s, &l.of_site(d, &wanted), &wanted);
    let collected = l.collected(&m.mover.name);
    let collected = (!collected.is_empty()).then(|| quote!(#(#collected)+*));
    let shared = |value: &TokenStream, e: &Expr, share: Rational| -> TokenStream {
        let own = (!e.is_zero()).then(|| m.array(value.clone()));
        let pulled =
            collected
                .as_ref()
                .filter(|_| !share.is_zero())
                .map(|c| match share.is_one() {
                    true => quote!(#c),
                    false => {
                        let share = crate::emit::expression::rational(share);
                        quote!((#c) * #share)
                    }
                });
        match (own, pulled) {
            (Some(own), Some(pulled)) => quote!(#own + #pulled),
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => quote!(SMatrix::zeros()),
        }
    };
    let [before, after] = l.line.shares;
    let name = &m.mover.name;
    let frame = match m.is_rotation() {
        true => ", in the body frame",
        false => "",
    };
    let (doc, output, value) = match (halves, results.as_slice()) {
        (true, [whole]) => (
            format!(
                " What acts on `{name}` at a node{frame}: half of it before the node, half after."
            ),
            quote!(#t),
            shared(whole, &wanted[0], Rational::integer(1)),
        ),
        (_, [arrive, leave]) => {
            let (a, b) = (
                shared(arrive, &wanted[0], before),
                shared(leave, &wanted[1], after),
            );
            (
                format!(" What acts on `{name}` before a node and after it{frame}."),
                quote!([#t; 2]),
                quote!([#a, #b]),
            )
        }
        _ => return TokenStream::new(),
    };
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, pulls: &#pulls<T>) -> #output {
            let _ = (#h, site, at, pulls);
            #lets
            #value
        }
    }
}

/// What the edge adds to a momentum that is found together with others.
fn added(l: &Lines, m: Moving) -> TokenStream {
    let Some(added) = m.mover.how.added() else {
        return TokenStream::new();
    };
    let d = m.outline();
    let s = &d.letters.symbols;
    let (kernel, places, t) = (edge_kernel(&m), l.item("Places"), m.covector());
    let h = step(d);
    let wanted: Vec<Expr> = match &m.mover.how {
        How::Newton {
            arriving: Some(arriving),
            ..
        } => vec![d.defined(added), d.defined(arriving)],
        _ => vec![d.defined(added)],
    };
    let at = Places {
        here: quote!(from),
        next: quote!(to),
    };
    let letters = l.of_site(d, &wanted);
    let (locals, mut bindings) = l.locals(s, &letters, &at, &quote!(site));
    let systems = l.systems();
    let Some((_, n, members)) = systems
        .iter()
        .find(|(.., members)| members.iter().any(|o| o.mover.name == m.mover.name))
    else {
        return TokenStream::new();
    };
    let velocities = taken_apart(members, &letters, &mut bindings, false);
    let (lets, results) = l.program(s, &wanted, &bindings);
    let value = match (wanted.as_slice(), results.as_slice()) {
        ([_], [value]) => m.array(value.clone()),
        ([leaving, arriving], [at_start, at_end]) => {
            let name = m.name();
            let parts = [
                (leaving, quote!(from.#name[site].matrix() * (#at_start))),
                (arriving, quote!(to.#name[site].matrix() * (#at_end))),
            ];
            let parts = parts.into_iter().filter(|(e, _)| !e.is_zero());
            let parts: Vec<TokenStream> = parts.map(|(_, value)| value).collect();
            match parts.is_empty() {
                true => quote!(SMatrix::zeros()),
                false => quote!(#(#parts)+*),
            }
        }
        _ => return TokenStream::new(),
    };
    let size = number(*n);
    let frame = match m.is_rotation() {
        true => ", in the space frame",
        false => "",
    };
    let doc = format!(
        " What the edge adds to the momentum of `{}`{frame}.",
        m.mover.name
    );
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, from: &#places<T>, to: &#places<T>, velocity: &SVector<T, #size>) -> #t {
            let _ = (#h, site, from, to, velocity);
            #locals
            #velocities
            #lets
            #value
        }
    }
}
