//! Energies of a chain, summed over sites: the kinetic energy of every site, and the potentials of sites, of
//! neighbour terms and of end conditions.

use super::locals::Places;
use super::neighbour_forces::{range_of, stated_letters};
use super::{Lines, Moving, OfMeshes};
use crate::algebra::{Algebra, Rational};
use crate::derive::cancellation;
use crate::derive::limit::{Limit, of_order};
use crate::emit::element;
use crate::emit::energy::twice_kinetic_of;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};
use crate::line::SiteModel;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The functions.
pub(super) fn energy(l: &Lines, of_meshes: Option<&OfMeshes>) -> TokenStream {
    let name = l.item("");
    let energies = energies(l, of_meshes).unwrap_or_default();
    let momenta: Vec<TokenStream> = l
        .moving()
        .filter_map(|m| momenta_of_velocities(l, &m))
        .collect();
    let totals = super::conserved::totals(l);
    quote!(impl<T: Real> #name<T> { #energies #(#momenta)* #totals })
}

/// `energies` and `energy`. None if a part has no limit of small steps.
fn energies(l: &Lines, of_meshes: Option<&OfMeshes>) -> Option<TokenStream> {
    let [places, momenta, state] = ["Places", "Momenta", "State"].map(|suffix| l.item(suffix));
    let part = &l.line.representative;
    let mut kernels = TokenStream::new();
    let (mut kinetic, mut potential) = (Vec::new(), Vec::new());
    for (n, lone) in l.line.lone.iter().enumerate() {
        let limit = lone.d.limit.as_ref().ok()?;
        let count = l.count(lone.label, lone.sites);
        let kernel = format_ident!("kinetic_{}", n + 1);
        let body = kinetic_of_site(l, lone, limit);
        if let Some(body) = body {
            kernels.extend(quote! {
                /// The kinetic energy of one site.
                fn #kernel(&self, site: usize, at: &#places<T>, momenta: &#momenta<T>) -> T {
                    let _ = (site, at);
                    #body
                }
            });
            kinetic.push(quote!(line::sum(#count, |i| self.#kernel(i, at, momenta))));
        }
        if !limit.potential.is_zero() {
            let kernel = format_ident!("own_potential_{}", n + 1);
            let (d, s) = (&lone.outline, &lone.outline.letters.symbols);
            let values = [expr::quaternion_components(s, &d.defined(&limit.potential))];
            let (lets, results) = l.computed(s, &l.of_site(d, &values), &values);
            kernels.extend(quote! {
                /// The potential energy of one site without its neighbours.
                fn #kernel(&self, site: usize, at: &#places<T>) -> T {
                    let _ = (site, at);
                    #lets
                    #(#results)*
                }
            });
            potential.push(quote!(line::sum(#count, |i| self.#kernel(i, at))));
        }
    }
    if !l.line.ties.is_empty() {
        let (more, together) = super::inertia::kinetic(l)?;
        kernels.extend(more);
        kinetic.push(together);
    }
    let s = &part.d.letters.symbols;
    let h = expr::here(s, part.d.spec.step);
    let algebra = Algebra::new(s);
    for (n, pull) in l.line.pulls.iter().enumerate() {
        let energy = expr::neg(expr::quotient(pull.terms.clone(), h.clone()));
        let energy = without_step(&algebra, &energy, &h)?;
        let kernel = format_ident!("potential_{}", n + 1);
        let values = [expr::quaternion_components(s, &energy)];
        let (lets, results) = l.computed(s, &stated_letters(l, &values), &values);
        kernels.extend(quote! {
            /// The potential energy of one term that couples neighbours.
            fn #kernel(&self, site: usize, at: &#places<T>) -> T {
                #lets
                #(#results)*
            }
        });
        let range = range_of(l, pull.label, pull.from, pull.to);
        potential.push(quote!({
            #range
            line::sum(last - first, |i| self.#kernel(first + i, at))
        }));
    }
    if let Some(m) = of_meshes {
        let (more, terms) = m.energy.as_ref()?;
        kernels.extend(more.clone());
        potential.extend(terms.iter().cloned());
    }
    let ends = super::ends::energies(l)?;
    let potential = match potential.is_empty() {
        true => quote!(T::zero()),
        false => quote!(#(#potential)+*),
    };
    Some(quote! {
        #kernels
        #ends

        /// The kinetic and the potential energy of all sites at this node, in the limit of small steps.
        pub fn energies(&self, state: &#state<T>) -> (T, T) {
            let (at, momenta) = (&state.places, &state.momenta);
            let kinetic = #(#kinetic)+*;
            (kinetic, #potential + self.potential_of_ends(at))
        }

        /// The energy at this node: it oscillates within a bound.
        pub fn energy(&self, state: &#state<T>) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
    })
}

/// The expression in a form without the step size, if one exists.
pub(super) fn without_step(algebra: &Algebra, e: &Expr, h: &Expr) -> Option<Expr> {
    let s = algebra.symbols();
    let step = expr::letters(h).first().copied()?;
    let free = |e: &Expr| !expr::contains(e, step);
    let collected = expr::collect(s, e);
    if free(&collected) {
        return Some(collected);
    }
    let shortest = Some(algebra.shortest(e)).filter(free);
    // The expanded form may have larger rounding errors far from the origin.
    let stated = of_order(algebra, e, step, Rational::ZERO);
    let is_nearer = |expanded: &Expr| {
        cancellation::error(algebra, &stated) < cancellation::error(algebra, expanded)
    };
    match shortest.as_ref().is_none_or(is_nearer) && algebra.equal(&stated, e) {
        true => Some(stated),
        false => shortest,
    }
}

/// The kinetic energy of one site as a function of its momenta, from the limit of small steps. Without configurations
/// whose velocities are coupled along the chain.
fn kinetic_of_site(l: &Lines, lone: &SiteModel, limit: &Limit) -> Option<TokenStream> {
    let is_apart = |i: usize| {
        let own = lone.blocks.iter().find(|b| b.contains(&i));
        let mut names = lone.movers.iter();
        !names.any(|m| own.is_some_and(|b| b.contains(&m.index)) && l.line.is_tied(&m.name))
    };
    if !lone.movers.iter().any(|m| is_apart(m.index)) {
        return None;
    }
    let (d, outline) = (&lone.d, &lone.outline);
    let s = &d.letters.symbols;
    let limit = Limit {
        linear: outline.defined(&limit.linear),
        kinetic: outline.defined(&limit.kinetic),
        ..limit.clone()
    };
    let values = [limit.linear.clone(), limit.kinetic.clone()];
    let mut letters = l.of_site(outline, &values);
    letters.retain(|k| s.get(k.letter.symbol).role != Role::Variation);
    let (locals, bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let own = lone.movers.iter().map(|mover| {
        let m = Moving { lone, mover };
        let c = &d.spec.configurations[mover.index];
        element::value(c, momentum(&m, &quote!(site)))
    });
    let own: Vec<TokenStream> = own.collect();
    let twice = twice_kinetic_of(d, &bindings, &limit, &own, &is_apart);
    Some(quote! {
        #locals
        #twice
        twice * T::from_f64(0.5)
    })
}

/// The function from velocities to momenta of a field in a fluid model, in the limit of small steps. It includes the
/// contribution of a vector potential. None if the momentum depends on another field.
fn momenta_of_velocities(l: &Lines, m: &Moving) -> Option<TokenStream> {
    l.extent()?;
    if l.moving().any(|other| other.is_rotation()) {
        return None;
    }
    let (d, outline) = (&m.lone.d, &m.lone.outline);
    let (s, limit) = (&outline.letters.symbols, d.limit.as_ref().ok()?);
    let xi = Letter {
        symbol: d.letters.variation[m.mover.index],
        shift: Shift::HERE,
    };
    let action = expr::add(limit.linear.clone(), limit.kinetic.clone());
    let values = [expr::gradient(s, &outline.defined(&action), xi)];
    let others = |(i, _): &(usize, _)| *i != m.mover.index;
    let mut others = d.spec.configurations.iter().enumerate().filter(others);
    let is_alone = others.all(|(i, c)| {
        let met = |symbol| {
            values
                .iter()
                .any(|e| expr::letters(e).iter().any(|l| l.symbol == symbol))
        };
        !met(c.element) && !met(d.letters.variation[i])
    });
    if !is_alone {
        return None;
    }
    let mut letters = l.of_site(outline, &values);
    letters.retain(|k| k.letter != xi);
    let (locals, mut bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let velocity = match m.is_number() {
        true => quote!(velocities[site][0]),
        false => quote!(velocities[site]),
    };
    bindings.bind(xi, format_ident!("velocity"));
    let (lets, results) = l.program(s, &values, &bindings);
    let value = m.array(results.into_iter().next().unwrap_or_default());
    let (name, places, count) = (m.name(), l.item("Places"), l.count_of(&m.mover.name));
    let function = format_ident!("momenta_of_{}", m.mover.name);
    let covector = m.covector();
    let (text, given) = (&m.mover.name, format!("velocity_{}", m.mover.name));
    let unused = l.moving().filter(|other| other.mover.name != m.mover.name);
    let unused: Vec<_> = unused.map(|other| other.name()).collect();
    let doc = format!(
        " The momenta of `{text}` at these positions and velocities, in the limit of small steps."
    );
    Some(quote! {
        #[doc = #doc]
        ///
        /// # Errors
        /// If a list does not have one entry for each site.
        pub fn #function(&self, #name: &[#covector], velocities: &[#covector]) -> Result<Vec<#covector>, LineError> {
            line::length_of(#text, #name, #count, "sites")?;
            line::length_of(#given, velocities, #count, "sites")?;
            let at = #places { #name: #name.to_vec() #(, #unused: ::std::vec![SMatrix::zeros(); 0])* };
            let _ = &at;
            let mut momenta = ::std::vec![SMatrix::zeros(); #count];
            line::fill(self.threads, &mut momenta[..], |site| {
                let velocity = #velocity;
                #locals
                #lets
                #value
            });
            Ok(momenta)
        }
    })
}

/// The momentum of a site in the frame of its side.
pub(super) fn momentum(m: &Moving, site: &TokenStream) -> TokenStream {
    let name = m.name();
    match m.is_rotation() {
        true => quote!(at.#name.at(#site).matrix().tr_mul(&momenta.#name[#site])),
        false => quote!(momenta.#name[#site]),
    }
}
