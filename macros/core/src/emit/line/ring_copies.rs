//! The positions beyond the last site of a ring: copies of the first ones, plus the offset of the ring.

use super::{Lines, Moving, number};
use proc_macro2::TokenStream;
use quote::quote;

/// The function that sets the positions beyond the last site.
pub(super) fn around(l: &Lines, moving: &[Moving]) -> TokenStream {
    let places = l.item("Places");
    let beyond = number(l.line.beyond());
    if l.line.lattice.periodic.is_none() || l.line.beyond() == 0 {
        return quote! {
            /// There are no sites beyond the last one.
            #[inline]
            fn around(&self, _: &mut #places<T>) {}
        };
    }
    let lattice = &l.line.lattice;
    let offsets: Vec<String> = l.offsets().iter().map(|(n, _)| n.clone()).collect();
    let pattern = l.ring_pattern(&offsets);
    let each = moving.iter().filter_map(|m| {
        let q = lattice.find(&m.mover.name)?;
        if lattice.line != Some(q.label) {
            return None;
        }
        let (name, count) = (m.name(), l.count_of(&m.mover.name));
        let offset = q.offset.as_ref().map(|o| {
            let local = super::ends::end_local(&o.text);
            let value = m.array(quote!(#local));
            quote!(+ #value)
        });
        let repeated = match m.is_rotation() {
            true => quote!(at.#name.set(#count + i, at.#name.at(i));),
            false => quote!(at.#name[#count + i] = at.#name[i] #offset;),
        };
        Some(quote! {
            for i in 0..#beyond {
                #repeated
            }
        })
    });
    let each: Vec<TokenStream> = each.collect();
    quote! {
        /// Copies the first sites of a ring beyond its last site.
        #[inline]
        fn around(&self, at: &mut #places<T>) {
            if let #pattern = self.sites.ends {
                #(#each)*
            }
        }
    }
}
