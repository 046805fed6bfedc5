//! Diagnostics: what is wrong, where, and what to write instead. A stage collects diagnostics and fails at its end.
//! The macro turns them into compile errors with exact spans; the command line prints line, column and caret.

mod report;

pub use report::{Report, TextRange};

use crate::expr::symbol::ascii;
use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

/// A range of tokens, stored as its first and last span, since stable Rust cannot join spans.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Span of the first token.
    pub first: Span,
    /// Span of the last token.
    pub last: Span,
}

impl Place {
    /// A single token.
    pub fn token(span: Span) -> Place {
        Place {
            first: span,
            last: span,
        }
    }

    /// Line and column of its start, counted from 1.
    pub fn line_and_column(self) -> (usize, usize) {
        let start = self.first.start();
        (start.line, start.column + 1)
    }

    /// The range from the start of one range to the end of another.
    pub fn to(self, end: Place) -> Place {
        Place {
            first: self.first,
            last: end.last,
        }
    }
}

/// One mistake of the user.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// The tokens to underline.
    pub place: Place,
    /// States what is wrong and why.
    pub message: String,
    /// States what to write instead.
    pub help: Vec<String>,
    /// Other tokens involved, with a note on each.
    pub also: Vec<(Place, String)>,
    /// Whether it is a consequence of another mistake, and is not reported if there is one.
    pub follows: bool,
    /// Whether the model exceeds a size limit but is otherwise valid.
    pub too_large: bool,
}

impl Diagnostic {
    /// A diagnostic with a message only.
    pub fn new(place: Place, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            place,
            message: message.into(),
            help: Vec::new(),
            also: Vec::new(),
            follows: false,
            too_large: false,
        }
    }

    /// Marks the diagnostic as a size limit: the model is valid but too large.
    #[must_use]
    pub fn of_size(self) -> Diagnostic {
        Diagnostic {
            too_large: true,
            ..self
        }
    }

    /// A diagnostic that is a consequence of another mistake.
    pub fn following(place: Place, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            follows: true,
            ..Diagnostic::new(place, message)
        }
    }

    /// Adds a suggestion.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Diagnostic {
        self.help.push(text.into());
        self
    }

    /// Adds a second position.
    #[must_use]
    pub fn also(mut self, place: Place, text: impl Into<String>) -> Diagnostic {
        self.also.push((place, text.into()));
        self
    }

    /// Message and suggestions as one text.
    pub fn text(&self) -> String {
        let mut text = self.message.clone();
        for line in &self.help {
            text.push_str("\n  help: ");
            text.push_str(line);
        }
        text
    }

    /// The diagnostic as plain data.
    pub fn report(&self) -> Report {
        let also = self.also.iter();
        Report {
            range: TextRange::of(self.place),
            message: self.message.clone(),
            help: self.help.clone(),
            also: also
                .map(|(place, text)| (TextRange::of(*place), text.clone()))
                .collect(),
        }
    }

    /// The diagnostic for a terminal, with a severity level: file, line, column, the source line and carets.
    pub fn render(&self, level: &str, source: &str, file: &str) -> String {
        self.report().render(level, source, file)
    }
}

/// All mistakes found before a stage failed; not empty if returned as an error.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    list: Vec<Diagnostic>,
}

/// The maximum number of reported mistakes.
const MOST: usize = 20;

impl Errors {
    /// Whether all diagnostics are size limits.
    pub fn are_of_size(&self) -> bool {
        !self.list.is_empty() && self.list.iter().all(|d| d.too_large)
    }

    /// An empty list.
    pub fn new() -> Errors {
        Errors::default()
    }

    /// Adds a mistake.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let follows = diagnostic.follows && !self.list.is_empty();
        if self.list.len() < MOST && !follows {
            self.list.push(diagnostic);
        }
    }

    /// The first mistake.
    pub fn first(self) -> Diagnostic {
        let nothing = || Diagnostic::new(Place::token(Span::call_site()), "nothing is wrong");
        self.list.into_iter().next().unwrap_or_else(nothing)
    }

    /// Adds a mistake, if there is one.
    pub fn extend(&mut self, diagnostic: Option<Diagnostic>) {
        diagnostic.into_iter().for_each(|d| self.push(d));
    }

    /// The mistakes in the order found.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Keeps the first mistake at each position, since copies of one statement repeat it.
    #[must_use]
    pub fn first_at_each_place(self) -> Errors {
        let mut seen = Vec::new();
        let mut out = Errors::new();
        for d in self.list {
            let at = format!("{:?} {:?}", d.place.first, d.place.last);
            if !seen.contains(&at) {
                seen.push(at);
                out.push(d);
            }
        }
        out
    }

    /// Returns an error if there are mistakes.
    pub fn propagate(self) -> Result<(), Errors> {
        if self.list.is_empty() {
            Ok(())
        } else {
            Err(self)
        }
    }

    /// One `compile_error!` for each place, spanned over its tokens.
    pub fn to_compile_errors(&self) -> Vec<TokenStream> {
        let mut all = Vec::new();
        for d in &self.list {
            all.push(compile_error(d.place, &d.text()));
            all.extend(
                d.also
                    .iter()
                    .map(|(place, text)| compile_error(*place, text)),
            );
        }
        all
    }

    /// The mistakes as text for a terminal: file, line, column, the source line and carets.
    pub fn render(&self, source: &str, file: &str) -> String {
        self.list
            .iter()
            .map(|d| d.render("error", source, file))
            .collect()
    }
}

impl From<Diagnostic> for Errors {
    fn from(d: Diagnostic) -> Errors {
        Errors { list: vec![d] }
    }
}

impl core::fmt::Display for Errors {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for (i, d) in self.list.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{}", d.text())?;
        }
        Ok(())
    }
}

impl std::error::Error for Errors {}

/// Builds the `compile_error!` with spans such that rustc underlines from the first to the last token.
fn compile_error(place: Place, text: &str) -> TokenStream {
    let mut head = quote_spanned!(place.first=> ::core::compile_error!);
    head.extend(quote_spanned!(place.last=> { #text }));
    head
}

/// The indefinite article before a size in words: a digit, or letters. A single letter is read by its name, as in `an n
/// x n matrix`.
pub fn article(size: &str) -> &'static str {
    let word = size.split(|c: char| !c.is_alphanumeric()).next();
    let word = word.unwrap_or_default();
    let first = word.chars().next().map(|c| c.to_ascii_lowercase());
    let is_vowel = match first {
        Some('8') => true,
        Some('1') => matches!(word, "11" | "18"),
        Some(c) if word.chars().nth(1).is_none() => "aefhilmnorsx".contains(c),
        Some(c) => "aeio".contains(c),
        None => false,
    };
    if is_vowel { "an" } else { "a" }
}

/// The candidate closest to a misspelt name, if it is close: the same name in another case or in ASCII (`Gamma` for
/// `Γ`), or a name with a few letters changed, but not all letters.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    let limit = (length / 3).max(1).min(length.saturating_sub(1));
    let spelt = ascii(name);
    candidates
        .into_iter()
        .map(|c| match ascii(c).eq_ignore_ascii_case(&spelt) {
            true => (0, c),
            false => (edit_distance(name, c), c),
        })
        .filter(|(d, _)| *d <= limit)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().take(64).collect();
    let b: Vec<char> = b.chars().take(64).collect();
    // Edit distances of prefixes: the two previous rows and the current one.
    let mut rows = [Vec::new(), Vec::new(), (0..=b.len()).collect::<Vec<_>>()];
    for (i, x) in a.iter().enumerate() {
        rows.rotate_left(1);
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let changed = rows[1][j] + usize::from(x != y);
            let mut cost = changed.min(row[j] + 1).min(rows[1][j + 1] + 1);
            // Two transposed letters count as one mistake.
            if i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y {
                cost = cost.min(rows[0][j - 1] + 1);
            }
            row.push(cost);
        }
        rows[2] = row;
    }
    rows[2][b.len()]
}
