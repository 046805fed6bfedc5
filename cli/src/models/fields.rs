//! The fields of a card: which are momenta, and sample values that every model accepts.

use clebsch::card::{Card, Field, Kind};

/// Whether it is the momentum of a configuration.
pub(crate) fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Whether bodies rotate: square momenta are skew.
pub(crate) fn turns(card: &Card) -> bool {
    card.initial.iter().any(|f| f.kind == Kind::Rotation)
}

/// An entry of the sample value of a field without labels' expressions.
pub(crate) fn sample_entry(field: &Field, turned: bool, i: usize, j: usize) -> f64 {
    let all = sample_values(field, turned);
    all.get(i * field.cols + j).copied().unwrap_or(0.0)
}

/// Sample values of a field. If `turned`, square momenta are skew.
pub(crate) fn sample_values(field: &Field, turned: bool) -> Vec<f64> {
    let (rows, cols) = (field.rows, field.cols);
    let square = rows == cols && rows > 1;
    let entry = |i: usize, j: usize| match field.kind {
        Kind::UnitQuaternion if cols == 1 => f64::from(u8::from(i == 0)),
        Kind::SecondMoments | Kind::Diagonal | Kind::Symmetric if i == j => (i + 1) as f64,
        Kind::Matrix | Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion if square => {
            f64::from(u8::from(i == j))
        }
        Kind::SecondMoments | Kind::Diagonal | Kind::Symmetric => 0.0,
        Kind::Skew => skew(i, j),
        Kind::BodyMomentum | Kind::SpatialMomentum if square && turned => 0.1 * skew(i, j),
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum => {
            0.1 / (1 + i + cols * j) as f64
        }
        _ => 1.0 / (1 + i * cols + j) as f64,
    };
    (0..rows)
        .flat_map(|i| (0..cols).map(move |j| (i, j)))
        .map(|(i, j)| entry(i, j))
        .collect()
}

fn skew(i: usize, j: usize) -> f64 {
    let size = 1.0 / (i + j).max(1) as f64;
    match i.cmp(&j) {
        std::cmp::Ordering::Less => -size,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => size,
    }
}
