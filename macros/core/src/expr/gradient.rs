//! Gradients with respect to one letter, by reverse accumulation, in the pairing `<A, B> = tr(A^T B)`: `d e =
//! <gradient, d letter>`. The result preserves the structure of the user's expression.

use super::*;
use crate::expr::symbol::Symbols;

const QUARTER: Rational = Rational::QUARTER;

/// The gradient of the scalar `e` with respect to `wrt`, of the shape of that letter.
pub fn gradient(symbols: &Symbols, e: &Expr, wrt: Letter) -> Expr {
    let shape = symbols.get(wrt.symbol).shape;
    let mut terms = Vec::new();
    pull_back(symbols, e, integer(1), wrt, &mut terms);
    sum(terms, shape)
}

/// Adds to `out` the contribution of `seed`, the gradient with respect to `e`, to the gradient with respect to
/// `wrt`.
fn pull_back(symbols: &Symbols, e: &Expr, seed: Expr, wrt: Letter, out: &mut Vec<Expr>) {
    if !contains(e, wrt) || seed.is_zero() {
        return;
    }
    let t = |x: &Expr| transpose(symbols, x.clone());
    let mut go = |x: &Expr, s: Expr| pull_back(symbols, x, s, wrt, out);
    match e.node() {
        Node::Number(_)
        | Node::Constant(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..) => {}
        Node::Letter(at) => {
            if *at == wrt {
                out.push(seed);
            }
        }
        Node::Sum(terms) => terms.iter().for_each(|x| go(x, seed.clone())),
        Node::Neg(a) => go(a, neg(seed)),
        Node::Product(factors) => {
            for (i, f) in factors.iter().enumerate() {
                if f.shape().is_scalar() {
                    let rest = product(without(factors, i));
                    go(f, pairing(symbols, seed.clone(), rest));
                } else {
                    let numbers = factors.iter().filter(|x| x.shape().is_scalar()).cloned();
                    let matrix = |x: &&Expr| !x.shape().is_scalar();
                    let before = factors[..i].iter().rev().filter(matrix).map(t);
                    let after = factors[i + 1..].iter().rev().filter(matrix).map(t);
                    let word = numbers
                        .chain(before)
                        .chain([seed.clone()])
                        .chain(after)
                        .collect::<Vec<_>>();
                    go(f, product(word));
                }
            }
        }
        Node::Quotient(a, b) => {
            go(a, quotient(seed.clone(), b.clone()));
            let whole = pairing(symbols, seed, a.clone());
            go(
                b,
                neg(quotient(whole, power(b.clone(), Rational::integer(2)))),
            );
        }
        Node::Power(a, q) => {
            if let Some(lower) = q.plus(Rational::MINUS_ONE) {
                go(a, product([number(*q), seed, power(a.clone(), lower)]));
            }
        }
        Node::Transpose(a) => go(a, t(&seed)),
        Node::Inverse(a) => {
            let back = transpose(symbols, e.clone());
            go(a, neg(product([back.clone(), seed, back])));
        }
        Node::Trace(a) => go(a, mul(seed, identity(a.shape().rows))),
        Node::Det(a) if let Some(factors) = determinant::det_by_factors(a) => go(&factors, seed),
        Node::Det(a) => {
            let cofactor = transpose(symbols, adjugate(symbols, a));
            go(a, mul(seed, cofactor));
        }
        Node::Adjugate(a) => {
            let polynomial = adjugate_polynomial(a);
            pull_back(symbols, &polynomial, seed, wrt, out);
        }
        Node::Dot(a, b) => {
            go(a, mul(seed.clone(), b.clone()));
            go(b, mul(seed, a.clone()));
        }
        Node::Cross(a, b) => {
            go(a, cross(b.clone(), seed.clone()));
            go(b, cross(seed, a.clone()));
        }
        // <S, hat v> = 2 v . vee(S)
        Node::Hat(v) => go(v, scale(Rational::integer(2), vee(seed))),
        // s . vee(A) = <hat(s)/2, A>
        Node::Vee(a) => go(a, scale(Rational::HALF, hat(seed))),
        Node::Part(which, a) => go(a, part(*which, seed)),
        // d log det A = tr(A^-1 dA): the determinant cancels.
        Node::Call(Function::Log, a) if matches!(a.node(), Node::Det(_)) => {
            if let Node::Det(inner) = a.node() {
                let whole = std::slice::from_ref(inner);
                for x in determinant::factors_of_det(inner).unwrap_or(whole) {
                    let back = transpose(symbols, inverse(symbols, x.clone()));
                    go(x, mul(seed.clone(), back));
                }
            }
        }
        Node::Call(function, a) => go(a, function.chain(e, a, seed)),
        Node::Map(map, a) => match map {
            Map::Real => go(
                a,
                product([number(QUARTER), seed, identity(a.shape().rows)]),
            ),
            // s . im(A) = <pure(s)/4, A>
            Map::Imaginary => go(a, scale(QUARTER, pure(seed))),
            Map::Pure => go(a, scale(Rational::integer(4), imaginary(seed))),
            Map::Rotation if is_motion(symbols, a) => go(a, rigid::in_block(symbols, seed)),
            Map::Translation => go(a, rigid::in_column(symbols, seed)),
            Map::Diagonal => go(a, diagonal_of(seed)),
            Map::DiagonalOf => go(a, diagonal(seed)),
            Map::Twist => go(a, rigid::paired_with_twists(symbols, &seed)),
            // <S, R hat(2 im(W^T D))> = <W pure(vee(R^T S)), D>
            Map::Rotation => go(a, mul(a.clone(), pure(vee(mul(t(e), seed))))),
        },
        Node::Given(a) => {
            let parts = functional::gradients(symbols, a, None, &seed, &|x| contains(x, wrt));
            parts.into_iter().for_each(|(x, s)| go(x, s));
        }
        Node::PullBack(a, which, own) => {
            let back = Some((*which, own));
            let parts = functional::gradients(symbols, a, back, &seed, &|x| contains(x, wrt));
            parts.into_iter().for_each(|(x, s)| go(x, s));
        }
    }
}

fn without(factors: &[Expr], i: usize) -> Vec<Expr> {
    let mut rest = factors.to_vec();
    rest.remove(i);
    rest
}
