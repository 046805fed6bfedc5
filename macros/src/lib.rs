//! The `model!` macro, a thin wrapper around `clebsch_core`.

use proc_macro::TokenStream;

/// Declares a model and expands to its parameters, state, workspace, stepper, invariants and derivation. The
/// documentation of the crate `clebsch` describes the language.
///
/// # Errors
/// A mistake in the model is a compile error at its tokens, with a suggested fix.
#[proc_macro]
pub fn model(input: TokenStream) -> TokenStream {
    clebsch_core::pipeline::expand(input.into()).into()
}
