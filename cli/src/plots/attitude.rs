//! Attitudes: the axes of bodies and their vectors on spheres, for a selection of sites.
//! Takes the samples of a run; gives a drawing of each rotation, of each vector and of each body momentum.

use super::sphere::{Course, Sphere, sheet};
use super::window::{Window, window};
use super::{Plot, letter, subscript};
use crate::output::Finished;
use crate::output::attitude::{matrix, placed};
use crate::output::sites::at_sites;
use crate::trajectory::record::Samples;
use crate::words::number;
use clebsch::card::{Field, Kind};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::scalar::largest;
use std::ops::Range;

/// The largest number of spheres in a picture.
const MOST: usize = 9;

/// A momentum stays on its sphere if the relative change of its length is below this.
const SAME_LENGTH: f64 = 1e-9;

/// An observable with its columns.
pub(super) type Placed = (&'static Field, Range<usize>);

/// One quantity, with or without sites.
pub(super) struct QuantityColumns {
    /// Its name without its site.
    pub(super) name: String,
    /// Its symbol in print: its name, or the symbol for momenta.
    pub(super) letter: String,
    /// The label of its sites.
    pub(super) index: String,
    /// Its observables, each with its site. `None` if the quantity has only one copy.
    pub(super) members: Vec<(Option<usize>, Placed)>,
}

/// Groups observables by quantity, in the order in which each quantity occurs first.
pub(super) fn grouped(run: &Finished<'_>, all: Vec<Placed>) -> Vec<QuantityColumns> {
    let at_sites = at_sites(run.card);
    let mut keys: Vec<&str> = Vec::new();
    let mut kin: Vec<QuantityColumns> = Vec::new();
    for (field, columns) in all {
        let own = at_sites.iter().find_map(|q| {
            let mut members = q.members.iter();
            let site = members.find(|(_, own)| *own == columns)?.0;
            Some((q, site))
        });
        let key = own.map_or(field.ascii, |(q, _)| q.key.as_str());
        let member = (own.map(|(_, site)| site), (field, columns));
        match keys.iter().position(|known| *known == key) {
            Some(at) => kin[at].members.push(member),
            None => {
                keys.push(key);
                let name = own.map_or(field.name, |(q, _)| q.name.as_str());
                let (name, letter) = match letter(field) {
                    own if own == field.name => (name.to_owned(), name),
                    letter => (format!("{letter} of {name}"), letter),
                };
                kin.push(QuantityColumns {
                    name,
                    letter: letter.to_owned(),
                    index: own.map_or_else(String::new, |(q, _)| q.index.clone()),
                    members: vec![member],
                });
            }
        }
    }
    kin
}

/// Selects as many copies of each quantity as fit into `room` together, evenly spaced from its first to its last
/// site. If some are omitted, a sentence lists the copies that are shown.
fn chosen(kin: Vec<QuantityColumns>, room: usize) -> (Vec<QuantityColumns>, Option<String>) {
    let taken = |each: usize| kin.iter().map(|k| k.members.len().min(each)).sum::<usize>();
    let all = taken(usize::MAX);
    if all <= room {
        return (kin, None);
    }
    let most = (1..=room).rev().find(|each| taken(*each) <= room);
    // Only complete rows.
    let each = match most.unwrap_or(1) {
        some @ 3.. => some / 3 * 3,
        few => few,
    };
    let shown = taken(each).min(room);
    let mut told = Vec::new();
    let mut some = Vec::new();
    for mut own in kin.into_iter().take(room) {
        let count = own.members.len();
        if count > each {
            let last = each.saturating_sub(1).max(1);
            let picked = |k: usize| {
                own.members
                    .get((k * (count - 1) + last / 2) / last)
                    .cloned()
            };
            own.members = (0..each).filter_map(picked).collect();
            let sites = own.members.iter().filter_map(|(site, _)| *site);
            let sites: Vec<String> = sites.map(|site| site.to_string()).collect();
            told.push(format!(
                "{} at {} = {}",
                own.name,
                own.index,
                sites.join(", ")
            ));
        }
        some.push(own);
    }
    let which = if told.is_empty() { "" } else { ": " };
    let sentence = format!(
        "{shown} of {all} spheres are shown{which}{}",
        told.join("; ")
    );
    (some, Some(sentence))
}

/// The rotations among the observables.
pub(super) fn rotations(run: &Finished<'_>) -> Vec<Placed> {
    let turns = |field: &Field| {
        field.kind == Kind::UnitQuaternion || (field.kind == Kind::Rotation && field.count() == 9)
    };
    placed(run.card.observables)
        .filter(|(field, _)| turns(field))
        .collect()
}

/// The rows of the samples in the window, restricted to these columns.
pub(super) fn rows<'a>(
    shown: Window<'a>,
    columns: &Range<usize>,
) -> impl Iterator<Item = &'a [f64]> {
    let columns = columns.clone();
    let rows = shown.record.observables.rows().take(shown.count);
    rows.filter_map(move |row| row.get(columns.clone()))
}

/// Draws spheres. A rotation is shown by its body axis e₃ in space, and a vector of three components by its
/// direction. A body momentum is shown on the sphere of its length, with lines of equal kinetic energy if these
/// are known.
pub(crate) fn attitude(run: &Finished<'_>, samples: &Samples) -> Plot {
    let turning = rotations(run);
    if turning.is_empty() {
        return Ok(None);
    }
    let moves = |field: &Field| {
        [Kind::Vector, Kind::BodyMomentum].contains(&field.kind) && field.count() == 3
    };
    // Positions along a chain are not directions; a picture of its shape shows them.
    let at_sites = at_sites(run.card);
    let places: Vec<&Range<usize>> = at_sites
        .iter()
        .filter(|q| q.moves)
        .flat_map(|q| q.members.iter().map(|(_, columns)| columns))
        .collect();
    // Positions of bodies, which precede their momenta, are not directions either; an orbit has its own picture.
    let all = run.card.observables;
    let positions = all.windows(2).filter(|pair| {
        pair.last()
            .is_some_and(|next| next.kind == Kind::FieldMomentum)
    });
    let positions: Vec<&str> = positions
        .filter_map(|pair| Some(pair.first()?.name))
        .collect();
    let moving = placed(all).filter(|(field, columns)| {
        moves(field) && !places.contains(&columns) && !positions.contains(&field.name)
    });
    let moving: Vec<Placed> = moving.collect();
    let all = turning.iter().chain(&moving);
    let all: Vec<Range<usize>> = all.map(|(_, columns)| columns.clone()).collect();
    let shown = window(samples, &all);
    // A vector that is zero or not finite at all samples cannot be drawn on a sphere.
    let has_length = |(_, columns): &Placed| {
        let lengths = rows(shown, columns).map(|row| Vector3::from_row_slice(row).norm());
        largest(lengths.filter(|x| x.is_finite())) > 0.0
    };
    let drawn = turning
        .iter()
        .chain(moving.iter().filter(|own| has_length(own)));
    let (kin, sentence) = chosen(grouped(run, drawn.cloned().collect()), MOST);
    let letters: Vec<&str> = kin.iter().map(|own| own.letter.as_str()).collect();
    let mut spheres = Vec::new();
    for own in &kin {
        let alike = letters.iter().filter(|l| **l == own.letter).count() > 1;
        for (site, (field, columns)) in &own.members {
            let mark = site.map_or_else(String::new, subscript);
            let name = format!("{}{mark}", own.letter);
            let rows = rows(shown, columns);
            spheres.push(match field.kind {
                Kind::Vector | Kind::BodyMomentum => {
                    let of = match alike {
                        false => String::new(),
                        true => format!(" ({})", field.name.replace('_', " ")),
                    };
                    let vectors = rows.map(Vector3::from_row_slice).collect();
                    of_vectors(run, field, vectors, (&name, &of))
                }
                _ => of_axis(field, rows.filter_map(matrix), (&own.letter, &mark)),
            });
        }
    }
    let (title, subtitle) = super::titles(run, shown, "attitude");
    let words = [&title, &subtitle, sentence.as_deref().unwrap_or_default()];
    Ok(Some(sheet(&spheres, words, run.plan.paper)))
}

/// The sphere of the body axis e₃ of a rotation, in space.
fn of_axis(
    field: &Field,
    turns: impl Iterator<Item = Matrix3<f64>>,
    (letter, mark): (&str, &str),
) -> Sphere {
    let times = match field.kind {
        Kind::UnitQuaternion => format!("{letter}{mark} e₃ {letter}̄{mark}"),
        _ => format!("{letter}{mark} e₃"),
    };
    Sphere {
        caption: format!("{times}: the body axis e₃ in space"),
        radius: 1.0,
        courses: vec![Course::of(turns.map(|turn| turn.column(2).into()))],
        contours: Vec::new(),
    }
}

/// The sphere of a vector or a body momentum that is not zero throughout. Its caption contains the name, and a word
/// that distinguishes vectors with the same name.
fn of_vectors(
    run: &Finished<'_>,
    field: &Field,
    vectors: Vec<Vector3<f64>>,
    (name, of): (&str, &str),
) -> Sphere {
    let lengths = || vectors.iter().map(Vector3::norm).filter(|x| x.is_finite());
    let longest = largest(lengths());
    let shortest = lengths().fold(f64::INFINITY, f64::min);
    let on = longest - shortest <= SAME_LENGTH * longest;
    let length = number::plain(rounded(longest));
    let contours = match field.kind {
        Kind::BodyMomentum if on => inverse_inertia(run).map_or_else(Vec::new, |inverse| {
            super::sphere::contours(longest, &|m| 0.5 * m.dot(&(inverse * m)))
        }),
        _ => Vec::new(),
    };
    let lines = if contours.is_empty() {
        ""
    } else {
        "; lines of equal kinetic energy"
    };
    Sphere {
        caption: match on {
            true => format!("{name}{of} on |{name}| = {length}{lines}"),
            false => format!("{name}{of} in the ball |{name}| ≤ {length}"),
        },
        radius: longest,
        courses: vec![Course::of(vectors.into_iter())],
        contours,
    }
}

/// Four digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// The inverse of the inertia `tr(J) Id - J`, if the model has exactly one such J.
fn inverse_inertia(run: &Finished<'_>) -> Option<Matrix3<f64>> {
    let card = run.card;
    let pairs = card.parameters.iter().zip(&run.plan.case.parameters);
    let mut second = pairs.filter(|(field, _)| {
        field.count() == 9 && [Kind::SecondMoments, Kind::Symmetric].contains(&field.kind)
    });
    let (_, numbers) = second.next()?;
    if second.next().is_some() {
        return None;
    }
    let j = Matrix3::from_row_slice(numbers.get(..9)?);
    (Matrix3::identity() * j.trace() - j).try_inverse()
}
