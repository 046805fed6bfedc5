//! The kinetic energy of velocities that are coupled along the chain. Kernels give the momenta of a site and of a
//! neighbour term, which are linear in the velocities; the runtime inverts this relation for all sites.

use super::coupled_velocities::{Derivatives, rows_of};
use super::locals::{Places, StatedLetter};
use super::neighbour_forces::{range_of, stated_letters};
use super::step::range_name;
use super::velocities::as_array;
use super::{Lines, number};
use crate::emit::element;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};
use crate::line::{Inertia, inertia_of_site};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The kernels, and the energy. None if there is no limit of small steps.
pub(super) fn kinetic(l: &Lines) -> Option<(TokenStream, TokenStream)> {
    let (_, n, members) = super::coupled_velocities::block(l)?;
    let first = members.first()?;
    let (places, size) = (l.item("Places"), number(n));
    let indices: Vec<usize> = members.iter().map(|m| m.mover.index).collect();
    let own = inertia_of_site(first.lone, &indices)?;
    let d = first.outline();
    let sites: Vec<[usize; 3]> = members
        .iter()
        .map(|m| {
            let (row, rows) = rows_of(&members, &m.mover.name);
            [0, row, rows]
        })
        .collect();
    let own = Inertia {
        at_rest: own.at_rest.iter().map(|e| d.defined(e)).collect(),
        columns: own
            .columns
            .iter()
            .map(|list| list.iter().map(|e| d.defined(e)).collect())
            .collect(),
    };
    let body = filled(
        l,
        &d.letters.symbols,
        &own,
        &sites,
        &|values| l.of_site(d, values),
        &mut |_, [row, rows, column], e, value| {
            let (value, [row, rows, column]) =
                (as_array(e, value), [row, rows, column].map(number));
            quote!(a.fixed_view_mut::<#rows, 1>(#row, #column).copy_from(&(#value));)
        },
    );
    let mut kernels = quote! {
        /// The momenta of one site at zero velocity, and their derivatives with respect to the velocities, in the limit of small steps.
        fn inertia(&self, site: usize, at: &#places<T>) -> (SVector<T, #size>, SMatrix<T, #size, #size>) {
            let _ = (site, at);
            let mut made = [SVector::<T, #size>::zeros(); 1];
            let mut a = SMatrix::<T, #size, #size>::zeros();
            #body
            (made[0], a)
        }
    };
    let s = &l.line.representative.d.letters.symbols;
    let count = l.count_of(&first.mover.name);
    let mut each = Vec::new();
    for (k, tie) in l.line.ties.iter().enumerate() {
        let of_tie = tie.inertia.as_ref()?;
        let sites: Vec<[usize; 3]> = tie
            .parts
            .iter()
            .map(|p| {
                let (row, rows) = rows_of(&members, &p.on);
                [p.site, row, rows]
            })
            .collect();
        let mut derivatives = Derivatives::new(n);
        let body = filled(
            l,
            s,
            of_tie,
            &sites,
            &|values| stated_letters(l, values),
            &mut |pair, place, e, value| {
                derivatives.store_column(pair, place, e, value);
                TokenStream::new()
            },
        );
        let ((fill, blocks), count_of_blocks) = (derivatives.emitted(), derivatives.count());
        let (kernel, wide) = (format_ident!("inertia_{}", k + 1), number(tie.width + 1));
        kernels.extend(quote! {
            /// The contribution of a coupling term to these momenta and derivatives.
            fn #kernel(&self, site: usize, at: &#places<T>) -> ([SVector<T, #size>; #wide], [(usize, usize, SMatrix<T, #size, #size>); #count_of_blocks]) {
                let _ = (site, at);
                let mut made = [SVector::<T, #size>::zeros(); #wide];
                #body
                #fill
                (made, #blocks)
            }
        });
        let range = range_of(l, tie.label, tie.from, tie.to);
        let touched = super::coupled_velocities::touched(l, tie, &count);
        each.push(quote! {{
            #range
            rows.tie(
                [first, last],
                |site| #touched,
                |site, _| self.#kernel(site, at).0,
                |site, _| self.#kernel(site, at),
            );
        }});
    }
    let given = members.iter().map(|m| {
        let (row, rows) = rows_of(&members, &m.mover.name);
        let (row, rows) = (number(row), number(rows));
        let c = &m.d().spec.configurations[m.mover.index];
        let value = element::value(c, super::energy::momentum(m, &quote!(site)));
        let value = m.array(value);
        quote!(known.fixed_view_mut::<#rows, 1>(#row, 0).copy_from(&(#value));)
    });
    let (range, ring) = (range_name(first), super::coupled_velocities::ring(l));
    let energy = quote! {{
        let [first, last] = self.#range();
        line::Band::<T, #size, 0>::kinetic(
            [#count, first, last],
            #ring,
            |site| {
                let mut known = SVector::<T, #size>::zeros();
                #(#given)*
                known
            },
            |site| self.inertia(site, at),
            |rows| { #(#each)* },
        )
    }};
    Some((kernels, energy))
}

/// Stores a column of derivatives. The arguments are the two sites of its block; its first row, number of rows and
/// column index; the expression; and its value.
type StoreColumn<'a> = dyn FnMut([usize; 2], [usize; 3], &Expr, TokenStream) -> TokenStream + 'a;

/// Fills `made` and stores the derivatives. `sites` gives, for each configuration, its site in the kernel, its first
/// row and its number of rows.
fn filled(
    l: &Lines,
    s: &Symbols,
    inertia: &Inertia,
    sites: &[[usize; 3]],
    known: &dyn Fn(&[Expr]) -> Vec<StatedLetter>,
    put: &mut StoreColumn,
) -> TokenStream {
    let mut values = Vec::new();
    for (rest, columns) in inertia.at_rest.iter().zip(&inertia.columns) {
        values.push(expr::quaternion_components(s, rest));
        values.extend(columns.iter().map(|e| expr::quaternion_components(s, e)));
    }
    let (locals, bindings) = l.locals(s, &known(&values), &Places::of_node(), &quote!(site));
    let (lets, results) = l.program(s, &values, &bindings);
    let mut out = quote!(#locals #lets);
    let mut results = values.iter().zip(results);
    for [site, row, rows] in sites {
        let (at, from, count) = (number(*site), number(*row), number(*rows));
        let value = results.next().map(|(e, value)| as_array(e, value));
        out.extend(quote!(made[#at].fixed_view_mut::<#count, 1>(#from, 0).copy_from(&(#value));));
        for [by, first, columns] in sites {
            for j in *first..first + columns {
                if let Some((e, value)) = results.next() {
                    out.extend(put([*site, *by], [*row, *rows, j], e, value));
                }
            }
        }
    }
    out
}
