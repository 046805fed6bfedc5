//! Homogeneous vectors, planes and points that rigid motions advect, and the quantities that they determine. Takes
//! the advected vectors of a model; gives parts of candidates for invariants.

use super::casimir_candidates::Piece;
use super::motions::space_of;
use super::{Candidate, Inputs};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, last_axis, within};
use crate::groups::Euclidean;

/// A homogeneous vector without its last component: the normal of a plane, or the position of a point times its
/// weight.
pub(super) fn spatial_part(s: &Symbols, v: &Expr) -> Expr {
    expr::rows_of(s, v, 0, within(v.shape().rows))
}

/// The last component.
fn weight(v: &Expr) -> Expr {
    let whole = v.shape().rows;
    expr::dot(expr::unit(whole, last_axis(whole)), v.clone())
}

/// The moment of a momentum `(a, l)` about a homogeneous point `(x, w)`, times its weight.
pub(super) fn moment(s: &Symbols, rigid: &dyn Euclidean, momentum: &Expr, point: &Expr) -> Expr {
    let lever = rigid.moment(s, spatial_part(s, point), rigid.linear(s, momentum));
    expr::sub(expr::mul(rigid.angular(s, momentum), weight(point)), lever)
}

/// The parts of homogeneous vectors that rigid motions advect: the normal of a plane or the position of a point,
/// and the moment of a momentum about the point, `w a - x × l` for the weight `w`.
pub(super) fn pieces(x: &Inputs) -> Vec<Piece> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    for a in &x.spec.advected {
        let e = expr::here(s, a.quantity);
        if space_of(x, e.shape()).is_none() {
            continue;
        }
        let name = &s.get(a.quantity).ascii;
        let part = spatial_part(s, &e);
        out.push(Piece {
            name: format!("{name}_part"),
            value: part,
        });
        for (c, id) in x.spec.configurations.iter().zip(&x.letters.node_momentum) {
            let rigid = match c.group.rigid() {
                Some(rigid) if rigid.space() == within(e.shape().rows) => rigid,
                _ => continue,
            };
            let mu = expr::here(s, *id);
            let moment = moment(s, rigid, &mu, &e);
            out.push(Piece {
                name: format!("moment_about_{name}"),
                value: moment,
            });
        }
    }
    out
}

/// Weights of homogeneous points.
pub(super) fn weights(x: &Inputs) -> Vec<Candidate> {
    let s = &x.letters.symbols;
    let list = x.spec.advected.iter().map(|a| a.quantity);
    let list = list.map(|id| (s.get(id).ascii.clone(), expr::here(s, id)));
    let list = list.filter(|(_, e)| space_of(x, e.shape()).is_some());
    list.map(|(name, e)| Candidate {
        name: format!("{name}_weight"),
        value: weight(&e),
    })
    .collect()
}
