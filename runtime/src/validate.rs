//! Checks of parameters and initial values, as emitted constructors call them. Takes a name and a value; gives a
//! [`ParameterError`] with the offending numbers if a check fails.

mod constraints;
mod initial;

pub use constraints::{along_constraint, has_inertia, on_constraint};
pub use initial::{Initial, initial};

use crate::domain::{Domain, Function};
use crate::linalg::{
    Dense, Homogeneous, left_multiplication, quaternion_imaginary, quaternion_real,
};
use crate::scalar::largest;
use crate::{ParameterError, Problem, Real};
use nalgebra::SMatrix;

/// Entries typed by hand agree to their last digit; entries computed from an inertia tensor in other axes agree to a
/// few roundings of the largest entry.
pub(crate) const ROUNDINGS: f64 = 64.0;

/// Every component, in every lane and with every derivative part, is finite.
///
/// # Errors
/// Names the first component that is not; components count in the order given.
pub fn finite<T: Real>(field: &'static str, values: &[T]) -> Result<(), ParameterError> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(index) => Err(ParameterError {
            field,
            problem: Problem::NotFinite {
                index,
                value: values.get(index).map_or(f64::NAN, offending),
            },
            remedy: "give finite numbers",
        }),
    }
}

/// Every entry of the matrix is finite, as [`finite`].
///
/// # Errors
/// Names the first entry that is not, row by row.
pub fn finite_entries<T: Real, const R: usize, const C: usize>(
    field: &'static str,
    matrix: &SMatrix<T, R, C>,
) -> Result<(), ParameterError> {
    finite_entries_of(field, [R, C], |row, column| {
        matrix.get((row, column)).copied()
    })
}

/// Tests a matrix whose size is known only at run time, given by rows, columns and entries.
///
/// # Errors
/// Names the first entry, row by row, that is not finite.
pub fn finite_entries_of<T: Real>(
    field: &'static str,
    [rows, columns]: [usize; 2],
    entry: impl Fn(usize, usize) -> Option<T>,
) -> Result<(), ParameterError> {
    for row in 0..rows {
        for column in 0..columns {
            if let Some(entry) = entry(row, column).filter(|x| !x.is_finite()) {
                return Err(ParameterError {
                    field,
                    problem: Problem::EntryNotFinite {
                        row,
                        column,
                        value: offending(&entry),
                    },
                    remedy: "give finite numbers",
                });
            }
        }
    }
    Ok(())
}

/// The value itself if it is not finite, otherwise the largest component of lanes and derivatives.
fn offending<T: Real>(x: &T) -> f64 {
    if x.value().is_finite() {
        x.magnitude()
    } else {
        x.value()
    }
}

/// The matrix equals its transpose, up to rounding of its largest entry.
///
/// # Errors
/// Names the first pair of entries that differ.
pub fn symmetric<T: Real, const N: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError> {
    symmetric_of(field, &Dense::of(matrix))
}

/// Like [`symmetric`], for a matrix whose size is known only at run time.
///
/// # Errors
/// As [`symmetric`].
pub fn symmetric_of<T: Real>(field: &'static str, matrix: &Dense<T>) -> Result<(), ParameterError> {
    mirrored(matrix, |upper, lower| upper - lower, 1).map_err(|(row, column, upper, lower)| {
        ParameterError {
            field,
            problem: Problem::NotSymmetric {
                row,
                column,
                upper,
                lower,
            },
            remedy: "give the same number on both sides of the diagonal",
        }
    })
}

/// The matrix is minus its transpose, up to rounding of its largest entry.
///
/// # Errors
/// Names the first pair of entries that are not opposite, or a diagonal entry that is not zero.
pub fn skew<T: Real, const N: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError> {
    skew_of(field, &Dense::of(matrix))
}

/// Like [`skew`], for a matrix whose size is known only at run time.
///
/// # Errors
/// As [`skew`].
pub fn skew_of<T: Real>(field: &'static str, matrix: &Dense<T>) -> Result<(), ParameterError> {
    mirrored(matrix, |upper, lower| upper + lower, 0).map_err(|(row, column, upper, lower)| {
        ParameterError {
            field,
            problem: Problem::NotSkew {
                row,
                column,
                upper,
                lower,
            },
            remedy: "give opposite numbers on both sides of a zero diagonal",
        }
    })
}

/// The matrix is zero off its diagonal, exactly.
///
/// # Errors
/// Names the first entry that is not.
pub fn diagonal<T: Real, const N: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError> {
    diagonal_of(field, &Dense::of(matrix))
}

/// Like [`diagonal`], for a matrix whose size is known only at run time.
///
/// # Errors
/// As [`diagonal`].
pub fn diagonal_of<T: Real>(field: &'static str, matrix: &Dense<T>) -> Result<(), ParameterError> {
    for row in 0..matrix.rows {
        for column in 0..matrix.cols {
            let entry = matrix.at(row, column);
            if row != column && !entry.is_zero() {
                return Err(ParameterError {
                    field,
                    problem: Problem::NotDiagonal {
                        row,
                        column,
                        value: entry.magnitude(),
                    },
                    remedy: "give zeros off the diagonal",
                });
            }
        }
    }
    Ok(())
}

/// The matrix is a rotation, up to rounding: an inverse is taken to be a transpose.
///
/// # Errors
/// Carries the deviation from orthonormal columns and the determinant.
pub fn orthogonal<T: Real, const N: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError> {
    orthogonal_of(field, &Dense::of(matrix))
}

/// Like [`orthogonal`], for a matrix whose size is known only at run time.
///
/// # Errors
/// As [`orthogonal`].
pub fn orthogonal_of<T: Real>(
    field: &'static str,
    matrix: &Dense<T>,
) -> Result<(), ParameterError> {
    let defect = matrix.tr_mul(matrix).minus_one();
    let deviation = largest(defect.data.iter().map(|x| x.magnitude()));
    let determinant = matrix.determinant();
    // Entries of a rotation are at most 1. Written so that NaN is rejected.
    if deviation <= ROUNDINGS * T::EPSILON && determinant.exceeds(T::zero()) {
        return Ok(());
    }
    Err(ParameterError {
        field,
        problem: Problem::NotOrthogonal {
            deviation,
            determinant: determinant.least(),
        },
        remedy: "give a rotation matrix that is accurate to all digits",
    })
}

/// The matrix is the left multiplication by a unit quaternion, up to rounding.
///
/// # Errors
/// Carries the deviation from the nearest such matrix, or of the length from 1.
pub fn unit_quaternion<T: Real>(
    field: &'static str,
    matrix: &SMatrix<T, 4, 4>,
) -> Result<(), ParameterError> {
    let real = quaternion_real(matrix);
    let [[x, y, z]] = quaternion_imaginary(matrix).data.0;
    let nearest = left_multiplication([real, x, y, z]);
    let length = real * real + x * x + y * y + z * z - T::one();
    in_group(
        field,
        matrix - nearest,
        length,
        "left multiplication by a unit quaternion",
    )
}

/// The matrix is a homogeneous one `[R x; 0 1]` with a rotation `R`, up to rounding.
///
/// # Errors
/// Carries the deviation of the last row from `(0, ..., 0, 1)`, or of `R^T R` from the identity.
pub fn rigid_motion<T: Real, const N: usize, const B: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError>
where
    SMatrix<T, N, N>: Homogeneous<Block = SMatrix<T, B, B>>,
{
    orthogonal(field, &matrix.block())?;
    let last = N.saturating_sub(1);
    let row = matrix.row(last) - SMatrix::<T, N, N>::identity().row(last);
    in_group(
        field,
        row,
        T::zero(),
        "the homogeneous matrix of a rigid motion",
    )
}

/// Rejects a matrix that differs from an element of its group by more than rounding.
fn in_group<T: Real, const R: usize, const C: usize>(
    field: &'static str,
    difference: SMatrix<T, R, C>,
    length: T,
    elements: &'static str,
) -> Result<(), ParameterError> {
    let entries = difference.iter().map(|x| x.magnitude());
    let deviation = largest(entries.chain([length.magnitude()]));
    // Written so that NaN is rejected.
    if deviation <= ROUNDINGS * T::EPSILON {
        return Ok(());
    }
    Err(ParameterError {
        field,
        problem: Problem::NotInGroup {
            elements,
            deviation,
        },
        remedy: "give an element of the group that is accurate to all digits",
    })
}

/// The matrix has an inverse, to working precision.
///
/// # Errors
/// When elimination finds no pivot.
pub fn invertible<T: Real, const N: usize>(
    field: &'static str,
    matrix: &SMatrix<T, N, N>,
) -> Result<(), ParameterError> {
    invertible_of(field, &Dense::of(matrix))
}

/// Like [`invertible`], for a matrix whose size is known only at run time.
///
/// # Errors
/// As [`invertible`].
pub fn invertible_of<T: Real>(
    field: &'static str,
    matrix: &Dense<T>,
) -> Result<(), ParameterError> {
    match matrix.inverse() {
        Some(_) => Ok(()),
        None => Err(ParameterError {
            field,
            problem: Problem::NotInvertible,
            remedy: "give a matrix with a non-zero determinant",
        }),
    }
}

/// The step size is positive and finite, in every lane.
///
/// # Errors
/// Carries the smallest lane.
pub fn positive_step<T: Real>(h: T) -> Result<(), ParameterError> {
    let value = h.least();
    // Steps divide by it.
    let problem = if value > 0.0 && value.recip().is_infinite() {
        Problem::TooSmall { value }
    } else if value > 0.0 && h.is_finite() {
        return Ok(());
    } else if value > 0.0 {
        Problem::NotFinite {
            index: 0,
            value: h.greatest(),
        }
    } else {
        Problem::NotPositive { value }
    };
    Err(ParameterError {
        field: "h",
        problem,
        remedy: if value < 0.0 {
            "give a positive step size; to run backwards in time, reverse all initial momenta and the field of a magnetic term"
        } else {
            "give a positive, finite step size, at least 1e-307"
        },
    })
}

/// As [`positive_step`], for steps forwards or backwards in time: lanes of one sign.
///
/// # Errors
/// Carries the lane nearest to zero.
pub fn directed_step<T: Real>(h: T) -> Result<(), ParameterError> {
    let backwards = h.is_below(0.0);
    positive_step(if backwards { -h } else { h }).map_err(|e| ParameterError {
        remedy: "give a finite step size of either sign, with absolute value at least 1e-307",
        ..e
    })
}

/// An assumption of the model, already evaluated.
///
/// # Errors
/// Carries the assumption's text.
pub fn assumption(holds: bool, text: &'static str) -> Result<(), ParameterError> {
    if holds {
        return Ok(());
    }
    Err(ParameterError {
        field: "assume",
        problem: Problem::AssumptionFails { text },
        remedy: "choose parameters that satisfy it",
    })
}

/// A function whose argument, evaluated from the parameters, has this value.
///
/// # Errors
/// Names the argument when it is outside the function's domain.
pub fn inside<T: Real>(
    domain: Domain,
    function: Function,
    argument: &'static str,
    value: T,
) -> Result<(), ParameterError> {
    if domain.admits(value) {
        return Ok(());
    }
    Err(ParameterError {
        field: argument,
        problem: Problem::OutsideDomain {
            function,
            domain,
            value: value.value(),
        },
        remedy: "choose parameters for which the function is defined",
    })
}

/// A function whose argument, evaluated at the initial node, has this value.
///
/// # Errors
/// Names the argument when it is outside the function's domain: no step helps there.
pub fn defined<T: Real>(
    domain: Domain,
    function: Function,
    argument: &'static str,
    value: T,
) -> Result<(), ParameterError> {
    inside(domain, function, argument, value).map_err(|error| ParameterError {
        remedy: "start where the model is defined",
        ..error
    })
}

/// The symmetry test alone: row, column and the two values of the first pair that differs.
pub(crate) fn mirrored_difference<T: Real, const N: usize>(
    matrix: &SMatrix<T, N, N>,
) -> Result<(), (usize, usize, f64, f64)> {
    mirrored(&Dense::of(matrix), |upper, lower| upper - lower, 1)
}

/// Compares entries across the diagonal, without the first `offset` diagonals above it.
fn mirrored<T: Real>(
    matrix: &Dense<T>,
    defect: impl Fn(T, T) -> T,
    offset: usize,
) -> Result<(), (usize, usize, f64, f64)> {
    let size = largest(matrix.data.iter().map(|x| x.magnitude()));
    let allowed = ROUNDINGS * T::EPSILON * size;
    for row in 0..matrix.rows {
        for column in row + offset..matrix.rows {
            let (upper, lower) = (matrix.at(row, column), matrix.at(column, row));
            // Written so that NaN is rejected.
            let agree = defect(upper, lower).magnitude() <= allowed;
            if !agree {
                return Err((row, column, upper.value(), lower.value()));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix2;

    #[test]
    fn every_check_accepts_and_refuses() {
        assert!(finite("x", &[1.0, 2.0]).is_ok());
        let error = finite("x", &[1.0, f64::INFINITY]).expect_err("infinite");
        assert_eq!(
            error.to_string(),
            "`x`: component 2 is inf; give finite numbers"
        );
        let error = finite_entries("J", &Matrix2::new(1.0, f64::NAN, 3.0, 4.0)).expect_err("NaN");
        assert_eq!(
            error.to_string(),
            "`J`: entry (1, 2) is NaN; give finite numbers"
        );
        assert!(symmetric("J", &Matrix2::new(1.0, 2.0, 2.0, 3.0)).is_ok());
        assert!(symmetric("J", &Matrix2::new(1.0, 2.0, 2.1, 3.0)).is_err());
        assert!(symmetric("J", &Matrix2::new(1.0, f64::NAN, 2.0, 3.0)).is_err());
        assert!(skew("A", &Matrix2::new(0.0, 2.0, -2.0, 0.0)).is_ok());
        assert!(skew("A", &Matrix2::new(0.1, 2.0, -2.0, 0.0)).is_err());
        assert!(diagonal("D", &Matrix2::new(1.0, 0.0, 0.0, 2.0)).is_ok());
        assert!(diagonal("D", &Matrix2::new(1.0, 1e-300, 0.0, 2.0)).is_err());
        assert!(orthogonal("R", &Matrix2::new(0.6, -0.8, 0.8, 0.6)).is_ok());
        assert!(orthogonal("R", &Matrix2::new(0.6, 0.8, 0.8, -0.6)).is_err());
        assert!(orthogonal("R", &Matrix2::new(0.6, -0.8, 0.8, 0.600_001)).is_err());
        assert!(orthogonal("R", &Matrix2::new(f64::NAN, 0.0, 0.0, 1.0)).is_err());
        let q = left_multiplication([0.1, -0.7, 0.5, 0.5]);
        assert!(unit_quaternion("q", &q).is_ok());
        assert!(unit_quaternion("q", &q.transpose()).is_ok());
        assert!(unit_quaternion("q", &(q * 1.001)).is_err());
        assert!(unit_quaternion("q", &(q * f64::NAN)).is_err());
        let mut other = q;
        other.swap_rows(0, 1);
        assert!(unit_quaternion("q", &other).is_err());
        let mut motion = SMatrix::<f64, 4, 4>::identity();
        motion.m14 = 7.0;
        assert!(rigid_motion("G", &motion).is_ok());
        assert!(rigid_motion("G", &motion.transpose()).is_err());
        motion.m12 = 1e-3;
        assert!(rigid_motion("G", &motion).is_err());
        assert!(invertible("A", &Matrix2::new(1.0, 2.0, 3.0, 4.0)).is_ok());
        assert!(invertible("A", &Matrix2::new(1.0, 2.0, 2.0, 4.0)).is_err());
        assert!(positive_step(0.1).is_ok());
        assert!(positive_step(0.0).is_err());
        assert!(positive_step(f64::NAN).is_err());
        assert!(assumption(true, "c > 0").is_ok());
        assert!(assumption(false, "c > 0").is_err());
    }

    #[test]
    fn a_few_roundings_pass_and_thousands_do_not() {
        // An entry computed in another way differs by a few roundings, a mistyped digit causes a far larger
        // difference.
        for (roundings, passes) in [(8.0, true), (1e4, false)] {
            let off = roundings * f64::EPSILON;
            let matrix = Matrix2::new(1.0, 2.0, 2.0 * (1.0 + off), 3.0);
            assert_eq!(symmetric("J", &matrix).is_ok(), passes, "{roundings}");
            let matrix = Matrix2::new(0.0, 2.0, -2.0 * (1.0 + off), 0.0);
            assert_eq!(skew("A", &matrix).is_ok(), passes, "{roundings}");
            let matrix = Matrix2::new(0.6, -0.8, 0.8, 0.6 + off);
            assert_eq!(orthogonal("R", &matrix).is_ok(), passes, "{roundings}");
            let q = left_multiplication([0.1, -0.7, 0.5, 0.5]) * (1.0 + off);
            assert_eq!(unit_quaternion("q", &q).is_ok(), passes, "{roundings}");
            let mut motion = SMatrix::<f64, 4, 4>::identity();
            motion.m12 = off;
            assert_eq!(rigid_motion("G", &motion).is_ok(), passes, "{roundings}");
        }
    }
}
