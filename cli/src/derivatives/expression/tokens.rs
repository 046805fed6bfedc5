//! Tokens of an expression, with their places. Takes a text; gives numbers, names and signs.

use super::Mistake;
use crate::words::plain::shown;

/// A piece of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Piece {
    Number(f64),
    Name(String),
    /// A component after a point, such as `.x` or `.12`.
    Part(String),
    Sign(char),
    End,
}

/// A piece and its place.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub piece: Piece,
    /// The first character, counted from 0.
    pub at: usize,
    pub length: usize,
}

impl Token {
    /// The token as a message names it.
    pub fn described(&self) -> String {
        match &self.piece {
            Piece::Number(x) => format!("the number {x}"),
            Piece::Name(name) => format!("`{}`", shown(name.as_str())),
            Piece::Part(part) => format!("`.{}`", shown(part.as_str())),
            Piece::Sign(sign) => format!("`{sign}`"),
            Piece::End => "the end".to_owned(),
        }
    }
}

/// Longer texts are mistakes.
const LONGEST: usize = 10_000;

/// Whether a character continues a name. Subscripts and primes belong to names.
fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || ('₀'..='₉').contains(&c) || c == '\''
}

/// Whether the last token is a name that ends at this character.
fn follows_a_name(tokens: &[Token], at: usize) -> bool {
    let last = tokens.last();
    last.is_some_and(|t| matches!(t.piece, Piece::Name(_)) && t.at + t.length == at)
}

/// Splits a text; the last token is the end.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, Mistake> {
    let letters: Vec<char> = text.chars().collect();
    if letters.len() > LONGEST {
        return Err(Mistake {
            at: LONGEST,
            length: 1,
            what: format!("the expression has more than {LONGEST} characters"),
            remedy: "Shorten it.".to_owned(),
        });
    }
    let mut all: Vec<Token> = Vec::new();
    let mut at = 0;
    while let Some(&letter) = letters.get(at) {
        let from = at;
        let take = |is: &dyn Fn(usize, char) -> bool| {
            let rest = letters.iter().enumerate().skip(from);
            rest.take_while(|(i, c)| is(*i, **c)).count()
        };
        let (piece, length) = match letter {
            c if c.is_whitespace() => {
                at += 1;
                continue;
            }
            '.' if follows_a_name(&all, from) => {
                let length = take(&|i, c| i == from || is_of_name(c));
                let word = letters.iter().skip(from + 1).take(length - 1).collect();
                (Piece::Part(word), length)
            }
            c if c.is_ascii_digit() || c == '.' => {
                let is_exponent = |i: usize, c: char| {
                    let before = i.checked_sub(1).and_then(|b| letters.get(b));
                    let after_e = matches!(before, Some('e' | 'E'));
                    matches!(c, 'e' | 'E') || (matches!(c, '+' | '-') && after_e)
                };
                let length = take(&|i, c| c.is_ascii_digit() || c == '.' || is_exponent(i, c));
                let word: String = letters.iter().skip(from).take(length).collect();
                match word.parse::<f64>() {
                    Ok(x) if x.is_finite() => (Piece::Number(x), length),
                    _ => {
                        return Err(Mistake {
                            at: from,
                            length,
                            what: format!("`{word}` is not a number"),
                            remedy: "Write numbers as 2, 0.5 or 1e-3, and products with `*`."
                                .to_owned(),
                        });
                    }
                }
            }
            c if is_of_name(c) => {
                let length = take(&|_, c| is_of_name(c));
                let word = letters.iter().skip(from).take(length).collect();
                (Piece::Name(word), length)
            }
            '*' if letters.get(from + 1) == Some(&'*') => (Piece::Sign('^'), 2),
            '−' => (Piece::Sign('-'), 1),
            '·' | '×' => (Piece::Sign('*'), 1),
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | '[' | ']' | ',' => (Piece::Sign(letter), 1),
            _ => {
                return Err(Mistake {
                    at: from,
                    length: 1,
                    what: format!("unexpected `{}`", shown(letter.to_string().as_str())),
                    remedy: "Use + - * / ^, brackets, functions, and names of the model."
                        .to_owned(),
                });
            }
        };
        all.push(Token {
            piece,
            at: from,
            length,
        });
        at = from + length;
    }
    all.push(Token {
        piece: Piece::End,
        at: letters.len(),
        length: 1,
    });
    Ok(all)
}
