//! Canonical scalars from words: brackets `u^T A v` (transposition, triple products, axial vectors) and traces
//! (rotation and transposition). A value that equals its negative is zero.

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

    /// The value of a word that starts with a row and ends with a column.
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
        if let Some((i, j)) = self.facing_hats(word) {
            return self.expanded(word, i, j);
        }
        let mut best: Option<(bool, Word)> = None;
        let mut both = false;
        for (negative, form) in self.forms(word) {
            match &best {
                Some((sign, least)) if *least == form => both |= *sign != negative,
                Some((_, least)) if *least < form => {}
                _ => {
                    both = false;
                    best = Some((negative, form));
                }
            }
        }
        match best {
            Some((negative, form)) if !both => self.atom(sign(negative), Atom::Bracket(form)),
            _ => zero,
        }
    }

    /// All forms of a bracket: itself and its transpose; if it contains a hat, also `a . (u x w)` in any order of the
    /// three vectors, in the frame in which the vector of the hat has no factor.
    fn forms(&self, word: &[Factor]) -> Vec<(bool, Word)> {
        let Some((k, u)) = word.iter().enumerate().rev().find_map(|(k, f)| match f {
            Factor::Hat(u) => Some((k, u)),
            _ => None,
        }) else {
            let (minus, back) = self.transposed_word(word);
            return vec![(false, word.to_vec()), (minus, back)];
        };
        let (minus, a) = self.transposed_word(&word[..k]);
        let (Some((m0, a)), Some((m1, w))) =
            (self.ordered_triple(&a), self.ordered_triple(&word[k + 1..]))
        else {
            return Vec::new();
        };
        let minus = minus ^ m0 ^ m1;
        let vectors = [a, u.clone(), w];
        let mut out = Vec::new();
        for j in 0..3 {
            let front = vectors[j]
                .iter()
                .take_while(|f| self.is_orthogonal(f))
                .count();
            let (frame, bare) = vectors[j].split_at(front);
            if matches!(bare.first(), Some(Factor::Hat(_) | Factor::Vee { .. })) {
                continue;
            }
            let (_, to_frame) = self.transposed_word(frame);
            let moved = |i: usize| {
                let vector = self.cancelled([&to_frame[..], &vectors[i % 3]].concat());
                self.ordered_triple(&vector)
            };
            let hat = [Factor::Hat(bare.to_vec())];
            for (left, right, odd) in [(j + 2, j + 1, false), (j + 1, j + 2, true)] {
                let (Some((m1, left)), Some((m2, right))) = (moved(left), moved(right)) else {
                    // One of the vectors is zero.
                    return Vec::new();
                };
                let (m3, row) = self.transposed_word(&left);
                let form = [&row[..], &hat, &right].concat();
                out.push((minus ^ odd ^ m1 ^ m2 ^ m3, form));
            }
        }
        out
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
            let value = self.trace_word(&whole, Dim::Fixed(3));
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

    /// The trace of a word whose value has `rows` rows. A word that cancels to the identity has the
    /// trace `rows`.
    pub(super) fn trace_word(&self, word: &[Factor], rows: Dim) -> Poly {
        let zero = Poly::zero(Shape::SCALAR);
        if !self.spend(1 + word.len()) {
            return zero;
        }
        let mut word = self.cancelled(word.to_vec());
        while word.len() > 1 && self.cancel(&word[word.len() - 1], &word[0]) {
            word.pop();
            word.remove(0);
        }
        if word.is_empty() {
            return match rows {
                Dim::Fixed(n) => Poly::constant(Shape::SCALAR, Rational::integer(i64::from(n))),
                Dim::Named(i) => self.atom(Rational::ONE, Atom::Dimension(i)),
            };
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
        // Left multiplications by vectors at both ends are adjacent under the cyclic trace.
        if let [Factor::Pure(_), .., Factor::Pure(_)] = word.as_slice() {
            word.rotate_right(1);
            let mut out = Poly::zero(Shape::square(Dim::Fixed(4)));
            self.push_reduced(&mut out, Rational::ONE, &Monomial::new(), word);
            return self.trace_poly(&out);
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
            Some((negative, mut word)) => match self.open_gap(&word) {
                Some((i, gap)) => {
                    word.rotate_left(i);
                    let value = self.expanded(&word, 0, gap + 1);
                    self.scaled(&value, sign(negative))
                }
                None => self.atom(sign(negative), Atom::Trace(word)),
            },
            None => zero,
        }
    }

    /// A hat in a cyclic word and the distance to the next hat, if `hat G hat` can be expanded there in one way only.
    /// This is so if the gap is empty, or if only this gap is orthogonal. A loop of rotations and two hats can be
    /// expanded on either side, and the results agree only by Cayley-Hamilton. Such a loop is not expanded.
    fn open_gap(&self, word: &[Factor]) -> Option<(usize, usize)> {
        let n = word.len();
        let hats: Vec<usize> = (0..n)
            .filter(|i| matches!(word[*i], Factor::Hat(_)))
            .collect();
        if hats.len() < 2 {
            return None;
        }
        let gaps: Vec<(usize, usize, bool)> = hats
            .iter()
            .enumerate()
            .map(|(k, i)| {
                let next = hats[(k + 1) % hats.len()];
                let gap = (next + n - i - 1) % n;
                let orthogonal = (1..=gap).all(|d| self.is_orthogonal(&word[(i + d) % n]));
                (*i, gap, orthogonal)
            })
            .collect();
        let empty = gaps.iter().find(|(_, gap, _)| *gap == 0);
        let closed = gaps.iter().all(|(_, _, orthogonal)| *orthogonal);
        let orthogonal = gaps.iter().find(|(_, _, o)| *o && !closed);
        empty.or(orthogonal).map(|(i, gap, _)| (*i, *gap))
    }

    /// The scalar that results if the hats at `i` and `j` of a bracket or trace are expanded.
    fn expanded(&self, word: &[Factor], i: usize, j: usize) -> Poly {
        let closed = self.shape_of(&word[0]).rows != Dim::Fixed(1);
        let mut out = Poly::zero(Shape::SCALAR);
        for (c, m, w) in self.expand_hats(word, i, j) {
            let value = if closed {
                let shape = Shape::square(Dim::Fixed(3));
                let mut opened = Poly::zero(shape);
                self.push_reduced(&mut opened, Rational::ONE, &Monomial::new(), w);
                self.trace_poly(&opened)
            } else {
                let mut opened = Poly::zero(Shape::SCALAR);
                self.push_reduced(&mut opened, Rational::ONE, &Monomial::new(), w);
                opened
            };
            for (t, c2) in &value.terms {
                match (super::monomial::times(&m, &t.monomial), c.times(*c2)) {
                    (Some(m), Some(c)) => self.push_term(&mut out, c, m, Word::new()),
                    _ => self.exhaust(),
                }
            }
        }
        out
    }

    /// The trace of a polynomial.
    pub(super) fn trace_poly(&self, a: &Poly) -> Poly {
        let mut out = Poly::zero(Shape::SCALAR);
        for (t, c) in &a.terms {
            let value = self.trace_word(&t.word, a.shape.rows);
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
