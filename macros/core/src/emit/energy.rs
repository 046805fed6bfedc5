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
    match (parts(d, limit).as_slice(), element::only_rotations(d)) {
        ([_, _, ..], _) => in_parts(d, names, limit),
        (_, true) => of_rotations(d, names, limit),
        (_, false) => of_matrices(d, names, limit),
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

/// Configurations whose velocities stand in one another's momenta: each such part of the kinetic
/// energy is inverted by itself.
fn parts(d: &Derivation, limit: &Limit) -> Vec<Vec<usize>> {
    let s = &d.letters.symbols;
    let letter = |i: usize| at(d.letters.variation[i], Shift::HERE);
    let count = d.spec.configurations.len();
    let all = || vec![(0..count).collect()];
    // Work arrays of named sizes are as large as the largest: one for all.
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

/// The configurations of one part: what the emission of a model asks of all.
fn part_of(whole: &mut Derivation, d: &Derivation, members: &[usize]) {
    let pick = |list: &[crate::expr::symbol::SymbolId]| members.iter().map(|i| list[*i]).collect();
    let configurations = members.iter().map(|i| d.spec.configurations[*i].clone());
    whole.spec.configurations = configurations.collect();
    whole.letters.variation = pick(&d.letters.variation);
    whole.letters.direction = pick(&d.letters.direction);
}

/// `energies` and `energy`, the kinetic energy part by part.
fn in_parts(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let needed = letters_of([&limit.kinetic, &limit.linear, &limit.potential]);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let twice = twice_kinetic(d, &bindings, limit, &momenta(d));
    let potential = potential(d, &bindings, limit);
    let body = quote! {
        #parameters
        #locals
        #twice
        (twice * T::from_f64(0.5), #potential)
    };
    both(d, body)
}

/// Twice the kinetic energy in the local `twice`, part by part, at momenta that are given by tokens.
pub(super) fn twice_kinetic(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    momenta: &[TokenStream],
) -> TokenStream {
    twice_kinetic_of(d, bindings, limit, momenta, &|_| true)
}

/// The same of the configurations that are `wanted`, which share theirs with no others.
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
        let inverted = match element::only_rotations(&part) {
            true => rotations(&part, bindings, limit, own),
            false => matrices(&part, bindings, limit, own),
        };
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

/// The functions around what is computed.
fn both(d: &Derivation, body: TokenStream) -> TokenStream {
    let state = item(d, "State");
    let used = Generics::of(d).used();
    quote! {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
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

/// The momenta along each configuration, of a form in the velocities.
fn gradients(d: &Derivation, e: &Expr) -> Vec<Expr> {
    let s = &d.letters.symbols;
    let list = d.spec.configurations.iter().zip(&d.letters.variation);
    list.map(|(c, xi)| {
        let y = expr::gradient(s, e, at(*xi, Shift::HERE));
        c.group.of_gradient(s, y)
    })
    .collect()
}

fn of_matrices(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let (kinetic, linear) = (gradients(d, &limit.kinetic), gradients(d, &limit.linear));
    let needed = letters_of(kinetic.iter().chain(&linear).chain([&limit.potential]));
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let inverted = matrices(d, &bindings, limit, momenta(d));
    let potential = potential(d, &bindings, limit);
    let body = quote! {
        #parameters
        #locals
        #inverted
        (momentum.dot(&velocity) * T::from_f64(0.5), #potential)
    };
    both(d, body)
}

/// The inertia column by column: the momentum of each unit velocity is the gradient of the kinetic
/// energy, which costs less than the form on all pairs.
pub(super) fn matrices(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    mut own: Vec<TokenStream>,
) -> TokenStream {
    let s = &d.letters.symbols;
    let bodies = d.spec.configurations.len();
    let bundle = Bundle::of(d);
    let covectors = element::covectors(d);
    let (kinetic, linear) = (gradients(d, &limit.kinetic), gradients(d, &limit.linear));
    let p = schedule::program(s, &kinetic, "t");
    let (lets, values) = program(&p, bindings);
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
        bindings,
    };
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
        let parts: #covectors = #own;
        let momentum = #stacked;
        let mut inertia = SMatrix::<T, #dimension, #dimension>::zeros();
        #columns
        let velocity = solve_leading_or_nan(&inertia, &momentum, #coordinates);
    }
}

fn of_rotations(d: &Derivation, names: &Names, limit: &Limit) -> TokenStream {
    let (form, linear) = forms(d, limit);
    let needed = letters_of([&form, &linear, &limit.potential]);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let inverted = rotations(d, &bindings, limit, momenta(d));
    let potential = potential(d, &bindings, limit);
    let body = quote! {
        #parameters
        #locals
        #inverted
        (momentum.dot(&velocity) * T::from_f64(0.5), #potential)
    };
    both(d, body)
}

/// B(ξ, η), with B(ξ, ξ)/2 the kinetic energy, and what is linear in the velocity.
fn forms(d: &Derivation, limit: &Limit) -> (Expr, Expr) {
    let s = &d.letters.symbols;
    let pairs = d.letters.variation.iter().zip(&d.letters.direction);
    let along: Vec<(Letter, Expr)> = pairs
        .map(|(xi, eta)| (at(*xi, Shift::HERE), expr::here(s, *eta)))
        .collect();
    let form = expr::directional(s, &limit.kinetic, &along);
    (form, expr::directional(s, &limit.linear, &along))
}

/// The kinetic energy of the limit, inverted for the momentum.
fn rotations(
    d: &Derivation,
    bindings: &Bindings,
    limit: &Limit,
    own: Vec<TokenStream>,
) -> TokenStream {
    let s = &d.letters.symbols;
    let bodies = d.spec.configurations.len();
    let (count, dimension) = (
        Literal::usize_unsuffixed(bodies),
        Literal::usize_unsuffixed(3 * bodies),
    );
    let (form, linear) = forms(d, limit);
    let writer = Writer {
        symbols: s,
        bindings,
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
    let form = writer.write(&form);
    let shift = (!limit.linear.is_zero()).then(|| {
        let linear = writer.write(&linear);
        quote! {
            - SVector::<T, #dimension>::from_fn(|i, _| { #eta_i #linear })
        }
    });
    let stacked = stack(d, quote!(parts));
    quote! {
        let parts: [SVector<T, 3>; #count] = [#(#own),*];
        let momentum: SVector<T, #dimension> = #stacked #shift;
        let inertia = SMatrix::<T, #dimension, #dimension>::from_fn(|i, j| {
            #xi
            #eta
            #form
        });
        let velocity = solve_or_nan(&inertia, &momentum);
    }
}
