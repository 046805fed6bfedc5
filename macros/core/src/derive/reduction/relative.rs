//! Elements of SU(2) and SE(3) that occur only relative to one another: several bodies are expressed by the first one
//! and the relative motions. If the first one cancels, the relative motions are the advected quantities. Takes
//! scalars; gives them in relative motions, which it declares.

use super::cancelled_elements::settled;
use super::terms::{ReducedQuantity, Reducer};
use crate::check::spec::Configuration;
use crate::derive::variation::at;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Shift};

/// The frame of a body, given by its element; with `true`, by the rotation of that element only.
pub(super) type Frame = (SymbolId, bool);

impl<'a> Reducer<'a> {
    /// A scalar in relative motions, if no element remains.
    pub(super) fn relative(&mut self, e: &Expr) -> Option<Expr> {
        let used = expr::letters(e);
        let all = self.spec.configurations.iter();
        let present: Vec<&'a Configuration> = all
            .filter(|c| used.contains(&at(c.element, Shift::HERE)))
            .filter(|c| c.group.coordinates().is_some())
            .collect();
        let [first, others @ ..] = present.as_slice() else {
            return None;
        };
        let same = |c: &&Configuration| c.group == first.group && c.side == first.side;
        if others.is_empty() || !others.iter().all(same) {
            return None;
        }
        // The quantities are kept only if the reduction succeeds.
        let known = (self.symbols.clone(), self.carried.len());
        let replaced: Vec<(Letter, Expr)> = others
            .iter()
            .map(|c| (at(c.element, Shift::HERE), self.by_first(first, c)))
            .collect();
        let symbols = self.symbols.clone();
        let trial = self.algebra.over(&symbols);
        let holds = |e: &Expr| expr::contains_role(&symbols, e, Role::Element);
        let e = settled(&trial, &holds, &expr::substitute(&symbols, e, &replaced));
        let e = match holds(&e) {
            true => trial.raise(&trial.lower(&e)),
            false => e,
        };
        self.algebra.charge(&trial);
        if holds(&e) || trial.exhausted() {
            self.symbols = known.0;
            self.carried.truncate(known.1);
            return None;
        }
        Some(e)
    }

    /// The element of a body, expressed by the element of the first body: `G1 (G1^-1 G2)`, or `(G1 G2^-1)^-1 G1`.
    fn by_first(&mut self, first: &Configuration, c: &Configuration) -> Expr {
        let between = self.motion_between(first, c);
        let g = expr::here(&self.symbols, first.element);
        if c.side.is_body() {
            expr::mul(g, between)
        } else {
            expr::mul(expr::inverse(&self.symbols, between), g)
        }
    }

    /// The relative motion, expressed by advected ones, or a new one.
    fn motion_between(&mut self, a: &Configuration, b: &Configuration) -> Expr {
        if let Some(path) = self.path((a.element, false), (b.element, false)) {
            return expr::product(path);
        }
        let s = &self.symbols;
        let between = |s: &crate::expr::symbol::Symbols, x: SymbolId, middle: Option<Expr>, y| {
            let (x, y) = (expr::here(s, x), expr::here(s, y));
            let (x, y) = if a.side.is_body() {
                (expr::inverse(s, x), y)
            } else {
                (x, expr::inverse(s, y))
            };
            expr::product([x].into_iter().chain(middle).chain([y]))
        };
        let definition = between(s, a.element, None, b.element);
        let name = format!(
            "relative_{}_{}",
            s.get(a.element).name,
            s.get(b.element).name
        );
        let word = self.algebra.lower(&definition);
        let word = word.terms.keys().next().map(|t| t.word.clone());
        let name = self.symbols.fresh_name(&name);
        let structure = a.group.structure();
        let shape = definition.shape();
        let quantity = self.symbols.add(&name, shape, structure, Role::Advected);
        let own = expr::here(&self.symbols, quantity);
        let update = between(&self.symbols, a.velocity, Some(own.clone()), b.velocity);
        self.carried.push(ReducedQuantity {
            quantity,
            word: word.unwrap_or_default(),
            definition,
            update,
        });
        own
    }

    /// The path from one body's frame to another's by relative elements that are already advected: three bodies need
    /// two of them, for any pairs in the statement. Whole elements also give their rotations.
    pub(super) fn path(&self, from: Frame, to: Frame) -> Option<Vec<Expr>> {
        let mut reached: Vec<(Frame, Vec<Expr>)> = vec![(from, Vec::new())];
        let mut k = 0;
        while let Some((body, way)) = reached.get(k).cloned() {
            k += 1;
            if body == to {
                return Some(way);
            }
            for c in &self.carried {
                for (start, end, e) in self.steps(c, body.1) {
                    if start == body && reached.iter().all(|(r, _)| *r != end) {
                        let mut longer = way.clone();
                        longer.push(e);
                        reached.push((end, longer));
                    }
                }
            }
        }
        None
    }

    /// An advected relative element as a step between two bodies, in both directions.
    fn steps(&self, c: &ReducedQuantity, rotation: bool) -> Vec<(Frame, Frame, Expr)> {
        let [a, b] = c.word.as_slice() else {
            return Vec::new();
        };
        let (Some(a), Some(b)) = (self.occurrence(a), self.occurrence(b)) else {
            return Vec::new();
        };
        let structure = self.symbols.get(c.quantity).structure;
        if !structure.is_invertible() || structure == Structure::Invertible {
            return Vec::new();
        }
        let whole = expr::here(&self.symbols, c.quantity);
        let own = match structure {
            Structure::Orthogonal => whole,
            _ if rotation => expr::rotation(&self.symbols, whole),
            _ => whole,
        };
        let key = |o: &super::element::Occurrence| {
            let turns = o.rotation || (rotation && structure != Structure::Orthogonal);
            (o.configuration.element, turns)
        };
        let back = expr::inverse(&self.symbols, own.clone());
        vec![(key(&a), key(&b), own), (key(&b), key(&a), back)]
    }

    /// Whether a word of two elements is one relative to the other.
    pub(super) fn is_relative(&self, word: &[crate::algebra::Factor]) -> bool {
        let [a, b] = word else { return false };
        match (self.occurrence(a), self.occurrence(b)) {
            (Some(a), Some(b)) => {
                (a.is_inverse() && b.is_plain()) || (a.is_plain() && b.is_inverse())
            }
            _ => false,
        }
    }
}
