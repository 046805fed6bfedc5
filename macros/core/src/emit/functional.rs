//! The functionals that a model is given, by paths of Rust.

#[cfg(test)]
mod tests;

use super::names::local_name;
use crate::expr::Reach;
use crate::expr::symbol::Symbols;
use proc_macro2::TokenStream;
use quote::quote;

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
