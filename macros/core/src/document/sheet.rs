//! Shared by all sections of a derivation: the derivation, its citations, names that the model does not use, and
//! common formulas.

use super::citations::{Citations, Place};
use crate::check::spec::Configuration;
use crate::derive::Derivation;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::document::Inline;
use crate::print::formula::Formula;

/// A derivation and its citations, from which sections are written.
pub struct Sheet<'a> {
    /// The derivation.
    pub d: &'a Derivation,
    /// Its citations.
    pub citations: Citations,
}

impl<'a> Sheet<'a> {
    /// Wraps a derivation and its citations.
    pub fn new(d: &'a Derivation, citations: Citations) -> Sheet<'a> {
        Sheet { d, citations }
    }

    /// The source of an equation, if the model cites one.
    pub fn source(&self, place: Place<'_>) -> Option<String> {
        self.citations.of(place)
    }

    /// The model's name of a symbol.
    pub fn name_of(&self, symbol: SymbolId) -> &'a str {
        &self.symbols().get(symbol).name
    }

    /// The symbols.
    pub fn symbols(&self) -> &'a Symbols {
        &self.d.letters.symbols
    }

    /// An expression with like terms collected.
    pub fn math(&self, e: &Expr) -> Formula {
        Formula::Expr(expr::shown(self.symbols(), e))
    }

    /// A derived expression with like terms collected and a positive term first.
    pub fn derived(&self, e: &Expr) -> Formula {
        Formula::Expr(expr::positive_first(&expr::shown(self.symbols(), e)))
    }

    /// A symbol at an offset.
    pub fn at(&self, symbol: SymbolId, shift: Shift) -> Formula {
        Formula::Expr(expr::letter(self.symbols(), symbol, shift))
    }

    /// A symbol at the node of the equation.
    pub fn here(&self, symbol: SymbolId) -> Formula {
        self.at(symbol, Shift::HERE)
    }

    /// The name of the time index with an offset, `k-1`.
    pub fn index(&self, by: i8) -> String {
        let k = &self.d.spec.time_index;
        match by {
            0 => k.clone(),
            n if n > 0 => format!("{k}+{n}"),
            n => format!("{k}{n}"),
        }
    }

    /// A name that the model does not use, with the number of the configuration if there are several.
    pub fn name(&self, base: &str, i: usize) -> Formula {
        let many = self.d.spec.configurations.len() > 1;
        let wanted = if many {
            format!("{base}{}", i + 1)
        } else {
            base.to_owned()
        };
        Formula::name(&self.symbols().fresh_name(&wanted))
    }

    /// A dummy letter for a definition: its usual name unless the model uses that name.
    pub fn free(&self, base: &str) -> Formula {
        Formula::name(&self.d.spec.symbols.fresh_name(base))
    }

    /// The momentum map of the multipliers at node `k`: `J^R`, of right translation, on the body side; `J^L`, of left
    /// translation, on the spatial side.
    pub fn lifted(&self, i: usize, by: i8) -> Formula {
        let many = self.d.spec.configurations.len() > 1;
        let number = if many {
            format!("{},", i + 1)
        } else {
            String::new()
        };
        let acting = self.d.spec.configurations.get(i);
        let side = acting.map_or("R", |c| c.side.of("R", "L"));
        Formula::name(&format!("J^{side}_{{{number}{}}}", self.index(by)))
    }

    /// The edge momentum at an offset.
    pub fn edge_momentum(&self, i: usize, shift: Shift) -> Formula {
        match self.d.letters.edge_momentum.get(i) {
            Some(symbol) => self.at(*symbol, shift),
            None => Formula::name("M"),
        }
    }

    /// The gradient, at node `k`, of the action of the edge that starts at node `k + by`.
    pub fn gradient(&self, by: i8, symbol: SymbolId) -> Formula {
        let of = format!("ℓ_{{{}}}", self.index(by));
        Formula::gradient(
            &of,
            Letter {
                symbol,
                shift: Shift::HERE,
            },
        )
    }

    /// The name of the group: `SO(3)`, `GL(n)`, `SU(2)`, `SE(3)`, `a vector of 3 components`.
    pub fn group(&self, c: &Configuration) -> String {
        c.group.name(&|n| self.symbols().dim_text(n).to_string())
    }

    /// Whether elements of the Lie algebra are written as vectors.
    pub fn has_vectors(&self, c: &Configuration) -> bool {
        c.group.is_of_space()
    }

    /// Whether the variation of configuration `i` changes advected quantity `j`.
    pub fn moves(&self, i: usize, j: usize) -> bool {
        let change = self.d.variations.get(i).and_then(|v| v.advected.get(j));
        change.is_some_and(|(_, e)| !e.is_zero())
    }
}

/// Joins parts of a sentence with commas and `and`.
pub fn listed(parts: Vec<Vec<Inline>>) -> Vec<Inline> {
    let last = parts.len().saturating_sub(1);
    let mut out = Vec::new();
    for (i, part) in parts.into_iter().enumerate() {
        if i > 0 {
            out.push(if i == last {
                " and ".into()
            } else {
                ", ".into()
            });
        }
        out.extend(part);
    }
    out
}

/// References to equations by their labels: `(7) and (8)`.
pub fn references(labels: &[String]) -> Vec<Inline> {
    listed(labels.iter().map(|l| vec![Inline::reference(l)]).collect())
}
