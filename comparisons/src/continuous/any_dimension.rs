//! The free rigid body in N dimensions (Arnold 1966, Manakov 1976): with second moments C = U diag(j) U^T and body velocity W, M =
//! W C + C W and M' = M W - W M, Lambda' = Lambda W. Takes the principal moments j; gives 2 N^2 equations in principal axes, y =
//! (attitude, body momentum), both row-major.

use super::Motion;
use crate::handwritten::body_n::{Square, identity, product, transposed, transposed_product};

/// The body in principal axes.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyN<const N: usize> {
    /// 1 / (j_a + j_b).
    reciprocal: Square<N>,
}

impl<const N: usize> BodyN<N> {
    /// A body with these principal second moments, in which no two sum to zero.
    pub fn new(moments: &[f64; N]) -> Self {
        Self {
            reciprocal: moments.map(|a| moments.map(|b| 1.0 / (a + b))),
        }
    }

    fn velocity(&self, momentum: &Square<N>) -> Square<N> {
        let mut w = *momentum;
        for (row, factors) in w.iter_mut().zip(&self.reciprocal) {
            for (x, factor) in row.iter_mut().zip(factors) {
                *x *= factor;
            }
        }
        w
    }
}

/// Attitude and body momentum of a state; `SIZE` is twice the square of `N`.
pub fn matrices<const N: usize, const SIZE: usize>(y: &[f64; SIZE]) -> [Square<N>; 2] {
    let mut both = [[[0.0; N]; N]; 2];
    for (place, x) in both.as_flattened_mut().as_flattened_mut().iter_mut().zip(y) {
        *place = *x;
    }
    both
}

/// The state of an attitude and a body momentum.
pub fn state<const N: usize, const SIZE: usize>(both: &[Square<N>; 2]) -> [f64; SIZE] {
    let mut y = [0.0; SIZE];
    for (place, x) in y.iter_mut().zip(both.as_flattened().as_flattened()) {
        *place = *x;
    }
    y
}

impl<const N: usize, const SIZE: usize> Motion<SIZE> for BodyN<N> {
    fn rate(&self, y: &[f64; SIZE], out: &mut [f64; SIZE]) {
        let [attitude, m] = matrices::<N, SIZE>(y);
        let w = self.velocity(&m);
        let (mw, wm) = (product(&m, &w), product(&w, &m));
        let mut change = mw;
        for (row, other) in change.iter_mut().zip(&wm) {
            for (x, y) in row.iter_mut().zip(other) {
                *x -= y;
            }
        }
        *out = state(&[product(&attitude, &w), change]);
    }
}

/// Principal moments and axes of a symmetric matrix, with the axes as columns, by cyclic Jacobi rotations. `None` if the matrix is
/// not symmetric or not finite.
pub fn principal<const N: usize>(c: &Square<N>) -> Option<([f64; N], Square<N>)> {
    let scale = c.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let entry = |a: &Square<N>, i: usize, k: usize| a.get(i).and_then(|r| r.get(k)).copied();
    let symmetric = (0..N).all(|i| {
        (0..N).all(|k| match (entry(c, i, k), entry(c, k, i)) {
            (Some(x), Some(y)) => (x - y).abs() <= 16.0 * f64::EPSILON * scale,
            _ => false,
        })
    });
    if !symmetric || !scale.is_finite() {
        return None;
    }
    let (mut axes, mut here) = (identity::<N>(), *c);
    // Convergence is quadratic; ten sweeps are twice the number that eight dimensions need.
    for _ in 0..10 {
        for i in 0..N {
            for k in i + 1..N {
                let off = entry(&here, i, k)?;
                if off.abs() <= 1e-17 * scale {
                    continue;
                }
                // The smaller of the two angles that annihilate the entry.
                let ratio = (entry(&here, k, k)? - entry(&here, i, i)?) / (2.0 * off);
                let tan = 1.0_f64.copysign(ratio) / (ratio.abs() + ratio.hypot(1.0));
                let cos = 1.0 / tan.hypot(1.0);
                let sin = cos * tan;
                let mut turn = identity::<N>();
                for (row, column, x) in [(i, i, cos), (k, k, cos), (i, k, sin), (k, i, -sin)] {
                    *turn.get_mut(row)?.get_mut(column)? = x;
                }
                axes = product(&axes, &turn);
                // Recomputed from the given matrix, so that sweeps do not accumulate rounding.
                here = transposed_product(&axes, &product(c, &axes));
            }
        }
    }
    let moments = std::array::from_fn(|i| entry(&here, i, i).unwrap_or(f64::NAN));
    Some((moments, axes))
}

/// A^T B A.
pub fn seen_from<const N: usize>(b: &Square<N>, a: &Square<N>) -> Square<N> {
    product(&transposed(a), &product(b, a))
}
