//! Velocities of a block as they are found: numbers one below the other, a rotation by the vector `v` of its Cayley
//! transform `Ω = (Id - hat(v)/2)^-1 (Id + hat(v)/2)`. What is derived along `Ω hat(η)` is turned into derivatives by `v`.

use super::locals::Known;
use super::{Moving, number};
use crate::emit::expression::Bindings;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

impl Moving<'_> {
    /// Its velocity in the stacked numbers `all`, where its own begin at `row`.
    pub(super) fn velocity(&self, all: &TokenStream, row: usize) -> TokenStream {
        let (row, rows) = (number(row), number(self.components()));
        match (self.is_number(), self.is_rotation()) {
            (true, _) => quote!(#all[#row]),
            (_, true) => quote!(line::turn_of(&#all.fixed_rows::<3>(#row).into_owned())),
            _ => quote!(#all.fixed_rows::<#rows>(#row).into_owned()),
        }
    }

    /// Of a rotation the matrix from changes of `v` to `η`.
    pub(super) fn rate(&self, all: &TokenStream, row: usize) -> Option<TokenStream> {
        let row = number(row);
        self.is_rotation()
            .then(|| quote!(line::rate_of(&#all.fixed_rows::<3>(#row).into_owned())))
    }

    /// The name of that matrix, of a site of the kernel.
    pub(super) fn rate_name(&self, site: usize) -> Ident {
        format_ident!("__rate_{}_{}", self.mover.name, site)
    }

    /// A block of derivatives by its velocity at a site, as it is put into those by the numbers found.
    pub(super) fn by_numbers(&self, value: &TokenStream, site: usize) -> TokenStream {
        let rate = self.rate_name(site);
        match self.is_rotation() {
            true => quote!((#value) * #rate),
            false => value.clone(),
        }
    }
}

/// How many columns an expression has.
pub(super) fn width(e: &Expr) -> usize {
    match e.shape().cols {
        Dim::Fixed(n) => usize::try_from(n).unwrap_or(1),
        Dim::Named(_) => 1,
    }
}

/// A value as an array: numbers are put into one.
pub(super) fn as_array(e: &Expr, value: TokenStream) -> TokenStream {
    match e.shape().is_scalar() {
        true => quote!(SMatrix::<T, 1, 1>::new(#value)),
        false => value,
    }
}

/// Lets that take the velocities of a block apart, those among `letters`, and their bindings.
pub(super) fn taken_apart(
    members: &[Moving],
    letters: &[Known],
    bindings: &mut Bindings,
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
        let value = o.velocity(&quote!(velocity), row);
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
