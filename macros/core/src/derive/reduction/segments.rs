//! Segments of words: an element, constants, an element again or the end. Each is one quantity that
//! the group carries. Takes words; gives their factors with quantities in place of the segments.

use super::terms::{Carried, LeftOver, Open, Reduced, Reducer};
use crate::algebra::{Factor, Poly, Rational, Source, Term};
use crate::check::spec::Side;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr};

impl Reducer<'_> {
    /// The factors of a word, segments that hold elements replaced by quantities.
    pub(super) fn word(
        &mut self,
        word: &[Factor],
        cyclic: bool,
    ) -> Result<Vec<Expr>, Box<LeftOver>> {
        let turns = if cyclic { word.len() } else { 1 };
        for turn in 0..turns {
            let mut w = word.to_vec();
            w.rotate_left(turn);
            if let Some(segments) = self.segments(&w) {
                return self.pieces(&w, &segments);
            }
        }
        let term = Term {
            monomial: Vec::new(),
            word: word.to_vec(),
        };
        let (Some(first), Some(last)) = (word.first(), word.last()) else {
            return Ok(Vec::new());
        };
        let shape = Shape {
            rows: self.algebra.factor_shape(first).rows,
            cols: self.algebra.factor_shape(last).cols,
        };
        let e = self.algebra.raise(&Poly::term(shape, Rational::ONE, term));
        let e = if cyclic { expr::trace(e) } else { e };
        Err(Box::new(LeftOver(e)))
    }

    /// Ranges of factors, in order, that together with constants absorb every element.
    fn segments(&self, w: &[Factor]) -> Option<Vec<(usize, usize)>> {
        let n = w.len();
        let opens: Vec<Option<Open>> = w.iter().map(|f| self.open(f)).collect();
        let mut out: Vec<(usize, usize)> = Vec::new();
        let mut i = 0;
        while i < n {
            match opens[i] {
                None => i += 1,
                Some(Open::Right) => {
                    let stop = (i + 1..n)
                        .find(|j| opens[*j].is_some() || !self.is_constant(&w[*j]))
                        .unwrap_or(n);
                    let closes = stop < n && opens[stop] == Some(Open::Left);
                    let column =
                        stop == n && self.algebra.factor_shape(&w[n - 1]).cols == Dim::Fixed(1);
                    let end = if closes {
                        stop + 1
                    } else if column {
                        n
                    } else if stop > i + 1 {
                        // A parameter with one index of either kind.
                        i + 2
                    } else {
                        return None;
                    };
                    out.push((i, end));
                    i = end;
                }
                Some(Open::Left) => {
                    let from = out.last().map_or(0, |(_, end)| *end);
                    let start = (from..i)
                        .rev()
                        .take_while(|j| self.is_constant(&w[*j]))
                        .last()?;
                    let row = start == 0 && self.algebra.factor_shape(&w[0]).rows == Dim::Fixed(1);
                    out.push((if row { 0 } else { i - 1 }, i + 1));
                    i += 1;
                }
            }
        }
        Some(out)
    }

    fn pieces(
        &mut self,
        w: &[Factor],
        segments: &[(usize, usize)],
    ) -> Result<Vec<Expr>, Box<LeftOver>> {
        let mut out = Vec::new();
        let mut i = 0;
        for (start, end) in segments.iter().copied().chain([(w.len(), w.len())]) {
            for f in &w[i..start] {
                out.push(self.factor(f)?);
            }
            if start < end {
                out.push(self.segment(&w[start..end]));
            }
            i = end;
        }
        Ok(out)
    }

    /// A factor that is no element: what it holds inside is reduced.
    fn factor(&mut self, f: &Factor) -> Reduced {
        let transposed_if = |r: &Self, e: Expr, t: bool| match t {
            true => expr::transpose(&r.symbols, e),
            false => e,
        };
        Ok(match f {
            Factor::Hat(word) if !matches!(word.as_slice(), [Factor::Axial { .. }]) => {
                expr::hat(expr::product(self.word(word, false)?))
            }
            Factor::Vee { word, transposed } => {
                let inner = expr::product(self.word(word, false)?);
                transposed_if(self, expr::vee(inner), *transposed)
            }
            Factor::Letter {
                source: Source::Opaque(i),
                transposed,
                inverted,
            } => {
                let e = self.opaque_matrix(*i)?;
                let e = match inverted {
                    true => expr::inverse(&self.symbols, e),
                    false => e,
                };
                transposed_if(self, e, *transposed)
            }
            Factor::Hat(_)
            | Factor::Letter { .. }
            | Factor::Unit { .. }
            | Factor::Axial { .. }
            | Factor::Inclusion { .. }
            | Factor::Pure(_)
            | Factor::Imaginary { .. } => self.plain(std::slice::from_ref(f)),
        })
    }

    fn plain(&self, word: &[Factor]) -> Expr {
        let (Some(first), Some(last)) = (word.first(), word.last()) else {
            return expr::integer(1);
        };
        let shape = Shape {
            rows: self.algebra.factor_shape(first).rows,
            cols: self.algebra.factor_shape(last).cols,
        };
        let term = Term {
            monomial: Vec::new(),
            word: word.to_vec(),
        };
        self.algebra.raise(&Poly::term(shape, Rational::ONE, term))
    }

    /// The quantity that stands for a segment: known already, or a new one.
    fn segment(&mut self, w: &[Factor]) -> Expr {
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
        if let [Some(from), Some(to)] =
            [w.first(), w.last()].map(|f| f.and_then(|f| self.element(f)))
            && w.len() == 2
            && let Some(path) = self.path(from, to)
        {
            return expr::product(path);
        }
        // Columns rather than rows, and of relative elements those from the first body on.
        let row = self.algebra.factor_shape(&w[0]).rows == Dim::Fixed(1);
        let later = matches!((w.first().and_then(|f| self.element(f)), w.last().and_then(|f| self.element(f))), (Some(a), Some(b)) if a > b);
        let turned = row || (later && !minus);
        let own = if turned { back.clone() } else { w.to_vec() };
        let quantity = self.declare(&own, back == *w && !minus, back == *w && minus);
        let e = expr::here(&self.symbols, quantity);
        match (turned, minus) {
            (false, _) => e,
            (true, false) => expr::transpose(&self.symbols, e),
            (true, true) => expr::neg(expr::transpose(&self.symbols, e)),
        }
    }

    /// The element of a factor.
    fn element(&self, f: &Factor) -> Option<SymbolId> {
        let Factor::Letter {
            source: Source::Letter(l),
            ..
        } = f
        else {
            return None;
        };
        self.configuration(l.symbol).map(|c| c.element)
    }

    /// Rotations from one body's frame to another's by those that are carried already: three
    /// bodies have two relative attitudes, whatever pairs the statement names.
    fn path(&self, from: SymbolId, to: SymbolId) -> Option<Vec<Expr>> {
        let mut reached: Vec<(SymbolId, Vec<Expr>)> = vec![(from, Vec::new())];
        let mut k = 0;
        while let Some((body, way)) = reached.get(k).cloned() {
            k += 1;
            if body == to {
                return Some(way);
            }
            for c in &self.carried {
                let [a, b] = c.word.as_slice() else { continue };
                let (Some(a), Some(b)) = (self.element(a), self.element(b)) else {
                    continue;
                };
                if self.symbols.get(c.quantity).structure != Structure::Orthogonal {
                    continue;
                }
                let own = expr::here(&self.symbols, c.quantity);
                let back = expr::transpose(&self.symbols, own.clone());
                for (start, end, e) in [(a, b, own), (b, a, back)] {
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

    /// Declares the quantity of a word: name, structure, definition, constraint.
    fn declare(&mut self, w: &[Factor], symmetric: bool, skew: bool) -> SymbolId {
        let definition = self.plain(w);
        let shape = definition.shape();
        let orthogonal = w.iter().all(|f| self.algebra.is_rotation(f));
        let structure = if symmetric && shape.is_square() {
            Structure::Symmetric
        } else if skew && shape.is_square() {
            Structure::Skew
        } else if orthogonal {
            Structure::Orthogonal
        } else {
            Structure::General
        };
        let name = self.symbols.fresh_name(&self.name(w, &definition));
        let quantity = self.symbols.add(&name, shape, structure, Role::Advected);
        let own = expr::here(&self.symbols, quantity);
        // Λ becomes Λ Ω: next to the quantity stands the velocity in the mode of the element.
        let velocity = |f: &Factor| -> Option<Expr> {
            let Factor::Letter {
                source: Source::Letter(l),
                transposed,
                inverted,
            } = f
            else {
                return None;
            };
            let c = self.configuration(l.symbol)?;
            let mut v = expr::here(&self.symbols, c.velocity);
            if *inverted {
                v = expr::inverse(&self.symbols, v);
            }
            if *transposed {
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
        self.carried.push(Carried {
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
        let frame = match side.map(|c| c.side) {
            Some(Side::Spatial) => "space",
            Some(Side::Body) | None => "body",
        };
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
