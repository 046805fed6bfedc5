//! Functions defined by a formula in quotes, in the model or in a case: `given b(Vec<2>): Real = "A*cos(2*pi*x/L)";`.

use super::ast::{Expression, Kind, Model, Name, SizedName, Statement};
use super::token::{Cursor, Token};
use crate::diagnostic::{Diagnostic, Place};

const ONLY: &str =
    "a function with an expression takes one number or a vector of known size, and returns one";
const OTHERWISE: &str = "for functions of matrices or of several arguments, give the path of a Rust function; in `given \
    b(Vec<2>): Real = \"x*y\";`, x, y, z are the components of the argument";

/// The component names of a position vector.
const LETTERS: [&str; 3] = ["x", "y", "z"];

/// After `=`: one expression in quotes, or a list of expressions for the components of a vector; empty if a path
/// follows.
pub(super) fn components(c: &mut Cursor) -> Result<Vec<(String, Expression)>, Diagnostic> {
    if !c.take_delimiter('[') {
        return match c.peek().is_some_and(is_text) {
            true => Ok(vec![quoted(c)?]),
            false => Ok(Vec::new()),
        };
    }
    let mut list = vec![quoted(c)?];
    while c.take_punct(',') {
        list.push(quoted(c)?);
    }
    c.delimiter(']')?;
    Ok(list)
}

/// Whether a token is a text in double quotes.
fn is_text(token: &Token) -> bool {
    matches!(token, Token::Literal(t) if t.trim_end_matches('#').ends_with('"'))
}

fn quoted(c: &mut Cursor) -> Result<(String, Expression), Diagnostic> {
    let place = c.place();
    let Some(Token::Literal(text)) = c.peek().filter(|t| is_text(t)) else {
        return Err(c
            .unexpected("an expression in quotes")
            .help("put each component in quotes, for example `[\"-f*y/2\", \"f*x/2\"]`"));
    };
    let text = super::statement::unquoted(text);
    c.advance();
    let mut parsed = read(&text).map_err(|wrong| Diagnostic { place, ..wrong })?;
    put_at(&mut parsed, place);
    Ok((text, parsed))
}

/// An expression in quotes.
///
/// # Errors
/// The first mistake, with its position in the text.
fn read(text: &str) -> Result<Expression, Diagnostic> {
    super::expression(text).map_err(|errors| {
        let mut first = errors.first();
        let at = match first.place.line_and_column() {
            (1, column) if column > 1 => format!(", at character {column}"),
            _ => String::new(),
        };
        first.message = format!("in this expression{at}: {}", first.message);
        first
    })
}

/// Sets the position of an expression and all its parts.
fn put_at(e: &mut Expression, place: Place) {
    e.place = place;
    if let Kind::Call(name, _) = &mut e.kind {
        name.place = place;
    }
    for part in e.parts_mut() {
        put_at(part, place);
    }
}

/// The quoted formulas of a function, as models and cases write them; a list for a vector.
pub fn in_quotes(components: &[String]) -> String {
    let quoted: Vec<String> = components.iter().map(|c| format!("{c:?}")).collect();
    match quoted.as_slice() {
        [only] => only.clone(),
        all => format!("[{}]", all.join(", ")),
    }
}

/// The argument of such a function, and the number of components of its value; an error for other functions.
pub(super) fn signature<'k>(
    name: &Name,
    arguments: &'k [SizedName],
    value: &SizedName,
) -> Result<(&'k SizedName, usize), Diagnostic> {
    match (arguments, value.components()) {
        ([argument], Some(n)) if argument.components().is_some() => Ok((argument, n)),
        _ => Err(Diagnostic::new(name.place, ONLY).help(OTHERWISE)),
    }
}

/// The declarations of such functions, without the final `;`.
pub fn stated(model: &Model) -> Vec<String> {
    let kind = |k: &SizedName| match k.components() {
        Some(n) if k.name.text == "Vec" => format!("Vec<{n}>"),
        _ => k.name.text.clone(),
    };
    let of = |s: &Statement| match s {
        Statement::Given {
            name,
            arguments,
            value,
            texts,
            by_case,
            ..
        } if !texts.is_empty() => {
            let arguments: Vec<String> = arguments.iter().map(kind).collect();
            let case = if by_case.is_some() { "case " } else { "" };
            Some(format!(
                "given {}({}): {} = {case}{}",
                name.text,
                arguments.join(", "),
                kind(value),
                in_quotes(texts)
            ))
        }
        _ => None,
    };
    model.statements.iter().filter_map(of).collect()
}

/// A function that a case must define.
#[derive(Clone, Debug)]
pub struct Open {
    /// Its name.
    pub name: Name,
    /// Its argument, a scalar or a vector.
    pub argument: SizedName,
    /// The number of components of its value.
    pub components: usize,
    /// Whether its definition is already filled in.
    pub is_filled: bool,
    /// Line and column of the word `case` in the text, from 1.
    pub at: (usize, usize),
}

/// The functions of a model that a case must define.
///
/// # Errors
/// A function whose argument or value a formula cannot have.
pub fn open(model: &Model) -> Result<Vec<Open>, Diagnostic> {
    let mut all = Vec::new();
    for statement in &model.statements {
        let Statement::Given {
            name,
            arguments,
            value,
            by_case: Some(word),
            components: filled,
            ..
        } = statement
        else {
            continue;
        };
        let (argument, components) = signature(name, arguments, value)?;
        all.push(Open {
            name: name.clone(),
            argument: argument.clone(),
            components,
            is_filled: !filled.is_empty(),
            at: word.line_and_column(),
        });
    }
    Ok(all)
}

/// Checks that a text is a formula in the components of an argument. `known` accepts other names that it may contain.
///
/// # Errors
/// A text that cannot be parsed, or the first unknown name.
pub fn check(text: &str, argument: &SizedName, known: &dyn Fn(&str) -> bool) -> Result<(), String> {
    let parsed = read(text).map_err(|wrong| wrong.text())?;
    if let Some(name) = parsed.call_that(&|n| !super::FUNCTIONS.contains(&n)) {
        return Err(format!(
            "`{name}` cannot be called here; functions: {}",
            super::AVAILABLE
        ));
    }
    match foreign(&parsed, argument, known) {
        None => Ok(()),
        Some(wrong) => Err(wrong),
    }
}

/// The error if an expression contains a name that is neither a component of the argument nor `known`.
pub(super) fn foreign(
    e: &Expression,
    argument: &SizedName,
    known: &dyn Fn(&str) -> bool,
) -> Option<String> {
    if let Some(shift) = e.call_of(&["next", "prev"]) {
        return Some(format!(
            "a function cannot contain `{shift}(...)`: write it where the function is called"
        ));
    }
    let names = names(argument);
    let unknown = |n: &str| {
        let of_language = super::FUNCTIONS.contains(&n) || super::circle::is_meant(n);
        !names.iter().flatten().any(|own| own == n) && !of_language && !known(n)
    };
    let n = e.name_that(&unknown)?;
    let own = names.iter().filter_map(|n| n.first().map(String::as_str));
    let own: Vec<&str> = own.collect();
    Some(format!(
        "`{n}` is unknown here: the expression may contain the argument {}, parameters of the model and `pi`",
        own.join(", ")
    ))
}

/// The names of each component of the argument.
pub(super) fn names(argument: &SizedName) -> Vec<Vec<String>> {
    let n = argument.components().unwrap_or(0);
    (0..n)
        .map(|i| {
            let letter = LETTERS.get(i).filter(|_| n <= 3);
            let numbered = (argument.name.text != "Real").then(|| format!("x{}", i + 1));
            letter
                .map(|l| (*l).to_owned())
                .into_iter()
                .chain(numbered)
                .collect()
        })
        .collect()
}
