//! Matrices that are transposes of one another, up to the order of their terms, are computed once. Takes
//! expressions that are computed together; gives equal ones in which the later of two such matrices is written as
//! the transpose of the earlier one.

use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Hashed, Node};
use std::collections::HashMap;

/// The expressions, in which products of matrices and sums of them are written as transposes if their transposes
/// occurred earlier.
pub fn aligned(symbols: &Symbols, results: &[Expr]) -> Vec<Expr> {
    let mut met = TransposeAlignment {
        symbols,
        numbers: Hashed::default(),
        first: HashMap::new(),
        done: Hashed::default(),
    };
    results.iter().map(|e| met.align(e)).collect()
}

struct TransposeAlignment<'a> {
    symbols: &'a Symbols,
    /// A number per term, in order of occurrence.
    numbers: Hashed<usize>,
    /// The first occurrence of a sum, by the sorted numbers of its terms.
    first: HashMap<Vec<usize>, Expr>,
    done: Hashed<Expr>,
}

impl TransposeAlignment<'_> {
    fn align(&mut self, e: &Expr) -> Expr {
        if let Some(known) = self.done.get(e) {
            return known.clone();
        }
        let inner = super::increment_form::rebuilt(self.symbols, e, &mut |c| self.align(c));
        let out = match (inner.node(), multiplies(&inner)) {
            // The inverse of a transpose is the transpose of the inverse that occurs elsewhere.
            (Node::Inverse(a), _) => match a.node() {
                Node::Transpose(b) => expr::transposed(expr::inverse(self.symbols, b.clone())),
                _ => inner,
            },
            (_, true) => self.known(inner),
            (_, false) => inner,
        };
        self.done.insert(e.clone(), out.clone());
        out
    }

    /// The transpose of an earlier expression if this is one; otherwise the expression. A sum whose products all
    /// occurred transposed is formed anew.
    fn known(&mut self, e: Expr) -> Expr {
        if let Some(found) = self.met_transposed(&e) {
            return found;
        }
        let own = self.key(&e);
        self.first.entry(own).or_insert_with(|| e.clone());
        e
    }

    fn met_transposed(&mut self, e: &Expr) -> Option<Expr> {
        let (own, turned) = (self.key(e), self.turned(e));
        let turned = self.key(&turned);
        let first = self.first.get(&turned).filter(|_| own != turned)?;
        Some(expr::transposed(first.clone()))
    }

    /// The transpose of a sum or a product; parts of its terms that are computed separately stay whole.
    fn turned(&self, e: &Expr) -> Expr {
        match e.node() {
            Node::Neg(a) => expr::neg(self.turned(a)),
            Node::Sum(terms) => {
                let shape = e.shape().transposed();
                expr::sum(terms.iter().map(|t| self.turned(t)), shape)
            }
            Node::Product(factors) => {
                let whole = |f: &Expr| match (f.node(), multiplies(f)) {
                    (Node::Transpose(a), _) => a.clone(),
                    (_, true) => expr::transposed(f.clone()),
                    _ => expr::transpose(self.symbols, f.clone()),
                };
                expr::product(factors.iter().rev().map(whole))
            }
            _ => expr::transpose(self.symbols, e.clone()),
        }
    }

    fn key(&mut self, e: &Expr) -> Vec<usize> {
        let terms = match e.node() {
            Node::Sum(terms) => terms.as_slice(),
            _ => std::slice::from_ref(e),
        };
        let mut key: Vec<usize> = Vec::with_capacity(terms.len());
        for term in terms {
            let next = self.numbers.len();
            key.push(*self.numbers.entry(term.clone()).or_insert(next));
        }
        key.sort_unstable();
        key
    }
}

/// Whether this is computed as a product of matrices, or a sum with such a product.
fn multiplies(e: &Expr) -> bool {
    let is_matrix = |e: &Expr| !e.shape().is_scalar() && !e.shape().is_vector();
    let product = |e: &Expr| match e.node() {
        Node::Product(factors) => factors.iter().filter(|f| is_matrix(f)).count() > 1,
        _ => false,
    };
    let of_term = |t: &Expr| match t.node() {
        Node::Neg(a) => product(a),
        _ => product(t),
    };
    is_matrix(e)
        && e.shape().rows != crate::expr::shape::Dim::Fixed(1)
        && match e.node() {
            Node::Sum(terms) => terms.iter().any(of_term),
            _ => product(e),
        }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Dim, Shape, Structure};
    use crate::expr::symbol::Role;

    #[test]
    fn a_transpose_is_computed_once() {
        let mut symbols = Symbols::default();
        let mut letter = |name: &str| {
            let shape = Shape::square(Dim::Fixed(3));
            let id = symbols.add(name, shape, Structure::General, Role::Derived);
            expr::here(&symbols, id)
        };
        let (a, b, c) = (letter("A"), letter("B"), letter("C"));
        let turned = |e: &Expr| expr::transpose(&symbols, e.clone());
        let work = |list: &[Expr]| super::super::work(&super::super::program(&symbols, list, "t"));
        let sum = expr::add(expr::mul(a.clone(), b.clone()), c.clone());
        // Write the sum in another order.
        let back = expr::add(turned(&c), expr::mul(turned(&b), turned(&a)));
        assert_eq!(work(std::slice::from_ref(&sum)), 45 + 9);
        let product = expr::mul(a.clone(), b.clone());
        assert_eq!(work(&[product.clone(), turned(&product)]), 45);
        // The product is computed once, the sums separately.
        assert_eq!(work(&[sum.clone(), back]), 45 + 9 + 9);
        // Another sum is not the transpose.
        let other = expr::add(turned(&c), expr::mul(turned(&a), turned(&b)));
        assert_eq!(work(&[sum, other]), 2 * (45 + 9));
        // A symmetric product is its own transpose.
        let square = expr::mul(a.clone(), turned(&a));
        assert_eq!(aligned(&symbols, std::slice::from_ref(&square)), [square]);
    }
}
