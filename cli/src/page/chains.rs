//! Points that a page draws: a chain, single points, particles, or the profile of numbers along a chain. Takes the
//! fields of a card; gives their positions in a sample, including points with prescribed positions.

use super::particle_colours::Tints;
use super::value::Stated;
use crate::case_file::space::Space;
use crate::output::attitude::placed;
use crate::output::places::Point;
use crate::output::points::Diagonals;
use crate::output::sites::AtSites;
use clebsch::card::{Card, Field};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::ops::Range;

/// The largest number of points that leave trails.
const TRAILS: usize = 12;

/// Points with a name.
pub(super) struct Chain<'a> {
    name: String,
    dim: usize,
    points: Vec<Point>,
    line: bool,
    tints: Option<&'a Tints<'a>>,
}

/// All of a model, in the order of the card.
pub(super) fn chains<'a>(
    card: &Card,
    stated: Option<&Stated<'_>>,
    tints: Option<&'a Tints<'a>>,
) -> Vec<Chain<'a>> {
    let sites = stated.map_or(&[][..], |s| &s.sites);
    let of_sites: HashSet<usize> = sites
        .iter()
        .flat_map(|q| q.members.iter().map(|(_, c)| c.start))
        .collect();
    let along = |q: &AtSites<'_>| stated.map(|s| s.along(q));
    let mut out: Vec<Chain<'a>> = sites
        .iter()
        .filter_map(|q| of_sites_of(q, along(q)?, tints))
        .collect();
    let diagonals = Diagonals::of(card);
    let alone: Vec<(&Field, Range<usize>)> = placed(card.observables)
        .filter(|(_, c)| !of_sites.contains(&c.start))
        .collect();
    for (i, (field, columns)) in alone.iter().enumerate() {
        let behind = alone.get(i + 1).map(|(f, _)| f.kind);
        if diagonals.leave(field, behind) {
            out.push(Chain {
                name: field.name.to_owned(),
                dim: field.rows,
                points: vec![Point::Moving(columns.clone(), Vec::new())],
                line: false,
                tints: None,
            });
        }
    }
    out
}

/// The points or numbers of a field at sites.
fn of_sites_of<'a>(
    q: &AtSites<'_>,
    along: Vec<Point>,
    tints: Option<&'a Tints<'a>>,
) -> Option<Chain<'a>> {
    let dim = q.field.count();
    // Scalars at sites without neighbours do not form a profile.
    let tints = tints.filter(|t| t.have(q));
    let seen = dim > 1 || q.on_line || tints.is_some();
    let known = q.moves && q.field.cols == 1 && (1..=3).contains(&dim) && seen;
    let points = match q.on_line {
        true => along,
        false => {
            let members = q.members.iter().map(|(_, c)| c.clone());
            members.map(|c| Point::Moving(c, Vec::new())).collect()
        }
    };
    (known && points.len() > 1).then(|| Chain {
        name: q.name.clone(),
        dim,
        points,
        line: q.on_line,
        tints,
    })
}

impl Chain<'_> {
    /// Whether it is a profile of numbers. Particles in one dimension are drawn at the height of their depth instead.
    pub(super) fn is_profile(&self) -> bool {
        self.dim == 1 && self.line
    }

    /// How many components a point has.
    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    /// Whether it is in the plane.
    pub(super) fn is_flat(&self) -> bool {
        self.dim < 3
    }

    /// The columns of its positions.
    pub(super) fn columns(&self) -> impl Iterator<Item = Range<usize>> {
        self.points.iter().filter_map(Point::columns)
    }

    /// How many numbers it has in a frame.
    pub(super) fn width(&self) -> usize {
        let tints = self.tints.map_or(0, |_| self.points.len());
        tints + self.dim * self.points.len()
    }

    /// The points with prescribed positions; empty for a profile.
    pub(super) fn held(&self) -> Vec<[f64; 3]> {
        let own = self.points.iter().filter(|_| !self.is_profile());
        let held = own.filter_map(|p| match p {
            Point::Held(place) => Some(place),
            Point::Moving(..) => None,
        });
        held.map(|p| [0, 1, 2].map(|i| p.get(i).copied().unwrap_or(0.0)))
            .collect()
    }

    /// The numbers of all points in a sample. Particles outside a periodic domain are mapped back into it.
    pub(super) fn numbers(&self, row: &[f64], space: Option<&Space>) -> Vec<f64> {
        let all = self.points.iter().flat_map(|p| p.at(row));
        let all = all.map(|x| if x.is_finite() { x } else { 0.0 });
        match space.filter(|space| space.lengths.len() == self.dim) {
            Some(space) => {
                let sides = space.lengths.iter().zip(&space.walls).cycle();
                let put = |(x, (length, solid)): (f64, (&f64, &bool))| match solid {
                    true => x,
                    false => x.rem_euclid(*length),
                };
                all.zip(sides).map(put).collect()
            }
            None => all.collect(),
        }
    }

    /// It as data.
    pub(super) fn data(&self, frames: &[&[f64]], space: Option<&Space>) -> Value {
        let tints = self.tints.map(|tints| {
            let values: Vec<Vec<f64>> = frames.iter().map(|row| tints.values(row)).collect();
            let finite = || values.iter().flatten().copied().filter(|x| x.is_finite());
            let low = finite().fold(f64::INFINITY, f64::min);
            let high = finite().fold(f64::NEG_INFINITY, f64::max);
            (low <= high)
                .then(|| json!({"name": tints.name(), "low": low, "high": high, "frames": values}))
        });
        let frames: Vec<Vec<f64>> = frames.iter().map(|row| self.numbers(row, space)).collect();
        let top = clebsch::scalar::largest(frames.iter().flatten().map(|x| x.abs()));
        json!({
            "name": self.name,
            "dim": self.dim,
            "line": self.line,
            "profile": self.is_profile(),
            "trails": !self.line && self.points.len() <= TRAILS,
            "top": top,
            "tints": tints.flatten(),
            "frames": frames,
        })
    }
}
