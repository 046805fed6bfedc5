//! The solution by the ordered Schur form of the Hamiltonian matrix, for plain double precision.
//! Takes a left factor and `h N`; gives the principal solution to some hundreds of roundings.
//!
//! The complex Schur form is found by shifted QR with plane rotations (Golub and Van Loan, Matrix
//! Computations, 7.5 and 7.6), with at most [`SWEEPS`] sweeps per eigenvalue. It is then ordered so that
//! the right half plane comes first. The real Schur form of nalgebra does not converge on these
//! matrices, whose eigenvalues come in pairs of opposite sign.

use super::factor::{LARGEST, LeftFactor};
use super::sign::{finish, hamiltonian};
use super::{Refusal, Unsolved};
use crate::Real;
use crate::groups::Orthogonal;
use crate::solvers::Method;
use nalgebra::{Complex, SMatrix};

/// The number of rows of the largest Hamiltonian matrix.
const ROWS: usize = 2 * LARGEST;

/// The largest number of sweeps for one eigenvalue; two or three usually suffice.
const SWEEPS: usize = 40;

type Number = Complex<f64>;
type Table = SMatrix<Number, ROWS, ROWS>;

const ZERO: Number = Number::new(0.0, 0.0);

/// The plane rotation `[[c, s], [-conj(s), c]]` that takes `(a, b)` to `(r, 0)`.
fn rotation(a: Number, b: Number) -> (f64, Number) {
    let length = a.norm().hypot(b.norm());
    if length == 0.0 {
        return (1.0, ZERO);
    }
    if a.norm() == 0.0 {
        return (0.0, b.conj() / b.norm());
    }
    (a.norm() / length, a / a.norm() * b.conj() / length)
}

/// A matrix during reduction to triangular form, and the accumulated unitary matrix.
struct Schur {
    t: Table,
    q: Table,
    size: usize,
}

impl Schur {
    /// Rotates rows `p` and `p + 1`, from column `from` on.
    fn rows(&mut self, p: usize, (c, s): (f64, Number), from: usize) {
        for j in from..self.size {
            let (x, y) = (self.t[(p, j)], self.t[(p + 1, j)]);
            self.t[(p, j)] = x * c + s * y;
            self.t[(p + 1, j)] = y * c - s.conj() * x;
        }
    }

    /// Rotates columns `p` and `p + 1` by the inverse, up to row `to`, and records it.
    fn columns(&mut self, p: usize, (c, s): (f64, Number), to: usize) {
        let turn = |m: &mut Table, i: usize| {
            let (x, y) = (m[(i, p)], m[(i, p + 1)]);
            m[(i, p)] = x * c + s.conj() * y;
            m[(i, p + 1)] = y * c - s * x;
        };
        for i in 0..to {
            turn(&mut self.t, i);
        }
        for i in 0..self.size {
            turn(&mut self.q, i);
        }
    }

    /// Reduces to Hessenberg form.
    fn hessenberg(&mut self) {
        for k in 0..self.size.saturating_sub(2) {
            for i in (k + 2..self.size).rev() {
                let turn = rotation(self.t[(i - 1, k)], self.t[(i, k)]);
                self.rows(i - 1, turn, 0);
                self.columns(i - 1, turn, self.size);
                self.t[(i, k)] = ZERO;
            }
        }
    }

    /// The eigenvalue of the 2 x 2 block that ends at `last` nearer to its last entry (Wilkinson).
    fn shift(&self, last: usize) -> Number {
        let (a, b) = (self.t[(last - 1, last - 1)], self.t[(last - 1, last)]);
        let (c, d) = (self.t[(last, last - 1)], self.t[(last, last)]);
        let half = (a - d) * 0.5;
        let root = (half * half + b * c).sqrt();
        let (one, other) = (d + half + root, d + half - root);
        match (one - d).norm() < (other - d).norm() {
            true => one,
            false => other,
        }
    }

    /// Reduces to triangular form; returns false if an eigenvalue needs too many sweeps.
    fn triangular(&mut self) -> bool {
        let mut last = self.size - 1;
        let mut sweeps = 0;
        while last > 0 {
            // The unreduced block that ends at `last`.
            let mut first = last;
            while first > 0 {
                let near = self.t[(first, first)].norm() + self.t[(first - 1, first - 1)].norm();
                if self.t[(first, first - 1)].norm() <= f64::EPSILON * near {
                    self.t[(first, first - 1)] = ZERO;
                    break;
                }
                first -= 1;
            }
            if first == last {
                last -= 1;
                sweeps = 0;
                continue;
            }
            sweeps += 1;
            if sweeps > SWEEPS {
                return false;
            }
            // An occasional arbitrary shift prevents cycles.
            let shift = match sweeps % 10 {
                0 => self.t[(last, last)] + self.t[(last, last - 1)].norm(),
                _ => self.shift(last),
            };
            for i in first..=last {
                self.t[(i, i)] -= shift;
            }
            let mut turns = [(1.0, ZERO); ROWS];
            for (k, slot) in turns.iter_mut().enumerate().take(last).skip(first) {
                let turn = rotation(self.t[(k, k)], self.t[(k + 1, k)]);
                self.rows(k, turn, k);
                *slot = turn;
            }
            for (k, turn) in turns.iter().enumerate().take(last).skip(first) {
                self.columns(k, *turn, (k + 2).min(last + 1));
            }
            for i in first..=last {
                self.t[(i, i)] += shift;
            }
            // The shift was subtracted only in the block, so outside it only the rotations change entries.
        }
        true
    }

    /// Moves the eigenvalues in the right half plane to the front; returns their number.
    fn order(&mut self) -> usize {
        let right = |t: &Table, k: usize| t[(k, k)].re > 0.0;
        for _ in 0..self.size {
            for k in 0..self.size - 1 {
                if right(&self.t, k) || !right(&self.t, k + 1) {
                    continue;
                }
                let turn = rotation(self.t[(k, k + 1)], self.t[(k + 1, k + 1)] - self.t[(k, k)]);
                self.rows(k, turn, k);
                self.columns(k, turn, k + 2);
                self.t[(k + 1, k)] = ZERO;
            }
        }
        (0..self.size).filter(|k| right(&self.t, *k)).count()
    }
}

/// The principal solution.
pub(super) fn solve<T: Real, const N: usize>(
    factor: &LeftFactor<N, T>,
    h_n: &SMatrix<T, N, N>,
) -> Result<Orthogonal<N, T>, Unsolved> {
    let refuse = |refusal| factor.unsolved(Method::Schur, h_n, refusal);
    // Double precision cannot represent derivatives, lanes or more digits.
    if T::order() > 0 || T::LANES > 1 || T::EPSILON < 1e-17 {
        return Err(refuse(Refusal::DoesNotApply));
    }
    if !h_n.iter().all(|x| x.is_finite()) {
        return Err(refuse(Refusal::NotFinite));
    }
    let h = hamiltonian(&factor.matrix(), h_n);
    let mut schur = Schur {
        t: h.map(|x| Number::new(x.value(), 0.0)),
        q: Table::identity(),
        size: 2 * N,
    };
    schur.hessenberg();
    if !schur.triangular() || schur.order() != N {
        return Err(refuse(Refusal::NotConverged));
    }
    // S U1 = U2: transposed, U1^T S^T = U2^T.
    let first = SMatrix::<Number, N, N>::from_fn(|i, j| schur.q[(j, i)]);
    let second = SMatrix::<Number, N, N>::from_fn(|i, j| schur.q[(N + j, i)]);
    let Some(s) = divided(first, second) else {
        return Err(refuse(Refusal::NotConverged));
    };
    let s = SMatrix::<T, N, N>::from_fn(|i, j| T::from_f64(0.5 * (s[(i, j)].re + s[(j, i)].re)));
    finish(factor, h_n, &s, Method::Schur)
}

/// `a^-1 b` of complex matrices, by elimination with partial pivoting.
fn divided<const N: usize>(
    mut a: SMatrix<Number, N, N>,
    mut b: SMatrix<Number, N, N>,
) -> Option<SMatrix<Number, N, N>> {
    for k in 0..N {
        let mut pivot = k;
        for i in k + 1..N {
            if a[(i, k)].norm() > a[(pivot, k)].norm() {
                pivot = i;
            }
        }
        let size = a[(pivot, k)].norm();
        if size <= 0.0 || size.is_nan() {
            return None;
        }
        a.swap_rows(k, pivot);
        b.swap_rows(k, pivot);
        for i in 0..N {
            if i == k {
                continue;
            }
            let factor = a[(i, k)] / a[(k, k)];
            for j in 0..N {
                let (above, beside) = (a[(k, j)], b[(k, j)]);
                a[(i, j)] -= factor * above;
                b[(i, j)] -= factor * beside;
            }
        }
    }
    Some(SMatrix::from_fn(|i, j| b[(i, j)] / a[(i, i)]))
}
