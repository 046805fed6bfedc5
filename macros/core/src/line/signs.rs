//! Signs of unit quaternions: which quantities along the chain occur in a term with their neighbours, whether the
//! term depends on the sign, and at which ends they occur with a prescribed quaternion. Takes the expanded chain;
//! gives the quantities whose signs must agree at the start, since `q` and `-q` are one attitude but two states.

use super::neighbour_force::{self, EndTerm};
use super::{Refused, RepresentativeChain, written};
use crate::algebra::Algebra;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter};
use crate::lattice::{Kind, Lattice};
use crate::pipeline;
use crate::syntax::ast::Model;

/// A unit quaternion that occurs in a term with its neighbour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signs {
    /// The quantity as stated.
    pub of: String,
    /// Whether a term changes if the sign at one site changes.
    pub seen: bool,
    /// The walls at the first end and at the last.
    pub walls: [Vec<Wall>; 2],
}

/// A unit quaternion prescribed by an end condition, in a term with one of a site.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wall {
    /// The index of the alternative.
    pub which: usize,
    /// The parameter as stated.
    pub parameter: String,
    /// The distance of the site from the end.
    pub site: usize,
}

/// The quantities of a model whose signs are made to agree.
///
/// # Errors
/// [`Refused`] if the model contains errors or has a term that cannot be read.
pub fn signs(model: &Model, lattice: &Lattice) -> Result<Vec<Signs>, Refused> {
    let any = lattice.quantities.iter().any(|q| {
        q.kind == Kind::Configuration && lattice.line == Some(q.label) && q.offset.is_none()
    });
    if !any {
        return Ok(Vec::new());
    }
    let choice = pipeline::representative(model, lattice)?;
    let part = written(model, lattice, choice)?;
    if of_line(lattice, &part).is_empty() {
        return Ok(Vec::new());
    }
    let ends = neighbour_force::ends(model, lattice, &part.choice)?;
    of_parts(lattice, &part, &ends)
}

/// The unit quaternions along the chain, as stated.
fn of_line(lattice: &Lattice, part: &RepresentativeChain) -> Vec<String> {
    let own = lattice.quantities.iter().filter(|q| {
        let group = part.copy(&q.name.text, 0).map(|id| is_unit(part, id));
        q.kind == Kind::Configuration && lattice.line == Some(q.label) && group == Some(true)
    });
    own.map(|q| q.name.text.clone()).collect()
}

fn is_unit(part: &RepresentativeChain, id: SymbolId) -> bool {
    let symbol = part.d.letters.symbols.get(id);
    symbol.structure == Structure::UnitQuaternion && symbol.role == Role::Element
}

/// Like `of`, for a chain that is already expanded, with its end conditions.
pub(super) fn of_parts(
    lattice: &Lattice,
    part: &RepresentativeChain,
    ends: &[EndTerm],
) -> Result<Vec<Signs>, Refused> {
    let names = of_line(lattice, part);
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let inner = part.unfolded.summands.iter();
    let inner = inner.filter(|t| t.end.is_none() && !t.of_functionals);
    let mut terms: Vec<Expr> = Vec::new();
    for summand in inner.filter(|t| neighbour_force::lone_at(t).is_none()) {
        terms.extend(neighbour_force::in_two(part, summand)?);
    }
    let algebra = Algebra::new(&part.d.letters.symbols);
    let each = names.into_iter().filter_map(|of| {
        let walls = [false, true].map(|last| walls(ends, last, &of));
        let met: Vec<bool> = terms
            .iter()
            .filter_map(|t| sees(part, &algebra, t, &of))
            .collect();
        let alone = met.is_empty() && walls.iter().all(Vec::is_empty);
        (!alone).then(|| Signs {
            of,
            seen: met.into_iter().any(|seen| seen),
            walls,
        })
    });
    Ok(each.collect())
}

/// Whether a term with two sites of a quantity changes with the sign of one of them; `None` if the term has fewer
/// sites.
fn sees(part: &RepresentativeChain, algebra: &Algebra, term: &Expr, of: &str) -> Option<bool> {
    let s = &part.d.letters.symbols;
    let letters = expr::letters(term).into_iter();
    let own: Vec<(Letter, usize)> = letters
        .filter_map(|l| {
            let at = part.sited(l.symbol).filter(|at| at.of == of)?;
            Some((l, at.site))
        })
        .collect();
    let (_, first) = own.first()?;
    own.iter().any(|(_, site)| site != first).then_some(())?;
    // The velocity of a site does not change with its sign.
    let opposite: Vec<(Letter, Expr)> = own
        .iter()
        .filter(|(_, site)| site == first)
        .map(|(l, _)| (*l, expr::neg(expr::letter(s, l.symbol, l.shift))))
        .collect();
    let other = expr::substitute(s, term, &opposite);
    Some(!algebra.is_zero(&expr::sub(term.clone(), other)))
}

/// The quaternions that an end condition prescribes in terms with this quantity.
fn walls(ends: &[EndTerm], last: bool, of: &str) -> Vec<Wall> {
    let own = ends.iter().filter(|e| e.last == last);
    let each = own.filter_map(|e| {
        let mut all = e.letters.iter();
        let parameter = all.find(|(l, _, site)| {
            site.is_none() && e.symbols.get(l.symbol).structure == Structure::UnitQuaternion
        })?;
        let sites = e.letters.iter().filter(|(_, name, _)| name == of);
        let site = sites.filter_map(|(.., site)| *site).min()?;
        Some(Wall {
            which: e.which,
            parameter: parameter.1.clone(),
            site,
        })
    });
    each.collect()
}
