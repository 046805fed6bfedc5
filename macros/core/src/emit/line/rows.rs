//! Kernels of the linear system for the impulses of all sites: the residuals at a site, their derivatives with
//! respect to the impulses of the previous site, the site and the next one, and their rates of change.

use super::constraint_kernels::{Bodies, DerivativeStorage, field, kept};
use super::{Lines, number};
use crate::line::Reach;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// A factor of a product: a multiple of the identity, or a matrix.
#[derive(Clone)]
enum Factor {
    Multiple(TokenStream),
    Matrix(TokenStream),
}

impl Factor {
    fn times(&self, other: &Factor) -> Factor {
        match (self, other) {
            (Factor::Multiple(a), Factor::Multiple(b)) => Factor::Multiple(quote!(#a * #b)),
            (Factor::Multiple(a), Factor::Matrix(b)) | (Factor::Matrix(b), Factor::Multiple(a)) => {
                Factor::Matrix(quote!(#b * #a))
            }
            (Factor::Matrix(a), Factor::Matrix(b)) => Factor::Matrix(quote!(#a * #b)),
        }
    }
}

fn factor(l: &Lines, r: &Reach, list: &str, k: usize, at: &TokenStream) -> Factor {
    let (list, held, own) = (format_ident!("{list}"), format_ident!("held_{k}"), field(r));
    match kept(l, r) {
        DerivativeStorage::Fixed(c) => Factor::Multiple(quote!((#c))),
        DerivativeStorage::Number => Factor::Multiple(quote!(#list.#held[#at].#own)),
        DerivativeStorage::Matrix => Factor::Matrix(quote!(#list.#held[#at].#own)),
    }
}

/// The kernels of the system: the residuals and the sizes of their terms, their derivatives with respect to the
/// impulses of the previous site, the site and the next one, and their rates of change.
pub(super) fn rows(l: &Lines, bodies: &[Bodies]) -> TokenStream {
    let [reached, responses, velocities] =
        ["Reached", "Responses", "Velocities"].map(|x| l.item(x));
    let total = l.held_components();
    let (size, wide) = (number(total), number(3 * total));
    let (mut values, mut lets, mut fill, mut rates) = Default::default();
    let of = |on: &str| {
        bodies
            .iter()
            .find(|b| b.members.iter().any(|m| m.mover.name == on))
    };
    let mut lefts = 0;
    for (k, a) in l.holds() {
        let (list, row, r) = (
            format_ident!("held_{k}"),
            number(l.held_row(a)),
            number(a.components),
        );
        let own: &mut TokenStream = &mut values;
        own.extend(quote! {
            held.fixed_view_mut::<#r, 1>(#row, 0).copy_from(&(reached.#list[site + 1].value));
            held.fixed_view_mut::<#r, 1>(#row, 1).copy_from(&(SMatrix::<T, #r, 1>::repeat(reached.#list[site + 1].size)));
        });
        let mut sums: Vec<(usize, isize, Vec<Factor>)> = Vec::new();
        let mut parts = Vec::new();
        for reach in &a.reaches {
            let Some(b) = of(&reach.on) else { continue };
            let (body, by) = (b.field(), number(reach.site));
            let [at_row, rows] = b.rows(&reach.on).unwrap_or([0, 0]);
            let (at_row, rows) = (number(at_row), number(rows));
            let left = factor(l, reach, "there", k, &quote!(site + 1));
            let velocity =
                quote!(velocities.#body[site + #by].fixed_rows::<#rows>(#at_row).into_owned());
            parts.push(match factor(l, reach, "reached", k, &quote!(site + 1)) {
                Factor::Multiple(c) => quote!(#velocity * #c),
                Factor::Matrix(g) => quote!(#g.tr_mul(&#velocity)),
            });
            let made = format_ident!("left_{lefts}");
            lefts += 1;
            let response = quote!(responses.#body[site + #by]);
            let n = number(b.n);
            let value = match (&left, b.scalar) {
                (Factor::Multiple(g), true) => quote!(#response * #g),
                (Factor::Matrix(g), true) => quote!(#g.transpose() * #response),
                (Factor::Multiple(g), false) => {
                    quote!((#response.fixed_view::<#rows, #n>(#at_row, 0).into_owned()) * #g)
                }
                (Factor::Matrix(g), false) => {
                    quote!(#g.tr_mul(&(#response.fixed_view::<#rows, #n>(#at_row, 0).into_owned())))
                }
            };
            // For a body with one member: its whole response.
            let value = match (b.scalar, b.members.len()) {
                (false, 1) => match &left {
                    Factor::Multiple(g) => quote!(#response * #g),
                    Factor::Matrix(g) => quote!(#g.tr_mul(&#response)),
                },
                _ => value,
            };
            let lets: &mut TokenStream = &mut lets;
            lets.extend(quote!(let #made = #value;));
            for m in &b.members {
                let [column, columns] = b.rows(&m.mover.name).unwrap_or([0, 0]);
                let (column, columns) = (number(column), number(columns));
                let own = match (&left, b.scalar, b.members.len()) {
                    (Factor::Multiple(_), true, _) => Factor::Multiple(quote!(#made)),
                    (_, _, 1) => Factor::Matrix(quote!(#made)),
                    _ => Factor::Matrix(
                        quote!((#made.fixed_view::<#r, #columns>(0, #column).into_owned())),
                    ),
                };
                for (other, c) in l.holds() {
                    for right in c.reaches.iter().filter(|x| x.on == m.mover.name) {
                        let by = 1 + reach.site - right.site;
                        let by_tokens = number(by);
                        let right = factor(l, right, "here", other, &quote!(site + #by_tokens));
                        let product = own.times(&right);
                        let offset = by as isize - 1;
                        match sums
                            .iter_mut()
                            .find(|(o, by, _)| (*o, *by) == (other, offset))
                        {
                            Some((.., list)) => list.push(product),
                            None => sums.push((other, offset, vec![product])),
                        }
                    }
                }
            }
        }
        for (other, offset, list) in sums {
            let Some((_, c)) = l.holds().find(|(k, _)| *k == other) else {
                continue;
            };
            let block = usize::try_from(offset + 1).unwrap_or(0);
            let column = number(total * block + l.held_row(c));
            let columns = number(c.components);
            let (mut multiples, mut matrices) = (Vec::new(), Vec::new());
            for product in list {
                match product {
                    Factor::Multiple(x) => multiples.push(x),
                    Factor::Matrix(x) => matrices.push(x),
                }
            }
            if !multiples.is_empty() {
                matrices.push(
                    quote!(SMatrix::<T, #r, #columns>::from_diagonal_element(#(#multiples)+*)),
                );
            }
            let fill: &mut TokenStream = &mut fill;
            fill.extend(quote!(row.fixed_view_mut::<#r, #columns>(#row, #column).copy_from(&(#(#matrices)+*));));
        }
        let rates: &mut TokenStream = &mut rates;
        rates.extend(quote!(rate.fixed_view_mut::<#r, 1>(#row, 0).copy_from(&(#(#parts)+*));));
    }
    quote! {
        /// The residuals of the constraints at a site, and the sizes of their terms.
        #[inline(always)]
        fn held_at(&self, site: usize, reached: &#reached<T>) -> SMatrix<T, #size, 2> {
            let mut held = SMatrix::<T, #size, 2>::zeros();
            #values
            held
        }

        /// The derivatives of the constraints at the positions `there` with respect to impulses at the positions `here`.
        #[inline(always)]
        fn held_row(&self, site: usize, there: &#reached<T>, here: &#reached<T>, responses: &#responses<T>) -> SMatrix<T, #size, #wide> {
            let _ = (there, here);
            #lets
            let mut row = SMatrix::<T, #size, #wide>::zeros();
            #fill
            row
        }

        /// The rates of change of the constraints.
        #[inline(always)]
        fn held_rate(&self, site: usize, reached: &#reached<T>, velocities: &#velocities<T>) -> SVector<T, #size> {
            let _ = reached;
            let mut rate = SVector::<T, #size>::zeros();
            #rates
            rate
        }
    }
}
