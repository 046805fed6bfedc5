//! The view of a run in space: bodies with their attitudes and positions, points and chains, profiles of
//! scalars along a chain, constraints, and the ground. Takes the samples of a run; gives data for the view, at
//! most
//! [`FRAMES`] frames.

use super::bodies::{Body, Place, bodies, carried, is_placed, place_note, turns};
use super::body_positions::Ties;
use super::chains::{Chain, chains};
use super::links::{Link, PageFrames, links};
use super::particle_colours::Tints;
use super::value::Stated;
use crate::case_file::space::Space;
use crate::output::Finished;
use crate::output::attitude::placed;
use crate::output::fluid::{Coloured, space};
use crate::output::points::Diagonals;
use crate::plots::window::window;
use crate::trajectory::record::Samples;
use crate::words::number::plain;
use clebsch::card::Field;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::ops::Range;

/// The largest number of frames of a page, without the last frame.
pub(super) const FRAMES: usize = 600;

/// The largest number of values in all frames together: about two megabytes.
const NUMBERS: usize = 200_000;

/// Up to this number, bodies are drawn large.
const FEW: usize = 3;

/// The largest number of bodies without a position in a single row.
const ROW: usize = 12;

/// The distance between bodies without a position, in lengths of their axes.
const APART: f64 = 2.6;

/// The scene as data, and the text below it.
pub(super) struct Scene {
    pub(super) data: Value,
    pub(super) said: String,
}

/// The scene; `None` if a model has nothing to draw in space.
pub(super) fn scene(run: &Finished<'_>, samples: &Samples) -> Option<Scene> {
    let stated = Stated::of(run.card, run.plan);
    let stated = stated.as_ref();
    let sites = stated.map_or(&[][..], |s| &s.sites);
    let coloured = Coloured::of(run.card, run.plan, sites);
    let tints = coloured.as_ref().map(Tints::of);
    let (attitudes, places) = names(run, stated);
    let ties = match stated {
        Some(stated) => Ties::of(stated, &attitudes, &places),
        None => Ties::default(),
    };
    let bodies = bodies(run, stated, &ties);
    let chains = chains(run.card, stated, tints.as_ref());
    if bodies.is_empty() && chains.is_empty() {
        return None;
    }
    let columns: Vec<Range<usize>> = bodies
        .iter()
        .flat_map(Body::columns)
        .chain(chains.iter().flat_map(Chain::columns))
        .collect();
    let shown = window(samples, &columns);
    let width = 12 * bodies.len() + chains.iter().map(Chain::width).sum::<usize>();
    let most = (NUMBERS / width.max(1)).clamp(2, FRAMES);
    let stride = shown.count.div_ceil(most).max(1);
    // The end of the run is always drawn.
    let last = shown.count.saturating_sub(1);
    let is_shown = |i: usize| i.is_multiple_of(stride) || i == last;
    let rows = shown.record.observables.rows().take(shown.count);
    let rows = rows.enumerate().filter(|(i, _)| is_shown(*i));
    let frames: Vec<&[f64]> = rows.map(|(_, row)| row).collect();
    let times = shown.record.times.iter().take(shown.count).enumerate();
    let times = times.filter(|(i, _)| is_shown(*i)).map(|(_, t)| *t);
    let space = space(run.card, run.plan).map(|(space, _)| space);
    let space = space.as_ref();
    let joined = PageFrames {
        frames: &frames,
        places: &[places, others(run, stated)].concat(),
        ties: &ties,
    };
    let mut links = stated.map_or_else(Vec::new, |s| links(s, joined));
    links.truncate(NUMBERS / (9 * frames.len().max(1)));
    let size = Size::of(&bodies, &chains, &links, (&frames, space));
    let flat = bodies.iter().all(Body::is_flat) && chains.iter().all(Chain::is_flat);
    let supports = links.iter().filter_map(|l| l.support);
    let mut supports: Vec<[f64; 3]> = supports
        .chain(chains.iter().flat_map(Chain::held))
        .collect();
    supports.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    supports.dedup();
    let data = json!({
        "times": times.collect::<Vec<f64>>(),
        "flat": flat,
        "box": space.map(|space| &space.lengths),
        "arm": if bodies.is_empty() { 0.0 } else { size.arm },
        "bodies": bodies.iter().map(|b| body(b, &frames, &size)).collect::<Vec<_>>(),
        "chains": chains.iter().map(|c| c.data(&frames, space)).collect::<Vec<_>>(),
        "links": links.iter().map(|l| &l.frames).collect::<Vec<_>>(),
        "supports": supports,
    });
    let mut said = place_note(&bodies, &ties);
    if shown.cut {
        let end = shown.record.times.get(last).copied().unwrap_or(0.0);
        let part = format!("The view shows the run up to time {}.", plain(end));
        said = format!("{said} {part}");
    }
    Some(Scene { data, said })
}

/// The attitudes without their own position, and the positions, both without sites.
fn names(
    run: &Finished<'_>,
    stated: Option<&Stated<'_>>,
) -> (Vec<&'static str>, Vec<&'static str>) {
    let diagonals = Diagonals::of(run.card);
    let carried = carried(stated);
    let sites = stated.into_iter().flat_map(|s| &s.sites);
    let of_sites: HashSet<usize> = sites
        .flat_map(|q| q.members.iter().map(|(_, c)| c.start))
        .collect();
    let alone: Vec<&'static Field> = placed(run.card.observables)
        .filter(|(_, columns)| !of_sites.contains(&columns.start))
        .map(|(field, _)| field)
        .collect();
    let attitudes = alone
        .iter()
        .filter(|f| turns(f) && !carried.contains(f.name));
    let behind = |i: usize| alone.get(i + 1).map(|f| f.kind);
    let places = alone.iter().enumerate();
    let places = places.filter(|(i, f)| diagonals.leave(f, behind(*i)));
    (
        attitudes.map(|f| f.name).collect(),
        places.map(|(_, f)| f.name).collect(),
    )
}

/// The names of the other quantities with a position: rigid motions, and points at sites.
fn others<'a>(run: &Finished<'_>, stated: Option<&'a Stated<'_>>) -> Vec<&'a str> {
    let rigid = placed(run.card.observables).filter(|(f, _)| is_placed(f));
    let sites = stated.into_iter().flat_map(|s| &s.sites);
    let points = sites.filter(|q| q.moves && (2..=3).contains(&q.field.count()));
    let points = points.map(|q| q.name.as_str());
    rigid.map(|(f, _)| f.name).chain(points).collect()
}

/// The size of the axes of bodies, and the location of bodies without a position.
struct Size {
    arm: f64,
    row: [f64; 3],
    /// The number of bodies in a row.
    beside: usize,
}

impl Size {
    fn of(
        bodies: &[Body],
        chains: &[Chain<'_>],
        links: &[Link],
        (frames, space): (&[&[f64]], Option<&Space>),
    ) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut put = |point: &[f64]| {
            for (d, x) in point.iter().enumerate().filter(|(_, x)| x.is_finite()) {
                if let (Some(a), Some(b)) = (low.get_mut(d), high.get_mut(d)) {
                    (*a, *b) = (a.min(*x), b.max(*x));
                }
            }
        };
        for row in frames {
            for body in bodies.iter().filter(|b| b.has_place()) {
                put(&body.at(row));
            }
            for chain in chains.iter().filter(|c| !c.is_profile()) {
                chain
                    .numbers(row, space)
                    .chunks(chain.dim())
                    .for_each(&mut put);
            }
        }
        for numbers in links.iter().flat_map(|l| &l.frames) {
            numbers.chunks(3).for_each(&mut put);
        }
        // A profile is drawn between -1 and 1.
        if chains.iter().any(Chain::is_profile) {
            [[-1.0, -0.6, 0.0], [1.0, 0.6, 0.0]]
                .iter()
                .for_each(|p| put(p));
        }
        if bodies.iter().any(|b| matches!(b.place, Place::Origin)) {
            put(&[0.0; 3]);
        }
        let rows = bodies.iter().filter(|b| matches!(b.place, Place::Row(_)));
        let beside = match rows.count() {
            few @ ..=ROW => few,
            many => (2 * many).isqrt(),
        };
        let known = low.iter().zip(&high).all(|(a, b)| a <= b);
        let sides = low.iter().zip(&high).map(|(a, b)| b - a);
        let reach = 0.5 * sides.map(|s| s * s).sum::<f64>().sqrt();
        if !known || reach <= 0.0 {
            let row = [if known { APART } else { 0.0 }, 0.0, 0.0];
            return Size {
                arm: 1.0,
                row,
                beside,
            };
        }
        let arm = reach / if bodies.len() <= FEW { 5.0 } else { 12.0 };
        let [_, y, z] = [0, 1, 2].map(|d: usize| 0.5 * (low[d] + high[d]));
        let [x, ..] = high;
        Size {
            arm,
            row: [x + APART * arm, y, z],
            beside,
        }
    }
}

fn body(body: &Body, frames: &[&[f64]], size: &Size) -> Value {
    let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
    let turns = frames.iter().map(|row| {
        let axes = body.axes(row).into_iter();
        axes.map(finite).collect::<Vec<f64>>()
    });
    let [x, y, z] = size.row;
    let places = frames.iter().map(|row| match body.place {
        Place::Row(i) => {
            let (down, along) = (i / size.beside.max(1), i % size.beside.max(1));
            let by = |count: usize| APART * size.arm * count as f64;
            [x + by(along), y, z - by(down)]
        }
        _ => body.at(row).map(finite),
    });
    json!({
        "name": body.name,
        "still": !body.has_place(),
        "turns": turns.collect::<Vec<_>>(),
        "places": places.collect::<Vec<_>>(),
    })
}
