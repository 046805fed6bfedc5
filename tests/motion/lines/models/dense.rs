//! Linear systems over dual numbers, by elimination with partial pivoting.

use crate::action::D;
use clebsch::Real;

/// The solution of `a x = b`.
pub fn solved(mut a: Vec<Vec<D>>, mut b: Vec<D>) -> Vec<D> {
    let n = b.len();
    for k in 0..n {
        let size = |i: usize| a[i][k].value().abs();
        let pivot = (k..n)
            .max_by(|i, j| size(*i).total_cmp(&size(*j)))
            .unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let by = a[i][k] / a[k][k];
            let pivot_row = a[k].clone();
            for (entry, known) in a[i].iter_mut().zip(pivot_row).skip(k) {
                *entry -= by * known;
            }
            let known = b[k];
            b[i] -= by * known;
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            let known = b[j];
            b[k] -= a[k][j] * known;
        }
        b[k] /= a[k][k];
    }
    b
}
