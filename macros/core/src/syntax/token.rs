//! Tokens as a flat list with a cursor; groups become opening and closing tokens. `2Ω` stays a number joined to a
//! name, which the parser rejects. Depth and length are limited, so that no input exhausts the stack.

use super::ast::Name;
use super::characters::QUOTES;
use super::delimiters::not_closed;
use super::unknown;
use crate::diagnostic::{Diagnostic, Errors, Place};
use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};

/// The maximum nesting of parentheses.
const DEEPEST: usize = 100;
/// The maximum number of divisions in a statement. Divisions nest without parentheses, since each contains everything
/// before it: `((a/b)/c)/d`.
const MOST_DIVISIONS: usize = 500;
/// The maximum length of a model in bytes, without whitespace, comments and documentation.
pub(super) const LONGEST: usize = 10_000;

/// Keywords that start a statement.
pub const KEYWORDS: [&str; 21] = [
    "dim",
    "time",
    "label",
    "grid",
    "param",
    "assume",
    "group",
    "field",
    "advected",
    "constraint",
    "let",
    "hold",
    "given",
    "mesh",
    "linear",
    "scale",
    "node",
    "integrate",
    "periodic",
    "end",
    "lagrangian",
];

/// One flat token.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Token {
    /// An identifier.
    Name(String),
    /// A number literal, without suffix.
    Number(String),
    /// A number and a name without a space, `2h`.
    Glued(String, String),
    /// A string or other literal.
    Literal(String),
    /// One punctuation character; `true` if the next character follows directly.
    Punct(char, bool),
    /// An opening delimiter.
    Open(char),
    /// A closing delimiter.
    Close(char),
}

impl Token {
    /// The text of the token in messages.
    pub fn text(&self) -> String {
        match self {
            Token::Name(s) | Token::Number(s) | Token::Literal(s) => s.clone(),
            Token::Glued(number, name) => format!("{number}{name}"),
            Token::Punct(c, _) | Token::Open(c) | Token::Close(c) => c.to_string(),
        }
    }
}

/// A position in the flat list.
pub struct Cursor {
    tokens: Vec<(Token, Span)>,
    at: usize,
    end: Span,
}

fn delimiters(d: Delimiter) -> Option<(char, char)> {
    match d {
        Delimiter::Parenthesis => Some(('(', ')')),
        Delimiter::Brace => Some(('{', '}')),
        Delimiter::Bracket => Some(('[', ']')),
        Delimiter::None => None,
    }
}

/// The length of the number at the start of `2e3x`.
fn split_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while i < bytes.len() && (bytes[i].is_ascii_digit() || bytes[i] == b'_') {
            i += 1;
        }
        i
    };
    let mut i = digits(0);
    if i < bytes.len() && bytes[i] == b'.' {
        i = digits(i + 1);
    }
    if i < bytes.len() && (bytes[i] == b'e' || bytes[i] == b'E') {
        let mut j = i + 1;
        if j < bytes.len() && (bytes[j] == b'+' || bytes[j] == b'-') {
            j += 1;
        }
        if digits(j) > j {
            i = digits(j);
        }
    }
    i
}

/// The notation for the size of a shape or a group.
pub const SIZES: &str = "write sizes in angle brackets: `Vec<3>`, `SO<3>`";

impl Cursor {
    /// Flattens a token stream.
    pub fn new(stream: TokenStream) -> Result<Cursor, Errors> {
        let mut tokens = Vec::new();
        let mut bytes = 0;
        let mut end = Span::call_site();
        let mut stack = vec![(stream.into_iter(), None::<(char, Span)>)];
        while let Some((iter, closing)) = stack.last_mut() {
            let Some(tree) = iter.next() else {
                if let Some((c, span)) = closing.take() {
                    tokens.push((Token::Close(c), span));
                    bytes += 1;
                    end = span;
                }
                stack.pop();
                continue;
            };
            let span = tree.span();
            if bytes > LONGEST {
                let message = format!(
                    "this model has more than {LONGEST} bytes, not counting blanks, comments and documentation"
                );
                return Err(Diagnostic::new(Place::token(span), message)
                    .help("shorten it with `let`, make parts of it parameters, or split it into several models")
                    .into());
            }
            match tree {
                TokenTree::Group(group) => {
                    if stack.len() > DEEPEST {
                        let message = format!("parentheses are nested deeper than {DEEPEST}");
                        return Err(Diagnostic::new(Place::token(span), message)
                            .help("name parts of the expression with `let`")
                            .into());
                    }
                    let pair = delimiters(group.delimiter());
                    if let Some((open, _)) = pair {
                        tokens.push((Token::Open(open), group.span_open()));
                        bytes += 1;
                    }
                    let close = pair.map(|(_, c)| (c, group.span_close()));
                    stack.push((group.stream().into_iter(), close));
                }
                TokenTree::Ident(name) => {
                    let text = name.to_string();
                    let text = text.strip_prefix("r#").unwrap_or(&text).to_owned();
                    if let Some(wrong) = super::characters::within(&text, Place::token(span)) {
                        return Err(wrong.into());
                    }
                    bytes += text.len();
                    tokens.push((Token::Name(text), span));
                }
                TokenTree::Punct(p) => {
                    let joint = p.spacing() == Spacing::Joint;
                    bytes += p.as_char().len_utf8();
                    tokens.push((Token::Punct(p.as_char(), joint), span));
                }
                TokenTree::Literal(literal) => {
                    let text = literal.to_string();
                    if text.starts_with(|c: char| c.is_ascii_digit()) {
                        bytes += text.len();
                        let (number, suffix) = text.split_at(split_number(&text));
                        tokens.push((
                            match suffix.is_empty() {
                                true => Token::Number(number.to_owned()),
                                false => Token::Glued(number.to_owned(), suffix.to_owned()),
                            },
                            span,
                        ));
                    } else {
                        // A documentation line is `#[doc = "..."]`; none of it counts.
                        if matches!(tokens.last(), Some((Token::Punct('=', _), _))) {
                            bytes = bytes.saturating_sub("#[doc=]".len());
                        }
                        tokens.push((Token::Literal(text), span));
                    }
                }
            }
            end = span;
        }
        let mut divisions = 0;
        for (token, span) in &tokens {
            match token {
                Token::Punct(';', _) => divisions = 0,
                Token::Punct('/', _) => divisions += 1,
                _ => {}
            }
            if divisions > MOST_DIVISIONS {
                let message = format!("this statement has more than {MOST_DIVISIONS} divisions");
                return Err(Diagnostic::new(Place::token(*span), message)
                    .help("divide by products, or name parts of the expression with `let`")
                    .into());
            }
        }
        Ok(Cursor { tokens, at: 0, end })
    }

    /// The token `ahead` positions after the next one.
    pub fn peek_at(&self, ahead: usize) -> Option<&Token> {
        self.tokens.get(self.at + ahead).map(|(t, _)| t)
    }

    /// The next token.
    pub fn peek(&self) -> Option<&Token> {
        self.peek_at(0)
    }

    /// The position of the next token, or of the end.
    pub fn place(&self) -> Place {
        Place::token(self.tokens.get(self.at).map_or(self.end, |(_, s)| *s))
    }

    /// The position of the previous token.
    pub fn last_place(&self) -> Place {
        let before = self.at.checked_sub(1).and_then(|i| self.tokens.get(i));
        Place::token(before.map_or(self.end, |(_, s)| *s))
    }

    /// The previous token.
    pub fn before(&self) -> Option<&Token> {
        let at = self.at.checked_sub(1)?;
        self.tokens.get(at).map(|(t, _)| t)
    }

    /// Whether the previous token is this punctuation.
    pub fn follows_punct(&self, c: char) -> bool {
        matches!(self.before(), Some(Token::Punct(p, _)) if *p == c)
    }

    /// Skips one token.
    pub fn advance(&mut self) {
        self.at += 1;
    }

    /// The number of tokens read.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The position of the brace that closes the current block.
    pub fn closing_brace(&self) -> usize {
        let mut depth = 0_u32;
        let mut at = self.at;
        while let Some((token, _)) = self.tokens.get(at) {
            match token {
                Token::Open(_) => depth += 1,
                Token::Close(_) if depth == 0 => break,
                Token::Close(_) => depth -= 1,
                _ => {}
            }
            at += 1;
        }
        at
    }

    /// Skips all tokens up to and including this position.
    pub fn go_past(&mut self, place: usize) {
        self.at = self.at.max(place.saturating_add(1));
    }

    /// Whether the previous token closes a block.
    pub fn follows_block(&self) -> bool {
        matches!(self.before(), Some(Token::Close('}')))
    }

    /// Whether all tokens have been read.
    pub fn is_at_end(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// Whether a quantity in the rest of the statement has a different index, such as `x[j]` next to `x[i]`.
    pub fn is_indexed_otherwise(&self, index: &str) -> bool {
        let rest = self.tokens.get(self.at..).unwrap_or_default();
        let ends = |t: &Token| matches!(t, Token::Punct(';', _));
        let end = rest.iter().position(|(t, _)| ends(t)).unwrap_or(rest.len());
        rest.iter().zip(rest.iter().skip(1)).take(end).any(|((open, _), (name, _))| {
            matches!((open, name), (Token::Open('['), Token::Name(n)) if n != index && n != "k")
        })
    }

    /// Whether the next token is this word.
    pub fn is_word(&self, word: &str) -> bool {
        matches!(self.peek(), Some(Token::Name(n)) if n == word)
    }

    /// Whether the next token is this punctuation.
    pub fn is_punct(&self, c: char) -> bool {
        matches!(self.peek(), Some(Token::Punct(p, _)) if *p == c)
    }

    /// Reads the word if it is next.
    pub fn take_word(&mut self, word: &str) -> bool {
        let found = self.is_word(word);
        self.at += usize::from(found);
        found
    }

    /// Reads the punctuation if it is next.
    pub fn take_punct(&mut self, c: char) -> bool {
        let found = self.is_punct(c);
        self.at += usize::from(found);
        found
    }

    /// Reads the opening or closing delimiter if it is next.
    pub fn take_delimiter(&mut self, c: char) -> bool {
        let found = matches!(self.peek(), Some(Token::Open(p) | Token::Close(p)) if *p == c);
        self.at += usize::from(found);
        found
    }

    /// An error at the next token: what was expected, and what was found.
    pub fn unexpected(&self, expected: &str) -> Diagnostic {
        let found = match self.peek() {
            Some(t) => format!("found `{}`", t.text()),
            None => "reached the end of the text".to_owned(),
        };
        let error = Diagnostic::new(self.place(), format!("expected {expected}, {found}"));
        let prime = matches!(self.before(), Some(Token::Name(_) | Token::Close(_)));
        match self.peek() {
            // Rust reads a letter in single quotes as a character, and a word behind one as a lifetime.
            Some(Token::Literal(text)) if text.starts_with('\'') => error.help(QUOTES),
            Some(Token::Punct('\'', _)) if !prime => error.help(QUOTES),
            _ => error,
        }
    }

    /// Reads this punctuation, or returns an error.
    pub fn punct(&mut self, c: char) -> Result<(), Diagnostic> {
        if self.take_punct(c) {
            return Ok(());
        }
        if c != ';' {
            let error = self.unexpected(&format!("`{c}`"));
            return Err(match (c, self.peek()) {
                (':', Some(Token::Punct('=' | ';', _))) => error.help(
                    "give the shape, for example `param m: Real;`; values belong in the case, not in the model",
                ),
                ('=', Some(Token::Punct(':', _))) => error.help("write `=` before an expression"),
                _ => error,
            });
        }
        let ends = matches!(self.peek(), Some(Token::Close('}')) | None);
        let mut error = self.unexpected("`;`");
        if ends || self.starts_statement() {
            error = self.unexpected("`;` after this");
            error.place = self.last_place();
        }
        // A closing delimiter here may belong to an unclosed one that was already reported.
        error.follows = matches!(self.peek(), Some(Token::Close(')' | ']')));
        Err(unknown::ends_expression(self)
            .unwrap_or_else(|| error.help(unknown::ends_statement(self))))
    }

    /// Whether the next tokens start a statement. A factor of a product may also have the name of a keyword.
    pub fn starts_statement(&self) -> bool {
        let Some(Token::Name(word)) = self.peek() else {
            return false;
        };
        let goes_on = match self.peek_at(1) {
            Some(Token::Name(_)) => true,
            Some(Token::Punct('=', _)) => word == "lagrangian",
            _ => false,
        };
        goes_on && KEYWORDS.contains(&word.as_str())
    }

    /// Reads this delimiter, or returns an error.
    pub fn delimiter(&mut self, c: char) -> Result<(), Diagnostic> {
        if self.take_delimiter(c) {
            return Ok(());
        }
        let error = self.unexpected(&format!("`{c}`"));
        let told = unknown::ends_expression(self).or_else(|| self.unclosed());
        Err(told.unwrap_or(error))
    }

    /// If a statement ends or its right side begins inside parentheses: the error for the innermost unclosed
    /// delimiter.
    pub fn unclosed(&self) -> Option<Diagnostic> {
        let equals = self.is_punct('=') && !matches!(self.peek_at(1), Some(Token::Punct('=', _)));
        if !self.is_punct(';') && !equals && !self.starts_statement() {
            return None;
        }
        let mut closed = 0usize;
        let opening = self
            .tokens
            .iter()
            .take(self.at)
            .rev()
            .find_map(|(t, span)| {
                match t {
                    Token::Close(_) => closed += 1,
                    Token::Open(_) if closed > 0 => closed -= 1,
                    Token::Open(c) => return Some((*c, *span)),
                    _ => {}
                }
                None
            });
        let (c, span) = opening.filter(|(c, _)| *c != '{')?;
        let found = self.peek().map(Token::text)?;
        let place = Place::token(span);
        Some(not_closed(c, place, Some((&found, self.place()))))
    }

    /// Reads this word, or returns an error.
    pub fn word(&mut self, word: &str) -> Result<(), Diagnostic> {
        if self.take_word(word) {
            return Ok(());
        }
        Err(self.unexpected(&format!("`{word}`")))
    }

    /// Reads a name, or returns an error.
    pub fn name(&mut self, what: &str) -> Result<Name, Diagnostic> {
        match self.peek() {
            Some(Token::Name(text)) => {
                let name = Name {
                    text: text.clone(),
                    place: self.place(),
                    typeset: None,
                    is_copy: false,
                };
                self.advance();
                Ok(name)
            }
            _ => Err(self.unexpected(what)),
        }
    }

    /// Reads a whole number, or returns an error.
    pub fn whole_number(&mut self) -> Result<u64, Diagnostic> {
        if let Some(Token::Number(text)) = self.peek()
            && let Ok(n) = text.replace('_', "").parse()
        {
            self.advance();
            return Ok(n);
        }
        Err(self.unexpected("a whole number"))
    }
}

#[cfg(test)]
mod tests {
    use super::{Cursor, MOST_DIVISIONS};
    use crate::syntax::{parse, tokens};

    #[test]
    fn divisions_are_counted_statement_by_statement() {
        let read = |statements: &[usize]| {
            let each = statements.iter().map(|n| format!("a{};", "/2".repeat(*n)));
            Cursor::new(each.collect::<String>().parse().expect("tokens")).is_ok()
        };
        assert!(read(&[MOST_DIVISIONS, MOST_DIVISIONS]));
        assert!(!read(&[1, MOST_DIVISIONS + 1]));
    }

    #[test]
    fn single_quotes_that_rust_reads_are_told_to_be_double() {
        for text in [
            "param 'm': Real;",
            "given f(Real): Real = 'x';",
            "given f(Vec<2>): Vec<2> = ['x', 'y'];",
            "lagrangian = 'q'^2;",
            "param m: Real as 'm';",
        ] {
            let source = format!("model M {{ {text} }}");
            let told = tokens(&source).and_then(parse).expect_err(text).to_string();
            assert!(told.contains("in double quotes"), "{text}: {told}");
        }
    }
}
