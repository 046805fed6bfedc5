//! Functionals as calls of methods of the model's own: `f.value(&x, &y)`, `f.along_1(&x, &y, &u)` and
//! `f.pull_back_1(&x, &y, &s)`. Arguments are counted from 1, and each derivative has a method of its own,
//! since the types of directions and seeds differ.

#[cfg(test)]
mod tests;

use super::expression::Writer;
use super::names::local_name;
use crate::expr::symbol::Symbols;
use crate::expr::{Applied, Expr, Reach};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// What the model is given by paths, under its names in the model. Not used where a model holds none of its
/// values, as by a factor of zero.
pub(super) fn paths(s: &Symbols) -> TokenStream {
    let at_points = s.functionals().iter().filter(|f| f.reach == Reach::Point);
    let each = at_points.filter_map(|f| {
        let name = local_name(s, &f.name);
        let path = path(&f.path)?;
        Some(quote!(#[allow(unused_imports)] use #path as #name;))
    });
    each.collect()
}

/// A path of Rust, from the root of a crate.
pub(super) fn path(text: &str) -> Option<TokenStream> {
    let own = ["crate", "self", "super"].contains(&text.split("::").next()?);
    let path = match own {
        true => text.to_owned(),
        false => format!("::{text}"),
    };
    path.parse().ok()
}

impl Writer<'_> {
    /// The call: arguments, then directions by their arguments, then the seed.
    pub(super) fn functional(&self, a: &Applied, back: Option<(u8, &Expr)>) -> TokenStream {
        let f = local_name(self.symbols, &self.symbols.functional(a.functional).name);
        let mut along: Vec<&(u8, Expr)> = a.along.iter().collect();
        along.sort_by_key(|(which, _)| *which);
        let mut method = match back {
            Some((which, _)) => format!("pull_back_{}", u32::from(which) + 1),
            None if along.is_empty() => "value".to_owned(),
            None => String::new(),
        };
        for (i, (which, _)) in along.iter().enumerate() {
            let word = match (i, method.is_empty()) {
                (0, true) => "along",
                (0, false) => "_along",
                _ => "",
            };
            method.push_str(&format!("{word}_{}", u32::from(*which) + 1));
        }
        let method = format_ident!("{method}");
        let directions = along.into_iter().map(|(_, x)| x);
        let all = a.arguments.iter().chain(directions);
        let all = all.chain(back.map(|(_, seed)| seed));
        let all = all.map(|x| self.by_reference(x));
        quote!(#f.#method(#(#all),*))
    }
}
