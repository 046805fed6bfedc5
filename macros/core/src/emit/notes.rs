//! The warnings of a model as warnings of rustc. Stable Rust gives a macro one way to warn: it emits the use of a
//! deprecated item. Here the item is a constant whose name is the topic and whose note is the warning, with the span
//! of the tokens concerned. `#[allow(deprecated)]` on an enclosing module silences the warnings.

use crate::derive::Derivation;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// One use of a deprecated constant for each warning.
pub(crate) fn notes(d: &Derivation) -> TokenStream {
    let all = d.warnings.iter().map(|w| {
        let name = w.topic.name().replace('-', "_");
        let declared = format_ident!("{name}");
        let mut used = declared.clone();
        used.set_span(w.diagnostic.place.first);
        let note = w.diagnostic.text();
        quote! {
            const _: () = {
                #[deprecated(note = #note)]
                #[allow(non_upper_case_globals)]
                const #declared: () = ();
                #used
            };
        }
    });
    all.collect()
}
