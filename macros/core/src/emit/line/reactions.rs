//! The constraints in a step: the search for the impulses at its start node, the projection of the momentum on
//! arrival, and the tests of initial data.

use super::constraint_kernels::Bodies;
use super::neighbour_forces::range_of;
use super::step::range_name;
use super::{Lines, Moving, number, totals};
use crate::line::ChainConstraint;
use crate::print::{Format, Style, formula};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Their fields in the workspace.
pub(super) fn fields(l: &Lines) -> Option<TokenStream> {
    if !l.is_held() {
        return None;
    }
    let [edges, reached, responses, velocities] =
        ["Edges", "Reached", "Responses", "Velocities"].map(|x| l.item(x));
    let total = l.held_components();
    let (n, wide) = (number(total), number(3 * total));
    Some(quote! {
        kicked: #edges<T>,
        here: #reached<T>,
        there: #reached<T>,
        responses: #responses<T>,
        weights: #responses<T>,
        velocities: #velocities<T>,
        search: line::Multipliers<T>,
        impulses: Vec<SVector<T, #n>>,
        found: Vec<SVector<T, #n>>,
        held: Vec<SMatrix<T, #n, 2>>,
        held_rows: Vec<SMatrix<T, #n, #wide>>,
        held_rates: Vec<SVector<T, #n>>,
    })
}

/// The number of indices of a constraint; one for a constraint on a sum.
pub(super) fn count(l: &Lines, h: &ChainConstraint) -> TokenStream {
    if h.beside.is_some() {
        return quote!(1);
    }
    let range = range_of(l, h.label, 0, h.to);
    quote!({ #range last - first })
}

/// Empty values and derivatives of all constraints.
pub(super) fn none_reached(l: &Lines) -> TokenStream {
    let reached = l.item("Reached");
    let lists = l.holds().map(|(k, h)| {
        let (list, ty) = (format_ident!("held_{k}"), l.item(&format!("Held{k}")));
        let count = l.count_field(h.label);
        quote!(#list: ::std::vec![#ty::none(); self.sites.#count + 3])
    });
    quote!(#reached { #(#lists),* })
}

pub(super) fn none_moving(l: &Lines, bodies: &[Bodies]) -> TokenStream {
    let velocities = l.item("Velocities");
    let lists = bodies.iter().map(|b| {
        let (field, n) = (b.field(), number(b.n));
        let count = count_of(l, b);
        quote!(#field: ::std::vec![SVector::<T, #n>::zeros(); #count + 1])
    });
    quote!(#velocities { #(#lists),* })
}

pub(super) fn count_of(l: &Lines, b: &Bodies) -> TokenStream {
    b.first()
        .map(|m| l.count_of(&m.mover.name))
        .unwrap_or_default()
}

/// The initial values of the fields.
pub(super) fn values(l: &Lines, edges: &TokenStream) -> Option<TokenStream> {
    if !l.is_held() {
        return None;
    }
    let responses = l.item("Responses");
    let bodies = l.bodies();
    let lists = bodies.iter().map(|b| {
        let (field, none, count) = (b.field(), b.none(), count_of(l, b));
        quote!(#field: ::std::vec![#none; #count + 1])
    });
    let none: Vec<TokenStream> = lists.collect();
    let (reached, velocities) = (none_reached(l), none_moving(l, &bodies));
    let total = l.held_components();
    let (n, wide) = (number(total), number(3 * total));
    let counts = l.holds().flat_map(|(_, h)| {
        let count = count(l, h);
        (0..h.components).map(move |_| count.clone())
    });
    let ring = ring(l);
    let search = match l.holds_sums() {
        true => quote!(line::Multipliers::of_sums(#n)),
        false => quote!(line::Multipliers::new(&[#(#counts),*], #ring)),
    };
    let places = l.holds().map(|(_, h)| {
        let count = l.count_field(h.label);
        quote!(self.sites.#count + 3)
    });
    let places = places.into_iter().next()?;
    Some(quote! {
        kicked: #edges,
        here: #reached,
        there: #reached,
        responses: #responses { #(#none),* },
        weights: #responses { #(#none),* },
        velocities: #velocities,
        search: #search,
        impulses: ::std::vec![SVector::<T, #n>::zeros(); #places],
        found: ::std::vec![SVector::<T, #n>::zeros(); #places],
        held: ::std::vec![SMatrix::<T, #n, 2>::zeros(); #places],
        held_rows: ::std::vec![SMatrix::<T, #n, #wide>::zeros(); #places],
        held_rates: ::std::vec![SVector::<T, #n>::zeros(); #places],
    })
}

pub(super) fn ring(l: &Lines) -> TokenStream {
    let of_line = l
        .line
        .holds
        .iter()
        .any(|h| l.line.lattice.line == Some(h.label));
    match of_line && l.line.lattice.periodic.is_some() {
        true => quote!(self.is_ring()),
        false => quote!(false),
    }
}

/// The multipliers at the start.
pub(super) fn no_multipliers(l: &Lines) -> TokenStream {
    let ty = l.item("Multipliers");
    let each = l.holds().map(|(_, h)| {
        let (name, r, count) = (
            format_ident!("{}", h.name),
            number(h.components),
            count(l, h),
        );
        quote!(#name: ::std::vec![SMatrix::<T, #r, 1>::zeros(); #count])
    });
    quote!(#ty { #(#each),* })
}

/// The names of the multipliers.
pub(super) fn names(l: &Lines) -> Vec<Ident> {
    l.holds()
        .map(|(_, h)| format_ident!("{}", h.name))
        .collect()
}

/// The structure of the multipliers, and the functions of a state that show them.
pub(super) fn state(l: &Lines) -> (TokenStream, TokenStream) {
    if !l.is_held() {
        return Default::default();
    }
    let ty = l.item("Multipliers");
    let (mut fields, mut access) = (TokenStream::new(), TokenStream::new());
    for (_, h) in l.holds() {
        let (name, r) = (format_ident!("{}", h.name), number(h.components));
        let [left, right] = sides(l, h);
        let doc = format!(
            " The multipliers of `{left} = {right}` over the step that ended here, zero at the start. The constraint \
             force is the multiplier times the derivative of the left side minus the right side."
        );
        fields.extend(quote!(#name: Vec<SMatrix<T, #r, 1>>,));
        let (shown, value) = match h.beside {
            Some(_) => (quote!(SMatrix<T, #r, 1>), quote!(self.multipliers.#name[0])),
            None => (
                quote!(&[SMatrix<T, #r, 1>]),
                quote!(&self.multipliers.#name),
            ),
        };
        access.extend(quote! {
            #[doc = #doc]
            pub fn #name(&self) -> #shown {
                #value
            }
        });
    }
    let structure = quote! {
        /// Multipliers of constraints.
        #[derive(Clone, Debug, PartialEq)]
        struct #ty<T> { #fields }
    };
    (structure, access)
}

pub(super) fn sides(l: &Lines, h: &ChainConstraint) -> [String; 2] {
    let d = &l.line.representative.d;
    let style = Style::new(&d.spec.time_index);
    let shown = |side| formula(side, &h.symbols, &style, Format::Text);
    [shown(&h.sides[0]), shown(&h.sides[1])]
}

/// The equation as text.
pub(super) fn equation(l: &Lines, h: &ChainConstraint) -> String {
    let [left, right] = sides(l, h);
    format!("{left} = {right}")
}

/// Fills a list of a body over its sites; on a ring, the first value is repeated at the end.
fn over(
    l: &Lines,
    b: &Bodies,
    list: &TokenStream,
    given: &TokenStream,
    value: &TokenStream,
) -> TokenStream {
    let Some(first) = b.first() else {
        return TokenStream::new();
    };
    let (range, field, count) = (range_name(first), b.field(), count_of(l, b));
    let closed = ring(l);
    let around = match closed.to_string() == "false" {
        true => TokenStream::new(),
        false => quote!(if self.is_ring() { #list.#field[#count] = #list.#field[0]; }),
    };
    quote! {
        {
            let [first, last] = self.#range();
            #given
            line::fill(self.threads, &mut #list.#field[first..last], |i| { let site = first + i; #value });
            #around
        }
    }
}

/// The values that a workspace computes once: responses to impulses that depend on parameters only.
pub(super) fn once(l: &Lines) -> TokenStream {
    let mut out = TokenStream::new();
    for b in &l.bodies() {
        let field = b.field();
        let given = quote!(let (at,) = (&state.places,););
        if b.is_steady(false) {
            out.extend(over(l, b, &quote!(work.responses), &given, &response(b)));
        }
        if b.is_steady(true) {
            let weight = format_ident!("weight_{field}");
            let value = quote!(self.#weight(h, site, at));
            out.extend(over(l, b, &quote!(work.weights), &given, &value));
        }
    }
    out
}

/// The call of the kernel for the response in a step.
fn response(b: &Bodies) -> TokenStream {
    let kernel = format_ident!("response_{}", b.field());
    match (&b.unit.of_edge, b.takes_velocities()) {
        (None, _) => quote!(self.#kernel(h, site, from, to)),
        (Some(_), true) if !b.is_steady(false) => {
            quote!(self.#kernel(h, site, at, &velocity[site]))
        }
        (Some(_), true) => {
            let n = number(b.n);
            quote!(self.#kernel(h, site, at, &SVector::<T, #n>::zeros()))
        }
        (Some(_), false) => quote!(self.#kernel(h, site, at)),
    }
}

/// The edge momenta of one configuration, including the constraint forces.
fn kicked(l: &Lines, m: &Moving) -> TokenStream {
    let (name, range) = (m.name(), range_name(m));
    if !l.is_reached(&m.mover.name) {
        return match m.is_rotation() {
            true => quote!(work.kicked.#name.keep(0..work.edges.#name.len(), &work.edges.#name);),
            false => quote!(work.kicked.#name.copy_from_slice(&work.edges.#name);),
        };
    }
    let kernel = format_ident!("reacted_{}", m.mover.name);
    let value = match m.is_rotation() {
        true => quote! {
            edges.at(site) + at.#name.at(site).matrix() * kick
        },
        false => quote!(edges[site] + kick),
    };
    let part = m.part(&quote!(work.kicked.#name));
    quote! {
        {
            let [first, last] = self.#range();
            let (at, edges, here, impulses) = (&state.places, &work.edges.#name, &work.here, &work.impulses);
            let _ = at;
            line::fill(self.threads, #part, |i| {
                let site = first + i;
                let kick = self.#kernel(site, here, impulses);
                #value
            });
        }
    }
}

/// The search for the impulses; `solved` is the code that computes the positions.
pub(super) fn search(l: &Lines, solved: &TokenStream) -> TokenStream {
    let bodies = l.bodies();
    let members = bodies.iter().flat_map(|b| &b.members);
    let kicked: Vec<TokenStream> = members.map(|m| kicked(l, m)).collect();
    let responses = bodies.iter().filter(|b| !b.is_steady(false)).map(|b| {
        let velocity = b
            .first()
            .filter(|_| b.takes_velocities())
            .map(|m| format_ident!("velocity_{}", m.mover.name));
        let given = match (&b.unit.of_edge, velocity) {
            (None, _) => quote!(let (from, to) = (&state.places, &work.places);),
            (Some(_), Some(field)) => {
                quote!(let (at, velocity) = (&state.places, &work.#field);)
            }
            (Some(_), None) => quote!(let (at,) = (&state.places,);),
        };
        over(l, b, &quote!(work.responses), &given, &response(b))
    });
    let responses: Vec<TokenStream> = responses.collect();
    let first = l.line.holds.first().map(|h| &h.name);
    let held = match l.holds_sums() {
        true => totals::held(),
        false => quote! {
            {
                let last = work.search.sites();
                let (there,) = (&work.there,);
                line::fill(self.threads, &mut work.held[0..last], |i| self.held_at(i, there));
            }
        },
    };
    let rows = held_rows(
        l,
        &quote!(&work.there),
        &quote!(&work.here),
        &quote!(&work.responses),
    );
    quote! {
        work.search.begin_search(&mut work.impulses);
        while work.search.goes_on() {
            #(#kicked)*
            #solved
            self.around(&mut work.places);
            self.reached(&work.places, &mut work.there);
            #held
            if work.search.wants_derivatives(&work.held, &mut work.impulses) {
                #(#responses)*
                #rows
                work.search.correct(&work.held_rows, &mut work.impulses);
            }
        }
        if let Err((site, cause)) = work.search.root_found() {
            return Err(self.refused(state, h, line::Place { quantity: #first, site }, StepCause::NoReaction(cause)));
        }
        work.found.copy_from_slice(&work.impulses);
    }
}

/// The derivatives of the constraints at the positions `there` with respect to impulses at `here`.
fn held_rows(
    l: &Lines,
    there: &TokenStream,
    here: &TokenStream,
    responses: &TokenStream,
) -> TokenStream {
    if l.holds_sums() {
        return totals::rows(there, here, responses);
    }
    quote! {
        {
            let last = work.search.sites();
            let (there, here, responses) = (#there, #here, #responses);
            line::fill(self.threads, &mut work.held_rows[0..last], |i| self.held_row(i, there, here, responses));
        }
    }
}

/// The edge momenta with constraint forces become those of the step.
pub(super) fn edges(l: &Lines) -> TokenStream {
    let bodies = l.bodies();
    let names = bodies.iter().flat_map(|b| &b.members).map(Moving::name);
    names
        .map(|name| quote!(::core::mem::swap(&mut work.edges.#name, &mut work.kicked.#name);))
        .collect()
}

/// The impulses that project the momenta of a node.
fn projected(
    l: &Lines,
    at: &TokenStream,
    momenta: &TokenStream,
    reached: &TokenStream,
) -> TokenStream {
    let bodies = l.bodies();
    let weights = bodies.iter().filter(|b| !b.is_steady(true)).map(|b| {
        let kernel = format_ident!("weight_{}", b.field());
        let value = quote!(self.#kernel(h, site, at));
        over(
            l,
            b,
            &quote!(work.weights),
            &quote!(let (at,) = (#at,);),
            &value,
        )
    });
    let velocities = bodies.iter().map(|b| {
        let field = b.field();
        let kernel = format_ident!("node_velocity_{field}");
        let given = quote!(let (at, momenta, weights) = (#at, #momenta, &work.weights.#field););
        let value = quote!(self.#kernel(h, site, at, momenta, weights));
        over(l, b, &quote!(work.velocities), &given, &value)
    });
    let rows = held_rows(l, reached, reached, &quote!(&work.weights));
    let rates = match l.holds_sums() {
        true => totals::rates(reached),
        false => quote! {
            {
                let last = work.search.sites();
                let (reached, velocities) = (#reached, &work.velocities);
                line::fill(self.threads, &mut work.held_rates[0..last], |i| self.held_rate(i, reached, velocities));
            }
        },
    };
    quote! {
        #(#weights)*
        #(#velocities)*
        #rows
        #rates
    }
}

/// The projection of the momenta on arrival, and the multipliers of the step; stores both in `state`.
pub(super) fn project(l: &Lines) -> TokenStream {
    let projected = projected(
        l,
        &quote!(&work.places),
        &quote!(&work.momenta),
        &quote!(&work.there),
    );
    let first = l.line.holds.first().map(|h| &h.name);
    let applied = l.moving().map(|m| {
        let (name, range) = (m.name(), range_name(&m));
        if !l.is_reached(&m.mover.name) {
            return quote!(::core::mem::swap(&mut state.momenta.#name, &mut work.momenta.#name););
        }
        let kernel = format_ident!("reacted_{}", m.mover.name);
        let value = match m.is_rotation() {
            true => quote! {
                let turned = at.#name.at(site).matrix() * kick;
                Some((momenta[site] - turned, edge - turned))
            },
            false => quote!(Some((momenta[site] - kick, edge - kick))),
        };
        let edges = m.part(&quote!(work.edges.#name));
        quote! {
            {
                let [first, last] = self.#range();
                let (at, momenta, there, impulses) = (&work.places, &work.momenta.#name, &work.there, &work.impulses);
                let _ = at;
                let _ = line::update(
                    self.threads,
                    &mut state.momenta.#name[first..last],
                    #edges,
                    |i, edge| {
                        let site = first + i;
                        let kick = self.#kernel(site, there, impulses);
                        #value
                    },
                );
            }
        }
    });
    let told = l.holds().map(|(_, h)| {
        let (name, row, r) = (
            format_ident!("{}", h.name),
            number(l.held_row(h)),
            number(h.components),
        );
        quote! {
            {
                let each = T::one() / h;
                let (found, impulses) = (&work.found, &work.impulses);
                line::fill(self.threads, &mut state.multipliers.#name[..], |i| {
                    (found[i + 1].fixed_rows::<#r>(#row).into_owned() - impulses[i + 1].fixed_rows::<#r>(#row).into_owned()) * each
                });
            }
        }
    });
    let told: Vec<TokenStream> = told.collect();
    quote! {
        #projected
        if let Err((site, cause)) = work.search.projected(&work.held_rows, &work.held_rates, &mut work.impulses) {
            return Err(self.refused(state, h, line::Place { quantity: #first, site }, StepCause::NoReaction(cause)));
        }
        #(#applied)*
        #(#told)*
        ::core::mem::swap(&mut work.here, &mut work.there);
    }
}

/// The error for a constraint at a site, or for a constraint on a sum.
fn refused_at(l: &Lines, h: &ChainConstraint) -> TokenStream {
    let label = &h.name;
    match l.holds_sums() {
        true => quote!(LineError::Parameter(error)),
        false => quote!(LineError::Site { at: line::Place { quantity: #label, site }, error }),
    }
}

/// The tests of a state at node 0: it must satisfy the constraints, and its momenta must be tangent to them. The
/// projection then removes the rounding error of the normal component.
pub(super) fn admitted(l: &Lines) -> TokenStream {
    let sums = l.holds_sums();
    let tests = l.holds().map(|(k, h)| {
        let (list, label, equation) = (format_ident!("held_{k}"), &h.name, equation(l, h));
        let range = range_of(l, h.label, 0, h.to);
        quote! {
            {
                #range
                let (here,) = (&work.here,);
                let made = line::try_each(first, last, |i| {
                    validate::on_constraint(#label, #equation, length(&here.#list[i + 1].value), here.#list[i + 1].size)
                });
                if let Err((site, error)) = made {
                    return Err(LineError::Site { at: line::Place { quantity: #label, site }, error });
                }
            }
        }
    });
    let tests: TokenStream = match sums {
        true => totals::on_constraints(l),
        false => tests.collect(),
    };
    let projected = projected(
        l,
        &quote!(&state.places),
        &quote!(&state.momenta),
        &quote!(&work.here),
    );
    let reached: Vec<Moving> = l.moving().filter(|m| l.is_reached(&m.mover.name)).collect();
    let applied = reached.iter().map(|m| {
        let (name, range) = (m.name(), range_name(m));
        let kernel = format_ident!("reacted_{}", m.mover.name);
        let value = match m.is_rotation() {
            true => quote!(momenta[site] - at.#name.at(site).matrix() * kick),
            false => quote!(momenta[site] - kick),
        };
        quote! {
            {
                let [first, last] = self.#range();
                let (at, momenta, here, impulses) = (&state.places, &state.momenta.#name, &work.here, &work.impulses);
                let _ = at;
                line::fill(self.threads, &mut work.momenta.#name[first..last], |i| {
                    let site = first + i;
                    let kick = self.#kernel(site, here, impulses);
                    #value
                });
                let (projected,) = (&work.momenta.#name,);
                taken += line::sum(last - first, |i| length(&(momenta[first + i] - projected[first + i])));
                whole += line::sum(last - first, |i| length(&momenta[first + i]));
            }
        }
    });
    let applied: Vec<TokenStream> = applied.collect();
    let swapped = reached.iter().map(|m| {
        let name = m.name();
        quote!(::core::mem::swap(&mut state.momenta.#name, &mut work.momenta.#name);)
    });
    let swapped: Vec<TokenStream> = swapped.collect();
    let inertia = super::responses::tests_of_inertia(l);
    let first = l.line.holds.first();
    let label = first.map(|h| &h.name);
    let equation_of_first = first.map(|h| equation(l, h));
    let refused_first = first.map(|h| refused_at(l, h));
    let along = l.holds().map(|(_, h)| {
        let (label, equation) = (&h.name, equation(l, h));
        let (row, r) = (number(l.held_row(h)), number(h.components));
        let refused = refused_at(l, h);
        quote! {
            if let Err(error) = validate::along_constraint(#label, #equation, length(&work.impulses[site + 1].fixed_rows::<#r>(#row).into_owned()), taken, whole) {
                return Err(#refused);
            }
        }
    });
    let along: Vec<TokenStream> = along.collect();
    quote! {
        #tests
        #projected
        let site = match work.search.projected(&work.held_rows, &work.held_rates, &mut work.impulses) {
            Ok(()) => work.search.largest_impulse(),
            Err((site, _)) => {
                #inertia
                let none = T::from_f64(f64::NAN);
                if let Err(error) = validate::along_constraint(#label, #equation_of_first, none, none, none) {
                    return Err(#refused_first);
                }
                site
            }
        };
        let (mut taken, mut whole) = (T::zero(), T::zero());
        #(#applied)*
        #(#along)*
        #(#swapped)*
    }
}
