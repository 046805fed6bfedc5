//! Parses tokens into a syntax tree with positions: a flat token list, a Pratt parser for expressions, and one
//! function for each statement. Names and shapes are resolved later, by `check`.

pub mod ast;
mod called;
mod characters;
mod circle;
mod delimiters;
mod expression;
pub mod formula;
mod label;
pub mod library;
mod mesh;
mod parts;
mod statement;
mod text;
mod token;
mod typeset;
pub(crate) mod unknown;

pub(crate) use circle::is_meant as is_circle;

use crate::diagnostic::{Diagnostic, Errors, Place};
use ast::Model;
use proc_macro2::TokenStream;
use token::Cursor;

/// Functions of the language.
pub const FUNCTIONS: [&str; 33] = [
    "tr", "det", "log", "exp", "sqrt", "sin", "cos", "sinh", "cosh", "tanh", "abs", "sign", "inv",
    "sym", "skew", "diag", "hat", "vee", "dot", "cross", "perp", "re", "im", "I1", "I2", "next",
    "prev", "rate", "sum", "Tr", "quat", "rot", "pos",
];

/// Functions that a declared name may hide, so that models without these groups can use the words.
pub const HIDEABLE: [&str; 5] = ["quat", "rot", "pos", "I1", "I2"];

/// The functions that models of this version can use, as listed in messages.
pub const AVAILABLE: &str = "tr det log exp sqrt sin cos sinh cosh tanh abs sign inv sym skew diag hat vee dot cross perp re im quat rot pos I1 I2 next";

/// Parses one model, `[pub] model NAME { ... }`, with its documentation.
pub fn parse(tokens: TokenStream) -> Result<Model, Errors> {
    let mut cursor = Cursor::new(tokens)?;
    statement::model(&mut cursor)
}

/// Parses a text as one expression.
pub fn expression(source: &str) -> Result<ast::Expression, Errors> {
    let mut cursor = Cursor::new(tokens(source)?)?;
    let parsed = expression::expression(&mut cursor)?;
    match cursor.is_at_end() {
        true => Ok(parsed),
        false => {
            let sign = unknown::ends_expression(&cursor);
            Err(sign
                .unwrap_or_else(|| cursor.unexpected("the end of the expression"))
                .into())
        }
    }
}

/// Maximum length of a text in bytes; a source with a model may also contain other items.
const LONGEST_TEXT: usize = 250_000;

/// Splits a text into tokens.
pub fn tokens(source: &str) -> Result<TokenStream, Errors> {
    if source.len() > LONGEST_TEXT {
        let message = format!(
            "this text has {} bytes; clebsch reads at most {LONGEST_TEXT}, and models of at most {}",
            source.len(),
            token::LONGEST
        );
        return Err(
            Diagnostic::new(Place::token(proc_macro2::Span::call_site()), message)
                .help("put the model into a file of its own")
                .into(),
        );
    }
    let text = text::with_plain_backslashes(source);
    text.parse().map_err(|e: proc_macro2::LexError| {
        if let Some(unmatched) = delimiters::unmatched(source) {
            return unmatched.into();
        }
        if let Some(foreign) = characters::foreign(source) {
            return foreign.into();
        }
        Errors::from(
            Diagnostic::new(Place::token(e.span()), "unexpected character".to_owned())
                .help("write Λ^T for a transpose (not Λ'), a*b or a b for a product (not a·b), dot(a, b) for ⟨a, b⟩"),
        )
    })
}
