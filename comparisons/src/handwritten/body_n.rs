//! Free body in n dimensions: A - A^T = h M with A = Om J, J diagonal, solved for S = sym A, extrapolated from previous values of
//! S. Takes the diagonal of J, attitude, body momentum (skew) and h; gives attitude and momenta at the nodes. The state is the
//! attitude and the constant spatial momentum. Beyond the range of the fast iteration, uses Newton's method on the group
//! (Lie-Newton).

// Index loops keep the shape of the formulas.
#![allow(clippy::needless_range_loop)]

use super::Unsolvable;

/// Row-major square matrix.
pub type Square<const N: usize> = [[f64; N]; N];

/// A b.
#[inline(always)]
pub fn product<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let mut out = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            let factor = a[i][k];
            for j in 0..N {
                out[i][j] += factor * b[k][j];
            }
        }
    }
    out
}

/// A^T B.
#[inline(always)]
pub fn transposed_product<const N: usize>(a: &Square<N>, b: &Square<N>) -> Square<N> {
    let mut out = [[0.0; N]; N];
    for k in 0..N {
        for i in 0..N {
            let factor = a[k][i];
            for j in 0..N {
                out[i][j] += factor * b[k][j];
            }
        }
    }
    out
}

/// A^T.
#[inline(always)]
pub fn transposed<const N: usize>(a: &Square<N>) -> Square<N> {
    let mut out = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            out[j][i] = a[i][j];
        }
    }
    out
}

/// The identity.
pub fn identity<const N: usize>() -> Square<N> {
    let mut out = [[0.0; N]; N];
    for (i, row) in out.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    out
}

/// One step of Newton's iteration for the nearest orthogonal matrix, (3 - R R^T) R / 2.
#[inline(always)]
fn reorthonormalised<const N: usize>(r: &Square<N>) -> Square<N> {
    let mut gram = product(r, &transposed(r));
    for (i, row) in gram.iter_mut().enumerate() {
        for x in row.iter_mut() {
            *x *= -0.5;
        }
        row[i] += 1.5;
    }
    product(&gram, r)
}

/// A moving free body in N dimensions.
#[derive(Clone, Copy, Debug)]
pub struct BodyN<const N: usize> {
    attitude: Square<N>,
    /// Body momentum times h at the current node.
    v: Square<N>,
    /// Spatial momentum times h.
    spatial: Square<N>,
    /// Symmetric parts of Om J of the last four steps, newest first.
    past: [Square<N>; 4],
    known: u32,
    j: [f64; N],
    /// 1 / (j_a + j_b).
    preconditioner: Square<N>,
    reciprocal: [f64; N],
    h: f64,
}

/// Iterations of the fast method before Lie-Newton takes over; where it is useful, each gains a decimal digit.
const MOST_SWEEPS: usize = 24;

impl<const N: usize> BodyN<N> {
    /// Starts a trajectory with the body momentum of node 0. Needs positive entries of J.
    pub fn start(
        j: &[f64; N],
        attitude: &Square<N>,
        body_momentum: &Square<N>,
        h: f64,
    ) -> Result<BodyN<N>, Unsolvable> {
        if !j.iter().all(|x| *x > 0.0 && x.is_finite()) {
            return Err(Unsolvable);
        }
        let v = body_momentum.map(|row| row.map(|m| h * m));
        let mut preconditioner = [[0.0; N]; N];
        for a in 0..N {
            for b in 0..N {
                preconditioner[a][b] = 1.0 / (j[a] + j[b]);
            }
        }
        let spatial = product(&product(attitude, &v), &transposed(attitude));
        Ok(BodyN {
            attitude: *attitude,
            v,
            spatial,
            past: [[[0.0; N]; N]; 4],
            known: 0,
            j: *j,
            preconditioner,
            reciprocal: j.map(|x| 1.0 / x),
            h,
        })
    }

    /// The initial guess: the cubic through the last four steps, or S = J.
    #[inline(always)]
    fn guess(&self) -> Square<N> {
        let mut s = [[0.0; N]; N];
        if self.known < 4 {
            for i in 0..N {
                s[i][i] = self.j[i];
            }
            return s;
        }
        let [a, b, c, d] = &self.past;
        for i in 0..N {
            for k in 0..N {
                s[i][k] = 4.0 * (a[i][k] + c[i][k]) - (6.0 * b[i][k] + d[i][k]);
            }
        }
        s
    }

    /// J^2 - A^T A for A = S + V/2, which vanishes if Om = A J^-1 is orthogonal; returns A, the defect and its largest entry.
    #[inline(always)]
    fn defect(&self, s: &Square<N>) -> (Square<N>, Square<N>, f64) {
        let mut a = *s;
        for i in 0..N {
            for k in 0..N {
                a[i][k] += 0.5 * self.v[i][k];
            }
        }
        let mut left = transposed_product(&a, &a);
        let mut size = 0.0_f64;
        for i in 0..N {
            for k in 0..N {
                let square = if i == k { self.j[i] * self.j[i] } else { 0.0 };
                left[i][k] = square - left[i][k];
                size = size.max(left[i][k].abs());
            }
        }
        (a, left, size)
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let scale = self.j.iter().fold(0.0_f64, |m, x| m.max(x * x));
        let mut s = self.guess();
        let mut previous = f64::INFINITY;
        let mut solved = None;
        for _ in 0..MOST_SWEEPS {
            let (a, defect, size) = self.defect(&s);
            // Converged if only rounding is left: the defect is a few rounding errors of the terms, or stops decreasing near that
            // level.
            if size <= 4.0 * f64::EPSILON * scale
                || (size <= 64.0 * f64::EPSILON * scale && size >= 0.5 * previous)
            {
                solved = Some(a);
                break;
            }
            previous = size;
            for i in 0..N {
                for k in 0..N {
                    s[i][k] += defect[i][k] * self.preconditioner[i][k];
                }
            }
        }
        let a = match solved {
            Some(a) => a,
            None => {
                let a = self.lie_newton()?;
                for i in 0..N {
                    for k in 0..N {
                        s[i][k] = 0.5 * (a[i][k] + a[k][i]);
                    }
                }
                a
            }
        };
        let mut turn = a;
        for row in &mut turn {
            for (x, r) in row.iter_mut().zip(self.reciprocal) {
                *x *= r;
            }
        }
        self.attitude = reorthonormalised(&product(&self.attitude, &turn));
        // Momentum from the attitude: the iteration Om^T M Om would accumulate rounding.
        self.v = transposed_product(&self.attitude, &product(&self.spatial, &self.attitude));
        self.past = [s, self.past[0], self.past[1], self.past[2]];
        self.known += u32::from(self.known < 4);
        Ok(())
    }

    /// A = Om J by Newton on the group: Om <- cay(X) Om with A^T X + X A = -(A - A^T - V), X skew.
    #[cold]
    #[inline(never)]
    fn lie_newton(&self) -> Result<Square<N>, Unsolvable> {
        let pairs: Vec<(usize, usize)> = (0..N)
            .flat_map(|i| (i + 1..N).map(move |k| (i, k)))
            .collect();
        let mut turn = identity::<N>();
        for iteration in 0..50 {
            let mut a = turn;
            for row in &mut a {
                for (x, j) in row.iter_mut().zip(self.j) {
                    *x *= j;
                }
            }
            let f = |i: usize, k: usize| a[i][k] - a[k][i] - self.v[i][k];
            let size = pairs
                .iter()
                .map(|(i, k)| f(*i, *k).abs())
                // Written so that NaN propagates.
                .fold(0.0_f64, |a, b| if b <= a || a.is_nan() { a } else { b });
            let scale = self.j.iter().fold(0.0_f64, |m, x| m.max(*x));
            if size <= 8.0 * f64::EPSILON * scale {
                return Ok(a);
            }
            if !size.is_finite() {
                return Err(Unsolvable);
            }
            let count = pairs.len();
            let mut rows: Vec<Vec<f64>> = Vec::with_capacity(count);
            for (i, k) in &pairs {
                let mut row = vec![0.0; count + 1];
                for (column, (p, q)) in pairs.iter().enumerate() {
                    // X = e_p e_q^T - e_q e_p^T in (A^T X + X A)_ik.
                    let left = |p: usize, q: usize| if *k == q { a[p][*i] } else { 0.0 };
                    let right = |p: usize, q: usize| if *i == p { a[q][*k] } else { 0.0 };
                    row[column] = left(*p, *q) - left(*q, *p) + right(*p, *q) - right(*q, *p);
                }
                row[count] = -f(*i, *k);
                rows.push(row);
            }
            let x = eliminated(rows).ok_or(Unsolvable)?;
            let mut half = [[0.0; N]; N];
            for (value, (i, k)) in x.iter().zip(&pairs) {
                half[*i][*k] = 0.5 * value;
                half[*k][*i] = -0.5 * value;
            }
            turn = product(&cayley(&half).ok_or(Unsolvable)?, &turn);
            if iteration > 3 {
                turn = reorthonormalised(&turn);
            }
        }
        Err(Unsolvable)
    }

    /// Attitude at the current node.
    pub fn attitude(&self) -> Square<N> {
        self.attitude
    }

    /// Body momentum M_k, skew.
    pub fn body_momentum(&self) -> Square<N> {
        self.v.map(|row| row.map(|x| x / self.h))
    }

    /// Spatial momentum, constant since node 0.
    pub fn spatial_momentum(&self) -> Square<N> {
        self.spatial.map(|row| row.map(|x| x / self.h))
    }

    /// Energy: sum over a < b of M_ab^2 / (2 (j_a + j_b)).
    pub fn energy(&self) -> f64 {
        let m = self.body_momentum();
        let mut sum = 0.0;
        for i in 0..N {
            for k in i + 1..N {
                sum += 0.5 * m[i][k] * m[i][k] * self.preconditioner[i][k];
            }
        }
        sum
    }
}

/// The Cayley map (Id - X)^-1 (Id + X), where X is half the algebra element.
fn cayley<const N: usize>(half: &Square<N>) -> Option<Square<N>> {
    let one = identity::<N>();
    let mut columns = [[0.0; N]; N];
    for c in 0..N {
        let rows = (0..N)
            .map(|i| {
                let mut row: Vec<f64> = (0..N).map(|k| one[i][k] - half[i][k]).collect();
                row.push(one[i][c] + half[i][c]);
                row
            })
            .collect();
        for (slot, x) in columns[c].iter_mut().zip(eliminated(rows)?) {
            *slot = x;
        }
    }
    Some(transposed(&columns))
}

/// Solves a linear system whose rows end with the right-hand side, with partial pivoting.
fn eliminated(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for c in 0..n {
        let pivot = (c..n).max_by(|a, b| rows[*a][c].abs().total_cmp(&rows[*b][c].abs()))?;
        rows.swap(c, pivot);
        if rows[c][c] == 0.0 {
            return None;
        }
        for r in c + 1..n {
            let factor = rows[r][c] / rows[c][c];
            for k in c..=n {
                let above = rows[c][k];
                rows[r][k] -= factor * above;
            }
        }
    }
    let mut x = vec![0.0; n];
    for r in (0..n).rev() {
        let known: f64 = (r + 1..n).map(|k| rows[r][k] * x[k]).sum();
        x[r] = (rows[r][n] - known) / rows[r][r];
    }
    Some(x)
}
