//! From expressions to normal forms: one rule for each kind of node.

use super::factor::{Factor, Source, Word};
use super::monomial::{self, Atom, Monomial};
use super::poly::{Poly, Term};
use super::quaternion::rotation_of;
use super::rational::Rational;
use super::rigid::translation_of;
use super::{Algebra, KeyRelation};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Function, Map, Node, Parity, Part};

impl Algebra<'_> {
    /// The normal form of an expression, whose parts may be cached.
    pub(super) fn normal_form(&self, e: &Expr) -> Poly {
        let shape = e.shape();
        if self.exhausted() {
            return Poly::zero(shape);
        }
        match e.node() {
            Node::Number(q) => Poly::constant(shape, *q),
            Node::Constant(c) => self.scalar_atom(Atom::Constant(*c)),
            Node::Zero(_) => Poly::zero(shape),
            Node::Identity(_) => Poly::constant(shape, Rational::ONE),
            Node::Letter(at) if shape.is_scalar() => self.scalar_atom(Atom::Letter(*at)),
            Node::Letter(at)
                if shape == Shape::square(Dim::Fixed(3))
                    && self.symbols.get(at.symbol).structure == Structure::Skew =>
            {
                let axial = Factor::Axial {
                    source: Source::Letter(*at),
                    transposed: false,
                };
                self.one_factor(shape, Factor::Hat(vec![axial]))
            }
            Node::Letter(at) if self.in_blocks(*at) => self.rigid_motion(*at, false),
            Node::Letter(at) => self.one_factor(
                shape,
                Factor::Letter {
                    source: Source::Letter(*at),
                    transposed: false,
                    inverted: false,
                },
            ),
            Node::Unit(dim, axis) => self.one_factor(
                shape,
                Factor::Unit {
                    dim: *dim,
                    axis: *axis,
                    transposed: false,
                },
            ),
            Node::Inclusion(whole, row) => self.one_factor(
                shape,
                Factor::Inclusion {
                    shape: *whole,
                    at: *row,
                    transposed: false,
                },
            ),
            Node::Sum(terms) => {
                let mut out = Poly::zero(shape);
                for t in terms {
                    self.accumulate(&mut out, &self.lowered(t), Rational::ONE);
                }
                out
            }
            Node::Neg(a) => self.scaled(&self.lowered(a), Rational::MINUS_ONE),
            Node::Product(factors) => {
                let mut factors = factors.iter();
                let Some(first) = factors.next() else {
                    return Poly::constant(shape, Rational::ONE);
                };
                factors.fold(self.lower(first), |acc, f| self.mul(&acc, &self.lowered(f)))
            }
            Node::Quotient(a, b) => {
                let inverse = self.lower_power(b, Rational::MINUS_ONE);
                self.mul(&self.lowered(a), &inverse)
            }
            Node::Power(a, q) => self.lower_power(a, *q),
            Node::Transpose(a) => self.transpose(&self.lowered(a)),
            Node::Inverse(a) => match a.node() {
                Node::Letter(at) if self.in_blocks(*at) => self.rigid_motion(*at, true),
                _ => self.inverse(&self.lowered(a), a),
            },
            Node::Trace(a) => self.trace_poly(&self.lowered(a)),
            Node::Det(a) => self.det(&self.lowered(a), a),
            // The adjugate of a letter is written by its inverse, which cancels against the letter. Sums have too many
            // forms for that, and skew matrices may be singular: their adjugate is expanded as a polynomial.
            Node::Adjugate(a) if !self.is_plain_letter(a) => {
                self.lower(&expr::adjugate_polynomial(a))
            }
            Node::Adjugate(a) => {
                let lowered = self.lowered(a);
                let det = self.det(&lowered, a);
                self.mul(&det, &self.inverse(&lowered, a))
            }
            Node::Dot(a, b) => {
                let row = self.transpose(&self.lowered(a));
                self.mul(&row, &self.lowered(b))
            }
            Node::Cross(a, b) => {
                let hat = self.linear(&self.lowered(a), Shape::square(Dim::Fixed(3)), |w| {
                    self.hat_word(w)
                });
                self.mul(&hat, &self.lowered(b))
            }
            Node::Hat(v) => self.linear(&self.lowered(v), shape, |w| self.hat_word(w)),
            Node::Vee(a) => self.linear(&self.lowered(a), shape, |w| self.vee_word(w)),
            Node::Part(part, a) => self.part(*part, &self.lowered(a), a),
            Node::Call(function, a) => self.call(*function, self.lower(a), a),
            Node::Given(a) => self.functional(e, a, None),
            Node::PullBack(a, which, seed) => self.functional(e, a, Some((*which, seed))),
            Node::Map(map, a) => match map {
                Map::Real => self.scaled(&self.trace_poly(&self.lowered(a)), Rational::QUARTER),
                Map::Imaginary => self.linear(&self.lowered(a), shape, |w| self.imaginary_word(w)),
                Map::Pure => self.linear(&self.lowered(a), shape, |w| self.pure_word(w)),
                Map::Twist => self.twist(&self.lowered(a), shape.rows),
                Map::Diagonal => self.diagonal(&self.lowered(a)),
                Map::DiagonalOf => self.diagonal_of(&self.lowered(a)),
                Map::Translation => match a.node() {
                    Node::Letter(at) => self.one_factor(shape, translation_of(*at)),
                    _ => {
                        self.exhaust();
                        Poly::zero(shape)
                    }
                },
                Map::Rotation => match a.node() {
                    Node::Letter(at) => self.one_factor(shape, rotation_of(*at, false)),
                    // Only letters have rotations.
                    _ => {
                        self.exhaust();
                        Poly::zero(shape)
                    }
                },
            },
        }
    }

    /// Whether the expression is a single letter, possibly transposed, that may have an inverse.
    fn is_plain_letter(&self, a: &Expr) -> bool {
        match a.node() {
            Node::Letter(at) => self.symbols.get(at.symbol).structure != Structure::Skew,
            Node::Transpose(inner) => self.is_plain_letter(inner),
            _ => false,
        }
    }

    fn scalar_atom(&self, atom: Atom) -> Poly {
        let term = Term {
            monomial: vec![(atom, Rational::ONE)],
            word: Word::new(),
        };
        Poly::term(Shape::SCALAR, Rational::ONE, term)
    }

    pub(super) fn one_factor(&self, shape: Shape, factor: Factor) -> Poly {
        let term = Term {
            monomial: Monomial::new(),
            word: vec![factor],
        };
        Poly::term(shape, Rational::ONE, term)
    }

    pub(super) fn scaled(&self, a: &Poly, q: Rational) -> Poly {
        a.scaled(q).unwrap_or_else(|| {
            self.exhaust();
            Poly::zero(a.shape)
        })
    }

    pub(super) fn accumulate(&self, out: &mut Poly, a: &Poly, q: Rational) {
        if !self.spend(a.terms.len()) {
            return;
        }
        for (t, c) in &a.terms {
            let ok = c.times(q).is_some_and(|c| out.push(t.clone(), c));
            if !ok {
                self.exhaust();
            }
        }
    }

    /// Product of normal forms; a scalar may multiply a matrix from either side.
    pub(super) fn mul(&self, a: &Poly, b: &Poly) -> Poly {
        let shape = if a.shape.is_scalar() && !b.shape.is_scalar() && b.shape.rows != Dim::Fixed(1)
        {
            b.shape
        } else if b.shape.is_scalar() && a.shape.cols != Dim::Fixed(1) {
            a.shape
        } else {
            Shape {
                rows: a.shape.rows,
                cols: b.shape.cols,
            }
        };
        let mut out = Poly::zero(shape);
        for (ta, ca) in &a.terms {
            for (tb, cb) in &b.terms {
                match (monomial::times(&ta.monomial, &tb.monomial), ca.times(*cb)) {
                    (Some(m), Some(c)) => {
                        let word = [&ta.word[..], &tb.word].concat();
                        self.push_reduced(&mut out, c, &m, word);
                    }
                    _ => self.exhaust(),
                }
                if self.exhausted() {
                    return out;
                }
            }
        }
        out
    }

    pub(super) fn transpose(&self, a: &Poly) -> Poly {
        let mut out = Poly::zero(a.shape.transposed());
        for (t, c) in &a.terms {
            let (minus, word) = self.transposed_word(&t.word);
            let c = if minus { c.negated() } else { *c };
            self.push_reduced(&mut out, c, &t.monomial, word);
        }
        out
    }

    /// Applies a map that is linear in the words.
    pub(super) fn linear(&self, a: &Poly, shape: Shape, f: impl Fn(&[Factor]) -> Poly) -> Poly {
        let mut out = Poly::zero(shape);
        for (t, c) in &a.terms {
            for (t2, c2) in &f(&t.word).terms {
                match (monomial::times(&t.monomial, &t2.monomial), c.times(*c2)) {
                    (Some(m), Some(c)) => self.push_term(&mut out, c, m, t2.word.clone()),
                    _ => self.exhaust(),
                }
            }
        }
        out
    }

    /// The term of a polynomial with exactly one term.
    fn single(a: &Poly) -> Option<(&Term, Rational)> {
        let mut terms = a.terms.iter();
        match (terms.next(), terms.next()) {
            (Some((t, c)), None) => Some((t, *c)),
            _ => None,
        }
    }

    /// `e^q`. Powers, products and quotients under it are split first, so that a sum under a power always has the form
    /// that the user wrote.
    fn lower_power(&self, e: &Expr, q: Rational) -> Poly {
        let whole = q.as_integer().is_some();
        match e.node() {
            Node::Power(a, r) if whole && r.times(q).is_some() => {
                self.lower_power(a, r.times(q).unwrap_or(q))
            }
            Node::Product(factors) if whole && factors.iter().all(|f| f.shape().is_scalar()) => {
                let one = Poly::constant(Shape::SCALAR, Rational::ONE);
                let powers = factors.iter().map(|f| self.lower_power(f, q));
                powers.fold(one, |acc, f| self.mul(&acc, &f))
            }
            Node::Quotient(a, b) if whole => {
                let below = self.lower_power(b, q.negated());
                self.mul(&self.lower_power(a, q), &below)
            }
            _ => self.power(&self.lowered(e), q, e),
        }
    }

    pub(super) fn power(&self, a: &Poly, q: Rational, meaning: &Expr) -> Poly {
        if let Some(n) = q.as_integer() {
            if let Some((t, c)) = Self::single(a)
                && let (Some(c), Some(m)) = (c.power(n), monomial::power(&t.monomial, q))
            {
                let mut out = Poly::zero(Shape::SCALAR);
                self.push_term(&mut out, c, m, Word::new());
                return out;
            }
            if (0..=4).contains(&n) {
                let one = Poly::constant(Shape::SCALAR, Rational::ONE);
                return (0..n).fold(one, |acc, _| self.mul(&acc, a));
            }
        } else if let Some((t, c)) = Self::single(a)
            && c.is_one()
            && t.monomial.iter().all(|(atom, _)| self.is_positive(atom))
            && let Some(m) = monomial::power(&t.monomial, q)
        {
            // (x y)^q = x^q y^q holds for positive numbers only.
            let term = Term {
                monomial: m,
                word: Word::new(),
            };
            return Poly::term(Shape::SCALAR, Rational::ONE, term);
        }
        // All multiples of a sum have the same base, because the leading coefficient is factored out.
        let leading = a.terms.values().next().copied().unwrap_or(Rational::ONE);
        let outside = q.as_integer().and_then(|n| leading.power(n));
        let (key, meaning, outside) = match (leading.inverse(), outside) {
            (Some(inverse), Some(outside)) if !leading.is_one() => (
                self.scaled(a, inverse),
                expr::scale(inverse, meaning.clone()),
                outside,
            ),
            _ => (a.clone(), meaning.clone(), Rational::ONE),
        };
        let id = self.intern(&self.numbers, key, KeyRelation::Value, || meaning);
        let term = Term {
            monomial: vec![(Atom::Base(id), q)],
            word: Word::new(),
        };
        Poly::term(Shape::SCALAR, outside, term)
    }

    fn is_positive(&self, atom: &Atom) -> bool {
        match atom {
            Atom::Letter(at) => self.symbols.get(at.symbol).role == Role::Step,
            Atom::Call(function, _) => matches!(function, Function::Exp | Function::Cosh),
            Atom::Dimension(_) | Atom::Constant(_) => true,
            Atom::Trace(_)
            | Atom::Bracket(_)
            | Atom::Det(_)
            | Atom::OpaqueDet(_)
            | Atom::Base(_)
            | Atom::Given(_) => false,
        }
    }

    fn inverse(&self, a: &Poly, meaning: &Expr) -> Poly {
        if let Some((t, c)) = Self::single(a)
            && let (Some(c), Some(m)) = (
                c.inverse(),
                monomial::power(&t.monomial, Rational::MINUS_ONE),
            )
            && t.word.iter().all(|f| {
                self.shape_of(f).is_square() && !matches!(f, Factor::Hat(_) | Factor::Pure(_))
            })
        {
            let word = t
                .word
                .iter()
                .rev()
                .map(|f| self.inverse_factor(f))
                .collect();
            let mut out = Poly::zero(a.shape);
            self.push_reduced(&mut out, c, &m, word);
            return out;
        }
        let mut key = a.clone();
        key.symmetric = self.transpose(a).terms == a.terms;
        let id = self.intern(&self.matrices, key, KeyRelation::Value, || meaning.clone());
        self.one_factor(
            a.shape,
            Factor::Letter {
                source: Source::Opaque(id),
                transposed: false,
                inverted: true,
            },
        )
    }

    fn inverse_factor(&self, f: &Factor) -> Factor {
        match f {
            Factor::Letter {
                source,
                transposed,
                inverted,
            } => {
                let orthogonal = self.structure(*source).is_orthogonal();
                Factor::Letter {
                    source: *source,
                    transposed: *transposed ^ orthogonal,
                    inverted: *inverted ^ !orthogonal,
                }
            }
            Factor::Unit { .. }
            | Factor::Inclusion { .. }
            | Factor::Axial { .. }
            | Factor::Hat(_)
            | Factor::Pure(_)
            | Factor::Imaginary { .. }
            | Factor::Vee { .. } => f.clone(),
        }
    }

    fn det(&self, a: &Poly, meaning: &Expr) -> Poly {
        if let Some((t, c)) = Self::single(a)
            && let Dim::Fixed(n) = a.shape.rows
            && let Ok(exponent) = i32::try_from(n)
            && t.word
                .iter()
                .all(|f| matches!(f, Factor::Letter { .. }) && self.shape_of(f).is_square())
            && let (Some(c), Some(mut m)) = (
                c.power(exponent),
                monomial::power(&t.monomial, Rational::integer(i64::from(n))),
            )
        {
            for f in &t.word {
                let Factor::Letter {
                    source, inverted, ..
                } = f
                else {
                    continue;
                };
                if self.structure(*source).is_unimodular() {
                    continue;
                }
                let atom = match source {
                    Source::Letter(_) | Source::Rotation(_) | Source::Translation(_) => {
                        Atom::Det(*source)
                    }
                    Source::Opaque(i) => Atom::OpaqueDet(*i),
                };
                let e = if *inverted {
                    Rational::MINUS_ONE
                } else {
                    Rational::ONE
                };
                match monomial::times(&m, &vec![(atom, e)]) {
                    Some(next) => m = next,
                    None => self.exhaust(),
                }
            }
            let mut out = Poly::zero(Shape::SCALAR);
            self.push_term(&mut out, c, m, Word::new());
            return out;
        }
        if a.is_zero() {
            return Poly::zero(Shape::SCALAR);
        }
        let mut key = a.clone();
        key.symmetric = self.transpose(a).terms == a.terms;
        let id = self.intern(&self.matrices, key, KeyRelation::Value, || meaning.clone());
        self.scalar_atom(Atom::OpaqueDet(id))
    }

    fn part(&self, part: Part, a: &Poly, meaning: &Expr) -> Poly {
        let mut out = Poly::zero(a.shape);
        match part {
            Part::Symmetric | Part::Skew => {
                self.accumulate(&mut out, a, Rational::HALF);
                let back = if part == Part::Skew {
                    Rational::HALF.negated()
                } else {
                    Rational::HALF
                };
                self.accumulate(&mut out, &self.transpose(a), back);
            }
            // diag(A) = sum of E_i (E_i^T A E_i) E_i^T
            Part::Diagonal => {
                let Dim::Fixed(n) = a.shape.rows else {
                    let mut key = a.clone();
                    key.symmetric = true;
                    let diagonal = || expr::part(Part::Diagonal, meaning.clone());
                    let id = self.intern(&self.matrices, key, KeyRelation::Diagonal, diagonal);
                    return self.one_factor(
                        a.shape,
                        Factor::Letter {
                            source: Source::Opaque(id),
                            transposed: false,
                            inverted: false,
                        },
                    );
                };
                for axis in 0..n.min(64) as u8 {
                    let unit = |transposed| Factor::Unit {
                        dim: a.shape.rows,
                        axis,
                        transposed,
                    };
                    for (t, c) in &a.terms {
                        let word = [
                            &[unit(false), unit(true)][..],
                            &t.word,
                            &[unit(false), unit(true)],
                        ]
                        .concat();
                        self.push_reduced(&mut out, *c, &t.monomial, word);
                    }
                }
            }
        }
        out
    }

    /// One letter per function and argument. The leading sign of the argument is factored out of odd and even
    /// functions.
    fn call(&self, function: Function, a: Poly, meaning: &Expr) -> Poly {
        let minus = a.terms.values().next().is_some_and(|c| c.is_negative());
        let parity = function.parity();
        if a.is_zero() {
            match function {
                Function::Exp | Function::Cos | Function::Cosh => {
                    return Poly::constant(Shape::SCALAR, Rational::ONE);
                }
                Function::Log => {}
                _ => return Poly::zero(Shape::SCALAR),
            }
        }
        let turned = minus && parity != Parity::None;
        let (key, meaning) = match turned {
            true => (
                self.scaled(&a, Rational::MINUS_ONE),
                expr::neg(meaning.clone()),
            ),
            false => (a, meaning.clone()),
        };
        let id = self.intern(&self.numbers, key, KeyRelation::Value, || meaning);
        let value = self.scalar_atom(Atom::Call(function, id));
        match turned && parity == Parity::Odd {
            true => self.scaled(&value, Rational::MINUS_ONE),
            false => value,
        }
    }
}
