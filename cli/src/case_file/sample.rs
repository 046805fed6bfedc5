//! The sample case of a fluid: its domain, particles on a lattice, and expressions in the position for depth
//! and velocities.
//! Takes a card; gives the tables of a case file.

use super::space::Space;
use super::stated::Stated;
use clebsch::card::{Card, Kind as FieldKind};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{Kind, Quantity};
use std::fmt::Write as _;

/// The table of the domain.
pub(super) fn domain(text: &mut String, stated: &Stated, space: &Space) {
    let (torus, d) = (Space::torus(stated), space.lengths.len());
    text.push_str(
        "# Expressions below may also contain the position x, y, the lengths Lx, Ly of the domain, and values at the same \
         sites.\n",
    );
    let _ = writeln!(
        text,
        "\n[domain]\n{} = {:?}     # along each direction",
        torus.unwrap_or("lengths"),
        space.lengths
    );
    if torus.is_none() {
        let walls = vec!["\"periodic\""; d].join(", ");
        let _ = writeln!(
            text,
            "walls = [{walls}]     # \"periodic\" or \"solid\" for each direction"
        );
    }
}

/// Parameters and initial values.
pub(super) fn tables(text: &mut String, card: &Card, stated: &Stated, space: &Space) {
    let quantities = &stated.lattice.quantities;
    let is_sited = |q: &Quantity, field: &str| {
        field
            .rsplit_once('_')
            .is_some_and(|(base, _)| base == ascii(&q.name.text))
    };
    let _ = writeln!(text, "\n[parameters]");
    for q in quantities.iter().filter(|q| q.kind == Kind::Parameter) {
        let name = ascii(&q.name.text);
        let _ = match stated.lattice.is_grid(q.label) {
            true => writeln!(text, "# {name}: if omitted, the trapezoid rule"),
            false => writeln!(
                text,
                "{name} = {{ depth = \"1 + 0.1*cos(2*pi*x/Lx)\" }}     # a particle's share of this depth; or a number, an expression, a list"
            ),
        };
    }
    let of_meshes = |name: &str| {
        let mut all = stated.lattice.meshes.iter();
        all.any(|m| m.arguments.iter().skip(1).any(|a| ascii(&a.text) == name))
    };
    let of_space = |name: &str| {
        let torus = Space::torus(stated).map(ascii);
        let grid = stated
            .lattice
            .labels
            .iter()
            .any(|l| l.grid && ascii(&l.index.text) == name);
        grid || name == "domain" || torus.as_deref() == Some(name)
    };
    for field in card.parameters {
        let sited = quantities.iter().any(|q| is_sited(q, field.ascii));
        if sited || of_space(field.ascii) || field.kind != FieldKind::Scalar {
            continue;
        }
        // Besides positions, functionals take lengths within the domain, and strengths.
        let value = if of_meshes(field.ascii) { 0.1 } else { 1.0 };
        let _ = writeln!(text, "{} = {value:?}     # {}", field.ascii, field.doc);
    }
    let _ = writeln!(text, "\n[initial]");
    for q in quantities.iter().filter(|q| q.kind == Kind::Configuration) {
        let name = ascii(&q.name.text);
        let (start, velocity) = match space.lengths.len() {
            // Scalar configurations of the particles other than their positions.
            _ if q.domain.is_none() && q.shape.name.text == "Real" => ("0.0", "0.0"),
            1 => ("{ lattice = \"square\" }", "\"0.1*sin(2*pi*x/Lx)\""),
            _ => (
                "{ lattice = \"brick\", jitter = 0.1, seed = 1 }     # or square, hex, random; or expressions of the index",
                "[\"0.1*sin(2*pi*y/Ly)\", \"0\"]",
            ),
        };
        let _ = writeln!(text, "{name} = {start}");
        let _ = writeln!(
            text,
            "velocity_{name} = {velocity}     # or momentum_{name}"
        );
    }
}
