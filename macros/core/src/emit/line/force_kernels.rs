//! Kernels of the force on a site at a node: its own potential and the neighbour forces, before and after the node.
//! For blocks of fields, also the force of the edge. The loop over sites adds these forces to the momenta.

use super::arguments::{Argument, seen_at};
use super::lanes::{Windows, are_together};
use super::locals::{Places, step};
use super::neighbour_forces::{field, front};
use super::velocities::taken_apart;
use super::{Lines, Moving, number};
use crate::algebra::Rational;
use crate::expr::{self, Expr};
use crate::line::SiteSolve;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The form of the force at a node.
pub(super) enum ForceForm {
    /// One covector: half of it acts before the node, half after.
    Halves,
    /// One covector before the node and one after.
    Both,
}

/// The site's own forces at a node: at the end of the incoming edge, and at the start of the outgoing edge.
fn own(m: &Moving) -> [Expr; 2] {
    let d = m.outline();
    let s = &d.letters.symbols;
    let at_node = |e: &Expr| d.defined(&expr::shift_time(s, e, -1));
    match &m.mover.how {
        SiteSolve::Rotation { leave, arrive, .. } => [at_node(arrive), d.defined(leave)],
        SiteSolve::Field { form, arrive } => {
            [at_node(arrive), d.defined(&expr::neg(form.rest.clone()))]
        }
        SiteSolve::System { .. } | SiteSolve::Newton { .. } => {
            let shape = d.balances[m.mover.index].outgoing.shape();
            [expr::zero(shape), expr::zero(shape)]
        }
    }
}

impl Lines<'_> {
    /// [`ForceForm::Halves`] if the two shares of every force are equal, both of the site's own forces and of neighbour
    /// forces.
    pub(super) fn force_form(&self, m: &Moving) -> ForceForm {
        let [arrive, leave] = own(m);
        let [before, after] = self.line.shares;
        match arrive == leave && before == after {
            true => ForceForm::Halves,
            false => ForceForm::Both,
        }
    }

    /// The forces of neighbours and functionals on a configuration at a site, term by term.
    fn pulled(&self, name: &str) -> Vec<Pulled> {
        let mut terms: Vec<Pulled> = Vec::new();
        for (n, pull) in self.line.pulls.iter().enumerate() {
            for f in pull.forces.iter().filter(|f| f.on == name) {
                terms.push(Pulled {
                    array: format_ident!("pull_{}", n + 1),
                    by: front(pull) - f.site,
                    field: Some(field(name, f.site)),
                });
            }
        }
        let of_functionals = self.line.meshed.iter().flat_map(|m| &m.forces);
        if of_functionals.into_iter().any(|f| f.on == name) {
            terms.push(Pulled {
                array: super::meshes::collected(name),
                by: 0,
                field: None,
            });
        }
        terms
    }

    /// The values of those forces at a site.
    pub(super) fn collected(&self, name: &str) -> Vec<TokenStream> {
        self.pulled(name).iter().map(Pulled::value).collect()
    }
}

/// The force of one neighbour term, or of a functional, at a site.
struct Pulled {
    array: Ident,
    /// The offset of its position in the array from the site.
    by: usize,
    field: Option<Ident>,
}

impl Pulled {
    fn value(&self) -> TokenStream {
        let (array, by) = (&self.array, number(self.by));
        match &self.field {
            Some(field) => quote!(pulls.#array.at(site + #by).#field),
            None => quote!(pulls.#array[site]),
        }
    }

    /// The value in the window of its list.
    fn seen(&self) -> TokenStream {
        let (at, field) = (seen_at(&self.window(), self.by), self.field.iter());
        quote!(#at #(.#field)*)
    }

    fn window(&self) -> Ident {
        format_ident!("__at_{}", self.array)
    }

    /// Its name in the kernel. No name of a model starts with `__`.
    fn name(&self) -> Ident {
        match &self.field {
            Some(field) => format_ident!("__{}_{field}", self.array),
            None => format_ident!("__{}", self.array),
        }
    }
}

/// The name of the kernel.
pub(super) fn kernel(m: &Moving) -> Ident {
    format_ident!("acted_{}", m.mover.name)
}

/// The name of the kernel of the force of the edge.
pub(super) fn edge_kernel(m: &Moving) -> Ident {
    format_ident!("added_{}", m.mover.name)
}

/// The kernels.
pub(super) fn all_kernels(l: &Lines) -> TokenStream {
    let name = l.item("");
    let each = l.moving().map(|m| one(l, m));
    let each: Vec<TokenStream> = each.collect();
    let added = l.moving().map(|m| added(l, m));
    let added: Vec<TokenStream> = added.collect();
    let arrivals = l.moving().filter_map(|m| arrival(l, m));
    let arrivals: Vec<TokenStream> = arrivals.collect();
    let arrived = l.moving().map(|m| arrived(l, &m));
    let stages = l.moving().filter_map(|m| stage(l, &m));
    let (arrived, stages): (Vec<_>, Vec<_>) = (arrived.collect(), stages.collect());
    quote!(impl<T: Real> #name<T> { #(#each)* #(#added)* #(#arrived)* #(#arrivals)* } #(#stages)*)
}

/// The site's own forces as the kernel computes them: the whole force if the two halves are equal.
fn wanted(l: &Lines, m: &Moving) -> Vec<Expr> {
    let s = &m.outline().letters.symbols;
    let [arrive, leave] = own(m);
    let wanted: Vec<Expr> = match l.force_form(m) {
        ForceForm::Halves => vec![crate::emit::forced::doubled(s, &leave)],
        ForceForm::Both => vec![arrive, leave],
    };
    wanted
        .iter()
        .map(|e| expr::quaternion_components(s, e))
        .collect()
}

/// The arguments of the kernel at its site.
fn reads(l: &Lines, m: &Moving) -> Vec<Argument> {
    let d = m.outline();
    let letters = l.of_site(d, &wanted(l, m));
    l.read(&d.letters.symbols, &letters).arguments
}

/// The force on a site; `at` is the list of all positions.
pub(super) fn call(l: &Lines, m: &Moving, at: &TokenStream) -> TokenStream {
    let kernel = kernel(m);
    let at = Places {
        here: at.clone(),
        next: at.clone(),
    };
    let own = reads(l, m).into_iter();
    let own = own.map(|a| a.value(&at, &quote!(site)));
    let all = own.chain(l.collected(&m.mover.name));
    quote!(self.#kernel(h, #(#all),*))
}

fn one(l: &Lines, m: Moving) -> TokenStream {
    let d = m.outline();
    let s = &d.letters.symbols;
    let (kernel, t) = (kernel(&m), m.covector());
    let h = step(d);
    let halves = matches!(l.force_form(&m), ForceForm::Halves);
    let wanted = wanted(l, &m);
    let read = l.read(s, &l.of_site(d, &wanted));
    let (lets, results) = l.program(s, &wanted, &read.bindings);
    let known_once = &read.lets;
    let pulled: Vec<Ident> = l.pulled(&m.mover.name).iter().map(Pulled::name).collect();
    let arguments = read.arguments.iter().map(Argument::declared);
    let collected = (!pulled.is_empty()).then(|| quote!(#(#pulled)+*));
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
                " The impulse on `{name}` at a node{frame}: half of it acts before the node, half after."
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
                format!(" The impulses on `{name}` before and after a node{frame}."),
                quote!([#t; 2]),
                quote!([#a, #b]),
            )
        }
        _ => return TokenStream::new(),
    };
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, #(#arguments,)* #(#pulled: #t),*) -> #output {
            let _ = #h;
            #known_once
            #lets
            #value
        }
    }
}

/// The kernel of the force of the edge, for a momentum that is solved in a block.
fn added(l: &Lines, m: Moving) -> TokenStream {
    let Some(added) = m.mover.how.added() else {
        return TokenStream::new();
    };
    let d = m.outline();
    let s = &d.letters.symbols;
    let (kernel, places, t) = (edge_kernel(&m), l.item("Places"), m.covector());
    let h = step(d);
    let wanted: Vec<Expr> = match &m.mover.how {
        SiteSolve::Newton {
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
                (leaving, quote!(from.#name.at(site).matrix() * (#at_start))),
                (arriving, quote!(to.#name.at(site).matrix() * (#at_end))),
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
        " The increment of the momentum of `{}` on the edge{frame}.",
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

/// The kernel that applies the force: from the momentum of the incoming edge it gives the node momentum and the
/// momentum of the outgoing edge.
fn arrived(l: &Lines, m: &Moving) -> TokenStream {
    let (kernel, t) = (arrived_kernel(m), m.covector());
    let turned = m.is_rotation().then(|| quote!(turn *));
    let in_space = m.is_rotation().then(|| quote!(let acting = turn * acting;));
    let (acting, done) = match l.force_form(m) {
        ForceForm::Halves => (
            quote!(#t),
            quote! {
                #in_space
                (edge + acting * T::from_f64(0.5), edge + acting)
            },
        ),
        ForceForm::Both => (
            quote!([#t; 2]),
            quote! {
                let [before, after] = acting;
                let momentum = edge + #turned before;
                (momentum, momentum + #turned after)
            },
        ),
    };
    let turn = m.is_rotation().then(|| quote!(turn: SMatrix<T, 3, 3>,));
    let doc = format!(
        " The momentum of `{}` at the node and on the outgoing edge, from the momentum on the incoming edge.",
        m.mover.name
    );
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, acting: #acting, #turn edge: #t) -> (#t, #t) {
            #done
        }
    }
}

fn arrived_kernel(m: &Moving) -> Ident {
    format_ident!("arrived_{}", m.mover.name)
}

/// The name of the loop over the sites that computes their momenta on arrival.
fn arriving(m: &Moving) -> Ident {
    format_ident!("arrive_{}", m.mover.name)
}

/// The call of that kernel in a loop over sites.
fn arrived_call(m: &Moving, acting: &TokenStream) -> TokenStream {
    let (kernel, name) = (arrived_kernel(m), m.name());
    let turn = m.is_rotation().then(|| quote!(at.#name.at(site).matrix(),));
    quote! {
        let (momentum, edge) = self.#kernel(#acting, #turn edge);
        all_finite(&edge).then_some((momentum, edge))
    }
}

/// The kernel for several sites together, as an item of its own.
fn stage(l: &Lines, m: &Moving) -> Option<TokenStream> {
    if m.system().is_some() || !are_together(&wanted(l, m)) {
        return None;
    }
    let [model, places, pulls] = ["", "Places", "Pulls"].map(|x| l.item(x));
    let (name, t) = (stage_name(l, m), m.covector());
    let (acted, arrived) = (kernel(m), arrived_kernel(m));
    let (own, pulled) = (reads(l, m), l.pulled(&m.mover.name));
    let mut windows = Windows::of(&own);
    for p in &pulled {
        let array = &p.array;
        windows.add(p.window(), quote!(pulls.#array), p.by);
    }
    let turn = m
        .is_rotation()
        .then(|| Argument::place(m, m.name()))
        .map(|place| {
            windows.add(place.window(), place.list(), 0);
            let seen = place.seen();
            quote!(#seen,)
        });
    let windows = windows.stated();
    let values = own.iter().map(Argument::seen);
    let values = values.chain(pulled.iter().map(Pulled::seen));
    Some(quote! {
        ::clebsch::in_lanes! {
            /// The momenta at the node and on the outgoing edges, for several sites together.
            #name(model: #model<T>, h: T, at: #places<T>, pulls: #pulls<T>) -> #t, #t
            #windows
            |site, edge| model.#arrived(model.#acted(*h, #(#values),*), #turn edge)
        }
    })
}

fn stage_name(l: &Lines, m: &Moving) -> Ident {
    l.item(&format!("ArrivedTogether_{}", m.mover.name))
}

/// The loop for a configuration whose velocity is found site by site. As a separate method, it keeps inputs and
/// outputs distinct, so that it can process several sites at a time.
fn arrival(l: &Lines, m: Moving) -> Option<TokenStream> {
    if m.system().is_some() {
        return None;
    }
    let (name, arriving, stage) = (m.name(), arriving(&m), stage_name(l, &m));
    let [places, pulls, momenta, edges] =
        ["Places", "Pulls", "Momenta", "Edges"].map(|n| l.item(n));
    let range = super::step::range_name(&m);
    let arrived = arrived_call(&m, &call(l, &m, &quote!(at)));
    let part = m.part(&quote!(edges.#name));
    let doc = format!(
        " The momenta of `{}` at the node and on the outgoing edges, from the momenta on the incoming edges. If a \
         momentum is not finite, the error names its site.",
        m.mover.name
    );
    let (loop_over_sites, together) = match are_together(&wanted(l, &m)) {
        true => (
            quote!(line::update_in_lanes),
            quote!(, &#stage { model: self, h: &h, at, pulls, first }),
        ),
        false => (quote!(line::update), TokenStream::new()),
    };
    Some(quote! {
        #[doc = #doc]
        #[inline]
        fn #arriving(
            &self, h: T, at: &#places<T>, pulls: &#pulls<T>, momenta: &mut #momenta<T>, edges: &mut #edges<T>,
        ) -> Result<(), usize> {
            let [first, last] = self.#range();
            #loop_over_sites(self.threads, &mut momenta.#name[first..last], #part, |i, edge| {
                let site = first + i;
                #arrived
            } #together)
        }
    })
}

/// The momenta of one configuration at the next node, and the momenta of the edges that start there.
pub(super) fn arrive(l: &Lines, m: &Moving) -> TokenStream {
    let (name, text) = (m.name(), &m.mover.name);
    let range = super::step::range_name(m);
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
    let (edge_kernel, tied) = (edge_kernel(m), super::coupled_velocities::added(l, m));
    let of_edge = quote!(self.#edge_kernel(h, site, &state.places, at, &work.#field[site])#tied);
    let added = quote!(let edge = edge + #of_edge;);
    let arrived = arrived_call(m, &call(l, m, &quote!(at)));
    let part = m.part(&quote!(work.edges.#name));
    quote! {
        {
            let [first, last] = self.#range();
            let (at, pulls) = (&work.places, &work.pulls);
            let made = line::update(
                self.threads,
                &mut work.momenta.#name[first..last],
                #part,
                |i, edge| {
                    let site = first + i;
                    #added
                    #arrived
                },
            );
            if let Err(i) = made {
                #refused
            }
        }
    }
}
