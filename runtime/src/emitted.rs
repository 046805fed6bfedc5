//! The names that emitted code uses, in one place: linear algebra, groups, solvers, errors and the
//! description of a model. Hand-written code should not use this module; steppers import all of it.

pub use crate::card::{
    Card, Dimension, Field, Invariant, Kind, OpenError, Settings, chosen_solver,
};
pub use crate::domain;
pub use crate::groups::{
    AboutBody, Additive, BodyImpulse, BodyMomentum, BodyMomentumMatrix, BodyPlaneImpulse,
    CarriedImpulse, CarriedPlaneImpulse, Coadjoint, FieldMomentum, Group, Linear, Orthogonal,
    Placed, PlaneMotion, RigidMotion, Rotation, SpatialImpulse, SpatialMomentum,
    SpatialMomentumMatrix, SpatialPlaneImpulse, TurnedRotation, UnitQuaternion, added,
    added_number,
};
pub use crate::integrate::not_less;
pub use crate::integrate::{
    Model as _, Moving, Reversible, SideBySide, Stepper, Steps, advance_side_by_side, only_size,
    open,
};
pub use crate::kinetic::KineticWarning;
pub use crate::linalg::{
    adjugate, axial_of_difference, columns_from, crossed, crossing, determinant, even_count, hat,
    inclusion, into_columns, into_rows, less_identity, motion_rotation, motion_translation,
    pencil_coefficients, pure_quaternion, quaternion_imaginary, quaternion_real,
    quaternion_rotation, rows_from, skew_coordinates, solve, trace_complement, twist, vee,
};
pub use crate::line::{self, LineError};
pub use crate::mesh::{self, Functional as _};
pub use crate::scalar::{InLanes, OfScalars as _, Real};
pub use crate::solvers::Method;
pub use crate::solvers::left_factor::{
    LeftFactor, LeftFactorError, Unsolved, reach_of, rotation_at,
};
pub use crate::solvers::moser_veselov::{Edge, Free, MoserVeselovError, Order, Poinsot, forced};
pub use crate::solvers::newton;
pub use crate::solvers::two_sided::{
    displaced, divided, divided_at_once, increment_before, increment_behind, increment_between,
    left_sided, right_sided, two_sided, two_sided_increment,
};
pub use crate::solvers::unit_quaternions::{QuaternionBody, QuaternionError};
pub use crate::validate;
pub use crate::{ParameterError, StartError, StepCause, StepError};
pub use nalgebra::{SMatrix, SVector};
pub use num_traits::{One as _, Zero as _};

/// The inverse of a matrix; all NaN if there is none, so that the step that uses it fails.
#[inline]
#[must_use]
pub fn inverse_or_nan<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    crate::linalg::small_inverse(a).unwrap_or_else(|| SMatrix::repeat(T::from_f64(f64::NAN)))
}

/// The solution of `a x = b`; all NaN if a solution does not exist.
#[inline]
#[must_use]
pub fn solve_or_nan<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SVector<T, N>,
) -> SVector<T, N> {
    solve(a, b).unwrap_or_else(|| SVector::repeat(T::from_f64(f64::NAN)))
}

/// The sum of the sizes of a kinetic and a potential energy.
#[inline]
#[must_use]
pub fn sum_of_sizes<T: Real>((kinetic, potential): (T, T)) -> T {
    kinetic.abs() + potential.abs()
}

/// If impulses cancel at a node, the rounding error of an energy is at most this fraction of the kinetic energy of
/// momenta as large as these impulses.
const CANCELLED: f64 = 1e-12;

/// The size of a kinetic and a potential energy. `enlarged` is the kinetic energy of momenta that are at least as
/// large as the impulses of the node. A fraction of it bounds the size from below: the kinetic energy of a body at
/// equilibrium may be only a rounding error.
#[inline]
#[must_use]
pub fn size_of_energy<T: Real>((kinetic, potential): (T, T), (enlarged, _): (T, T)) -> T {
    let cancelled = T::from_f64(CANCELLED) * enlarged.abs();
    crate::scalar::greater(kinetic.abs(), cancelled) + potential.abs()
}

/// The coefficients of a pencil that do not vanish, row by row.
pub fn spectrum<const N: usize>(coefficients: SMatrix<f64, N, N>) -> impl Iterator<Item = f64> {
    crate::linalg::even_degrees(N).map(move |at| coefficients[at])
}

/// Scales of [`spectrum`]: the lengths of `M` and `S`, raised to the degree of each coefficient.
pub fn spectrum_scales<const N: usize>(m: f64, s: f64) -> impl Iterator<Item = f64> {
    spectrum_scales_of(N, m, s)
}

/// Like `spectrum_scales`, for a size that is known only at run time.
pub fn spectrum_scales_of(n: usize, m: f64, s: f64) -> impl Iterator<Item = f64> {
    let power = |x: f64, n: usize| (0..n).fold(1.0, |p, _| p * x);
    crate::linalg::even_degrees(n)
        .map(move |(row, i)| power(m, row + 1) * power(s, n.saturating_sub(row + 1 + i)))
}

/// `D A` of a diagonal matrix.
#[inline(always)]
#[must_use]
pub fn diagonal_times<T: Real, const N: usize, const C: usize>(
    diagonal: &SMatrix<T, N, N>,
    a: &SMatrix<T, N, C>,
) -> SMatrix<T, N, C> {
    SMatrix::from_fn(|i, j| diagonal[(i, i)] * a[(i, j)])
}

/// `A D` of a diagonal matrix.
#[inline(always)]
#[must_use]
pub fn times_diagonal<T: Real, const R: usize, const N: usize>(
    a: &SMatrix<T, R, N>,
    diagonal: &SMatrix<T, N, N>,
) -> SMatrix<T, R, N> {
    SMatrix::from_fn(|i, j| a[(i, j)] * diagonal[(j, j)])
}

/// The size of a momentum: the sum of the magnitudes of its components.
#[inline(always)]
#[must_use]
pub fn size_of<T: Real, const R: usize, const C: usize>(a: &SMatrix<T, R, C>) -> f64 {
    a.iter().fold(0.0, |sum, x| sum + x.magnitude())
}

/// The rigid motion of a rotation and a translation.
#[inline(always)]
#[must_use]
pub fn rigid_motion<T: Real>(rotation: Rotation<T>, translation: SVector<T, 3>) -> RigidMotion<T> {
    RigidMotion {
        rotation,
        translation,
    }
}

/// Vectors of three components on top of each other.
#[inline(always)]
#[must_use]
pub fn joined<T: Real, const K: usize, const D: usize>(
    parts: &[SVector<T, 3>; K],
) -> SVector<T, D> {
    SVector::from_fn(|i, _| parts.get(i / 3).map_or_else(T::zero, |part| part[i % 3]))
}

/// The matrix of these blocks of three, given by rows.
#[inline(always)]
#[must_use]
pub fn assembled<T: Real, const K: usize, const D: usize>(
    blocks: &[[SMatrix<T, 3, 3>; K]; K],
) -> SMatrix<T, D, D> {
    SMatrix::from_fn(|i, j| {
        let block = blocks.get(i / 3).and_then(|row| row.get(j / 3));
        block.map_or_else(T::zero, |block| block[(i % 3, j % 3)])
    })
}

/// The unit vector along `axis`, counted from 0.
#[inline]
#[must_use]
pub fn unit<T: Real, const N: usize>(axis: usize) -> SVector<T, N> {
    SVector::from_fn(|i, _| if i == axis { T::one() } else { T::zero() })
}

/// The skew matrix of the unit vector along `axis`: a basis of the Lie algebra of SO(3).
#[inline]
#[must_use]
pub fn basis<T: Real>(axis: usize) -> SMatrix<T, 3, 3> {
    hat(&unit(axis))
}

/// The solution of the leading `size` equations of `a x = b`; all NaN if it does not exist.
#[inline]
#[must_use]
pub fn solve_leading_or_nan<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SVector<T, N>,
    size: usize,
) -> SVector<T, N> {
    let mut scale = [T::one(); N];
    let held = crate::linalg::held_scales(&mut scale[..size.min(N)], |i, j| a[(i, j)]);
    let solved = match held {
        false => crate::linalg::solve_leading(a, b, size),
        true => crate::linalg::solve_scaled(|i, j| a[(i, j)], b, &scale, size),
    };
    solved.unwrap_or_else(|| SVector::repeat(T::from_f64(f64::NAN)))
}

/// The square matrix of these columns.
#[inline]
#[must_use]
pub fn columns<T: Real, const N: usize>(
    column: impl Fn(usize) -> SVector<T, N>,
) -> SMatrix<T, N, N> {
    let mut all = SMatrix::<T, N, N>::zeros();
    for at in 0..N {
        all.set_column(at, &column(at));
    }
    all
}

/// The skew matrix of the coordinate with this index: a basis of the Lie algebra of SO(n), for
/// `i < j`, row by row, -1 at (i, j) and +1 at (j, i).
#[inline]
#[must_use]
pub fn skew_basis<T: Real, const N: usize>(index: usize) -> SMatrix<T, N, N> {
    let mut basis = SMatrix::zeros();
    if let Some((i, j)) = skew_place(N, index) {
        basis[(i, j)] = -T::one();
        basis[(j, i)] = T::one();
    }
    basis
}

/// The row and the column of this index.
#[inline]
#[must_use]
pub fn skew_place(n: usize, index: usize) -> Option<(usize, usize)> {
    let (mut i, mut rest) = (0, index);
    // Row i has n - 1 - i entries right of the diagonal.
    while i + 1 < n && rest >= n - 1 - i {
        rest -= n - 1 - i;
        i += 1;
    }
    let j = i + 1 + rest;
    (j < n).then_some((i, j))
}

/// The matrix unit with this index, row by row: a basis of the Lie algebra of GL(n).
#[inline]
#[must_use]
pub fn matrix_basis<T: Real, const N: usize>(index: usize) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| {
        if N * i + j == index {
            T::one()
        } else {
            T::zero()
        }
    })
}

/// The matrix unit with this index, row by row: a basis of the increments of a field.
#[inline]
#[must_use]
pub fn array_basis<T: Real, const R: usize, const C: usize>(index: usize) -> SMatrix<T, R, C> {
    let one = |at| if at == index { T::one() } else { T::zero() };
    SMatrix::from_fn(|i, j| one(C * i + j))
}

/// Writes the components of a vector to the front of `out`; returns the rest.
#[inline]
pub fn put_vector<'a, T: Real, const N: usize>(
    out: &'a mut [T],
    value: &SVector<T, N>,
) -> &'a mut [T] {
    fill(out, N, value.iter().copied())
}

/// Writes the coordinates of a skew matrix to the front of `out`; returns the rest.
#[inline]
pub fn put_skew<'a, T: Real, const N: usize>(
    out: &'a mut [T],
    value: &SMatrix<T, N, N>,
) -> &'a mut [T] {
    fill(out, N * N.saturating_sub(1) / 2, skew_coordinates(value))
}

/// Writes the entries of a matrix, row by row, to the front of `out`; returns the rest.
#[inline]
pub fn put_matrix<'a, T: Real, const R: usize, const C: usize>(
    out: &'a mut [T],
    value: &SMatrix<T, R, C>,
) -> &'a mut [T] {
    let entries = (0..R).flat_map(|i| (0..C).map(move |j| value[(i, j)]));
    fill(out, R * C, entries)
}

/// Writes one number to the front of `out`; returns the rest.
#[inline]
pub fn put_number<'a, T: Real>(out: &'a mut [T], value: &T) -> &'a mut [T] {
    fill(out, 1, [*value].into_iter())
}

#[inline]
fn fill<T: Real>(out: &mut [T], count: usize, values: impl Iterator<Item = T>) -> &mut [T] {
    let (front, rest) = out.split_at_mut(count.min(out.len()));
    for (slot, x) in front.iter_mut().zip(values) {
        *slot = x;
    }
    rest
}

/// `(A + A^T)/2`.
#[inline]
#[must_use]
pub fn symmetric_part<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    (a + a.transpose()) * T::from_f64(0.5)
}

/// `(A - A^T)/2`.
#[inline]
#[must_use]
pub fn skew_part<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    (a - a.transpose()) * T::from_f64(0.5)
}

/// The diagonal of `A`, as a matrix.
#[inline]
#[must_use]
pub fn diagonal_part<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    SMatrix::from_diagonal(&a.diagonal())
}

/// The matrix with this vector on its diagonal.
#[inline]
#[must_use]
pub fn diagonal<T: Real, const N: usize>(v: &SVector<T, N>) -> SMatrix<T, N, N> {
    SMatrix::from_diagonal(v)
}

/// The diagonal of `A`, as a vector.
#[inline]
#[must_use]
pub fn diagonal_of<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SVector<T, N> {
    a.diagonal()
}

/// The length of all entries together.
#[inline]
#[must_use]
pub fn length<T: Real, const R: usize, const C: usize>(a: &SMatrix<T, R, C>) -> T {
    a.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt()
}

/// Whether two quantities are equal, entry by entry.
#[inline(always)]
#[must_use]
pub fn same<V: Compared>(a: &V, b: &V) -> bool {
    a.same(b)
}

/// A quantity of a state other than an element or a momentum: a number, a vector or a matrix.
pub trait Compared {
    /// Whether both are equal, entry by entry.
    fn same(&self, other: &Self) -> bool;
}

impl<T: Real> Compared for T {
    #[inline(always)]
    fn same(&self, other: &Self) -> bool {
        self == other
    }
}

impl<T: Real, const R: usize, const C: usize> Compared for SMatrix<T, R, C> {
    #[inline(always)]
    fn same(&self, other: &Self) -> bool {
        // They are nearly always equal, so the only branch is at the end.
        self.iter()
            .zip(other.iter())
            .fold(true, |all, (x, y)| all & (x == y))
    }
}

/// Whether every entry is finite.
#[inline]
#[must_use]
pub fn all_finite<T: Real, const R: usize, const C: usize>(a: &SMatrix<T, R, C>) -> bool {
    line::Finite::is_finite(a)
}

/// Copies `values` to the front of `out` and returns the rest of `out`.
pub fn put(out: &mut [f64], values: impl IntoIterator<Item = f64>) -> &mut [f64] {
    let mut filled = 0;
    for (slot, x) in out.iter_mut().zip(values) {
        *slot = x;
        filled += 1;
    }
    out.split_at_mut(filled).1
}

/// The entries of a matrix row by row.
pub fn rows<const R: usize, const C: usize>(a: SMatrix<f64, R, C>) -> impl Iterator<Item = f64> {
    let t = a.transpose();
    (0..R * C).map(move |i| t.as_slice().get(i).copied().unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::{diagonal_part, skew_part, symmetric_part};
    use nalgebra::Matrix3;

    #[test]
    fn a_matrix_is_the_sum_of_its_parts() {
        let a = Matrix3::new(1.0, 2.0, 4.0, -8.0, 16.0, 32.0, 0.5, 0.25, -2.0);
        let (even, odd) = (symmetric_part(&a), skew_part(&a));
        assert_eq!(even + odd, a);
        assert_eq!((even.transpose(), odd.transpose()), (even, -odd));
        assert_eq!(diagonal_part(&a).diagonal(), a.diagonal());
        assert_eq!(diagonal_part(&odd), Matrix3::zeros());
    }
}
