//! Invertible linear maps of n-dimensional space, GL(n).
//! Takes invertible matrices; gives group elements.

use super::{Coadjoint, Coordinate, Group, Part, squares};
use crate::Real;
use crate::domain::LEAST_RATIO;
use crate::linalg::{Dense, inverse, singular_ratio_of, small_inverse};
use crate::scalar::of_scalars;
use core::fmt;
use nalgebra::SMatrix;

/// An invertible matrix, by convention from reference to space: `x = Q X`.
///
/// The Lie algebra consists of all matrices, and the retraction is affine in them. If the equation of
/// a step is linear in its velocity, Newton's method with this retraction solves it by one correction.
/// This is the case for a kinetic energy with a constant inertia in the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<const N: usize, T = f64> {
    matrix: SMatrix<T, N, N>,
}

of_scalars!(Linear<N> { matrix });

/// A matrix that is not an element of GL(n).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotInvertible {
    /// An entry is NaN or infinite.
    NotFinite,
    /// The matrix is singular to working precision: elimination finds no pivot, or its smallest
    /// singular value is below [`LEAST_RATIO`] of its largest.
    Singular,
}

impl fmt::Display for NotInvertible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "not invertible: an entry is NaN or infinite"),
            Self::Singular => write!(f, "not invertible: singular to working precision"),
        }
    }
}

impl std::error::Error for NotInvertible {}

impl<const N: usize, T: Real> Linear<N, T> {
    /// The identity.
    #[inline]
    pub fn identity() -> Self {
        Self {
            matrix: SMatrix::identity(),
        }
    }

    /// The map of a matrix.
    ///
    /// # Errors
    /// [`NotInvertible`] if it is singular or not finite.
    pub fn from_matrix(a: &SMatrix<T, N, N>) -> Result<Self, NotInvertible> {
        invertible_map(&Dense::of(a)).map(|()| Self { matrix: *a })
    }

    /// The map at the end of a step. A check after the step rejects a singular one.
    #[inline]
    pub(crate) fn stepped(matrix: SMatrix<T, N, N>) -> Self {
        Self { matrix }
    }

    /// The matrix, reference -> space.
    #[inline]
    pub fn matrix(&self) -> SMatrix<T, N, N> {
        self.matrix
    }

    /// The map at the end of a step that changes it by this matrix.
    #[inline]
    pub fn changed(&self, change: &SMatrix<T, N, N>) -> Self {
        Self::stepped(self.matrix + change)
    }

    /// The inverse map. If a step has made the matrix singular, its entries are NaN, and the step that
    /// uses them fails.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self {
            matrix: small_inverse(&self.matrix)
                .unwrap_or_else(|| SMatrix::repeat(T::from_f64(f64::NAN))),
        }
    }
}

/// Checks that [`Linear::from_matrix`] would accept a matrix, for any size.
///
/// # Errors
/// The same as [`Linear::from_matrix`].
pub fn invertible_map<T: Real>(a: &Dense<T>) -> Result<(), NotInvertible> {
    if !a.is_finite() {
        return Err(NotInvertible::NotFinite);
    }
    let far = |lane| {
        let mut columns = a.columns().into_iter();
        let own = columns
            .by_ref()
            .map(|c| c.iter().map(|x| x.lane(lane)).collect());
        singular_ratio_of(own.collect()) >= LEAST_RATIO
    };
    match a.inverse() {
        Some(_) if (0..T::LANES).all(far) => Ok(()),
        _ => Err(NotInvertible::Singular),
    }
}

impl<const N: usize, T: Real> core::ops::Mul for Linear<N, T> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            matrix: self.matrix * other.matrix,
        }
    }
}

impl<const N: usize, T: Real> Group<T> for Linear<N, T> {
    const DIMENSION: usize = N * N;

    super::own_operations!();

    /// `self . (1 + X)`, `X` the matrix of the coordinates, row by row.
    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        let x =
            SMatrix::<T, N, N>::from_fn(|i, j| xi.get(N * i + j).copied().unwrap_or_else(T::zero));
        Self {
            matrix: self.matrix + self.matrix * x,
        }
    }

    #[inline]
    fn combined(weights: &[f64], element: impl Fn(usize) -> Self) -> Self {
        let terms = weights.iter().enumerate();
        Self {
            matrix: terms.fold(SMatrix::zeros(), |sum, (i, weight)| {
                sum + element(i).matrix * T::from_f64(*weight)
            }),
        }
    }

    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::entry(index, N))
    }

    /// Zero for every invertible matrix: rounding cannot move it off the group. NaN otherwise.
    fn distance_from_group(&self) -> f64 {
        match inverse(&self.matrix) {
            Some(_) => 0.0,
            None => f64::NAN,
        }
    }

    /// The length of all entries of `Q - 1` together.
    fn is_open(_part: usize) -> bool {
        true
    }

    #[inline(always)]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        if let Some(first) = out.first_mut() {
            *first = squares(&(self.matrix - SMatrix::identity()), xi);
        }
    }

    #[inline]
    fn is_within(&self, reach: &[f64]) -> bool {
        let reach = reach.first().copied().unwrap_or(0.0);
        (self.off_identity() - T::from_f64(reach * reach)).nowhere_positive()
    }
}

impl<const N: usize, T: Real> Linear<N, T> {
    /// The sum of the squares of the entries of `Q - 1`.
    #[inline]
    fn off_identity(&self) -> T {
        let off = self.matrix - SMatrix::identity();
        off.iter().fold(T::zero(), |sum, x| sum + *x * *x)
    }
}

impl<const N: usize, T: Real> Coadjoint<T> for Linear<N, T> {
    type Covector = SMatrix<T, N, N>;

    /// `Q^-T M Q^T`: its pairing with `Q X Q^-1` equals the pairing of `M` with `X`, for `<A, B> = tr(A^T B)`.
    #[inline]
    fn covector_to_space(&self, body: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        self.inverse().matrix.tr_mul(body) * self.matrix.transpose()
    }

    /// `Q^T M Q^-T`.
    #[inline]
    fn covector_to_body(&self, spatial: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        self.matrix.tr_mul(spatial) * self.inverse().matrix.transpose()
    }
}
