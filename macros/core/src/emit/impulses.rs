//! Momenta as scales of invariants. At equilibrium, impulses cancel, and the momentum is only their rounding error,
//! which is not a scale. Takes the derivation; gives a state whose momenta are at least as large as the impulses at
//! its node.

use super::expression::{Bindings, program};
use super::names::{Names, item, per_configuration, variable};
use super::sizes::size;
use super::step::at;
use crate::check::spec::{Configuration, Hold};
use crate::derive::Derivation;
use crate::derive::balance::Balance;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// Some rows of a momentum, and the size of their impulse at a node.
pub(super) struct Impulse {
    configuration: usize,
    rows: TokenStream,
    pub size: Expr,
}

/// Whether a symbol with this role has a value at a node once its state is known.
fn stands(role: Role) -> bool {
    matches!(
        role,
        Role::Step | Role::Parameter | Role::Element | Role::Advected
    )
}

/// The two parts of the impulse of a balance at its node, if they depend on quantities at that node only. The letters
/// of multipliers are replaced by `rest`.
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

/// The position of a constrained body has a relative rounding error of about 1e-16. A step corrects that error, and
/// the corrections leave a momentum even at equilibrium. The scale of that momentum is the momentum of a step from
/// the origin to the position, divided by this number. `not_less` uses that scale for momenta below 1e-9 of it, that
/// is, 1e-18 of the step, which is smaller than any correction.
const CORRECTED: i64 = 1_000_000_000;

/// The magnitude of the momentum of an edge from the origin to the position, divided by [`CORRECTED`]. None if no
/// constraint contains the configuration.
fn correction(
    d: &Derivation,
    configuration: usize,
    multipliers: &[(Letter, Expr)],
    edge: &Expr,
) -> Option<Expr> {
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[configuration];
    let is_held = |hold: &Hold| {
        let mut letters = expr::letters(&hold.value).into_iter();
        letters.any(|l| l.symbol == c.element)
    };
    if !d.spec.holds.iter().any(is_held) {
        return None;
    }
    let size = expr::magnitude(s, &expr::substitute(s, edge, multipliers));
    // At zero velocity: positions are the node's positions, and attitudes do not rotate.
    let at_rest = expr::letters(&size).into_iter().filter_map(|l| {
        let own = |c: &&Configuration| c.velocity == l.symbol;
        match d.spec.configurations.iter().find(own) {
            Some(c) if c.group.is_additive() => Some((l, expr::here(s, c.element))),
            Some(_) => Some((l, expr::identity(s.get(l.symbol).shape.rows))),
            None => (l.shift == Shift::NEXT).then(|| (l, expr::here(s, l.symbol))),
        }
    });
    let at_rest: Vec<(Letter, Expr)> = at_rest.collect();
    let size = expr::substitute(s, &size, &at_rest);
    let stands = expr::letters(&size)
        .iter()
        .all(|l| l.shift == Shift::HERE && stands(s.get(l.symbol).role));
    stands.then(|| expr::quotient(size, expr::integer(CORRECTED)))
}

/// The impulses at a node that depend only on quantities there, together with the corrections by constraints.
pub(super) fn impulses(d: &Derivation) -> Vec<Impulse> {
    let s = &d.letters.symbols;
    // Multipliers are set to zero: at equilibrium, the constraint forces are as large as the others.
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
            let corrections = correction(d, configuration, &multipliers, &of(&b.edge_out));
            let sizes: Vec<Expr> = sizes.chain(corrections).filter(|e| !e.is_zero()).collect();
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

/// Statements that replace `state` by a state whose momenta are at least as large as the impulses. `bindings` must
/// bind the letters of the impulses.
pub(super) fn not_less_than_impulses(
    d: &Derivation,
    names: &Names,
    all: &[Impulse],
    bindings: &Bindings,
) -> TokenStream {
    if all.is_empty() {
        return TokenStream::new();
    }
    let sizes: Vec<Expr> = all.iter().map(|i| i.size.clone()).collect();
    let p = schedule::program(&d.letters.symbols, &sizes, "s");
    let (lets, values) = program(&p, bindings);
    let step = variable(&d.letters.symbols, d.spec.step);
    let step = (step != "h").then(|| quote!(let #step = h;));
    let state = item(d, "State");
    let named: Vec<Ident> = (1..=all.len())
        .map(|n| match all {
            [_] => names.local("impulse"),
            _ => names.local(&format!("impulse{n}")),
        })
        .collect();
    let of: Vec<(&Impulse, &Ident)> = all.iter().zip(&named).collect();
    let taken = of.chunk_by(|(a, _), (b, _)| a.configuration == b.configuration);
    let taken = taken.map(|parts| {
        let configuration = parts[0].0.configuration;
        let field = per_configuration(d, "momentum", configuration);
        let kept = super::element::kept_name(d, configuration);
        let value = parts
            .iter()
            .fold(quote!(state.#field.0), |value, (part, size)| {
                let rows = &part.rows;
                quote!(not_less(#value, #rows, #size))
            });
        quote!(#field: #kept(#value),)
    });
    quote! {
        #step
        #lets
        #(let #named = #values;)*
        let state = &#state { #(#taken)* ..*state };
    }
}
