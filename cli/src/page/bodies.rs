//! Bodies that a page draws by their axes, and the position of each: its own position, the origin, or a row
//! next to the other objects. Takes a card with its model; gives their columns, and their axes and positions in
//! a sample.

use super::body_positions::{Tied, Ties};
use super::value::Stated;
use crate::output::Finished;
use crate::output::attitude::{matrix, placed};
use crate::output::places::{Places, Point};
use clebsch::card::{Field, Kind};
use clebsch_core::syntax::ast::Statement;
use std::collections::HashSet;
use std::ops::Range;

/// A body with the columns of its attitude.
pub(super) struct Body {
    pub(super) name: String,
    pub(super) turn: Range<usize>,
    kind: Kind,
    pub(super) place: Place,
}

/// The position at which a body is drawn.
pub(super) enum Place {
    /// The position is unknown: in a row, by its number.
    Row(usize),
    /// About the origin.
    Origin,
    /// In a homogeneous matrix.
    Within,
    /// At a point, or midway between two.
    At(Point, Point),
}

/// The bodies of a run, with the positions of bodies that are not at sites.
pub(super) fn bodies(run: &Finished<'_>, stated: Option<&Stated<'_>>, ties: &Ties) -> Vec<Body> {
    let carried = carried(stated);
    let sites = stated.map_or(&[][..], |s| &s.sites);
    let of_sites: HashSet<usize> = sites
        .iter()
        .flat_map(|q| q.members.iter().map(|(_, c)| c.start))
        .collect();
    let mut out = Vec::new();
    let mut rows = 0;
    let mut put = |name: String, (field, turn): (&Field, Range<usize>), place: Option<Place>| {
        let place = match place {
            _ if is_placed(field) => Place::Within,
            Some(known) => known,
            None => {
                rows += 1;
                Place::Row(rows - 1)
            }
        };
        out.push(Body {
            name,
            turn,
            kind: field.kind,
            place,
        });
    };
    let own = |q: &&crate::output::sites::AtSites<'_>| {
        is_body(q.field) && !carried.contains(q.name.as_str())
    };
    for q in sites.iter().filter(own) {
        let places = Places::of((run.card, run.plan), sites, q);
        for (site, turn) in &q.members {
            let beside = places.as_ref().and_then(|p| p.at(*site));
            let place = beside.map(|(a, b)| Place::At(a, b));
            put(format!("{}_{site}", q.name), (q.field, turn.clone()), place);
        }
    }
    let all: Vec<(&Field, Range<usize>)> = placed(run.card.observables).collect();
    for (field, turn) in &all {
        let alone = !of_sites.contains(&turn.start) && !carried.contains(field.name);
        if !alone || !is_body(field) {
            continue;
        }
        let columns = |name: &str| {
            let own = all.iter().find(|(f, _)| f.name == name);
            own.map(|(_, c)| Point::Moving(c.clone(), Vec::new()))
        };
        let place = ties.place(field.name).and_then(|tied| match tied {
            Tied::Origin => Some(Place::Origin),
            Tied::To(name) => columns(name).map(|p| Place::At(p.clone(), p)),
        });
        put(field.name.to_owned(), (field, turn.clone()), place);
    }
    out
}

/// The names of advected quantities, such as the attitude of one body relative to another. They are not drawn as
/// bodies.
pub(super) fn carried<'a>(stated: Option<&'a Stated<'_>>) -> HashSet<&'a str> {
    let statements = stated.map_or(&[][..], |s| &s.model.statements);
    let names = statements.iter().filter_map(|s| match s {
        Statement::Advected { names, .. } => Some(names),
        _ => None,
    });
    names.flatten().map(|n| n.text.as_str()).collect()
}

/// Whether the field is an attitude, with or without a position.
fn is_body(field: &Field) -> bool {
    turns(field) || is_placed(field)
}

/// Whether the field is an attitude with a position, in space or in the plane.
pub(super) fn is_placed(field: &Field) -> bool {
    field.kind == Kind::RigidMotion && [9, 16].contains(&field.count())
}

/// Whether it is an attitude in space or in the plane.
pub(super) fn turns(field: &Field) -> bool {
    field.kind == Kind::UnitQuaternion
        || (field.kind == Kind::Rotation && [4, 9].contains(&field.count()))
}

impl Body {
    /// Whether it moves in the plane.
    pub(super) fn is_flat(&self) -> bool {
        let flat = match self.kind {
            Kind::Rotation => self.turn.len() == 4,
            Kind::RigidMotion => self.turn.len() == 9,
            _ => false,
        };
        let in_plane = |p: &Point| match p {
            Point::Held(place) => place.len() < 3,
            Point::Moving(columns, _) => columns.len() < 3,
        };
        flat && match &self.place {
            Place::At(a, b) => in_plane(a) && in_plane(b),
            _ => true,
        }
    }

    /// Whether the body has its own position.
    pub(super) fn has_place(&self) -> bool {
        matches!(self.place, Place::Within | Place::At(..))
    }

    /// The columns of its attitude and position.
    pub(super) fn columns(&self) -> Vec<Range<usize>> {
        let mut all = vec![self.turn.clone()];
        if let Place::At(a, b) = &self.place {
            all.extend([a, b].into_iter().filter_map(Point::columns));
        }
        all
    }

    /// The nine entries of its attitude, row by row; a body in the plane rotates about the third axis.
    pub(super) fn axes(&self, row: &[f64]) -> Vec<f64> {
        let m = row.get(self.turn.clone()).unwrap_or_default();
        let entry = |i: usize| m.get(i).copied().unwrap_or(0.0);
        let in_plane = |[a, b, c, d]: [usize; 4]| {
            let [a, b, c, d] = [a, b, c, d].map(entry);
            vec![a, b, 0.0, c, d, 0.0, 0.0, 0.0, 1.0]
        };
        match (self.kind, m.len()) {
            (Kind::Rotation, 4) => in_plane([0, 1, 2, 3]),
            (Kind::RigidMotion, 9) => in_plane([0, 1, 3, 4]),
            // The upper rows of a homogeneous matrix, without their last entries.
            (Kind::RigidMotion, _) => [0, 1, 2, 4, 5, 6, 8, 9, 10].map(entry).to_vec(),
            _ => matrix(m).map_or_else(Vec::new, |a| a.transpose().as_slice().to_vec()),
        }
    }

    /// Its position, or the origin if it has none.
    pub(super) fn at(&self, row: &[f64]) -> [f64; 3] {
        match &self.place {
            Place::Row(_) | Place::Origin => [0.0; 3],
            Place::Within => {
                let m = row.get(self.turn.clone()).unwrap_or_default();
                let entry = |i: usize| m.get(i).copied().unwrap_or(0.0);
                match m.len() {
                    9 => [entry(2), entry(5), 0.0],
                    _ => [3, 7, 11].map(entry),
                }
            }
            Place::At(a, b) => {
                let (a, b) = (a.at(row), b.at(row));
                let entry = |v: &[f64], i: usize| v.get(i).copied().unwrap_or(0.0);
                [0, 1, 2].map(|i| (entry(&a, i) + entry(&b, i)) / 2.0)
            }
        }
    }
}

/// A sentence that states where bodies are drawn, if their names do not make it clear.
pub(super) fn place_note(bodies: &[Body], ties: &Ties) -> String {
    let mut at: Vec<String> = Vec::new();
    let (mut origin, mut rows) = (Vec::new(), Vec::new());
    for body in bodies {
        match (&body.place, ties.place(&body.name)) {
            (Place::At(..), Some(Tied::To(place))) => at.push(format!("{} at {place}", body.name)),
            (Place::Origin, _) => origin.push(body.name.as_str()),
            (Place::Row(_), _) => rows.push(body.name.as_str()),
            _ => {}
        }
    }
    let mut out: Vec<String> = Vec::new();
    if !origin.is_empty() {
        at.push(format!("{} about the origin", listed(&origin)));
    }
    if !bodies.is_empty() {
        let at = match at.as_slice() {
            [] => String::new(),
            at => format!("; {}", at.join(", ")),
        };
        out.push(format!(
            "The axes of each body are drawn: the first red, the second green, the third blue{at}."
        ));
    }
    if !rows.is_empty() && rows.len() < bodies.len() {
        let (have, are) = match rows.len() {
            1 => ("has", "is"),
            _ => ("have", "are"),
        };
        let names = listed(&rows);
        out.push(format!(
            "{names} {have} no position in the model and {are} drawn next to the others."
        ));
    }
    out.join(" ")
}

/// Names in a row, the first and the last of many.
fn listed(names: &[&str]) -> String {
    match names {
        [first, .., last] if names.len() > 4 => format!("{first} to {last}"),
        _ => names.join(", "),
    }
}
