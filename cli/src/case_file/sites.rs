//! Site data: what one value of a case says at one site. Numbers are the same at every site, texts
//! are expressions in the label, the number of sites and the numbers of the case, and lists have an
//! element for each site.

use super::value::number;
use clebsch::card::{Field, Kind};
use clebsch_core::lattice::value::SiteData;
use toml::de::{DeTable, DeValue};

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

pub(super) type Numbers<'a> = dyn Fn(&str) -> Option<f64> + 'a;

/// The numbers that expressions may hold: parameters of the case that are numbers or expressions of others,
/// and its step.
pub(super) fn numbers(top: &DeTable<'_>, parameters: Option<&DeTable<'_>>) -> Vec<(String, f64)> {
    let step = top.get("h").map(|v| ("h".to_owned(), v));
    let stated = parameters.into_iter().flatten();
    let stated = stated.map(|(k, v)| (k.get_ref().to_string(), v));
    let all: Vec<_> = step.into_iter().chain(stated).collect();
    let plain = all
        .iter()
        .filter_map(|(key, value)| Some((key.clone(), number(value.get_ref()).ok()?)));
    let mut known: Vec<(String, f64)> = plain.collect();
    let mut rest: Vec<(String, SiteData)> = all
        .iter()
        .filter_map(|(key, value)| {
            let data = SiteData::read(value.get_ref().as_str()?).ok()?;
            Some((key.clone(), data))
        })
        .collect();
    // Until none is found any more: others are of the site, and are read there.
    loop {
        let before = known.len();
        rest.retain(|(key, data)| {
            let of = |name: &str| known.iter().find(|(own, _)| own == name).map(|(_, x)| *x);
            let value = data.value(&of).ok().filter(|x| x.is_finite());
            known.extend(value.map(|x| (key.clone(), x)));
            value.is_none()
        });
        if known.len() == before {
            return known;
        }
    }
}

/// What expressions read.
const READS: &str = ": an expression of a site reads its label, the number of sites, and numbers of the case that are the same at \
                     all sites";

/// The value as TOML, texts in it evaluated.
pub(super) fn plain(value: &DeValue<'_>, of: &Numbers<'_>) -> Result<String, String> {
    match value {
        DeValue::String(text) => {
            let value = SiteData::read(text).and_then(|data| data.value(of));
            let value = value.map_err(|why| format!("\"{text}\": {why}"))?;
            Ok(spelt(value))
        }
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
        other => Ok(spelt(number(other)?)),
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
        return plain(value, of);
    };
    if !is_list_of_sites(site.field, value) {
        return plain(value, of);
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
        Some(one) => plain(one.get_ref(), of).map_err(|why| format!("at {}, {why}", site.named)),
        None => plain(value, of),
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
        Kind::Rotation if field.rows == 3 => match depth {
            2 => inner == Some(4),
            d => d >= 3,
        },
        Kind::Diagonal => depth >= 3 || (depth == 2 && lengths(value) != field.rows),
        _ if field.cols == 1 => depth >= 2,
        _ => depth >= 3,
    }
}

fn depth(value: &DeValue<'_>) -> usize {
    match value {
        DeValue::Array(list) => 1 + list.first().map_or(0, |v| depth(v.get_ref())),
        _ => 0,
    }
}
