//! Emitted tokens as formatted Rust source, for `generated/` and for readers.

use proc_macro2::TokenStream;

/// Formats a whole file of items.
///
/// # Errors
/// If the tokens are not Rust items, which emission never produces.
pub fn pretty(tokens: TokenStream) -> Result<String, String> {
    let file: syn::File = syn::parse2(tokens).map_err(|e| e.to_string())?;
    Ok(prettyplease::unparse(&file))
}
