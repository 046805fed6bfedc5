//! `balance`: the residual of the discrete Euler-Lagrange equations at three consecutive configurations, which need
//! not be a solution. Oracles compare it with the variation of the action.

use super::element::{self, stacked};
use super::expression::{Bindings, program, ty};
use super::items::{kept, letters_of, node_locals, parameter_locals, with_transports};
use super::names::{Names, item, own, tagged, variable};
use super::sizes::Generics;
use super::step::at;
use crate::derive::Derivation;
use crate::expr::Shift;
use proc_macro2::TokenStream;
use quote::quote;

/// The configuration struct and the method.
pub fn balance(d: &Derivation, names: &Names) -> [TokenStream; 2] {
    let s = &d.letters.symbols;
    let configuration = item(d, "Configuration");
    let elements = d.spec.configurations.iter().enumerate().map(|(i, c)| {
        let (e, kind) = (own(d, c.element), element::ty(d, i));
        let doc = match c.group.is_additive() {
            true => format!(" `{e}` at the node."),
            false => format!(" `{e}` at the node: body -> space."),
        };
        quote!(#[doc = #doc] pub #e: #kind)
    });
    let others = kept(d).into_iter().map(|id| {
        let (field, t) = (own(d, id), ty(s, s.get(id).shape));
        let doc = format!(" `{field}` at the node, evolved by its constraint.");
        quote!(#[doc = #doc] pub #field: #t)
    });
    let multipliers = d.spec.holds.iter().map(|hold| {
        let (field, t) = (own(d, hold.multiplier), ty(s, s.get(hold.multiplier).shape));
        let doc = format!(" `{field}`, the multiplier of the step that starts at the node.");
        quote!(#[doc = #doc] pub #field: #t)
    });
    let multipliers: Vec<TokenStream> = multipliers.collect();
    let p = d.residual_program();
    let needed = letters_of(p.temporaries.iter().map(|(_, e)| e).chain(&p.results));
    let mut all = Vec::new();
    let mut bindings = Bindings::new();
    let mut locals = TokenStream::new();
    let (before, here, after) = (
        names.local("before"),
        names.local("here"),
        names.local("after"),
    );
    for (level, source) in [(-1i8, &before), (0, &here), (1, &after)] {
        all.extend(with_transports(d, &needed, level));
        let element = |i: usize| {
            let c = &d.spec.configurations[i];
            let e = own(d, c.element);
            element::matrix(c, quote!(#source.#e))
        };
        // Quantities without a definition are arguments at every node.
        let mut given = TokenStream::new();
        for id in kept(d) {
            let local = match level {
                0 => variable(s, id),
                1 => tagged(d, names, id, "next"),
                _ => tagged(d, names, id, "before"),
            };
            let field = own(d, id);
            let letter = at(
                id,
                Shift {
                    time: level,
                    label: [0, 0],
                },
            );
            given.extend(quote!(let #local = #source.#field;));
            bindings.bind(letter, local);
        }
        let undefined = kept(d);
        let defined: Vec<_> = needed
            .iter()
            .filter(|l| !undefined.contains(&l.symbol))
            .copied()
            .collect();
        let reference = |_| TokenStream::new();
        let found = node_locals(
            d,
            names,
            level,
            &defined,
            &element,
            &reference,
            &mut bindings,
        );
        locals.extend(quote!(#given #found));
    }
    let mut velocities = TokenStream::new();
    for c in &d.spec.configurations {
        let e = own(d, c.element);
        for (level, from, to) in [(-1i8, &before, &here), (0, &here, &after)] {
            let local = if level == 0 {
                variable(s, c.velocity)
            } else {
                tagged(d, names, c.velocity, "before")
            };
            let velocity = element::velocity_between(c);
            let value = quote!(#from.#e.#velocity(&#to.#e));
            let value = element::matrix(c, value);
            velocities.extend(quote!(let #local = #value;));
            bindings.bind(
                at(
                    c.velocity,
                    Shift {
                        time: level,
                        label: [0, 0],
                    },
                ),
                local,
            );
        }
    }
    for hold in &d.spec.holds {
        let (field, local) = (own(d, hold.multiplier), variable(s, hold.multiplier));
        velocities.extend(quote!(let #local = #here.#field;));
        bindings.bind(at(hold.multiplier, Shift::HERE), local);
    }
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let (lets, values) = program(&p, &bindings);
    let dimension = element::total(d);
    let stacked = stacked(d, &values);
    let step = variable(s, d.spec.step);
    let g = Generics::of(d);
    let (declared, used) = (g.declared(), g.used());
    let components = components(d);
    let data = quote! {
        /// A configuration at one node; it need not lie on a solution.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #configuration #declared { #(#elements,)* #(#others,)* #(#multipliers,)* }
    };
    let function = quote! {
        /// The residual of the discrete Euler-Lagrange equations at the middle of three
            #(#[doc = #components])*
            pub fn balance(
                &self,
                #step: T,
                #before: &#configuration #used,
                #here: &#configuration #used,
                #after: &#configuration #used,
            ) -> SVector<T, #dimension> {
                #parameters
                #locals
                #velocities
                #lets
                #stacked
            }
    };
    [data, function]
}

/// The documentation of the components of the residual.
fn components(d: &Derivation) -> Vec<&'static str> {
    if element::only_rotations(d) {
        return vec![
            " consecutive configurations: component `i` is the derivative of the action of the",
            " two edges when the middle element is rotated about its axis `i` (a body axis on",
            " the body side, a space axis on the spatial side). Zero on solutions.",
        ];
    }
    vec![
        " consecutive configurations: components are derivatives of the action of the two edges",
        " along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for",
        " `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix",
        " units, row by row. Components beyond the coordinates are zero. Zero on solutions.",
    ]
}
