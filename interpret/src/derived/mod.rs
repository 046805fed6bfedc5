//! The data of a derivation that a run needs: emitted programs as text, and words of cards. A run starts from this data,
//! whether the derivation has just been made or the cache has kept its data.

mod body;
mod chain;
mod json;
mod looped;
mod words;

pub(crate) use body::Body;
pub(crate) use chain::{Expanded, Short};
pub(crate) use looped::{Looped, Program as LoopProgram};

use crate::Refused;
use crate::cache::{Cache, Key};
use crate::program::Program;
use proc_macro2::TokenStream;
use serde_json::Value;

/// Data that the cache keeps.
pub(crate) trait Data: Sized {
    /// The name of its kind in the cache.
    const KIND: &'static str;

    /// The data as JSON.
    fn to_json(&self) -> Value;

    /// The data from its JSON; `None` if the JSON has another form.
    fn from_json(json: &Value) -> Option<Self>;
}

/// The data of a text from the cache, otherwise from its derivation, which the cache then keeps. Errors are not kept.
pub(crate) fn kept<D: Data, E>(
    cache: &Cache,
    (choice, text): (&str, &str),
    derive: impl FnOnce() -> Result<D, E>,
) -> Result<D, E> {
    let kind = D::KIND;
    let key = Key { kind, choice, text };
    let json = cache
        .get(&key)
        .and_then(|data| serde_json::from_str(&data).ok());
    if let Some(data) = json.as_ref().and_then(D::from_json) {
        return Ok(data);
    }
    let data = derive()?;
    let json = data.to_json();
    if cache.is_open() {
        cache.put(&key, &json.to_string());
    }
    // Also a new derivation is read from its JSON, so that all runs take one path.
    Ok(D::from_json(&json).unwrap_or(data))
}

/// The items of an emitted program from its text.
pub(crate) fn program(text: &str) -> Result<Program, Refused> {
    let tokens: Result<TokenStream, _> = text.parse();
    Program::read(tokens.map_err(|e| Refused::Construct(e.to_string()))?)
}
