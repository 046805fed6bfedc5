//! Inverts products of matrices factor by factor. Multiplied by the inverse of `F`, `F A + B` becomes `A + F⁻¹ B`.
//! The inverse of `Id + Q` for a rotation `Q` with Rodrigues vector `c` is `(Id - hat(c))/2`. Takes expressions and
//! factors; gives equal expressions that cost less.

use super::collect::parts;
use super::shape::Structure;
use super::simpler::identity_and;
use super::*;
use crate::expr::symbol::{Role, Symbols};

/// A factor that is to be inverted.
#[derive(Clone, Debug)]
pub enum InvertedFactor {
    /// `Id + Q` for a rotation with this Rodrigues vector, or for its inverse if `minus` is set.
    Cayley {
        /// `Id + Q` itself.
        whole: Expr,
        /// The vector.
        turn: Expr,
        /// Whether `Q` is the inverse of the rotation.
        minus: bool,
    },
    /// A rotation.
    Turn(Expr),
    /// Any other matrix.
    Matrix(Expr),
}

impl InvertedFactor {
    /// The factors of a product in order, and the reciprocal of its scalar factor. `turn` gives the Rodrigues vectors
    /// of letters that are rotations. `None` if a factor cannot be inverted.
    pub fn factors(
        symbols: &Symbols,
        e: &Expr,
        turn: impl Fn(&Expr) -> Option<Expr>,
    ) -> Option<(Expr, Vec<InvertedFactor>)> {
        let word = parts(e);
        let mut number = vec![super::number(word.coefficient.inverse()?)];
        number.extend(
            word.numbers
                .iter()
                .map(|(base, q)| power(base.clone(), q.negated())),
        );
        let own = |f: &Expr| {
            let is_turn = |e: &Expr| match e.node() {
                Node::Letter(l) => symbols.get(l.symbol).structure == Structure::Orthogonal,
                _ => false,
            };
            let bare = |e: &Expr| match e.node() {
                Node::Transpose(q) => (true, q.clone()),
                _ => (false, e.clone()),
            };
            if is_turn(&bare(f).1) {
                return Some(InvertedFactor::Turn(f.clone()));
            }
            if let Some((sign, q)) = identity_and(f)
                && sign.is_one()
                && is_turn(&bare(&q).1)
            {
                let (minus, q) = bare(&q);
                let (whole, turn) = (f.clone(), turn(&q)?);
                return Some(InvertedFactor::Cayley { whole, turn, minus });
            }
            let constant = letters(f)
                .iter()
                .all(|l| symbols.get(l.symbol).role == Role::Parameter);
            constant.then(|| InvertedFactor::Matrix(f.clone()))
        };
        let listed = word
            .matrices
            .iter()
            .filter(|f| !matches!(f.node(), Node::Identity(_)));
        Some((product(number), listed.map(own).collect::<Option<_>>()?))
    }

    /// The matrix itself.
    pub fn whole(&self) -> &Expr {
        match self {
            InvertedFactor::Cayley { whole, .. }
            | InvertedFactor::Turn(whole)
            | InvertedFactor::Matrix(whole) => whole,
        }
    }

    /// Whether `e` is this matrix, for any order of its terms.
    fn is(&self, e: &Expr) -> bool {
        self.whole() == e
            || matches!((identity_and(self.whole()), identity_and(e)), (Some(a), Some(b)) if a == b)
    }

    /// The inverse times a vector or matrix; multiplied from the right if `from_right` is set.
    fn inverted(&self, symbols: &Symbols, e: Expr, from_right: bool) -> Expr {
        let placed = |a: Expr, e: Expr| match from_right {
            true => mul(e, a),
            false => mul(a, e),
        };
        match self {
            InvertedFactor::Turn(q) => placed(transpose(symbols, q.clone()), e),
            InvertedFactor::Matrix(a) => placed(inverse(symbols, a.clone()), e),
            InvertedFactor::Cayley { turn, minus, .. } => {
                let across = match e.shape().is_vector() {
                    true => cross(turn.clone(), e.clone()),
                    false => placed(hat(turn.clone()), e.clone()),
                };
                let both = match minus {
                    true => add(e, across),
                    false => sub(e, across),
                };
                scale(Rational::HALF, both)
            }
        }
    }

    /// The inverse times a sum; the matrix is removed from terms that begin with it. If `from_right` is set, from
    /// terms that end with it.
    pub fn undo(&self, symbols: &Symbols, e: &Expr, from_right: bool) -> Expr {
        let (without, with) = self.apart(e, from_right);
        let rest = sum(with, e.shape());
        if rest.is_zero() {
            return sum(without, e.shape());
        }
        let rest = self.inverted(symbols, rest, from_right);
        sum(
            without.into_iter().chain([rest]).collect::<Vec<_>>(),
            e.shape(),
        )
    }

    /// Whether a term of the sum begins with the matrix; if `from_right` is set, whether it ends with it.
    pub fn stands_in(&self, e: &Expr, from_right: bool) -> bool {
        !self.apart(e, from_right).0.is_empty()
    }

    /// The terms with the matrix, after its removal, and the terms without it.
    fn apart(&self, e: &Expr, from_right: bool) -> (Vec<Expr>, Vec<Expr>) {
        let terms = match e.node() {
            Node::Sum(terms) => terms.clone(),
            _ => vec![e.clone()],
        };
        let (mut without, mut with) = (Vec::new(), Vec::new());
        for term in terms {
            let mut word = parts(&term);
            let own = match from_right {
                true => word.matrices.last(),
                false => word.matrices.first(),
            };
            if word.matrices.len() > 1 && own.is_some_and(|f| self.is(f)) {
                let at = if from_right {
                    word.matrices.len() - 1
                } else {
                    0
                };
                word.matrices.remove(at);
                let numbers = word.numbers.iter().map(|(base, q)| power(base.clone(), *q));
                let all = [number(word.coefficient)].into_iter().chain(numbers);
                without.push(product(all.chain(word.matrices.iter().cloned())));
            } else {
                with.push(term);
            }
        }
        (without, with)
    }

    /// The expression with `image` in place of this matrix times `v`.
    pub fn acted(&self, symbols: &Symbols, e: &Expr, v: &Expr, image: &Expr) -> Expr {
        let e = rebuild(symbols, e, &mut |x| self.acted(symbols, x, v, image));
        if let (Node::Sum(terms), Some((_, q))) = (e.node(), identity_and(self.whole())) {
            // `Q v + v`.
            let own = [mul(q, v.clone()), v.clone()];
            let places: Vec<usize> = (own.iter())
                .filter_map(|x| terms.iter().position(|t| t == x))
                .collect();
            if let [i, j] = places.as_slice() {
                let others = terms.iter().enumerate().filter(|(k, _)| k != i && k != j);
                let all = others.map(|(_, t)| t.clone()).chain([image.clone()]);
                return sum(all.collect::<Vec<_>>(), e.shape());
            }
        }
        let Node::Product(factors) = e.node() else {
            return e;
        };
        match factors.as_slice() {
            [before @ .., f, last] if last == v && self.is(f) => {
                product(before.iter().cloned().chain([image.clone()]))
            }
            _ => e,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::Dim;

    #[test]
    fn factors_are_undone_one_by_one() {
        let mut s = Symbols::default();
        let (three, vector) = (Shape::square(Dim::Fixed(3)), Shape::vector(Dim::Fixed(3)));
        let mut letter = |name: &str, shape, structure, role| {
            let id = s.add(name, shape, structure, role);
            here(&s, id)
        };
        let q = letter("Q", three, Structure::Orthogonal, Role::Derived);
        let m = letter("M", three, Structure::Symmetric, Role::Parameter);
        let a = letter("A", three, Structure::General, Role::Velocity);
        let c = letter("c", vector, Structure::General, Role::Derived);
        let [u, v] = ["u", "v"].map(|x| letter(x, vector, Structure::General, Role::Derived));
        let h = letter("h", Shape::SCALAR, Structure::General, Role::Step);
        let one = || identity(Dim::Fixed(3));
        let back = transpose(&s, q.clone());
        let (near, far) = (add(one(), back.clone()), add(q.clone(), one()));
        let turn = |_: &Expr| Some(c.clone());
        let whole = quotient(product([far.clone(), m.clone(), near.clone()]), h.clone());
        let (number, factors) = InvertedFactor::factors(&s, &whole, turn).expect("a product");
        assert_eq!(number, h);
        let [first, second, third] = factors.as_slice() else {
            panic!("{factors:?}");
        };
        assert!(matches!(first, InvertedFactor::Cayley { minus: false, .. }));
        assert!(matches!(second, InvertedFactor::Matrix(_)));
        assert!(matches!(third, InvertedFactor::Cayley { minus: true, .. }));
        // The factor is removed from terms that begin with it, for any order of its terms.
        let asked = add(mul(add(one(), q.clone()), u.clone()), v.clone());
        let rest = scale(Rational::HALF, sub(v.clone(), cross(c.clone(), v.clone())));
        assert_eq!(first.undo(&s, &asked, false), add(u.clone(), rest));
        let inverse = inverse(&s, m.clone());
        assert_eq!(second.undo(&s, &u, false), mul(inverse, u.clone()));
        let ends = mul(a.clone(), near.clone());
        assert!(third.stands_in(&ends, true) && !third.stands_in(&ends, false));
        assert_eq!(third.undo(&s, &ends, true), a);
        // `(Id + Q^T) v` is known.
        let long = sum([mul(back, v.clone()), v.clone(), c.clone()], vector);
        let seen = third.acted(&s, &mul(m.clone(), long), &v, &u);
        assert_eq!(seen, mul(m, add(c.clone(), u.clone())));
        // A matrix that varies is not inverted, and `Id - Q` is singular at zero velocity.
        assert!(InvertedFactor::factors(&s, &mul(far, a), turn).is_none());
        assert!(InvertedFactor::factors(&s, &sub(one(), q), turn).is_none());
    }
}
