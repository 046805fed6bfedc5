//! Tests of the prover: identities of discrete mechanics, statements that must stay unproved, and a numerical check
//! of every rule in the table.

mod matrices;
mod mechanics;
mod numbers;
mod refusals;
mod soundness;
mod vectors;

use super::{Limits, Statement, Verdict, prove};
use clebsch_core::expr::shape::{Dim, Shape, Structure};
use clebsch_core::expr::symbol::{Role, Symbols};
use clebsch_core::expr::{Expr, here, transpose};

/// The dimension of all fixed-size letters in the tests.
const N: Dim = Dim::Fixed(3);

/// A symbol table under construction.
#[derive(Default)]
struct Desk {
    symbols: Symbols,
}

impl Desk {
    fn letter(&mut self, name: &str, shape: Shape, structure: Structure, role: Role) -> Expr {
        let id = self.symbols.add(name, shape, structure, role);
        here(&self.symbols, id)
    }

    fn matrix(&mut self, name: &str, structure: Structure) -> Expr {
        self.letter(name, Shape::square(N), structure, Role::Parameter)
    }

    fn general(&mut self, name: &str) -> Expr {
        self.matrix(name, Structure::General)
    }

    fn symmetric(&mut self, name: &str) -> Expr {
        self.matrix(name, Structure::Symmetric)
    }

    fn skew(&mut self, name: &str) -> Expr {
        self.letter(name, Shape::square(N), Structure::Skew, Role::Variation)
    }

    fn rotation(&mut self, name: &str) -> Expr {
        self.letter(name, Shape::square(N), Structure::Orthogonal, Role::Element)
    }

    fn vector(&mut self, name: &str) -> Expr {
        self.letter(name, Shape::vector(N), Structure::General, Role::Parameter)
    }

    fn scalar(&mut self, name: &str) -> Expr {
        self.letter(name, Shape::SCALAR, Structure::General, Role::Parameter)
    }

    fn t(&self, a: &Expr) -> Expr {
        transpose(&self.symbols, a.clone())
    }

    fn verdict(&self, name: &str, left: &Expr, right: &Expr) -> Verdict {
        let statement = Statement {
            name: name.to_owned(),
            left: left.clone(),
            right: right.clone(),
        };
        prove(&self.symbols, &statement, &Limits::default())
    }

    /// Asserts that a proof is found and that every line after the first names a rule.
    #[track_caller]
    fn proves(&self, name: &str, left: &Expr, right: &Expr) -> Vec<String> {
        match self.verdict(name, left, right) {
            Verdict::Proved { explanation, .. } => {
                assert!(!explanation.is_empty(), "{name}");
                for line in explanation.iter().skip(1) {
                    assert!(
                        line.starts_with("= ") && line.ends_with(']'),
                        "{name}: {line}"
                    );
                }
                explanation
            }
            Verdict::Unproved {
                reason,
                nodes,
                iterations,
            } => panic!("{name}: {reason} ({nodes} nodes, {iterations} iterations)"),
        }
    }

    /// Asserts that no proof is found within the limits, and returns the reason.
    #[track_caller]
    fn refuses(&self, name: &str, left: &Expr, right: &Expr) -> String {
        match self.verdict(name, left, right) {
            Verdict::Proved { explanation, .. } => {
                panic!(
                    "{name} is false but was proved:\n{}",
                    explanation.join("\n")
                )
            }
            Verdict::Unproved {
                reason,
                nodes,
                iterations,
            } => {
                // A rule that has started may finish its matches.
                assert!(
                    nodes <= 2 * Limits::default().nodes,
                    "{name}: {nodes} nodes"
                );
                assert!(iterations <= Limits::default().iterations, "{name}");
                reason
            }
        }
    }
}
