//! The functionals and functions that a model names by Rust paths.

#[cfg(test)]
mod tests;

use super::names::local_name;
use crate::expr::Reach;
use crate::expr::symbol::Symbols;
use proc_macro2::TokenStream;
use quote::quote;

/// Imports of the functions of one point, under their names in the model. An import may be unused, for example if the
/// function is multiplied by zero.
pub(super) fn paths(s: &Symbols) -> TokenStream {
    let at_points = s.functionals().iter().filter(|f| f.reach == Reach::Point);
    let each = at_points.filter_map(|f| {
        let name = local_name(s, &f.name);
        let path = path(&f.path)?;
        Some(quote!(#[allow(unused_imports)] use #path as #name;))
    });
    each.collect()
}

/// A Rust path, starting at the root of a crate.
pub(super) fn path(text: &str) -> Option<TokenStream> {
    let own = ["crate", "self", "super"].contains(&text.split("::").next()?);
    let path = match own {
        true => text.to_owned(),
        false => format!("::{text}"),
    };
    path.parse().ok()
}
