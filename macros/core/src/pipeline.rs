//! The stages from text to derivation, one line per stage.

use crate::check::{
    self,
    spec::{CopyOf, Spec},
};
use crate::derive::{self, Derivation};
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::emit;
use crate::lattice::{self, ChainConfig, ExpandedModel, Lattice};
use crate::line::{self, Line};
use crate::syntax;
use crate::syntax::ast::Model;
use crate::work;
use proc_macro2::{TokenStream, TokenTree};

/// Derives the model that the tokens state.
pub fn derive_tokens(tokens: TokenStream) -> Result<Derivation, Errors> {
    derive_model(&syntax::parse(tokens)?)
}

/// Derives the model that a text states, outside a compiler, with the same result as the macro. The text is a bare
/// `model NAME { ... }`, or Rust source that contains one `model! { ... }`.
pub fn derive_source(source: &str) -> Result<Derivation, Errors> {
    derive_model(&parse_source(source)?)
}

/// The syntax tree of the model that a text states.
pub fn parse_source(source: &str) -> Result<Model, Errors> {
    syntax::parse(invocation(syntax::tokens(source)?)?)
}

/// Derives a model; one with labels on the shortest lattice that represents all longer lattices.
pub fn derive_model(model: &Model) -> Result<Derivation, Errors> {
    if lattice::has_labels(model) {
        let line = Lattice::read(model)?;
        let choice = representative(model, &line)?;
        return derive_lattice(model, &line, &choice).map(|(_, d)| d);
    }
    derive::derive(check::check(model)?)
}

/// The lattice on which the middle site and each end have all their neighbours.
pub fn representative(model: &Model, line: &Lattice) -> Result<ChainConfig, Errors> {
    let first = ChainConfig::representative(line, 1);
    let width = lattice::unfold(model, line, &first)?.width();
    Ok(ChainConfig::representative(line, width))
}

/// The work limit of a lattice as a multiple of the limit of an ordinary model: proportional to its number of copies,
/// because the work for each copy grows with their number.
fn room(unfolded: &ExpandedModel) -> u64 {
    (unfolded.copies.len() as u64 / 4).max(4)
}

/// Derives a model with labels for this number of sites and these end conditions.
pub fn derive_lattice(
    model: &Model,
    line: &Lattice,
    choice: &ChainConfig,
) -> Result<(ExpandedModel, Derivation), Errors> {
    let unfolded = lattice::unfold(model, line, choice)?;
    let _room = work::room(room(&unfolded));
    let spec = written_out(&unfolded, line, choice)?;
    let derived = derive::derive(spec).map_err(Errors::first_at_each_place)?;
    Ok((unfolded, derived))
}

/// Checks an expanded lattice, whose configurations store the quantity and site of which they are copies.
fn written_out(
    unfolded: &ExpandedModel,
    line: &Lattice,
    choice: &ChainConfig,
) -> Result<Spec, Errors> {
    let mut spec = check::check_written_out(&unfolded.model)?;
    let motionless = check::without_velocity(&spec);
    if let Some(first) = motionless.first() {
        let found = (*first, motionless.as_slice());
        return Err(unfolded.motionless(line, choice, &spec, found).into());
    }
    let mut families: Vec<(String, usize)> = Vec::new();
    for (i, c) in spec.configurations.iter_mut().enumerate() {
        let name = &spec.symbols.get(c.element).name;
        let Some(own) = unfolded.copy(name) else {
            continue;
        };
        let known = families.iter().find(|(of, _)| *of == own.of);
        let family = known.map_or(i, |(_, first)| *first);
        if family == i {
            families.push((own.of.clone(), i));
        }
        c.copy = Some(CopyOf {
            family,
            site: own.site,
        });
    }
    Ok(spec)
}

/// The first stages of the derivation of a lattice, see [`derive_lattice`].
pub fn outline_lattice(
    model: &Model,
    line: &Lattice,
    choice: &ChainConfig,
) -> Result<(ExpandedModel, derive::Outline), Errors> {
    let unfolded = lattice::unfold(model, line, choice)?;
    let _room = work::room(room(&unfolded));
    let spec = written_out(&unfolded, line, choice)?;
    let outline = derive::outline(spec).map_err(Errors::first_at_each_place)?;
    Ok((unfolded, outline))
}

/// The Rust items of a model, or compile errors on its tokens and empty items of the same names,
/// so that one mistake does not cause more.
pub fn expand(tokens: TokenStream) -> TokenStream {
    let text = tokens.to_string();
    let derived = syntax::parse(tokens.clone()).and_then(|model| {
        Ok(match lattice::has_labels(&model) {
            true => Emitted::Line(emitted_line(&model, &text)?),
            false => Emitted::Body(Box::new(emitted(&model)?)),
        })
    });
    match derived {
        Ok(Emitted::Line(items)) => items,
        Ok(Emitted::Body(d)) => {
            let mut items = emit::emit(&d, true);
            items.extend(emit::notes(&d));
            items
        }
        Err(errors) => emit::fallback(&tokens, &errors),
    }
}

/// The expansion of `model!`.
enum Emitted {
    /// The items of a model with labels.
    Line(TokenStream),
    /// The derivation of a model of bodies.
    Body(Box<Derivation>),
}

/// The items of a model with labels, for every number of sites.
///
/// # Errors
/// Mistakes of the model; that no such stepper is compiled, and why.
pub fn emitted_line(model: &Model, source: &str) -> Result<TokenStream, Errors> {
    match Line::of(model) {
        Ok(line) => match emit::refusal_of_line(&line) {
            None => Ok(emit::emit_line(&line, source)),
            Some(why) => Err(lattice::not_emitted(model, &why).into()),
        },
        Err(line::Refused::Model(errors)) => Err(errors),
        Err(line::Refused::Form(why)) => Err(lattice::not_emitted(model, &why).into()),
    }
}

/// The derivation of a model that has a stepper.
pub fn emitted(model: &Model) -> Result<Derivation, Errors> {
    let d = derive_model(model)?;
    match emit::refusal(&d) {
        Some(refused) => Err(refused.into()),
        None => Ok(d),
    }
}

/// The contents of the only `model! { ... }` in Rust source, otherwise the tokens unchanged.
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
            let second = Diagnostic::new(
                Place::token(name.span()),
                "the file contains several models",
            );
            return Err(second.help("put each model into a file of its own").into());
        }
    }
    Ok(found.unwrap_or(tokens))
}
