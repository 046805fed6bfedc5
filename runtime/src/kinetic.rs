//! Checks whether the kinetic energy of a model is positive at the start of a trajectory. Takes the matrix of the
//! quadratic form in all velocities together; gives a warning if it is not positive definite. The warning states the
//! sign convention, because a wrong sign is the most common mistake.

use crate::scalar::largest;
use core::fmt;
use nalgebra::SMatrix;

/// Why the kinetic energy at a state is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KineticWarning {
    /// The number of velocities.
    pub velocities: usize,
    /// In how many independent directions the energy is negative.
    pub negative: usize,
    /// In how many it vanishes, to rounding.
    pub vanishing: usize,
    /// The smallest eigenvalue of the form, in units in which every diagonal entry is 1 in size.
    pub smallest: f64,
}

/// An eigenvalue of a matrix with unit diagonal is zero within this: sums of a few hundred terms.
const ROUNDING: f64 = 1e-13;

/// Sweeps of Jacobi's method; it converges quadratically, for any size, in fewer than ten.
const SWEEPS: usize = 30;

impl KineticWarning {
    /// Judges the leading `count` rows and columns of a symmetric matrix, the Hessian of the kinetic
    /// energy in the velocities at the identity. `None` if it is positive definite.
    #[must_use]
    pub fn of<const N: usize>(form: &SMatrix<f64, N, N>, count: usize) -> Option<Self> {
        Self::of_entries(count.min(N), &|i, j| form[(i, j)])
    }

    /// Like `of`, for a matrix of `n` rows given by its entries.
    #[must_use]
    pub fn of_entries(n: usize, form: &dyn Fn(usize, usize) -> f64) -> Option<Self> {
        // Velocities have different units: each is scaled by its own energy or, if that vanishes, by its largest
        // coupling.
        let size = |i: usize| {
            let own = form(i, i).abs();
            let row = largest((0..n).map(|j| form(i, j)));
            match own > ROUNDING * row {
                true => own.sqrt(),
                false if row > 0.0 => row.sqrt(),
                false => 1.0,
            }
        };
        let sizes: Vec<f64> = (0..n).map(size).collect();
        let mut a = vec![vec![0.0; n]; n];
        for (i, row) in a.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = 0.5 * (form(i, j) + form(j, i)) / (sizes[i] * sizes[j]);
            }
        }
        if a.iter().flatten().any(|x| !x.is_finite()) {
            return Some(Self {
                velocities: n,
                negative: 0,
                vanishing: n,
                smallest: f64::NAN,
            });
        }
        let eigenvalues = eigenvalues(&mut a);
        let bound = ROUNDING * n as f64;
        let warning = Self {
            velocities: n,
            negative: eigenvalues.iter().filter(|x| **x < -bound).count(),
            vanishing: eigenvalues.iter().filter(|x| x.abs() <= bound).count(),
            smallest: eigenvalues.iter().copied().fold(f64::INFINITY, f64::min),
        };
        (warning.negative + warning.vanishing > 0).then_some(warning)
    }
}

/// The eigenvalues of a symmetric matrix, by Jacobi's rotations.
fn eigenvalues(a: &mut [Vec<f64>]) -> Vec<f64> {
    let n = a.len();
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..n {
            for q in p + 1..n {
                let (off, size) = (a[p][q], (a[p][p] * a[q][q]).abs().sqrt());
                if off == 0.0 || off.abs() <= f64::EPSILON * size * 1e-3 {
                    continue;
                }
                turned = true;
                let theta = (a[q][q] - a[p][p]) / (2.0 * off);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let (c, s) = (1.0 / t.hypot(1.0), t / t.hypot(1.0));
                for row in a.iter_mut() {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                let (above, below) = a.split_at_mut(q);
                for (u, v) in above[p].iter_mut().zip(&mut below[0]) {
                    (*u, *v) = (c * *u - s * *v, s * *u + c * *v);
                }
            }
        }
        if !turned {
            break;
        }
    }
    (0..n).map(|i| a[i][i]).collect()
}

impl fmt::Display for KineticWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            velocities,
            negative,
            vanishing,
            smallest,
        } = self;
        if smallest.is_nan() {
            return write!(f, "the kinetic energy at the start is not a finite number");
        }
        if *negative == 0 {
            write!(
                f,
                "the kinetic energy at the start is degenerate: it vanishes in {vanishing} of \
                 {velocities} independent directions of the velocity. "
            )?;
        } else {
            let sort = match negative == velocities {
                true => "negative",
                false => "indefinite",
            };
            write!(
                f,
                "the kinetic energy at the start is {sort}: it is negative in {negative} of \
                 {velocities} independent directions of the velocity (smallest eigenvalue \
                 {smallest:.3}, scaled to a unit diagonal). "
            )?;
        }
        write!(
            f,
            "The Lagrangian is kinetic minus potential energy, and inertias, metrics and second moments of mass must be \
             positive definite; if a rigid body is stated by its second moments J, this applies to I = tr(J) Id - J"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::KineticWarning;
    use nalgebra::{Matrix2, Matrix3, SMatrix};

    #[test]
    fn definite_forms_are_told_from_others() {
        let judged = |m: Matrix3<f64>| KineticWarning::of(&m, 3);
        let diagonal = |a, b, c| Matrix3::from_diagonal(&nalgebra::Vector3::new(a, b, c));
        assert_eq!(judged(diagonal(2.0, 2.0, 1.0)), None);
        // Different units: twenty orders of magnitude.
        assert_eq!(judged(diagonal(1e-10, 1.0, 1e10)), None);
        let counts = |m| judged(m).map(|w| (w.negative, w.vanishing));
        assert_eq!(counts(diagonal(-2.0, -2.0, -1.0)), Some((3, 0)));
        assert_eq!(counts(diagonal(2.0, -1e-9, 1.0)), Some((1, 0)));
        assert_eq!(counts(diagonal(2.0, 0.0, 1.0)), Some((0, 1)));
        assert_eq!(counts(diagonal(0.0, 0.0, 0.0)), Some((0, 3)));
        assert_eq!(counts(diagonal(2.0, f64::NAN, 1.0)), Some((0, 3)));
        // A form of rank one, and a form that is indefinite only because of its coupling.
        let v = nalgebra::Vector3::new(0.3, -1.2, 0.7);
        assert_eq!(counts(v * v.transpose()), Some((0, 2)));
        let coupled = Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 5.0);
        assert_eq!(counts(coupled), Some((1, 0)));
        let off = Matrix2::new(0.0, 3.0, 3.0, 0.0);
        let found = KineticWarning::of(&off, 2).map(|w| (w.negative, w.vanishing));
        assert_eq!(found, Some((1, 0)));
    }

    #[test]
    fn only_the_leading_part_counts() {
        let mut form = SMatrix::<f64, 6, 6>::zeros();
        for i in 0..6 {
            for j in 0..6 {
                form[(i, j)] = if i == j {
                    2.0
                } else {
                    1.0 / (1 + i + j) as f64
                };
            }
        }
        form[(5, 5)] = -1.0;
        assert_eq!(KineticWarning::of(&form, 5), None);
        assert_eq!(KineticWarning::of(&form, 6).map(|w| w.negative), Some(1));
    }

    #[test]
    fn words_name_the_convention() {
        let negative = KineticWarning::of(&(-Matrix3::<f64>::identity()), 3);
        let text = negative.map_or_else(String::new, |w| w.to_string());
        assert!(
            text.contains("is negative") && text.contains("this applies to I = tr(J) Id - J"),
            "{text}"
        );
        let flat = KineticWarning::of(&Matrix3::<f64>::zeros(), 3);
        let text = flat.map_or_else(String::new, |w| w.to_string());
        assert!(
            text.contains("degenerate") && text.contains("3 of 3"),
            "{text}"
        );
    }
}
