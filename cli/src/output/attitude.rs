//! Attitudes among the observables of a run. Takes the fields; gives their columns, and matrices for their numbers.

use clebsch::card::Field;
use clebsch::nalgebra::Matrix3;
use std::ops::Range;

/// Observables with their columns.
pub(crate) fn placed(
    fields: &'static [Field],
) -> impl Iterator<Item = (&'static Field, Range<usize>)> {
    let mut from = 0;
    fields.iter().map(move |field| {
        let columns = from..from + field.count();
        from = columns.end;
        (field, columns)
    })
}

/// The matrix body -> space of a rotation or a unit quaternion.
pub(crate) fn matrix(numbers: &[f64]) -> Option<Matrix3<f64>> {
    match *numbers {
        [w, x, y, z] => Some(Matrix3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        )),
        _ if numbers.len() == 9 => Some(Matrix3::from_row_slice(numbers)),
        _ => None,
    }
}
