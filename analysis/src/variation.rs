//! The second variation at a critical point, and the verdict that it gives.
//!
//! The Hessian of the energy with multipliers acts on directions that keep the conserved quantities. If it is definite
//! there, apart from directions of symmetry, the relative equilibrium is stable (the energy-Casimir and energy-momentum
//! methods: Holm, Marsden, Ratiu and Weinstein, Physics Reports 123, 1985).

use crate::equilibrium::EquilibriumError;
use crate::error::{self, Invalid};
use crate::flow::Energy;
use crate::kkt::{Kkt, Point};
use crate::singular::Singular;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The largest eigenvalue that counts as zero, relative to the largest entry of the Hessian. Near a fold, an eigenvalue
/// is as uncertain as the square root of the residual.
pub const NULL: f64 = 1e-8;

/// The relative threshold for the rank of the gradients and of the directions of symmetry.
const RANK: f64 = 1e-9;

/// How much of a null direction may lie outside the directions of symmetry, as the sine of an angle.
const OUTSIDE: f64 = 1e-4;

/// The kind of a critical point by its second variation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Definiteness {
    /// Positive definite, or no directions at all. The point is stable, also for a potential energy.
    Minimum,
    /// Negative definite. The point is stable if the energy is a Hamiltonian, and not if it is a potential.
    Maximum,
    /// Indefinite. The point is unstable for a potential. For a Hamiltonian, linearisation has to decide.
    Saddle {
        /// The number of negative directions.
        negative: usize,
        /// The number of positive directions.
        positive: usize,
    },
    /// Some directions outside the symmetries have eigenvalue zero, so that higher derivatives decide.
    Degenerate {
        /// The number of these directions.
        null: usize,
        /// The number of negative directions.
        negative: usize,
        /// The number of positive directions.
        positive: usize,
    },
}

impl Definiteness {
    /// Whether the second variation is definite: a relative equilibrium with this Hamiltonian is stable.
    #[must_use]
    pub fn is_definite(self) -> bool {
        matches!(self, Self::Minimum | Self::Maximum)
    }
}

/// The second variation on the directions that keep the conserved quantities, without null directions of symmetry.
#[derive(Clone, Debug)]
pub struct Variation {
    /// Its eigenvalues in ascending order, k numbers.
    pub eigenvalues: Vec<f64>,
    /// Unit eigenvectors as columns in local coordinates, n x k.
    pub directions: DMatrix<f64>,
    /// The number of null directions that were left out because they are symmetries.
    pub symmetric: usize,
    /// The number of negative eigenvalues.
    pub negative: usize,
    /// The verdict.
    pub definiteness: Definiteness,
}

/// The second variation at a point.
pub(crate) fn variation<E: Energy>(
    kkt: &Kkt<'_, E>,
    at: &Point<E::State>,
) -> Result<Variation, EquilibriumError<E::Error>> {
    let n = kkt.energy.dimension();
    let hessian = kkt.second(at)?;
    let gradients = kkt.first(&at.state, at.p)?.gradients;
    let kernel = Singular::new(&gradients).kernel(RANK);
    let (mut values, mut vectors) = symmetric_eigen(&(kernel.tr_mul(&hessian) * &kernel))?;
    vectors = &kernel * vectors;
    let least = NULL * hessian.amax();
    let null: Vec<usize> = (0..values.len())
        .filter(|&i| values[i].abs() <= least)
        .collect();
    let symmetries = kkt.energy.symmetries(&at.state);
    error::matrix("matrix of symmetries", &symmetries, (n, symmetries.ncols()))?;
    let mut symmetric = 0;
    if !null.is_empty() && symmetries.ncols() > 0 {
        // Cosines of the angles between the null space and the directions of symmetry.
        let image = Singular::new(&symmetries).image(RANK);
        let null_space = vectors.select_columns(&null);
        let angles = Singular::new(&image.tr_mul(&null_space));
        symmetric = angles
            .values
            .iter()
            .filter(|&&c| c * c >= 1.0 - OUTSIDE * OUTSIDE)
            .count();
        let rest = &null_space * angles.v.columns(symmetric, null.len() - symmetric);
        let kept: Vec<usize> = (0..values.len()).filter(|i| !null.contains(i)).collect();
        let below = kept.iter().filter(|&&i| values[i] < 0.0).count();
        let mut columns: Vec<DVector<f64>> = kept
            .iter()
            .map(|&i| vectors.column(i).into_owned())
            .collect();
        let mut kept_values: Vec<f64> = kept.iter().map(|&i| values[i]).collect();
        for column in rest.column_iter() {
            columns.insert(below, column.into_owned());
            kept_values.insert(below, column.dot(&(&hessian * column)));
        }
        values = kept_values;
        vectors = match columns.is_empty() {
            true => DMatrix::zeros(n, 0),
            false => DMatrix::from_columns(&columns),
        };
    }
    let negative = values.iter().filter(|&&x| x < -least).count();
    let positive = values.iter().filter(|&&x| x > least).count();
    let definiteness = match values.len() - negative - positive {
        0 if negative == 0 => Definiteness::Minimum,
        0 if positive == 0 => Definiteness::Maximum,
        0 => Definiteness::Saddle { negative, positive },
        null => Definiteness::Degenerate {
            null,
            negative,
            positive,
        },
    };
    Ok(Variation {
        eigenvalues: values.into_iter().map(|x| x * kkt.unit).collect(),
        directions: vectors,
        symmetric,
        negative,
        definiteness,
    })
}

/// Eigenvalues of a symmetric matrix in ascending order, with eigenvectors as columns.
fn symmetric_eigen(a: &DMatrix<f64>) -> Result<(Vec<f64>, DMatrix<f64>), Invalid> {
    let n = a.nrows();
    let scale = a.amax();
    if n == 0 || scale == 0.0 {
        return Ok((vec![0.0; n], DMatrix::identity(n, n)));
    }
    let scaled = (a + a.transpose()) * (0.5 / scale);
    let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, 100 * n + 100);
    let eigen = eigen.ok_or(Invalid::NotFinite {
        what: "second variation",
    })?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order
        .iter()
        .map(|&i| scale * eigen.eigenvalues[i])
        .collect();
    Ok((values, eigen.eigenvectors.select_columns(&order)))
}
