//! Misprints of the thesis, each with the correct form: the correct form holds and the printed form fails. Points are random and
//! solve nothing. The reference is the variation of the unreduced action, a directional derivative, or an invariance of a rotation
//! or a bracket. `docs/errata.md` lists the errata. The thesis's Lagrangian and momenta are -h times those of clebsch.

mod bodies;
mod ellipsoids;
mod quaternions;
mod steps;
mod waters;

use clebsch_oracle::oracle::action::{DiscreteAction, rotations, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

type Matrix = Square<f64, 3>;
type Vector = [f64; 3];

/// A hundred rounding errors of numbers of order one.
const ROUNDING: f64 = 1e-12;
/// The error of a wrong printed form is of order one.
const VISIBLE: f64 = 1e-3;
/// Number of draws. The correct form must hold, and the printed form must fail, at every draw.
const DRAWS: u64 = 50;

fn inner(a: &Matrix, b: &Matrix) -> f64 {
    (a.transpose() * *b).trace()
}

/// `(A - Aᵀ)/2`, the convention of the thesis.
fn skew(a: &Matrix) -> Matrix {
    (*a - a.transpose()).scaled(0.5)
}

fn sym(a: &Matrix) -> Matrix {
    (*a + a.transpose()).scaled(0.5)
}

fn bracket(a: &Matrix, b: &Matrix) -> Matrix {
    *a * *b - *b * *a
}

/// `Ad*_g M = gᵀ M g⁻ᵀ` (2.88).
fn ad_star(g: &Matrix, m: &Matrix) -> Matrix {
    g.transpose() * *m * g.transpose().inverse()
}

fn size(a: &Matrix) -> f64 {
    a.0.iter().flatten().fold(0.0, |m, x| worse(m, x.abs()))
}

fn length(v: &Vector) -> f64 {
    v.iter().fold(0.0, |m, x| worse(m, x.abs()))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    from_fn(|i| a[i] - b[i])
}

/// Compares the errors of the printed and the correct form at every draw.
fn judge(what: &str, off: impl FnMut(&mut Source) -> (f64, f64)) {
    judge_within(ROUNDING, what, off);
}

/// Like `judge`, with a larger tolerance for correct forms computed by finite differences.
fn judge_within(tolerance: f64, what: &str, mut off: impl FnMut(&mut Source) -> (f64, f64)) {
    for seed in 1..=DRAWS {
        let (printed, right) = off(&mut Source::seeded(seed));
        assert!(
            right < tolerance,
            "{what}: the right form is off by {right:e}"
        );
        assert!(
            printed > VISIBLE,
            "{what}: the printed form is off by {printed:e} only"
        );
    }
}

fn id() -> Matrix {
    Square::identity()
}

/// The oracle's residual at the middle of three nodes.
fn residual<const G: usize>(
    action: &impl DiscreteAction<3, G>,
    nodes: &[[Matrix; G]; 3],
) -> Vec<f64> {
    stationarity(action, nodes, &rotations()).derivative
}
