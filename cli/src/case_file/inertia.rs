//! A body by its inertia, where the model asks for second moments: principal moments or the matrix
//! I in the place of J. Takes a table of a case file; gives J with `I = tr(J) Id - J`.

use super::value::{Numbers, numbers};
use crate::words::number;
use clebsch::card::{Field, Kind};
use std::collections::HashSet;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The key under which the inertia may stand beside the field's own: `I` for `J`, `I2` for `J2`.
/// None where the field is no matrix of second moments, has another letter, or the key is taken.
pub(super) fn key(field: &Field, taken: &Taken<'_>) -> Option<String> {
    key_of(field, field.ascii, taken)
}

/// The same of a field that is given by this name.
pub(super) fn key_of(field: &Field, name: &str, taken: &Taken<'_>) -> Option<String> {
    if field.kind != Kind::SecondMoments {
        return None;
    }
    let key = format!("I{}", name.strip_prefix('J')?);
    (!taken.0.contains(key.as_str())).then_some(key)
}

/// The names of fields of a table that begin as those of inertias do.
pub(super) struct Taken<'a>(HashSet<&'a str>);

impl<'a> Taken<'a> {
    /// Those of these fields, which may be millions.
    pub(super) fn of(fields: &'a [Field]) -> Self {
        let names = fields.iter().map(|field| field.ascii);
        Taken(names.filter(|name| name.starts_with('I')).collect())
    }
}

/// The value of a field, and whether it is its inertia: under its own name, as `J = { I = ... }`,
/// or under the key of its inertia.
pub(super) enum Given<'a, 'i> {
    /// The field itself.
    Own(&'a Spanned<DeValue<'i>>),
    /// Its inertia.
    Inertia(&'a Spanned<DeValue<'i>>),
    /// Both, of which one is too many; the second one.
    Twice(&'a Spanned<DeValue<'i>>),
    /// Neither.
    Missing,
}

/// How a table gives a field by a name: its own, or that of all its copies.
pub(super) fn given<'a, 'i>(
    table: &'a DeTable<'i>,
    field: &Field,
    name: &str,
    fields: &Taken<'_>,
) -> Given<'a, 'i> {
    let own = table.get(name);
    let beside = key_of(field, name, fields).and_then(|key| table.get(key.as_str()));
    let inside = own
        .filter(|_| field.kind == Kind::SecondMoments)
        .and_then(|value| value.get_ref().as_table())
        .filter(|inner| inner.len() == 1)
        .and_then(|inner| inner.get("I"));
    match (own, inside, beside) {
        (Some(_), _, Some(second)) => Given::Twice(second),
        (_, Some(inertia), None) | (None, None, Some(inertia)) => Given::Inertia(inertia),
        (Some(value), None, None) => Given::Own(value),
        (None, _, None) => Given::Missing,
        (None, Some(_), Some(second)) => Given::Twice(second),
    }
}

/// What the key of a given field is called in messages: `I` where it is the inertia that was given.
pub(super) fn shown_key(
    table: &DeTable<'_>,
    field: &Field,
    name: &str,
    fields: &Taken<'_>,
) -> String {
    match given(table, field, name, fields) {
        Given::Inertia(_) if table.contains_key(name) => format!("{name}.I"),
        Given::Inertia(_) => key_of(field, name, fields).unwrap_or_else(|| name.to_owned()),
        Given::Own(_) | Given::Twice(_) | Given::Missing => name.to_owned(),
    }
}

/// What to write for a matrix of second moments besides itself.
pub(super) fn words(field: &Field) -> &'static str {
    match field.kind {
        Kind::SecondMoments => {
            ", or the inertia: { I = [a, b, c] } for principal moments, { I = [[..], ..] } for a matrix"
        }
        _ => "",
    }
}

/// The inertia in the place of a field of second moments: a matrix, or its diagonal.
pub(super) fn field(field: &Field) -> Field {
    Field {
        kind: Kind::Diagonal,
        ..*field
    }
}

/// Why no body in space has these principal moments; nothing of a matrix that is not diagonal.
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
                "moments of inertia obey I{} <= I{first} + I{second}; {own} > {}",
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
        // What is said of one entry stands; of the whole, it is the inertia that was asked for.
        match message.split_once(", found ") {
            Some((_, found)) => format!("{wanted}, found {found}"),
            None => message,
        }
    })?;
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
    if let Some(why) = impossible(&entries, n) {
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
