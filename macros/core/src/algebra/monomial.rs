//! Commuting parts of a term: rational powers of scalar atoms (numbers, traces, brackets `u^T A v`, determinants,
//! opaque functions), sorted.

use super::factor::{Source, Word};
use super::rational::Rational;
use crate::expr::{Constant, Function, Letter};

/// A scalar that the normal form does not expand further.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Atom {
    /// A constant that exact arithmetic does not represent.
    Constant(Constant),
    /// A scalar letter.
    Letter(Letter),
    /// The size of a named dimension.
    Dimension(u16),
    /// The trace of a word, canonical under rotation and transposition.
    Trace(Word),
    /// A row times matrices times a column, canonical under transposition and the rules for hats.
    Bracket(Word),
    /// The determinant of a letter.
    Det(Source),
    /// The determinant of an opaque matrix.
    OpaqueDet(u32),
    /// The base of a power of a sum.
    Base(u32),
    /// A function of an interned scalar.
    Call(Function, u32),
    /// A value of a functional, or an entry of its derivative.
    Given(u32),
}

/// A product of powers of atoms, sorted by atom, without zero exponents.
pub type Monomial = Vec<(Atom, Rational)>;

/// Product of two monomials; `None` on overflow of an exponent.
pub fn times(a: &Monomial, b: &Monomial) -> Option<Monomial> {
    let mut out: Monomial = Vec::with_capacity(a.len() + b.len());
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let order = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => x.0.cmp(&y.0),
            (Some(_), None) => core::cmp::Ordering::Less,
            _ => core::cmp::Ordering::Greater,
        };
        match order {
            core::cmp::Ordering::Less => {
                out.push(a[i].clone());
                i += 1;
            }
            core::cmp::Ordering::Greater => {
                out.push(b[j].clone());
                j += 1;
            }
            core::cmp::Ordering::Equal => {
                let e = a[i].1.plus(b[j].1)?;
                if !e.is_zero() {
                    out.push((a[i].0.clone(), e));
                }
                i += 1;
                j += 1;
            }
        }
    }
    Some(out)
}

/// The monomial with every exponent multiplied by `q`; `None` on overflow.
pub fn power(a: &Monomial, q: Rational) -> Option<Monomial> {
    let mut out = Vec::with_capacity(a.len());
    for (atom, e) in a {
        let e = e.times(q)?;
        if !e.is_zero() {
            out.push((atom.clone(), e));
        }
    }
    Some(out)
}
