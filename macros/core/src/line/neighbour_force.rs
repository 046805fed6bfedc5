//! Contributions of neighbour terms and of end conditions to the momenta of the sites that they touch: derivatives
//! of one term along the variations of the expanded chain. All act at a node in time, on covectors of the side of
//! each configuration.

use super::site::BASE;
use super::velocity_coupling::{self, VelocityCoupling};
use super::{Refused, RepresentativeChain, written};
use crate::derive::action;
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::balance::{pairing, shorter};
use crate::derive::reduction::is_singular;
use crate::expr::shape::Shape;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};
use crate::lattice::{ChainConfig, Lattice, Sites, Summand};
use crate::syntax::ast::Model;
use crate::{algebra::Algebra, check};

/// The force on one configuration.
#[derive(Clone, Debug)]
pub struct Force {
    /// The configuration as stated.
    pub on: String,
    /// Its site, relative to the index of the term; for an end condition, counted from that end.
    pub site: usize,
    /// The covector, in full at one node.
    pub value: Expr,
}

/// Terms of one range of sites.
#[derive(Clone, Debug)]
pub struct NeighbourForce {
    /// The label.
    pub label: usize,
    /// The first index of an open chain.
    pub from: usize,
    /// The last index of an open chain, minus the number of segments.
    pub to: isize,
    /// The distance between its letters, in sites.
    pub width: usize,
    /// Its forces, with the letters of the first site at the base of the representative.
    pub forces: Vec<Force>,
    /// The terms of the Lagrangian, in the same letters.
    pub terms: Expr,
}

/// The contributions of one end condition.
#[derive(Clone, Debug)]
pub struct EndTerm {
    /// Whether it belongs to the last site.
    pub last: bool,
    /// The index of the alternative.
    pub which: usize,
    /// The forces, on sites counted from the end.
    pub forces: Vec<Force>,
    /// The terms of the Lagrangian.
    pub terms: Expr,
    /// The letters with their bindings: the name as stated, and the site counted from the end, or none for parameters
    /// of the end condition.
    pub letters: Vec<(Letter, String, Option<usize>)>,
    /// The symbols of the letters.
    pub symbols: crate::expr::symbol::Symbols,
}

/// The kind of sites that each have this term on their own; None for a neighbour term.
pub(super) fn lone_at(summand: &Summand) -> Option<Sites> {
    let [(sites, 0)] = summand.letters.as_slice() else {
        return None;
    };
    let range = summand.range?;
    let last = match sites {
        Sites::Nodes => 0,
        Sites::Segments | Sites::Members => -1,
    };
    (range.from == 0 && range.to == last).then_some(*sites)
}

/// A term with the range of its sites; the letters of the first site are at the base of the representative.
pub(super) struct Placed {
    /// The label.
    pub label: usize,
    /// The first index of an open chain.
    pub from: usize,
    /// The last index, minus the number of segments.
    pub to: isize,
    /// The distance between its letters, in sites.
    pub width: usize,
    /// The term.
    pub term: Expr,
}

/// The term of a summand in its range; `None` if it contains no letter of a site, and is constant.
fn placed(
    lattice: &Lattice,
    part: &RepresentativeChain,
    summand: &Summand,
    term: &Expr,
) -> Result<Option<Placed>, Refused> {
    let Some(range) = summand.range else {
        return Ok(None);
    };
    let first = summand.letters.iter().map(|(_, o)| *o).min().unwrap_or(0);
    let at = isize::try_from(summand.site).unwrap_or(0) + first;
    let by = isize::try_from(BASE).unwrap_or(0) - at;
    let Some(term) = part.moved(term, by) else {
        return Err(Refused::Form(
            "a term reaches too far along the chain".to_owned(),
        ));
    };
    if first != 0 && lattice.periodic.is_some() && !keeps(lattice, part, &term) {
        return Err(Refused::Form(
            "a term with the previous site changes when fields grow by their offsets".to_owned(),
        ));
    }
    let from = usize::try_from(range.from + first)
        .map_err(|_| Refused::Form("a term begins before the chain".to_owned()))?;
    Ok(Some(Placed {
        label: range.label,
        from,
        to: range.to + first,
        width: summand.width,
        term,
    }))
}

/// The terms of neighbours: nodal terms, and terms with velocities.
pub(super) fn pulls(
    lattice: &Lattice,
    part: &RepresentativeChain,
) -> Result<(Vec<NeighbourForce>, Vec<VelocityCoupling>), Refused> {
    let mut out: Vec<NeighbourForce> = Vec::new();
    let mut ties: Vec<VelocityCoupling> = Vec::new();
    let inner = part.unfolded.summands.iter().filter(|t| t.end.is_none());
    for summand in inner.filter(|t| lone_at(t).is_none() && !t.of_functionals) {
        let [edge, nodal] = gathered(part, summand)?;
        if !edge.is_zero()
            && let Some(placed) = placed(lattice, part, summand, &edge)?
        {
            velocity_coupling::add_coupling(&mut ties, part, placed);
        }
        if nodal.is_zero() {
            continue;
        }
        let Some(placed) = placed(lattice, part, summand, &nodal)? else {
            continue;
        };
        let known = out
            .iter_mut()
            .find(|p| p.label == placed.label && p.from == placed.from && p.to == placed.to);
        match known {
            Some(pull) => {
                pull.width = pull.width.max(placed.width);
                pull.terms = expr::add(pull.terms.clone(), placed.term);
            }
            None => out.push(NeighbourForce {
                label: placed.label,
                from: placed.from,
                to: placed.to,
                width: placed.width,
                forces: Vec::new(),
                terms: placed.term,
            }),
        }
    }
    for tie in &mut ties {
        let same = |p: &NeighbourForce| (p.label, p.from, p.to) == (tie.label, tie.from, tie.to);
        let known = out.iter().position(same);
        let at_node =
            velocity_coupling::settle(part, tie, known.and_then(|i| out.get(i)).map(|p| &p.terms));
        match known {
            Some(i) if at_node.is_zero() => {
                out.remove(i);
            }
            Some(i) => out[i].terms = at_node,
            None if at_node.is_zero() => {}
            None => out.push(NeighbourForce {
                label: tie.label,
                from: tie.from,
                to: tie.to,
                width: tie.width,
                forces: Vec::new(),
                terms: at_node,
            }),
        }
    }
    ties.retain(|tie| !tie.terms.is_zero());
    velocity_coupling::finish(lattice, part, &mut ties)?;
    for pull in &mut out {
        pull.terms = defined(part, &pull.terms)?;
        pull.forces = forces(part, &pull.terms)
            .into_iter()
            .map(|f| Force {
                site: f.site - BASE,
                ..f
            })
            .collect();
    }
    Ok((out, ties))
}

/// Whether a term is invariant if all copies of a field are shifted equally, as happens once around a ring.
fn keeps(lattice: &Lattice, part: &RepresentativeChain, term: &Expr) -> bool {
    let s = &part.d.letters.symbols;
    let algebra = Algebra::new(s);
    let mut grown = lattice.quantities.iter().filter(|q| q.offset.is_some());
    grown.all(|q| {
        let letters = expr::letters(term).into_iter();
        let is_own = |l: &Letter| part.sited(l.symbol).is_some_and(|at| at.of == q.name.text);
        let own: Vec<Letter> = letters.filter(is_own).collect();
        let Some(first) = own.first() else {
            return true;
        };
        // The amount is arbitrary: the first letter itself.
        let by = expr::letter(s, first.symbol, first.shift);
        let changes: Vec<(Letter, Expr)> = own.iter().map(|l| (*l, by.clone())).collect();
        algebra.is_zero(&expr::directional(s, term, &changes))
    })
}

/// A summand as displayed.
fn read(part: &RepresentativeChain, summand: &Summand) -> Result<Expr, Refused> {
    let found = check::numbers(&part.unfolded.model, &[&summand.shown]);
    match found.into_iter().next() {
        Some(Some(term)) => Ok(term),
        _ => Err(Refused::Form(
            "clebsch cannot read a term of neighbours".to_owned(),
        )),
    }
}

/// The part of a term on the edge, and its part at a node.
pub(super) fn in_two(part: &RepresentativeChain, summand: &Summand) -> Result<[Expr; 2], Refused> {
    let (edge, nodal) = action::split(&part.d.letters.symbols, &read(part, summand)?);
    Ok([edge, nodal])
}

/// The two parts of a term, if the derivation combines terms with negative powers of the step size: the nodal part of
/// a difference over the step size then belongs to the edge, at the end where it is stated.
fn gathered(part: &RepresentativeChain, summand: &Summand) -> Result<[Expr; 2], Refused> {
    let s = &part.d.letters.symbols;
    let reduction = part.d.spec.reduction.as_ref();
    let nodal = reduction.map(|r| action::summands(s, &r.nodal));
    let gathers = nodal.is_some_and(|all| !all.iter().any(|t| is_singular(s, t)));
    if !gathers {
        return in_two(part, summand);
    }
    let (mut on_edge, mut at_node) = (Vec::new(), Vec::new());
    for term in action::summands(s, &read(part, summand)?) {
        let (edge, nodal) = action::split(s, &term);
        match !nodal.is_zero() && is_singular(s, &term) {
            true => on_edge.push(term),
            false => {
                on_edge.push(edge);
                at_node.push(nodal);
            }
        }
    }
    let sum = |terms: Vec<Expr>| expr::sum(terms, Shape::SCALAR);
    Ok([sum(on_edge), sum(at_node)])
}

/// A summand as displayed; it must belong to one node in time.
pub(super) fn elaborated(part: &RepresentativeChain, summand: &Summand) -> Result<Expr, Refused> {
    let [edge, nodal] = in_two(part, summand)?;
    match edge.is_zero() {
        true => Ok(nodal),
        false => Err(Refused::Form(
            "an end condition contains a kinetic term: write it at all sites, with a mass at each site"
                .to_owned(),
        )),
    }
}

/// Expresses advected quantities by the configurations that advect them.
pub(super) fn defined(part: &RepresentativeChain, term: &Expr) -> Result<Expr, Refused> {
    let d = &part.d;
    let s = &d.letters.symbols;
    let mut list: Vec<(Letter, Expr)> = Vec::new();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let here = Letter {
            symbol: a.quantity,
            shift: Shift::HERE,
        };
        if !expr::contains(term, here) {
            continue;
        }
        match t {
            AdvectionRule::Defined(e) => list.push((here, e.clone())),
            AdvectionRule::Carried { .. } | AdvectionRule::Advanced => {
                return Err(Refused::Form(format!(
                    "`{}` has a constraint but no definition, and a term with neighbours contains it",
                    s.get(a.quantity).name
                )));
            }
        }
    }
    Ok(expr::substitute(s, term, &list))
}

/// The derivative of a term at one node along every variation, as covectors, by configuration.
pub(super) fn forces(part: &RepresentativeChain, term: &Expr) -> Vec<Force> {
    let d = &part.d;
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let mut out = Vec::new();
    for (i, (c, v)) in d.spec.configurations.iter().zip(&d.variations).enumerate() {
        let xi = Letter {
            symbol: d.letters.variation[i],
            shift: Shift::HERE,
        };
        let (letter, change) = &v.element;
        let gradient = expr::gradient(s, term, *letter);
        if gradient.is_zero() {
            continue;
        }
        let paired = expr::sum([pairing(&d.letters, &gradient, change)], Shape::SCALAR);
        let covector = c.group.of_gradient(s, expr::gradient(s, &paired, xi));
        let value = shorter(&algebra, covector);
        if value.is_zero() {
            continue;
        }
        let Some(at) = part.sited(c.element) else {
            continue;
        };
        out.push(Force {
            on: at.of,
            site: at.site,
            value,
        });
    }
    out
}

/// Adds an empty entry for the forces of ends if no neighbour acts on a configuration, because forces of ends are
/// added to the forces of neighbours.
pub(super) fn collecting(
    lattice: &Lattice,
    pulls: &[NeighbourForce],
    ends: &[EndTerm],
) -> Vec<NeighbourForce> {
    let mut out: Vec<NeighbourForce> = Vec::new();
    for f in ends.iter().flat_map(|e| &e.forces) {
        let collected =
            |all: &[NeighbourForce]| all.iter().flat_map(|p| &p.forces).any(|x| x.on == f.on);
        if collected(pulls) || collected(&out) {
            continue;
        }
        let Some(q) = lattice.find(&f.on) else {
            continue;
        };
        let none = Force {
            on: f.on.clone(),
            site: 0,
            value: expr::zero(f.value.shape()),
        };
        out.push(NeighbourForce {
            label: q.label,
            from: 0,
            to: match q.sites {
                Sites::Nodes => 0,
                Sites::Segments | Sites::Members => -1,
            },
            width: 0,
            forces: vec![none],
            terms: expr::zero(Shape::SCALAR),
        });
    }
    out
}

/// The contributions of every end condition, each from a chain with this end.
pub(super) fn ends(
    model: &Model,
    lattice: &Lattice,
    open: &ChainConfig,
) -> Result<Vec<EndTerm>, Refused> {
    let mut out = Vec::new();
    for last in [false, true] {
        let alternatives = &lattice.ends[usize::from(last)];
        for (which, alternative) in alternatives.iter().enumerate() {
            if alternative.terms.is_empty() {
                continue;
            }
            let mut choice = open.clone();
            choice.ends[usize::from(last)] = which;
            let part = written(model, lattice, choice)?;
            out.extend(end(lattice, &part, last, which)?);
        }
    }
    Ok(out)
}

fn end(
    lattice: &Lattice,
    part: &RepresentativeChain,
    last: bool,
    which: usize,
) -> Result<Option<EndTerm>, Refused> {
    let s = &part.d.letters.symbols;
    let mut terms = Vec::new();
    let own = |t: &&Summand| t.end == Some((last, which));
    for summand in part.unfolded.summands.iter().filter(own) {
        terms.push(elaborated(part, summand)?);
    }
    let whole = defined(part, &expr::sum(terms, Shape::SCALAR))?;
    if whole.is_zero() {
        return Ok(None);
    }
    let from_end = |of: &str, site: usize| -> usize {
        let q = lattice.find(of.strip_prefix('Δ').unwrap_or(of));
        let count = q.map_or(0, |q| part.choice.sites_of(lattice, q));
        match last {
            false => site,
            true => count.saturating_sub(1).saturating_sub(site),
        }
    };
    let forces: Vec<Force> = forces(part, &whole)
        .into_iter()
        .map(|f| Force {
            site: from_end(&f.on, f.site),
            ..f
        })
        .collect();
    let mut letters: Vec<(Letter, String, Option<usize>)> = Vec::new();
    let all = expr::letters(&whole).into_iter();
    let of_forces = forces.iter().flat_map(|f| expr::letters(&f.value));
    for l in all.chain(of_forces) {
        if letters.iter().any(|(known, ..)| *known == l) || s.get(l.symbol).role == Role::Step {
            continue;
        }
        let name = &s.get(l.symbol).name;
        let of_end = part.unfolded.end_parameters.iter();
        if let Some((_, stated, _)) = of_end.clone().find(|(own, ..)| own == name) {
            letters.push((l, stated.clone(), None));
        } else if let Some(at) = part.sited(l.symbol) {
            let site = from_end(&at.of, at.site);
            letters.push((l, at.of, Some(site)));
        }
    }
    Ok(Some(EndTerm {
        last,
        which,
        forces,
        terms: whole,
        letters,
        symbols: s.clone(),
    }))
}
