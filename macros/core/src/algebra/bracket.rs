//! Canonical numbers made of words: brackets `u^T A v` (transposition, triple products, axial
//! vectors) and traces (rotation and transposition). A value that equals its opposite is zero.

use super::Algebra;
use super::factor::{Factor, Word};
use super::monomial::{Atom, Monomial};
use super::poly::{Poly, Term};
use super::rational::Rational;
use crate::expr::shape::{Dim, Shape};

fn sign(negative: bool) -> Rational {
    if negative {
        Rational::MINUS_ONE
    } else {
        Rational::ONE
    }
}

impl Algebra<'_> {
    fn atom(&self, coefficient: Rational, atom: Atom) -> Poly {
        let term = Term {
            monomial: vec![(atom, Rational::ONE)],
            word: Word::new(),
        };
        Poly::term(Shape::SCALAR, coefficient, term)
    }

    /// The value of a word that runs from a row to a column.
    pub(super) fn bracket(&self, word: &[Factor]) -> Poly {
        let zero = Poly::zero(Shape::SCALAR);
        if !self.spend(1) {
            return zero;
        }
        if let Some(value) = self.axial_bracket(word) {
            return value;
        }
        if let [
            Factor::Unit {
                axis: a,
                transposed: true,
                ..
            },
            Factor::Unit {
                axis: b,
                transposed: false,
                ..
            },
        ] = word
        {
            let value = if a == b {
                Rational::ONE
            } else {
                Rational::ZERO
            };
            return Poly::constant(Shape::SCALAR, value);
        }
        // Each pass puts the smaller vector under the hat, so that this ends.
        let mut negative = false;
        let mut best = word.to_vec();
        for _ in 0..8 {
            let Some((minus, ordered)) = self.ordered_triple(&best) else {
                return zero;
            };
            negative ^= minus;
            let (minus, back) = self.transposed_word(&ordered);
            let Some((minus2, back)) = self.ordered_triple(&back) else {
                return zero;
            };
            if back < ordered {
                negative ^= minus ^ minus2;
                best = back;
            } else {
                if back == ordered && (minus ^ minus2) {
                    return zero;
                }
                let done = ordered == best;
                best = ordered;
                if done {
                    break;
                }
            }
        }
        self.atom(sign(negative), Atom::Bracket(best))
    }

    /// `z . vee(X) = -tr(hat(z) X)/2`.
    fn axial_bracket(&self, word: &[Factor]) -> Option<Poly> {
        let (word, negative) = match (word.first()?, word.last()?) {
            (_, Factor::Vee { .. }) => (word.to_vec(), false),
            (Factor::Vee { .. }, _) => {
                let (minus, back) = self.transposed_word(word);
                (back, minus)
            }
            _ => return None,
        };
        let (row, last) = word.split_at(word.len() - 1);
        let Factor::Vee { word: x, .. } = &last[0] else {
            return None;
        };
        let (minus, z) = self.transposed_word(row);
        let half = Rational::HALF.times(sign(!(minus ^ negative)))?;
        let mut out = Poly::zero(Shape::SCALAR);
        for (t, c) in &self.hat_word(&z).terms {
            let whole = [&t.word[..], x].concat();
            let value = self.trace_word(&whole);
            let Some(c) = c.times(half) else {
                self.exhaust();
                return Some(out);
            };
            for (t2, c2) in &value.terms {
                match (
                    super::monomial::times(&t.monomial, &t2.monomial),
                    c.times(*c2),
                ) {
                    (Some(m), Some(c)) => self.push_term(&mut out, c, m, Word::new()),
                    _ => self.exhaust(),
                }
            }
        }
        Some(out)
    }

    /// In `... hat(u) G w` puts the smaller of `u` and `w` under the hat:
    /// `hat(u) G w = -G hat(w) G^T u`. `None` when the product vanishes.
    pub(super) fn ordered_triple(&self, word: &[Factor]) -> Option<(bool, Word)> {
        let Some(k) = word.iter().rposition(|f| matches!(f, Factor::Hat(_))) else {
            return Some((false, word.to_vec()));
        };
        let Factor::Hat(u) = &word[k] else {
            return Some((false, word.to_vec()));
        };
        let tail = &word[k + 1..];
        let front = tail.iter().take_while(|f| self.is_orthogonal(f)).count();
        let (g, w) = tail.split_at(front);
        if g.is_empty() && w == u.as_slice() {
            return None;
        }
        if w >= u.as_slice() {
            return Some((false, word.to_vec()));
        }
        let (_, g_back) = self.transposed_word(g);
        let hat = [Factor::Hat(w.to_vec())];
        let swapped = [&word[..k], g, &hat, &g_back, u].concat();
        Some((true, self.cancelled(swapped)))
    }

    /// The trace of a word.
    pub(super) fn trace_word(&self, word: &[Factor]) -> Poly {
        let zero = Poly::zero(Shape::SCALAR);
        if !self.spend(1 + word.len()) {
            return zero;
        }
        let mut word = self.cancelled(word.to_vec());
        while word.len() > 1 && self.cancel(&word[word.len() - 1], &word[0]) {
            word.pop();
            word.remove(0);
        }
        // A cut between a column and a row: the trace is a bracket.
        if let Some(i) = word
            .iter()
            .position(|f| self.shape_of(f).rows == Dim::Fixed(1))
        {
            word.rotate_left(i);
            let mut out = Poly::zero(Shape::SCALAR);
            self.push_reduced(&mut out, Rational::ONE, &Monomial::new(), word);
            return out;
        }
        if let [Factor::Hat(_)] = word.as_slice() {
            return zero;
        }
        // Hats that face each other across the end of the word.
        if let Some(i) = word.iter().position(|f| matches!(f, Factor::Hat(_))) {
            let before = word[..i].iter().rev().chain(word[i + 1..].iter().rev());
            let facing = before.take_while(|f| self.is_orthogonal(f)).count();
            let other = (2 * word.len() + i - facing - 1) % word.len();
            if other != i && matches!(word[other], Factor::Hat(_)) {
                word.rotate_left(other);
                let mut opened = Poly::zero(Shape::square(Dim::Fixed(3)));
                self.push_reduced(&mut opened, Rational::ONE, &Monomial::new(), word);
                return self.trace_poly(&opened);
            }
        }
        let (minus, back) = self.transposed_word(&word);
        let mut best: Option<(bool, Word)> = None;
        let mut both = false;
        for (negative, base) in [(false, &word), (minus, &back)] {
            for r in 0..base.len() {
                let mut candidate = base.clone();
                candidate.rotate_left(r);
                match &best {
                    Some((s, b)) if *b == candidate => both |= *s != negative,
                    Some((_, b)) if *b < candidate => {}
                    _ => {
                        both = false;
                        best = Some((negative, candidate));
                    }
                }
            }
        }
        match best {
            Some(_) if both => zero,
            Some((negative, word)) => self.atom(sign(negative), Atom::Trace(word)),
            None => zero,
        }
    }

    /// The trace of a polynomial.
    pub(super) fn trace_poly(&self, a: &Poly) -> Poly {
        let mut out = Poly::zero(Shape::SCALAR);
        for (t, c) in &a.terms {
            let value = if t.word.is_empty() {
                match a.shape.rows {
                    Dim::Fixed(n) => Poly::constant(Shape::SCALAR, Rational::integer(i64::from(n))),
                    Dim::Named(i) => self.atom(Rational::ONE, Atom::Dimension(i)),
                }
            } else {
                self.trace_word(&t.word)
            };
            for (t2, c2) in &value.terms {
                match (
                    super::monomial::times(&t.monomial, &t2.monomial),
                    c.times(*c2),
                ) {
                    (Some(m), Some(c)) => self.push_term(&mut out, c, m, Word::new()),
                    _ => self.exhaust(),
                }
            }
        }
        out
    }
}
