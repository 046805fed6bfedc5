//! The inertia of a body instead of its second moments: principal moments, or the matrix I instead of J.
//! Takes a table of a case file; gives J with `I = tr(J) Id - J`.

use super::value::{Numbers, numbers};
use crate::words::number;
use clebsch::card::{Field, Kind};
use toml::Spanned;
use toml::de::DeValue;

/// The key under which a case may give the inertia instead of the field: `I` for `J`, `I2` for `J2`. `None` if
/// the field is not a matrix of second moments, or if `name` does not start with `J`.
pub(super) fn key_of(field: &Field, name: &str) -> Option<String> {
    if field.kind != Kind::SecondMoments {
        return None;
    }
    Some(format!("I{}", name.strip_prefix('J')?))
}

/// The inertia in a value of second moments: `{ I = ... }`.
pub(super) fn inside<'a, 'i>(
    field: &Field,
    value: &'a DeValue<'i>,
) -> Option<&'a Spanned<DeValue<'i>>> {
    let inner = value
        .as_table()
        .filter(|_| field.kind == Kind::SecondMoments)?;
    inner.get("I").filter(|_| inner.len() == 1)
}

/// The field of the inertia that replaces second moments: a matrix, or its diagonal.
pub(super) fn field(field: &Field) -> Field {
    Field {
        kind: Kind::Diagonal,
        ..*field
    }
}

/// The reason why these principal moments are impossible for a body in space; `None` if the matrix is not
/// diagonal.
fn impossible(entries: &[f64], n: usize) -> Option<String> {
    let at = |i: usize| entries.get(i * n + i).copied().unwrap_or_default();
    let is_diagonal = entries
        .iter()
        .enumerate()
        .all(|(k, x)| k / n == k % n || *x == 0.0);
    if n != 3 || !is_diagonal {
        return None;
    }
    (0..3).find_map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (own, sum) = (at(i), at(j) + at(k));
        let (first, second) = (j.min(k) + 1, j.max(k) + 1);
        (own > sum * (1.0 + 4.0 * f64::EPSILON)).then(|| {
            format!(
                "moments of inertia must satisfy I{} <= I{first} + I{second}; {own} > {}",
                i + 1,
                number::short(sum)
            )
        })
    })
}

/// J of an inertia given by its principal moments or in full: `tr(I)/2 Id - I`.
pub(super) fn second_moments(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<Vec<f64>, String> {
    let inertia = self::field(field);
    let wanted = "expected the principal moments of inertia [a, b, c] or the matrix [[..], ..]";
    let entries = numbers(&inertia, value, of).map_err(|message| {
        // A message about a single entry is unchanged. A message about the whole value asks for the inertia instead.
        match message.split_once(", found ") {
            Some((_, found)) => format!("{wanted}, found {found}"),
            None => message,
        }
    })?;
    of_entries(field, &entries)
}

/// J of an inertia given by the entries of its matrix.
pub(super) fn of_entries(field: &Field, entries: &[f64]) -> Result<Vec<f64>, String> {
    let n = field.rows;
    for i in 0..n {
        for j in i + 1..n {
            let (upper, lower) = (entries[i * n + j], entries[j * n + i]);
            let rounding = 4.0 * f64::EPSILON * upper.abs().max(lower.abs());
            if (upper - lower).abs() > rounding {
                let (row, column) = (i + 1, j + 1);
                return Err(format!(
                    "not symmetric: entry ({row}, {column}) is {upper} but ({column}, {row}) is {lower}"
                ));
            }
        }
    }
    if let Some(why) = impossible(entries, n) {
        return Err(why);
    }
    let half: f64 = (0..n).map(|i| 0.5 * entries[i * n + i]).sum();
    Ok(entries
        .iter()
        .enumerate()
        .map(|(k, entry)| match k / n == k % n {
            true => half - entry,
            false => -entry,
        })
        .collect())
}
