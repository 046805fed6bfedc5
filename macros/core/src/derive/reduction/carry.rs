//! Advected quantities for segments of words: a quantity that is already declared, or a new one with its name,
//! structure, definition and constraint. Takes segments; gives letters.

use super::relative::Frame;
use super::terms::{ReducedQuantity, Reducer};
use crate::algebra::{Factor, Word};
use crate::expr::shape::{Dim, Structure};
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr};

impl Reducer<'_> {
    /// The quantity that replaces a segment: one that is already declared, or a new one.
    pub(super) fn segment(&mut self, w: &[Factor]) -> Expr {
        // Λ^T hat(z) Λ = hat(Λ^T z).
        if let [first, Factor::Hat(inner), last] = w
            && self.open(first).is_some()
            && self.open(last).is_some()
            && self
                .algebra
                .cancelled_word(vec![last.clone(), first.clone()])
                .is_empty()
        {
            let vector = [&[first.clone()][..], inner].concat();
            return expr::hat(self.segment(&vector));
        }
        let (minus, back) = self.algebra.transposed_of(w);
        if let Some(c) = self.carried.iter().find(|c| c.word == w) {
            return expr::here(&self.symbols, c.quantity);
        }
        if let Some(c) = self.carried.iter().find(|c| c.word == back) {
            let own = expr::here(&self.symbols, c.quantity);
            let e = expr::transpose(&self.symbols, own);
            return if minus { expr::neg(e) } else { e };
        }
        let ends = [w.first(), w.last()].map(|f| f.and_then(|f| self.body(f)));
        if let [Some(from), Some(to)] = ends
            && self.is_relative(w)
            && let Some(path) = self.path(from, to)
        {
            return expr::product(path);
        }
        // Columns rather than rows; for relative elements, those that start with the first body.
        let row = self.algebra.factor_shape(&w[0]).rows == Dim::Fixed(1);
        let later = matches!(ends, [Some(a), Some(b)] if a > b);
        let turned = row || (later && !minus);
        let own = if turned { back.clone() } else { w.to_vec() };
        let e = match self.part_of_plane(&own) {
            Some(part) => part,
            None => {
                let quantity = self.declare(&own, back == *w && !minus, back == *w && minus);
                expr::here(&self.symbols, quantity)
            }
        };
        match (turned, minus) {
            (false, _) => e,
            (true, false) => expr::transpose(&self.symbols, e),
            (true, true) => expr::neg(expr::transpose(&self.symbols, e)),
        }
    }

    /// The element of a factor, and whether the factor is the element's rotation.
    fn body(&self, f: &Factor) -> Option<Frame> {
        let o = self.occurrence(f)?;
        Some((o.configuration.element, o.rotation))
    }

    /// The planes that were found.
    pub(super) fn planes(&self) -> Vec<Word> {
        let found = self.carried.iter().filter(|c| self.is_plane(&c.word));
        found.map(|c| c.word.clone()).collect()
    }

    /// Declares the quantities of these words.
    pub(super) fn declare_all(&mut self, words: &[Word]) {
        for w in words {
            self.declare(w, false, false);
        }
    }

    /// `R^T z` by the plane `G^T ι z`, if this plane is advected.
    fn part_of_plane(&self, w: &[Factor]) -> Option<Expr> {
        let plane = self.plane_of(w)?;
        let c = self.carried.iter().find(|c| c.word == plane)?;
        let inclusion = self.plain(&plane[1..2]);
        let part = expr::transpose(&self.symbols, inclusion);
        Some(expr::mul(part, expr::here(&self.symbols, c.quantity)))
    }

    /// Declares the quantity of a word: name, structure, definition, constraint.
    fn declare(&mut self, w: &[Factor], symmetric: bool, skew: bool) -> SymbolId {
        let definition = self.plain(w);
        let shape = definition.shape();
        let of_group = self.algebra.structure_of_word(w);
        let structure = if symmetric && shape.is_square() {
            Structure::Symmetric
        } else if skew && shape.is_square() {
            Structure::Skew
        } else {
            of_group.unwrap_or(Structure::General)
        };
        let name = self.symbols.fresh_name(&self.name(w, &definition));
        let quantity = self.symbols.add(&name, shape, structure, Role::Advected);
        let own = expr::here(&self.symbols, quantity);
        // Λ becomes Λ Ω: the velocity, in the same mode as the element, is next to the quantity.
        let velocity = |f: &Factor| -> Option<Expr> {
            let o = self.occurrence(f)?;
            let mut v = expr::here(&self.symbols, o.configuration.velocity);
            if o.rotation {
                v = expr::rotation(&self.symbols, v);
            }
            if o.inverted {
                v = expr::inverse(&self.symbols, v);
            }
            if o.transposed {
                v = expr::transpose(&self.symbols, v);
            }
            Some(v)
        };
        let ends =
            (w.len() > 1).then(|| (w.first().and_then(velocity), w.last().and_then(velocity)));
        let (left, right) = ends.unwrap_or((None, None));
        let update = expr::product(
            left.into_iter()
                .chain([own])
                .chain(right)
                .collect::<Vec<_>>(),
        );
        self.carried.push(ReducedQuantity {
            quantity,
            word: w.to_vec(),
            definition,
            update,
        });
        quantity
    }

    /// `z_body` for `Λ^T z`, `J_space` for `Λ J Λ^T`, `relative` for `Λ1^T Λ2`.
    fn name(&self, w: &[Factor], definition: &Expr) -> String {
        let s = &self.symbols;
        let letters = expr::letters(definition);
        let of_role = |role: Role| {
            let list = letters.iter().filter(move |l| s.get(l.symbol).role == role);
            list.map(|l| s.get(l.symbol).name.clone())
                .collect::<Vec<_>>()
        };
        let (elements, parameters) = (of_role(Role::Element), of_role(Role::Parameter));
        let side = self.spec.configurations.iter().find(|c| {
            let name = &s.get(c.element).name;
            elements.contains(name)
        });
        let frame = side.map_or("body", |c| c.side.frame());
        let unit = w.iter().find_map(|f| match f {
            Factor::Unit { axis, .. } => Some(format!("E{}", axis + 1)),
            _ => None,
        });
        let base = if parameters.is_empty() {
            unit
        } else {
            Some(parameters.join("_"))
        };
        let several = self.spec.configurations.len() > 1;
        match base {
            Some(base) if several => format!("{base}_{frame}_{}", elements.join("_")),
            Some(base) => format!("{base}_{frame}"),
            None if elements.len() > 1 => format!("relative_{}", elements.join("_")),
            None => format!("metric_{}", elements.join("_")),
        }
    }
}
