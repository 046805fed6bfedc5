//! Converts group elements and their momenta between the form that users see and the coordinates that a chain stores.
//! Numbers are listed for all sites, one site after the other, matrices in row-major order.

use super::{Numbers, Unstarted};
use crate::text;
use clebsch::card::{Field, Kind, OpenError};
use clebsch::groups::invertible_map;
use clebsch::linalg::Dense;
use clebsch::line::{LineError, Place};
use clebsch::of_numbers::OfNumbers;
use clebsch::validate;
use clebsch::{Orthogonal, ParameterError, PlaneMotion, RigidMotion, StartError};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::line::{CoordinateKind, Coordinates};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// The role of a variable of the program in the form that users see.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum UserRole {
    /// Users see the element instead.
    Element,
    /// Users see the momentum of the element instead.
    Momentum,
    /// The element or its momentum already contains it.
    Rest,
}

/// Rows of the matrix of an element, and the shape of a momentum.
fn sizes(c: &Coordinates) -> (usize, [usize; 2]) {
    match &c.by {
        CoordinateKind::Entries(n) => (*n, [*n, *n]),
        CoordinateKind::Angle(_) => (2, [2, 2]),
        CoordinateKind::AngleAndPlace(..) => (3, [3, 1]),
        CoordinateKind::TurnAndPlace(..) => (4, [6, 1]),
    }
}

/// The initial momentum that the user gives.
fn given_momentum(c: &Coordinates) -> String {
    let frame = c.side.of("body", "spatial");
    format!("{frame}_momentum_{}", c.name)
}

/// The names under which an element and its momenta are shown.
pub(super) fn shown(c: &Coordinates) -> [String; 3] {
    let of = |what: &str| format!("{what}{}", c.name);
    ["", "body_momentum_", "spatial_momentum_"].map(of)
}

/// The role of a variable of the program, by its name or its ASCII name.
pub(super) fn of(c: &Coordinates, name: &str) -> Option<UserRole> {
    let is = |prefix: &str, own: &str| {
        let whole = format!("{prefix}{own}");
        name == whole || name == ascii(&whole)
    };
    let (first, place) = match &c.by {
        CoordinateKind::Entries(_) => (&c.name, None),
        CoordinateKind::Angle(angle) => (angle, None),
        CoordinateKind::AngleAndPlace(first, place)
        | CoordinateKind::TurnAndPlace(first, place) => (first, Some(place)),
    };
    let of_turn = matches!(c.by, CoordinateKind::TurnAndPlace(..));
    let momentum = if of_turn {
        "body_momentum_"
    } else {
        "momentum_"
    };
    if is("", first) {
        return Some(UserRole::Element);
    }
    if is(momentum, first) {
        return Some(UserRole::Momentum);
    }
    let beside = place.is_some_and(|p| is("", p) || is("momentum_", p));
    (beside || of_turn && is("spatial_momentum_", first)).then_some(UserRole::Rest)
}

/// The fields of a card of an element and of its momenta.
pub(super) fn fields(
    c: &Coordinates,
    site: usize,
    momenta: bool,
    initial: bool,
) -> Vec<(Field, String)> {
    let (rows, [high, wide]) = sizes(c);
    let kind = match &c.by {
        CoordinateKind::Entries(_) => Kind::Matrix,
        CoordinateKind::Angle(_) => Kind::Rotation,
        CoordinateKind::AngleAndPlace(..) | CoordinateKind::TurnAndPlace(..) => Kind::RigidMotion,
    };
    let [element, body, spatial] = shown(c);
    let own = match momenta {
        false => vec![(kind, element, [rows, rows], c.doc.as_str())],
        true => vec![
            (
                Kind::BodyMomentum,
                body,
                [high, wide],
                "momentum, body frame",
            ),
            (
                Kind::SpatialMomentum,
                spatial,
                [high, wide],
                "momentum, space frame",
            ),
        ],
    };
    let asked = given_momentum(c);
    own.into_iter()
        .filter(|(_, name, ..)| !momenta || !initial || *name == asked)
        .map(|(kind, name, shape, doc)| {
            let field = kind.field(text(&format!("{name}_{site}")), shape, text(doc));
            let key = ascii(&name);
            (field.spelt(text(&format!("{key}_{site}"))), key)
        })
        .collect()
}

/// Whether every given matrix is an element.
pub(super) fn admit(c: &Coordinates, numbers: &Numbers<'_>) -> Result<(), Unstarted> {
    let quantity = text(&c.name);
    let missing = || Unstarted::Missing(c.name.clone());
    let list = numbers(&c.name).ok_or_else(missing)?;
    let (rows, _) = sizes(c);
    for (site, one) in list.chunks(rows * rows).enumerate() {
        let read = match &c.by {
            CoordinateKind::Entries(_) => invertible_map(&square(one, rows))
                .map_err(|e| OpenError::Start(StartError::Initial(e.in_field(quantity)))),
            CoordinateKind::Angle(_) => Orthogonal::<2>::of_numbers(quantity, one).map(|_| ()),
            CoordinateKind::AngleAndPlace(..) => PlaneMotion::of_numbers(quantity, one).map(|_| ()),
            CoordinateKind::TurnAndPlace(..) => RigidMotion::of_numbers(quantity, one).map(|_| ()),
        };
        match read {
            Ok(()) => {}
            Err(OpenError::Start(StartError::Initial(error)) | OpenError::Parameter(error)) => {
                let at = Place { quantity, site };
                return Err(LineError::Site { at, error }.into());
            }
            Err(_) => {
                return Err(Unstarted::Components {
                    quantity: c.name.clone(),
                    components: rows * rows,
                    found: list.len(),
                });
            }
        }
    }
    momenta_of_the_plane(c, numbers)
}

/// Whether every momentum of a rotation of the plane is skew.
fn momenta_of_the_plane(c: &Coordinates, numbers: &Numbers<'_>) -> Result<(), Unstarted> {
    let name = given_momentum(c);
    let (CoordinateKind::Angle(_), Some(list)) = (&c.by, numbers(&name)) else {
        return Ok(());
    };
    let quantity = text(&name);
    for (site, one) in list.chunks_exact(4).enumerate() {
        let at = Place { quantity, site };
        validate::skew(quantity, &Matrix2::from_row_slice(one))
            .map_err(|error| LineError::Site { at, error })?;
    }
    Ok(())
}

fn square(list: &[f64], rows: usize) -> Dense<f64> {
    let entry = |i: usize, j: usize| list.get(i * rows + j).copied().unwrap_or(f64::NAN);
    Dense::from_fn(rows, rows, entry)
}

/// The rows of a matrix, one after the other.
fn by_rows(a: &Dense<f64>) -> Vec<f64> {
    a.transpose().data
}

/// The rotation and the position of a homogeneous matrix in three dimensions.
fn of_space(one: &[f64]) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let [a, b, c, x, d, e, f, y, g, h, i, z, ..] = *one else {
        return None;
    };
    Some((
        Matrix3::new(a, b, c, d, e, f, g, h, i),
        Vector3::new(x, y, z),
    ))
}

/// Like `of_space`, in two dimensions.
fn of_plane(one: &[f64]) -> Option<(Matrix2<f64>, Vector2<f64>)> {
    let [a, b, x, c, d, y, ..] = *one else {
        return None;
    };
    Some((Matrix2::new(a, b, c, d), Vector2::new(x, y)))
}

/// The values of a variable of the program, computed from the elements and momenta that the user gives.
pub(super) fn given(c: &Coordinates, name: &str, numbers: &Numbers<'_>) -> Option<Vec<f64>> {
    let asked = of(c, name)?;
    let (rows, [high, wide]) = sizes(c);
    let body = c.side.is_body();
    let elements = numbers(&c.name)?;
    if asked == UserRole::Element && matches!(c.by, CoordinateKind::Entries(_)) {
        return Some(elements);
    }
    let is_of_place = asked == UserRole::Rest;
    let of_momentum = name.starts_with("momentum_") || name.starts_with("body_momentum_");
    let momenta = match of_momentum {
        true => numbers(&given_momentum(c))?,
        false => vec![0.0; elements.len() / (rows * rows) * high * wide],
    };
    let each = elements
        .chunks_exact(rows * rows)
        .zip(momenta.chunks_exact(high * wide));
    let mut out = Vec::new();
    for (g, m) in each {
        match &c.by {
            CoordinateKind::Entries(n) => {
                let back = square(g, *n).inverse()?.transpose();
                let m = square(m, *n);
                let own = if body { back.times(&m) } else { m.times(&back) };
                out.extend(by_rows(&own));
            }
            CoordinateKind::Angle(_) => out.push(if of_momentum { m[2] } else { g[2].atan2(g[0]) }),
            CoordinateKind::AngleAndPlace(..) => {
                let (turn, x) = of_plane(g)?;
                let (about, linear) = (m[0], Vector2::new(m[1], m[2]));
                let p = if body { turn * linear } else { linear };
                match (of_momentum, is_of_place) {
                    (false, false) => out.push(g[3].atan2(g[0])),
                    (false, true) => out.extend([x[0], x[1]]),
                    (true, false) if body => out.push(about),
                    (true, false) => out.push(about - (x[0] * p[1] - x[1] * p[0])),
                    (true, true) => out.extend([p[0], p[1]]),
                }
            }
            CoordinateKind::TurnAndPlace(..) => {
                let (turn, x) = of_space(g)?;
                let (about, linear) = (
                    Vector3::new(m[0], m[1], m[2]),
                    Vector3::new(m[3], m[4], m[5]),
                );
                let p = if body { turn * linear } else { linear };
                match (of_momentum, is_of_place) {
                    (false, false) => out.extend_from_slice(turn.transpose().as_slice()),
                    (false, true) => out.extend_from_slice(x.as_slice()),
                    (true, false) if body => out.extend_from_slice(about.as_slice()),
                    (true, false) => {
                        out.extend_from_slice(turn.tr_mul(&(about - x.cross(&p))).as_slice());
                    }
                    (true, true) => out.extend_from_slice(p.as_slice()),
                }
            }
        }
    }
    Some(out)
}

/// An error that names elements and momenta as users know them.
pub(super) fn named(all: &[Coordinates], e: LineError) -> LineError {
    let known = |quantity: &'static str| {
        let mut found = all.iter().filter(|c| of(c, quantity).is_some());
        match found.next() {
            Some(c) if quantity.contains("momentum_") => text(&given_momentum(c)),
            Some(c) => text(&c.name),
            None => quantity,
        }
    };
    let there = |at: Place| Place {
        quantity: known(at.quantity),
        ..at
    };
    match e {
        LineError::Site { at, error } => LineError::Site {
            at: there(at),
            error: ParameterError {
                field: known(error.field),
                ..error
            },
        },
        LineError::Step {
            node,
            at,
            cause,
            works,
        } => LineError::Step {
            node,
            at: there(at),
            cause,
            works,
        },
        other => other,
    }
}

/// The elements or momenta that users see, computed from the variables of the program.
pub(super) fn user_coordinates(
    c: &Coordinates,
    name: &str,
    mut seen: impl FnMut(&str) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let [element, body, spatial] = shown(c);
    let in_body = name == body;
    if name != element && !in_body && name != spatial {
        return None;
    }
    let is_element = name == element;
    let mut out = Vec::new();
    match &c.by {
        CoordinateKind::Entries(n) => {
            let places = seen(&c.name)?;
            if is_element {
                return Some(places);
            }
            let momenta = seen(&format!("momentum_{}", c.name))?;
            let size = n * n;
            for (q, p) in places.chunks_exact(size).zip(momenta.chunks_exact(size)) {
                let (q, p) = (square(q, *n).transpose(), square(p, *n));
                out.extend(by_rows(&if in_body { q.times(&p) } else { p.times(&q) }));
            }
        }
        CoordinateKind::Angle(angle) => {
            let list = match is_element {
                true => seen(angle)?,
                false => seen(&format!("momentum_{angle}"))?,
            };
            for x in list {
                let (cos, sin) = (x.cos(), x.sin());
                out.extend(match is_element {
                    true => [cos, -sin, sin, cos],
                    false => [0.0, -x, x, 0.0],
                });
            }
        }
        CoordinateKind::AngleAndPlace(angle, place) => {
            let (angles, places) = (seen(angle)?, seen(place)?);
            let about = seen(&format!("momentum_{angle}"))?;
            let linear = seen(&format!("momentum_{place}"))?;
            let each = angles.iter().zip(places.chunks_exact(2));
            for ((a, x), (m, p)) in each.zip(about.iter().zip(linear.chunks_exact(2))) {
                let (cos, sin) = (a.cos(), a.sin());
                out.extend(match (is_element, in_body) {
                    (true, _) => vec![cos, -sin, x[0], sin, cos, x[1], 0.0, 0.0, 1.0],
                    (_, true) => vec![*m, cos * p[0] + sin * p[1], cos * p[1] - sin * p[0]],
                    _ => vec![m + (x[0] * p[1] - x[1] * p[0]), p[0], p[1]],
                });
            }
        }
        CoordinateKind::TurnAndPlace(turn, place) => {
            let (turns, places) = (seen(turn)?, seen(place)?);
            let about = seen(&format!("body_momentum_{turn}"))?;
            let linear = seen(&format!("momentum_{place}"))?;
            let each = turns.chunks_exact(9).zip(places.chunks_exact(3));
            let momenta = about.chunks_exact(3).zip(linear.chunks_exact(3));
            for ((r, x), (m, p)) in each.zip(momenta) {
                if is_element {
                    for (row, x) in r.chunks_exact(3).zip(x) {
                        out.extend_from_slice(row);
                        out.push(*x);
                    }
                    out.extend([0.0, 0.0, 0.0, 1.0]);
                    continue;
                }
                let turn = Matrix3::from_row_slice(r);
                let [x, m, p] = [x, m, p].map(Vector3::from_column_slice);
                let (about, linear) = match in_body {
                    true => (m, turn.tr_mul(&p)),
                    false => (turn * m + x.cross(&p), p),
                };
                out.extend_from_slice(about.as_slice());
                out.extend_from_slice(linear.as_slice());
            }
        }
    }
    Some(out)
}
