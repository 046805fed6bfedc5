//! Values from the numbers of a state: elements with variations, fields whose numbers are variables, advected
//! quantities.

use crate::group::{Group, LEFT};
use crate::judge::LEFT_BY_SOLVERS;
use crate::matrix::Matrix;
use crate::number::{Number, UNIT, times};
use crate::setup::Numbers;
use crate::stated::{Layout, Side};
use crate::value::Value;

/// Roundings of an increment. A solver finds it, so it has the roundings of the terms of an equation. In a long step of
/// a stiff spring, forces of both nodes cancel, and the rounding of the increment is the largest in the equation.
pub const OF_AN_INCREMENT: f64 = LEFT_BY_SOLVERS;

/// A number of variables.
pub fn small(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// The stored value of an advected quantity. Each entry has the error of the largest entry.
pub fn stored(own: &Numbers, numbers: &[f64], is_quaternion: bool) -> Value {
    let size = numbers.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    let of = |x: f64| Number::within(x, UNIT * size);
    if is_quaternion && numbers.len() == 4 {
        let entry = |i: usize, j: usize| of(LEFT[i][j].1 * numbers[LEFT[i][j].0]);
        return Value::Known(Matrix::from_entries(4, 4, entry));
    }
    let entries = numbers.iter().map(|x| of(*x)).collect();
    Value::Known(Matrix::of_rows(own.rows, own.cols, entries))
}

/// An element with its variations: `R (Id + xi)` or `(Id + xi) R`, for the basis of the Lie algebra.
pub fn varied_element(r: &Matrix, group: Group, side: Side, first: u32) -> Matrix {
    let n = r.rows;
    let mut out = r.clone();
    let entries = out.entries_mut();
    for (which, direction) in group.basis().iter().enumerate() {
        let of = first + small(which);
        for (k, l, c) in direction {
            for i in 0..n {
                let (from, to) = match side {
                    Side::Body => ((i, *k), (i, *l)),
                    Side::Space => ((*l, i), (*k, i)),
                };
                let by = r.entries.get(from.0 * n + from.1);
                if let (Some(x), Some(by)) = (entries.get_mut(to.0 * n + to.1), by) {
                    let (value, error) = times(by.pair(), (*c, 0.0));
                    x.add_slope(of, value, error);
                }
            }
        }
    }
    out
}

/// A field from its numbers, each of which is a variable. If an increment leads to them from the numbers `before`, they
/// have the rounding of the increment as well.
pub fn field(
    layout: Layout,
    own: &Numbers,
    (before, numbers): (Option<&[f64]>, &[f64]),
    first: Option<u32>,
) -> Option<Value> {
    let entry = |k: usize, sign: f64| {
        let x = numbers.get(k).copied().unwrap_or(f64::NAN);
        let from = before.map_or(x, |all| all.get(k).copied().unwrap_or(f64::NAN));
        let error = UNIT * x.abs() + OF_AN_INCREMENT * UNIT * (x - from).abs();
        let n = Number::within(sign * x, error);
        match first {
            Some(first) => n.with_slope(first + small(k), sign, 0.0),
            None => n,
        }
    };
    let of_size = |count: &dyn Fn(usize) -> usize| (1..=64).find(|n| count(*n) == numbers.len());
    let matrix = match layout {
        Layout::Entries => {
            Matrix::from_entries(own.rows, own.cols, |i, j| entry(i * own.cols + j, 1.0))
        }
        Layout::Diagonal => {
            let n = numbers.len();
            Matrix::from_entries(n, n, |i, j| {
                if i == j {
                    entry(i, 1.0)
                } else {
                    Number::default()
                }
            })
        }
        Layout::Symmetric => {
            let n = of_size(&|n| n * (n + 1) / 2)?;
            let place = |i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
            Matrix::from_entries(n, n, |i, j| entry(place(i.min(j), i.max(j)), 1.0))
        }
        Layout::Skew if numbers.len() == 3 => {
            Matrix::from_entries(3, 3, |i, j| match (3 + j - i) % 3 {
                1 => entry(3 - i - j, -1.0),
                2 => entry(3 - i - j, 1.0),
                _ => Number::default(),
            })
        }
        Layout::Skew => {
            let n = of_size(&|n| n * n.saturating_sub(1) / 2)?;
            let place = |i: usize, j: usize| i * (i - 1) / 2 + j;
            Matrix::from_entries(n, n, |i, j| match i.cmp(&j) {
                std::cmp::Ordering::Greater => entry(place(i, j), 1.0),
                std::cmp::Ordering::Less => entry(place(j, i), -1.0),
                std::cmp::Ordering::Equal => Number::default(),
            })
        }
    };
    Some(Value::Known(matrix))
}
