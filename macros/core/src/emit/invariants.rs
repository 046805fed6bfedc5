//! The derived invariants as functions of the state, with their natural scales.

use super::expression::{Bindings, Writer, program};
use super::items::{letters_of, parameter_locals, text, with_transports};
use super::names::{Names, item, per_configuration, variable};
use super::step::{at, here};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::invariants::{Invariant, Kind};
use crate::derive::limit::Limit;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// How an invariant is documented.
pub fn formula(d: &Derivation, v: &Invariant) -> String {
    match (&v.kind, &v.value, d.limit.as_ref()) {
        (Kind::SpatialMomentum(i), _, _) => {
            let c = &d.spec.configurations[*i];
            let element = &d.letters.symbols.get(c.element).name;
            match c.side {
                Side::Body => format!("{element} μ"),
                Side::Spatial => "m".to_owned(),
            }
        }
        (Kind::Energy, _, Ok(limit)) if limit.potential.is_zero() => "½ μ·I⁻¹μ".to_owned(),
        (Kind::Energy, _, Ok(limit)) => format!("½ μ·I⁻¹μ + {}", text(d, &limit.potential)),
        (_, Some(value), _) => text(d, value),
        (Kind::Number | Kind::Energy, _, _) => v.name.clone(),
    }
}

/// Locals for the node momenta among the letters.
fn momenta(d: &Derivation, needed: &[Letter], bindings: &mut Bindings) -> TokenStream {
    let mut out = TokenStream::new();
    for (i, (c, id)) in d
        .spec
        .configurations
        .iter()
        .zip(&d.letters.node_momentum)
        .enumerate()
    {
        let letter = at(*id, Shift::HERE);
        if !needed.contains(&letter) {
            continue;
        }
        let name = variable(&d.letters.symbols, *id);
        let method = per_configuration(
            d,
            match c.side {
                Side::Body => "body_momentum",
                Side::Spatial => "spatial_momentum",
            },
            i,
        );
        out.extend(quote!(let #name = state.#method().0;));
        bindings.bind(letter, name);
    }
    out
}

/// One function for every number, the energy, and all values and scales together.
pub fn invariants(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let (name, state) = (item(d, ""), item(d, "State"));
    let mut functions = TokenStream::new();
    for v in &d.invariants {
        let method = format_ident!("{}", v.name);
        let doc = format!(" `{}`: {}.", formula(d, v), v.reason);
        match (&v.kind, &v.value, d.limit.as_ref()) {
            (Kind::SpatialMomentum(_), _, _) => {}
            (Kind::Energy, _, Ok(limit)) => functions.extend(energy(d, names, limit)),
            (_, Some(value), _) => {
                let needed = letters_of([value]);
                let all = with_transports(d, &needed, 0);
                let parameters = parameter_locals(d, quote!(self.parameters), &all);
                let mut bindings = Bindings::new();
                let locals = here(d, names, &needed, &mut bindings);
                let mu = momenta(d, &needed, &mut bindings);
                let p = schedule::program(s, std::slice::from_ref(value), "t");
                let (lets, values) = program(&p, &bindings);
                let value = &values[0];
                functions.extend(quote! {
                    #[doc = #doc]
                    pub fn #method(&self, state: &#state<T>) -> T {
                        #parameters
                        #locals
                        #mu
                        #lets
                        #value
                    }
                });
            }
            (Kind::Number | Kind::Energy, None, _) => {}
        }
    }
    quote!(impl<T: Real> #name<T> { #functions })
}

/// The scale of an invariant as a value of type `T`.
pub fn scale(d: &Derivation, names: &Names, v: &Invariant) -> TokenStream {
    let s = &d.letters.symbols;
    let Some(e) = &v.scale else {
        return quote!({
            let (kinetic, potential) = self.model.energies(state);
            kinetic.abs() + potential.abs()
        });
    };
    let needed = letters_of([e]);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.model.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let mu = momenta(d, &needed, &mut bindings);
    let value = Writer {
        symbols: s,
        bindings: &bindings,
    }
    .write(e);
    // Scales are taken on plain numbers.
    quote!({ type T = f64; #parameters #locals #mu let value: T = #value; value })
}

/// The physical energy: the kinetic energy of the limit, inverted for the momentum, and the
/// potential.
fn energy(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let bodies = d.spec.configurations.len();
    let (count, dimension) = (
        Literal::usize_unsuffixed(bodies),
        Literal::usize_unsuffixed(3 * bodies),
    );
    // B(ξ, η): the kinetic energy is B(ξ, ξ)/2.
    let along: Vec<(Letter, Expr)> = (0..bodies)
        .map(|i| {
            let xi = at(d.letters.variation[i], Shift::HERE);
            (xi, expr::here(s, d.letters.direction[i]))
        })
        .collect();
    let form = expr::directional(s, &limit.kinetic, &along);
    let linear = expr::directional(s, &limit.linear, &along);
    let needed = letters_of([&form, &linear, &limit.potential]);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let writer = Writer {
        symbols: s,
        bindings: &bindings,
    };
    let axis = |index: TokenStream, i: usize| {
        let i = Literal::usize_unsuffixed(i);
        if bodies == 1 {
            quote!(basis::<T>(#index))
        } else {
            quote!(if #index / 3 == #i { basis::<T>(#index % 3) } else { SMatrix::<T, 3, 3>::zeros() })
        }
    };
    let directions = |ids: &[crate::expr::symbol::SymbolId], index: TokenStream| -> TokenStream {
        ids.iter()
            .enumerate()
            .map(|(i, id)| {
                let (name, value) = (variable(s, *id), axis(index.clone(), i));
                quote!(let #name = #value;)
            })
            .collect()
    };
    let xi = directions(&d.letters.variation, quote!(i));
    let eta = directions(&d.letters.direction, quote!(j));
    let eta_i = directions(&d.letters.direction, quote!(i));
    let (form, potential) = (writer.write(&form), writer.write(&limit.potential));
    let zero_potential = limit.potential.is_zero();
    let potential = if zero_potential {
        quote!(T::zero())
    } else {
        potential
    };
    let shift = (!limit.linear.is_zero()).then(|| {
        let linear = writer.write(&linear);
        quote! {
            - SVector::<T, #dimension>::from_fn(|i, _| { #eta_i #linear })
        }
    });
    let parts = d.spec.configurations.iter().enumerate().map(|(i, c)| {
        let base = match c.side {
            Side::Body => "body_momentum",
            Side::Spatial => "spatial_momentum",
        };
        let method = per_configuration(d, base, i);
        quote!(state.#method().0)
    });
    let stacked = super::newton::stack(bodies, quote!(parts));
    quote! {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &#state<T>) -> (T, T) {
            #parameters
            #locals
            let parts: [SVector<T, 3>; #count] = [#(#parts),*];
            let momentum: SVector<T, #dimension> = #stacked #shift;
            let inertia = SMatrix::<T, #dimension, #dimension>::from_fn(|i, j| {
                #xi
                #eta
                #form
            });
            let velocity = solve_or_nan(&inertia, &momentum);
            (momentum.dot(&velocity) * T::from_f64(0.5), #potential)
        }

        /// The physical energy at this node.
        pub fn energy(&self, state: &#state<T>) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
    }
}
