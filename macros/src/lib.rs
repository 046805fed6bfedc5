//! The `model!` macro: tokens in, tokens out. All work is done by `clebsch_core`.

use proc_macro::TokenStream;

/// States a model and expands to its parameters, state, workspace, stepper, invariants and
/// derivation. The language is described in the documentation of the crate `clebsch`.
///
/// # Errors
/// Whatever is wrong with the model is a compile error on the tokens concerned, with the remedy.
#[proc_macro]
pub fn model(input: TokenStream) -> TokenStream {
    clebsch_core::pipeline::expand(input.into()).into()
}
