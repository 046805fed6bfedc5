//! The cheapest bracketing of a chain of matrix products, by the classical dynamic program: `A B v` is computed as `A
//! (B v)`.

use crate::expr::shape::Dim;
use crate::expr::{Expr, Node};

/// A bracketed product.
#[derive(Clone, Debug)]
pub enum Bracketed {
    /// The i-th factor.
    Factor(usize),
    /// A product of two.
    Pair(Box<Bracketed>, Box<Bracketed>),
}

/// Brackets the factors, whose shapes must match.
pub fn associate(factors: &[Expr]) -> Bracketed {
    let n = factors.len();
    let size = |d: Dim| match d {
        Dim::Fixed(n) => u64::from(n),
        Dim::Named(_) => 4,
    };
    let mut dims: Vec<u64> = factors.iter().map(|f| size(f.shape().rows)).collect();
    dims.push(factors.last().map_or(1, |f| size(f.shape().cols)));
    let constant = |f: &Expr| match f.node() {
        Node::Inclusion(..) => true,
        Node::Transpose(a) => matches!(a.node(), Node::Inclusion(..)),
        _ => false,
    };
    // cost[i][j], split[i][j] for the product of factors i..=j.
    let mut cost = vec![vec![0u64; n]; n];
    let mut split = vec![vec![0usize; n]; n];
    for length in 2..=n {
        for i in 0..=n - length {
            let j = i + length - 1;
            let candidates = (i..j).map(|m| {
                // Rows are selected, not multiplied.
                let picked =
                    (m == i && constant(&factors[i])) || (m + 1 == j && constant(&factors[j]));
                let work = if picked {
                    0
                } else {
                    dims[i] * dims[m + 1] * dims[j + 1]
                };
                (cost[i][m] + cost[m + 1][j] + work, m)
            });
            if let Some((best, m)) = candidates.min() {
                cost[i][j] = best;
                split[i][j] = m;
            }
        }
    }
    fn build(split: &[Vec<usize>], i: usize, j: usize) -> Bracketed {
        if i >= j {
            return Bracketed::Factor(i);
        }
        let m = split[i][j];
        Bracketed::Pair(
            Box::new(build(split, i, m)),
            Box::new(build(split, m + 1, j)),
        )
    }
    build(&split, 0, n.saturating_sub(1))
}
