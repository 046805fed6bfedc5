//! Expressions as trees. Takes the values of observables and invariants; gives a value with a directional derivative.

use super::FUNCTIONS;

/// An expression.
#[derive(Clone, Debug)]
pub(super) enum Tree {
    Number(f64),
    /// The observable or invariant at a place.
    Seen(usize),
    /// The function with a number.
    Call(usize, Box<Tree>),
    Negative(Box<Tree>),
    Power(Box<Tree>, Box<Tree>),
    /// Terms with signs.
    Sum(Vec<(bool, Tree)>),
    /// Factors; `true` divides.
    Product(Vec<(bool, Tree)>),
}

impl Tree {
    /// Visits the places of observables and invariants.
    pub fn each(&self, visit: &mut dyn FnMut(usize)) {
        match self {
            Tree::Number(_) => {}
            Tree::Seen(at) => visit(*at),
            Tree::Call(_, a) | Tree::Negative(a) => a.each(visit),
            Tree::Power(a, b) => {
                a.each(visit);
                b.each(visit);
            }
            Tree::Sum(all) | Tree::Product(all) => all.iter().for_each(|(_, a)| a.each(visit)),
        }
    }

    /// The value and its derivative, along the derivatives that `along` gives to observables; `None` is zero.
    pub fn dual(&self, seen: &[f64], along: &mut dyn FnMut(usize) -> Option<f64>) -> (f64, f64) {
        match self {
            Tree::Number(x) => (*x, 0.0),
            Tree::Seen(at) => (
                seen.get(*at).copied().unwrap_or(f64::NAN),
                along(*at).unwrap_or(0.0),
            ),
            Tree::Negative(a) => {
                let (x, dx) = a.dual(seen, along);
                (-x, -dx)
            }
            Tree::Call(function, a) => {
                let (x, dx) = a.dual(seen, along);
                let Some((_, of, slope)) = FUNCTIONS.get(*function) else {
                    return (f64::NAN, f64::NAN);
                };
                // A constant argument contributes nothing, even where the function lacks a derivative.
                (of(x), if dx == 0.0 { 0.0 } else { slope(x) * dx })
            }
            Tree::Sum(all) => all.iter().fold((0.0, 0.0), |(sum, dsum), (minus, a)| {
                let (x, dx) = a.dual(seen, along);
                match minus {
                    true => (sum - x, dsum - dx),
                    false => (sum + x, dsum + dx),
                }
            }),
            Tree::Product(all) => all.iter().fold((1.0, 0.0), |(y, dy), (divides, a)| {
                let (x, dx) = a.dual(seen, along);
                match divides {
                    true => (y / x, (dy - y / x * dx) / x),
                    false => (y * x, dy * x + y * dx),
                }
            }),
            Tree::Power(a, b) => {
                let (x, dx) = a.dual(seen, along);
                let (n, dn) = b.dual(seen, along);
                let y = power(x, n);
                let by_base = if dx == 0.0 || n == 0.0 {
                    0.0
                } else {
                    n * power(x, n - 1.0) * dx
                };
                let by_exponent = if dn == 0.0 { 0.0 } else { y * x.ln() * dn };
                (y, by_base + by_exponent)
            }
        }
    }
}

fn power(x: f64, n: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation)]
    match n.fract() == 0.0 && n.abs() < 1e9 {
        true => x.powi(n as i32),
        false => x.powf(n),
    }
}
