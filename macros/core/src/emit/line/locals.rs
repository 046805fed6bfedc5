//! The locals with which a kernel begins: what its expressions read of parameters and places.

use super::{Lines, number};
use crate::derive::Outline;
use crate::derive::transport::Transport;
use crate::emit::expression::Bindings;
use crate::emit::names::{local_name, variable};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::lattice::Kind;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// A letter as stated: the quantity, and how many sites on from the site of the kernel.
pub(super) struct Known {
    pub letter: Letter,
    pub of: String,
    pub on: Option<usize>,
}

/// Where places at the node and at the next one are found.
pub(super) struct Places {
    pub here: TokenStream,
    pub next: TokenStream,
}

impl Lines<'_> {
    /// Lets for letters, and their bindings. `site` is the index of the kernel.
    pub(super) fn locals(
        &self,
        s: &Symbols,
        letters: &[Known],
        places: &Places,
        site: &TokenStream,
    ) -> (TokenStream, Bindings) {
        let mut bindings = Bindings::new();
        let mut out = TokenStream::new();
        let mut used = Vec::new();
        for known in letters {
            let symbol = s.get(known.letter.symbol);
            if symbol.role == Role::Step || symbol.role == Role::Velocity {
                continue;
            }
            let field = format_ident!("{}", known.of);
            let index = match known.on {
                None => None,
                Some(0) => Some(site.clone()),
                Some(n) => {
                    let n = number(n);
                    Some(quote!(#site + #n))
                }
            };
            let stated = self.line.lattice.find(&known.of).map(|q| q.kind);
            let base = local_name(s, &known.of).to_string();
            let base = match (known.on, known.letter.shift.time) {
                (None | Some(0), 0) => base,
                (None | Some(0), _) => format!("{base}_next"),
                (Some(n), 0) => format!("{base}_{n}"),
                (Some(n), _) => format!("{base}_{n}_next"),
            };
            let name = self.unique(&known.of, &base, &mut used);
            let value = match (stated, index) {
                (Some(Kind::Configuration), Some(index)) => {
                    let at = match known.letter.shift.time {
                        0 => &places.here,
                        _ => &places.next,
                    };
                    let rotation = self
                        .moving()
                        .any(|m| m.mover.name == known.of && m.is_rotation());
                    match (rotation, symbol.shape.is_scalar()) {
                        (true, _) => quote!(#at.#field[#index].matrix()),
                        (_, true) => quote!(#at.#field[#index][0]),
                        _ => quote!(#at.#field[#index]),
                    }
                }
                (Some(_), Some(index)) => quote!(self.parameters.#field[#index]),
                _ => quote!(self.parameters.#field),
            };
            out.extend(quote!(let #name = #value;));
            bindings.bind(known.letter, name);
        }
        (out, bindings)
    }

    /// The letters of expressions of one site.
    pub(super) fn of_site(&self, d: &Outline, list: &[Expr]) -> Vec<Known> {
        let s = &d.letters.symbols;
        let letters = crate::emit::items::letters_of(list);
        let known = letters.into_iter().map(|letter| {
            let of = s.get(letter.symbol).name.clone();
            let on = self.line.lattice.find(&of).map(|_| 0);
            Known { letter, of, on }
        });
        known.collect()
    }
}

/// With advected quantities by the configurations that carry them, at both ends of the edge.
pub(super) fn defined(d: &Outline, e: &Expr) -> Expr {
    let s = &d.letters.symbols;
    let mut list: Vec<(Letter, Expr)> = Vec::new();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        if let Transport::Defined(value) = t {
            for time in [0, 1] {
                let shift = Shift {
                    time,
                    ..Shift::HERE
                };
                let letter = Letter {
                    symbol: a.quantity,
                    shift,
                };
                list.push((letter, expr::shift_time(s, value, time)));
            }
        }
    }
    expr::substitute(s, e, &list)
}

/// The name of the step as a local.
pub(super) fn step(d: &Outline) -> proc_macro2::Ident {
    variable(&d.letters.symbols, d.spec.step)
}
