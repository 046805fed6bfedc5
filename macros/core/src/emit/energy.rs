//! The physical energy of a node: the kinetic energy of the limit of small steps, inverted for the
//! momentum, and the potential. Takes the limit; gives `energies` and `energy`.

use super::element::{self, Bundle, stack};
use super::expression::{Bindings, Writer, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, item, variable};
use super::sizes::Generics;
use super::step::{at, here};
use crate::derive::Derivation;
use crate::derive::limit::Limit;
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `energies` and `energy`.
pub fn energy(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    match element::only_rotations(d) {
        true => of_rotations(d, names, limit),
        false => of_matrices(d, names, limit),
    }
}

/// Each configuration's node momentum in the frame of its side.
fn momenta(d: &Derivation) -> Vec<TokenStream> {
    let list = d.spec.configurations.iter().enumerate();
    list.map(|(i, c)| {
        let method = element::momentum_field(d, i, c.side);
        element::value(c, quote!(state.#method().0))
    })
    .collect()
}

/// The inertia column by column: the momentum of each unit velocity is the gradient of the kinetic
/// energy, which costs less than the form on all pairs.
fn of_matrices(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let bodies = d.spec.configurations.len();
    let bundle = Bundle::of(d);
    let covectors = element::covectors(d);
    let gradients = |e: &Expr| -> Vec<Expr> {
        let list = d.spec.configurations.iter().zip(&d.letters.variation);
        list.map(|(c, xi)| {
            let y = expr::gradient(s, e, at(*xi, Shift::HERE));
            c.group.of_gradient(&d.letters.symbols, y)
        })
        .collect()
    };
    let (kinetic, linear) = (gradients(&limit.kinetic), gradients(&limit.linear));
    let needed = letters_of(kinetic.iter().chain(&linear).chain([&limit.potential]));
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let p = schedule::program(s, &kinetic, "t");
    let (lets, values) = program(&p, &bindings);
    let values = bundle.value(&values);
    let stacked = stack(d, quote!(parts));
    let mut columns = TokenStream::new();
    for j in 0..bodies {
        let directions: TokenStream = d
            .letters
            .variation
            .iter()
            .enumerate()
            .map(|(i, xi)| {
                let name = variable(s, *xi);
                let value = if i == j {
                    element::basis(d, i, quote!(axis))
                } else if s.get(*xi).shape.is_scalar() {
                    quote!(T::zero())
                } else {
                    quote!(SMatrix::zeros())
                };
                let t = super::expression::ty(s, s.get(*xi).shape);
                quote!(let #name: #t = #value;)
            })
            .collect();
        let column = match j {
            0 => quote!(axis),
            _ => {
                let offset = element::offset(d, j);
                quote!(#offset + axis)
            }
        };
        let count = element::coordinates(d, j);
        columns.extend(quote! {
            for axis in 0..#count {
                #directions
                #lets
                let parts: #covectors = #values;
                inertia.set_column(#column, &#stacked);
            }
        });
    }
    let writer = Writer {
        symbols: s,
        bindings: &bindings,
    };
    let potential = match limit.potential.is_zero() {
        true => quote!(T::zero()),
        false => writer.write(&limit.potential),
    };
    let mut own = momenta(d);
    if !limit.linear.is_zero() {
        for (value, e) in own.iter_mut().zip(&linear) {
            if !e.is_zero() {
                let shift = writer.operand(e);
                *value = quote!(#value - #shift);
            }
        }
    }
    let own = bundle.value(&own);
    let (dimension, coordinates) = (element::total(d), element::offset(d, bodies));
    quote! {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &#state #used) -> (T, T) {
            #parameters
            #locals
            let parts: #covectors = #own;
            let momentum = #stacked;
            let mut inertia = SMatrix::<T, #dimension, #dimension>::zeros();
            #columns
            let velocity = solve_leading_or_nan(&inertia, &momentum, #coordinates);
            (momentum.dot(&velocity) * T::from_f64(0.5), #potential)
        }

        /// The physical energy at this node.
        pub fn energy(&self, state: &#state #used) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
    }
}

/// The physical energy: the kinetic energy of the limit, inverted for the momentum, and the
/// potential.
fn of_rotations(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
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
    let parts = momenta(d);
    let stacked = stack(d, quote!(parts));
    quote! {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &#state #used) -> (T, T) {
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
        pub fn energy(&self, state: &#state #used) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
    }
}
