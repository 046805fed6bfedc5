//! Residuals that differ from the emitted one by one term, which tests of the derivation must detect.

use super::{Assignment, EvalError, Evaluator};
use crate::derive::Derivation;
use crate::expr::{self, Expr};
use crate::schedule::program;

impl Derivation {
    /// Every residual that differs from the emitted one in one term, which is dropped or has the opposite sign.
    pub fn mutations(&self) -> Vec<Mutant<'_>> {
        let s = &self.letters.symbols;
        let original = self.residual_expressions();
        let mut out = Vec::new();
        for (slot, e) in original.iter().enumerate() {
            for change in expr::changes(s, e) {
                let mut results = original.clone();
                results[slot] = change.changed;
                out.push(Mutant {
                    derivation: self,
                    residual: Evaluator::of(&program(s, &results, "t")),
                    term: change.term,
                    flipped: change.flipped,
                });
            }
        }
        out
    }
}

/// A residual with one term changed.
pub struct Mutant<'a> {
    derivation: &'a Derivation,
    residual: Evaluator,
    term: Expr,
    flipped: bool,
}

impl Mutant<'_> {
    /// The changed term and its change, in words.
    pub fn describe(&self) -> String {
        let style = crate::print::Style::new(&self.derivation.spec.time_index);
        let format = crate::print::Format::Text;
        let term =
            crate::print::expression(&self.term, &self.derivation.letters.symbols, &style, format);
        format!(
            "{} {term}",
            if self.flipped { "flipped" } else { "dropped" }
        )
    }

    /// Its value, as [`Derivation::residual`].
    pub fn residual(&self, values: &Assignment) -> Result<Vec<f64>, EvalError> {
        self.derivation.evaluate_residual(&self.residual, values)
    }
}
