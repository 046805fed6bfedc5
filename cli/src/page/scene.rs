//! What of a run is seen in space: bodies by their attitude and place, points and chains, profiles of numbers along a
//! line. Takes the samples of a run; gives data for the view, at most [`FRAMES`] frames.

use super::places::{Places, Point};
use crate::output::Finished;
use crate::output::points::Diagonals;
use crate::output::sites::{AtSites, at_sites};
use crate::plots::attitude::{matrix, placed};
use crate::plots::particles::space;
use crate::plots::window::window;
use crate::record::Samples;
use clebsch::card::{Field, Kind};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::ops::Range;

/// Most frames of a page, the last one besides.
pub(super) const FRAMES: usize = 600;

/// Most numbers of all frames together: about two megabytes.
const NUMBERS: usize = 200_000;

/// One thing that is seen, with the columns it is read from.
enum Seen {
    Body {
        name: String,
        turn: Range<usize>,
        place: Place,
    },
    Chain {
        name: String,
        dim: usize,
        columns: Vec<Range<usize>>,
        line: bool,
    },
}

/// Where a body is drawn.
enum Place {
    /// Where no place is known: in a row, by its number.
    Row(usize),
    /// In a homogeneous matrix.
    Within,
    /// At a point, or midway between two.
    At(Point, Point),
}

/// The scene as data; nothing where a model has nothing in space.
pub(super) fn scene(run: &Finished<'_>, samples: &Samples) -> Option<Value> {
    let seen = seen(run);
    if seen.is_empty() {
        return None;
    }
    let columns: Vec<Range<usize>> = seen.iter().flat_map(read).collect();
    let shown = window(samples, &columns);
    let width: usize = columns.iter().map(Range::len).sum();
    let most = (NUMBERS / width.max(1)).clamp(2, FRAMES);
    let stride = shown.count.div_ceil(most).max(1);
    // The end of the run is seen, whatever the stride.
    let last = shown.count.saturating_sub(1);
    let is_shown = |i: usize| i.is_multiple_of(stride) || i == last;
    let rows = shown.record.observables.rows().take(shown.count);
    let rows = rows.enumerate().filter(|(i, _)| is_shown(*i));
    let frames: Vec<&[f64]> = rows.map(|(_, row)| row).collect();
    let times = shown.record.times.iter().take(shown.count).enumerate();
    let times = times.filter(|(i, _)| is_shown(*i)).map(|(_, t)| *t);
    let finite = |x: &f64| if x.is_finite() { *x } else { 0.0 };
    let lengths = space(run.card, run.plan).map(|(space, _)| space.lengths);
    let flat = seen
        .iter()
        .all(|s| matches!(s, Seen::Chain { dim, .. } if *dim < 3));
    Some(json!({
        "times": times.collect::<Vec<f64>>(),
        "flat": flat,
        "box": lengths,
        "bodies": seen.iter().filter_map(|s| body(s, &frames, &finite)).collect::<Vec<_>>(),
        "chains": seen.iter().filter_map(|s| chain(s, &frames, lengths.as_deref(), &finite)).collect::<Vec<_>>(),
    }))
}

/// The columns that a thing is read from.
fn read(seen: &Seen) -> Vec<Range<usize>> {
    match seen {
        Seen::Body { turn, place, .. } => match place {
            Place::At(a, b) => {
                let moving = [a, b].into_iter().filter_map(|p| match p {
                    Point::Moving(columns, _) => Some(columns.clone()),
                    Point::Held(_) => None,
                });
                std::iter::once(turn.clone()).chain(moving).collect()
            }
            _ => vec![turn.clone()],
        },
        Seen::Chain { columns, .. } => columns.clone(),
    }
}

/// Everything in space, in the order of the card.
fn seen(run: &Finished<'_>) -> Vec<Seen> {
    let sites = at_sites(run.card);
    let of_sites: HashSet<usize> = sites
        .iter()
        .flat_map(|q| q.members.iter().map(|(_, c)| c.start))
        .collect();
    let mut out: Vec<Seen> = sites.iter().filter_map(|q| chain_of(q)).collect();
    let diagonals = Diagonals::of(run.card);
    let mut number = 0;
    for q in sites
        .iter()
        .filter(|q| turns(q.field) || is_placed(q.field))
    {
        let places = Places::of((run.card, run.plan), &sites, q);
        for (site, turn) in &q.members {
            let place = match places.as_ref().and_then(|p| p.at(*site)) {
                _ if is_placed(q.field) => Place::Within,
                Some((a, b)) => Place::At(a, b),
                None => {
                    number += 1;
                    Place::Row(number - 1)
                }
            };
            out.push(Seen::Body {
                name: format!("{}_{site}", q.name),
                turn: turn.clone(),
                place,
            });
        }
    }
    let alone = placed(run.card.observables).filter(|(_, c)| !of_sites.contains(&c.start));
    let alone: Vec<(&Field, Range<usize>)> = alone.collect();
    for (i, (field, columns)) in alone.iter().enumerate() {
        let behind = alone.get(i + 1).map(|(f, _)| f.kind);
        let within = is_placed(field);
        if turns(field) || within {
            out.push(Seen::Body {
                name: field.name.to_owned(),
                turn: columns.clone(),
                place: if within {
                    Place::Within
                } else {
                    Place::Row(number)
                },
            });
            number += 1;
        } else if diagonals.leave(field, behind) {
            out.push(Seen::Chain {
                name: field.name.to_owned(),
                dim: field.rows,
                columns: vec![columns.clone()],
                line: false,
            });
        }
    }
    out
}

/// Whether it is an attitude with its place.
fn is_placed(field: &Field) -> bool {
    field.kind == Kind::RigidMotion && field.count() == 16
}

/// Whether it is an attitude in space.
fn turns(field: &Field) -> bool {
    field.kind == Kind::UnitQuaternion || (field.kind == Kind::Rotation && field.count() == 9)
}

/// The points or numbers of a field at sites.
fn chain_of(q: &AtSites<'_>) -> Option<Seen> {
    let dim = q.field.count();
    // Numbers of sites without neighbours are no profile.
    let known = q.moves && q.field.cols == 1 && (1..=3).contains(&dim) && (dim > 1 || q.on_line);
    (known && q.members.len() > 1).then(|| Seen::Chain {
        name: q.name.clone(),
        dim,
        columns: q.members.iter().map(|(_, c)| c.clone()).collect(),
        line: q.on_line,
    })
}

fn body(seen: &Seen, frames: &[&[f64]], finite: &dyn Fn(&f64) -> f64) -> Option<Value> {
    let Seen::Body { name, turn, place } = seen else {
        return None;
    };
    let numbers = |frame: &[f64], columns: &Range<usize>| -> Vec<f64> {
        let part = frame.get(columns.clone()).unwrap_or_default();
        part.iter().map(finite).collect()
    };
    let entry = |m: &[f64], i: usize| m.get(i).copied().unwrap_or(0.0);
    let turns = frames.iter().map(|frame| {
        let m = numbers(frame, turn);
        match place {
            // The upper rows of a homogeneous matrix, without their last entries.
            Place::Within => [0, 1, 2, 4, 5, 6, 8, 9, 10].map(|i| entry(&m, i)).to_vec(),
            _ => matrix(&m).map_or_else(Vec::new, |a| a.transpose().as_slice().to_vec()),
        }
    });
    let places = frames.iter().map(|frame| match place {
        Place::Row(i) => vec![2.6 * *i as f64, 0.0, 0.0],
        Place::Within => {
            let m = numbers(frame, turn);
            [3, 7, 11].map(|i| entry(&m, i)).to_vec()
        }
        Place::At(a, b) => {
            let point = |p: &Point| match p {
                Point::Held(place) => place.clone(),
                Point::Moving(columns, around) => {
                    let around = around.iter().copied().chain(std::iter::repeat(0.0));
                    let here = numbers(frame, columns).into_iter();
                    here.zip(around).map(|(x, by)| x + by).collect()
                }
            };
            let (a, b): (Vec<f64>, Vec<f64>) = (point(a), point(b));
            a.iter().zip(&b).map(|(x, y)| (x + y) / 2.0).collect()
        }
    });
    Some(json!({
        "name": name,
        "small": !matches!(place, Place::Row(_)),
        "turns": turns.collect::<Vec<_>>(),
        "places": places.collect::<Vec<_>>(),
    }))
}

/// Particles on a torus are put back into it.
fn chain(
    seen: &Seen,
    frames: &[&[f64]],
    lengths: Option<&[f64]>,
    finite: &dyn Fn(&f64) -> f64,
) -> Option<Value> {
    let Seen::Chain {
        name,
        dim,
        columns,
        line,
    } = seen
    else {
        return None;
    };
    let frame = |frame: &&[f64]| -> Vec<f64> {
        let cells = columns
            .iter()
            .flat_map(|c| frame.get(c.clone()).unwrap_or_default());
        let cells = cells.map(finite);
        match lengths.filter(|l| l.len() == *dim) {
            Some(l) => cells
                .zip(l.iter().cycle())
                .map(|(x, l)| x.rem_euclid(*l))
                .collect(),
            None => cells.collect(),
        }
    };
    let frames: Vec<Vec<f64>> = frames.iter().map(frame).collect();
    let top = clebsch::scalar::largest(frames.iter().flatten().map(|x| x.abs()));
    Some(json!({
        "name": name,
        "dim": dim,
        "line": line,
        "profile": *dim == 1,
        "top": top,
        "frames": frames,
    }))
}
