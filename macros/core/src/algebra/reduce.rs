//! Reduction of words: cancellation of inverses, extraction of scalars (`u^T A v`), hats and axial vectors of words.
//! The resulting words are canonical, and scalars move to the monomial.

use super::factor::{Factor, Word};
use super::monomial::{self, Atom, Monomial};
use super::poly::{Poly, Term};
use super::rational::Rational;
use super::{Algebra, Excess, WORD_LIMIT, term_limit};
use crate::expr::shape::{Dim, Shape};

impl Algebra<'_> {
    /// Removes `g g^-1` wherever it occurs.
    pub(super) fn cancelled(&self, word: Word) -> Word {
        let mut out: Word = Vec::with_capacity(word.len());
        for f in word {
            if out.last().is_some_and(|last| self.cancel(last, &f)) {
                out.pop();
            } else {
                out.push(f);
            }
        }
        // Products of constant factors may become shorter, which may allow further cancellation.
        let shorter = out.windows(2).enumerate().find_map(|(i, pair)| {
            let [a, b] = pair else { return None };
            let new = self.constant_pair(a, b)??;
            Some([&out[..i], &new, &out[i + 2..]].concat())
        });
        match shorter {
            Some(word) => self.cancelled(word),
            None => out,
        }
    }

    /// Adds `coefficient * monomial * word`, with the word brought to canonical form, to `out`.
    pub(super) fn push_reduced(
        &self,
        out: &mut Poly,
        coefficient: Rational,
        monomial: &Monomial,
        word: Word,
    ) {
        if coefficient.is_zero() || !self.spend(1 + word.len() / 4) {
            return;
        }
        if word.len() > WORD_LIMIT || out.terms.len() > term_limit() {
            self.note(match word.len() > WORD_LIMIT {
                true => Excess::Word(word.len()),
                false => Excess::Terms(out.terms.len()),
            });
            return self.exhaust();
        }
        let word = self.cancelled(word);
        let vanishes = |pair: &[Factor]| match pair {
            [a, b] => self.constant_pair(a, b) == Some(None),
            _ => false,
        };
        if word.windows(2).any(vanishes) {
            return;
        }
        if let Some(moved) = self.pure_in_front(&word) {
            return self.push_reduced(out, coefficient, monomial, moved);
        }
        if let Some(terms) = self.pure_product(&word) {
            for (c, m, w) in terms {
                match (monomial::times(monomial, &m), coefficient.times(c)) {
                    (Some(m), Some(c)) => self.push_reduced(out, c, &m, w),
                    _ => self.exhaust(),
                }
            }
            return;
        }
        if let Some((a, b)) = self.number_inside(&word) {
            let value = self.bracket(&word[a..b]);
            let mut rest = word;
            rest.drain(a..b);
            for (t, c) in &value.terms {
                match (
                    monomial::times(monomial, &t.monomial),
                    coefficient.times(*c),
                ) {
                    (Some(m), Some(c)) => self.push_reduced(out, c, &m, rest.clone()),
                    _ => self.exhaust(),
                }
            }
            return;
        }
        // A vector product has one order: hat(u) w = -hat(w) u.
        if self.is_column(&word) {
            match self.ordered_triple(&word) {
                None => return,
                Some((true, swapped)) => {
                    return self.push_reduced(out, coefficient.negated(), monomial, swapped);
                }
                Some((false, _)) => {}
            }
        }
        self.push_term(out, coefficient, monomial.clone(), word);
    }

    /// Whether the word is a column vector that starts with a matrix.
    fn is_column(&self, word: &[Factor]) -> bool {
        let one = Dim::Fixed(1);
        word.len() > 1
            && word.last().is_some_and(|f| self.shape_of(f).cols == one)
            && word.iter().all(|f| self.shape_of(f).rows != one)
    }

    /// Adds a term whose word is canonical, and expands sums with a small positive power. Sums under fractional powers
    /// keep their coefficients; if their product is a whole power, the coefficients are taken out.
    pub(super) fn push_term(&self, out: &mut Poly, c: Rational, m: Monomial, word: Word) {
        let mut factors = m.iter().enumerate();
        let opened = factors.find_map(|(i, (atom, e))| Some((i, self.whole_power(atom, *e)?)));
        if let Some((i, value)) = opened {
            let mut rest = m;
            rest.remove(i);
            for (t, c2) in &value.terms {
                match (monomial::times(&rest, &t.monomial), c.times(*c2)) {
                    (Some(m), Some(c)) => self.push_term(out, c, m, word.clone()),
                    _ => self.exhaust(),
                }
            }
            return;
        }
        if !out.push(Term { monomial: m, word }, c) {
            self.exhaust();
        }
    }

    /// The normal form of a base with an integer power, either interned as for a fractional power, or expanded; `None`
    /// if it is in normal form.
    fn whole_power(&self, atom: &Atom, e: Rational) -> Option<Poly> {
        let Atom::Base(id) = atom else { return None };
        let n = e.as_integer()?;
        let (key, meaning) = {
            let numbers = self.numbers.borrow();
            let base = &numbers[*id as usize];
            let leading = base.key.terms.values().next()?;
            let opens = (1..=4).contains(&n) || base.key.terms.len() == 1 || !leading.is_one();
            opens.then(|| (base.key.clone(), base.meaning.clone()))?
        };
        let value = self.power(&key, e, &meaning);
        let same = |t: &Term| matches!(&t.monomial[..], [(Atom::Base(other), _)] if other == id);
        (!value.terms.keys().all(same)).then_some(value)
    }

    /// A shortest subword that is a scalar: it starts with a row and ends with a column.
    fn number_inside(&self, word: &[Factor]) -> Option<(usize, usize)> {
        let mut start = None;
        for (i, f) in word.iter().enumerate() {
            let shape = self.shape_of(f);
            if shape.rows == Dim::Fixed(1) {
                start = Some(i);
            }
            if shape.cols == Dim::Fixed(1)
                && let Some(a) = start
            {
                return Some((a, i + 1));
            }
        }
        None
    }

    /// Two hats with only orthogonal letters between them.
    pub(super) fn facing_hats(&self, word: &[Factor]) -> Option<(usize, usize)> {
        let mut last = None;
        for (i, f) in word.iter().enumerate() {
            match f {
                Factor::Hat(_) => {
                    if let Some(a) = last {
                        return Some((a, i));
                    }
                    last = Some(i);
                }
                _ if self.is_orthogonal(f) => {}
                _ => last = None,
            }
        }
        None
    }

    /// `hat(a) G hat(b) = G b a^T G - (a^T G b) G` for G in SO(3).
    pub(super) fn expand_hats(
        &self,
        word: &[Factor],
        i: usize,
        j: usize,
    ) -> Vec<(Rational, Monomial, Word)> {
        let (Factor::Hat(a), Factor::Hat(b)) = (&word[i], &word[j]) else {
            return Vec::new();
        };
        let g = &word[i + 1..j];
        let (minus, row) = self.transposed_word(a);
        let sign = if minus {
            Rational::MINUS_ONE
        } else {
            Rational::ONE
        };
        let outer = [&word[..i], g, b, &row, g, &word[j + 1..]].concat();
        let inner = [&word[..i], g, &word[j + 1..]].concat();
        let bracket = self.bracket(&[&row[..], g, b].concat());
        let mut out = vec![(sign, Monomial::new(), outer)];
        for (t, c) in &bracket.terms {
            match c.times(sign.negated()) {
                Some(c) => out.push((c, t.monomial.clone(), inner.clone())),
                None => self.exhaust(),
            }
        }
        out
    }

    /// The skew matrix of a vector word: orthogonal letters move out, products are expanded.
    pub(super) fn hat_word(&self, word: &[Factor]) -> Poly {
        let shape = Shape::square(Dim::Fixed(3));
        let mut out = Poly::zero(shape);
        let front = word.iter().take_while(|f| self.is_orthogonal(f)).count();
        let (g, rest) = word.split_at(front);
        let (_, g_back) = self.transposed_word(g);
        let wrap = |middle: &[Factor]| [g, middle, &g_back].concat();
        let none = Monomial::new();
        match rest.first() {
            // hat(a x b) = b a^T - a b^T
            Some(Factor::Hat(a)) => {
                let b = &rest[1..];
                let (minus_a, a_row) = self.transposed_word(a);
                let (minus_b, b_row) = self.transposed_word(b);
                let sign = |m: bool| {
                    if m {
                        Rational::MINUS_ONE
                    } else {
                        Rational::ONE
                    }
                };
                self.push_reduced(&mut out, sign(minus_a), &none, wrap(&[b, &a_row].concat()));
                self.push_reduced(
                    &mut out,
                    sign(!minus_b),
                    &none,
                    wrap(&[&a[..], &b_row].concat()),
                );
            }
            // hat(vee(X)) = (X - X^T)/2
            Some(Factor::Vee { word: x, .. }) => {
                let (minus, xt) = self.transposed_word(x);
                let half = Rational::HALF;
                self.push_reduced(&mut out, half, &none, wrap(x));
                let back = if minus { half } else { half.negated() };
                self.push_reduced(&mut out, back, &none, wrap(&xt));
            }
            _ => {
                if let Some((minus, rest)) = self.ordered_triple(rest) {
                    let sign = if minus {
                        Rational::MINUS_ONE
                    } else {
                        Rational::ONE
                    };
                    self.push_reduced(&mut out, sign, &none, wrap(&[Factor::Hat(rest)]));
                }
            }
        }
        out
    }

    /// The axial vector of the skew part of a matrix word.
    pub(super) fn vee_word(&self, word: &[Factor]) -> Poly {
        let mut out = Poly::zero(Shape::vector(Dim::Fixed(3)));
        let none = Monomial::new();
        if let [Factor::Hat(v)] = word {
            self.push_reduced(&mut out, Rational::ONE, &none, v.clone());
            return out;
        }
        // vee(x y^T) = (y x x)/2
        if let Some(cut) = word
            .iter()
            .position(|f| self.shape_of(f).cols == Dim::Fixed(1))
        {
            let (x, y_row) = word.split_at(cut + 1);
            let (minus, y) = self.transposed_word(y_row);
            let half = if minus {
                Rational::HALF.negated()
            } else {
                Rational::HALF
            };
            for (t, c) in &self.hat_word(&y).terms {
                match c.times(half) {
                    Some(c) => {
                        self.push_reduced(&mut out, c, &t.monomial, [&t.word[..], x].concat());
                    }
                    None => self.exhaust(),
                }
            }
            return out;
        }
        // vee(g X g^T) = g vee(X)
        if let (Some(first), Some(last)) = (word.first(), word.last())
            && word.len() > 1
            && self.is_orthogonal(first)
            && self.cancel(last, first)
        {
            let inner = self.vee_word(&word[1..word.len() - 1]);
            for (t, c) in &inner.terms {
                let w = [&[first.clone()][..], &t.word].concat();
                self.push_reduced(&mut out, *c, &t.monomial, w);
            }
            return out;
        }
        let (minus, back) = self.transposed_word(word);
        if word.is_empty() || (back == word && !minus) {
            return out;
        }
        let (sign, word) = if back.as_slice() < word {
            (
                if minus {
                    Rational::ONE
                } else {
                    Rational::MINUS_ONE
                },
                back,
            )
        } else {
            (Rational::ONE, word.to_vec())
        };
        let factor = Factor::Vee {
            word,
            transposed: false,
        };
        self.push_reduced(&mut out, sign, &none, vec![factor]);
        out
    }
}
