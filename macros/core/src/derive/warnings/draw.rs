//! Real values of letters by their structure, from a fixed seed, as a user would give them: symmetric matrices are
//! positive definite and scalars positive. Takes symbols; gives assignments for [`interpret`](crate::interpret).

use crate::expr::shape::{Dim, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::interpret::Assignment;

/// A source of numbers that are equal in every run (SplitMix64).
pub(super) struct Draw(u64);

impl Draw {
    /// A source with this seed.
    pub(super) fn new(seed: u64) -> Draw {
        Draw(seed)
    }

    /// A number in [-1, 1).
    pub(super) fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
        (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A positive number between 1/e and e.
    fn positive(&mut self) -> f64 {
        self.number().exp()
    }
}

/// The size of a dimension here, which is its smallest.
pub(super) fn size(symbols: &Symbols, d: Dim) -> usize {
    symbols.sizes(d).0
}

/// No values yet; named dimensions have their smallest size.
pub(super) fn nothing(symbols: &Symbols) -> Assignment {
    let sizes = (0..symbols.dim_count()).map(|i| size(symbols, Dim::Named(i)));
    Assignment::new().sized(sizes.collect())
}

/// A value of a letter as a user would give it: positive scalars, positive definite symmetric matrices, elements of
/// groups. Vectors, skew matrices and matrices without structure may couple other motions; they are multiplied by
/// `scale`. The spread of scalars increases as `scale` decreases.
pub(super) fn natural(symbols: &Symbols, id: SymbolId, scale: f64, draw: &mut Draw) -> Vec<f64> {
    let symbol = symbols.get(id);
    let (n, m) = (
        size(symbols, symbol.shape.rows),
        size(symbols, symbol.shape.cols),
    );
    if symbol.shape.is_scalar() {
        return vec![draw.positive().powf(1.0 - scale.log10())];
    }
    let free = |draw: &mut Draw, count: usize| -> Vec<f64> {
        (0..count).map(|_| scale * draw.number()).collect()
    };
    match symbol.structure {
        Structure::Symmetric => positive_definite(n, draw),
        Structure::Diagonal => {
            let mut d = vec![0.0; n * n];
            d.iter_mut()
                .step_by(n + 1)
                .for_each(|x| *x = draw.positive());
            d
        }
        Structure::Skew => skew(n, scale, draw),
        Structure::General | Structure::Invertible if symbol.shape.is_square() => {
            let rest = free(draw, n * n);
            let base = positive_definite(n, draw);
            base.iter()
                .zip(rest)
                .map(|(a, b)| scale * a + 0.1 * b)
                .collect()
        }
        Structure::General | Structure::Invertible => free(draw, n * m),
        Structure::Orthogonal => rotation(n, draw),
        Structure::UnitQuaternion => {
            let q: Vec<f64> = (0..4).map(|_| draw.number()).collect();
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
            let [w, x, y, z] = [0, 1, 2, 3].map(|i| q[i] / norm);
            vec![w, -x, -y, -z, x, w, -z, y, y, z, w, -x, z, -y, x, w]
        }
        Structure::RigidMotion => {
            let last = n.saturating_sub(1);
            let r = rotation(last, draw);
            let x = free(draw, last);
            let entry = |i: usize, j: usize| match (i == last, j == last) {
                (true, corner) => f64::from(u8::from(corner)),
                (false, true) => x[i],
                (false, false) => r[i * last + j],
            };
            (0..n * n).map(|k| entry(k / n, k % n)).collect()
        }
    }
}

fn skew(n: usize, scale: f64, draw: &mut Draw) -> Vec<f64> {
    let mut a = vec![0.0; n * n];
    for i in 0..n {
        for j in i + 1..n {
            let x = scale * draw.number();
            (a[i * n + j], a[j * n + i]) = (x, -x);
        }
    }
    a
}

/// `A A^T + Id/2`.
fn positive_definite(n: usize, draw: &mut Draw) -> Vec<f64> {
    let a: Vec<f64> = (0..n * n).map(|_| draw.number()).collect();
    let entry = |i: usize, j: usize| {
        let half = if i == j { 0.5 } else { 0.0 };
        (0..n).map(|k| a[i * n + k] * a[j * n + k]).sum::<f64>() + half
    };
    (0..n * n).map(|k| entry(k / n, k % n)).collect()
}

/// A product of one rotation in every coordinate plane.
fn rotation(n: usize, draw: &mut Draw) -> Vec<f64> {
    let mut r: Vec<f64> = (0..n * n)
        .map(|k| f64::from(u8::from(k / n == k % n)))
        .collect();
    for i in 0..n {
        for j in i + 1..n {
            let (sin, cos) = (3.0 * draw.number()).sin_cos();
            for row in 0..n {
                let (a, b) = (r[row * n + i], r[row * n + j]);
                (r[row * n + i], r[row * n + j]) = (cos * a - sin * b, sin * a + cos * b);
            }
        }
    }
    r
}

#[cfg(test)]
mod tests {
    use super::{Draw, natural};
    use crate::expr::shape::{Dim, Shape, Structure};
    use crate::expr::symbol::{Role, Symbols};

    /// Entry by entry, whether `A^T A` is the identity up to the rounding of some products of numbers of size 1.
    fn is_orthogonal(n: usize, a: &[f64]) -> bool {
        let product = |i: usize, j: usize| (0..n).map(|k| a[k * n + i] * a[k * n + j]).sum::<f64>();
        let one = |i, j| f64::from(u8::from(i == j));
        (0..n * n).all(|k| (product(k / n, k % n) - one(k / n, k % n)).abs() < 1e-14)
    }

    #[test]
    fn values_have_the_structure_of_their_letter() {
        let mut s = Symbols::default();
        let mut draw = Draw::new(7);
        let mut drawn = |n: u32, structure: Structure| {
            let shape = Shape::square(Dim::Fixed(n));
            let id = s.add(
                &format!("{structure:?}{n}"),
                shape,
                structure,
                Role::Parameter,
            );
            natural(&s, id, 0.25, &mut draw)
        };
        for n in [2, 3, 4] {
            let size = n as usize;
            let rotation = drawn(n, Structure::Orthogonal);
            assert!(is_orthogonal(size, &rotation));
            // No axis is fixed.
            assert!((0..size).all(|i| rotation[i * size + i].abs() < 1.0));
            let skew = drawn(n, Structure::Skew);
            let symmetric = drawn(n, Structure::Symmetric);
            for i in 0..size {
                for j in 0..size {
                    let (here, there) = (i * size + j, j * size + i);
                    assert!(skew[here] == -skew[there] && (i == j) == (skew[here] == 0.0));
                    assert!(symmetric[here] == symmetric[there]);
                }
            }
        }
        let q = drawn(4, Structure::UnitQuaternion);
        assert!(is_orthogonal(4, &q));
        assert!([q[5], q[10], q[15]] == [q[0]; 3] && q[4] == -q[1] && q[14] == -q[11]);
        let shape = Shape::vector(Dim::Fixed(5));
        let id = s.add("v", shape, Structure::General, Role::Parameter);
        let v = natural(&s, id, 0.25, &mut draw);
        assert!(v.len() == 5 && v.iter().all(|x| *x != 0.0 && x.abs() <= 0.25));
    }
}
