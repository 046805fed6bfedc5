//! Parses statements of chains and sets: `label`, `end` with its alternatives, and `at` after a shape.

use super::ast::{Alternative, At, Name, Site, Statement};
use super::expression::expression;
use super::statement::{kindred, names};
use super::token::{Cursor, Token};
use crate::diagnostic::Diagnostic;

/// `i in 0..N step s`.
pub(super) fn label(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let remedy = "write `label i in 0..N;` or, with a spacing, `label i in 0..N step s;`";
    let index = c.name("the name of the label")?;
    c.word("in").map_err(|e| e.help(remedy))?;
    let place = c.place();
    if let Some(range) = reversed(c) {
        return Err(Diagnostic::new(
            place.to(c.last_place()),
            format!("the range {range} runs backwards, and a label counts up from 0"),
        )
        .help(remedy));
    }
    let zero = c.whole_number().map_err(|e| e.help(remedy))?;
    if zero != 0 {
        return Err(
            Diagnostic::new(place, format!("a label starts at 0, not at {zero}")).help(remedy),
        );
    }
    for _ in 0..2 {
        c.punct('.').map_err(|e| e.help(remedy))?;
    }
    if c.take_punct('=') || matches!(c.peek(), Some(Token::Number(_))) {
        let d = c.unexpected("the name of the number of segments");
        return Err(d.help(
            "the case gives the number: write `0..N`, and in the case `[labels]` with `i = 50`",
        ));
    }
    let count = c
        .name("the name of the number of segments")
        .map_err(|e| e.help(remedy))?;
    let step = match c.take_word("step") {
        true => Some(c.name("the name of the spacing")?),
        false => None,
    };
    Ok(Statement::Label { index, count, step })
}

/// Reads a range that ends before it starts, such as `5..0` or `N..0`. Reads nothing otherwise.
fn reversed(c: &mut Cursor) -> Option<String> {
    let number = |text: &str| text.parse::<u64>().ok();
    let dots = [1, 2].map(|k| c.peek_at(k).map(Token::text));
    let (start, end) = (c.peek()?.text(), c.peek_at(3)?.text());
    let is_range = dots.iter().all(|dot| dot.as_deref() == Some("."));
    let is_reversed = match (number(&start), number(&end)) {
        (Some(start), Some(end)) => start > end,
        (None, Some(end)) => end == 0,
        _ => false,
    };
    (is_range && is_reversed).then(|| {
        (0..4).for_each(|_| c.advance());
        format!("{start}..{end}")
    })
}

/// `at nodes`, `at segments`, `at a`, if it comes next.
pub(super) fn at(c: &mut Cursor) -> Result<Option<At>, Diagnostic> {
    if !c.take_word("at") {
        return Ok(None);
    }
    let name = c.name("`nodes`, `segments` or the label of a set of sites")?;
    let place = name.place;
    let site = match name.text.as_str() {
        "nodes" => Site::Nodes,
        "segments" => Site::Segments,
        _ => Site::Set(name),
    };
    Ok(Some(At { site, place }))
}

/// `i = 0 { ... }`, which ends at its brace without `;`.
pub(super) fn end(c: &mut Cursor) -> Result<Statement, Diagnostic> {
    let remedy = "write `end i = 0 { free; pinned { φ = given; } }`, and `end i = N { ... }` for the other end";
    let label = c
        .name("the label of the chain")
        .map_err(|e| e.help(remedy))?;
    c.punct('=').map_err(|e| e.help(remedy))?;
    let at = match c.peek() {
        Some(Token::Number(text)) => {
            let name = Name {
                text: text.clone(),
                place: c.place(),
                typeset: None,
                is_copy: false,
            };
            c.advance();
            name
        }
        _ => c.name("`0` or the name of the number of segments")?,
    };
    c.delimiter('{').map_err(|e| e.help(remedy))?;
    let close = c.closing_brace();
    let mut alternatives = Vec::new();
    while !c.take_delimiter('}') {
        if c.is_at_end() {
            return Err(c.unexpected("`}`"));
        }
        match alternative(c) {
            Ok(one) => alternatives.push(one),
            Err(error) => {
                // The next statement is after the block.
                c.go_past(close);
                return Err(error);
            }
        }
    }
    c.take_punct(';');
    Ok(Statement::End {
        label,
        at,
        alternatives,
    })
}

/// `NAME;` or `NAME { ... }`.
fn alternative(c: &mut Cursor) -> Result<Alternative, Diagnostic> {
    let name = c.name("the name of an end condition, such as `free`")?;
    let mut out = Alternative {
        name,
        params: Vec::new(),
        given: Vec::new(),
        terms: Vec::new(),
    };
    if c.take_punct(';') {
        return Ok(out);
    }
    if c.is_punct('=') {
        let d = c.unexpected("`;` or `{` after the name of an end condition");
        let given = &out.name.text;
        return Err(d.help(format!(
            "name the end condition, for example `pinned {{ {given} = given; }}`"
        )));
    }
    c.delimiter('{').map_err(|e| {
        let given = &out.name.text;
        e.help(format!(
            "write an end condition as `{given};` or `{given} {{ φ = given; }}`"
        ))
    })?;
    while !c.take_delimiter('}') {
        let word = c.name("`param`, `term` or the name of a prescribed quantity")?;
        match word.text.as_str() {
            "param" => {
                let names = names(c)?;
                c.punct(':')?;
                out.params.push((names, kindred(c)?));
            }
            "term" => out.terms.push(expression(c)?),
            _ => {
                let remedy = "an end condition contains `param F: Vec<3>;`, `φ = given;` or `term h*dot(F, φ);`";
                c.punct('=').map_err(|e| e.help(remedy))?;
                c.word("given").map_err(|e| {
                    e.help(
                        "write `φ = given;`: the case gives the value, which is constant in time. To drive an end, use a term, \
                         `term -h*(K/2)*(φ - A*sin(w*τ))^2;`, and a clock at the nodes: `advected τ: Real at nodes; \
                         constraint next(τ) = τ + h;`",
                    )
                })?;
                out.given.push(word);
            }
        }
        c.punct(';')?;
    }
    c.take_punct(';');
    Ok(out)
}
