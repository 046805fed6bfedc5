//! The files of `generated/` for one model: its derivation as Markdown and LaTeX, and the emitted
//! Rust. The same bytes on every machine; a test checks that the committed ones are these.

use crate::derive::Derivation;
use crate::document::printed;
use crate::emit::emit;
use crate::pretty::pretty;
use crate::print::Format;
use proc_macro2::TokenStream;
use quote::quote;

/// Names and contents of the files.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn files(d: &Derivation) -> Result<Vec<(String, String)>, String> {
    let note = "Written by `clebsch derive --write`. Do not edit.";
    Ok(vec![
        (
            "derivation.md".to_owned(),
            format!("<!-- {note} -->\n\n{}", printed(d, Format::Markdown)),
        ),
        (
            "derivation.tex".to_owned(),
            format!("% {note}\n{}", printed(d, Format::Latex)),
        ),
        (
            "stepper.rs".to_owned(),
            format!("// {note}\n\n{}", rust(d)?),
        ),
    ])
}

/// The emitted module as a file of its own, formatted, without the derivation in its documentation.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn rust(d: &Derivation) -> Result<String, String> {
    if let Some(refused) = crate::emit::refusal(d) {
        return Err(refused.text());
    }
    pretty(of_module(emit(d, false)))
}

/// What stands inside the module that is emitted, as the file of that module: its documentation and what it
/// allows are those of the file.
fn of_module(emitted: TokenStream) -> TokenStream {
    let Ok(file) = syn::parse2::<syn::File>(emitted.clone()) else {
        return emitted;
    };
    let module = file.items.into_iter().find_map(|item| match item {
        syn::Item::Mod(module) => Some(module),
        _ => None,
    });
    let Some(syn::ItemMod {
        mut attrs,
        content: Some((_, items)),
        ..
    }) = module
    else {
        return emitted;
    };
    for attribute in &mut attrs {
        attribute.style = syn::AttrStyle::Inner(syn::token::Not::default());
    }
    quote!(#(#attrs)* #(#items)*)
}
