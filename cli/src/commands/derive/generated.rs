//! The files of `generated/` for one model: its derivation as Markdown and LaTeX, with citations, and the
//! emitted Rust. Their bytes are the same on every machine. A test checks that the committed files are up to
//! date.

mod calls;

use clebsch_core::Derivation;
use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::emit::{emit, refusal};
use clebsch_core::print::{Format, Style};
use proc_macro2::TokenStream;
use quote::quote;

/// Names and contents of the files.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn files(d: &Derivation, citations: Citations) -> Result<Vec<(String, String)>, String> {
    let printed = |format| printed_telling(d, format, Style::default().columns, citations, None);
    let note = "Written by `clebsch derive --write`. Do not edit.";
    Ok(vec![
        (
            "derivation.md".to_owned(),
            format!("<!-- {note} -->\n\n{}", printed(Format::Markdown)),
        ),
        (
            "derivation.tex".to_owned(),
            format!("% {note}\n{}", printed(Format::Latex)),
        ),
        (
            "stepper.rs".to_owned(),
            format!("// {note}\n\n{}", rust(d)?),
        ),
    ])
}

/// The emitted module as a separate file, formatted, without the derivation in its documentation.
///
/// # Errors
/// The reason why no stepper is emitted for the model.
pub fn rust(d: &Derivation) -> Result<String, String> {
    if let Some(refused) = refusal(d) {
        return Err(refused.text());
    }
    formatted(of_module(emit(d, false)))
}

/// A whole file of items, formatted.
///
/// # Errors
/// If the tokens are not Rust items, which emission never produces.
pub fn formatted(tokens: TokenStream) -> Result<String, String> {
    let file: syn::File = syn::parse2(tokens).map_err(|e| e.to_string())?;
    Ok(calls::with_calls(&prettyplease::unparse(&file)))
}

/// The content of the emitted module as a file. The attributes of the module, such as its documentation, become
/// inner attributes of the file.
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
