//! Kernels of constraints on sums over sites: the residual of a sum, the effect of its multiplier on the
//! configurations of a site, and the small system for the multipliers of all sums, itself a sum over sites.

use super::constraint_kernels::{Bodies, DerivativeStorage, field, kept};
use super::neighbour_forces::range_of;
use super::reactions::count_of;
use super::{Lines, number};
use crate::emit::expression::Bindings;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Lines<'_> {
    /// Whether the constraints are on sums over sites; such a model has none at single sites.
    pub(super) fn holds_sums(&self) -> bool {
        self.line.holds.iter().any(|h| h.beside.is_some())
    }
}

/// The kernels.
pub(super) fn kernels(l: &Lines, bodies: &[Bodies]) -> TokenStream {
    let [reached, responses, velocities] =
        ["Reached", "Responses", "Velocities"].map(|x| l.item(x));
    let total = l.held_components();
    let (size, wide) = (number(total), number(3 * total));
    let (mut kernels, mut values) = (TokenStream::new(), TokenStream::new());
    for (k, h) in l.holds() {
        let s = &l.line.representative.d.letters.symbols;
        let (list, own) = (format_ident!("held_{k}"), format_ident!("sum_{k}"));
        let (row, r) = (number(l.held_row(h)), number(h.components));
        let range = range_of(l, h.label, 0, h.to);
        let rest: Vec<_> = h.beside.iter().cloned().collect();
        let letters = super::neighbour_forces::stated_letters(l, &rest);
        let (locals, bindings): (TokenStream, Bindings) =
            l.locals(s, &letters, &super::locals::Places::of_node(), &quote!(0));
        let (lets, results) = l.program(s, &rest, &bindings);
        let beside = results.into_iter().next().unwrap_or_default();
        let beside = match h.value.shape().is_scalar() {
            true => quote!(SMatrix::<T, 1, 1>::new(#beside)),
            false => beside,
        };
        let doc = format!(
            " The residual of the constraint of `{}`, and the size of its terms.",
            h.name
        );
        kernels.extend(quote! {
            #[doc = #doc]
            fn #own(&self, reached: &#reached<T>) -> (SMatrix<T, #r, 1>, T) {
                #locals
                #lets
                let beside: SMatrix<T, #r, 1> = #beside;
                #range
                let value = line::total(last - first, |i| reached.#list[first + i + 1].value);
                let size = line::sum(last - first, |i| reached.#list[first + i + 1].size);
                (value + beside, size + length(&beside))
            }
        });
        values.extend(quote! {
            let (value, size) = self.#own(reached);
            held.fixed_view_mut::<#r, 1>(#row, 0).copy_from(&value);
            held.fixed_view_mut::<#r, 1>(#row, 1).copy_from(&(SMatrix::<T, #r, 1>::repeat(size)));
        });
    }
    let answering = bodies.iter().map(|b| answering(l, b));
    let answering: Vec<TokenStream> = answering.collect();
    let rows = bodies.iter().map(|b| {
        let (body, count, kernel) = (b.field(), count_of(l, b), name_of(b));
        let answer = match b.scalar {
            true => quote!(right * responses.#body[site]),
            false => quote!(responses.#body[site] * right),
        };
        quote!(line::total(#count, |site| {
            let left = self.#kernel(site, there);
            let right = self.#kernel(site, here);
            left.tr_mul(&(#answer))
        }))
    });
    let rates = bodies.iter().map(|b| {
        let (body, count, kernel) = (b.field(), count_of(l, b), name_of(b));
        quote!(line::total(#count, |site| self.#kernel(site, reached).tr_mul(&velocities.#body[site])))
    });
    let sizes = bodies.iter().map(|b| {
        let (body, count, kernel) = (b.field(), count_of(l, b), name_of(b));
        quote!(line::sum(#count, |site| length(&self.#kernel(site, reached)) * length(&velocities.#body[site])))
    });
    quote! {
        #kernels
        #(#answering)*

        /// The residuals of the constraints on sums, and the sizes of their terms.
        fn held_sums(&self, reached: &#reached<T>) -> SMatrix<T, #size, 2> {
            let mut held = SMatrix::<T, #size, 2>::zeros();
            #values
            held
        }

        /// The derivatives of the constraints on sums at the positions `there` with respect to impulses at the positions `here`.
        fn held_sums_row(&self, there: &#reached<T>, here: &#reached<T>, responses: &#responses<T>) -> SMatrix<T, #size, #wide> {
            let own: SMatrix<T, #size, #size> = #(#rows)+*;
            let mut row = SMatrix::<T, #size, #wide>::zeros();
            row.fixed_view_mut::<#size, #size>(0, #size).copy_from(&own);
            row
        }

        /// The rates of change of the constraints on sums.
        fn held_sums_rate(&self, reached: &#reached<T>, velocities: &#velocities<T>) -> SVector<T, #size> {
            #(#rates)+*
        }

        /// The size of the terms of these rates.
        fn held_sums_rate_size(&self, reached: &#reached<T>, velocities: &#velocities<T>) -> T {
            #(#sizes)+*
        }
    }
}

fn name_of(b: &Bodies) -> proc_macro2::Ident {
    format_ident!("answering_{}", b.field())
}

/// The kernel of the effect of the multipliers on the momenta at a site, one column per multiplier.
fn answering(l: &Lines, b: &Bodies) -> TokenStream {
    let (n, size, reached) = (number(b.n), number(l.held_components()), l.item("Reached"));
    let mut put = Vec::new();
    for (k, h) in l.holds() {
        let (list, column, r) = (
            format_ident!("held_{k}"),
            number(l.held_row(h)),
            number(h.components),
        );
        for m in &b.members {
            let [row, rows] = b.rows(&m.mover.name).unwrap_or([0, 0]);
            let (row, rows) = (number(row), number(rows));
            let own = h.reaches.iter().filter(|x| x.on == m.mover.name);
            let each: Vec<TokenStream> = own
                .map(|reach| {
                    let (own, by) = (field(reach), number(1 - reach.site));
                    match kept(l, reach) {
                        DerivativeStorage::Matrix => quote!(reached.#list[site + #by].#own),
                        DerivativeStorage::Number => quote!(SMatrix::<T, #rows, #r>::from_diagonal_element(reached.#list[site + #by].#own)),
                        DerivativeStorage::Fixed(c) => quote!(SMatrix::<T, #rows, #r>::from_diagonal_element(#c)),
                    }
                })
                .collect();
            if !each.is_empty() {
                put.push(
                    quote!(a.fixed_view_mut::<#rows, #r>(#row, #column).copy_from(&(#(#each)+*));),
                );
            }
        }
    }
    let kernel = name_of(b);
    quote! {
        /// The contributions of the impulses of constraints on sums to the momenta at a site, one column for each.
        #[inline(always)]
        fn #kernel(&self, site: usize, reached: &#reached<T>) -> SMatrix<T, #n, #size> {
            let mut a = SMatrix::<T, #n, #size>::zeros();
            #(#put)*
            a
        }
    }
}

/// Stores the residuals of the sums for the search.
pub(super) fn held() -> TokenStream {
    quote!(work.held[0] = self.held_sums(&work.there);)
}

/// Stores the derivatives of the sums for the search.
pub(super) fn rows(
    there: &TokenStream,
    here: &TokenStream,
    responses: &TokenStream,
) -> TokenStream {
    quote!(work.held_rows[0] = self.held_sums_row(#there, #here, #responses);)
}

/// Stores the rates of change of the sums for the search.
pub(super) fn rates(reached: &TokenStream) -> TokenStream {
    quote!(work.held_rates[0] = self.held_sums_rate(#reached, &work.velocities);)
}

/// The tests that a state at node 0 is on the constraints.
pub(super) fn on_constraints(l: &Lines) -> TokenStream {
    let each = l.holds().map(|(k, h)| {
        let (own, label) = (format_ident!("sum_{k}"), &h.name);
        let equation = super::reactions::equation(l, h);
        quote! {
            {
                let (value, size) = self.#own(&work.here);
                if let Err(error) = validate::on_constraint(#label, #equation, length(&value), size) {
                    return Err(LineError::Parameter(error));
                }
            }
        }
    });
    each.collect()
}

/// Functions of a state that report on constraints on sums.
pub(super) fn sum_constraint_functions(
    l: &Lines,
    none_reached: &TokenStream,
    none_moving: &TokenStream,
) -> TokenStream {
    let state = l.item("State");
    let each = l.holds().map(|(k, h)| {
        let own = format_ident!("sum_{k}");
        let [value, rate, size, rate_size] =
            ["constraint", "constraint_rate", "constraint_size", "constraint_rate_size"]
                .map(|x| format_ident!("{x}_{}", h.name));
        let (row, r) = (number(l.held_row(h)), number(h.components));
        let equation = super::reactions::equation(l, h);
        let doc = format!(" The residual of `{equation}` at this state.");
        let doc_rate = format!(" The rate of change of the residual of `{equation}`.");
        let reached = quote! {
            let mut reached = #none_reached;
            self.reached(&state.places, &mut reached);
        };
        let moving = quote! {
            #reached
            let mut velocities = #none_moving;
            self.velocities_of_node(&state.places, &state.momenta, &mut velocities);
        };
        quote! {
            #[doc = #doc]
            pub fn #value(&self, state: &#state<T>) -> T {
                #reached
                let (value, _) = self.#own(&reached);
                length(&value)
            }

            #[doc = #doc_rate]
            pub fn #rate(&self, state: &#state<T>) -> T {
                #moving
                let rate = self.held_sums_rate(&reached, &velocities).fixed_rows::<#r>(#row).into_owned();
                length(&rate)
            }

            /// The size of its terms.
            #[doc(hidden)]
            pub fn #size(&self, state: &#state<T>) -> T {
                #reached
                let (_, size) = self.#own(&reached);
                size
            }

            /// The size of its terms.
            #[doc(hidden)]
            pub fn #rate_size(&self, state: &#state<T>) -> T {
                #moving
                self.held_sums_rate_size(&reached, &velocities)
            }
        }
    });
    each.collect()
}
