//! The signs of unit quaternions in neighbour terms, at the start of a trajectory.

use super::Lines;
use super::ends::{end_local, pattern, place};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Makes the signs of unit quaternions in neighbour terms agree from site to site, and with the values of end
/// conditions. The first end takes precedence over the last.
pub(super) fn agreed(l: &Lines) -> TokenStream {
    let ends = l.item("Ends");
    let mut out = TokenStream::new();
    for signs in &l.line.signs {
        let (name, text) = (format_ident!("{}", signs.of), &signs.of);
        out.extend(quote!(line::agree(&mut state.places.#name);));
        for last in [true, false] {
            let Some((ty, alternatives)) = l.alternatives(last) else {
                continue;
            };
            let field = if last { quote!(last) } else { quote!(first) };
            for wall in &signs.walls[usize::from(last)] {
                let Some(end) = alternatives.get(wall.which) else {
                    continue;
                };
                let pattern = pattern(&ty, end);
                let site = place(l, last, text, wall.site);
                let given = end_local(&wall.parameter);
                out.extend(quote! {
                    if let #ends::Open { #field: #pattern, .. } = self.sites.ends {
                        line::turn_towards(&mut state.places.#name, #site, &#given);
                    }
                });
            }
        }
        if signs.seen && l.line.lattice.periodic.is_some() {
            out.extend(quote! {
                if self.is_ring() {
                    line::closes(#text, &state.places.#name)?;
                }
            });
        }
    }
    out
}
