//! Kernels of what acts on a site at a node: its own potential and what neighbours add, before the node
//! and after it; of blocks of fields, what the edge adds. The loop over sites that puts it all to the momenta.

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
    let arrivals = l.moving().filter_map(|m| arrival(l, m));
    let arrivals: Vec<TokenStream> = arrivals.collect();
    quote!(impl<T: Real> #name<T> { #(#each)* #(#added)* #(#arrivals)* })
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
    let Some((_, n, members)) = l.system_of(&m) else {
        return TokenStream::new();
    };
    let velocities = taken_apart(&members, &letters, &mut bindings, false);
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
    let size = number(n);
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

/// What is done with what acts: the momentum at the node and that of the edge that leaves, given that
/// of the edge that came.
fn arrived(l: &Lines, m: &Moving) -> TokenStream {
    let name = m.name();
    match (m.is_rotation(), l.acting(m)) {
        (true, Acting::Halves) => quote! {
            let turn = at.#name[site].matrix();
            let space = edge.space();
            let kick = turn * acting;
            let momentum = space + kick * T::from_f64(0.5);
            let edge = Edge::new(turn.tr_mul(&space) + acting, space + kick);
            all_finite(&edge.space()).then_some((momentum, edge))
        },
        (true, Acting::Both) => quote! {
            let [before, after] = acting;
            let turn = at.#name[site].matrix();
            let space = edge.space();
            let momentum = space + turn * before;
            let edge = Edge::new(turn.tr_mul(&space) + before + after, momentum + turn * after);
            all_finite(&edge.space()).then_some((momentum, edge))
        },
        (false, Acting::Halves) => quote! {
            let momentum = edge + acting * T::from_f64(0.5);
            let edge = edge + acting;
            all_finite(&edge).then_some((momentum, edge))
        },
        (false, Acting::Both) => quote! {
            let [before, after] = acting;
            let momentum = edge + before;
            let edge = momentum + after;
            all_finite(&edge).then_some((momentum, edge))
        },
    }
}

/// The name of the loop over the sites at which a momentum arrives.
fn arriving(m: &Moving) -> Ident {
    format_ident!("arrive_{}", m.mover.name)
}

/// The loop, of a configuration whose velocity is found site by site. A method of its own: what it reads is told apart from
/// what it writes, so that it can be made several sites at a time.
fn arrival(l: &Lines, m: Moving) -> Option<TokenStream> {
    if m.system().is_some() {
        return None;
    }
    let (name, arriving, kernel) = (m.name(), arriving(&m), kernel(&m));
    let [places, pulls, momenta, edges] =
        ["Places", "Pulls", "Momenta", "Edges"].map(|n| l.item(n));
    let (range, arrived) = (super::step::range_name(&m), arrived(l, &m));
    let doc = format!(
        " The momenta of `{}` at the node, and those of the edges that leave, from those of the edges that came. Says at \
         which site they are not finite.",
        m.mover.name
    );
    Some(quote! {
        #[doc = #doc]
        #[inline]
        fn #arriving(
            &self, h: T, at: &#places<T>, pulls: &#pulls<T>, momenta: &mut #momenta<T>, edges: &mut #edges<T>,
        ) -> Result<(), usize> {
            let [first, last] = self.#range();
            line::update(self.threads, &mut momenta.#name[first..last], &mut edges.#name[first..last], |i, edge| {
                let site = first + i;
                let acting = self.#kernel(h, site, at, pulls);
                #arrived
            })
        }
    })
}

/// The momenta of one configuration at the next node, and those of the edges that leave it.
pub(super) fn arrive(l: &Lines, m: &Moving) -> TokenStream {
    let (name, text, range, kernel) = (
        m.name(),
        &m.mover.name,
        super::step::range_name(m),
        kernel(m),
    );
    let refused = quote! {
        let cause = StepCause::not_finite("momentum");
        return Err(self.refused(state, h, line::Place { quantity: #text, site: first + i }, cause));
    };
    let Some((field, ..)) = l.system_of(m) else {
        let arriving = arriving(m);
        return quote! {
            {
                let [first, _] = self.#range();
                let made = self.#arriving(h, &work.places, &work.pulls, &mut work.momenta, &mut work.edges);
                if let Err(i) = made {
                    #refused
                }
            }
        };
    };
    let (edge_kernel, tied) = (edge_kernel(m), super::tied::added(l, m));
    let of_edge = quote!(self.#edge_kernel(h, site, &state.places, at, &work.#field[site])#tied);
    let added = match m.is_rotation() {
        true => quote!(let edge = Edge::new(edge.body(), edge.space() + #of_edge);),
        false => quote!(let edge = edge + #of_edge;),
    };
    let arrived = arrived(l, m);
    quote! {
        {
            let [first, last] = self.#range();
            let (at, pulls) = (&work.places, &work.pulls);
            let made = line::update(
                self.threads,
                &mut work.momenta.#name[first..last],
                &mut work.edges.#name[first..last],
                |i, edge| {
                    let site = first + i;
                    #added
                    let acting = self.#kernel(h, site, at, pulls);
                    #arrived
                },
            );
            if let Err(i) = made {
                #refused
            }
        }
    }
}
