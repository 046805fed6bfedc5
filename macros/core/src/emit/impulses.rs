//! Momenta by which invariants are measured: of a body at equilibrium, impulses that cancel leave their rounding as its
//! momentum, which is no scale.
//! Takes the derivation; gives a state whose momenta are not less than the impulses of its node.

use super::expression::{Bindings, program};
use super::items::{letters_of, parameter_locals, with_transports};
use super::names::{Names, per_configuration, variable};
use super::sizes::size;
use super::step::{at, here};
use crate::derive::Derivation;
use crate::derive::balance::Balance;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Some rows of a momentum, and the size of the impulse that they get at a node.
struct Impulse {
    configuration: usize,
    rows: TokenStream,
    size: Expr,
}

/// What has a value at a node whose state is known.
fn stands(role: Role) -> bool {
    matches!(
        role,
        Role::Step | Role::Parameter | Role::Element | Role::Advected
    )
}

/// The two parts of the impulse of a balance at its node, where they depend on what stands there alone; letters of
/// reactions are put to `rest`.
pub(super) fn at_node(s: &Symbols, rest: &[(Letter, Expr)], b: &Balance) -> Vec<Expr> {
    let stands_at_node = |e: &Expr| {
        let letters = expr::letters(e);
        !letters.is_empty()
            && letters
                .iter()
                .all(|l| l.shift == Shift::HERE && stands(s.get(l.symbol).role))
    };
    let arrived = expr::shift_time(s, &b.node_in, -Shift::NEXT.time);
    [b.node_out.clone(), arrived]
        .iter()
        .map(|e| expr::substitute(s, e, rest))
        .filter(stands_at_node)
        .collect()
}

/// The impulses that what stands at a node gives, where they depend on nothing else.
fn impulses(d: &Derivation) -> Vec<Impulse> {
    let s = &d.letters.symbols;
    // Reactions of what is held balance the rest: they are as large.
    let multipliers: Vec<(Letter, Expr)> = d
        .spec
        .holds
        .iter()
        .flat_map(|hold| {
            [Shift::HERE, Shift::NEXT].map(|shift| (at(hold.multiplier, shift), expr::integer(0)))
        })
        .collect();
    let mut all = Vec::new();
    for (configuration, (c, b)) in d.spec.configurations.iter().zip(&d.balances).enumerate() {
        let parts = at_node(s, &multipliers, b);
        let mut push = |rows, of: &dyn Fn(&Expr) -> Expr| {
            let sizes = parts
                .iter()
                .map(|e| expr::magnitude_by_differences(s, &of(e)));
            let sizes: Vec<Expr> = sizes.filter(|e| !e.is_zero()).collect();
            if !sizes.is_empty() {
                all.push(Impulse {
                    configuration,
                    rows,
                    size: expr::sum(sizes, expr::shape::Shape::SCALAR),
                });
            }
        };
        match c.group.rigid() {
            None => {
                let whole = size(s, c.group.variation().0.rows);
                push(quote!((0, #whole)), &Expr::clone);
            }
            Some(rigid) => {
                for (at, count) in rigid.rows() {
                    let (from, rows) = (Literal::u8_unsuffixed(at), size(s, count));
                    let of = |e: &Expr| expr::taken_rows(s, e, at, count);
                    push(quote!((#from, #rows)), &of);
                }
            }
        }
    }
    all
}

/// `state`, its momenta not less than such impulses.
pub(super) fn not_less_than_impulses(d: &Derivation, names: &Names) -> TokenStream {
    let all = impulses(d);
    if all.is_empty() {
        return TokenStream::new();
    }
    let sizes: Vec<Expr> = all.iter().map(|i| i.size.clone()).collect();
    let needed = letters_of(&sizes);
    let mut bindings = Bindings::new();
    let parameters = parameter_locals(d, quote!(self.parameters), &with_transports(d, &needed, 0));
    let locals = here(d, names, &needed, &mut bindings);
    let p = schedule::program(&d.letters.symbols, &sizes, "t");
    let (lets, values) = program(&p, &bindings);
    let step = variable(&d.letters.symbols, d.spec.step);
    let step = (step != "h").then(|| quote!(let #step = h;));
    let enlarged = names.local("enlarged");
    let taken = all.iter().zip(values).map(|(impulse, value)| {
        let (field, rows) = (
            per_configuration(d, "momentum", impulse.configuration),
            &impulse.rows,
        );
        let kept = super::element::kept_name(d, impulse.configuration);
        quote!(#enlarged.#field = #kept(not_less(#enlarged.#field.0, #rows, #value));)
    });
    quote! {
        let mut #enlarged = *state;
        {
            type T = f64;
            #step
            #parameters
            #locals
            #lets
            #(#taken)*
        }
        let state = &#enlarged;
    }
}
