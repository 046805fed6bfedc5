//! The velocities of a block as stacked numbers. A rotation is represented by the vector `v` of its Cayley transform
//! `Ω = (Id - hat(v)/2)^-1 (Id + hat(v)/2)`. Derivatives are along `Ω hat(η)`; the runtime converts `η` to changes of
//! `v`.

use super::locals::StatedLetter;
use super::{Moving, number};
use crate::emit::expression::Bindings;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr};
use proc_macro2::TokenStream;
use quote::quote;

impl Moving<'_> {
    /// Its velocity, read from the stacked numbers `all` starting at `row`. If the velocities of all sites are solved
    /// together, the rotations are available (`known`).
    pub(super) fn velocity(&self, all: &TokenStream, row: usize, known: bool) -> TokenStream {
        let (row, rows) = (number(row), number(self.components()));
        match (self.is_number(), self.is_rotation()) {
            (true, _) => quote!(#all[#row]),
            (_, true) if known => quote!(#all.turn(#row)),
            (_, true) => quote!(line::turn_of(&#all.fixed_rows::<3>(#row).into_owned())),
            _ => quote!(#all.fixed_rows::<#rows>(#row).into_owned()),
        }
    }
}

/// The number of columns of an expression.
pub(super) fn width(e: &Expr) -> usize {
    match e.shape().cols {
        Dim::Fixed(n) => usize::try_from(n).unwrap_or(1),
        Dim::Named(_) => 1,
    }
}

/// A value as an array; a number becomes an array of length one.
pub(super) fn as_array(e: &Expr, value: TokenStream) -> TokenStream {
    match e.shape().is_scalar() {
        true => quote!(SMatrix::<T, 1, 1>::new(#value)),
        false => value,
    }
}

/// `let` statements that extract the velocities in `letters` from a block, and their bindings.
pub(super) fn taken_apart(
    members: &[Moving],
    letters: &[StatedLetter],
    bindings: &mut Bindings,
    known: bool,
) -> TokenStream {
    let mut row = 0;
    let mut out = TokenStream::new();
    for o in members {
        let d = o.outline();
        let c = &d.spec.configurations[o.mover.index];
        let letter = expr::Letter {
            symbol: c.velocity,
            shift: expr::Shift::HERE,
        };
        let value = o.velocity(&quote!(velocity), row, known);
        row += o.components();
        if !letters.iter().any(|k| k.letter == letter) {
            continue;
        }
        let local = crate::emit::names::variable(&d.letters.symbols, c.velocity);
        out.extend(quote!(let #local = #value;));
        bindings.bind(letter, local);
    }
    out
}
