//! The warnings of a model as warnings of rustc. Stable Rust lets a macro warn in one way only: it
//! emits the use of a deprecated item, here a constant whose name is the topic and whose note is
//! the warning, on the tokens concerned. `#[allow(deprecated)]` on a module around silences them.

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
