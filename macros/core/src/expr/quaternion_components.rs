//! Splits quaternions for emitted code. Real and imaginary parts of products of unit quaternions and of vectors (as
//! quaternions) are expressed by the parts of their factors. The result has scalars and vectors of three components
//! instead of matrices of four rows. Takes an expression, gives an equal one.

use super::shape::{Dim, Shape, Structure};
use super::symbol::Symbols;
use super::*;

/// The parts of a quaternion.
struct Both {
    re: Expr,
    im: Expr,
}

/// The largest number of factors of a product that is expanded; each factor doubles the number of terms.
const MOST: usize = 4;

/// The largest number of products in an expansion.
const MOST_WORDS: usize = 16;

/// The expression in which real and imaginary parts are taken only of single quaternions and of relative quaternions,
/// `re(q^T p)`.
pub fn quaternion_components(symbols: &Symbols, e: &Expr) -> Expr {
    let e = rebuild(symbols, e, &mut |x| quaternion_components(symbols, x));
    let taken = match e.node() {
        Node::Map(Map::Imaginary, a) => both(symbols, a).map(|b| b.im),
        Node::Map(Map::Real, a) => both(symbols, a).map(|b| b.re),
        Node::Trace(a) if a.shape() == Shape::square(Dim::Fixed(4)) => {
            let b = both(symbols, a);
            b.map(|b| scale(Rational::integer(4), b.re))
        }
        _ => None,
    };
    taken.unwrap_or(e)
}

/// Whether it is a letter of a unit quaternion.
fn is_unit(symbols: &Symbols, e: &Expr) -> bool {
    match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::UnitQuaternion,
        _ => false,
    }
}

/// The unit quaternion whose conjugate this is, if it is one.
fn conjugated<'a>(symbols: &Symbols, e: &'a Expr) -> Option<&'a Expr> {
    match e.node() {
        Node::Transpose(x) if is_unit(symbols, x) => Some(x),
        _ => None,
    }
}

fn both(symbols: &Symbols, e: &Expr) -> Option<Both> {
    let vector = Shape::vector(Dim::Fixed(3));
    let each =
        |list: &[Expr]| -> Option<Vec<Both>> { list.iter().map(|x| both(symbols, x)).collect() };
    Some(match e.node() {
        Node::Letter(_) if is_unit(symbols, e) => Both {
            re: real(e.clone()),
            im: imaginary(e.clone()),
        },
        Node::Identity(Dim::Fixed(4)) => Both {
            re: integer(1),
            im: zero(vector),
        },
        Node::Map(Map::Pure, v) => Both {
            re: integer(0),
            im: v.clone(),
        },
        Node::Neg(x) => {
            let Both { re, im } = both(symbols, x)?;
            Both {
                re: neg(re),
                im: neg(im),
            }
        }
        Node::Transpose(x) => {
            let Both { re, im } = both(symbols, x)?;
            Both { re, im: neg(im) }
        }
        Node::Quotient(x, y) => {
            let Both { re, im } = both(symbols, x)?;
            Both {
                re: quotient(re, y.clone()),
                im: quotient(im, y.clone()),
            }
        }
        Node::Sum(terms) => {
            let (re, im): (Vec<Expr>, Vec<Expr>) =
                each(terms)?.into_iter().map(|b| (b.re, b.im)).unzip();
            Both {
                re: sum(re, Shape::SCALAR),
                im: sum(im, vector),
            }
        }
        Node::Product(_) => of_product(symbols, e)?,
        _ => return None,
    })
}

/// A product in which short sums are expanded.
fn of_product(symbols: &Symbols, e: &Expr) -> Option<Both> {
    let mut words = Vec::new();
    spread(e, &mut words)?;
    let each: Option<Vec<Both>> = words
        .into_iter()
        .map(|(numbers, word)| of_word(symbols, numbers, word))
        .collect();
    let (re, im): (Vec<Expr>, Vec<Expr>) = each?.into_iter().map(|b| (b.re, b.im)).unzip();
    Some(Both {
        re: sum(re, Shape::SCALAR),
        im: sum(im, Shape::vector(Dim::Fixed(3))),
    })
}

/// Scalars, and quaternions in order.
type Word = (Vec<Expr>, Vec<Expr>);

/// The words of a quaternion.
fn spread(e: &Expr, out: &mut Vec<Word>) -> Option<()> {
    match e.node() {
        Node::Neg(x) => {
            let from = out.len();
            spread(x, out)?;
            let own = out.iter_mut().skip(from);
            own.for_each(|(numbers, _)| numbers.push(integer(-1)));
        }
        Node::Quotient(x, y) => {
            let from = out.len();
            spread(x, out)?;
            let by = quotient(integer(1), y.clone());
            let own = out.iter_mut().skip(from);
            own.for_each(|(numbers, _)| numbers.push(by.clone()));
        }
        Node::Sum(terms) => terms.iter().try_for_each(|t| spread(t, out))?,
        Node::Product(factors) => {
            let mut all: Vec<Word> = vec![Word::default()];
            for f in factors {
                if f.shape().is_scalar() {
                    all.iter_mut().for_each(|(n, _)| n.push(f.clone()));
                    continue;
                }
                let mut own = Vec::new();
                spread(f, &mut own)?;
                let both = |(n, w): &Word| {
                    let (n, w) = (n.clone(), w.clone());
                    let with = move |(m, v): &Word| {
                        ([n.as_slice(), m].concat(), [w.as_slice(), v].concat())
                    };
                    own.iter().map(with).collect::<Vec<Word>>()
                };
                all = all.iter().flat_map(both).collect();
                if all.len() > MOST_WORDS {
                    return None;
                }
            }
            out.extend(all);
        }
        _ => out.push((Vec::new(), vec![e.clone()])),
    }
    (out.len() <= MOST_WORDS).then_some(())
}

/// The parts of one word.
fn of_word(symbols: &Symbols, numbers: Vec<Expr>, mut word: Vec<Expr>) -> Option<Both> {
    ordered(symbols, &mut word);
    let mut factors = Vec::new();
    let mut rest = word.as_slice();
    while let [first, after @ ..] = rest {
        let from = conjugated(symbols, first);
        let to = after.first().filter(|y| is_unit(symbols, y));
        let (next, left) = match (from, to) {
            (Some(x), Some(y)) => (between(symbols, x, y), after.get(1..)?),
            _ => (both(symbols, first)?, after),
        };
        factors.push(next);
        rest = left;
    }
    if factors.len() > MOST {
        return None;
    }
    let one = Both {
        re: integer(1),
        im: zero(Shape::vector(Dim::Fixed(3))),
    };
    let all = factors.into_iter().fold(one, times);
    let by = |e: Expr| product(numbers.iter().cloned().chain([e]));
    Some(Both {
        re: by(all.re),
        im: by(all.im),
    })
}

/// The parts of `x^T y` for two letters, expressed by the parts of the pair in one fixed order.
fn between(symbols: &Symbols, x: &Expr, y: &Expr) -> Both {
    let letter = |e: &Expr| letters(e).first().copied();
    let turned = letter(x) > letter(y);
    let (a, b) = if turned { (y, x) } else { (x, y) };
    let whole = mul(transpose(symbols, a.clone()), b.clone());
    let im = imaginary(whole.clone());
    Both {
        re: real(whole),
        im: if turned { neg(im) } else { im },
    }
}

/// Hamilton's product.
fn times(a: Both, b: Both) -> Both {
    if a.im.is_zero() && a.re == integer(1) {
        return b;
    }
    let re = sub(
        mul(a.re.clone(), b.re.clone()),
        dot(a.im.clone(), b.im.clone()),
    );
    let im = [
        mul(a.re, b.im.clone()),
        mul(b.re, a.im.clone()),
        cross(a.im, b.im),
    ];
    Both {
        re,
        im: sum(im, Shape::vector(Dim::Fixed(3))),
    }
}

/// Cancels adjacent inverse factors, and moves vectors in front of the quaternions that rotate them: `q quat(rot(q)^T
/// v) = quat(v) q`.
fn ordered(symbols: &Symbols, word: &mut Vec<Expr>) {
    let opposite =
        |a: &Expr, b: &Expr| conjugated(symbols, a) == Some(b) || conjugated(symbols, b) == Some(a);
    loop {
        if let Some(i) = word.windows(2).position(|w| opposite(&w[0], &w[1])) {
            word.drain(i..i + 2);
            continue;
        }
        let moved = word.windows(2).enumerate().find_map(|(i, w)| {
            let turns = is_unit(symbols, &w[0]) || conjugated(symbols, &w[0]).is_some();
            let Node::Map(Map::Pure, v) = w[1].node() else {
                return None;
            };
            let lead = transpose(symbols, rotation(symbols, w[0].clone()));
            turns.then(|| without(v, &lead)).flatten().map(|v| (i, v))
        });
        let Some((i, v)) = moved else {
            break;
        };
        let turn = word.remove(i);
        word.insert(i + 1, turn);
        word[i] = pure(v);
    }
}

/// `v` if the expression is `R v`.
fn without(e: &Expr, lead: &Expr) -> Option<Expr> {
    let go = |x: &Expr| without(x, lead);
    match e.node() {
        Node::Neg(x) => go(x).map(neg),
        Node::Quotient(x, y) => Some(quotient(go(x)?, y.clone())),
        Node::Sum(terms) => {
            let each: Option<Vec<Expr>> = terms.iter().map(go).collect();
            Some(sum(each?, e.shape()))
        }
        Node::Product(factors) => {
            let at = factors.iter().position(|f| !f.shape().is_scalar())?;
            let mut rest = factors.clone();
            match &rest[at] == lead && rest.len() > at + 1 {
                true => {
                    rest.remove(at);
                }
                // A vector in brackets is the last factor.
                false if rest.len() == at + 1 => rest[at] = go(&rest[at])?,
                false => return None,
            }
            Some(product(rest))
        }
        _ => None,
    }
}
