//! A left factor, validated and transformed to its principal frames once. Takes the matrix `C`; gives the data for the
//! solvers.

use super::{Refusal, Unsolved};
use crate::groups::Orthogonal;
use crate::linalg::{determinant, inverse, principal_frame};
use crate::saved::{Saved, Words, optional};
use crate::solvers::Method;
use crate::solvers::moser_veselov::Poinsot;
use crate::validate::mirrored_difference;
use crate::{OfScalars, ParameterError, Problem, Real, Rotation};
use core::fmt;
use nalgebra::{SMatrix, SVector, Vector3};

/// The largest matrix size for which the linear systems fit into the work arrays.
pub(super) const LARGEST: usize = 8;

/// A left factor `C = P Q` with a symmetric positive `P` and a rotation `Q`, and the principal frame of `P`, in which
/// the factor is diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftFactor<const N: usize, T = f64> {
    /// The given `C`.
    pub(super) given: SMatrix<T, N, N>,
    /// `U`: maps principal to given components, on the left.
    left: SMatrix<T, N, N>,
    /// `W = Q^T U`: maps principal to given components, on the right.
    right: SMatrix<T, N, N>,
    /// `U^T C W`, diagonal to rounding.
    pub(super) framed: SMatrix<T, N, N>,
    /// Whether both frames are the identity.
    plain: bool,
    /// `P` as a Poinsot matrix, and `Q`, in three dimensions; `None` in other dimensions.
    space: Option<(Poinsot<T>, Rotation<T>)>,
    /// Whether `Q` is the identity.
    symmetric: bool,
}

impl<const N: usize> Saved for LeftFactor<N, f64> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            given,
            left,
            right,
            framed,
            plain,
            space,
            symmetric,
        } = self;
        [given, left, right, framed]
            .into_iter()
            .for_each(|x| x.words(words));
        plain.words(words);
        symmetric.words(words);
        // True in three dimensions, false otherwise.
        optional(space, words, || None);
    }
}

impl<const N: usize, T: Real> OfScalars for LeftFactor<N, T> {
    type Scalar = T;
    type Over<U: Real> = LeftFactor<N, U>;

    fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> LeftFactor<N, U> {
        LeftFactor {
            given: self.given.over(change),
            left: self.left.over(change),
            right: self.right.over(change),
            framed: self.framed.over(change),
            plain: self.plain,
            space: (self.space.as_ref()).map(|(body, turn)| (body.over(change), turn.over(change))),
            symmetric: self.symmetric,
        }
    }
}

/// A matrix that is not a left factor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LeftFactorError {
    /// An entry is NaN or infinite.
    NotFinite,
    /// The determinant is not positive: the principal solution would be a reflection.
    Reflected {
        /// The determinant.
        determinant: f64,
    },
    /// A symmetric factor with a negative eigenvalue, or with two eigenvalues whose sum is not positive.
    NotPositive {
        /// The smallest eigenvalue.
        smallest: f64,
        /// The second smallest eigenvalue.
        second: f64,
    },
}

impl fmt::Display for LeftFactorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "an entry is NaN or infinite"),
            Self::Reflected { determinant } => write!(
                f,
                "the determinant is {determinant:e}, but a left factor needs a positive one"
            ),
            Self::NotPositive { smallest, second } => write!(
                f,
                "its smallest eigenvalues are {smallest:e} and {second:e}: none may be negative, and at most one may be zero"
            ),
        }
    }
}

impl std::error::Error for LeftFactorError {}

impl LeftFactorError {
    /// Turns this error into a [`ParameterError`] of the parameter `field`.
    #[cold]
    pub fn in_field(self, field: &'static str) -> ParameterError {
        let remedy = match self {
            Self::NotPositive { .. } => {
                "give second moments that are positive in all directions but one: a rotation in a plane without second moments \
                 has no inertia"
            }
            Self::NotFinite | Self::Reflected { .. } => {
                "give the second moments of a real mass distribution, rotated if necessary"
            }
        };
        ParameterError {
            field,
            problem: Problem::LeftFactor(self),
            remedy,
        }
    }
}

/// The largest number of Newton steps for the polar factor; with scaling, fewer than ten suffice.
const POLAR_STEPS: usize = 20;

/// The orthogonal factor `Q` of `C = P Q` (Higham, SIAM J. Sci. Stat. Comput. 7, 1986).
fn polar<T: Real, const N: usize>(c: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    let half = T::from_f64(0.5);
    let square = |a: &SMatrix<T, N, N>| a.iter().fold(T::zero(), |s, x| s + *x * *x);
    let mut q = *c;
    for _ in 0..POLAR_STEPS {
        let back = inverse(&q)?.transpose();
        let scale = (square(&back) / square(&q)).sqrt().sqrt();
        q = (q * scale + back * (T::one() / scale)) * half;
    }
    // Without scaling, the last steps converge quadratically, including derivative parts.
    for _ in 0..2 {
        q = (q + inverse(&q)?.transpose()) * half;
    }
    Some(q)
}

impl<const N: usize, T: Real> LeftFactor<N, T> {
    /// Whether both have the same form, so that the operations of a step are the same.
    #[doc(hidden)]
    pub fn is_alike(&self, other: &Self) -> bool {
        let bodies = match (&self.space, &other.space) {
            (Some((a, _)), Some((b, _))) => a.is_diagonal() == b.is_diagonal(),
            (a, b) => a.is_none() && b.is_none(),
        };
        bodies && (self.plain, self.symmetric) == (other.plain, other.symmetric)
    }

    /// Validates a matrix as a left factor.
    ///
    /// One eigenvalue of a symmetric matrix may be zero, as for a flat body. Any other matrix must have a positive
    /// determinant. Sizes above eight do not compile.
    ///
    /// # Errors
    /// [`LeftFactorError`] with the invalid numbers.
    pub fn new(c: SMatrix<T, N, N>) -> Result<Self, LeftFactorError> {
        const { assert!(2 <= N && N <= LARGEST, "left factors have sizes 2 to 8") };
        if !c.iter().all(|x| x.is_finite()) {
            return Err(LeftFactorError::NotFinite);
        }
        let symmetric = mirrored_difference(&c).is_ok();
        let q = if symmetric {
            SMatrix::identity()
        } else {
            let determinant = determinant(&c).least();
            let q = polar(&c).filter(|q| q.iter().all(|x| x.is_finite()));
            match q {
                Some(q) if determinant > 0.0 => q,
                _ => return Err(LeftFactorError::Reflected { determinant }),
            }
        };
        let p = c * q.transpose();
        let p = (p + p.transpose()) * T::from_f64(0.5);
        let diagonal = p == SMatrix::from_diagonal(&p.diagonal());
        let left = if diagonal {
            SMatrix::identity()
        } else {
            principal_frame(&p)
        };
        let right = q.tr_mul(&left);
        let framed = left.tr_mul(&(c * right));
        let factor = Self {
            given: c,
            left,
            right,
            framed,
            plain: symmetric && diagonal,
            space: (N == 3)
                .then(|| {
                    let body = Poinsot::new(nalgebra::Matrix3::from_fn(|i, j| p[(i, j)])).ok()?;
                    let turn = nalgebra::Matrix3::from_fn(|i, j| q[(i, j)]);
                    Some((body, Rotation::from_matrix(&turn).ok()?))
                })
                .flatten(),
            symmetric,
        };
        for lane in 0..T::LANES {
            let mut spectrum = factor.framed.diagonal().map(|x| x.lane(lane));
            let list = spectrum.as_mut_slice();
            list.sort_by(f64::total_cmp);
            let (smallest, second) = (list[0], list[1]);
            let largest = list[N - 1];
            let noise = 64.0 * T::EPSILON * largest;
            // The comparison also rejects NaN.
            let positive = smallest >= -noise && second > noise;
            if !positive {
                return Err(LeftFactorError::NotPositive { smallest, second });
            }
        }
        Ok(factor)
    }

    /// The given matrix `C`.
    pub fn matrix(&self) -> SMatrix<T, N, N> {
        self.given
    }

    /// The principal solution by the solver `method`.
    ///
    /// `h_n` is the step times the edge momentum, a skew matrix: `Omega C^T - C Omega^T = h_n`.
    /// Equal arguments give equal results. Nothing is allocated.
    ///
    /// # Errors
    /// [`Unsolved`] if the momentum exceeds the exact bound of the principal solution, with the ratio of both; if the
    /// solver does not support the factor; or if it does not converge.
    #[inline]
    pub fn solve(
        &self,
        h_n: &SMatrix<T, N, N>,
        method: Method,
    ) -> Result<Orthogonal<N, T>, Unsolved> {
        match method {
            Method::LieNewton => super::lie_newton::solve(self, h_n),
            Method::Sign => super::sign::solve(self, h_n),
            Method::Schur => super::schur::solve(self, h_n),
            Method::Davenport => match three(&self.given, h_n) {
                Some((c, v)) => super::davenport(&c, &v).map(|q| Orthogonal::of_rotation(&q)),
                None => Err(self.unsolved(method, h_n, Refusal::DoesNotApply)),
            },
            Method::Kappa => match three(&self.given, h_n) {
                Some((_, v)) => self.by_kappa(&v).map(|r| Orthogonal::of_rotation(&r)),
                None => Err(self.unsolved(method, h_n, Refusal::DoesNotApply)),
            },
        }
    }

    /// `Omega C^T = R P` with `R = Omega Q^T`: the quartic for the Poinsot matrix `P`.
    #[inline]
    fn by_kappa(&self, v: &Vector3<T>) -> Result<Rotation<T>, Unsolved> {
        let refuse = |refusal| self.unsolved(Method::Kappa, &self.hat(v), refusal);
        let Some((body, turn)) = &self.space else {
            return Err(refuse(Refusal::DoesNotApply));
        };
        match crate::solvers::moser_veselov::forced(body, v) {
            Ok(r) if self.symmetric => Ok(r),
            Ok(r) => Ok(r * *turn),
            Err(e) if e.ratio.is_nan() => Err(refuse(Refusal::NotFinite)),
            Err(_) => Err(refuse(Refusal::NotConverged)),
        }
    }

    /// The skew matrix of a vector, for `N = 3`.
    fn hat(&self, v: &Vector3<T>) -> SMatrix<T, N, N> {
        let hat = crate::linalg::hat(v);
        SMatrix::from_fn(|i, j| hat.get((i, j)).copied().unwrap_or_else(T::zero))
    }

    /// The principal solution in three dimensions, for a momentum vector.
    ///
    /// # Errors
    /// The errors of [`LeftFactor::solve`].
    #[inline]
    pub fn rotation(&self, h_n: &Vector3<T>, method: Method) -> Result<Rotation<T>, Unsolved> {
        if method == Method::Kappa {
            return self.by_kappa(h_n);
        }
        let h_n = self.hat(h_n);
        let omega = self.solve(&h_n, method)?.matrix();
        let omega =
            nalgebra::Matrix3::from_fn(|i, j| omega.get((i, j)).copied().unwrap_or_else(T::zero));
        Rotation::from_matrix(&omega)
            .map_err(|_| self.unsolved(method, &h_n, Refusal::DoesNotApply))
    }

    /// Like [`LeftFactor::rotation`] for several independent bodies, with bitwise identical results.
    ///
    /// # Errors
    /// The error of [`LeftFactor::solve`] for the first body that fails.
    // A separate function: the bodies need all registers.
    #[inline(never)]
    pub fn rotations<const COUNT: usize>(
        &self,
        h_n: &[Vector3<T>; COUNT],
        method: Method,
    ) -> Result<[Rotation<T>; COUNT], Unsolved> {
        // Numbers with lanes already solve several bodies at once.
        if let (Method::Kappa, true, Some((body, _)), 1) =
            (method, self.symmetric, &self.space, T::LANES)
        {
            let (all, found) = crate::solvers::moser_veselov::forced_together(body, h_n);
            if found {
                return Ok(all);
            }
        }
        let mut all = [Rotation::identity(); COUNT];
        for (omega, v) in all.iter_mut().zip(h_n) {
            *omega = self.rotation(v, method)?;
        }
        Ok(all)
    }

    /// Transforms a skew matrix from the given frame to the principal frame.
    #[inline]
    pub(super) fn framed_momentum(&self, v: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        // If the frame is the identity, nothing is computed.
        match self.plain && T::order() == 0 {
            true => *v,
            false => self.left.tr_mul(&(v * self.left)),
        }
    }

    /// Transforms a rotation from the principal frame to the given frame.
    #[inline]
    pub(super) fn unframed(&self, r: &SMatrix<T, N, N>) -> Orthogonal<N, T> {
        match self.plain && T::order() == 0 {
            true => Orthogonal::nearby(r),
            false => Orthogonal::nearby(&(self.left * r * self.right.transpose())),
        }
    }

    /// The eigenvalues of `P`.
    #[inline]
    pub(super) fn spectrum(&self) -> SVector<T, N> {
        self.framed.diagonal()
    }

    /// The error for a momentum without a solution.
    #[cold]
    #[inline(never)]
    pub(super) fn unsolved(
        &self,
        method: Method,
        h_n: &SMatrix<T, N, N>,
        refusal: Refusal,
    ) -> Unsolved {
        let (ratio, lane) = self.farthest(h_n);
        let p = self.left * self.framed * self.left.transpose();
        let refusal = match refusal {
            Refusal::NotConverged if ratio > 1.0 || ratio.is_nan() => Refusal::BeyondBound,
            other => other,
        };
        Unsolved {
            method,
            refusal,
            ratio,
            fastest: super::reach::fastest(&p, h_n, lane),
            lane: u8::try_from(lane).unwrap_or(u8::MAX),
            residual: f64::NAN,
            h: None,
            largest_step: None,
        }
    }
}

/// Converts the factor and the momentum to three dimensions.
fn three<T: Real, const N: usize>(
    c: &SMatrix<T, N, N>,
    v: &SMatrix<T, N, N>,
) -> Option<(nalgebra::Matrix3<T>, Vector3<T>)> {
    if N != 3 {
        return None;
    }
    let c = nalgebra::Matrix3::from_fn(|i, j| c[(i, j)]);
    Some((c, Vector3::new(v[(2, 1)], v[(0, 2)], v[(1, 0)])))
}
