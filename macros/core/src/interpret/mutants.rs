//! Residuals that differ from the emitted one by one term: what tests of the derivation must notice.

use super::{Assignment, EvalError, Evaluator};
use crate::derive::Derivation;
use crate::expr::{self, Expr};
use crate::schedule::program;

impl Derivation {
    /// Every residual that differs from the emitted one by one term: dropped, or with its sign
    /// flipped.
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
    /// Which term, and what was done to it.
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
