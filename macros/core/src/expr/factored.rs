//! Factors common factors out of sums: `h M x + h M y` is computed as `h (M (x + y))`. Used for emitted code, not for
//! display: divisions become products with inverses that are known beforehand. Takes an expression, gives an equal
//! one.

use super::collect::{Parts, parts};
use super::shape::Structure;
use super::substitute::bottom_up;
use super::*;
use crate::expr::symbol::Symbols;

/// Scalars and their exponents.
type Powers = Vec<(Expr, Rational)>;

/// A term of a sum without its scalars: a multiple of a product of factors in order.
#[derive(Clone)]
struct Word {
    times: Rational,
    factors: Vec<Expr>,
}

/// The expression with common factors taken out of sums of vectors and matrices.
pub fn factored(symbols: &Symbols, e: &Expr) -> Expr {
    bottom_up(symbols, e, &|e| match e.node() {
        Node::Sum(_) | Node::Product(_) | Node::Quotient(..) if !e.shape().is_scalar() => {
            let mut terms = Vec::new();
            flatten(symbols, &e, &mut terms);
            position_differences::first(symbols, of_terms(symbols, terms, e.shape()))
        }
        Node::Vee(a) => axial_of_outer(symbols, a).unwrap_or(e),
        _ => e,
    })
}

/// `vee(a b^T)`, which is half of `b x a`, for a product of a column and a row, or of a matrix and a sum of such
/// products. Moments on a body thus become a sum of cross products.
pub fn axial_of_outer(symbols: &Symbols, a: &Expr) -> Option<Expr> {
    let Parts {
        coefficient,
        numbers,
        matrices,
        ..
    } = parts(a);
    let Some(cut) = matrices
        .iter()
        .position(|m| m.shape().cols == Dim::Fixed(1))
    else {
        let at = matrices
            .iter()
            .position(|m| matches!(m.node(), Node::Sum(_)))?;
        let Node::Sum(terms) = matrices[at].node() else {
            return None;
        };
        let each = terms.iter().map(|t| {
            let mut word = matrices.clone();
            word[at] = t.clone();
            axial_of_outer(symbols, &product(word))
        });
        let each: Option<Vec<Expr>> = each.collect();
        let all = super::sum(each?, Shape::vector(Dim::Fixed(3)));
        return Some(product([scalar(coefficient, &numbers), all]));
    };
    let (left, right) = matrices.split_at(cut + 1);
    if right.first()?.shape().rows != Dim::Fixed(1) {
        return None;
    }
    let (a, b) = (
        product(left.to_vec()),
        transpose(symbols, product(right.to_vec())),
    );
    let half = coefficient.times(Rational::HALF)?;
    Some(product([scalar(half, &numbers), cross(b, a)]))
}

/// The terms of a sum with scalars multiplied through; an adjacent rotation and its inverse cancel.
fn flatten(symbols: &Symbols, e: &Expr, out: &mut Vec<Parts>) {
    if let Node::Sum(terms) = e.node() {
        terms.iter().for_each(|t| flatten(symbols, t, out));
        return;
    }
    let mut term = parts(e);
    cancel(symbols, &mut term.matrices);
    // `parts` writes `(-A - B) C` as `-(A + B) C`.
    if let [only] = term.matrices.as_slice()
        && matches!(only.node(), Node::Sum(_) | Node::Neg(_))
        && *only != *e
        && !position_differences::is_between(symbols, only)
    {
        let mut inner = Vec::new();
        flatten(symbols, only, &mut inner);
        for mut i in inner {
            match i.coefficient.times(term.coefficient) {
                Some(c) => i.coefficient = c,
                None => i.numbers.push((number(term.coefficient), Rational::ONE)),
            }
            for (base, exponent) in &term.numbers {
                match i.numbers.iter_mut().find(|(b, _)| b == base) {
                    Some((_, x)) if x.plus(*exponent).is_some() => {
                        *x = x.plus(*exponent).unwrap_or(*x);
                    }
                    _ => i.numbers.push((base.clone(), *exponent)),
                }
            }
            i.numbers.retain(|(_, x)| !x.is_zero());
            out.push(i);
        }
        return;
    }
    out.push(term);
}

fn cancel(symbols: &Symbols, word: &mut Vec<Expr>) {
    let turn = |e: &Expr| match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::Orthogonal,
        _ => false,
    };
    let inverse = |a: &Expr, b: &Expr| match (a.node(), b.node()) {
        (Node::Transpose(x), _) => x == b && turn(b),
        (_, Node::Transpose(y)) => y == a && turn(a),
        _ => false,
    };
    while let Some(i) = word.windows(2).position(|w| inverse(&w[0], &w[1])) {
        word.drain(i..i + 2);
    }
}

/// The number `q` times powers of scalars.
fn scalar(q: Rational, numbers: &[(Expr, Rational)]) -> Expr {
    let powers = numbers.iter().map(|(base, x)| power(base.clone(), *x));
    product([number(q)].into_iter().chain(powers))
}

fn of_terms(symbols: &Symbols, terms: Vec<Parts>, shape: Shape) -> Expr {
    // Terms with the same factors: their coefficients are added.
    let mut same: Vec<(Vec<Expr>, Vec<Parts>)> = Vec::new();
    for t in terms {
        match same.iter_mut().find(|(word, _)| *word == t.matrices) {
            Some((_, list)) => list.push(t),
            None => same.push((t.matrices.clone(), vec![t])),
        }
    }
    let mut groups: Vec<(Powers, Vec<Word>)> = Vec::new();
    for (factors, list) in same {
        let (times, numbers) = match list.as_slice() {
            [only] => (only.coefficient, only.numbers.clone()),
            list if alike_total(list).is_some_and(|c| !c.is_zero()) => {
                let times = alike_total(list).unwrap_or(Rational::ONE);
                (times, list[0].numbers.clone())
            }
            list => {
                let all = list.iter().map(|t| scalar(t.coefficient, &t.numbers));
                let total = sum(all.collect::<Vec<_>>(), Shape::SCALAR);
                if total.is_zero() {
                    continue;
                }
                (Rational::ONE, vec![(total, Rational::ONE)])
            }
        };
        let word = Word { times, factors };
        match groups.iter_mut().find(|(n, _)| alike(n, &numbers)) {
            Some((_, words)) => words.push(word),
            None => groups.push((numbers, vec![word])),
        }
    }
    let written = groups.into_iter().map(|(numbers, words)| {
        let (common, words) = without_common_number(words);
        product([scalar(common, &numbers), of_words(symbols, words, shape)])
    });
    sum(written.collect::<Vec<_>>(), shape)
}

/// The multiple of the scalars that all terms share.
fn alike_total(list: &[Parts]) -> Option<Rational> {
    let (first, rest) = list.split_first()?;
    rest.iter().try_fold(first.coefficient, |total, t| {
        let same = alike(&first.numbers, &t.numbers);
        same.then(|| total.plus(t.coefficient)).flatten()
    })
}

/// Whether both are the same powers, in any order.
fn alike(a: &[(Expr, Rational)], b: &[(Expr, Rational)]) -> bool {
    a.len() == b.len() && a.iter().all(|x| b.contains(x))
}

/// Factors out the number that all words share, up to sign.
fn without_common_number(mut words: Vec<Word>) -> (Rational, Vec<Word>) {
    let size = |q: Rational| if q.is_negative() { q.negated() } else { q };
    let Some(first) = words.first().map(|w| size(w.times)) else {
        return (Rational::ONE, words);
    };
    if words.iter().any(|w| size(w.times) != first) {
        return (Rational::ONE, words);
    }
    for w in &mut words {
        w.times = match w.times.is_negative() {
            true => Rational::MINUS_ONE,
            false => Rational::ONE,
        };
    }
    (first, words)
}

/// The sum of words of one shape, with the most frequent outer factor taken out, recursively.
fn of_words(symbols: &Symbols, words: Vec<Word>, shape: Shape) -> Expr {
    let whole = |w: &Word| match w.factors.is_empty() {
        true => scale(w.times, identity(shape.rows)),
        false => scale(w.times, product(w.factors.clone())),
    };
    if let [only] = words.as_slice() {
        return whole(only);
    }
    let Some(outer) = outermost(&words) else {
        return sum(words.iter().map(whole).collect::<Vec<_>>(), shape);
    };
    let count = words.len();
    let (mut with, mut without) = (Vec::new(), Vec::new());
    for mut w in words {
        if outer.take(&mut w.factors) {
            with.push(w);
        } else {
            without.push(w);
        }
    }
    let wraps = !matches!(outer, Outer::First(_) | Outer::Last(_));
    if wraps {
        with = with.iter().flat_map(|w| opened(symbols, w)).collect();
    }
    let (common, with) = without_common_number(with);
    let inner = match &outer {
        Outer::First(f) => Shape {
            rows: f.shape().cols,
            cols: shape.cols,
        },
        Outer::Last(f) => Shape {
            rows: shape.rows,
            cols: f.shape().rows,
        },
        Outer::CrossLeft(_) | Outer::CrossRight(_) | Outer::Hat => Shape::vector(shape.rows),
        Outer::Vee => Shape::square(shape.rows),
    };
    let together = scale(common, outer.around(of_words(symbols, with, inner)));
    if without.is_empty() {
        return together;
    }
    // The factored part and the remainder may share a factor.
    let both = add(together, of_words(symbols, without, shape));
    let Node::Sum(terms) = both.node() else {
        return both;
    };
    let again: Option<Vec<Word>> = terms.iter().map(word).collect();
    match again {
        Some(again) if again.len() < count && outermost(&again).is_some() => {
            of_words(symbols, again, shape)
        }
        _ => both,
    }
}

/// Expands a word after its outer factor was removed. The word is unchanged if its terms contain other scalars.
fn opened(symbols: &Symbols, w: &Word) -> Vec<Word> {
    let mut terms = Vec::new();
    flatten(symbols, &product(w.factors.clone()), &mut terms);
    let words: Option<Vec<Word>> = terms
        .into_iter()
        .map(|t| {
            let times = w.times.times(t.coefficient)?;
            let factors = t.matrices;
            t.numbers.is_empty().then_some(Word { times, factors })
        })
        .collect();
    words.unwrap_or_else(|| vec![w.clone()])
}

/// A term that is a word. None if it contains other scalars.
fn word(e: &Expr) -> Option<Word> {
    let term = parts(e);
    term.numbers.is_empty().then_some(Word {
        times: term.coefficient,
        factors: term.matrices,
    })
}

/// The outer part that several words share.
#[derive(Clone, PartialEq)]
enum Outer {
    First(Expr),
    Last(Expr),
    /// `a x .`
    CrossLeft(Expr),
    /// `. x b`
    CrossRight(Expr),
    Vee,
    Hat,
}

impl Outer {
    /// All outer parts of this word.
    fn of(factors: &[Expr]) -> Vec<Outer> {
        let mut all = Vec::new();
        if let [only] = factors {
            match only.node() {
                Node::Cross(a, b) => {
                    all.push(Outer::CrossLeft(a.clone()));
                    all.push(Outer::CrossRight(b.clone()));
                }
                Node::Vee(_) => all.push(Outer::Vee),
                Node::Hat(_) => all.push(Outer::Hat),
                _ => {}
            }
        }
        // `A` without its factor `A` is the identity, so that `A` must be square.
        let fits = |f: &Expr| factors.len() > 1 || f.shape().is_square();
        all.extend(
            factors
                .first()
                .filter(|f| fits(f))
                .cloned()
                .map(Outer::First),
        );
        all.extend(factors.last().filter(|f| fits(f)).cloned().map(Outer::Last));
        all
    }

    /// Removes this outer part from the word, if present.
    fn take(&self, factors: &mut Vec<Expr>) -> bool {
        let only = match factors.as_slice() {
            [only] => Some(only.clone()),
            _ => None,
        };
        let node = only.as_ref().map(Expr::node);
        match (self, node) {
            (Outer::CrossLeft(a), Some(Node::Cross(x, b))) if a == x => *factors = vec![b.clone()],
            (Outer::CrossRight(b), Some(Node::Cross(a, y))) if b == y => {
                *factors = vec![a.clone()];
            }
            (Outer::Vee, Some(Node::Vee(x))) | (Outer::Hat, Some(Node::Hat(x))) => {
                *factors = vec![x.clone()];
            }
            (Outer::First(f), _)
                if factors.first() == Some(f) && (factors.len() > 1 || f.shape().is_square()) =>
            {
                factors.remove(0);
            }
            (Outer::Last(f), _)
                if factors.last() == Some(f) && (factors.len() > 1 || f.shape().is_square()) =>
            {
                factors.pop();
            }
            _ => return false,
        }
        true
    }

    fn around(&self, inner: Expr) -> Expr {
        match self {
            Outer::First(f) => mul(f.clone(), inner),
            Outer::Last(f) => mul(inner, f.clone()),
            Outer::CrossLeft(a) => cross(a.clone(), inner),
            Outer::CrossRight(b) => cross(inner, b.clone()),
            Outer::Vee => vee(inner),
            Outer::Hat => hat(inner),
        }
    }
}

/// The outer part that most words share, the first one of several. None if no two words share one.
fn outermost(words: &[Word]) -> Option<Outer> {
    let mut found: Vec<(Outer, usize)> = Vec::new();
    for w in words {
        for o in Outer::of(&w.factors) {
            match found.iter_mut().find(|(other, _)| *other == o) {
                Some((_, n)) => *n += 1,
                None => found.push((o, 1)),
            }
        }
    }
    let most = found.iter().map(|(_, n)| *n).max().filter(|n| *n > 1)?;
    found.into_iter().find(|(_, n)| *n == most).map(|(o, _)| o)
}
