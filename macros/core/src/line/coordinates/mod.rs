//! Linear maps, rotations of the plane and rigid motions along a chain, in coordinates. A linear map is represented
//! by its entries, a rotation of the plane by its angle, a rigid motion by its rotation and its position. Takes a
//! model with labels as stated; gives the same action in fields and rotations, which loops over sites support.

mod motions;
mod restated;
#[cfg(test)]
mod tests;

use super::{Refused, written};
use crate::check::spec::Side;
use crate::expr::shape::Dim;
use crate::groups::{self, Chart};
use crate::lattice::Lattice;
use crate::pipeline;
use crate::syntax::ast::{Kind, Model, Size, SizedName, Statement};

/// A configuration of a group that is stored in coordinates.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinates {
    /// Its name.
    pub name: String,
    /// The side of its velocity, in whose frame its momentum is given.
    pub side: Side,
    /// Its coordinates.
    pub by: CoordinateKind,
    /// Its documentation in the model.
    pub doc: String,
}

/// The coordinates of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// The entries of a linear map: a field of matrices with this many rows, of the same name.
    Entries(usize),
    /// The angle of a rotation of the plane: a field of numbers with this name.
    Angle(String),
    /// The angle and the position of a rigid motion of the plane: fields with these names.
    AngleAndPlace(String, String),
    /// The rotation and the position of a rigid motion of space: a configuration of `SO<3>` and a field, with these
    /// names.
    TurnAndPlace(String, String),
}

impl Coordinates {
    /// The names of its coordinates.
    pub fn names(&self) -> Vec<&str> {
        match &self.by {
            CoordinateKind::Entries(_) => vec![&self.name],
            CoordinateKind::Angle(angle) => vec![angle],
            CoordinateKind::AngleAndPlace(first, place)
            | CoordinateKind::TurnAndPlace(first, place) => {
                vec![first, place]
            }
        }
    }

    /// A description of its coordinates.
    pub fn words(&self) -> String {
        let name = &self.name;
        match &self.by {
            CoordinateKind::Entries(_) => format!("{name} by its entries"),
            CoordinateKind::Angle(angle) => format!("{name} by its angle {angle}"),
            CoordinateKind::AngleAndPlace(angle, place) => {
                format!("{name} by its angle {angle} and its place {place}")
            }
            CoordinateKind::TurnAndPlace(turn, place) => {
                format!("{name} by its rotation {turn} and its place {place}")
            }
        }
    }
}

/// A configuration that is stated in a group and stored in coordinates.
struct Stated {
    of: Coordinates,
    velocity: String,
    /// For a rotation, the name of its velocity.
    turning: String,
}

/// The model in coordinates, and the elements concerned; `None` if nothing along the chain requires coordinates.
///
/// # Errors
/// Errors in the model as stated, or a form without such coordinates.
pub(super) fn in_coordinates(
    model: &Model,
    lattice: &Lattice,
) -> Result<Option<(Model, Vec<Coordinates>)>, Refused> {
    let all = stated(model, lattice);
    if all.is_empty() {
        return Ok(None);
    }
    // Errors refer to the model as stated.
    written(model, lattice, pipeline::representative(model, lattice)?)?;
    let restated = restated::restated(model, &all)?;
    Ok(Some((restated, all.into_iter().map(|x| x.of).collect())))
}

/// A valid model in coordinates; unchanged if it needs none.
pub fn restated(model: &Model, lattice: &Lattice) -> Option<Model> {
    restated::restated(model, &stated(model, lattice)).ok()
}

/// The elements that are replaced by coordinates.
fn stated(model: &Model, lattice: &Lattice) -> Vec<Stated> {
    let mut out = Vec::new();
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        let Statement::Group {
            name,
            group,
            velocity,
            ..
        } = statement
        else {
            continue;
        };
        let side = side_of(model, &name.text, &velocity.text);
        let (Some(side), Some(_)) = (side, lattice.find(&name.text)) else {
            continue;
        };
        let own = |letter: &str| fresh(model, letter, &name.text);
        let by = match chart(group) {
            Some(Chart::Entries(n)) => CoordinateKind::Entries(n as usize),
            Some(Chart::Angle) => CoordinateKind::Angle(own("θ")),
            Some(Chart::AngleAndPlace) => CoordinateKind::AngleAndPlace(own("θ"), own("x")),
            Some(Chart::TurnAndPlace) => CoordinateKind::TurnAndPlace(own("R"), own("x")),
            None => continue,
        };
        out.push(Stated {
            of: Coordinates {
                name: name.text.clone(),
                side,
                by,
                doc: docs.join(" "),
            },
            velocity: velocity.text.clone(),
            turning: own("Ω"),
        });
    }
    out
}

/// The coordinates of a group as it is stated.
fn chart(of: &SizedName) -> Option<Chart> {
    let n = u32::try_from(size(of)?).ok()?;
    groups::named(&of.name.text, Dim::Fixed(n))?.chart()
}

/// The size of a group or of a shape, if it is a single number.
fn size(of: &SizedName) -> Option<usize> {
    match of.sizes.as_slice() {
        [Size::Number(n, _)] => usize::try_from(*n).ok(),
        _ => None,
    }
}

/// The side of a configuration's velocity.
fn side_of(model: &Model, element: &str, velocity: &str) -> Option<Side> {
    model.statements.iter().find_map(|s| match s {
        Statement::Constraint { name, value, .. } if name.text == element => {
            let Kind::Product(two) = &value.kind else {
                return None;
            };
            let [Kind::Name(a), Kind::Name(b)] =
                two.iter().map(|e| &e.kind).collect::<Vec<_>>()[..]
            else {
                return None;
            };
            match (a == element && b == velocity, a == velocity && b == element) {
                (true, _) => Some(Side::Body),
                (_, true) => Some(Side::Spatial),
                _ => None,
            }
        }
        _ => None,
    })
}

/// An unused name: a letter with the name of the element.
fn fresh(model: &Model, letter: &str, of: &str) -> String {
    let taken = |name: &str| {
        let mut declared = model.statements.iter().flat_map(Statement::declared);
        declared.any(|n| n.text == name)
    };
    let mut name = format!("{letter}_{of}");
    while taken(&name) {
        name.insert_str(0, letter);
    }
    name
}
