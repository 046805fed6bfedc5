//! Fields of structured matrices. They are stored and varied as the list of their independent entries, from which the
//! matrix is built.

use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// How the matrix of a field is built from its stored entries.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Entries {
    /// The matrix itself is stored.
    Own,
    /// The stored vector is its diagonal.
    Diagonal,
    /// A symmetric matrix of this size: its entries on and above the diagonal, row by row.
    Symmetric(u32),
    /// A skew matrix of this size: for size 3 its axial vector, otherwise the entries below the diagonal, row by row.
    Skew(u32),
}

impl Entries {
    /// The shape of the field in expressions.
    pub fn shape(self, kept: Shape) -> Shape {
        match self {
            Entries::Own => kept,
            Entries::Diagonal => Shape::square(kept.rows),
            Entries::Symmetric(n) | Entries::Skew(n) => Shape::square(Dim::Fixed(n)),
        }
    }

    /// The matrix built from the stored entries.
    pub fn matrix(self, symbols: &Symbols, kept: Expr) -> Expr {
        match self {
            Entries::Own => kept,
            Entries::Diagonal => expr::diagonal(kept),
            Entries::Skew(3) => expr::hat(kept),
            Entries::Symmetric(n) => {
                let places = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
                made(symbols, n, &kept, places, |a, b| match a == b {
                    true => a,
                    false => expr::add(a, b),
                })
            }
            Entries::Skew(n) => {
                let places = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
                made(symbols, n, &kept, places, expr::sub)
            }
        }
    }
}

/// The sum of entries times the matrix units at their position and at the transposed one, combined by `with`.
fn made(
    symbols: &Symbols,
    n: u32,
    kept: &Expr,
    places: impl Iterator<Item = (u32, u32)>,
    with: impl Fn(Expr, Expr) -> Expr,
) -> Expr {
    let size = Dim::Fixed(n);
    let axis = |i: u32| expr::unit(size, u8::try_from(i).unwrap_or(0));
    let unit = |i, j| expr::mul(axis(i), expr::transpose(symbols, axis(j)));
    let rows = kept.shape().rows;
    let entry = |k: usize| match kept.shape().is_scalar() {
        true => kept.clone(),
        false => expr::dot(kept.clone(), expr::unit(rows, u8::try_from(k).unwrap_or(0))),
    };
    let terms = places
        .enumerate()
        .map(|(k, (i, j))| expr::mul(entry(k), with(unit(i, j), unit(j, i))));
    let terms: Vec<Expr> = terms.collect();
    expr::sum(terms, Shape::square(size))
}
