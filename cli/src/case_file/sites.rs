//! Site data: what one value of a case says at one site. Numbers are the same at every site, texts
//! are expressions in the label, the number of sites and the numbers of the case, and lists have an
//! element for each site.

use super::attitude;
use super::scope;
use super::value::{Numbers, number, numbers};
use clebsch::card::{Field, Kind};
use toml::de::DeValue;

/// Of which field a value is asked, at which of its sites.
pub(super) struct Site<'a> {
    pub field: &'a Field,
    /// Which of the sites, counted from 0.
    pub place: usize,
    /// How many sites there are.
    pub count: usize,
    /// The same among the sites that move, where a list may leave the others out.
    pub moving: Option<(usize, usize)>,
    /// Which site it is, as a reader is told: `i = 3`.
    pub named: &'a str,
}

/// What expressions read.
const READS: &str = ": an expression of a site reads its label, the number of sites, and numbers of the case that are the same at \
                     all sites";

/// The value as TOML, texts in it evaluated.
pub(super) fn plain(value: &DeValue<'_>, of: &Numbers<'_>) -> Result<String, String> {
    match value {
        // What is no finite number is told with its site, where the case is read.
        DeValue::String(text) => Ok(spelt(scope::value(text, of)?)),
        DeValue::Array(list) => {
            let each = list.iter().map(|v| plain(v.get_ref(), of));
            let each: Result<Vec<String>, String> = each.collect();
            Ok(format!("[{}]", each?.join(", ")))
        }
        DeValue::Table(table) => {
            let each = table.iter().map(|(key, v)| {
                let text = plain(v.get_ref(), of)?;
                Ok(format!("{} = {text}", key.get_ref()))
            });
            let each: Result<Vec<String>, String> = each.collect();
            Ok(format!("{{ {} }}", each?.join(", ")))
        }
        other => Ok(spelt(number(other, of)?)),
    }
}

/// The value of a field that belongs to one site or to none, as TOML: an element of a group by its numbers.
pub(super) fn of_field(
    field: &Field,
    value: &DeValue<'_>,
    of: &Numbers<'_>,
) -> Result<String, String> {
    match field.kind {
        Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion => {
            Ok(by_rows(field, &numbers(field, value, of)?))
        }
        // The inertia in the place of second moments.
        _ if value.as_table().is_some_and(|t| !t.contains_key("I")) => {
            numbers(field, value, of).map(|all| by_rows(field, &all))
        }
        _ => plain(value, of),
    }
}

/// Numbers as TOML, row by row.
fn by_rows(field: &Field, all: &[f64]) -> String {
    let list = |row: &[f64]| {
        let each: Vec<String> = row.iter().map(|x| spelt(*x)).collect();
        format!("[{}]", each.join(", "))
    };
    match field.cols {
        1 => list(all),
        cols => {
            let rows: Vec<String> = all.chunks(cols).map(list).collect();
            format!("[{}]", rows.join(", "))
        }
    }
}

/// A number as TOML reads it back.
pub(super) fn spelt(value: f64) -> String {
    match value {
        v if v.is_nan() => "nan".to_owned(),
        v if v.is_infinite() => if v > 0.0 { "inf" } else { "-inf" }.to_owned(),
        v => format!("{v:?}"),
    }
}

/// The value at one site.
pub(super) fn at(site: &Site<'_>, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<String, String> {
    found(site, value, of).map_err(|why| match why.ends_with("has no value here") {
        true => format!("{why}{READS}"),
        false => why,
    })
}

fn found(site: &Site<'_>, value: &DeValue<'_>, of: &Numbers<'_>) -> Result<String, String> {
    let DeValue::Array(list) = value else {
        return of_field(site.field, value, of);
    };
    if !is_list_of_sites(site.field, value) {
        return of_field(site.field, value, of);
    }
    let place = match site.moving {
        Some((place, count)) if list.len() == count => place,
        _ => site.place,
    };
    let fits = list.len() == site.count || site.moving.is_some_and(|(_, n)| list.len() == n);
    if !fits {
        return Err(format!(
            "a list has a value for each of the {} sites, and this one has {}",
            site.count,
            list.len()
        ));
    }
    match list.get(place) {
        Some(one) => of_field(site.field, one.get_ref(), of)
            .map_err(|why| format!("at {}, {why}", site.named)),
        None => of_field(site.field, value, of),
    }
}

/// Whether a value is a list with an element for each site rather than the value of all sites.
fn is_list_of_sites(field: &Field, value: &DeValue<'_>) -> bool {
    let depth = depth(value);
    let lengths = |v: &DeValue<'_>| v.as_array().map_or(0, |l| l.len());
    let inner = value
        .as_array()
        .and_then(|l| l.first().map(|f| lengths(f.get_ref())));
    match field.kind {
        _ if field.count() == 1 => depth >= 1,
        Kind::Rotation | Kind::UnitQuaternion | Kind::RigidMotion if first_is_table(value) => true,
        Kind::Rotation if field.rows == 2 => depth == 1 || depth >= 3,
        Kind::Rotation if field.rows == 3 => match depth {
            2 => inner == Some(4),
            d => d >= 3,
        },
        Kind::UnitQuaternion => match depth {
            2 => inner == Some(4) && !(field.cols == 4 && attitude::is_left_factor(value)),
            d => d >= 3,
        },
        Kind::Diagonal => depth >= 3 || (depth == 2 && lengths(value) != field.rows),
        _ if field.cols == 1 => depth >= 2,
        _ => depth >= 3,
    }
}

fn first_is_table(value: &DeValue<'_>) -> bool {
    let first = value.as_array().and_then(|list| list.first());
    first.is_some_and(|one| one.get_ref().is_table())
}

fn depth(value: &DeValue<'_>) -> usize {
    match value {
        DeValue::Array(list) => 1 + list.first().map_or(0, |v| depth(v.get_ref())),
        _ => 0,
    }
}
