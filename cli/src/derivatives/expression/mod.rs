//! Expressions in observables and invariants, such as `X[1]^2 + X[2]^2` or `energy`, with exact derivatives. Takes a
//! text and a card; gives a function of all observables and invariants.

mod names;
mod parse;
mod tokens;
mod tree;

use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clebsch::card::Card;
use names::Names;
use tree::Tree;

/// A function of one number, with its name and derivative.
type Function = (&'static str, fn(f64) -> f64, fn(f64) -> f64);

/// The functions of expressions.
const FUNCTIONS: [Function; 13] = [
    ("sin", f64::sin, f64::cos),
    ("cos", f64::cos, |x| -x.sin()),
    ("tan", f64::tan, |x| 1.0 / x.cos().powi(2)),
    ("asin", f64::asin, |x| 1.0 / (1.0 - x * x).sqrt()),
    ("acos", f64::acos, |x| -1.0 / (1.0 - x * x).sqrt()),
    ("atan", f64::atan, |x| 1.0 / (1.0 + x * x)),
    ("sinh", f64::sinh, f64::cosh),
    ("cosh", f64::cosh, f64::sinh),
    ("tanh", f64::tanh, |x| 1.0 / x.cosh().powi(2)),
    ("exp", f64::exp, f64::exp),
    ("log", f64::ln, |x| 1.0 / x),
    ("sqrt", f64::sqrt, |x| 0.5 / x.sqrt()),
    ("abs", f64::abs, |x| {
        if x == 0.0 { f64::NAN } else { x.signum() }
    }),
];

/// An expression in the observables and invariants of a card.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    text: String,
    tree: Tree,
    /// The observables and invariants in it, by their places.
    used: Vec<usize>,
}

/// A mistake in the text of an expression.
#[derive(Debug)]
struct Mistake {
    /// The first wrong character, counted from 0.
    at: usize,
    /// The number of wrong characters.
    length: usize,
    /// The fault.
    what: String,
    /// The way out.
    remedy: String,
}

impl Mistake {
    /// The message, with the wrong characters marked.
    fn message(&self, option: &str, text: &str) -> String {
        // Control characters would move the marks.
        let line: String = text
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        format!(
            "{option}, column {}: {}\n  {}\n  {}{}\n{}",
            self.at + 1,
            self.what,
            shown(line.as_str()),
            " ".repeat(self.at),
            "^".repeat(self.length.max(1)),
            self.remedy
        )
    }
}

impl Expression {
    /// Reads an expression, which the option `option` gave.
    ///
    /// # Errors
    /// Usage: the text is wrong; the message marks the place and lists names.
    pub fn read(text: &str, card: &Card, option: &str) -> Result<Self, Failure> {
        let tree = tokens::tokens(text).and_then(|tokens| parse::parse(&tokens, &Names::of(card)));
        let tree = tree.map_err(|mistake| Failure::Usage(mistake.message(option, text)))?;
        let mut used = Vec::new();
        tree.each(&mut |at| {
            if !used.contains(&at) {
                used.push(at);
            }
        });
        Ok(Self {
            text: text.trim().to_owned(),
            tree,
            used,
        })
    }

    /// The expression as given.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its value, from the observables and the invariants.
    pub fn value(&self, seen: &[f64]) -> f64 {
        self.tree.dual(seen, &mut |_| None).0
    }

    /// Adds its derivatives to the weights of observables and of invariants, as a cost of a run needs.
    pub fn weigh(&self, seen: &[f64], weights: &mut [f64], of_invariants: &mut [f64]) {
        for (at, slope) in self.slopes(seen) {
            let place = match at.checked_sub(weights.len()) {
                None => weights.get_mut(at),
                Some(at) => of_invariants.get_mut(at),
            };
            if let Some(place) = place {
                *place += slope;
            }
        }
    }

    /// Its derivatives: the places of observables and invariants in it, with the derivative in each.
    fn slopes(&self, seen: &[f64]) -> Vec<(usize, f64)> {
        let along = |at: usize| {
            let unit = &mut |own: usize| (own == at).then_some(1.0);
            (at, self.tree.dual(seen, unit).1)
        };
        self.used.iter().copied().map(along).collect()
    }
}

/// The parts of a list at its commas outside brackets.
pub(crate) fn parts(text: &str) -> Vec<&str> {
    let (mut depth, mut from, mut all) = (0_i32, 0, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' if depth == 0 => {
                all.push(text.get(from..at).unwrap_or_default().trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    all.push(text.get(from..).unwrap_or_default().trim());
    all
}

#[cfg(test)]
mod tests {
    use super::{FUNCTIONS, parts};

    #[test]
    fn derivatives_of_functions_are_limits_of_differences() {
        for (name, of, slope) in FUNCTIONS {
            let (x, d) = (0.37, 1e-5);
            let expected = (of(x + d) - of(x - d)) / (2.0 * d);
            assert!((slope(x) - expected).abs() < 1e-9, "{name}");
        }
    }

    #[test]
    fn lists_are_split_outside_brackets() {
        assert_eq!(parts("A[1, 2], atan(x), y"), ["A[1, 2]", "atan(x)", "y"]);
    }
}
