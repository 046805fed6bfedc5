//! Constraints at the sites of a chain: their derivatives with respect to the unknowns, and the response of the
//! unknowns to an impulse, in a step and at a node. Takes the expanded chain and the models of its sites; gives the
//! data of a block-tridiagonal system for the multipliers of all sites.

use super::neighbour_force::{defined, forces};
use super::site::BASE;
use super::{Refused, RepresentativeChain, SiteModel, SiteSolve, SiteUnknown, velocity};
use crate::algebra::Algebra;
use crate::check::{self, spec::Hold};
use crate::derive::balance::{pairing, shorter};
use crate::derive::holds;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::groups::ElementStorage;
use crate::lattice::{Lattice, Sites, StatedHold, StatedTotal};
use crate::print::formula::Formula;
use crate::syntax::ast::{self as syntax, Expression};
use std::cmp::Ordering;

/// A constraint as stated: one at every index of a range, from the first site on, or one on the sum over them.
#[derive(Clone, Debug)]
pub struct ChainConstraint {
    /// The name of its multiplier.
    pub name: String,
    /// The label.
    pub label: usize,
    /// The last index of an open chain, minus the number of segments.
    pub to: isize,
    /// The distance between its letters, in sites: neighbours at most.
    pub width: usize,
    /// Its multiplier, at the base of the representative.
    pub multiplier: Letter,
    /// Its number of components.
    pub components: usize,
    /// The expression that vanishes.
    pub value: Expr,
    /// The size of its terms.
    pub scale: Expr,
    /// The equation, seen from the site `i`.
    pub sides: [Formula; 2],
    /// The letters of the equation.
    pub symbols: Symbols,
    /// For a constraint on a sum over sites, whose summand is `value`: the terms outside the sum.
    pub beside: Option<Expr>,
    /// Its derivatives.
    pub reaches: Vec<Reach>,
}

/// The action of a constraint on one configuration.
#[derive(Clone, Debug)]
pub struct Reach {
    /// The configuration as stated.
    pub on: String,
    /// Its site, from the index of the constraint.
    pub site: usize,
    /// The constraint force as a covector, for the multiplier.
    pub reaction: Expr,
    /// The constraint force for each component of the multiplier.
    pub columns: Matrix,
    /// Whether it occurs in a sum over sites.
    pub in_sum: bool,
}

/// A matrix by its columns.
#[derive(Clone, Debug)]
pub enum Matrix {
    /// A multiple of the identity.
    Multiple(Expr),
    /// Any other.
    Columns(Vec<Expr>),
}

/// Configurations of a site whose velocities are found together, and their response to an impulse.
#[derive(Clone, Debug)]
pub struct ConstraintResponse {
    /// Their indices in the model of the site.
    pub members: Vec<usize>,
    /// The derivative of the edge momenta with respect to the velocities, member by member; none for a rotation.
    pub of_edge: Option<Vec<Matrix>>,
    /// The same derivative in the limit of small steps.
    pub of_node: Vec<Matrix>,
    /// The momenta of that limit at zero velocity.
    pub at_rest: Vec<Expr>,
}

impl Matrix {
    /// The matrix of these columns; recognises a multiple of the identity.
    fn of(algebra: &Algebra, columns: Vec<Expr>) -> Matrix {
        let columns: Vec<Expr> = columns
            .into_iter()
            .map(|c| match c.is_zero() {
                true => c,
                false => shorter(algebra, c),
            })
            .collect();
        let Some(first) = columns.first() else {
            return Matrix::Columns(columns);
        };
        let axes = match expr::axes(first.shape()) {
            Some(axes) if axes.len() == columns.len() => axes,
            _ => return Matrix::Columns(columns),
        };
        let factor = match first.shape().is_scalar() {
            true => first.clone(),
            false => expr::dot(axes[0].clone(), first.clone()),
        };
        let factor = algebra.shortest(&factor);
        let equal = axes.iter().zip(&columns).all(|(axis, column)| {
            let own = expr::mul(factor.clone(), axis.clone());
            algebra.is_zero(&expr::sub(column.clone(), own))
        });
        match equal {
            true => Matrix::Multiple(factor),
            false => Matrix::Columns(columns),
        }
    }

    /// Its expressions.
    pub fn expressions(&self) -> &[Expr] {
        match self {
            Matrix::Multiple(e) => std::slice::from_ref(e),
            Matrix::Columns(list) => list,
        }
    }
}

fn refused<T>(words: String) -> Result<T, Refused> {
    Err(Refused::Form(words))
}

/// The constraints of a chain.
pub(super) fn held(
    lattice: &Lattice,
    part: &RepresentativeChain,
    lone: &[SiteModel],
) -> Result<Vec<ChainConstraint>, Refused> {
    let mut out: Vec<ChainConstraint> = Vec::new();
    let movers = lone.iter().flat_map(|l| l.movers.iter());
    let mut turning = movers.filter(|m| {
        matches!(
            m.how,
            SiteSolve::Newton {
                arriving: Some(_),
                ..
            }
        )
    });
    if let (Some(m), false) = (turning.next(), part.unfolded.holds.is_empty()) {
        return refused(format!(
            "the model has a `hold` constraint, and the velocity of `{}` is found by Newton's method: in constrained chains, \
             loops over sites support rotations with the kinetic energy `-tr(J*Ω)`, `J` a function of parameters",
            m.name
        ));
    }
    for stated in &part.unfolded.holds {
        let found = one(lattice, part, stated)?;
        if let Some(first) = out.first()
            && first.label != found.label
        {
            return refused(format!(
                "`{}` and `{}` constrain sites of two labels",
                first.name, found.name
            ));
        }
        for reach in &found.reaches {
            admitted(lattice, lone, &found, reach)?;
        }
        out.push(found);
    }
    if let (Some(sum), Some(site)) = (part.unfolded.totals.first(), out.first()) {
        return refused(format!(
            "`{}` constrains a sum over sites and `{}` constrains each site, so their multipliers must be solved together",
            sum.name, site.name
        ));
    }
    for stated in &part.unfolded.totals {
        let found = total(lattice, part, stated)?;
        for reach in &found.reaches {
            admitted(lattice, lone, &found, reach)?;
        }
        out.push(found);
    }
    match out.is_empty() && !part.d.spec.holds.is_empty() {
        true => refused("a `hold` constraint belongs to no site".to_owned()),
        false => Ok(out),
    }
}

/// Checks that a constrained quantity belongs to the chain, and that impulses can act on it.
fn admitted(
    lattice: &Lattice,
    lone: &[SiteModel],
    held: &ChainConstraint,
    reach: &Reach,
) -> Result<(), Refused> {
    let name = &held.name;
    if lattice.find(&reach.on).map(|q| q.label) != Some(held.label) {
        return refused(format!(
            "`{name}` constrains a quantity that is not at the sites of its label"
        ));
    }
    let mut movers = lone
        .iter()
        .flat_map(|l| l.movers.iter().map(move |m| (l, m)));
    let Some((own, mover)) = movers.find(|(_, m)| m.name == reach.on) else {
        return refused(format!(
            "`{name}` constrains `{}`, which does not move",
            reach.on
        ));
    };
    let c = &own.d.spec.configurations[mover.index];
    match c.group.kept() {
        ElementStorage::Rotation => Ok(()),
        ElementStorage::Field(shape) if shape.is_scalar() || shape.is_vector() => Ok(()),
        _ => refused(format!(
            "`{name}` constrains `{}`: chains support constraints on numbers, vectors and rotations",
            reach.on
        )),
    }
}

/// Checks that the letters of a constraint begin at its index and reach at most the next site. Returns the distance
/// between them.
fn width(name: &str, from: isize, letters: &[(Sites, isize)]) -> Result<usize, Refused> {
    let first = letters.iter().map(|(_, o)| *o).min().unwrap_or(0);
    let last = letters.iter().map(|(_, o)| *o).max().unwrap_or(0);
    if first != 0 || from != 0 {
        return refused(format!(
            "`{name}` does not constrain its first site: shift its index, so that it contains `x` and `next(x, i)`"
        ));
    }
    match usize::try_from(last).unwrap_or(0) {
        width @ 0..=1 => Ok(width),
        _ => refused(format!("`{name}` constrains sites that are not neighbours")),
    }
}

fn one(
    lattice: &Lattice,
    part: &RepresentativeChain,
    stated: &StatedHold,
) -> Result<ChainConstraint, Refused> {
    let (d, name) = (&part.d, &stated.name);
    let width = width(name, stated.range.from, &stated.letters)?;
    let multiplier = part.copy(name, BASE);
    let mut holds = d.spec.holds.iter();
    let Some(hold) = holds.find(|h| Some(h.multiplier) == multiplier) else {
        return refused(format!(
            "`{name}` applies to no site with all its neighbours"
        ));
    };
    let mut symbols = d.letters.symbols.clone();
    let label = lattice.labels.get(stated.range.label);
    let index = label.map_or("", |l| l.index.text.as_str());
    let sides = [&hold.left, &hold.right];
    let sides = sides.map(|e| Formula::Expr(seen_from(part, e, index, &mut symbols)));
    let held = ChainConstraint {
        name: name.clone(),
        label: stated.range.label,
        to: stated.range.to,
        width,
        multiplier: Letter {
            symbol: hold.multiplier,
            shift: Shift::HERE,
        },
        components: 0,
        value: hold.value.clone(),
        scale: expr::integer(0),
        sides,
        symbols,
        beside: None,
        reaches: Vec::new(),
    };
    with_derivatives(part, hold, held)
}

/// A constraint on a sum over sites.
fn total(
    lattice: &Lattice,
    part: &RepresentativeChain,
    stated: &StatedTotal,
) -> Result<ChainConstraint, Refused> {
    let (d, name) = (&part.d, &stated.name);
    let Some(summed) = &stated.summed else {
        return refused(format!(
            "`{name}` is not linear in the sums that it contains"
        ));
    };
    let Some(first) = summed.first() else {
        return refused(format!("`{name}` contains no sum"));
    };
    let mut largest = 0;
    for term in summed {
        if term.range != first.range || term.site != first.site {
            return refused(format!(
                "`{name}` contains sums over different ranges of sites"
            ));
        }
        largest = largest.max(width(name, term.range.from, &term.letters)?);
    }
    let mut holds = d.spec.holds.iter();
    let own = |h: &&Hold| d.letters.symbols.get(h.multiplier).name == *name;
    let Some(hold) = holds.find(own) else {
        return refused(format!("`{name}` is not a `hold` constraint"));
    };
    let place = stated.rest.place;
    let terms = summed.iter().map(|t| (false, t.shown.clone()));
    let kind = syntax::Kind::Sum(terms.collect());
    let terms = Expression { kind, place };
    let found = check::sides(&part.unfolded.model, &terms, &stated.rest);
    let Some((summand, beside)) = found.filter(|(a, _)| a.shape() == hold.value.shape()) else {
        return refused(format!("clebsch cannot read the summand of `{name}`"));
    };
    let by = isize::try_from(BASE).unwrap_or(0) - isize::try_from(first.site).unwrap_or(0);
    let Some(value) = part.moved(&summand, by) else {
        return refused(format!("`{name}` reaches too far along the chain"));
    };
    let is_constant = |l: &Letter| d.letters.symbols.get(l.symbol).role == Role::Parameter;
    if !expr::letters(&beside).iter().all(is_constant) {
        return refused(format!(
            "`{name}` contains a sum and a quantity that is not at sites"
        ));
    }
    let mut symbols = d.letters.symbols.clone();
    let (index, count) = match lattice.labels.get(first.range.label) {
        Some(l) => (l.index.text.as_str(), l.count.text.as_str()),
        None => ("", ""),
    };
    let seen = seen_from(part, &value, index, &mut symbols);
    let left = Formula::SumOver {
        index: index.to_owned(),
        from: Some("0".to_owned()),
        to: Some(match first.range.to {
            0 => count.to_owned(),
            by => format!("{count}{by}"),
        }),
        of: Box::new(Formula::Expr(seen)),
    };
    let right = Formula::Expr(expr::neg(beside.clone()));
    let held = ChainConstraint {
        name: name.clone(),
        label: first.range.label,
        to: first.range.to,
        width: largest,
        multiplier: Letter {
            symbol: hold.multiplier,
            shift: Shift::HERE,
        },
        components: 0,
        value,
        scale: expr::integer(0),
        sides: [left, right],
        symbols,
        beside: Some(beside),
        reaches: Vec::new(),
    };
    with_derivatives(part, hold, held)
}

/// An expression at the base, with its letters named as letters of the site `i`, for display.
fn seen_from(part: &RepresentativeChain, e: &Expr, index: &str, symbols: &mut Symbols) -> Expr {
    let mut list = Vec::new();
    for l in expr::letters(e) {
        let Some(at) = part.sited(l.symbol) else {
            continue;
        };
        let own = symbols.get(l.symbol).clone();
        let site = match at.site.cmp(&BASE) {
            Ordering::Equal => index.to_owned(),
            Ordering::Greater => format!("{index}+{}", at.site - BASE),
            Ordering::Less => format!("{index}-{}", BASE - at.site),
        };
        let name = format!("{}_{{{site}}}", at.of);
        let id = symbols.add(&name, own.shape, own.structure, own.role);
        list.push((l, expr::letter(symbols, id, l.shift)));
    }
    expr::substitute(symbols, e, &list)
}

/// A constraint with its derivatives and the size of its terms.
fn with_derivatives(
    part: &RepresentativeChain,
    hold: &Hold,
    held: ChainConstraint,
) -> Result<ChainConstraint, Refused> {
    let d = &part.d;
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let (name, letter) = (&held.name, held.multiplier);
    let shape = s.get(letter.symbol).shape;
    let own = expr::here(s, letter.symbol);
    let value = defined(part, &held.value)?;
    let step = Letter {
        symbol: d.spec.step,
        shift: Shift::HERE,
    };
    if expr::contains(&value, step) {
        return refused(format!("`{name}` depends on the step"));
    }
    let axes = expr::axes(shape).unwrap_or_default();
    let in_sum = held.beside.is_some();
    let reaches = forces(part, &pairing(&d.letters, &own, &value));
    let reaches = reaches.into_iter().map(|f| {
        let along = |axis: &Expr| expr::substitute(s, &f.value, &[(letter, axis.clone())]);
        Reach {
            columns: Matrix::of(&algebra, axes.iter().map(along).collect()),
            on: f.on,
            site: f.site - BASE,
            reaction: f.value,
            in_sum,
        }
    });
    let reaches: Vec<Reach> = reaches.collect();
    if reaches.iter().any(|r| r.site > 1) {
        return refused(format!("`{name}` constrains sites that are not neighbours"));
    }
    let by_definition = Hold {
        value: value.clone(),
        ..hold.clone()
    };
    Ok(ChainConstraint {
        components: axes.len(),
        scale: holds::scale(s, &by_definition),
        value,
        reaches,
        ..held
    })
}

/// The response of constrained configurations to impulses, in the models of their sites.
pub(super) fn units(
    lone: &SiteModel,
    held: &[ChainConstraint],
) -> Result<Vec<ConstraintResponse>, Refused> {
    let reached = |m: &SiteUnknown| held.iter().flat_map(|h| &h.reaches).any(|r| r.on == m.name);
    let mut out = Vec::new();
    for members in &lone.blocks {
        let own = |i: &usize| lone.movers.iter().find(|m| m.index == *i);
        let movers: Vec<&SiteUnknown> = members.iter().filter_map(own).collect();
        // If a constraint acts on part of a block, it changes the velocities of the whole block.
        if movers.iter().any(|m| reached(m)) {
            out.push(unit(lone, members, &movers)?);
        }
    }
    Ok(out)
}

fn unit(
    lone: &SiteModel,
    members: &[usize],
    movers: &[&SiteUnknown],
) -> Result<ConstraintResponse, Refused> {
    let d = &lone.d;
    let s = &d.letters.symbols;
    let algebra = Algebra::new(s);
    let name = movers.first().map_or("", |m| m.name.as_str());
    let Ok(limit) = &d.limit else {
        return refused(format!(
            "`{name}` is constrained, but its momentum has no limit of small steps"
        ));
    };
    let variation = |i: usize| Letter {
        symbol: d.letters.variation[i],
        shift: Shift::HERE,
    };
    let gradient = |of: &Expr, i: usize| {
        let y = expr::gradient(s, of, variation(i));
        d.spec.configurations[i].group.of_gradient(s, y)
    };
    let mut of_node = Vec::new();
    for i in members {
        let momentum = gradient(&limit.kinetic, *i);
        let others = (0..d.spec.configurations.len()).filter(|j| !members.contains(j));
        if others
            .into_iter()
            .any(|j| expr::contains(&momentum, variation(j)))
        {
            return refused(format!(
                "`{name}` is constrained, but shares its kinetic energy with a velocity that is solved separately"
            ));
        }
        let columns = members.iter().flat_map(|j| {
            let c = &d.spec.configurations[*j];
            velocity::columns_of_limit(s, &momentum, c, variation(*j).symbol)
        });
        of_node.push(Matrix::of(&algebra, columns.collect()));
    }
    let mut of_edge = None;
    if !movers
        .iter()
        .any(|m| matches!(m.how, SiteSolve::Rotation { .. }))
    {
        let mut all = Vec::new();
        for i in members {
            let (_, columns) = super::site_model::momentum(d, *i, members)?;
            all.push(Matrix::of(&algebra, columns));
        }
        of_edge = Some(all);
    }
    Ok(ConstraintResponse {
        members: members.to_vec(),
        of_edge,
        of_node,
        at_rest: members
            .iter()
            .map(|i| gradient(&limit.linear, *i))
            .collect(),
    })
}

/// The constraint forces of all copies of all constraints on a configuration of the expanded chain, per unit time:
/// the program for every number of sites must give the same forces.
pub(super) fn written_out(part: &RepresentativeChain, i: usize) -> Vec<Expr> {
    let d = &part.d;
    let each = d.spec.holds.iter();
    let each = each.map(|h| holds::reaction(&d.spec, &d.letters, &d.variations, i, h));
    each.map(|e| d.defined(&e)).collect()
}
