//! The summands of a Lagrangian as they were typed. Numbers before a sum are multiplied into it and
//! nothing else is expanded, so that `(next(q, i) - q)^2` stays one term of a segment. Below the top,
//! a sum with a term of one neighbour alone, as in `next(q, i) - q`, is a difference and stays whole as well.

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
            // A bracket among the terms, or a definition, is below the top.
            let parts = terms.iter().flat_map(|(minus, t)| {
                let parts = split(lattice, t, false).into_iter();
                parts.map(move |p| if *minus { negated(p) } else { p })
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

/// A product with one factor that is a sum, all of them numbers.
fn product(lattice: &Lattice, e: &Expression, factors: &[Expression]) -> Vec<Expression> {
    if !factors.iter().all(|f| is_number(lattice, f)) {
        return vec![e.clone()];
    }
    let split = factors.iter().map(|f| split(lattice, f, false));
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

/// Whether an expression is a number, as far as its form says.
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
