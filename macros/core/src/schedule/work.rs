//! How much a program computes: sums and products of numbers, counted. If two programs are equivalent, the one with
//! less work is emitted.

use super::{Bracketed, Program, associate};
use crate::expr::shape::{Dim, Shape};
use crate::expr::{Expr, Node};

/// The operations of all temporaries and results.
pub fn work(program: &Program) -> u64 {
    let temporaries = program.temporaries.iter().map(|(_, value)| value);
    temporaries.chain(&program.results).map(of).sum()
}

fn length(d: Dim) -> u64 {
    match d {
        Dim::Fixed(n) => u64::from(n),
        Dim::Named(_) => 4,
    }
}

fn entries(shape: Shape) -> u64 {
    length(shape.rows) * length(shape.cols)
}

/// The assumed number of operations of a functional, since the true number is unknown. It is larger than the work
/// around a call, so that the program with fewer calls is selected.
const CALLED: u64 = 1_000;

fn of(e: &Expr) -> u64 {
    let own = match e.node() {
        Node::Sum(terms) => entries(e.shape()) * (terms.len() as u64).saturating_sub(1),
        Node::Product(factors) => product(factors),
        Node::Quotient(..) | Node::Power(..) | Node::Call(..) | Node::Part(..) => {
            entries(e.shape())
        }
        Node::Trace(a) => length(a.shape().rows).saturating_sub(1),
        Node::Dot(a, _) => 2 * entries(a.shape()) - 1,
        Node::Cross(..) => 9,
        Node::Vee(_) => 6,
        Node::Inverse(a) | Node::Det(a) | Node::Adjugate(a) => {
            entries(a.shape()) * length(a.shape().rows)
        }
        Node::Number(_)
        | Node::Constant(_)
        | Node::Letter(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Neg(_)
        | Node::Transpose(_)
        | Node::Hat(_)
        | Node::Map(..) => 0,
        Node::Given(_) | Node::PullBack(..) => CALLED,
    };
    own + e.children().into_iter().map(of).sum::<u64>()
}

/// The cost of the scalars, of scaling the matrix, and of the matrix products in their bracketing.
fn product(factors: &[Expr]) -> u64 {
    let (numbers, matrices): (Vec<Expr>, Vec<Expr>) =
        factors.iter().cloned().partition(|f| f.shape().is_scalar());
    let Some(last) = matrices.last() else {
        return (numbers.len() as u64).saturating_sub(1);
    };
    let shape = Shape {
        rows: matrices[0].shape().rows,
        cols: last.shape().cols,
    };
    let times = match numbers.len() as u64 {
        0 => 0,
        n => n - 1 + entries(shape),
    };
    times + chain(&associate(&matrices), &matrices).0
}

/// The operations of a bracketed product, and its shape.
fn chain(tree: &Bracketed, factors: &[Expr]) -> (u64, Shape) {
    let factor = |tree: &Bracketed| match tree {
        Bracketed::Factor(i) => factors.get(*i),
        Bracketed::Pair(..) => None,
    };
    match tree {
        Bracketed::Factor(_) => (0, factor(tree).map_or(Shape::SCALAR, Expr::shape)),
        Bracketed::Pair(a, b) => {
            let ((before, left), (after, right)) = (chain(a, factors), chain(b, factors));
            let shape = Shape {
                rows: left.rows,
                cols: right.cols,
            };
            let is = |test: fn(&Node) -> bool| {
                [a, b]
                    .iter()
                    .any(|t| factor(t).is_some_and(|f| test(f.node())))
            };
            // A vector product with every column or row, a copy, or a matrix product.
            let own = if is(|n| matches!(n, Node::Hat(_))) {
                3
            } else if is(|n| matches!(n, Node::Identity(_) | Node::Inclusion(..))) {
                0
            } else {
                2 * length(left.cols) - 1
            };
            (before + after + own * entries(shape), shape)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr;
    use crate::expr::shape::Structure;
    use crate::expr::symbol::{Role, Symbols};

    #[test]
    fn a_rotation_less_is_less_work() {
        let mut symbols = Symbols::default();
        let three = Shape::square(Dim::Fixed(3));
        let mut letter = |name: &str, shape| {
            let id = symbols.add(name, shape, Structure::General, Role::Derived);
            expr::here(&symbols, id)
        };
        let (a, b) = (letter("A", three), letter("B", three));
        let v = letter("v", Shape::vector(Dim::Fixed(3)));
        let counted = |e: Expr| work(&super::super::program(&symbols, &[e], "t"));
        let hat = expr::hat(v.clone());
        assert_eq!(counted(expr::mul(a.clone(), b.clone())), 45);
        assert_eq!(counted(expr::mul(a.clone(), hat.clone())), 27);
        assert_eq!(counted(expr::mul(a.clone(), v.clone())), 15);
        // The image is computed once.
        let image = expr::mul(a, v);
        assert_eq!(counted(expr::dot(image.clone(), image)), 15 + 5);
    }
}
