//! The whole way from text to derivation, one line a stage.

use crate::check;
use crate::derive::{self, Derivation};
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::emit;
use crate::syntax;
use proc_macro2::{TokenStream, TokenTree};

/// Derives the model that the tokens state.
pub fn derive_tokens(tokens: TokenStream) -> Result<Derivation, Errors> {
    let model = syntax::parse(tokens)?;
    let spec = check::check(&model)?;
    derive::derive(spec)
}

/// Derives the model that a text states: the same, outside a compiler. The text is a bare
/// `model NAME { ... }`, or Rust source that holds one `model! { ... }`.
pub fn derive_source(source: &str) -> Result<Derivation, Errors> {
    let model = syntax::parse(invocation(syntax::tokens(source)?)?)?;
    let spec = check::check(&model)?;
    derive::derive(spec)
}

/// The Rust items of a model, or compile errors on its tokens and empty items of the same names,
/// so that one mistake does not cause more.
pub fn expand(tokens: TokenStream) -> TokenStream {
    let derived = derive_tokens(tokens.clone()).and_then(|d| match emit::refusal(&d) {
        Some(refused) => Err(refused.into()),
        None => Ok(d),
    });
    match derived {
        Ok(d) => {
            let mut items = emit::emit(&d, true);
            items.extend(emit::notes(&d));
            items
        }
        Err(errors) => emit::fallback(&tokens, &errors),
    }
}

/// The inside of the only `model! { ... }` of a Rust source, or the tokens as they are.
fn invocation(tokens: TokenStream) -> Result<TokenStream, Errors> {
    let trees: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let mut found: Option<TokenStream> = None;
    for window in trees.windows(3) {
        let [
            TokenTree::Ident(name),
            TokenTree::Punct(bang),
            TokenTree::Group(group),
        ] = window
        else {
            continue;
        };
        if name != "model" || bang.as_char() != '!' {
            continue;
        }
        if found.replace(group.stream()).is_some() {
            let second =
                Diagnostic::new(Place::token(name.span()), "the file holds several models");
            return Err(second.help("put each model into a file of its own").into());
        }
    }
    Ok(found.unwrap_or(tokens))
}
