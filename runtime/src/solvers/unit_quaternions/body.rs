//! The constants of the step equation in unit quaternions. Takes `A` and `β`; gives them validated, with the invariants
//! of the inertia `I = A + β`.

use super::shift::{EASY, EXACT, MODERATE, QUICK};
use crate::Real;
use crate::error::{ParameterError, Problem};
use crate::linalg::{determinant, symmetric_eigenvalues};
use crate::validate::{ROUNDINGS, mirrored_difference};
use nalgebra::Matrix3;

/// A body in unit quaternions: the symmetric matrix `A` and the number `β` in `w A v + v x A v + β v = h N / 2`, in body axes. The
/// dimension is mass times length squared. Includes the constants that the solver derives from them once.
///
/// `I = A + β`, the inertia for small steps, is positive definite; `A` itself need not be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuaternionBody<T = f64> {
    /// A power of two near the largest moment. All constants below belong to `I / unit`.
    pub(super) unit: f64,
    /// `1 / (2 unit)`, the factor from `h N` to `u`.
    pub(super) half_over_unit: T,
    /// `β / unit`.
    pub(super) real: T,
    /// The diagonal entries of `I`.
    pub(super) moments: [T; 3],
    /// The entries (2,3), (3,1), (1,2) of `I`.
    pub(super) products: [T; 3],
    /// The differences `I2 - I3`, `I3 - I1`, `I1 - I2` of the diagonal entries, divided by `det I`.
    pub(super) differences: [T; 3],
    /// The inverse of `I`, diagonal entries first.
    pub(super) inverse_moments: [T; 3],
    pub(super) inverse_products: [T; 3],
    /// `(I - tr I) / det I`, diagonal entries first.
    pub(super) linear_moments: [T; 3],
    pub(super) linear_products: [T; 3],
    /// `1`, `tr I` and the sum of the principal minors of `I`, each divided by `det I`.
    pub(super) zeroth: T,
    pub(super) first: T,
    pub(super) second: T,
    /// The largest `|u|^2` for which Newton's method may be exact in one step, and the largest square
    /// of that step for which it is.
    pub(super) quick: T,
    pub(super) exact: T,
    /// The largest `|u|^2` for which one iteration from the series is exact to rounding.
    pub(super) easy: T,
    /// The largest `|u|^2` for which a few iterations are exact to rounding.
    pub(super) moderate: T,
    /// Whether the off-diagonal entries are exactly zero.
    pub(super) diagonal: bool,
}

crate::saved!([] QuaternionBody {
    unit, half_over_unit, real, moments, products, differences, inverse_moments, inverse_products,
    linear_moments, linear_products, zeroth, first, second, quick, exact, easy, moderate, diagonal
});

crate::scalar::of_scalars!(QuaternionBody {
    half_over_unit, real, moments, products, differences, inverse_moments, inverse_products,
    linear_moments, linear_products, zeroth, first, second, quick, exact, easy, moderate;
    unit, diagonal
});

impl<T: Real> QuaternionBody<T> {
    /// Whether the off-diagonal entries are exactly zero; steps are then cheaper. Always false for a scalar with
    /// derivatives, because these entries may have derivatives.
    #[doc(hidden)]
    pub fn is_diagonal(&self) -> bool {
        T::order() == 0 && self.diagonal
    }

    /// Validates `A` (symmetric up to a few roundings) and `β`, in every lane. `field` is the name of `A` in errors.
    ///
    /// # Errors
    /// If an entry is not finite, `A` is not symmetric, or `A + β` is not positive definite.
    pub fn new(field: &'static str, a: Matrix3<T>, real: T) -> Result<Self, ParameterError> {
        let refused = |problem, remedy| ParameterError {
            field,
            problem,
            remedy,
        };
        let inertia = Matrix3::from_diagonal_element(real) + a;
        for row in 0..3 {
            for column in 0..3 {
                let entry = inertia.get((row, column)).copied();
                if !entry.is_some_and(|x| x.is_finite()) {
                    let value = entry.map_or(f64::NAN, Real::value);
                    let problem = Problem::EntryNotFinite { row, column, value };
                    return Err(refused(problem, "give finite values"));
                }
            }
        }
        // `A = I - β` may be a small difference that has the rounding error of `I` and `β`.
        let both = Matrix3::from_diagonal_element(T::from_f64(2.0 * real.magnitude()));
        mirrored_difference(&(a + both)).map_err(|(row, column, upper, lower)| {
            let problem = Problem::NotSymmetric {
                row,
                column,
                upper,
                lower,
            };
            refused(problem, "give a symmetric matrix")
        })?;
        let half = T::from_f64(0.5);
        let inertia = (inertia + inertia.transpose()).map(|x| x * half);
        let eigenvalues = |lane| symmetric_eigenvalues(&inertia.map(|x| x.lane(lane)));
        let mut largest: f64 = 0.0;
        for lane in 0..T::LANES {
            let [small, _, large] = eigenvalues(lane);
            // This form of the comparison also rejects NaN.
            let positive = small > ROUNDINGS * f64::EPSILON * large.abs();
            if !positive {
                let remedy =
                    "give larger moments: for small steps the inertia must be positive definite";
                return Err(refused(Problem::NotPositive { value: small }, remedy));
            }
            largest = largest.max(large);
        }
        let unit = largest.log2().floor().clamp(-400.0, 400.0).exp2();
        let per_unit = T::from_f64(1.0 / unit);
        // |u|^2 over this is the square of the largest half angle, times 1 + |β| / I.
        let smallest = by_lane(|lane| {
            let [small, ..] = eigenvalues(lane);
            small / unit
        });
        let bound = by_lane(|lane| {
            let [small, ..] = eigenvalues(lane);
            let moment = small / unit;
            moment * moment / (1.0 + real.lane(lane).abs() / small)
        });
        Ok(Self::prepared(
            inertia.map(|x| x * per_unit),
            real * per_unit,
            unit,
            [bound, smallest],
        ))
    }

    /// Prepares the constants from `I / unit` and `β / unit`.
    fn prepared(inertia: Matrix3<T>, real: T, unit: f64, [bound, smallest]: [T; 2]) -> Self {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = inertia.data.0;
        let adjugate = [yy * zz - yz * yz, zz * xx - xz * xz, xx * yy - xy * xy];
        let adjugate_products = [xy * xz - xx * yz, xy * yz - yy * xz, xz * yz - zz * xy];
        let trace = xx + yy + zz;
        let [ax, ay, az] = adjugate;
        let zeroth = T::one() / determinant(&inertia);
        let over = |list: [T; 3]| list.map(|x| x * zeroth);
        // The error of the iteration is of twelfth degree in the size of the step.
        let precision = (T::EPSILON / f64::EPSILON).powf(1.0 / 12.0);
        Self {
            unit,
            half_over_unit: T::from_f64(0.5 / unit),
            real,
            moments: [xx, yy, zz],
            products: [yz, xz, xy],
            differences: over([yy - zz, zz - xx, xx - yy]),
            inverse_moments: over(adjugate),
            inverse_products: over(adjugate_products),
            linear_moments: over([xx - trace, yy - trace, zz - trace]),
            linear_products: over([yz, xz, xy]),
            zeroth,
            first: trace * zeroth,
            second: (ax + ay + az) * zeroth,
            quick: bound * T::from_f64(QUICK),
            exact: smallest * smallest * T::from_f64(EXACT * EXACT),
            easy: bound * T::from_f64(EASY * precision),
            moderate: bound * T::from_f64(MODERATE),
            diagonal: yz.is_zero() && xz.is_zero() && xy.is_zero(),
        }
    }

    /// One lane, without derivatives.
    pub(super) fn lane(&self, lane: usize) -> QuaternionBody<f64> {
        let three = |list: [T; 3]| list.map(|x| x.lane(lane));
        QuaternionBody {
            unit: self.unit,
            half_over_unit: self.half_over_unit.lane(lane),
            real: self.real.lane(lane),
            moments: three(self.moments),
            products: three(self.products),
            differences: three(self.differences),
            inverse_moments: three(self.inverse_moments),
            inverse_products: three(self.inverse_products),
            linear_moments: three(self.linear_moments),
            linear_products: three(self.linear_products),
            zeroth: self.zeroth.lane(lane),
            first: self.first.lane(lane),
            second: self.second.lane(lane),
            quick: self.quick.lane(lane),
            exact: self.exact.lane(lane),
            easy: self.easy.lane(lane),
            moderate: self.moderate.lane(lane),
            diagonal: self.diagonal,
        }
    }
}

/// A number with these real parts in its lanes, without derivatives.
pub(super) fn by_lane<T: Real>(value: impl Fn(usize) -> f64) -> T {
    let mut all = T::zero();
    for lane in 0..T::LANES {
        all.set_lane(lane, T::One::from_f64(value(lane)));
    }
    all
}
