//! The mass distribution of a rigid body, in the form that the solver uses. Takes the Poinsot
//! matrix; gives it validated, with the invariants of the inertia tensor.

use super::cayley::dot;
use super::kappa::Symmetric;
use crate::Real;
use crate::linalg::{determinant, symmetric_eigenvalues};
use crate::number_format::place;
use crate::scalar::lane_view::in_lanes;
use crate::scalar::of_scalars;
use crate::validate::{ROUNDINGS, mirrored_difference};
use core::fmt;
use nalgebra::{Matrix3, Vector3};

/// A valid Poinsot matrix `J` (second moments of mass, body axes, mass times length squared) and the data that the
/// solver computes from it once.
///
/// Any symmetric `J >= 0` of rank at least 2 is a body; `J` may be singular (a flat body).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Poinsot<T = f64> {
    j: Matrix3<T>,
    /// A power of two near the trace of `I`. The constants below belong to `I / unit`, so that none of them can
    /// overflow or underflow.
    pub(super) unit: f64,
    /// `1 / (2 unit)`, which converts `h N` to the solver's `u`.
    pub(super) half_over_unit: T,
    /// `I / unit`, diagonal entries.
    pub(super) moments: [T; 3],
    /// `I / unit`, entries (2,3), (3,1), (1,2).
    pub(super) products: [T; 3],
    /// Diagonal entries of `I / unit - s1`: minus the sums of the two other moments.
    pub(super) rest: [T; 3],
    /// `I2 - I3`, `I3 - I1`, `I1 - I2` of the diagonal entries.
    pub(super) differences: [T; 3],
    /// Adjugate of `I / unit`, diagonal entries.
    pub(super) adjugate_moments: [T; 3],
    /// Adjugate of `I / unit`, entries (2,3), (3,1), (1,2).
    pub(super) adjugate_products: [T; 3],
    /// Elementary symmetric functions of `I / unit`.
    pub(super) s1: T,
    pub(super) s2: T,
    pub(super) s3: T,
    /// These functions divided by `s3`, for the quartic.
    pub(super) symmetric: Symmetric<T>,
    /// `(I / unit)^-1` and `(s2 (I / unit)^-1 - s1) / s3`, whose quadratic forms give the initial guess of the root.
    pub(super) energy: Form<T>,
    pub(super) deviation: Form<T>,
    /// Whether the off-diagonal entries are exactly zero.
    pub(super) diagonal: bool,
}

/// A quadratic form: factors of the squares of the components, and of the products (2,3), (3,1),
/// (1,2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Form<T> {
    squares: [T; 3],
    products: [T; 3],
}

in_lanes!(Form { squares, products });
in_lanes!(Poinsot {
    j, half_over_unit, moments, products, rest, differences, adjugate_moments, adjugate_products,
    s1, s2, s3, symmetric, energy, deviation; unit, diagonal
});

of_scalars!(Form { squares, products });
of_scalars!(Poinsot {
    j, half_over_unit, moments, products, rest, differences, adjugate_moments, adjugate_products,
    s1, s2, s3, symmetric, energy, deviation; unit, diagonal
});
crate::saved!([] Poinsot {
    j, unit, half_over_unit, moments, products, rest, differences, adjugate_moments,
    adjugate_products, s1, s2, s3, symmetric, energy, deviation, diagonal
});

impl<T: Real> Form<T> {
    #[inline(always)]
    pub(super) fn value<const DIAGONAL: bool>(&self, squares: [T; 3], products: [T; 3]) -> T {
        if DIAGONAL {
            dot(self.squares, squares)
        } else {
            dot(self.squares, squares) + dot(self.products, products)
        }
    }
}

/// Why a matrix is not a Poinsot matrix. Rows and columns count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PoinsotError {
    /// An entry is NaN or infinite.
    NotFinite {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
    /// Two entries that should be equal differ.
    NotSymmetric {
        /// Row of the entry above the diagonal.
        row: usize,
        /// The column of this entry.
        column: usize,
        /// The entry above the diagonal.
        upper: f64,
        /// The entry below the diagonal.
        lower: f64,
    },
    /// `J` has a negative eigenvalue: the triangle inequality of the moments of inertia fails.
    Triangle {
        /// The smallest eigenvalue of `J`.
        smallest: f64,
        /// The largest moment of inertia.
        largest_moment: f64,
        /// The sum of the two smaller moments, which the largest moment must not exceed.
        sum_of_others: f64,
    },
    /// A moment of inertia vanishes because all mass is on a line.
    NoInertia {
        /// The smallest moment of inertia.
        smallest_moment: f64,
    },
}

impl fmt::Display for PoinsotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { row, column } => {
                write!(f, "entry {} is NaN or infinite", place(*row, *column))
            }
            Self::NotSymmetric {
                row,
                column,
                upper,
                lower,
            } => write!(
                f,
                "not symmetric: entry {} is {upper} but {} is {lower}",
                place(*row, *column),
                place(*column, *row)
            ),
            Self::Triangle {
                smallest,
                largest_moment,
                sum_of_others,
            } => write!(
                f,
                "negative second moment {smallest}: the moment of inertia {largest_moment} exceeds the sum {sum_of_others} of \
                 the other two, which is impossible for a body"
            ),
            Self::NoInertia { smallest_moment } => write!(
                f,
                "the smallest moment of inertia is {smallest_moment}: all mass lies on a line, so momenta do not determine the \
                 spin about it"
            ),
        }
    }
}

impl std::error::Error for PoinsotError {}

impl<T: Real> Poinsot<T> {
    /// Validates the Poinsot matrix `J`, in every lane. Accepts asymmetry and negative eigenvalues
    /// of a few roundings; it symmetrises the matrix.
    ///
    /// # Errors
    /// [`PoinsotError`] with the numbers.
    pub fn new(j: Matrix3<T>) -> Result<Self, PoinsotError> {
        for row in 0..3 {
            for column in 0..3 {
                if !j.get((row, column)).is_some_and(|x| x.is_finite()) {
                    return Err(PoinsotError::NotFinite { row, column });
                }
            }
        }
        mirrored_difference(&j).map_err(|(row, column, upper, lower)| {
            PoinsotError::NotSymmetric {
                row,
                column,
                upper,
                lower,
            }
        })?;
        let half = T::from_f64(0.5);
        let j = (j + j.transpose()).map(|x| x * half);
        let mut largest: f64 = 0.0;
        for lane in 0..T::LANES {
            largest = largest.max(body_check(&j.map(|x| x.lane(lane)))?);
        }
        Ok(Self::prepared(j, power_of_two_near(largest)))
    }

    /// The body of the inertia tensor `I` (body axes): `J = tr(I)/2 1 - I`.
    ///
    /// # Errors
    /// The errors of [`Poinsot::new`], for `J`.
    pub fn from_inertia(inertia: &Matrix3<T>) -> Result<Self, PoinsotError> {
        let half_trace = inertia.trace() * T::from_f64(0.5);
        Self::new(Matrix3::from_diagonal_element(half_trace) - *inertia)
    }

    fn prepared(j: Matrix3<T>, unit: f64) -> Self {
        let per_unit = T::from_f64(1.0 / unit);
        let inertia = Matrix3::from_diagonal_element(j.trace()) - j;
        Self::with_constants(j, inertia.map(|x| x * per_unit), unit)
    }

    /// From `J` and `I / unit`.
    fn with_constants(j: Matrix3<T>, inertia: Matrix3<T>, unit: f64) -> Self {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = inertia.data.0;
        let adjugate_moments = [yy * zz - yz * yz, zz * xx - xz * xz, xx * yy - xy * xy];
        let adjugate_products = [xy * xz - xx * yz, xy * yz - yy * xz, xz * yz - zz * xy];
        let s1 = xx + yy + zz;
        let [ax, ay, az] = adjugate_moments;
        let s2 = ax + ay + az;
        let s3 = determinant(&inertia);
        let symmetric = Symmetric::new(s1, s2, s3);
        let energy = Form {
            squares: adjugate_moments.map(|x| x * symmetric.zeroth),
            products: adjugate_products.map(|x| (x + x) * symmetric.zeroth),
        };
        let deviation = Form {
            squares: energy
                .squares
                .map(|x| x * symmetric.second - symmetric.first),
            products: energy.products.map(|x| x * symmetric.second),
        };
        Self {
            j,
            unit,
            half_over_unit: T::from_f64(0.5 / unit),
            moments: [xx, yy, zz],
            products: [yz, xz, xy],
            rest: [-(yy + zz), -(zz + xx), -(xx + yy)],
            differences: [yy - zz, zz - xx, xx - yy],
            adjugate_moments,
            adjugate_products,
            s1,
            s2,
            s3,
            symmetric,
            energy,
            deviation,
            diagonal: yz.is_zero() && xz.is_zero() && xy.is_zero(),
        }
    }

    /// The Poinsot matrix `J`.
    #[inline]
    pub fn matrix(&self) -> &Matrix3<T> {
        &self.j
    }

    /// The inertia tensor `I = tr(J) 1 - J`.
    #[inline]
    pub fn inertia(&self) -> Matrix3<T> {
        Matrix3::from_diagonal_element(self.j.trace()) - self.j
    }

    /// This body in principal axes, with known moments divided by `unit`.
    pub(super) fn in_principal_axes(&self, [x, y, z]: [T; 3]) -> Self {
        self.with_inertia(&Matrix3::from_diagonal(&Vector3::new(x, y, z)))
    }

    /// `(I / unit)^-1`.
    pub(super) fn inverse_inertia(&self) -> Matrix3<T> {
        let [[x, y, z], [yz, xz, xy]] = [self.adjugate_moments, self.adjugate_products];
        Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z).map(|entry| entry * self.symmetric.zeroth)
    }

    /// The solver data for `inertia` as `I / unit`, in the same unit. It need not be a body: `J` may have a negative
    /// eigenvalue, because the solver uses only `I`.
    pub(super) fn with_inertia(&self, inertia: &Matrix3<T>) -> Self {
        let half = T::from_f64(0.5);
        let inertia = (inertia + inertia.transpose()).map(|x| x * half);
        let j = Matrix3::from_diagonal_element(inertia.trace() * half) - inertia;
        Self::with_constants(j.map(|x| x * T::from_f64(self.unit)), inertia, self.unit)
    }

    /// Whether the body is given in principal axes; the solver is then faster. Always false for a scalar with derivatives,
    /// because entries that are zero may have derivatives.
    #[inline(always)]
    pub fn is_diagonal(&self) -> bool {
        T::order() == 0 && self.diagonal
    }

    /// One lane of the body, without derivatives.
    pub(super) fn lane(&self, lane: usize) -> Poinsot<f64> {
        Poinsot::prepared(self.j.map(|x| x.lane(lane)), self.unit)
    }

    /// `(I / unit) v`.
    #[inline(always)]
    pub(super) fn inertia_times<const DIAGONAL: bool>(&self, v: [T; 3]) -> [T; 3] {
        symmetric_times::<T, DIAGONAL>(self.moments, self.products, v)
    }

    /// `adj(I / unit) v`.
    #[inline(always)]
    pub(super) fn adjugate_times<const DIAGONAL: bool>(&self, v: [T; 3]) -> [T; 3] {
        symmetric_times::<T, DIAGONAL>(self.adjugate_moments, self.adjugate_products, v)
    }

    /// `(adj(I / unit) + a) v`.
    #[inline(always)]
    pub(super) fn adjugate_and_times<const DIAGONAL: bool>(&self, a: T, v: [T; 3]) -> [T; 3] {
        let [x, y, z] = self.adjugate_moments;
        symmetric_times::<T, DIAGONAL>([x + a, y + a, z + a], self.adjugate_products, v)
    }

    /// `(I / unit - s1) v`.
    #[inline(always)]
    pub(super) fn rest_times<const DIAGONAL: bool>(&self, v: [T; 3]) -> [T; 3] {
        symmetric_times::<T, DIAGONAL>(self.rest, self.products, v)
    }

    /// `u = h N / (2 unit)`.
    #[inline(always)]
    pub(super) fn scaled(&self, h_n: &Vector3<T>) -> [T; 3] {
        let [[x, y, z]] = h_n.data.0;
        let s = self.half_over_unit;
        [x * s, y * s, z * s]
    }
}

/// A symmetric matrix, given by its diagonal entries and its entries at (2,3), (3,1), (1,2), times a vector.
#[inline(always)]
pub(in crate::solvers) fn symmetric_times<T: Real, const DIAGONAL: bool>(
    [xx, yy, zz]: [T; 3],
    [yz, xz, xy]: [T; 3],
    [x, y, z]: [T; 3],
) -> [T; 3] {
    if DIAGONAL {
        [xx * x, yy * y, zz * z]
    } else {
        [
            (xx * x + xy * y) + xz * z,
            (xy * x + yy * y) + yz * z,
            (xz * x + yz * y) + zz * z,
        ]
    }
}

/// Validates one lane; returns the largest moment of inertia.
fn body_check(j: &Matrix3<f64>) -> Result<f64, PoinsotError> {
    let [small, middle, large] = symmetric_eigenvalues(j);
    let allowed = ROUNDINGS * f64::EPSILON * large.abs();
    if small < -allowed {
        return Err(PoinsotError::Triangle {
            smallest: small,
            largest_moment: middle + large,
            sum_of_others: (small + large) + (small + middle),
        });
    }
    let smallest_moment = small + middle;
    // This form of the comparison also rejects NaN.
    if smallest_moment > allowed {
        Ok(middle + large)
    } else {
        Err(PoinsotError::NoInertia { smallest_moment })
    }
}

/// The power of two at or below a positive number, limited to the range whose inverse is normal.
fn power_of_two_near(x: f64) -> f64 {
    x.log2().floor().clamp(-1000.0, 1000.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::Poinsot;
    use nalgebra::Matrix3;

    #[test]
    fn one_product_of_inertia_is_enough_to_be_not_diagonal() {
        let moments = Matrix3::from_diagonal(&[1.0, 2.0, 3.0].into());
        assert!(Poinsot::new(moments).expect("a body").diagonal);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let mut a = moments;
            (a[(i, j)], a[(j, i)]) = (0.25, 0.25);
            assert!(!Poinsot::new(a).expect("a body").diagonal, "{i} {j}");
        }
    }
}
