//! Scans a document before letters are chosen for parts: names in its equations, dimensions of homogeneous
//! coordinates, and letters that are split into parts.

use super::each_formula;
use super::names::Kind;
use super::rigid_motion_patterns::{homogeneous, last_taken, taken_kind};
use crate::expr::shape::Dim;
use crate::expr::symbol::SymbolId;
use crate::expr::{Constant, Expr, Node};
use crate::print::document::{Block, Document};
use std::collections::BTreeSet;

/// The result of the scan.
pub struct DocumentScan {
    /// Names in displayed equations that are not symbols.
    pub names: BTreeSet<String>,
    /// Dimensions of the homogeneous coordinates.
    pub points: BTreeSet<Dim>,
    /// Letters whose parts occur in the document.
    pub parted: BTreeSet<(Kind, SymbolId)>,
}

impl DocumentScan {
    /// Scans a document.
    pub fn in_document(doc: &Document) -> DocumentScan {
        let mut names = BTreeSet::new();
        // Definitions use dummy letters; a letter in an equation has a fixed meaning.
        for block in doc.sections.iter().flat_map(|s| &s.blocks) {
            if let Block::Equation { formula, .. } = block {
                formula.each_name(&mut |base| {
                    names.insert(base.to_owned());
                });
            }
        }
        let mut points = BTreeSet::new();
        each_formula(doc, &mut |f| {
            f.each_expression(&mut |e| coordinates(e, &mut points));
        });
        let mut parted = BTreeSet::new();
        each_formula(doc, &mut |f| {
            f.each_expression(&mut |e| {
                if has_pi(e) {
                    names.insert("π".to_owned());
                }
                taken_apart(e, &points, &mut parted);
            });
        });
        DocumentScan {
            names,
            points,
            parted,
        }
    }
}

/// Collects the dimensions of homogeneous coordinates that vectors are included into.
fn coordinates(e: &Expr, out: &mut BTreeSet<Dim>) {
    out.extend(homogeneous(e));
    for child in e.children() {
        coordinates(child, out);
    }
}

/// Collects the letters that an expression takes parts of.
fn taken_apart(e: &Expr, points: &BTreeSet<Dim>, out: &mut BTreeSet<(Kind, SymbolId)>) {
    if let Node::Product(list) = e.node() {
        for pair in list.windows(2) {
            if let [head, of] = pair
                && let (Some(kind), Node::Letter(at)) = (taken_kind(head), of.node())
                && of.shape().is_vector()
            {
                out.insert((kind, at.symbol));
            }
        }
    }
    let unit = e
        .children()
        .into_iter()
        .find(|c| matches!(c.node(), Node::Unit(..)));
    if let (Some(at), Some(unit)) = (last_taken(e), unit)
        && points.contains(&unit.shape().rows)
    {
        out.insert((Kind::Point, at.symbol));
    }
    for child in e.children() {
        taken_apart(child, points, out);
    }
}

fn has_pi(e: &Expr) -> bool {
    matches!(e.node(), Node::Constant(c) if *c == Constant::PI)
        || e.children().into_iter().any(has_pi)
}
