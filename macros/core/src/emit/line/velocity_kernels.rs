//! Kernels of the velocities of a site: from the momentum of the edge that leaves a node to the position at the next
//! node.

use super::arguments::Argument;
use super::lanes::Windows;
use super::locals::{Places, step};
use super::velocities::{as_array, taken_apart, width};
use super::{Lines, Moving, number};
use crate::derive::two_sided_linear::TwoSidedLinear;
use crate::emit::blocks::linear_solution;
use crate::emit::element;
use crate::expr::{self, Expr};
use crate::line::SiteSolve;
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

impl Lines<'_> {
    /// Blocks of fields that are solved together: the field of their velocities, the number of components, and their
    /// members in order.
    pub(super) fn systems(&self) -> Vec<(Ident, usize, Vec<Moving<'_>>)> {
        let mut out: Vec<(Ident, usize, Vec<Moving>)> = Vec::new();
        for m in self.moving() {
            let Some(block) = m.system() else {
                continue;
            };
            let members: Vec<Moving> = self
                .moving()
                .filter(|o| std::ptr::eq(o.lone, m.lone) && block.contains(&o.mover.index))
                .collect();
            if members.first().is_none_or(|f| f.mover.name != m.mover.name) {
                continue;
            }
            let count = members.iter().map(Moving::components).sum();
            out.push((format_ident!("velocity_{}", m.mover.name), count, members));
        }
        out
    }

    /// The block that contains a configuration, if its velocity is solved together with others.
    pub(super) fn system_of(&self, m: &Moving) -> Option<(Ident, usize, Vec<Moving<'_>>)> {
        let mut systems = self.systems().into_iter();
        systems.find(|(.., members)| members.iter().any(|o| o.mover.name == m.mover.name))
    }
}

impl Moving<'_> {
    /// The number of components of its velocity.
    pub(super) fn components(&self) -> usize {
        let most = element::most_coordinates(self.d(), self.mover.index);
        usize::try_from(most).unwrap_or(0)
    }
}

/// The kernels.
pub(super) fn solved(l: &Lines) -> TokenStream {
    let name = l.item("");
    let each = l.moving().map(|m| match &m.mover.how {
        SiteSolve::Rotation { .. } => rotation(l, m),
        SiteSolve::Field { .. } => field(l, m),
        SiteSolve::System { .. } | SiteSolve::Newton { .. } => TokenStream::new(),
    });
    let each: Vec<TokenStream> = each.collect();
    let stages = l.moving().filter_map(|m| stage(l, &m));
    let stages: Vec<TokenStream> = stages.collect();
    let systems = l.systems();
    let systems = systems.iter().map(|(_, n, members)| {
        let by_newton = members
            .first()
            .map(|m| matches!(m.mover.how, SiteSolve::Newton { .. }));
        match by_newton {
            Some(true) => newton(l, *n, members),
            _ => system(l, *n, members),
        }
    });
    quote!(impl<T: Real> #name<T> { #(#each)* #(#systems)* } #(#stages)*)
}

/// The name of the kernel of a velocity.
pub(super) fn kernel(m: &Moving) -> Ident {
    format_ident!("moved_{}", m.mover.name)
}

fn rotation(l: &Lines, m: Moving) -> TokenStream {
    let (kernel, places, name) = (kernel(&m), l.item("Places"), m.name());
    let factor = format_ident!("factor_{}", m.mover.name);
    let h = step(m.outline());
    let doc = format!(
        " `{}` at the end of the outgoing edge of a site.",
        m.mover.name
    );
    let turn = match m.is_quaternion() {
        true => quote!(edge.turn_in_quaternions(factor, #h, &attitude.unit_quaternion())),
        false => quote!(edge.turn(factor, #h, &attitude.rotation())),
    };
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, edge: &SMatrix<T, 3, 1>) -> Result<line::Attitude<T>, StepCause> {
            let attitude = at.#name.at(site);
            let edge = Edge::of_space(*edge, &attitude.rotation());
            let factor = &self.#factor[site.min(self.#factor.len() - 1)];
            match #turn {
                Ok(turned) => Ok(line::Attitude::turned(&turned)),
                Err(e) => Err(StepCause::from(e)),
            }
        }
    }
}

fn field(l: &Lines, m: Moving) -> TokenStream {
    let SiteSolve::Field { form, .. } = &m.mover.how else {
        return TokenStream::new();
    };
    let factors = [&form.left, &form.right];
    let d = m.outline();
    let s = &d.letters.symbols;
    let (kernel, t) = (kernel(&m), m.covector());
    let h = step(d);
    let values: Vec<Expr> = factors.iter().map(|e| d.defined(e)).collect();
    let read = l.read(s, &l.of_site(d, &values));
    let (lets, results) = l.program(s, &values, &read.bindings);
    let arguments: Vec<TokenStream> = read.arguments.iter().map(Argument::declared).collect();
    let known_once = &read.lets;
    let [left, right] = results.as_slice() else {
        return TokenStream::new();
    };
    // The solution wraps a scalar in an array.
    let known = match m.is_number() {
        true => quote!(edge[0]),
        false => quote!(edge),
    };
    let index = m.mover.index;
    let solution = linear_solution(m.d(), index, form, left.clone(), known, right.clone());
    let doc = format!(
        " `{}` at the end of the outgoing edge of a site.",
        m.mover.name
    );
    let at_once = is_divided(form).then(|| {
        let (kernel, arguments) = (at_once(&m), arguments.clone());
        quote! {
            /// Solves without a branch; also returns whether there is a solution.
            #[inline(always)]
            fn #kernel(&self, #h: T, place: #t, edge: #t, #(#arguments),*) -> (#t, bool) {
                #known_once
                #lets
                let (velocity, found) = divided_at_once(&edge, #left);
                (place + velocity, found)
            }
        }
    });
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, place: #t, edge: #t, #(#arguments),*) -> Result<#t, StepCause> {
            #known_once
            #lets
            match #solution {
                Ok(velocity) => Ok(place + velocity.matrix()),
                Err(e) => Err(StepCause::Singular(e)),
            }
        }
        #at_once
    }
}

/// Whether the momentum is a scalar multiple of the velocity.
fn is_divided(form: &TwoSidedLinear) -> bool {
    [&form.left, &form.right].map(|e| e.shape().is_scalar()) == [true; 2]
}

fn at_once(m: &Moving) -> Ident {
    format_ident!("at_once_{}", m.mover.name)
}

/// The arguments of the kernel of a field at its site, besides position and edge momentum.
fn reads_of_field(l: &Lines, m: &Moving) -> Option<Vec<Argument>> {
    let SiteSolve::Field { form, .. } = &m.mover.how else {
        return None;
    };
    let d = m.outline();
    let values = [d.defined(&form.left), d.defined(&form.right)];
    Some(l.read(&d.letters.symbols, &l.of_site(d, &values)).arguments)
}

/// The kernel for several sites together, as an item of its own.
fn stage(l: &Lines, m: &Moving) -> Option<TokenStream> {
    let arguments = reads_of_field(l, m)?;
    let (model, places, t) = (l.item(""), l.item("Places"), m.covector());
    let (name, kernel, edges) = (stage_name(l, m), kernel(m), m.edges());
    let own = Argument::place(m, m.name());
    let mut windows = Windows::of(&arguments);
    windows.add(own.window(), own.list(), 0);
    windows.add(format_ident!("leaving"), quote!(*edges), 0);
    let (windows, place) = (windows.stated(), own.seen());
    let values: Vec<TokenStream> = arguments.iter().map(Argument::seen).collect();
    let reached = match &m.mover.how {
        SiteSolve::Field { form, .. } if is_divided(form) => {
            let kernel = at_once(m);
            quote!(model.#kernel(*h, #place, leaving.at(site), #(#values),*))
        }
        _ => quote! {
            match model.#kernel(*h, #place, leaving.at(site), #(#values),*) {
                Ok(reached) => (reached, true),
                Err(_) => (#place, false),
            }
        },
    };
    Some(quote! {
        ::clebsch::in_lanes! {
            /// The positions at the ends of outgoing edges, for several sites together.
            #name(model: #model<T>, h: T, at: #places<T>, edges: #edges) -> #t
            #windows
            |site| #reached
        }
    })
}

fn stage_name(l: &Lines, m: &Moving) -> Ident {
    l.item(&format!("MovedTogether_{}", m.mover.name))
}

/// The loop over the sites of a configuration whose velocity is found site by site.
pub(super) fn loop_over_sites(l: &Lines, m: &Moving) -> TokenStream {
    let (name, kernel) = (m.name(), kernel(m));
    let part = m.part(&quote!(work.places.#name));
    match reads_of_field(l, m) {
        Some(arguments) => {
            let (at, stage) = (Places::of_node(), stage_name(l, m));
            let values = arguments.iter().map(|a| a.value(&at, &quote!(site)));
            quote! {
                line::try_fill_in_lanes(self.threads, #part, |i| {
                    let site = first + i;
                    self.#kernel(h, at.#name[site], edges[site], #(#values),*)
                }, &#stage { model: self, h: &h, at, edges, first })
            }
        }
        None if m.is_quaternion() => quote! {
            line::try_fill(self.threads, #part, |i| self.#kernel(h, first + i, at, &edges.at(first + i)))
        },
        None => {
            let factor = format_ident!("factor_{}", m.mover.name);
            quote! {
                line::try_fill_in_lanes(
                    self.threads,
                    #part,
                    |i| self.#kernel(h, first + i, at, &edges.at(first + i)),
                    &line::Turning { at: &at.#name, edges, bodies: &self.#factor, h, first },
                )
            }
        }
    }
}

/// The kernel of the stacked velocities of a block.
fn system(l: &Lines, n: usize, members: &[Moving]) -> TokenStream {
    let Some(first) = members.first() else {
        return TokenStream::new();
    };
    let d = first.outline();
    let s = &d.letters.symbols;
    let (kernel, places, edges) = (kernel(first), l.item("Places"), l.item("Edges"));
    let h = step(d);
    let mut values: Vec<Expr> = Vec::new();
    for m in members {
        if let SiteSolve::System { columns, rest, .. } = &m.mover.how {
            values.extend(columns.iter().chain([rest]).map(|e| d.defined(e)));
        }
    }
    let (lets, results) = l.computed(s, &l.of_site(d, &values), &values);
    let size = number(n);
    let mut fill = TokenStream::new();
    let mut row = 0;
    let mut results = results.into_iter();
    for m in members {
        let count = m.components();
        let (rows, name) = (number(count), m.name());
        let at_row = number(row);
        for column in 0..n {
            let (column, value) = (number(column), results.next().unwrap_or_default());
            let value = m.array(value);
            fill.extend(
                quote!(a.fixed_view_mut::<#rows, 1>(#at_row, #column).copy_from(&(#value));),
            );
        }
        let rest = m.array(results.next().unwrap_or_default());
        fill.extend(quote! {
            known.fixed_view_mut::<#rows, 1>(#at_row, 0).copy_from(&(edges.#name[site] - (#rest)));
        });
        row += count;
    }
    let names: Vec<String> = members.iter().map(|m| m.mover.name.clone()).collect();
    let what = format!(
        "the derivative of the momenta of {} with respect to their velocities",
        names.join(", ")
    );
    let doc = format!(
        " The velocities of {} on the outgoing edge of a site.",
        names.join(", ")
    );
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, edges: &#edges<T>) -> Result<SVector<T, #size>, StepCause> {
            #lets
            let mut a = SMatrix::<T, #size, #size>::zeros();
            let mut known = SVector::<T, #size>::zeros();
            #fill
            left_sided(&a, &known, #what).map(|x| x.matrix()).map_err(StepCause::Singular)
        }
    }
}

/// The kernels of a block whose momenta are not linear in the velocities: the stacked velocities, and the momenta
/// with their derivative.
fn newton(l: &Lines, n: usize, members: &[Moving]) -> TokenStream {
    let Some(first) = members.first() else {
        return TokenStream::new();
    };
    let d = first.outline();
    let s = &d.letters.symbols;
    let (kernel, places, edges) = (kernel(first), l.item("Places"), l.item("Edges"));
    let momenta = format_ident!("edge_momenta_{}", first.mover.name);
    let h = step(d);
    let mut values: Vec<Expr> = Vec::new();
    for m in members {
        if let SiteSolve::Newton {
            columns, momentum, ..
        } = &m.mover.how
        {
            let own = columns.iter().chain([momentum]);
            values.extend(own.map(|e| expr::factored(s, &schedule::displaced(s, &d.defined(e)))));
        }
    }
    let letters = l.of_site(d, &values);
    let (locals, mut bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let tied = super::coupled_velocities::is_tied(l, members);
    let velocities = taken_apart(members, &letters, &mut bindings, tied);
    let (lets, results) = l.program(s, &values, &bindings);
    let (size, unknowns) = (number(n), super::coupled_velocities::unknowns(members));
    let (mut fill, mut given) = (TokenStream::new(), TokenStream::new());
    let mut row = 0;
    let mut results = values.iter().zip(results);
    for m in members {
        let count = m.components();
        let (rows, at_row, name) = (number(count), number(row), m.name());
        let mut column = 0;
        for by in members {
            let end = column + by.components();
            while column < end {
                let Some((e, value)) = results.next() else {
                    return TokenStream::new();
                };
                let (at_column, wide) = (number(column), number(width(e)));
                let value = as_array(e, value);
                fill.extend(
                    quote!(a.fixed_view_mut::<#rows, #wide>(#at_row, #at_column).copy_from(&(#value));),
                );
                column += width(e);
            }
        }
        let momentum = results.next().map(|(_, value)| m.array(value));
        fill.extend(quote!(made.fixed_view_mut::<#rows, 1>(#at_row, 0).copy_from(&(#momentum));));
        let edge = match m.is_rotation() {
            true => quote!(at.#name.at(site).matrix().tr_mul(&edges.#name.at(site))),
            false => quote!(edges.#name[site]),
        };
        given.extend(quote!(known.fixed_view_mut::<#rows, 1>(#at_row, 0).copy_from(&#edge);));
        row += count;
    }
    let names: Vec<String> = members.iter().map(|m| m.mover.name.clone()).collect();
    let names = names.join(", ");
    let doc = format!(" The velocities of {names} on the outgoing edge of a site.");
    let of_momenta = format!(
        " The momenta of {names} at the start of an edge with these velocities, and their derivative with respect to the velocities."
    );
    let solved = match tied {
        true => {
            let given_of = format_ident!("given_{}", first.mover.name);
            let doc = format!(" The momenta of {names} on the outgoing edge of a site.");
            quote! {
                #[doc = #doc]
                #[inline(always)]
                fn #given_of(&self, site: usize, at: &#places<T>, edges: &#edges<T>) -> SVector<T, #size> {
                    let _ = at;
                    let mut known = SVector::<T, #size>::zeros();
                    #given
                    known
                }
            }
        }
        false => quote! {
            #[doc = #doc]
            #[inline(always)]
            fn #kernel(&self, #h: T, site: usize, at: &#places<T>, edges: &#edges<T>) -> Result<SVector<T, #size>, StepCause> {
                let mut known = SVector::<T, #size>::zeros();
                #given
                line::root(
                    &known,
                    #unknowns,
                    |velocity| self.#momenta(#h, site, at, velocity).0,
                    |velocity| self.#momenta(#h, site, at, velocity),
                ).map_err(StepCause::NoRoot)
            }
        },
    };
    let velocity = match tied {
        true => super::coupled_velocities::velocity(n, members),
        false => quote!(SVector<T, #size>),
    };
    quote! {
        #solved

        #[doc = #of_momenta]
        #[inline(always)]
        fn #momenta(&self, #h: T, site: usize, at: &#places<T>, velocity: &#velocity) -> (SVector<T, #size>, SMatrix<T, #size, #size>) {
            let _ = (#h, site, at);
            #locals
            #velocities
            #lets
            let mut a = SMatrix::<T, #size, #size>::zeros();
            let mut made = SVector::<T, #size>::zeros();
            #fill
            (made, a)
        }
    }
}
