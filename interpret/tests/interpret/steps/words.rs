//! Words of the language as generic functions, in which actions are typed.

use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::oracle::step::Edge;

pub type Mat<T, const N: usize> = Square<T, N>;

/// A number of the text.
pub fn of<T: Number>(x: f64) -> T {
    T::constant(x)
}

pub fn square<T: Number>(x: T) -> T {
    x * x
}

/// `dot(a, M*a)`.
pub fn form<T: Number, const N: usize>(m: &Mat<T, N>, a: &[T; N]) -> T {
    dot(a, &m.apply(a))
}

/// `dot(a, a)`.
pub fn norm<T: Number, const N: usize>(a: &[T; N]) -> T {
    dot(a, a)
}

pub fn plus<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn minus<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn times<T: Number, const N: usize>(x: T, a: &[T; N]) -> [T; N] {
    a.map(|y| x * y)
}

/// `-tr(J*R^T*next(R))/h`, for either side of the velocity.
pub fn body<T: Number, const N: usize>(e: &Edge<'_, T>, moments: &str, attitude: &str) -> T {
    -(e.given.square::<N>(moments) * e.turn(attitude)).trace() / e.h
}

/// `m*dot(next(x) - x, next(x) - x)/(2*h)`.
pub fn mass<T: Number, const N: usize>(e: &Edge<'_, T>, mass: &str, place: &str) -> T {
    e.given.real(mass) * norm(&e.changes::<N>(place)) / (of::<T>(2.0) * e.h)
}

/// The same term, for a number.
pub fn point<T: Number>(e: &Edge<'_, T>, mass: &str, place: &str) -> T {
    e.given.real(mass) * square(e.change(place)) / (of::<T>(2.0) * e.h)
}

/// The number of segments, and whether they form a ring.
pub fn extent<T: Number>(e: &Edge<'_, T>) -> (usize, bool) {
    // Rounded, since they are data whose last bits may change.
    let count = e.given.real("N").value().round() as usize;
    (count, e.given.real("ring").value() > 0.5)
}

/// The segments of a chain with the nodes at their ends, and whether they cross the seam of a ring.
pub fn segments<T: Number>(e: &Edge<'_, T>) -> Vec<(usize, usize, bool)> {
    let (count, is_ring) = extent(e);
    let each = (0..count).map(|i| match is_ring && i + 1 == count {
        true => (i, 0, true),
        false => (i, i + 1, false),
    });
    each.collect()
}

/// The inner nodes of a line with the segments before and behind them; all nodes of a ring.
pub fn inner<T: Number>(e: &Edge<'_, T>) -> Vec<[(usize, usize, bool); 2]> {
    let all = segments(e);
    let mut out: Vec<_> = all.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    if let ((_, true), [first, .., last]) = (extent(e), all.as_slice()) {
        out.push([*last, *first]);
    }
    out
}

/// The sum of some terms.
pub fn sum<T: Number>(terms: impl Iterator<Item = T>) -> T {
    terms.fold(of(0.0), |a, b| a + b)
}
