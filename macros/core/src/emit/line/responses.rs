//! Kernels for the response of configurations to the impulses of constraints. The response in a step is at the end of
//! an edge, to an impulse at its start. The response at a node is that of the limit of small steps.

use super::constraint_kernels::{Bodies, filled};
use super::locals::Places;
use super::{Lines, number};
use crate::expr::Expr;
use crate::expr::symbol::Symbols;
use crate::line::Matrix;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The kernels of a body: its response in a step, its response at a node, and its velocity at a node.
pub(super) fn kernels(l: &Lines, b: &Bodies) -> TokenStream {
    let Some(first) = b.first() else {
        return TokenStream::new();
    };
    let (places, momenta) = (l.item("Places"), l.item("Momenta"));
    let field = b.field();
    let [response, weight, velocity] =
        ["response", "weight", "node_velocity"].map(|x| format_ident!("{x}_{field}"));
    let (ty, n) = (b.response(), number(b.n));
    let d = first.outline();
    let h = super::locals::step(d);
    let of_edge = match &b.unit.of_edge {
        None => {
            let factor = format_ident!("factor_{}", first.mover.name);
            quote! {
                /// The derivative of the attitude at the end of an edge with respect to an impulse at its start.
                #[inline(always)]
                fn #response(&self, #h: T, site: usize, from: &#places<T>, to: &#places<T>) -> #ty {
                    let factor = &self.#factor[site.min(self.#factor.len() - 1)];
                    line::turned_by(factor, #h, &from.#field.at(site), &to.#field.at(site))
                }
            }
        }
        Some(list) => {
            let (more, argument) = match b.takes_velocities() {
                true => (true, Some(quote!(velocity: &SVector<T, #n>))),
                false => (false, None),
            };
            let body = inverse(l, b, list, more);
            quote! {
                /// The derivative of the velocities with respect to an impulse at the start of an edge.
                #[inline(always)]
                fn #response(&self, #h: T, site: usize, at: &#places<T>, #argument) -> #ty {
                    let _ = (#h, site, at);
                    #body
                }
            }
        }
    };
    let of_node = inverse(l, b, &b.unit.of_node, false);
    let at_rest = at_rest(l, b);
    let stacked = b.members.iter().map(|m| {
        let [row, rows] = b.rows(&m.mover.name).unwrap_or([0, 0]);
        let (row, rows) = (number(row), number(rows));
        let own = super::energy::momentum(m, &quote!(site));
        quote!(momentum.fixed_view_mut::<#rows, 1>(#row, 0).copy_from(&(#own));)
    });
    let apply = match b.scalar {
        true => quote!(momentum * weights[site]),
        false => quote!(weights[site] * momentum),
    };
    quote! {
        #of_edge

        /// The derivative of the velocities with respect to an impulse at a node, in the limit of small steps.
        #[inline(always)]
        fn #weight(&self, #h: T, site: usize, at: &#places<T>) -> #ty {
            let _ = (#h, site, at);
            #of_node
        }

        /// The velocities that belong to the momenta at a node, in the limit of small steps.
        #[inline(always)]
        fn #velocity(&self, #h: T, site: usize, at: &#places<T>, momenta: &#momenta<T>, weights: &[#ty]) -> SVector<T, #n> {
            let _ = (#h, at);
            let mut momentum = SVector::<T, #n>::zeros();
            #(#stacked)*
            #at_rest
            #apply
        }
    }
}

/// Subtracts the momenta at zero velocity from the momenta of a node.
fn at_rest(l: &Lines, b: &Bodies) -> Option<TokenStream> {
    let m = b.first()?;
    let d = m.outline();
    let values: Vec<Expr> = b.unit.at_rest.iter().map(|e| d.defined(e)).collect();
    if values.iter().all(Expr::is_zero) {
        return None;
    }
    let (lets, results) = l.computed(&d.letters.symbols, &l.of_site(d, &values), &values);
    let each = b.members.iter().zip(results).zip(&values);
    let each = each.filter(|(_, e)| !e.is_zero()).map(|((m, value), _)| {
        let [row, rows] = b.rows(&m.mover.name).unwrap_or([0, 0]);
        let (row, rows, value) = (number(row), number(rows), m.array(value));
        quote!(still.fixed_view_mut::<#rows, 1>(#row, 0).copy_from(&(#value));)
    });
    let n = number(b.n);
    Some(quote! {
        let mut still = SVector::<T, #n>::zeros();
        {
            #lets
            #(#each)*
        }
        let momentum = momentum - still;
    })
}

/// The inverse of the derivative of the momenta with respect to the velocities.
fn inverse(l: &Lines, b: &Bodies, list: &[Matrix], with_velocities: bool) -> TokenStream {
    let Some(first) = b.first() else {
        return TokenStream::new();
    };
    let d = first.outline();
    let s: &Symbols = &d.letters.symbols;
    let values: Vec<Expr> = list
        .iter()
        .flat_map(Matrix::expressions)
        .map(|e| d.defined(e))
        .collect();
    let letters = l.of_site(d, &values);
    let (locals, mut bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let velocities = match with_velocities {
        true => super::velocities::taken_apart(&b.members, &letters, &mut bindings, false),
        false => TokenStream::new(),
    };
    let (lets, results) = l.program(s, &values, &bindings);
    if b.scalar {
        let value = results.into_iter().next().unwrap_or_default();
        return quote!(#locals #velocities #lets T::one() / (#value));
    }
    let mut columns = Vec::new();
    let mut results = results.into_iter().zip(&values);
    for (m, of) in b.members.iter().zip(list) {
        let [row, rows] = b.rows(&m.mover.name).unwrap_or([0, 0]);
        match of {
            Matrix::Multiple(_) => {
                let Some((value, _)) = results.next() else {
                    continue;
                };
                let axis = |j: usize| {
                    let (rows, j) = (number(rows), number(j));
                    match m.is_number() {
                        true => quote!(SMatrix::<T, 1, 1>::new(#value)),
                        false => quote!(unit::<T, #rows>(#j) * (#value)),
                    }
                };
                columns.extend((0..rows).map(|j| (row, rows, row + j, axis(j))));
            }
            Matrix::Columns(own) => {
                for j in 0..own.len() {
                    let Some((value, e)) = results.next() else {
                        continue;
                    };
                    if !e.is_zero() {
                        columns.push((row, rows, j, m.array(value)));
                    }
                }
            }
        }
    }
    let matrix = filled((b.n, b.n), &columns);
    quote! {
        #locals
        #velocities
        #lets
        let inertia = #matrix;
        inverse_or_nan(&inertia)
    }
}

/// The tests that the response of every body to an impulse is defined; if an inertia is missing, the constraint
/// forces are not determined.
pub(super) fn tests_of_inertia(l: &Lines) -> TokenStream {
    l.bodies().iter().map(test_of_inertia).collect()
}

/// The test for one body.
fn test_of_inertia(b: &Bodies) -> TokenStream {
    let Some(first) = b.first() else {
        return TokenStream::new();
    };
    let (range, field, label) = (super::step::range_name(first), b.field(), &first.mover.name);
    let answer = match b.scalar {
        true => quote!(weights.#field[i]),
        false => quote!(length(&weights.#field[i])),
    };
    quote! {
        {
            let [first, last] = self.#range();
            let (weights,) = (&work.weights,);
            if let Err((site, error)) = line::try_each(first, last, |i| validate::has_inertia(#label, #answer)) {
                return Err(LineError::Site { at: line::Place { quantity: #label, site }, error });
            }
        }
    }
}
