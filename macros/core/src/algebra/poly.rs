//! Polynomials in words: finite sums of rational coefficient x monomial x word, sorted, without zero terms. As far as
//! the rules reach, two expressions are equal iff their polynomials are identical.

use super::factor::Word;
use super::monomial::Monomial;
use super::rational::Rational;
use crate::expr::shape::Shape;
use std::collections::BTreeMap;

/// The monomial and the word of one term. The word of a scalar is empty.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug, Default)]
pub struct Term {
    /// Commuting part.
    pub monomial: Monomial,
    /// Matrix part; the empty word is the identity, or 1 in a scalar.
    pub word: Word,
}

/// A normal form.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Poly {
    /// Shape of the value.
    pub shape: Shape,
    /// Terms with non-zero coefficients.
    pub terms: BTreeMap<Term, Rational>,
    /// Whether the value is known to equal its transpose; set only for interned matrices.
    pub symmetric: bool,
}

impl Poly {
    /// The zero of a shape.
    pub fn zero(shape: Shape) -> Poly {
        Poly {
            shape,
            terms: BTreeMap::new(),
            symmetric: false,
        }
    }

    /// One term.
    pub fn term(shape: Shape, coefficient: Rational, term: Term) -> Poly {
        let mut poly = Poly::zero(shape);
        if !coefficient.is_zero() {
            poly.terms.insert(term, coefficient);
        }
        poly
    }

    /// A constant: a number, or a multiple of the identity.
    pub fn constant(shape: Shape, value: Rational) -> Poly {
        Poly::term(shape, value, Term::default())
    }

    /// Whether it has no terms.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// Adds a term; `false` on overflow.
    #[must_use]
    pub fn push(&mut self, term: Term, coefficient: Rational) -> bool {
        use std::collections::btree_map::Entry;
        if coefficient.is_zero() {
            return true;
        }
        match self.terms.entry(term) {
            Entry::Vacant(v) => {
                v.insert(coefficient);
                true
            }
            Entry::Occupied(mut o) => match o.get().plus(coefficient) {
                Some(s) if s.is_zero() => {
                    o.remove();
                    true
                }
                Some(s) => {
                    o.insert(s);
                    true
                }
                None => false,
            },
        }
    }

    /// The polynomial with every coefficient multiplied by `q`; `None` on overflow.
    pub fn scaled(&self, q: Rational) -> Option<Poly> {
        let mut out = Poly::zero(self.shape);
        for (t, c) in &self.terms {
            let c = c.times(q)?;
            if !c.is_zero() {
                out.terms.insert(t.clone(), c);
            }
        }
        Some(out)
    }
}
