//! Velocities that neighbour terms couple, so that all sites are solved together: kernels of one such term, the
//! equations of all sites, and the force of the edge.

use super::locals::{Places, step};
use super::neighbour_forces::{range_of, stated_letters};
use super::step::range_name;
use super::velocities::{as_array, width};
use super::{Lines, Moving, number};
use crate::emit::expression::Bindings;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr};
use crate::line::{SiteSolve, VelocityCoupling};
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// Whether the momenta of a block depend on velocities of neighbours.
pub(super) fn is_tied(l: &Lines, members: &[Moving]) -> bool {
    members.iter().any(|m| l.line.is_tied(&m.mover.name))
}

/// The block with coupled velocities, if any: the field of its velocities, its number of components, and its members.
pub(super) fn block<'a>(l: &'a Lines) -> Option<(Ident, usize, Vec<Moving<'a>>)> {
    let mut systems = l.systems().into_iter();
    systems.find(|(.., members)| is_tied(l, members))
}

/// Whether a coupling term depends on positions too, so that it exerts a force on the edge.
fn adds(l: &Lines) -> bool {
    let mut parts = l.line.ties.iter().flat_map(|t| &t.parts);
    parts.any(|p| !p.added.is_zero())
}

/// Its fields in the workspace.
pub(super) fn band_field(l: &Lines) -> Option<TokenStream> {
    let (_, n, members) = block(l)?;
    let n = number(n);
    let tied = adds(l).then(|| quote!(tied: Vec<SVector<T, #n>>,));
    let rotations = rotations(&members);
    Some(quote!(band: line::Band<T, #n, #rotations>, #tied))
}

/// The initial values of those fields.
pub(super) fn band_value(l: &Lines) -> Option<TokenStream> {
    let (_, n, members) = block(l)?;
    let n = number(n);
    let first = members.first()?;
    let (count, ring) = (l.count_of(&first.mover.name), ring(l));
    let tied = adds(l).then(|| quote!(tied: ::std::vec![SVector::<T, #n>::zeros(); #count],));
    let constant = is_constant(l, &members);
    let unknowns = (!constant).then(|| {
        let unknowns = unknowns(&members);
        quote!(.with_unknowns(#unknowns))
    });
    let rotations = rotations(&members);
    Some(
        quote!(band: line::Band::<T, #n, #rotations>::new(#count, #ring, #constant)#unknowns, #tied),
    )
}

/// The number of slots for rotations in a velocity. The slot of a rotation is a third of the first row of its vector.
fn rotations(members: &[Moving]) -> Literal {
    let rows = members.iter().filter(|m| m.is_rotation()).map(|m| {
        let (row, _) = rows_of(members, &m.mover.name);
        row / 3 + 1
    });
    number(rows.max().unwrap_or(0))
}

/// The type of the velocities of a site.
pub(super) fn velocity(n: usize, members: &[Moving]) -> TokenStream {
    let (n, rotations) = (number(n), rotations(members));
    quote!(line::Velocity<T, #n, #rotations>)
}

/// The parts of a site's velocity: each field and each rotation.
pub(super) fn unknowns(members: &[Moving]) -> TokenStream {
    let each = members.iter().map(|m| match m.is_rotation() {
        true => quote!(line::rotation()),
        false => {
            let count = number(m.components());
            quote!(line::field(#count))
        }
    });
    quote!([#(#each),*])
}

/// Whether the derivatives of the momenta depend on parameters and the step size only. They are then factored once.
fn is_constant(l: &Lines, members: &[Moving]) -> bool {
    if members.iter().any(Moving::is_rotation) {
        return false;
    }
    let part = &l.line.representative;
    let fixed = |s: &Symbols, e: &Expr| {
        let role = |letter: &expr::Letter| s.get(letter.symbol).role;
        let mut letters = expr::letters(e).into_iter();
        letters.all(|x| matches!(role(&x), Role::Parameter | Role::Step))
    };
    let own = members.iter().all(|m| match &m.mover.how {
        SiteSolve::Newton { columns, .. } => {
            let d = m.outline();
            columns
                .iter()
                .all(|e| fixed(&d.letters.symbols, &d.defined(e)))
        }
        _ => false,
    });
    let s = &part.d.letters.symbols;
    let of_tie = |tie: &VelocityCoupling| {
        let mut pairs = tie
            .parts
            .iter()
            .flat_map(|a| tie.parts.iter().map(move |b| (a, b)));
        pairs.all(|(a, b)| tie.columns(part, a, b).iter().all(|e| fixed(s, e)))
    };
    own && l.line.ties.iter().all(of_tie)
}

pub(super) fn ring(l: &Lines) -> TokenStream {
    match l.line.lattice.periodic.is_some() {
        true => quote!(self.is_ring()),
        false => quote!(false),
    }
}

/// The sites that a term touches, with the ring closed.
pub(super) fn touched(l: &Lines, tie: &VelocityCoupling, count: &TokenStream) -> TokenStream {
    match (tie.width, l.line.lattice.periodic.is_some()) {
        (0, _) => quote!([site]),
        (_, false) => quote!([site, site + 1]),
        (_, true) => quote!([site, if site + 1 < #count { site + 1 } else { 0 }]),
    }
}

/// The code that solves for the velocities of all sites.
pub(super) fn solve(l: &Lines, field: &Ident, members: &[Moving]) -> TokenStream {
    let Some(first) = members.first() else {
        return TokenStream::new();
    };
    let (range, text) = (range_name(first), &first.mover.name);
    let [own, given] = ["edge_momenta", "given"].map(|x| format_ident!("{x}_{text}"));
    let count = l.count_of(text);
    let each = l.line.ties.iter().enumerate().map(|(n, tie)| {
        let (kernel, range) = (
            format_ident!("tied_{}", n + 1),
            range_of(l, tie.label, tie.from, tie.to),
        );
        let touched = touched(l, tie, &count);
        quote! {
            {
                #range
                rows.tie(
                    [first, last],
                    |site| #touched,
                    |site, velocities| self.#kernel(h, site, at, velocities).0,
                    |site, velocities| self.#kernel(h, site, at, velocities),
                );
            }
        }
    });
    let added =
        adds(l).then(|| {
            let each = l.line.ties.iter().enumerate().map(|(n, tie)| {
            let (kernel, range) =
                (format_ident!("tied_added_{}", n + 1), range_of(l, tie.label, tie.from, tie.to));
            let touched = touched(l, tie, &count);
            quote! {
                #range
                line::spread([first, last], |site| #touched, &work.#field, &mut work.tied, |site, velocities| {
                    self.#kernel(h, site, &state.places, velocities)
                });
            }
        });
            quote! {
                work.tied.fill(SVector::zeros());
                #({ #each })*
            }
        });
    quote! {
        {
            let (at, edges) = (&state.places, &work.edges);
            let made = work.band.solve_along(
                self.#range(),
                |site| self.#given(site, at, edges),
                |site, velocity| self.#own(h, site, at, velocity).0,
                |site, velocity| self.#own(h, site, at, velocity),
                |rows| { #(#each)* },
                &mut work.#field,
            );
            if let Err((site, cause)) = made {
                let at = line::Place { quantity: #text, site };
                return Err(self.refused(state, h, at, StepCause::NoRoot(cause)));
            }
            #added
        }
    }
}

/// The force of those terms on a configuration along the edge.
pub(super) fn added(l: &Lines, m: &Moving) -> Option<TokenStream> {
    if !adds(l) || !l.line.is_tied(&m.mover.name) {
        return None;
    }
    let (_, _, members) = block(l)?;
    let before = members.iter().take_while(|o| o.mover.name != m.mover.name);
    let row = number(before.map(Moving::components).sum());
    let rows = number(m.components());
    let name = m.name();
    Some(match m.is_rotation() {
        true => {
            quote!(+ state.places.#name.at(site).matrix() * work.tied[site].fixed_rows::<3>(#row))
        }
        false => quote!(+ work.tied[site].fixed_rows::<#rows>(#row)),
    })
}

/// The kernels.
pub(super) fn tied(l: &Lines) -> TokenStream {
    let Some((_, n, members)) = block(l) else {
        return TokenStream::new();
    };
    let name = l.item("");
    let each = l.line.ties.iter().enumerate();
    let each = each.map(|(k, tie)| of_tie(l, k + 1, tie, n, &members));
    quote!(impl<T: Real> #name<T> { #(#each)* })
}

/// The nonzero derivatives of a neighbour term: those of the momenta of one of its sites with respect to the
/// velocities of another.
pub(super) struct Derivatives {
    n: usize,
    /// For each block, its two sites relative to the index of the term, and its columns.
    blocks: Vec<([usize; 2], Vec<Columns>)>,
}

/// Columns of a block.
struct Columns {
    row: usize,
    rows: usize,
    column: usize,
    wide: usize,
    value: TokenStream,
}

impl Derivatives {
    /// No derivatives yet; velocities have `n` components.
    pub(super) fn new(n: usize) -> Self {
        let blocks = Vec::new();
        Self { n, blocks }
    }

    /// Adds columns to the block of two sites: their first row, their number of rows, and the first column.
    pub(super) fn store_column(
        &mut self,
        pair: [usize; 2],
        [row, rows, column]: [usize; 3],
        e: &Expr,
        value: TokenStream,
    ) {
        if e.is_zero() {
            return;
        }
        let columns = Columns {
            row,
            rows,
            column,
            wide: width(e),
            value: as_array(e, value),
        };
        match self.blocks.iter_mut().find(|(known, _)| *known == pair) {
            Some((_, list)) => list.push(columns),
            None => self.blocks.push((pair, vec![columns])),
        }
    }

    /// The statements that compute the blocks, and the list of the blocks.
    pub(super) fn emitted(&self) -> (TokenStream, TokenStream) {
        let size = number(self.n);
        let (mut lets, mut list) = (TokenStream::new(), TokenStream::new());
        for ([of, by], all) in &self.blocks {
            let name = format_ident!("derivative_{of}_{by}");
            let ([of, by], whole) = ([*of, *by].map(number), [self.n, self.n]);
            list.extend(quote!((#of, #by, #name),));
            match all.as_slice() {
                [one] if [one.rows, one.wide] == whole => {
                    let value = &one.value;
                    lets.extend(quote!(let #name = #value;));
                }
                parts => {
                    lets.extend(quote!(let mut #name = SMatrix::<T, #size, #size>::zeros();));
                    for part in parts {
                        let place = [part.row, part.rows, part.column, part.wide];
                        let [row, rows, column, wide] = place.map(number);
                        let value = &part.value;
                        lets.extend(quote!(#name.fixed_view_mut::<#rows, #wide>(#row, #column).copy_from(&(#value));));
                    }
                }
            }
        }
        (lets, quote!([#list]))
    }

    /// The number of blocks.
    pub(super) fn count(&self) -> Literal {
        number(self.blocks.len())
    }
}

/// The first row of a configuration in its block, and its number of rows.
pub(super) fn rows_of(members: &[Moving], on: &str) -> (usize, usize) {
    let before = members.iter().take_while(|o| o.mover.name != on);
    let own = members.iter().find(|o| o.mover.name == on);
    (
        before.map(Moving::components).sum(),
        own.map_or(0, Moving::components),
    )
}

fn of_tie(
    l: &Lines,
    k: usize,
    tie: &VelocityCoupling,
    n: usize,
    members: &[Moving],
) -> TokenStream {
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let (places, h) = (l.item("Places"), step(&part.d));
    let formed = |e: &Expr| expr::factored(s, &schedule::displaced(s, e));
    let mut values: Vec<Expr> = Vec::new();
    for of in &tie.parts {
        values.push(formed(&of.momentum));
        for by in &tie.parts {
            values.extend(tie.columns(part, of, by).iter().map(formed));
        }
    }
    let (lets, results) = computed(l, tie, members, &values, true);
    let mut results = values.iter().zip(results);
    let velocity = velocity(n, members);
    let (size, wide) = (number(n), number(tie.width + 1));
    let mut fill = TokenStream::new();
    let mut derivatives = Derivatives::new(n);
    for of in &tie.parts {
        let (row, rows) = rows_of(members, &of.on);
        let (at_row, count, site) = (number(row), number(rows), number(of.site));
        let value = results.next().map(|(e, value)| as_array(e, value));
        fill.extend(
            quote!(made[#site].fixed_view_mut::<#count, 1>(#at_row, 0).copy_from(&(#value));),
        );
        for by in &tie.parts {
            let (column, columns) = rows_of(members, &by.on);
            let mut j = column;
            while j < column + columns {
                let Some((e, value)) = results.next() else {
                    break;
                };
                derivatives.store_column([of.site, by.site], [row, rows, j], e, value);
                j += width(e);
            }
        }
    }
    let ((made, blocks), count) = (derivatives.emitted(), derivatives.count());
    let kernel = format_ident!("tied_{k}");
    let doc = " The contribution of a coupling term to the momenta of its sites at the start of an edge, and the \
               derivatives with respect to their velocities.";
    let added = adds(l).then(|| added_kernel(l, k, tie, n, members));
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, velocities: [&#velocity; #wide]) -> ([SVector<T, #size>; #wide], [(usize, usize, SMatrix<T, #size, #size>); #count]) {
            let _ = (#h, site, at, &velocities);
            #lets
            let mut made = [SVector::<T, #size>::zeros(); #wide];
            #fill
            #made
            (made, #blocks)
        }
        #added
    }
}

/// Values that depend on positions and velocities of the sites of a term. If `known_turns` is set, the rotations are
/// available.
fn computed(
    l: &Lines,
    tie: &VelocityCoupling,
    members: &[Moving],
    values: &[Expr],
    known_turns: bool,
) -> (TokenStream, Vec<TokenStream>) {
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let letters = stated_letters(l, values);
    let (locals, mut bindings): (TokenStream, Bindings) =
        l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let mut used: Vec<String> = Vec::new();
    let mut lets = locals;
    for own in &tie.parts {
        if !letters.iter().any(|k| k.letter == own.velocity) {
            continue;
        }
        let base = format!("change_{}_{}", own.on, own.site);
        let local = l.unique(&base, &base, &mut used);
        let (row, _) = rows_of(members, &own.on);
        let site = number(own.site);
        let of = members.iter().find(|m| m.mover.name == own.on);
        let value = of.map(|m| m.velocity(&quote!(velocities[#site]), row, known_turns));
        lets.extend(quote!(let #local = #value;));
        bindings.bind(own.velocity, local);
    }
    let (more, results) = l.program(s, values, &bindings);
    lets.extend(more);
    (lets, results)
}

fn added_kernel(
    l: &Lines,
    k: usize,
    tie: &VelocityCoupling,
    n: usize,
    members: &[Moving],
) -> TokenStream {
    let part = &l.line.representative;
    let (places, h) = (l.item("Places"), step(&part.d));
    let values: Vec<Expr> = tie.parts.iter().map(|p| p.added.clone()).collect();
    let (lets, results) = computed(l, tie, members, &values, false);
    let (size, wide) = (number(n), number(tie.width + 1));
    let fill = tie.parts.iter().zip(results).map(|(own, value)| {
        let (row, rows) = rows_of(members, &own.on);
        let (row, rows, site) = (number(row), number(rows), number(own.site));
        let of = members.iter().find(|m| m.mover.name == own.on);
        let value = of.map_or(value.clone(), |m| m.array(value));
        quote!(made[#site].fixed_view_mut::<#rows, 1>(#row, 0).copy_from(&(#value));)
    });
    let kernel = format_ident!("tied_added_{k}");
    quote! {
        /// The contribution of the edge to the momenta of the sites of a coupling term.
        #[inline(always)]
        fn #kernel(&self, #h: T, site: usize, at: &#places<T>, velocities: [SVector<T, #size>; #wide]) -> [SVector<T, #size>; #wide] {
            let _ = (#h, site, at, &velocities);
            #lets
            let mut made = [SVector::<T, #size>::zeros(); #wide];
            #(#fill)*
            made
        }
    }
}
