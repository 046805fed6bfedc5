//! Segments of words: an element, constants, and another element or the end. Each becomes one advected quantity.
//! Takes words; gives their factors with quantities in place of the segments.

use super::element::Open;
use super::terms::{LeftOver, Reduced, Reducer};
use crate::algebra::{Factor, Poly, Rational, Source, Term};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr};

impl Reducer<'_> {
    /// The factors of a word, with quantities in place of segments that contain elements.
    pub(super) fn word(&mut self, word: &[Factor], cyclic: bool) -> Result<Vec<Expr>, LeftOver> {
        let (minus, whole) = self.in_motions(word);
        let turns = if cyclic { whole.len() } else { 1 };
        for turn in 0..turns {
            let mut w = whole.clone();
            w.rotate_left(turn);
            if let Some(segments) = self.segments(&w) {
                let mut pieces = self.pieces(&w, &segments)?;
                if minus && let Some(first) = pieces.first_mut() {
                    *first = expr::neg(first.clone());
                }
                return Ok(pieces);
            }
        }
        match word.is_empty() {
            true => Ok(Vec::new()),
            false => Err(LeftOver),
        }
    }

    /// Ranges of factors, in order, in which constants absorb every element.
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
                    } else {
                        // A parameter with one index of each kind.
                        1 + (i + 1..stop).find(|j| self.absorbs(&w[*j]))?
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
                    let nearest = (start..i).rev().find(|j| self.absorbs(&w[*j]))?;
                    out.push((if row { 0 } else { nearest }, i + 1));
                    i += 1;
                }
            }
        }
        Some(out)
    }

    fn pieces(&mut self, w: &[Factor], segments: &[(usize, usize)]) -> Result<Vec<Expr>, LeftOver> {
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

    /// A factor that is not an element: its contents are reduced.
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
            Factor::Pure(word) => expr::pure(expr::product(self.word(word, false)?)),
            Factor::Imaginary { word, transposed } => {
                let inner = expr::product(self.word(word, false)?);
                transposed_if(self, expr::imaginary(inner), *transposed)
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
            | Factor::Inclusion { .. } => self.plain(std::slice::from_ref(f)),
        })
    }

    pub(super) fn plain(&self, word: &[Factor]) -> Expr {
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
}
