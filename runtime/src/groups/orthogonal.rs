//! Rotations of n-dimensional space, SO(n), stored as orthogonal matrices. Takes matrices or algebra coordinates;
//! gives elements that stay orthogonal in arbitrarily long products.

use super::{Coadjoint, Coordinate, Group, NotARotation, Part};
use crate::Real;
use crate::linalg::{Dense, orthonormalised, product, skew_from, solve_many};
use crate::scalar::{largest, of_scalars};
use nalgebra::SMatrix;

/// A rotation of n-dimensional space, by convention from body to space: `v_space = R v_body`.
///
/// Products and retractions are made orthogonal again by one Newton step, so that rounding errors do not accumulate.
/// For three dimensions [`Rotation`](super::Rotation) is shorter and faster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthogonal<const N: usize, T = f64> {
    matrix: SMatrix<T, N, N>,
}

of_scalars!(Orthogonal<N> { matrix });

/// Input data typed with ten digits are accepted and made orthonormal; larger defects are treated as mistakes.
const ALLOWED_DEFECT: f64 = 1e-9;

/// Newton steps that reduce a defect of [`ALLOWED_DEFECT`] to rounding, even in double-double: each step squares the
/// defect.
const STEPS_FROM_INPUT: usize = 2;

impl<const N: usize, T: Real> Orthogonal<N, T> {
    /// The identity.
    #[inline]
    pub fn identity() -> Self {
        Self {
            matrix: SMatrix::identity(),
        }
    }

    /// The rotation of a matrix with orthonormal columns and determinant +1.
    ///
    /// # Errors
    /// [`NotARotation`] when an entry of `A^T A - 1` exceeds 1e-9, the determinant is negative or
    /// an entry is not finite; within that the matrix is replaced by a nearby rotation.
    pub fn from_matrix(a: &SMatrix<T, N, N>) -> Result<Self, NotARotation> {
        let nearest = nearest_rotation(&Dense::of(a))?;
        Ok(Self {
            matrix: nearest.fixed(),
        })
    }

    /// A matrix that the caller knows to be a rotation up to rounding: the result is orthogonal to working precision.
    #[inline]
    pub(crate) fn nearby(a: &SMatrix<T, N, N>) -> Self {
        Self {
            matrix: orthonormalised(a),
        }
    }

    /// The rotation of space with this quaternion, if `N` is three; the identity otherwise.
    #[inline]
    pub(crate) fn of_rotation(r: &super::Rotation<T>) -> Self {
        let matrix = r.matrix();
        match N {
            3 => Self {
                matrix: SMatrix::from_fn(|i, j| matrix[(i, j)]),
            },
            _ => Self::identity(),
        }
    }

    /// The matrix, body -> space.
    #[inline]
    pub fn matrix(&self) -> SMatrix<T, N, N> {
        self.matrix
    }

    /// The inverse rotation, space -> body.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self {
            matrix: self.matrix.transpose(),
        }
    }
}

/// The matrix of [`Orthogonal::from_matrix`], of any size.
///
/// # Errors
/// As there.
pub fn nearest_rotation<T: Real>(a: &Dense<T>) -> Result<Dense<T>, NotARotation> {
    if !a.is_finite() {
        return Err(NotARotation::NotFinite);
    }
    let defect = defect(a);
    // The comparison also rejects NaN: products of finite entries may overflow.
    let near = defect <= ALLOWED_DEFECT;
    if !near {
        return Err(NotARotation::NotOrthogonal { defect });
    }
    if a.determinant().least() < 0.0 {
        return Err(NotARotation::Reflection);
    }
    let mut nearest = a.clone();
    for _ in 0..STEPS_FROM_INPUT {
        nearest = nearest.orthonormalised();
    }
    Ok(nearest)
}

/// The largest entry of `A^T A - 1` in absolute value, over the real parts of all lanes.
fn defect<T: Real>(a: &Dense<T>) -> f64 {
    let gram = a.tr_mul(a).minus_one();
    let entries = gram.data.iter();
    entries.fold(0.0, |worst: f64, x| worst.max(x.greatest()).max(-x.least()))
}

impl<const N: usize, T: Real> core::ops::Mul for Orthogonal<N, T> {
    type Output = Self;

    /// The composition, orthogonal to rounding however long the chain of products.
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self::nearby(&product(&self.matrix, &other.matrix))
    }
}

impl<const N: usize, T: Real> Group<T> for Orthogonal<N, T> {
    const DIMENSION: usize = N * (N.saturating_sub(1)) / 2;

    super::own_operations!();

    /// `self . cay(X)` with the Cayley map `(1 - X/2)^-1 (1 + X/2)`, `X` the skew matrix of the
    /// coordinates: for `i < j`, row by row, `-xi` at (i, j) and `+xi` at (j, i).
    #[inline]
    fn retract(&self, xi: &[T]) -> Self {
        let half = skew_from::<T, N>(xi) * T::from_f64(0.5);
        let one = SMatrix::<T, N, N>::identity();
        // cay(X) = 2 (1 - X/2)^-1 - 1; the matrix has an inverse for every skew X.
        match solve_many(&(one - half), &one) {
            Some(inverse) => Self::nearby(&(self.matrix * (inverse + inverse - one))),
            None => Self {
                matrix: SMatrix::repeat(T::from_f64(f64::NAN)),
            },
        }
    }

    fn coordinate(index: usize) -> Coordinate {
        Coordinate::of(Part::of_pair(index, N))
    }

    fn distance_from_group(&self) -> f64 {
        let gram = self.matrix.tr_mul(&self.matrix) - SMatrix::identity();
        largest(gram.iter().map(|x| x.magnitude()))
    }

    /// With the planes' angles `a`, `R (1 - Y/2) - (1 + Y/2)` is `(R + 1)(X - Y)/2`, where `X` and `Y` have the coordinates
    /// compared: `cos(a/2)` times as large as the difference at least.
    #[inline]
    fn compared(&self, xi: &[T], out: &mut [[T; 2]]) {
        let half = skew_from::<T, N>(xi) * T::from_f64(0.5);
        let off = self.matrix - self.matrix * half - half - SMatrix::identity();
        let eighth = self.off_identity();
        let near = T::one() - eighth;
        let mut both = [
            eighth * T::from_f64(4.0) / near,
            off.iter().fold(T::zero(), |sum, x| sum + *x * *x) * T::from_f64(0.5) / near,
        ];
        for lane in 0..T::LANES {
            if eighth.lane(lane) >= 1.0 {
                for x in &mut both {
                    x.set_lane(lane, T::One::from_f64(f64::INFINITY));
                }
            }
        }
        if let Some(first) = out.first_mut() {
            *first = both;
        }
    }

    #[inline]
    fn is_within(&self, reach: &[f64]) -> bool {
        let reach = reach.first().copied().unwrap_or(0.0);
        let eighth = self.off_identity();
        let four = eighth * T::from_f64(4.0);
        (four - (T::one() - eighth) * T::from_f64(reach * reach)).nowhere_positive()
    }
}

impl<const N: usize, T: Real> Orthogonal<N, T> {
    /// An eighth of the sum of the squares of the entries of `R - 1`.
    #[inline]
    fn off_identity(&self) -> T {
        let off = self.matrix - SMatrix::identity();
        off.iter().fold(T::zero(), |sum, x| sum + *x * *x) * T::from_f64(0.125)
    }
}

impl<const N: usize, T: Real> Coadjoint<T> for Orthogonal<N, T> {
    type Covector = SMatrix<T, N, N>;

    /// `R M R^T` of a skew matrix.
    #[inline]
    fn covector_to_space(&self, body: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        self.matrix * body * self.matrix.transpose()
    }

    /// `R^T M R` of a skew matrix.
    #[inline]
    fn covector_to_body(&self, spatial: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        self.matrix.tr_mul(&(spatial * self.matrix))
    }
}
