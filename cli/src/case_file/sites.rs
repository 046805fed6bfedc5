//! Site data: the value of a case at one site. A number is the same at every site. A text is an expression in
//! the label, the number of sites and the numbers of the case. A list has an element for each site.

use super::attitude;
use super::names;
use super::value::{Numbers, number};
use clebsch::card::{Field, Kind};
use toml::Spanned;
use toml::de::DeValue;

/// A field at one of its sites, whose value is requested.
pub(super) struct Site<'a> {
    pub field: &'a Field,
    /// Which of the sites, counted from 0.
    pub place: usize,
    /// How many sites there are.
    pub count: usize,
    /// The index and count among the sites without a prescribed value. A list may omit the other sites.
    pub moving: Option<(usize, usize)>,
}

/// The reason why a part of a value cannot be evaluated; `None` if all parts can.
pub(super) fn unvalued(value: &DeValue<'_>, of: &Numbers<'_>) -> Option<String> {
    match value {
        // A number that is not finite is reported for its site.
        DeValue::String(text) => names::value(text, of).err(),
        DeValue::Array(list) => list.iter().find_map(|v| unvalued(v.get_ref(), of)),
        DeValue::Table(table) => table.iter().find_map(|(_, v)| unvalued(v.get_ref(), of)),
        other => number(other, of).err(),
    }
}

/// The value at one site, and whether it is an element of a list.
pub(super) fn at<'v, 'i>(
    site: &Site<'_>,
    value: &'v Spanned<DeValue<'i>>,
) -> Result<(&'v Spanned<DeValue<'i>>, bool), String> {
    let list = value.get_ref().as_array();
    let list = list.filter(|_| is_list_of_sites(site.field, value.get_ref()));
    let Some(list) = list else {
        return Ok((value, false));
    };
    let place = match site.moving {
        Some((place, count)) if list.len() == count => place,
        _ if list.len() == site.count => site.place,
        _ => {
            return Err(format!(
                "a list needs one value for each of the {} sites; this list has {}",
                site.count,
                list.len()
            ));
        }
    };
    Ok(match list.get(place) {
        Some(one) => (one, true),
        None => (value, false),
    })
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
            2 => {
                inner == Some(4)
                    && !(field.cols == 4 && lengths(value) == 4 && attitude::is_left_factor(value))
            }
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
