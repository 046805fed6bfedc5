//! A model with labels as data: the emitted program with loops over sites, or why there is none.

use super::{Data, json};
use crate::Refused;
use clebsch_core::check::spec::Side;
use clebsch_core::line::{self, CoordinateKind, Coordinates, Line};
use clebsch_core::{emit, pipeline};
use serde_json::{Value, json};

/// The program of a model with labels for every number of sites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Looped {
    /// The program.
    Program(Program),
    /// Loops over sites do not support the form of the model; the reason.
    Form(String),
}

/// A program with loops over sites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Program {
    /// The name of the model.
    pub name: String,
    /// The emitted items.
    pub items: String,
    /// The names of the numbers of sites, one for each label.
    pub counts: Vec<String>,
    /// Whether one label is a chain.
    pub has_line: bool,
    /// Whether functionals of all sites occur.
    pub has_functionals: bool,
    /// Whether a step solves for the velocities of all sites together.
    pub is_together: bool,
    /// Conserved totals.
    pub totals: Vec<ConservedTotal>,
    /// The multipliers of the constraints.
    pub holds: Vec<String>,
    /// The group elements that the program stores in coordinates.
    pub coordinates: Vec<Coordinates>,
}

/// A conserved total.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ConservedTotal {
    /// Its name.
    pub name: String,
    /// Why it is conserved.
    pub reason: String,
    /// The terms that it sums over all sites.
    pub density: String,
}

impl Looped {
    /// Derives the program of a text.
    ///
    /// # Errors
    /// [`Refused::Model`], if the text is not a valid model.
    pub fn derive(source: &str) -> Result<Self, Refused> {
        let model = pipeline::parse_source(source).map_err(Refused::Model)?;
        let line = match Line::of(&model) {
            Ok(line) => line,
            Err(line::Refused::Form(why)) => return Ok(Looped::Form(why)),
            Err(line::Refused::Model(errors)) => return Err(Refused::Model(errors)),
        };
        if let Some(why) = emit::refusal_of_line(&line) {
            return Ok(Looped::Form(why));
        }
        let labels = line.lattice.labels.iter();
        let totals = line.totals.iter().map(|t| ConservedTotal {
            name: t.name.clone(),
            reason: t.reason.clone(),
            density: t.text(&line.representative),
        });
        Ok(Looped::Program(Program {
            name: model.name.text.clone(),
            items: emit::emit_line(&line, source).to_string(),
            counts: labels.map(|l| l.count.text.clone()).collect(),
            has_line: line.lattice.line.is_some(),
            has_functionals: !line.lattice.meshes.is_empty(),
            is_together: !line.ties.is_empty(),
            totals: totals.collect(),
            holds: line.holds.iter().map(|h| h.name.clone()).collect(),
            coordinates: line.coordinates.clone(),
        }))
    }
}

impl Data for Looped {
    const KIND: &'static str = "looped";

    fn to_json(&self) -> Value {
        let p = match self {
            Looped::Program(program) => program,
            Looped::Form(why) => return json!({ "form": why }),
        };
        let totals = p.totals.iter();
        let totals: Vec<Value> = totals
            .map(|t| json!({ "name": t.name, "reason": t.reason, "density": t.density }))
            .collect();
        let coordinates: Vec<Value> = p.coordinates.iter().map(of_coordinates).collect();
        json!({
            "name": p.name,
            "items": p.items,
            "counts": p.counts,
            "has_line": p.has_line,
            "has_functionals": p.has_functionals,
            "is_together": p.is_together,
            "totals": totals,
            "holds": p.holds,
            "coordinates": coordinates,
        })
    }

    fn from_json(json: &Value) -> Option<Self> {
        if let Some(why) = json::text(json, "form") {
            return Some(Looped::Form(why));
        }
        Some(Looped::Program(Program {
            name: json::text(json, "name")?,
            items: json::text(json, "items")?,
            counts: json::texts(json, "counts")?,
            has_line: json::truth(json, "has_line")?,
            has_functionals: json::truth(json, "has_functionals")?,
            is_together: json::truth(json, "is_together")?,
            totals: json::list(json, "totals", |own| {
                Some(ConservedTotal {
                    name: json::text(own, "name")?,
                    reason: json::text(own, "reason")?,
                    density: json::text(own, "density")?,
                })
            })?,
            holds: json::texts(json, "holds")?,
            coordinates: json::list(json, "coordinates", coordinates)?,
        }))
    }
}

fn of_coordinates(c: &Coordinates) -> Value {
    let (kind, rows, names) = match &c.by {
        CoordinateKind::Entries(rows) => ("entries", *rows, Vec::new()),
        CoordinateKind::Angle(angle) => ("angle", 0, vec![angle]),
        CoordinateKind::AngleAndPlace(angle, place) => ("angle and place", 0, vec![angle, place]),
        CoordinateKind::TurnAndPlace(turn, place) => ("turn and place", 0, vec![turn, place]),
    };
    json!({
        "name": c.name,
        "is_body": c.side.is_body(),
        "kind": kind,
        "rows": rows,
        "names": names,
        "doc": c.doc,
    })
}

fn coordinates(json: &Value) -> Option<Coordinates> {
    let names = json::texts(json, "names")?;
    let by = match (json::text(json, "kind")?.as_str(), names.as_slice()) {
        ("entries", []) => CoordinateKind::Entries(json::count(json, "rows")?),
        ("angle", [angle]) => CoordinateKind::Angle(angle.clone()),
        ("angle and place", [angle, place]) => {
            CoordinateKind::AngleAndPlace(angle.clone(), place.clone())
        }
        ("turn and place", [turn, place]) => {
            CoordinateKind::TurnAndPlace(turn.clone(), place.clone())
        }
        _ => return None,
    };
    Some(Coordinates {
        name: json::text(json, "name")?,
        side: match json::truth(json, "is_body")? {
            true => Side::Body,
            false => Side::Spatial,
        },
        by,
        doc: json::text(json, "doc")?,
    })
}
