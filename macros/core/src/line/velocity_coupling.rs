//! Neighbour terms that contain velocities: their contributions to the momenta of the sites that they touch. The
//! velocities of these sites are then found together. Letters are letters of the expanded chain.

use super::neighbour_force::{Placed, defined};
use super::{Inertia, Refused, RepresentativeChain, inertia, velocity};
use crate::derive::balance::{pairing, shorter};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Letter, Shift};
use crate::lattice::Lattice;
use crate::{algebra::Algebra, line::BASE};

/// Terms of one range of sites.
#[derive(Clone, Debug)]
pub struct VelocityCoupling {
    /// The label.
    pub label: usize,
    /// The first index of an open chain.
    pub from: usize,
    /// The last index of an open chain, minus the number of segments.
    pub to: isize,
    /// The distance between its letters, in sites.
    pub width: usize,
    /// Its contributions to momenta, with the letters of the first site at the base of the representative.
    pub parts: Vec<Part>,
    /// The terms of the Lagrangian, in positions at the node and velocities.
    pub terms: Expr,
    /// Its contributions to momenta in the limit of small steps, if this limit exists.
    pub inertia: Option<Inertia>,
}

/// The contribution to the momentum of one configuration.
#[derive(Clone, Debug)]
pub struct Part {
    /// The configuration as stated.
    pub on: String,
    /// Its site, relative to the index of the term.
    pub site: usize,
    /// Its velocity.
    pub velocity: Letter,
    /// The contribution to the momentum of the edge on arrival at a node: the derivative with respect to the
    /// velocity.
    pub incoming: Expr,
    /// The increment of the momentum over the edge, in that frame: the derivative with respect to the position.
    pub added: Expr,
    /// The contribution to the momentum of the edge at its start, in the frame there, minus the increment over the
    /// edge.
    pub momentum: Expr,
}

/// Adds a term to the coupling with the same range.
pub(super) fn add_coupling(
    ties: &mut Vec<VelocityCoupling>,
    part: &RepresentativeChain,
    placed: Placed,
) {
    let s = &part.d.letters.symbols;
    let term = expr::substitute(s, &placed.term, &part.d.spec.end_of_edge());
    let mut known = ties.iter_mut();
    match known.find(|t| t.label == placed.label && t.from == placed.from && t.to == placed.to) {
        Some(tie) => {
            tie.width = tie.width.max(placed.width);
            tie.terms = expr::add(tie.terms.clone(), term);
        }
        None => ties.push(VelocityCoupling {
            label: placed.label,
            from: placed.from,
            to: placed.to,
            width: placed.width,
            parts: Vec::new(),
            terms: term,
            inertia: None,
        }),
    }
}

/// Splits neighbour terms, together with the nodal terms of the same range. The part that vanishes at zero velocity
/// is the coupling, and the remainder is nodal, so differences stay together.
pub(super) fn settle(
    part: &RepresentativeChain,
    tie: &mut VelocityCoupling,
    nodal: Option<&Expr>,
) -> Expr {
    let d = &part.d;
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let [arriving, leaving] = part.shares();
    let end = d.spec.end_of_edge();
    let on_edge = |e: &Expr| {
        let next = expr::shift_time(s, e, Shift::NEXT.time);
        let next = expr::substitute(s, &next, &end);
        expr::add(expr::scale(leaving, e.clone()), expr::scale(arriving, next))
    };
    let mut whole = tie.terms.clone();
    if let Some(nodal) = nodal {
        whole = expr::add(whole, on_edge(nodal));
    }
    let configurations = d.spec.configurations.iter();
    let still: Vec<(Letter, Expr)> = configurations
        .map(|c| (velocity::letter(c), c.group.identity()))
        .collect();
    let at_rest = algebra.shortest(&expr::substitute(s, &whole, &still));
    // The stated differences vanish at zero velocity.
    if at_rest.is_zero() && d.spec.configurations.iter().any(velocity::turns) {
        tie.terms = whole;
        return at_rest;
    }
    tie.terms = algebra.shortest(&expr::sub(whole, on_edge(&at_rest)));
    at_rest
}

/// Finds the contributions of the terms, which must be to fields and rotations of one kind of sites, at adjacent
/// sites.
pub(super) fn finish(
    lattice: &Lattice,
    part: &RepresentativeChain,
    ties: &mut [VelocityCoupling],
) -> Result<(), Refused> {
    let d = &part.d;
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let here = |symbol| Letter {
        symbol,
        shift: Shift::HERE,
    };
    for tie in ties.iter_mut() {
        if tie.width > 1 {
            return Err(Refused::Form(
                "a term contains velocities of sites that are not neighbours".to_owned(),
            ));
        }
        tie.terms = defined(part, &tie.terms)?;
        for (i, c) in d.spec.configurations.iter().enumerate() {
            let Some(at) = part.sited(c.element) else {
                continue;
            };
            let of = |letter| -> Expr {
                let gradient = expr::gradient(s, &tie.terms, letter);
                match gradient.is_zero() {
                    true => expr::zero(c.group.shape()),
                    false => shorter(&algebra, gradient),
                }
            };
            // The covector of a variation of all letters in the terms.
            let along = |(letter, change): (Letter, Expr)| -> Expr {
                let gradient = expr::gradient(s, &tie.terms, letter);
                let paired = expr::sum([pairing(&d.letters, &gradient, &change)], Shape::SCALAR);
                let own = here(d.letters.variation[i]);
                shorter(
                    &algebra,
                    c.group.of_gradient(s, expr::gradient(s, &paired, own)),
                )
            };
            if !expr::contains(&tie.terms, here(c.velocity))
                && !expr::contains(&tie.terms, here(c.element))
            {
                continue;
            }
            if !velocity::is_free(c) {
                return Err(Refused::Form(format!(
                    "a term contains the velocity of `{}` and that of a neighbour: loops over sites support this for fields \
                     and rotations of SO<3> on the body side",
                    at.of
                )));
            }
            let [incoming, added, momentum] = match velocity::turns(c) {
                false => {
                    let (by_velocity, by_place) = (of(here(c.velocity)), of(here(c.element)));
                    let momentum = expr::sub(by_velocity.clone(), by_place.clone());
                    [by_velocity, by_place, momentum]
                }
                true => {
                    let v = &d.variations[i];
                    let coming = expr::shift_time(s, &v.incoming.1, Shift::NEXT.time);
                    let going = expr::neg(v.outgoing.1.clone());
                    let velocity = here(c.velocity);
                    let leaving = along((velocity, going));
                    let added = along(v.element.clone());
                    // The difference is often shorter than either expression.
                    let momentum = shorter(&algebra, expr::sub(leaving, added.clone()));
                    [along((velocity, coming)), added, momentum]
                }
            };
            tie.parts.push(Part {
                on: at.of,
                site: at.site - BASE,
                velocity: here(c.velocity),
                incoming,
                added,
                momentum,
            });
        }
    }
    for tie in ties.iter_mut() {
        tie.inertia = inertia::of_tie(part, tie);
    }
    let mut kinds = ties.iter().flat_map(|t| &t.parts);
    let kind = |on: &str| lattice.find(on).map(|q| (q.label, q.sites));
    if let Some(first) = kinds.next()
        && let Some(other) = kinds.find(|p| kind(&p.on) != kind(&first.on))
    {
        return Err(Refused::Form(format!(
            "a term contains velocities at two kinds of sites, of `{}` and of `{}`",
            first.on, other.on
        )));
    }
    Ok(())
}

impl VelocityCoupling {
    /// The derivative of the momentum of one part with respect to the velocity of another, columns side by side.
    pub fn columns(&self, part: &RepresentativeChain, of: &Part, by: &Part) -> Vec<Expr> {
        let s = &part.d.letters.symbols;
        let mut all = part.d.spec.configurations.iter();
        let c = all.find(|c| c.velocity == by.velocity.symbol);
        let columns = c.and_then(|c| velocity::columns(s, &of.momentum, c));
        columns.unwrap_or_default()
    }
}
