//! The initial positions of the particles of a fluid: `{ lattice = "brick", jitter = 0.1, seed = 1 }`.
//! Takes the table and the domain; gives `count` positions in it.

use super::scope::Scope;
use super::space::Space;
use clebsch::mesh::Domain;
use clebsch::mesh::placement::{self, Jitter};
use toml::de::DeTable;

/// By default, the number of times that random positions are moved to the centres of their cells.
const SWEEPS: u64 = 20;

/// If clebsch chooses the columns of a lattice, the largest aspect ratio of its cells.
const LONGEST: f64 = 2.0;

/// The positions of `count` particles, one after the other.
pub(super) fn places(
    table: &DeTable<'_>,
    space: &Space,
    count: usize,
    scope: &Scope,
) -> Result<Vec<f64>, String> {
    const KEYS: [&str; 5] = ["lattice", "jitter", "seed", "columns", "sweeps"];
    if let Some((key, _)) = table
        .iter()
        .find(|(k, _)| !KEYS.contains(&k.get_ref().as_ref()))
    {
        return Err(format!(
            "unknown key `{}`; known are {}",
            key.get_ref(),
            KEYS.join(", ")
        ));
    }
    let kinds = "\"brick\", \"square\", \"hex\" or \"random\"";
    let kind = table.get("lattice").and_then(|v| v.get_ref().as_str());
    let kind = kind.ok_or_else(|| format!("expected {{ lattice = {kinds} }}"))?;
    for (key, of) in [
        ("sweeps", ["random"].as_slice()),
        ("columns", &["brick", "square", "hex"]),
    ] {
        if table.contains_key(key) && !of.contains(&kind) && kinds.contains(kind) {
            return Err(format!(
                "{key}: lattice = \"{kind}\" has no such key; remove it"
            ));
        }
    }
    let size = match table.get("jitter") {
        None => 0.0,
        Some(v) => scope
            .read(v.get_ref())
            .map_err(|why| format!("jitter: {why}"))?,
    };
    let seed = whole(table, "seed", scope)?.unwrap_or(1);
    let jitter = Jitter { size, seed };
    let mut all = match space.lengths.as_slice() {
        // A row of cells; its height is the length of a cell.
        [length] if kind == "square" => {
            #[allow(clippy::cast_precision_loss)]
            let domain = Domain::torus([*length, *length / count.max(1) as f64]);
            let row = placement::lattice(&domain, [count, 1], false, jitter);
            row.iter()
                .map(|x| x.x + centred(*length, count))
                .collect::<Vec<f64>>()
        }
        [_] => {
            return Err(
                "in one dimension, particles start on { lattice = \"square\" }, with jitter"
                    .to_owned(),
            );
        }
        [width, height] => {
            let domain = Domain::torus([*width, *height]);
            let columns = whole(table, "columns", scope)?;
            let columns = columns
                .and_then(|n| usize::try_from(n).ok())
                .filter(|n| *n > 0);
            let places = match kind {
                "brick" | "square" => {
                    let columns = match columns {
                        Some(columns) => columns,
                        None => even(count, width / height, kind)?,
                    };
                    if !count.is_multiple_of(columns) {
                        return Err(format!("{columns} columns do not divide {count} particles"));
                    }
                    let shape = [columns, count / columns];
                    let mut all = placement::lattice(&domain, shape, kind == "brick", jitter);
                    if kind == "square" {
                        all.iter_mut().for_each(|x| x.x += centred(*width, columns));
                    }
                    all
                }
                "hex" => hexagons(&domain, count, columns, jitter)?,
                "random" => {
                    let sweeps = whole(table, "sweeps", scope)?.unwrap_or(SWEEPS);
                    let sweeps = usize::try_from(sweeps).unwrap_or(usize::MAX);
                    let found = placement::scattered(&domain, count, sweeps, seed);
                    found.map_err(|e| e.to_string())?
                }
                other => {
                    return Err(format!(
                        "the lattice \"{other}\" does not exist: write {kinds}"
                    ));
                }
            };
            places.iter().flat_map(|x| [x.x, x.y]).collect()
        }
        _ => return Err("lattices exist in one and two dimensions only".to_owned()),
    };
    // Jitter must not move a particle beyond a wall.
    let lengths = space.lengths.iter().zip(&space.walls).cycle();
    for (x, (length, solid)) in all.iter_mut().zip(lengths) {
        if *solid {
            *x = x.clamp(0.0, *length);
        }
    }
    Ok(all)
}

fn whole(table: &DeTable<'_>, key: &str, scope: &Scope) -> Result<Option<u64>, String> {
    let Some(value) = table.get(key) else {
        return Ok(None);
    };
    let read = scope.whole(value.get_ref());
    match read.map_err(|why| format!("{key}: {why}"))? {
        Some(n) => Ok(Some(n)),
        None => Err(format!("{key}: expected a whole number, 0 or more")),
    }
}

/// The offset from the start of a row, at a quarter of a column, to its centred position.
#[allow(clippy::cast_precision_loss)]
fn centred(width: f64, columns: usize) -> f64 {
    0.25 * width / columns.max(1) as f64
}

/// How far the cells of a lattice are from squares: the logarithm of the ratio of the longer to the shorter side.
#[allow(clippy::cast_precision_loss)]
fn off([columns, rows]: [usize; 2], aspect: f64) -> f64 {
    (columns as f64 / rows as f64 / aspect).ln().abs()
}

/// The divisor of `count` whose lattice has the most nearly square cells, if the longer side is at most
/// [`LONGEST`] times the shorter.
fn even(count: usize, aspect: f64, kind: &str) -> Result<usize, String> {
    let divisors = (1..=count).filter(|n| count.is_multiple_of(*n));
    let shapes = divisors.map(|columns| [columns, count / columns]);
    let best = shapes.min_by(|a, b| off(*a, aspect).total_cmp(&off(*b, aspect)));
    match best {
        Some(shape) if !is_even(shape, aspect) => Err(uneven(count, kind, filling(count, aspect))),
        best => Ok(best.map_or(1, |[columns, _]| columns)),
    }
}

fn is_even(shape: [usize; 2], aspect: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    off(shape, aspect) <= LONGEST.ln() + ROUNDING
}

/// Numbers of particles near `count` that fill a domain of this aspect evenly.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss
)]
fn filling(count: usize, aspect: f64) -> Vec<usize> {
    let whole = |x: f64| x.round().max(1.0) as usize;
    let around = |n: usize| n.saturating_sub(3).max(1)..=n.saturating_add(3);
    let rows = whole((count as f64 / aspect).sqrt());
    let columns = whole((count as f64 * aspect).sqrt());
    let by_rows = around(rows).flat_map(|rows| {
        let columns = [count as f64 / rows as f64, rows as f64 * aspect].map(whole);
        columns.map(|columns| [columns, rows])
    });
    let by_columns = around(columns).map(|columns| [columns, whole(columns as f64 / aspect)]);
    let even = by_rows
        .chain(by_columns)
        .filter(|shape| is_even(*shape, aspect));
    even.map(|[columns, rows]| columns.saturating_mul(rows))
        .collect()
}

/// The message of a number of particles that does not fill the domain, with the nearest of the numbers that do.
fn uneven(count: usize, kind: &str, mut filling: Vec<usize>) -> String {
    const LISTED: usize = 4;
    filling.sort_by_key(|n| (n.abs_diff(count), *n));
    filling.dedup();
    filling.truncate(LISTED);
    filling.sort_unstable();
    let known: Vec<String> = filling.iter().map(usize::to_string).collect();
    let take = match known.split_last() {
        None => String::new(),
        Some((last, [])) => format!("use {last} particles, or "),
        Some((last, others)) => format!("use {} or {last} particles, or ", others.join(", ")),
    };
    format!(
        "{count} particles do not fill the domain evenly with lattice = \"{kind}\"; {take}lattice = \"random\", which accepts \
         any number"
    )
}

/// A hexagonal lattice. Only some numbers of hexagons fill a domain.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss
)]
fn hexagons(
    domain: &Domain<2>,
    count: usize,
    columns: Option<usize>,
    jitter: Jitter,
) -> Result<Vec<clebsch::nalgebra::SVector<f64, 2>>, String> {
    let [width, height] = domain.lengths;
    let near = (count as f64 * width / height * 0.75_f64.sqrt())
        .sqrt()
        .round() as usize;
    let range = match columns {
        Some(columns) => columns..=columns,
        None => near.saturating_sub(3).max(1)..=near + 3,
    };
    let all: Vec<_> = range
        .map(|n| placement::hexagonal(domain, n, jitter))
        .collect();
    let numbers: Vec<usize> = all.iter().map(Vec::len).collect();
    let found = all.into_iter().find(|places| places.len() == count);
    found.ok_or_else(|| uneven(count, "hex", numbers))
}
