//! The thesis's iteration for coupled bodies (appendix A.4, corrected): each body in turn solves its own Moser-Veselov equation
//! with the coupling to the other held fixed. Gives both rotations of one step, and the contraction rate of the iteration, which
//! does not depend on h.

use super::Unsolvable;
use super::attitude::{Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross};
use super::coupled_bodies::Pair;
use super::one_sided_top::edge_rotation;
use super::principal_axes::PrincipalAxes;
use super::principal_root::Quartic;

/// The rotations of one step from the fixed-point iteration.
#[derive(Clone, Debug)]
pub struct FixedPoint {
    /// Rotations of both bodies over the step, each in its body axes.
    pub turns: [Matrix; 2],
    /// Sizes of the successive changes of the rotations.
    pub changes: Vec<f64>,
}

/// Changes below this are rounding, and do not determine the rate.
const ROUNDING: f64 = 1e-13;

impl FixedPoint {
    /// Iterates until the rotations no longer change.
    pub fn solve(
        pair: &Pair,
        attitudes: &[Quaternion; 2],
        body_momenta: &[Vector; 2],
        h: f64,
    ) -> Result<FixedPoint, Unsolvable> {
        let axes = [
            PrincipalAxes::new(&pair.poinsots[0])?,
            PrincipalAxes::new(&pair.poinsots[1])?,
        ];
        let quartics = [0, 1].map(|i: usize| Quartic::new(&axes[i].moments));
        let relative = attitudes[0].conjugate().times(&attitudes[1]).normalised();
        let r = relative.matrix();
        let mut found = FixedPoint {
            turns: [Quaternion::IDENTITY.matrix(); 2],
            changes: Vec::new(),
        };
        for _ in 0..2000 {
            let before = found.turns;
            for i in 0..2 {
                let other = 1 - i;
                let moved = add_scaled(
                    &apply(&found.turns[other], &pair.arms[other]),
                    -1.0,
                    &pair.arms[other],
                );
                let seen = if i == 0 {
                    apply(&r, &moved)
                } else {
                    apply_transposed(&r, &moved)
                };
                // Om J - J Om^T = hat(h mu + eps d x v).
                let torque = cross(&pair.arms[i], &seen);
                let n = add_scaled(&body_momenta[i], pair.eps / h, &torque);
                let turn = edge_rotation(&axes[i], &quartics[i], &axes[i].enter(&n), h)?;
                found.turns[i] = in_user_axes(&axes[i], &turn.matrix());
            }
            let change = (0..18)
                .map(|n| {
                    let (i, r, c) = (n / 9, n % 9 / 3, n % 3);
                    (found.turns[i][r][c] - before[i][r][c]).abs()
                })
                // Written so that NaN propagates.
                .fold(0.0_f64, |a, b| if b <= a || a.is_nan() { a } else { b });
            found.changes.push(change);
            if change <= 4.0 * f64::EPSILON {
                return Ok(found);
            }
        }
        Err(Unsolvable)
    }

    /// Contraction per sweep: the last ratio of changes above rounding.
    pub fn rate(&self) -> f64 {
        let clear: Vec<f64> = self
            .changes
            .iter()
            .copied()
            .filter(|c| *c > ROUNDING)
            .collect();
        match clear.as_slice() {
            [.., before, last] => last / before,
            _ => f64::NAN,
        }
    }
}

/// The same rotation of the body in the user's axes.
fn in_user_axes(axes: &PrincipalAxes, turn: &Matrix) -> Matrix {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .map(|e| axes.leave(&apply(turn, &axes.enter(&e))));
    [0, 1, 2].map(|i| [columns[0][i], columns[1][i], columns[2][i]])
}
