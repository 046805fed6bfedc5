//! `residual`: what a step leaves of its equations, each configuration by itself. Momenta are carried from node to node, so
//! that a bad solve does not show in what is conserved; it shows where the momentum that leaves a node is compared with the
//! one that the motion to the next node makes there.
//! Gives the function with its kernels; none for particles in a mesh or between walls, whose steps do more.

use super::locals::{Places, Stands, step};
use super::pulls::range_of;
use super::step::range_name;
use super::tied::{self, rows_of};
use super::{Lines, Moving, number};
use crate::derive::Derivation;
use crate::emit::expression::Bindings;
use crate::emit::names::variable;
use crate::expr::{self, Expr, Letter, Shift};
use crate::line::Tie;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The function.
pub(super) fn residual(l: &Lines) -> Option<TokenStream> {
    if l.line.meshed.is_some() || l.extent().is_some() {
        return None;
    }
    let [name, state, work, pulls] = ["", "State", "Workspace", "Pulls"].map(|x| l.item(x));
    let moving: Vec<Moving> = l.moving().collect();
    let kernels = moving.iter().map(|m| leaving(l, m));
    let kernels = kernels.collect::<Option<Vec<_>>>()?;
    let of_ties = l.line.ties.iter().enumerate();
    let of_ties = of_ties.map(|(k, tie)| of_tie(l, k + 1, tie));
    let of_ties: Vec<TokenStream> = of_ties.collect();
    let tied = tied_momenta(l);
    let pull_values = super::pulls::none_yet(l);
    let none = pull_values
        .is_empty()
        .then(|| quote!(scalar: ::core::marker::PhantomData));
    let reached = l.is_held().then(|| {
        let none = super::reactions::none_reached(l);
        quote! {
            let mut reached = #none;
            self.reached(&before.places, &mut reached);
        }
    });
    let each: Vec<TokenStream> = moving.iter().map(|m| of_mover(l, m)).collect();
    let count = number(moving.len());
    Some(quote! {
        impl<T: Real> #name<T> {
            #(#kernels)*
            #(#of_ties)*

            /// What the step that has just been made, from one state to the other, leaves of its equations: one part for
            /// each of what moves, of all sites the largest.
            pub fn residual(&self, before: &#state<T>, after: &#state<T>, work: &#work<T>) -> [Residual; #count] {
                let h = work.h;
                let mut pulls = #pulls { #(#pull_values,)* #none };
                self.pulled(h, &before.places, &mut pulls);
                #reached
                #tied
                [#(#each),*]
            }
        }
    })
}

fn kernel(m: &Moving) -> Ident {
    format_ident!("leaving_{}", m.mover.name)
}

/// The velocity from one node to the next at a site.
fn velocity(m: &Moving, site: &TokenStream) -> TokenStream {
    let name = m.name();
    match (m.is_quaternion(), m.is_rotation(), m.is_number()) {
        (true, ..) => quote! {
            line::between(&at.#name.at(#site).unit_quaternion(), &to.#name.at(#site).unit_quaternion())
        },
        (_, true, _) => {
            quote!(at.#name.at(#site).matrix().tr_mul(&to.#name.at(#site).matrix()))
        }
        (.., true) => quote!(to.#name[#site][0] - at.#name[#site][0]),
        _ => quote!(to.#name[#site] - at.#name[#site]),
    }
}

/// The kernel of the momentum that the motion between two nodes makes at the first of them, with the size of its terms.
fn leaving(l: &Lines, m: &Moving) -> Option<TokenStream> {
    let (d, outline) = (m.d(), m.outline());
    let s = &outline.letters.symbols;
    let balance = d.balances.get(m.mover.index)?;
    let momentum = expr::substitute(s, &balance.outgoing, &d.spec.end_of_edge());
    let momentum = expr::parted(s, &outline.defined(&momentum));
    let size = expr::magnitude_between(s, &momentum, &paths(d));
    let is_number = momentum.shape().is_scalar();
    let values = [momentum, size];
    let velocities: Vec<(Letter, Moving)> = l
        .moving()
        .filter(|o| std::ptr::eq(o.lone, m.lone))
        .map(|o| {
            let symbol = d.spec.configurations[o.mover.index].velocity;
            let shift = Shift::HERE;
            (Letter { symbol, shift }, o)
        })
        .collect();
    let mut letters = l.of_site(outline, &values);
    letters.retain(|k| velocities.iter().all(|(v, _)| *v != k.letter));
    let places = Places {
        here: quote!(at),
        next: quote!(to),
    };
    let (mut locals, mut bindings) = l.locals(s, &letters, &places, &quote!(site));
    for (letter, of) in &velocities {
        if values.iter().any(|e| expr::contains(e, *letter)) {
            let base = variable(s, letter.symbol).to_string();
            locals.extend(bound(l, of, (*letter, &base), &values, &mut bindings));
        }
    }
    let (lets, results) = l.program(s, &values, &bindings);
    let [momentum, size] = results.as_slice() else {
        return None;
    };
    let momentum = match is_number {
        true => m.array(momentum.clone()),
        false => momentum.clone(),
    };
    let (kernel, places, t) = (kernel(m), l.item("Places"), m.covector());
    let (h, name) = (step(outline), &m.mover.name);
    let frame = if m.is_rotation() {
        ", in the body frame"
    } else {
        ""
    };
    let doc = format!(
        " The momentum of `{name}` that leaves a node, as the motion to the next one makes it{frame}, and the size of its terms."
    );
    Some(quote! {
        #[doc = #doc]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, to: &#places<T>) -> (#t, T) {
            let _ = (#h, site, at, to);
            #locals
            #lets
            (#momentum, #size)
        }
    })
}

/// For each velocity of a field the distances of its two ends from the origin: places are rounded to them.
fn paths(d: &Derivation) -> Vec<(Letter, Expr)> {
    let s = &d.letters.symbols;
    let each = d.spec.configurations.iter().filter_map(|c| {
        let size = |shift| {
            let place = c.group.place(s, &expr::letter(s, c.element, shift))?;
            Some(expr::length(s, &place))
        };
        let velocity = Letter {
            symbol: c.velocity,
            shift: Shift::HERE,
        };
        Some((velocity, expr::add(size(Shift::HERE)?, size(Shift::NEXT)?)))
    });
    each.collect()
}

/// The let of a velocity, and how expressions find it.
fn bound(
    l: &Lines,
    m: &Moving,
    (letter, base): (Letter, &str),
    values: &[Expr],
    bindings: &mut Bindings,
) -> TokenStream {
    let s = &m.outline().letters.symbols;
    let mut used = Vec::new();
    let local = l.unique(base, base, &mut used);
    let value = velocity(m, &quote!(site));
    if !m.is_quaternion() {
        bindings.bind(letter, local.clone());
        return quote!(let #local = #value;);
    }
    let unit = l.unique(base, &format!("{base}_unit"), &mut used);
    let stands = Stands::of(s, letter, values);
    bindings.bind_quaternion(letter, unit.clone());
    let mut lets = quote!(let #unit = #value;);
    if stands.turned {
        let turn = l.unique(base, &format!("{base}_turn"), &mut used);
        bindings.bind_rotation(letter, turn.clone());
        lets.extend(quote!(let #turn = #unit.rotation().matrix();));
    }
    if stands.alone {
        bindings.bind(letter, local.clone());
        lets.extend(quote!(let #local = #unit.matrix();));
    }
    lets
}

/// The part of one configuration.
fn of_mover(l: &Lines, m: &Moving) -> TokenStream {
    let (name, kernel, range) = (m.name(), kernel(m), range_name(m));
    let turn = quote!(before.places.#name.at(site).matrix());
    let carried = match m.is_rotation() {
        true => quote!(#turn.tr_mul(&before.momenta.#name[site])),
        false => quote!(before.momenta.#name[site]),
    };
    let [_, share] = l.line.shares;
    let share = (!share.is_zero()).then(|| crate::emit::expression::rational(share));
    let pulled = share.iter().flat_map(|share| {
        let each = l.collected(&m.mover.name).into_iter();
        each.map(move |pull| quote! { let pull = #pull * #share; let (carried, size) = (carried + pull, size + length(&pull)); })
    });
    let kicked = l.is_reached(&m.mover.name).then(|| {
        let reacted = format_ident!("reacted_{}", m.mover.name);
        quote! {
            let kick = self.#reacted(site, &reached, &work.found);
            let (carried, size) = (carried + kick, size + length(&kick));
        }
    });
    let is_tied = l.line.is_tied(&m.mover.name);
    let tied = is_tied.then(|| tied::block(l)).flatten();
    let tied = tied.map(|(_, _, members)| {
        let (row, rows) = rows_of(&members, &m.mover.name);
        let (row, rows) = (number(row), number(rows));
        quote! {
            let added = tied[site].fixed_rows::<#rows>(#row).into_owned();
            let (made, size) = (made + added, size + length(&added));
        }
    });
    // What is found together is as exact as the largest of it.
    let of_all = match is_tied || l.body_of(&m.mover.name).is_some() {
        true => quote!(line::residual_of_all),
        false => quote!(line::worst_residual),
    };
    quote! {
        {
            let [first, last] = self.#range();
            #of_all(last - first, |i| {
                let site = first + i;
                let (made, size) = self.#kernel(h, site, &before.places, &after.places);
                let carried = #carried;
                #(#pulled)*
                #kicked
                #tied
                Residual::between(&carried, &made, size)
            })
        }
    }
}

/// The momenta of terms of neighbours in which velocities stand, of all sites.
fn tied_momenta(l: &Lines) -> Option<TokenStream> {
    let (field, n, members) = tied::block(l)?;
    let n = number(n);
    let count = l.count_of(&members.first()?.mover.name);
    let each = l.line.ties.iter().enumerate().map(|(k, tie)| {
        let (kernel, range) = (
            tied_kernel(k + 1),
            range_of(l, tie.label, tie.from, tie.to),
        );
        let touched = tied::touched(l, tie, &count);
        quote! {
            {
                #range
                line::spread([first, last], |site| #touched, &work.#field, &mut tied, |site, velocities| {
                    let _ = velocities;
                    self.#kernel(h, site, &before.places, &after.places)
                });
            }
        }
    });
    Some(quote! {
        let mut tied = ::std::vec![SVector::<T, #n>::zeros(); #count];
        #(#each)*
    })
}

fn tied_kernel(k: usize) -> Ident {
    format_ident!("leaving_tied_{k}")
}

/// The kernel of what one such term makes of the momenta of its sites.
fn of_tie(l: &Lines, k: usize, tie: &Tie) -> TokenStream {
    let Some((_, n, members)) = tied::block(l) else {
        return TokenStream::new();
    };
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let values: Vec<Expr> = tie.parts.iter().map(|p| p.momentum.clone()).collect();
    let mut letters = super::pulls::known(l, &values);
    letters.retain(|k| tie.parts.iter().all(|p| p.velocity != k.letter));
    let (mut locals, mut bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let mut used = Vec::new();
    for own in &tie.parts {
        let Some(of) = members.iter().find(|m| m.mover.name == own.on) else {
            continue;
        };
        let base = format!("change_{}_{}", own.on, own.site);
        let local = l.unique(&base, &base, &mut used);
        let on: Literal = number(own.site);
        let value = velocity(of, &quote!((site + #on)));
        locals.extend(quote!(let #local = #value;));
        bindings.bind(own.velocity, local);
    }
    let (lets, results) = l.program(s, &values, &bindings);
    let (size, wide) = (number(n), number(tie.width + 1));
    let fill = tie.parts.iter().zip(results).map(|(own, value)| {
        let (row, rows) = rows_of(&members, &own.on);
        let (row, rows, site) = (number(row), number(rows), number(own.site));
        let of = members.iter().find(|m| m.mover.name == own.on);
        let value = of.map_or(value.clone(), |m| m.array(value));
        quote!(made[#site].fixed_view_mut::<#rows, 1>(#row, 0).copy_from(&(#value));)
    });
    let (kernel, places, h) = (tied_kernel(k), l.item("Places"), step(&part.d));
    quote! {
        /// What a term of neighbours makes of the momenta of its sites that leave a node.
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, to: &#places<T>) -> [SVector<T, #size>; #wide] {
            let _ = (#h, site, at, to);
            #locals
            #lets
            let mut made = [SVector::<T, #size>::zeros(); #wide];
            #(#fill)*
            made
        }
    }
}
