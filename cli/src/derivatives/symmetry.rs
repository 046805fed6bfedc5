//! Directions of symmetry at a state: translations of all fields, rotations of everything in space, and the direction
//! of the motion. Takes a state; gives columns in local coordinates.
//!
//! A combination of translations and rotations is a symmetry if it leaves the energy of states nearby unchanged.

use crate::derivatives::coordinates::entries;
use crate::derivatives::flow::{State, Steps};
use crate::derivatives::problem::Problem;
use crate::models::fields::is_momentum;
use clebsch::card::{Field, Kind};
use clebsch::derivatives::NoDerivative;
use clebsch::nalgebra::{DMatrix, DVector, SymmetricEigen};
use clebsch_analysis::Flow;

/// The size of displacements of the states nearby.
const NEARBY: f64 = 0.05;

/// The largest change of the energy that counts as none, relative to the largest one.
const NONE: f64 = 1e-9;

/// All directions of symmetry that clebsch finds.
pub(super) fn directions(
    problem: &Problem,
    steps: &Steps,
    energy: usize,
    at: &State,
) -> DMatrix<f64> {
    let n = steps.dimension();
    let mut columns = Vec::new();
    let h = problem.plan.case.h;
    // The motion of a relative equilibrium is a motion along symmetries.
    if let Ok(next) = steps.step(at, h) {
        columns.push(DVector::from_vec(steps.difference(at, &next)));
    }
    if let Ok(found) = rigid(problem, steps, energy, at) {
        columns.extend(found);
    }
    columns.retain(|c: &DVector<f64>| c.len() == n && c.iter().all(|x| x.is_finite()));
    match columns.is_empty() {
        true => DMatrix::zeros(n, 0),
        false => DMatrix::from_columns(&columns),
    }
}

/// Combinations of translations and rotations that keep the energy.
fn rigid(
    problem: &Problem,
    steps: &Steps,
    energy: usize,
    at: &State,
) -> Result<Vec<DVector<f64>>, NoDerivative> {
    let own = candidates(problem, steps, at)?;
    let count = own.len();
    let n = steps.dimension();
    let mut products = DMatrix::zeros(count, count);
    for sample in 0..count + 2 {
        // Any displacements without a pattern will do.
        let by = |i: usize| NEARBY * (1.0 + (i + 1) as f64 * (sample + 1) as f64 * 1.618).sin();
        let near = steps.moved(at, &(0..n).map(by).collect::<Vec<f64>>());
        let point = near.as_ref().map_err(Clone::clone)?;
        let slopes = steps.with(|own| own.conserved(point))?;
        let slope = |j: usize| slopes.entries.get(j * slopes.rows + energy).copied();
        let gradient = DVector::from_fn(n, |j, _| slope(j).unwrap_or(f64::NAN));
        let size = gradient.norm().max(f64::MIN_POSITIVE);
        let row: Vec<f64> = candidates(problem, steps, &near)?
            .iter()
            .map(|c| c.dot(&gradient) / size / c.norm().max(f64::MIN_POSITIVE))
            .collect();
        let row = DVector::from_vec(row);
        if row.len() == count {
            products += &row * row.transpose();
        }
    }
    if count == 0 || !products.iter().all(|x| x.is_finite()) {
        return Ok(Vec::new());
    }
    let eigen = SymmetricEigen::new(products);
    let kept = (0..count).filter(|&i| eigen.eigenvalues[i].abs() <= NONE * NONE);
    let combined = kept.map(|i| {
        let vector = eigen.eigenvectors.column(i);
        let parts = own.iter().zip(vector.iter());
        parts.fold(DVector::zeros(n), |sum: DVector<f64>, (c, w)| {
            sum + c * (*w / c.norm().max(f64::MIN_POSITIVE))
        })
    });
    Ok(combined.collect())
}

/// The part of a direction that belongs to an initial value; `None` if there is none.
type Column<'a> = &'a dyn Fn(&Field, &[f64]) -> Option<Vec<f64>>;

/// Translations along each axis, then rotations about each axis of space.
fn candidates(
    problem: &Problem,
    steps: &Steps,
    at: &State,
) -> Result<Vec<DVector<f64>>, NoDerivative> {
    let point = at.as_ref().map_err(Clone::clone)?;
    let case = &problem.plan.case;
    let (values, dimensions) = steps.with(|own| {
        let values = problem.case_at(case, own, point)?.initial;
        Ok::<_, NoDerivative>((values, own.dimensions()))
    })?;
    let fields = problem.card.initial;
    let n = steps.dimension();
    let whole = |column: Column<'_>| {
        let mut all = Vec::with_capacity(n);
        for ((field, own), count) in fields.iter().zip(&values).zip(&dimensions) {
            let part = column(field, own)?;
            if part.len() != *count {
                return None;
            }
            all.extend(part);
        }
        Some(DVector::from_vec(all))
    };
    let mut columns: Vec<DVector<f64>> = Vec::new();
    let is_position = |f: &Field| matches!(f.kind, Kind::Scalar | Kind::Vector) && !is_momentum(f);
    let largest = fields
        .iter()
        .filter(|f| is_position(f))
        .map(Field::count)
        .max();
    for axis in 0..largest.unwrap_or(0) {
        columns.extend(whole(&|field, own| {
            let moves = is_position(field);
            let one = |i: usize| f64::from(u8::from(moves && i == axis));
            let count = match crate::derivatives::coordinates::turns(field) {
                true if field.kind == Kind::RigidMotion => 6,
                true => 3,
                false => entries(field).len().min(own.len()),
            };
            Some((0..count).map(one).collect())
        }));
    }
    for axis in 0..3 {
        columns.extend(whole(&|field, own| turned(field, own, axis)));
    }
    columns.retain(|c| c.norm() > 0.0);
    Ok(columns)
}

/// The change of a value under a rotation about an axis of space; `None` if clebsch does not know how it turns.
fn turned(field: &Field, own: &[f64], axis: usize) -> Option<Vec<f64>> {
    let unit = |i: usize| f64::from(u8::from(i == axis));
    match (field.kind, own) {
        (Kind::Rotation, m) if m.len() == 9 => Some(m.chunks(3).nth(axis)?.to_vec()),
        (Kind::UnitQuaternion, [w, x, y, z]) => {
            // The axis in the body frame: the row of the rotation matrix.
            let rows = [
                [
                    w * w + x * x - y * y - z * z,
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                [
                    2.0 * (x * y + w * z),
                    w * w - x * x + y * y - z * z,
                    2.0 * (y * z - w * x),
                ],
                [
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    w * w - x * x - y * y + z * z,
                ],
            ];
            Some(rows.get(axis)?.to_vec())
        }
        (Kind::BodyMomentum, m) => Some(vec![0.0; m.len()]),
        (Kind::Vector | Kind::SpatialMomentum | Kind::FieldMomentum, [x, y, z]) => {
            let e = [unit(0), unit(1), unit(2)];
            Some(vec![
                e[1] * z - e[2] * y,
                e[2] * x - e[0] * z,
                e[0] * y - e[1] * x,
            ])
        }
        _ => None,
    }
}
