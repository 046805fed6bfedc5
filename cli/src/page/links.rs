//! Draws constraints as lines between two positions, or between a position and a fixed point. Takes the `hold`
//! statements of a model and frames of a run; gives a path in every frame, and the fixed points.
//!
//! A fixed length has the form `dot(u, u)`, and a joint is an equation of vectors. Both contain a difference of
//! two points, `u = a - b`. Each point is a position, or a position plus an arm of its body. A point that is
//! the same in every frame is a support.

use super::body_positions::{Ties, place_of};
use super::value::{At, Stated, Value, scalar};
use clebsch_core::syntax::ast::{Expression, Kind, Statement};

/// The largest number of lines on a page.
const MOST: usize = 200;

/// The fraction of the size of a picture within which a point counts as fixed.
const STAYS: f64 = 1e-6;

/// Relative tolerance within which a length counts as fixed.
const HELD: f64 = 1e-4;

/// A line through points that are joined.
pub(super) struct Link {
    /// The coordinates of all points in every frame, three for each point.
    pub(super) frames: Vec<Vec<f64>>,
    /// A fixed point, if there is one.
    pub(super) support: Option<[f64; 3]>,
}

/// A term with its sign.
type Term = (bool, Expression);

/// A difference of points, as lists of terms, whose length a constraint fixes or which it sets to zero.
struct Difference {
    /// Terms of the first point.
    first: Vec<Term>,
    /// Terms of the second point, with their signs.
    second: Vec<Term>,
    /// The positions of the two bodies.
    places: [Option<Term>; 2],
}

/// The frames that a page shows, and the names of positions.
#[derive(Clone, Copy)]
pub(super) struct PageFrames<'a> {
    pub(super) frames: &'a [&'a [f64]],
    pub(super) places: &'a [&'a str],
    pub(super) ties: &'a Ties,
}

/// The links of a model. If there are too many, only the first of them.
pub(super) fn links(stated: &Stated<'_>, shown: PageFrames<'_>) -> Vec<Link> {
    let mut out = Vec::new();
    for statement in &stated.model.statements {
        let Statement::Hold { left, right, .. } = statement else {
            continue;
        };
        for site in sites_of(stated, [left, right]) {
            for difference in differences(stated, [left, right], site, shown) {
                if out.len() == MOST {
                    return out;
                }
                out.extend(link(stated, &difference, site, shown.frames));
            }
        }
    }
    out
}

/// The sites at which a constraint applies, or a single `None` if it belongs to no site. Constraints on a chain are
/// omitted, since the chain is drawn already.
fn sites_of(stated: &Stated<'_>, sides: [&Expression; 2]) -> Vec<Option<isize>> {
    let named = |name: &str| {
        let of_it = |e: &&Expression| stated.names(e, &|n| n == name);
        sides.iter().any(of_it)
    };
    let mut own = stated.sites.iter().filter(|q| q.moves && named(&q.name));
    match own.next() {
        None => vec![None],
        Some(q) if q.on_line => Vec::new(),
        Some(q) => {
            let sites = q.members.iter().map(|(site, _)| *site);
            sites.map(|s| isize::try_from(s).ok()).collect()
        }
    }
}

/// The differences of points in a constraint.
fn differences(
    stated: &Stated<'_>,
    [left, right]: [&Expression; 2],
    site: Option<isize>,
    shown: PageFrames<'_>,
) -> Vec<Difference> {
    let Some(row) = shown.frames.first() else {
        return Vec::new();
    };
    let at = At { row, site };
    let is_vector = |e: &Expression| {
        let value = stated.value(e, at);
        value.is_some_and(|v| v.ncols() == 1 && (2..=3).contains(&v.nrows()))
    };
    if is_vector(left) || is_vector(right) {
        let sides = [left, right].map(|side| stated.terms(side));
        return joint(stated, sides, shown).into_iter().collect();
    }
    let mut found = Vec::new();
    for side in [left, right] {
        lengths(stated, side, site, shown, &mut found, 0);
    }
    if found.is_empty() {
        found.extend(by_components(stated, [left, right], site, shown));
    }
    found
}

/// The difference of points in an equation of vectors.
fn joint(
    stated: &Stated<'_>,
    [left, right]: [Vec<Term>; 2],
    shown: PageFrames<'_>,
) -> Option<Difference> {
    let of = |side: &[Term]| {
        let own = side
            .iter()
            .filter(|t| place_of(&t.1, shown.places).is_some());
        own.cloned().collect::<Vec<Term>>()
    };
    let moves = |side: &[Term]| side.iter().any(|(_, e)| stated.moves(e));
    let difference = |sides: [Vec<Term>; 2], own: &Term, other: Option<&Term>| {
        let [first, second] = sides.map(|side| signed(side, own.0));
        Difference {
            first,
            second,
            places: [Some(positive(own)), other.map(positive)],
        }
    };
    match (of(&left).as_slice(), of(&right).as_slice()) {
        // Each side is a point, or one side is fixed.
        ([a], [b]) if a.0 == b.0 => Some(difference([left, right], a, Some(b))),
        ([a], []) if !moves(&right) => Some(difference([left, right], a, None)),
        ([], [b]) if !moves(&left) => Some(difference([right, left], b, None)),
        _ => {
            let opposite = right.into_iter().map(|(minus, e)| (!minus, e));
            let all: Vec<Term> = left.into_iter().chain(opposite).collect();
            parted(stated, all, shown)
        }
    }
}

fn positive(term: &Term) -> Term {
    (false, term.1.clone())
}

fn signed(terms: Vec<Term>, turned: bool) -> Vec<Term> {
    let turn = |(minus, e): Term| (minus != turned, e);
    terms.into_iter().map(turn).collect()
}

/// Splits a sum of terms into a difference of two points. `None` if it contains no position, or several positions
/// with the same sign.
fn parted(stated: &Stated<'_>, all: Vec<Term>, shown: PageFrames<'_>) -> Option<Difference> {
    let own = |all: &[Term]| -> Vec<Term> {
        let places = all
            .iter()
            .filter(|t| place_of(&t.1, shown.places).is_some());
        places.cloned().collect()
    };
    let (first, second) = match own(&all).as_slice() {
        [a] => (a.clone(), None),
        [a, b] if a.0 != b.0 => (a.clone(), Some(b.clone())),
        _ => return None,
    };
    let all = signed(all, first.0);
    let name = place_of(&first.1, shown.places)?;
    let other = second.as_ref().and_then(|t| place_of(&t.1, shown.places));
    // A different site of the same field has its own arms.
    let same = other == Some(name);
    let of_first = |(minus, e): &Term| match place_of(e, shown.places) {
        Some(_) => !minus,
        None => !same && shown.ties.joins(stated, e, name),
    };
    let (mine, rest): (Vec<Term>, Vec<Term>) = all.into_iter().partition(of_first);
    Some(Difference {
        first: mine,
        second: signed(rest, true),
        places: [Some(positive(&first)), second.as_ref().map(positive)],
    })
}

/// Lengths `dot(u, u)` within an expression.
fn lengths(
    stated: &Stated<'_>,
    e: &Expression,
    site: Option<isize>,
    shown: PageFrames<'_>,
    found: &mut Vec<Difference>,
    deep: usize,
) {
    // The depth of nested abbreviations is limited.
    if deep > 40 {
        return;
    }
    match &e.kind {
        Kind::Call(f, arguments) if f.text == "dot" => {
            let [u, v] = arguments.as_slice() else {
                return;
            };
            let both = |row: Option<&&[f64]>| {
                let at = At { row: row?, site };
                stated.value(u, at).zip(stated.value(v, at))
            };
            let ends = [shown.frames.first(), shown.frames.last()];
            if ends
                .iter()
                .all(|row| both(*row).is_some_and(|(a, b)| a == b))
            {
                found.extend(parted(stated, stated.terms(u), shown));
            }
        }
        Kind::Name(n) => {
            if let Some(value) = stated.abbreviated(n) {
                lengths(stated, value, site, shown, found, deep + 1);
            }
        }
        _ => {
            for part in e.parts() {
                lengths(stated, part, site, shown, found, deep + 1);
            }
        }
    }
}

/// A length given by components, `x[1]^2 + x[2]^2`: the distance of one position from the origin or from a parameter,
/// whichever distance stays constant along the motion.
fn by_components(
    stated: &Stated<'_>,
    sides: [&Expression; 2],
    site: Option<isize>,
    shown: PageFrames<'_>,
) -> Option<Difference> {
    let mut own = shown.places.iter().filter(|p| {
        let named = |e: &&Expression| stated.names(e, &|n| n == **p);
        sides.iter().any(named)
    });
    let (place, None) = (own.next()?, own.next()) else {
        return None;
    };
    let mut names: Vec<String> = Vec::new();
    let mut squares = false;
    for side in sides {
        side.each(&mut |e| match &e.kind {
            Kind::Name(n) => names.push(n.clone()),
            Kind::Power(e, power) if power.as_integer() == Some(2) => {
                squares |= stated.names(e, &|n| n == *place);
            }
            _ => {}
        });
    }
    if !squares {
        return None;
    }
    let term = |name: &str| {
        let place = sides.first().map(|side| side.place)?;
        let kind = Kind::Name(name.to_owned());
        Some((false, Expression { kind, place }))
    };
    let own = term(place)?;
    let values = |term: &Term| -> Option<Vec<Value>> {
        let each = shown
            .frames
            .iter()
            .map(|row| stated.value(&term.1, At { row, site }));
        each.collect()
    };
    let here = values(&own)?;
    let keeps = |fixed: Option<&Value>| {
        let length = |x: &Value| match fixed {
            Some(p) if p.shape() == x.shape() => (x - p).norm(),
            Some(_) => f64::NAN,
            None => x.norm(),
        };
        let (low, high) = here
            .iter()
            .map(length)
            .fold((f64::INFINITY, 0.0_f64), |(a, b), l| {
                (a.min(l), if l > b || l.is_nan() { l } else { b })
            });
        high > 0.0 && high - low <= HELD * high
    };
    let moves = here.windows(2).any(|pair| pair.first() != pair.last());
    let mut fixed = names.iter().filter(|n| !shown.places.contains(&n.as_str()));
    let about = fixed.find_map(|name| {
        let term = term(name)?;
        let value = stated.value(
            &term.1,
            At {
                row: shown.frames.first()?,
                site,
            },
        )?;
        (scalar(&value).is_none() && keeps(Some(&value))).then_some(term)
    });
    let held = about.is_some() || keeps(None);
    (moves && held).then(|| Difference {
        first: vec![own.clone()],
        second: about.into_iter().collect(),
        places: [Some(own), None],
    })
}

/// The path of a difference: the position of one body, its point, the point of the other body, and the position
/// of that body.
fn link(
    stated: &Stated<'_>,
    difference: &Difference,
    site: Option<isize>,
    frames: &[&[f64]],
) -> Option<Link> {
    let [one, two] = &difference.places;
    let one = one.as_ref()?;
    let points = |row: &[f64]| -> Option<Vec<[f64; 3]>> {
        let at = At { row, site };
        let place = |term: &Term| stated.value(&term.1, at).and_then(|v| point(&v));
        let first = stated.sum(&difference.first, at).and_then(|v| point(&v))?;
        let second = match difference.second.is_empty() {
            true => [0.0; 3],
            false => stated.sum(&difference.second, at).and_then(|v| point(&v))?,
        };
        let mut path = vec![place(one)?, first, second];
        if let Some(two) = two {
            path.push(place(two)?);
        }
        Some(path)
    };
    let paths: Vec<Vec<[f64; 3]>> = frames
        .iter()
        .map(|row| points(row))
        .collect::<Option<_>>()?;
    let size = clebsch::scalar::largest(paths.iter().flatten().flatten().map(|x| x.abs()));
    let near = |a: &[f64; 3], b: &[f64; 3]| {
        let most = clebsch::scalar::largest(a.iter().zip(b).map(|(x, y)| (x - y).abs()));
        most <= STAYS * size
    };
    let start = paths.first()?;
    // A point that coincides with its predecessor in every frame is drawn once.
    let mut kept: Vec<usize> = Vec::new();
    for k in 0..start.len() {
        let same = |j: usize| {
            let both = paths.iter().map(|p| p.get(j).zip(p.get(k)));
            both.flatten().all(|(a, b)| near(a, b))
        };
        if !kept.last().is_some_and(|j| same(*j)) {
            kept.push(k);
        }
    }
    let fixed = start.get(2).filter(|p| {
        let each = paths.iter().filter_map(|path| path.get(2));
        two.is_none() && each.into_iter().all(|q| near(p, q))
    });
    let numbers = |path: &Vec<[f64; 3]>| -> Vec<f64> {
        let own = kept.iter().filter_map(|k| path.get(*k));
        own.flatten().copied().collect()
    };
    Some(Link {
        support: fixed.copied(),
        frames: paths.iter().map(numbers).collect(),
    })
}

/// A vector of the plane or of space as a point of space.
fn point(value: &Value) -> Option<[f64; 3]> {
    let known = value.ncols() == 1 && (2..=3).contains(&value.nrows());
    let entry = |i: usize| value.get((i, 0)).copied().filter(|x| x.is_finite());
    let third = if value.nrows() > 2 { entry(2)? } else { 0.0 };
    known.then_some([entry(0)?, entry(1)?, third])
}
