//! Names of parameters, of local coordinates and of observed numbers. Takes a card; gives the names as `--set` and
//! tables write them.

use crate::words::columns::aligned;
use crate::words::number::decimals;
use clebsch::card::{Card, Field, Kind};
use clebsch::derivatives::Gradient;

/// An entry of a field that can change alone, with its mirror image if the kind requires one.
pub(crate) struct Entry {
    /// Its name, such as `J.12`.
    pub name: String,
    /// Its places in the row-major field, each with a sign.
    pub places: Vec<(usize, f64)>,
}

/// The entries of a parameter that can change alone.
pub(crate) fn entries(field: &Field) -> Vec<Entry> {
    let (rows, cols) = (field.rows, field.cols);
    let gap = if rows > 9 || cols > 9 { "_" } else { "" };
    let mut all = Vec::new();
    for i in 0..rows {
        for j in 0..cols {
            let name = match (rows * cols, cols) {
                (1, _) => field.ascii.to_owned(),
                (_, 1) => format!("{}.{}", field.ascii, i + 1),
                _ => format!("{}.{}{gap}{}", field.ascii, i + 1, j + 1),
            };
            let (here, mirror) = (i * cols + j, j * cols + i);
            let places = match field.kind {
                Kind::Symmetric | Kind::SecondMoments if i < j => vec![(here, 1.0), (mirror, 1.0)],
                Kind::Skew if i < j => vec![(here, 1.0), (mirror, -1.0)],
                Kind::Symmetric | Kind::SecondMoments if i > j => continue,
                Kind::Skew => continue,
                Kind::Diagonal if i != j => continue,
                _ => vec![(here, 1.0)],
            };
            all.push(Entry { name, places });
        }
    }
    all
}

/// The derivative of a cost with respect to each entry of each parameter that can change alone.
pub(crate) fn of_parameters(card: &Card, gradient: &Gradient) -> Vec<(String, f64)> {
    let fields = card.parameters.iter().zip(&gradient.parameters);
    let each = fields.flat_map(|(field, own)| {
        entries(field).into_iter().map(|entry| {
            let value = |(at, sign): &(usize, f64)| sign * own.get(*at).copied().unwrap_or(0.0);
            (entry.name, entry.places.iter().map(value).sum())
        })
    });
    each.collect()
}

/// The names of the local coordinates: rotations about body axes as `turn_1(Lambda)`, other initial values by entry.
pub(crate) fn local(card: &Card, dimensions: &[usize]) -> Vec<String> {
    let fields = card.initial.iter().zip(dimensions);
    let each = fields.flat_map(|(field, count)| {
        let entries = entries(field);
        let name = |i: usize| match entries.get(i) {
            Some(entry) if entries.len() == *count && !turns(field) => entry.name.clone(),
            _ if field.kind == Kind::RigidMotion && i >= 3 => {
                format!("shift_{}({})", i - 2, field.ascii)
            }
            _ if turns(field) => format!("turn_{}({})", i + 1, field.ascii),
            _ => format!("change_{}({})", i + 1, field.ascii),
        };
        (0..*count).map(name).collect::<Vec<_>>()
    });
    each.collect()
}

/// Whether the local coordinates of an initial value are rotations.
pub(crate) fn turns(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion
    )
}

/// The names of the observables and of the invariants, component by component, as in CSV files.
pub(crate) fn seen(card: &Card) -> Vec<String> {
    clebsch::record::columns(card)
}

/// The rows of such a table, at most.
const SHOWN: usize = 24;

/// A table of initial values before and after, entry by entry.
pub(crate) fn compared(
    card: &Card,
    before: &[Vec<f64>],
    after: &[Vec<f64>],
    width: Option<usize>,
) -> String {
    let mut rows = vec![["", "in the case", "found"].map(str::to_owned).to_vec()];
    for ((field, before), after) in card.initial.iter().zip(before).zip(after) {
        for entry in entries(field) {
            let place = entry.places.first().map_or(0, |(place, _)| *place);
            let number = |of: &[f64]| of.get(place).map_or_else(String::new, |x| decimals(*x, 12));
            rows.push(vec![entry.name, number(before), number(after)]);
        }
    }
    let more = rows.len().saturating_sub(SHOWN + 1);
    rows.truncate(SHOWN + 1);
    let table = aligned(&rows, &[1, 2], width);
    match more {
        0 => table,
        more => format!("{table}... and {more} more, which --json gives\n"),
    }
}
