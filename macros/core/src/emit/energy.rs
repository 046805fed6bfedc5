//! The physical energy of a node: the potential energy, and the kinetic energy of the limit of small steps as a
//! function of the momentum. Takes the limit; gives `energies` and `energy`.

use super::element::{self, stacked};
use super::expression::{Bindings, Writer, program};
use super::items::letters_of;
use super::names::{Names, item, variable};
use super::sizes::Generics;
use super::step::{at, seen};
use crate::derive::Derivation;
use crate::derive::limit::Limit;
use crate::expr::{self, Expr, Shift};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// The functions `energies` and `energy`.
pub fn energy(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    match parts(d, limit).as_slice() {
        [_, _, ..] => in_parts(d, names, limit),
        _ => whole(d, names, limit),
    }
}

/// Each configuration's node momentum, in the frame of its side.
fn momenta(d: &Derivation) -> Vec<TokenStream> {
    let list = d.spec.configurations.iter().enumerate();
    list.map(|(i, c)| {
        let method = element::momentum_field(d, i, c.side);
        element::value(c, quote!(state.#method().0))
    })
    .collect()
}

/// Sets of configurations whose kinetic energies are independent: no momentum contains a velocity of another set.
/// Each set is inverted by itself.
fn parts(d: &Derivation, limit: &Limit) -> Vec<Vec<usize>> {
    let s = &d.letters.symbols;
    let letter = |i: usize| at(d.letters.variation[i], Shift::HERE);
    let count = d.spec.configurations.len();
    let all = || vec![(0..count).collect()];
    // Work arrays of named sizes have the largest size, so one array serves all configurations.
    if !d.spec.dimensions.is_empty() {
        return all();
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for i in 0..count {
        let momentum = expr::gradient(s, &limit.kinetic, letter(i));
        let holds = |j: &usize| expr::contains(&momentum, letter(*j));
        let (tied, apart): (Vec<_>, Vec<_>) =
            parts.into_iter().partition(|part| part.iter().any(holds));
        parts = apart;
        let mut own: Vec<usize> = tied.into_iter().flatten().chain([i]).collect();
        own.sort_unstable();
        parts.push(own);
    }
    parts.sort();
    parts
}

/// Restricts `whole` to the configurations of one part, in the fields that this module reads.
fn part_of(whole: &mut Derivation, d: &Derivation, members: &[usize]) {
    let pick = |list: &[crate::expr::symbol::SymbolId]| members.iter().map(|i| list[*i]).collect();
    let configurations = members.iter().map(|i| d.spec.configurations[*i].clone());
    whole.spec.configurations = configurations.collect();
    whole.letters.variation = pick(&d.letters.variation);
    whole.letters.direction = pick(&d.letters.direction);
}

/// `energies` and `energy`, with the kinetic energy computed part by part.
fn in_parts(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let needed = letters_of([&limit.kinetic, &limit.linear, &limit.potential]);
    let mut bindings = Bindings::new();
    let locals = seen(d, names, &needed, &mut bindings);
    let twice = twice_kinetic(d, &bindings, limit, &momenta(d));
    let potential = potential(d, &bindings, limit);
    let body = quote! {
        #locals
        #twice
        (twice * T::from_f64(0.5), #potential)
    };
    both(d, body)
}

/// Twice the kinetic energy as the local `twice`, computed part by part from `momenta`.
pub(super) fn twice_kinetic(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    momenta: &[TokenStream],
) -> TokenStream {
    twice_kinetic_of(d, bindings, limit, momenta, &|_| true)
}

/// Twice the kinetic energy of the `wanted` configurations, which must not share kinetic energy with others.
pub(super) fn twice_kinetic_of(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    momenta: &[TokenStream],
    wanted: &dyn Fn(usize) -> bool,
) -> TokenStream {
    let mut part = d.clone();
    let own = parts(d, limit).into_iter();
    let own = own.filter(|members| members.iter().any(|i| wanted(*i)));
    let each = own.map(|members| {
        part_of(&mut part, d, &members);
        let own = members.iter().map(|i| momenta[*i].clone()).collect();
        let inverted = matrices(&part, bindings, limit, own);
        quote!({ #inverted momentum.dot(&velocity) })
    });
    let kinetic: Vec<TokenStream> = each.collect();
    quote! {
        let mut twice = T::zero();
        #(twice += #kinetic;)*
    }
}

fn potential(d: &Derivation, bindings: &Bindings, limit: &Limit) -> TokenStream {
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings,
    };
    match limit.potential.is_zero() {
        true => quote!(T::zero()),
        false => writer.write(&limit.potential),
    }
}

/// The functions whose common body is `body`.
fn both(d: &Derivation, body: TokenStream) -> TokenStream {
    let state = item(d, "State");
    let used = Generics::of(d).used();
    quote! {
        /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
        pub fn energies(&self, state: &#state #used) -> (T, T) {
            #body
        }

        /// The physical energy at this node.
        pub fn energy(&self, state: &#state #used) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
    }
}

/// The momentum of each configuration, given a function of the velocities.
pub(super) fn gradients(d: &Derivation, e: &Expr) -> Vec<Expr> {
    let s = &d.letters.symbols;
    let list = d.spec.configurations.iter().zip(&d.letters.variation);
    list.map(|(c, xi)| {
        let y = expr::gradient(s, e, at(*xi, Shift::HERE));
        expr::term_by_term(&c.group.of_gradient(s, y))
    })
    .collect()
}

/// `energies` and `energy`, with one inertia matrix for all velocities.
fn whole(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let linear = gradients(d, &limit.linear);
    let needed = letters_of(linear.iter().chain([&limit.potential]));
    let mut bindings = Bindings::new();
    let locals = seen(d, names, &needed, &mut bindings);
    let momentum = momentum(d, &bindings, &linear, momenta(d));
    let potential = potential(d, &bindings, limit);
    let coordinates = element::offset(d, d.spec.configurations.len());
    let body = quote! {
        #locals
        #momentum
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, #coordinates);
        (momentum.dot(&velocity) * T::from_f64(0.5), #potential)
    };
    both(d, body)
}

/// The stacked momenta minus the part that is linear in the velocity in the Lagrangian, as the local `momentum`.
fn momentum(
    d: &Derivation,
    bindings: &Bindings,
    linear: &[Expr],
    mut own: Vec<TokenStream>,
) -> TokenStream {
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings,
    };
    for (value, e) in own.iter_mut().zip(linear) {
        if !e.is_zero() {
            let shift = writer.operand(e);
            *value = quote!(#value - #shift);
        }
    }
    let stacked = stacked(d, &own);
    quote!(let momentum = #stacked;)
}

/// The inertia at a state, as the last expression of a function.
pub(super) fn inertia_alone(d: &Derivation, bindings: &Bindings, kinetic: &[Expr]) -> TokenStream {
    let s = &d.letters.symbols;
    let fixed = d.spec.dimensions.is_empty();
    let (true, [xi]) = (fixed, d.letters.variation.as_slice()) else {
        let inertia = inertia(d, bindings, kinetic);
        return quote!(#inertia inertia);
    };
    let p = schedule::program(s, kinetic, "t");
    let (lets, values) = program(&p, bindings);
    let (name, along) = (variable(s, *xi), stacked(d, &values));
    let direction = element::basis(d, 0, quote!(axis));
    let t = super::expression::ty(s, s.get(*xi).shape);
    quote! {
        columns(|axis| {
            let #name: #t = #direction;
            #lets
            #along
        })
    }
}

/// The inertia as the local `inertia`, column by column. Each column is the gradient of the kinetic energy at a unit
/// velocity, which is cheaper than the form on all pairs.
pub(super) fn inertia(d: &Derivation, bindings: &Bindings, kinetic: &[Expr]) -> TokenStream {
    let s = &d.letters.symbols;
    let p = schedule::program(s, kinetic, "t");
    let (lets, values) = program(&p, bindings);
    let stacked = stacked(d, &values);
    let columns = (0..d.spec.configurations.len()).map(|j| {
        let directions = d.letters.variation.iter().enumerate().map(|(i, xi)| {
            let name = variable(s, *xi);
            let t = super::expression::ty(s, s.get(*xi).shape);
            let value = match i == j {
                true => element::basis(d, i, quote!(axis)),
                false if s.get(*xi).shape.is_scalar() => quote!(T::zero()),
                false => quote!(SMatrix::zeros()),
            };
            quote!(let #name: #t = #value;)
        });
        let count = element::coordinates(d, j);
        let column = match j {
            0 => quote!(axis),
            _ => {
                let offset = element::offset(d, j);
                quote!(#offset + axis)
            }
        };
        quote! {
            for axis in 0..#count {
                #(#directions)*
                #lets
                let along = #stacked;
                inertia.set_column(#column, &along);
            }
        }
    });
    let dimension = element::total(d);
    quote! {
        let mut inertia = SMatrix::<T, #dimension, #dimension>::zeros();
        #(#columns)*
    }
}

/// The momentum and the inertia as locals, to compute the kinetic energy from the momentum.
pub(super) fn matrices(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    own: Vec<TokenStream>,
) -> TokenStream {
    let momentum = momentum(d, bindings, &gradients(d, &limit.linear), own);
    let inertia = inertia(d, bindings, &gradients(d, &limit.kinetic));
    let coordinates = element::offset(d, d.spec.configurations.len());
    quote! {
        #momentum
        #inertia
        let velocity = solve_leading_or_nan(&inertia, &momentum, #coordinates);
    }
}
