//! Names of letters and scripts as layouts.

use super::layout::{Layout, Sign};

pub(super) use crate::expr::spelling::{letter, parse};

/// Lays out the text of a script, such as `k+1` or `ref`, token by token.
pub(super) fn script(text: &str) -> Layout {
    let mut row = Vec::new();
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let same = |class: fn(char) -> bool, rest: &mut std::iter::Peekable<std::str::Chars>| {
            let mut run = c.to_string();
            while let Some(d) = rest.next_if(|d| class(*d)) {
                run.push(d);
            }
            run
        };
        if c.is_alphabetic() {
            let word = letter(&same(char::is_alphabetic, &mut rest));
            row.push(match word.chars().count() {
                1 => Layout::Identifier(word),
                _ => Layout::Word(word),
            });
        } else if c.is_ascii_digit() {
            row.push(Layout::Number(same(|d| d.is_ascii_digit(), &mut rest)));
        } else if !c.is_whitespace() {
            row.push(Layout::Sign(Sign::Tight(c)));
        }
    }
    Layout::row(row)
}
