//! Homogeneous vectors of four components, planes and points that rigid motions carry: what can be
//! read from them. Takes the advected vectors of a model; gives parts of candidates for invariants.

use super::words::Piece;
use super::{Candidate, Inputs, length};
use crate::derive::bracket;
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// The first three components of a homogeneous vector: the normal of a plane, the place of a point
/// times its weight.
pub(super) fn spatial_part(s: &Symbols, v: &Expr) -> Expr {
    let taken = expr::inclusion(Dim::Fixed(4), Dim::Fixed(3), 0);
    expr::mul(expr::transpose(s, taken), v.clone())
}

/// The moment of a momentum `(a, l)` about a homogeneous point `(x, w)`, times its weight.
pub(super) fn moment(s: &Symbols, momentum: &Expr, point: &Expr) -> Expr {
    let weight = expr::dot(expr::unit(Dim::Fixed(4), 3), point.clone());
    let lever = expr::cross(spatial_part(s, point), bracket::linear(s, momentum));
    expr::sub(expr::mul(bracket::angular(s, momentum), weight), lever)
}

/// What is read from homogeneous vectors that rigid motions carry: the normal of a plane or the
/// place of a point, and the moment of a momentum about the point, `w a - x × l` for the weight `w`.
pub(super) fn pieces(x: &Inputs) -> Vec<Piece> {
    let s = &x.letters.symbols;
    let four = Dim::Fixed(4);
    let mut out = Vec::new();
    for a in &x.spec.advected {
        let e = expr::here(s, a.quantity);
        if e.shape() != Shape::vector(four) {
            continue;
        }
        let name = &s.get(a.quantity).ascii;
        let part = spatial_part(s, &e);
        out.push(Piece {
            name: format!("{name}_part"),
            size: length(x, &part),
            value: part,
        });
        for (c, id) in x.spec.configurations.iter().zip(&x.letters.node_momentum) {
            if !c.group.is_rigid() {
                continue;
            }
            let mu = expr::here(s, *id);
            let moment = moment(s, &mu, &e);
            out.push(Piece {
                name: format!("moment_about_{name}"),
                size: expr::mul(length(x, &mu), length(x, &e)),
                value: moment,
            });
        }
    }
    out
}

/// Weights of homogeneous points.
pub(super) fn weights(x: &Inputs) -> Vec<Candidate> {
    let s = &x.letters.symbols;
    let four = Dim::Fixed(4);
    let list = x.spec.advected.iter().map(|a| a.quantity);
    let list = list.map(|id| (s.get(id).ascii.clone(), expr::here(s, id)));
    let list = list.filter(|(_, e)| e.shape() == Shape::vector(four));
    list.map(|(name, e)| Candidate {
        name: format!("{name}_weight"),
        value: expr::dot(expr::unit(four, 3), e.clone()),
        scale: length(x, &e),
    })
    .collect()
}
