//! The summands of a Lagrangian as typed. Scalars in front of a sum are multiplied into it and nothing else is
//! expanded, so that `(next(q, i) - q)^2` stays one term of a segment. Below the top level, a sum that contains a
//! term of one neighbour only, as in `next(q, i) - q`, is a difference and stays whole. So do the two terms of a time
//! difference, `next(q) - q`.

use super::declared::Lattice;
use super::range::of_one_neighbour;
use crate::syntax::ast::{Expression, Kind};

/// The summands of an expression, each with its sign and its factors.
pub(super) fn summands(lattice: &Lattice, e: &Expression) -> Vec<Expression> {
    split(lattice, e, true)
}

fn split(lattice: &Lattice, e: &Expression, top: bool) -> Vec<Expression> {
    match &e.kind {
        Kind::Sum(terms) => {
            if !top && terms.iter().any(|(_, t)| of_one_neighbour(lattice, t)) {
                return vec![e.clone()];
            }
            let together = match top {
                true => vec![None; terms.len()],
                false => differences(terms),
            };
            // A bracket among the terms, or a definition, is below the top level.
            let parts = terms.iter().zip(&together).enumerate();
            let parts = parts.flat_map(|(i, ((minus, t), partner))| match partner {
                Some(j) if *j < i => Vec::new(),
                Some(j) => {
                    let both = [i, *j].into_iter().filter_map(|k| terms.get(k).cloned());
                    vec![with(e, Kind::Sum(both.collect()))]
                }
                None => {
                    let parts = split(lattice, t, false).into_iter();
                    parts.map(|p| if *minus { negated(p) } else { p }).collect()
                }
            });
            parts.collect()
        }
        Kind::Neg(a) => split(lattice, a, top).into_iter().map(negated).collect(),
        Kind::Quotient(a, b) => {
            let parts = split(lattice, a, false).into_iter();
            parts
                .map(|p| with(e, Kind::Quotient(Box::new(p), b.clone())))
                .collect()
        }
        Kind::Product(factors) => product(lattice, e, factors),
        _ => vec![e.clone()],
    }
}

/// For each term, its partner in a difference in time: the same term one step earlier or later.
fn differences(terms: &[(bool, Expression)]) -> Vec<Option<usize>> {
    let mut out: Vec<Option<usize>> = vec![None; terms.len()];
    let known: Vec<(bool, String)> = terms.iter().map(|(_, t)| in_words(t)).collect();
    for i in 0..terms.len() {
        for j in i + 1..terms.len() {
            let opposite = terms[i].0 != terms[j].0 && known[i].0 != known[j].0;
            if out[i].is_none() && out[j].is_none() && opposite && known[i].1 == known[j].1 {
                (out[i], out[j]) = (Some(j), Some(i));
            }
        }
    }
    out
}

/// Whether an expression contains a quantity at the end of the step, and its text without `next`.
fn in_words(e: &Expression) -> (bool, String) {
    let head = match &e.kind {
        Kind::Call(f, arguments) if f.text == "next" && arguments.len() == 1 => {
            let inner = arguments.iter().map(in_words);
            return (true, inner.map(|(_, words)| words).collect());
        }
        Kind::Number(q) => format!("{q:?}"),
        Kind::Constant(c) => format!("{c:?}"),
        Kind::Name(n) => n.clone(),
        Kind::Shaped(..) => ":".to_owned(),
        Kind::Sum(terms) => {
            let signs = terms
                .iter()
                .map(|(minus, _)| if *minus { '-' } else { '+' });
            signs.collect()
        }
        Kind::Product(_) => "*".to_owned(),
        Kind::Quotient(..) => "/".to_owned(),
        Kind::Neg(_) => "neg".to_owned(),
        Kind::Transpose(_) => "^T".to_owned(),
        Kind::Power(_, q) => format!("^{q:?}"),
        Kind::Call(f, _) => f.text.clone(),
        Kind::Component(_, at) => format!("{at:?}"),
    };
    let parts: Vec<(bool, String)> = e.parts().into_iter().map(in_words).collect();
    let later = parts.iter().any(|(later, _)| *later);
    let words: Vec<String> = parts.into_iter().map(|(_, words)| words).collect();
    (later, format!("{head}({})", words.join(", ")))
}

/// Expands a product of scalars in which one factor is a sum.
fn product(lattice: &Lattice, e: &Expression, factors: &[Expression]) -> Vec<Expression> {
    if !factors.iter().all(|f| is_number(lattice, f)) {
        return vec![e.clone()];
    }
    let moves = |e: &Expression| contains(e, &|e| is_moving(lattice, e));
    let split = factors.iter().enumerate().map(|(i, f)| {
        let others = factors.iter().enumerate().filter(|(k, _)| *k != i);
        let terms = split(lattice, f, false);
        match others.map(|(_, other)| other).any(moves) {
            true => with_constants(lattice, f, terms),
            false => terms,
        }
    });
    let split: Vec<Vec<Expression>> = split.collect();
    let mut sums = (0..split.len()).filter(|i| split[*i].len() > 1);
    let (Some(place), None) = (sums.next(), sums.next()) else {
        return vec![e.clone()];
    };
    let parts = split[place].iter().map(|part| {
        let mut list = factors.to_vec();
        list[place] = part.clone();
        with(e, Kind::Product(list))
    });
    parts.collect()
}

/// Adds the constant terms to the first term that contains a velocity: `3 - tr(Ω)` is one kinetic energy, and its
/// constant is not a nodal term of its own.
fn with_constants(lattice: &Lattice, e: &Expression, terms: Vec<Expression>) -> Vec<Expression> {
    let on_edge = |e: &Expression| contains(e, &|e| is_of_the_edge(lattice, e));
    if !terms.iter().any(on_edge) {
        return terms;
    }
    let moves = |e: &Expression| contains(e, &|e| is_moving(lattice, e));
    let (mut moving, constant): (Vec<_>, Vec<_>) = terms.into_iter().partition(moves);
    if let Some(edge) = moving
        .iter_mut()
        .find(|t| on_edge(t))
        .filter(|_| !constant.is_empty())
    {
        let all = constant.into_iter().chain([edge.clone()]);
        *edge = with(e, Kind::Sum(all.map(|t| (false, t)).collect()));
    }
    moving
}

/// Whether `holds` is true for an expression or a part of it.
fn contains(e: &Expression, holds: &dyn Fn(&Expression) -> bool) -> bool {
    holds(e) || e.parts().into_iter().any(|part| contains(part, holds))
}

fn is_moving(lattice: &Lattice, e: &Expression) -> bool {
    matches!(&e.kind, Kind::Name(n) if lattice.moving.contains(n))
}

/// Whether it is a velocity, or a quantity at the next time node.
fn is_of_the_edge(lattice: &Lattice, e: &Expression) -> bool {
    match &e.kind {
        Kind::Name(n) => lattice.velocities.contains(n),
        Kind::Call(f, arguments) => f.text == "next" && arguments.len() == 1,
        _ => false,
    }
}

fn with(e: &Expression, kind: Kind) -> Expression {
    Expression {
        kind,
        place: e.place,
    }
}

fn negated(e: Expression) -> Expression {
    let place = e.place;
    let kind = match e.kind {
        Kind::Neg(inner) => return *inner,
        _ => Kind::Neg(Box::new(e)),
    };
    Expression { kind, place }
}

/// Whether an expression is scalar, as far as its form shows.
fn is_number(lattice: &Lattice, e: &Expression) -> bool {
    match &e.kind {
        Kind::Number(_) | Kind::Constant(_) | Kind::Component(..) => true,
        Kind::Name(n) => lattice.numbers.contains(n),
        Kind::Shaped(_, shape) => shape.name.text == "Real",
        Kind::Sum(terms) => terms.iter().all(|(_, t)| is_number(lattice, t)),
        Kind::Product(list) => list.iter().all(|f| is_number(lattice, f)),
        Kind::Quotient(a, _) | Kind::Neg(a) | Kind::Transpose(a) | Kind::Power(a, _) => {
            is_number(lattice, a)
        }
        Kind::Call(f, arguments) => match f.text.as_str() {
            "next" | "prev" | "sum" => arguments.first().is_some_and(|a| is_number(lattice, a)),
            "tr" | "Tr" | "det" | "log" | "exp" | "sqrt" | "sin" | "cos" | "sinh" | "cosh"
            | "tanh" | "abs" | "sign" | "dot" | "re" | "I1" | "I2" => true,
            _ => false,
        },
    }
}
