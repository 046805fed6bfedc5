//! The unknowns of a single site: its model without neighbours, derived like any other model, and how its
//! velocities are found if neighbours add to its momentum.

use super::neighbour_force::lone_at;
use super::velocity_coupling::VelocityCoupling;
use super::{Refused, RepresentativeChain, velocity};
use crate::algebra::{Algebra, Rational};
use crate::check::{self, spec::Side};
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::momentum_update::MomentumUpdate;
use crate::derive::select_solver::{MoserVeselov, StepEquation};
use crate::derive::two_sided_linear::TwoSidedLinear;
use crate::derive::{self, Derivation, Outline};
use crate::diagnostic::Errors;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter};
use crate::groups::{self, ElementStorage};
use crate::lattice::{Kind as QuantityKind, Lattice, Sites, definitions, inlined};
use crate::syntax::ast::{Expression, Kind, Model, Name, SizedName, Statement};

/// The model of one site.
pub struct SiteModel {
    /// Its label.
    pub label: usize,
    /// The kind of its sites.
    pub sites: Sites,
    /// Its derivation, in the names of the model as stated.
    pub d: Derivation,
    /// The first results of this derivation.
    pub outline: Outline,
    /// Its configurations.
    pub movers: Vec<SiteUnknown>,
    /// Configurations whose velocities are found together, by their indices.
    pub blocks: Vec<Vec<usize>>,
}

/// A configuration of a site.
pub struct SiteUnknown {
    /// Its name.
    pub name: String,
    /// Its index in the derivation.
    pub index: usize,
    /// How its velocity is found.
    pub how: SiteSolve,
}

/// How a velocity is found from the momentum of the edge that leaves the node.
pub enum SiteSolve {
    /// A rotation by the Moser-Veselov equation with a factor that depends on parameters, or a unit quaternion by the
    /// analogous equation on SU(2).
    Rotation {
        /// The factor.
        factor: Expr,
        /// For a unit quaternion, its real coefficient, which also contains parameters only.
        real: Option<Expr>,
        /// The impulse at the start of the edge, in the body frame there.
        leave: Expr,
        /// The impulse at the end of the edge, in the body frame there.
        arrive: Expr,
    },
    /// A field with potential forces only: `p = L ΔX R + rest`.
    Field {
        /// The factors.
        form: TwoSidedLinear,
        /// The impulse at the end of the edge.
        arrive: Expr,
    },
    /// Fields whose momenta are linear in all velocities of their block.
    System {
        /// The momentum at zero velocity.
        rest: Expr,
        /// The columns of the momentum's derivative, one per component of each velocity of the block.
        columns: Vec<Expr>,
        /// The increment of the momentum over the edge, in velocities and both ends.
        added: Expr,
    },
    /// Fields whose momenta are nonlinear functions of the velocities of their block, solved by Newton's method.
    Newton {
        /// The momentum, in the velocities of the block.
        momentum: Expr,
        /// Its derivative with respect to each component of each velocity of the block.
        columns: Vec<Expr>,
        /// The increment of the momentum over the edge, in velocities and both ends. For a rotation, the increment at
        /// its start, in the body frame there.
        added: Expr,
        /// For a rotation, the increment at its end, in the body frame there.
        arriving: Option<Expr>,
    },
}

impl SiteSolve {
    /// The increment of the momentum over the edge, if velocities are found together.
    pub fn added(&self) -> Option<&Expr> {
        match self {
            SiteSolve::System { added, .. } | SiteSolve::Newton { added, .. } => Some(added),
            SiteSolve::Rotation { .. } | SiteSolve::Field { .. } => None,
        }
    }
}

/// The models of all sites with configurations.
pub(super) fn lone(
    model: &Model,
    lattice: &Lattice,
    part: &RepresentativeChain,
    ties: &[VelocityCoupling],
) -> Result<Vec<SiteModel>, Refused> {
    let mut kinds: Vec<(usize, Sites)> = Vec::new();
    for q in &lattice.quantities {
        let at = (q.label, q.sites);
        if q.kind == QuantityKind::Configuration && !kinds.contains(&at) {
            kinds.push(at);
        }
    }
    kinds
        .into_iter()
        .map(|(label, sites)| one(model, lattice, (part, ties), (label, sites)))
        .collect()
}

fn one(
    model: &Model,
    lattice: &Lattice,
    (part, ties): (&RepresentativeChain, &[VelocityCoupling]),
    (label, sites): (usize, Sites),
) -> Result<SiteModel, Refused> {
    let terms = part.unfolded.summands.iter().filter(|t| {
        let range = t.range.map(|r| r.label);
        lone_at(t) == Some(sites) && range == Some(label) && !t.of_functionals
    });
    let terms: Vec<Expression> = terms.map(|t| t.stated.clone()).collect();
    let spec = check::check_site(&alone(model, lattice, (label, sites), terms)?)?;
    let d = derive::derive(spec).map_err(Errors::first_at_each_place)?;
    without_carried(&d)?;
    let blocks: Vec<Vec<usize>> = match d.solve.blocks.as_slice() {
        [] => vec![(0..d.spec.configurations.len()).collect()],
        blocks => blocks.iter().map(|b| b.members.clone()).collect(),
    };
    let algebra = Algebra::new(&d.letters.symbols);
    let mut movers = Vec::new();
    let name = |i: usize| {
        let element = d.spec.configurations[i].element;
        d.letters.symbols.get(element).name.as_str()
    };
    // If terms contain velocities of neighbours, these velocities are found together, for all sites.
    let is_tied = |i: &usize| {
        let mut parts = ties.iter().flat_map(|t| &t.parts);
        parts.any(|p| p.on == name(*i))
    };
    let (tied, mut blocks): (Vec<Vec<usize>>, Vec<Vec<usize>>) =
        blocks.into_iter().partition(|b| b.iter().any(is_tied));
    let mut together: Vec<usize> = tied.into_iter().flatten().collect();
    together.sort_unstable();
    if !together.is_empty() {
        for i in &together {
            movers.push(SiteUnknown {
                how: by_newton(&d, *i, &together)?,
                name: name(*i).to_owned(),
                index: *i,
            });
        }
    }
    for block in &blocks {
        for i in block {
            let name = d
                .letters
                .symbols
                .get(d.spec.configurations[*i].element)
                .name
                .clone();
            movers.push(SiteUnknown {
                how: how(&d, *i, block, &name, &algebra)?,
                name,
                index: *i,
            });
        }
    }
    movers.sort_by_key(|m| m.index);
    if !together.is_empty() {
        blocks.push(together);
    }
    Ok(SiteModel {
        label,
        sites,
        outline: d.outline(),
        d,
        movers,
        blocks,
    })
}

/// Rejects terms with advected quantities that have a constraint but no definition: a chain does not store their
/// values from step to step.
fn without_carried(d: &Derivation) -> Result<(), Refused> {
    let s = &d.letters.symbols;
    let stated = expr::letters(&d.spec.lagrangian);
    for (a, transport) in d.spec.advected.iter().zip(&d.transports) {
        let is_used = stated.iter().any(|l| l.symbol == a.quantity);
        if is_used && !matches!(transport, AdvectionRule::Defined(_)) {
            return Err(Refused::Form(format!(
                "`{}` has a constraint but no definition: loops over sites need a definition",
                s.get(a.quantity).name
            )));
        }
    }
    Ok(())
}

/// The model of one site: its declarations, and the terms without neighbours.
fn alone(
    model: &Model,
    lattice: &Lattice,
    at: (usize, Sites),
    terms: Vec<Expression>,
) -> Result<Model, Refused> {
    let here = |name: &str| match lattice.find(name) {
        None => true,
        Some(q) => (q.label, q.sites) == at,
    };
    let lets = definitions(model)?;
    let those =
        |names: &[Name]| -> Vec<Name> { names.iter().filter(|n| here(&n.text)).cloned().collect() };
    let mut out = Model {
        statements: Vec::new(),
        remarks: Vec::new(),
        ..model.clone()
    };
    let mut place = model.name.place;
    for (statement, docs) in model.statements.iter().zip(&model.remarks) {
        let kept: Vec<Statement> = match statement {
            Statement::Label { step: Some(s), .. } => vec![number(s)],
            Statement::Label { step: None, .. }
            | Statement::Periodic(_)
            | Statement::End { .. }
            | Statement::Let { .. } => Vec::new(),
            Statement::Param { names, shape, .. } => vec![Statement::Param {
                names: those(names),
                shape: shape.clone(),
                at: None,
            }],
            Statement::Field { names, shape, .. } => vec![Statement::Field {
                names: those(names),
                shape: shape.clone(),
                at: None,
                offset: None,
                domain: None,
            }],
            Statement::Group {
                name,
                group,
                velocity,
                ..
            } if here(&name.text) => vec![Statement::Group {
                name: name.clone(),
                group: group.clone(),
                at: None,
                velocity: velocity.clone(),
            }],
            Statement::Advected {
                names,
                shape,
                definition,
                ..
            } => vec![Statement::Advected {
                names: those(names),
                shape: shape.clone(),
                at: None,
                definition: definition.as_ref().map(|e| inlined(e, &lets)),
            }],
            Statement::Constraint { name, value, place } if here(&name.text) => {
                vec![Statement::Constraint {
                    name: name.clone(),
                    value: inlined(value, &lets),
                    place: *place,
                }]
            }
            Statement::Lagrangian(e) => {
                place = e.place;
                Vec::new()
            }
            Statement::Time { .. } | Statement::Node(..) | Statement::Given { .. } => {
                vec![statement.clone()]
            }
            Statement::Group { .. }
            | Statement::Constraint { .. }
            | Statement::Hold { .. }
            | Statement::Mesh { .. }
            | Statement::Grid(_)
            | Statement::Assume { .. }
            | Statement::Scale(_)
            | Statement::Dim { .. } => Vec::new(),
        };
        for statement in kept.into_iter().filter(|s| !is_empty(s)) {
            out.statements.push(statement);
            out.remarks.push(docs.clone());
        }
    }
    let lagrangian = match terms.len() {
        // Its velocities occur in neighbour terms only.
        0 => Some(Expression {
            kind: Kind::Number(Rational::integer(0)),
            place,
        }),
        1 => terms.into_iter().next(),
        _ => Some(Expression {
            kind: Kind::Sum(terms.into_iter().map(|t| (false, t)).collect()),
            place,
        }),
    };
    out.statements.extend(lagrangian.map(Statement::Lagrangian));
    out.remarks.push(Vec::new());
    Ok(out)
}

/// Whether the statement declares nothing.
fn is_empty(statement: &Statement) -> bool {
    match statement {
        Statement::Param { names, .. }
        | Statement::Field { names, .. }
        | Statement::Advected { names, .. } => names.is_empty(),
        _ => false,
    }
}

fn number(name: &Name) -> Statement {
    Statement::Param {
        names: vec![name.clone()],
        shape: SizedName::number(name.place),
        at: None,
    }
}

/// How the velocity of a configuration is found.
fn how(
    d: &Derivation,
    i: usize,
    block: &[usize],
    name: &str,
    algebra: &Algebra,
) -> Result<SiteSolve, Refused> {
    let s = &d.letters.symbols;
    let c = &d.spec.configurations[i];
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    let together = || {
        if velocity::turns(c) {
            return by_newton(d, i, block);
        }
        let group = c.group.name(&|n| s.dim_text(n));
        Err(Refused::Form(match (c.group.kept(), c.side) {
            (ElementStorage::Rotation | ElementStorage::Quaternion, Side::Spatial) => format!(
                "`{name}` is spatial, `next({name}) = ω*{name}`: loops over sites support rotations on the body side"
            ),
            (ElementStorage::Quaternion, Side::Body) => format!(
                "the velocity of `{name}` is found by Newton's method: loops over sites support unit quaternions whose kinetic \
                 energy is a quadratic form of im and a multiple of re, with parameters as coefficients"
            ),
            _ => format!(
                "`{name}` is in {group}: loops over sites support fields, rotations of SO<3> and unit quaternions of SU<2> on \
                 the body side, and SO<2>, {} in coordinates of these",
                groups::listed("and", |_, g| g.chart().is_some())
            ),
        }))
    };
    let turning = |mv: &MoserVeselov, real: Option<&Expr>| {
        let MomentumUpdate::Through { leave, arrive, .. } = &d.carries[i] else {
            return together();
        };
        let constant = |l: &Letter| s.get(l.symbol).role == Role::Parameter;
        let free = !moving(leave) && !moving(arrive);
        let known = mv.symmetric && expr::letters(&mv.factor).iter().all(constant);
        match free && known {
            true => Ok(SiteSolve::Rotation {
                factor: mv.factor.clone(),
                real: real.cloned(),
                leave: leave.clone(),
                arrive: arrive.clone(),
            }),
            false => together(),
        }
    };
    let alone = c.side.is_body() && block.len() == 1;
    match (c.group.kept(), &d.solve.riccati[i]) {
        (ElementStorage::Rotation, StepEquation::Exact(mv)) if alone => turning(mv, None),
        (ElementStorage::Quaternion, StepEquation::Quaternionic(q)) if alone => {
            turning(&q.edge, Some(&q.real))
        }
        (ElementStorage::Field(_), StepEquation::Linear(form)) if block.len() == 1 => {
            let b = &d.balances[i];
            let straight = expr::sub(b.edge_in.clone(), b.edge_out.clone());
            let free = !moving(&b.node_in) && !moving(&b.node_out);
            match free && algebra.is_zero(&straight) {
                true => Ok(SiteSolve::Field {
                    form: form.clone(),
                    arrive: b.node_in.clone(),
                }),
                false => system(d, i, block),
            }
        }
        (ElementStorage::Field(_), _) => system(d, i, block),
        _ => together(),
    }
}

/// The momentum of a field as a function of the velocities of its block, linear or not.
fn system(d: &Derivation, i: usize, block: &[usize]) -> Result<SiteSolve, Refused> {
    let s = &d.letters.symbols;
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    // All configurations of a block are solved in the same way.
    for j in block {
        let (_, columns) = momentum(d, *j, block)?;
        if columns.iter().any(moving) {
            return by_newton(d, i, block);
        }
    }
    let (momentum, columns) = momentum(d, i, block)?;
    let still: Vec<(Letter, Expr)> = block
        .iter()
        .map(|j| {
            let c = &d.spec.configurations[*j];
            (velocity::letter(c), expr::zero(c.group.shape()))
        })
        .collect();
    Ok(SiteSolve::System {
        rest: expr::substitute(s, &momentum, &still),
        columns,
        added: added(d, i),
    })
}

/// The momentum of a field as a function whose derivative may depend on the velocities.
fn by_newton(d: &Derivation, i: usize, block: &[usize]) -> Result<SiteSolve, Refused> {
    let (momentum, columns) = momentum(d, i, block)?;
    let c = &d.spec.configurations[i];
    let (added, arriving) = match (velocity::turns(c), &d.carries[i]) {
        (false, _) => (added(d, i), None),
        (true, MomentumUpdate::Through { leave, arrive, .. }) => {
            (leave.clone(), Some(arrive.clone()))
        }
        (true, MomentumUpdate::Kept(_)) => {
            let b = &d.balances[i];
            (expr::neg(b.node_out.clone()), Some(b.node_in.clone()))
        }
    };
    Ok(SiteSolve::Newton {
        momentum,
        columns,
        added,
        arriving,
    })
}

/// The increment of a momentum over the edge.
fn added(d: &Derivation, i: usize) -> Expr {
    match &d.carries[i] {
        MomentumUpdate::Kept(added) => added.clone(),
        MomentumUpdate::Through { leave, arrive, .. } => expr::add(leave.clone(), arrive.clone()),
    }
}

/// The momentum of the outgoing edge, in the position at the node and the velocities. Also its derivative with
/// respect to each component of each velocity of a block, one column per component.
pub(super) fn momentum(
    d: &Derivation,
    i: usize,
    block: &[usize],
) -> Result<(Expr, Vec<Expr>), Refused> {
    let s = &d.letters.symbols;
    let momentum = expr::substitute(s, &d.balances[i].outgoing, &d.spec.end_of_edge());
    let mut columns = Vec::new();
    for j in block {
        let c = &d.spec.configurations[*j];
        let Some(own) = velocity::columns(s, &momentum, c) else {
            if c.group.is_additive() {
                return Err(Refused::Form(format!(
                    "the momentum of the matrix `{}` is not a product `L*(next(X) - X)*R` with known factors: loops over sites \
                     support matrices with the kinetic energy `tr(A*(next(X) - X)*B*(next(X) - X)^T)/(2*h)`",
                    s.get(c.element).name
                )));
            }
            return Err(Refused::Form(format!(
                "the velocities of `{}` and `{}` are solved together: loops over sites support this for fields and rotations \
                 of SO<3> on the body side",
                s.get(d.spec.configurations[i].element).name,
                s.get(c.element).name
            )));
        };
        columns.extend(own);
    }
    Ok((momentum, columns))
}
