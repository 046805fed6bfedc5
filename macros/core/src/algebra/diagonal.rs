//! The diagonal matrix of a vector, and the vector of a diagonal. A fixed size gives a sum over unit vectors; a named
//! size gives a letter for each word.

use super::factor::{Factor, Source};
use super::monomial::Monomial;
use super::poly::{Poly, Term};
use super::rational::Rational;
use super::{Algebra, KeyRelation};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr};

impl Algebra<'_> {
    /// A linear map to a letter for each word, for sizes that are not numbers.
    fn by_letters(
        &self,
        a: &Poly,
        shape: Shape,
        sense: KeyRelation,
        map: impl Fn(Expr) -> Expr,
    ) -> Poly {
        self.linear(a, shape, |word| {
            let term = Term {
                monomial: Monomial::new(),
                word: word.to_vec(),
            };
            let mut key = Poly::term(a.shape, Rational::ONE, term);
            key.symmetric = shape.is_square();
            let meaning = map(self.raise(&key));
            let id = self.intern(&self.matrices, key, sense, || meaning);
            self.one_factor(
                shape,
                Factor::Letter {
                    source: Source::Opaque(id),
                    transposed: false,
                    inverted: false,
                },
            )
        })
    }

    /// The vector of a letter that is the diagonal matrix of a vector.
    fn on_the_diagonal(&self, word: &[Factor]) -> Option<Poly> {
        let [
            Factor::Letter {
                source: Source::Opaque(id),
                inverted: false,
                ..
            },
        ] = word
        else {
            return None;
        };
        let table = self.matrices.borrow();
        let own = table.get(*id as usize)?;
        let is_of_vector = own.sense == KeyRelation::Diagonal && !own.key.shape.is_square();
        is_of_vector.then(|| own.key.clone())
    }

    /// `sum of E_i (E_i^T v) E_i^T`; a letter for each word of a named size.
    pub(super) fn diagonal(&self, v: &Poly) -> Poly {
        let mut out = Poly::zero(Shape::square(v.shape.rows));
        let Dim::Fixed(n) = v.shape.rows else {
            return self.by_letters(v, out.shape, KeyRelation::Diagonal, expr::diagonal);
        };
        for axis in 0..n.min(64) as u8 {
            let unit = |transposed| unit(v.shape.rows, axis, transposed);
            for (t, c) in &v.terms {
                let word = [&[unit(true)][..], &t.word].concat();
                let mut one = Poly::zero(Shape::SCALAR);
                self.push_reduced(&mut one, *c, &t.monomial, word);
                let frame = Poly::term(
                    out.shape,
                    Rational::ONE,
                    Term {
                        monomial: Monomial::new(),
                        word: vec![unit(false), unit(true)],
                    },
                );
                self.accumulate(&mut out, &self.mul(&one, &frame), Rational::ONE);
            }
        }
        out
    }

    /// `sum of E_i (E_i^T A E_i)`; a letter for each word of a named size.
    pub(super) fn diagonal_of(&self, a: &Poly) -> Poly {
        let mut out = Poly::zero(Shape::vector(a.shape.rows));
        let Dim::Fixed(n) = a.shape.rows else {
            for (t, c) in &a.terms {
                let mut one = Poly::zero(a.shape);
                self.push_term(&mut one, *c, t.monomial.clone(), t.word.clone());
                let own = match self.on_the_diagonal(&t.word) {
                    Some(vector) => self.linear(&one, out.shape, |_| vector.clone()),
                    None => {
                        let sense = KeyRelation::DiagonalVector;
                        self.by_letters(&one, out.shape, sense, expr::diagonal_of)
                    }
                };
                self.accumulate(&mut out, &own, Rational::ONE);
            }
            return out;
        };
        for axis in 0..n.min(64) as u8 {
            let unit = |transposed| unit(a.shape.rows, axis, transposed);
            for (t, c) in &a.terms {
                let word = [&[unit(false), unit(true)][..], &t.word, &[unit(false)]].concat();
                self.push_reduced(&mut out, *c, &t.monomial, word);
            }
        }
        out
    }
}

/// A unit vector, as a column or a row.
fn unit(dim: Dim, axis: u8, transposed: bool) -> Factor {
    Factor::Unit {
        dim,
        axis,
        transposed,
    }
}
