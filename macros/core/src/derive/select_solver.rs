//! Selects how each step solves for the velocities. If the balance is linear in the velocity and `C` is free of
//! velocities, this is the Moser-Veselov equation `Ω C^T - C Ω^T = h N`, an exact matrix Riccati equation.
//! Otherwise Newton's method solves the derived residual with its tangent.

use super::Letters;
use super::advection_rule::AdvectionRule;
use super::balance::{Balance, shorter};
use super::blocks::{self, Block};
use super::left_factor::split;
use super::quaternionic::{self, Quaternionic};
use super::seen_from_body::seen_from_body;
use super::two_sided_linear::{self, TwoSidedLinear};
use super::variation::at;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::{Configuration, Spec};
use crate::expr::shape::Dim;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// The Riccati form of one balance.
#[derive(Clone, Debug)]
pub enum StepEquation {
    /// `Ω C^T - C Ω^T = h N`, where `C` depends on parameters and node quantities.
    Exact(MoserVeselov),
    /// The same equation, where `C` contains other velocities.
    Coupled(MoserVeselov),
    /// No such form, but the equation of SU(2) applies.
    Quaternionic(Quaternionic),
    /// No such form, but a balance that is linear in the velocity; on GL(n) and for fields.
    Linear(TwoSidedLinear),
    /// No such form, with the reason.
    None(String),
}

/// The parts of a Moser-Veselov equation.
#[derive(Clone, Debug)]
pub struct MoserVeselov {
    /// The left factor `C`, an n x n matrix. For the free body, it is the Poinsot matrix.
    pub factor: Expr,
    /// Whether `C` equals its transpose.
    pub symmetric: bool,
    /// The part of the node momentum that does not depend on the velocity, as a covector. The edge momentum is
    /// `N = μ - rest`.
    pub rest: Expr,
    /// `C` in the body frame, if it is constant there: it contains parameters, and advected quantities whose letters
    /// denote their constant values at the identity.
    pub in_body: Option<Expr>,
    /// The momentum received at the end of the edge, evaluated at the node there, on the side of the configuration.
    /// Present only if the node does nothing else: the next edge can then be computed there.
    pub arrive: Option<Expr>,
    /// For a configuration in space: the impulse at a node on both sides of it, in the body frame. It is expressed by
    /// the element and by advected quantities with their constant values at the identity. `None` if it is not simpler
    /// in the body frame.
    pub torque: Option<Expr>,
}

/// How the step is solved.
#[derive(Clone, Debug)]
pub enum Method {
    /// Explicitly, with constants of the trajectory that are computed once: `C` is constant and the edge momentum is
    /// the node momentum, so that `κ` is conserved.
    FreeMoserVeselov,
    /// Explicitly, with one quartic per step; the momentum of the next edge is computed at its first node.
    ForcedMoserVeselov,
    /// Explicitly, with one scalar equation per step, in the same way: SU(2).
    UnitQuaternions,
    /// By a solver for left factors: `C` is constant, in the frame of the velocity or, if [`Solve::turned`] is
    /// present, in the other one.
    LeftFactor,
    /// By Davenport's eigenvalue problem, for any `C` known at the node; SO(3).
    Davenport,
    /// Explicitly, by small linear systems: the balance is linear in the velocity; on GL(n) and for fields.
    Linear,
    /// By Newton's method on the group, with derived residual and tangent.
    Newton,
    /// Several blocks, each with a method of its own; see [`Solve::blocks`].
    Blocks,
}

/// Joins a method and its reason.
pub(crate) const BECAUSE: &str = ", because ";

/// Newton's method for one equation.
const NEWTON: &str = "Newton's method on the derived residual";

/// The equations to solve, and how they are solved.
#[derive(Clone, Debug)]
pub struct Solve {
    /// The Riccati form of each balance.
    pub riccati: Vec<StepEquation>,
    /// The method of the emitted stepper.
    pub method: Method,
    /// The method and, after `BECAUSE`, the reason for it.
    pub reason: String,
    /// `C` in the other frame, if it is constant along the motion: it depends on parameters and on the reference
    /// values of advected quantities.
    pub turned: Option<Expr>,
    /// The momenta for which Newton's method solves, if spatial velocities are transformed to the body frame.
    pub seen_from_body: Option<Vec<Expr>>,
    /// The blocks, if the model is not solved as a whole: none or several.
    pub blocks: Vec<Block>,
    /// Configurations whose velocities are part of one linear system, with others or with their own components, that
    /// Newton's method solves.
    pub one_system: Vec<usize>,
}

impl Solve {
    /// Whether the stepper accepts only symmetric factors `C` that are second moments of a body, and tests given
    /// factors for this. The Moser-Veselov equation with another factor does not determine the velocity. A model
    /// whose kinetic energy is degenerate then accepts no parameters.
    pub fn needs_second_moments(&self) -> bool {
        let symmetric = |r: &StepEquation| matches!(r, StepEquation::Exact(mv) if mv.symmetric);
        match self.method {
            Method::FreeMoserVeselov | Method::ForcedMoserVeselov => true,
            Method::LeftFactor => self.riccati.iter().all(symmetric),
            Method::Blocks => self.blocks.iter().any(|b| match b.method {
                Method::LeftFactor => b.members.iter().all(|i| symmetric(&self.riccati[*i])),
                _ => false,
            }),
            Method::Davenport | Method::UnitQuaternions | Method::Linear | Method::Newton => false,
        }
    }

    /// Whether the solver finds the velocity of a configuration in the body frame, although it is stated in space.
    pub fn finds_body_velocity(&self, i: usize) -> bool {
        let by_newton = match self.method {
            Method::Newton => true,
            Method::Blocks => self
                .blocks
                .iter()
                .any(|b| b.is_newton() && b.members.contains(&i)),
            _ => false,
        };
        self.turned.is_some() || by_newton && self.seen_from_body.is_some()
    }
}

/// Selects the solver; `stated` is the model before its reduction.
pub fn select_solver(
    stated: &Spec,
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> Solve {
    let riccati: Vec<StepEquation> = balances
        .iter()
        .enumerate()
        .map(|(i, b)| riccati(spec, letters, b, i, transports, algebra))
        .collect();
    let blocks = blocks::blocks(spec, letters, balances, &riccati, algebra);
    let systems = blocks.iter().filter(|b| b.is_one_system);
    let one_system: Vec<usize> = systems.flat_map(|b| b.members.clone()).collect();
    if blocks.len() > 1 || blocks.iter().any(Block::is_linear) {
        let newton = blocks.iter().any(Block::is_newton);
        return Solve {
            riccati,
            method: Method::Blocks,
            reason: blocks::reasons(letters, spec, &blocks),
            turned: None,
            seen_from_body: newton
                .then(|| seen_from_body(stated, spec, letters, balances))
                .flatten(),
            blocks,
            one_system,
        };
    }
    let three = |i: usize| is_of_space(&spec.configurations[i]);
    let turned = match riccati.as_slice() {
        _ if !spec.holds.is_empty() => None,
        // Symmetric factors in three dimensions have their own steppers.
        [StepEquation::Exact(mv)] if three(0) && mv.symmetric && keeps_edge(mv) => None,
        [StepEquation::Exact(mv)]
            if !is_constant(letters, mv) && balances[0].increment.is_some() =>
        {
            turned(spec, letters, transports, mv, algebra)
        }
        _ => None,
    };
    let kappa = "explicit up to the root of one quartic per step";
    let iterated = "Newton's method on the Lie algebra";
    let solver = if three(0) { kappa } else { iterated };
    let (method, reason) = match riccati.as_slice() {
        _ if !one_system.is_empty() || !spec.holds.is_empty() => {
            (Method::Newton, blocks::reasons(letters, spec, &blocks))
        }
        [StepEquation::Exact(mv)] if three(0) && mv.symmetric && is_free(mv) => (
            Method::FreeMoserVeselov,
            format!(
                "explicit up to the root of one quartic at the start{BECAUSE}the left factor is symmetric and {}, and no \
                 force acts",
                constancy(letters, mv)
            ),
        ),
        [StepEquation::Exact(mv)] if three(0) && mv.symmetric && keeps_edge(mv) => (
            Method::ForcedMoserVeselov,
            format!(
                "{kappa}{BECAUSE}the left factor is symmetric and {}",
                constancy(letters, mv)
            ),
        ),
        [StepEquation::Quaternionic(q)] if keeps_edge(&q.edge) => (
            Method::UnitQuaternions,
            format!(
                "one scalar equation per step{BECAUSE}its coefficients are {}",
                constancy(letters, &q.edge)
            ),
        ),
        [StepEquation::Quaternionic(_)] => (
            Method::Newton,
            format!(
                "{NEWTON}{BECAUSE}a coefficient depends on the step size or changes along the motion"
            ),
        ),
        [StepEquation::Exact(_)] if turned.is_some() => (
            Method::LeftFactor,
            format!("{solver}, in the body frame{BECAUSE}the left factor is constant there"),
        ),
        [StepEquation::Exact(mv)] if three(0) && !is_constant(letters, mv) => (
            Method::Davenport,
            format!(
                "the largest real eigenvalue of a 4 x 4 matrix{BECAUSE}the left factor is known at each node but is not \
                 constant"
            ),
        ),
        [StepEquation::Exact(mv)] if three(0) && mv.symmetric => (
            Method::LeftFactor,
            format!("{kappa}{BECAUSE}the left factor is symmetric and constant"),
        ),
        [StepEquation::Exact(_)] if three(0) => (
            Method::LeftFactor,
            format!(
                "{kappa}{BECAUSE}the left factor is constant and equals a rotation times a symmetric matrix"
            ),
        ),
        [StepEquation::Exact(mv)] if is_constant(letters, mv) => (
            Method::LeftFactor,
            format!("{iterated}{BECAUSE}the left factor is constant"),
        ),
        [StepEquation::Exact(_)] => (
            Method::Newton,
            format!(
                "{NEWTON}{BECAUSE}the left factor depends on the step size or changes along the motion"
            ),
        ),
        [StepEquation::None(why)] => (Method::Newton, format!("{NEWTON}{BECAUSE}{why}")),
        _ => (
            Method::Newton,
            format!("{NEWTON}s{BECAUSE}the equations of several velocities are coupled"),
        ),
    };
    let seen_from_body = match method {
        Method::Newton => seen_from_body(stated, spec, letters, balances),
        _ => None,
    };
    Solve {
        riccati,
        method,
        reason,
        turned,
        seen_from_body,
        blocks: Vec::new(),
        one_system,
    }
}

/// Whether a configuration is a rotation of space.
pub(super) fn is_of_space(c: &Configuration) -> bool {
    c.group.is_of_space()
}

/// The factor of a spatial velocity in the body frame, `Λ^T C Λ`, if it is constant there. Then `Λ^T ω Λ` solves the
/// equation of the body.
fn turned(
    spec: &Spec,
    letters: &Letters,
    transports: &[AdvectionRule],
    mv: &MoserVeselov,
    algebra: &Algebra,
) -> Option<Expr> {
    let s = &letters.symbols;
    let c = &spec.configurations[0];
    if c.side.is_body() {
        return None;
    }
    let values = carried(spec, transports);
    let here = expr::substitute(s, &mv.factor, &values);
    let element = expr::here(s, c.element);
    let seen = expr::product([expr::transpose(s, element.clone()), here, element]);
    let seen = algebra.raise(&algebra.lower(&seen));
    let advanced = |q: SymbolId| {
        let list = spec.advected.iter().zip(transports);
        list.clone()
            .any(|(a, t)| a.quantity == q && matches!(t, AdvectionRule::Advanced))
    };
    let constant = expr::letters(&seen).iter().all(|l| {
        let role = s.get(l.symbol).role;
        role == Role::Parameter || role == Role::Advected && !advanced(l.symbol)
    });
    constant.then_some(seen)
}

/// Whether `C` contains parameters only, so that it is validated once.
pub(super) fn is_constant(letters: &Letters, mv: &MoserVeselov) -> bool {
    let s = &letters.symbols;
    let letters = expr::letters(&mv.factor);
    letters
        .iter()
        .all(|l| s.get(l.symbol).role == Role::Parameter)
}

/// In which sense `C` is constant.
fn constancy(letters: &Letters, mv: &MoserVeselov) -> &'static str {
    match is_constant(letters, mv) {
        true => "constant",
        false => "constant in the body frame",
    }
}

/// Whether the motion is free: only the velocity contributes to the momentum.
fn is_free(mv: &MoserVeselov) -> bool {
    let arrive = mv.arrive.as_ref();
    mv.in_body.is_some() && mv.rest.is_zero() && arrive.is_some_and(Expr::is_zero)
}

/// Whether the momentum of the next edge can be computed at the end of a step and stored.
pub fn keeps_edge(mv: &MoserVeselov) -> bool {
    mv.in_body.is_some() && mv.arrive.is_some()
}

/// The rotation of the body relative to space.
fn frame(s: &Symbols, c: &Configuration) -> Expr {
    let element = expr::here(s, c.element);
    c.group.turn(s, &element).unwrap_or(element)
}

/// The impulse at a node on both sides of it, in the body frame; see [`MoserVeselov::torque`].
fn torque(
    spec: &Spec,
    letters: &Letters,
    i: usize,
    rest: &Expr,
    arrive: &Expr,
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> Option<Expr> {
    let s = &letters.symbols;
    let c = &spec.configurations[i];
    if c.side.is_body() || !rest.shape().is_vector() {
        return None;
    }
    let (before, after) = (expr::shift_time(s, arrive, -1), expr::neg(rest.clone()));
    let both = match before == after {
        true => expr::scale(Rational::integer(2), after),
        false => expr::add(before, after),
    };
    let spatial = expr::substitute(s, &both, &carried(spec, transports));
    let seen = from_body(s, algebra, &frame(s, c), &spatial);
    (!algebra.exhausted() && occurrences(&seen) <= occurrences(&spatial)).then_some(seen)
}

/// The number of letters in an expression, counted with repetition; transposes cost nothing.
fn occurrences(e: &Expr) -> u32 {
    let inside = |list: Vec<&Expr>| list.into_iter().map(occurrences).sum();
    u32::from(matches!(e.node(), Node::Letter(_))).saturating_add(inside(e.children()))
}

/// A vector in the body frame: the rotation passes through sums and vector products.
fn from_body(s: &Symbols, algebra: &Algebra, element: &Expr, e: &Expr) -> Expr {
    let of = |x: &Expr| from_body(s, algebra, element, x);
    match e.node() {
        Node::Sum(terms) => expr::sum(terms.iter().map(of), e.shape()),
        Node::Neg(a) => expr::neg(of(a)),
        Node::Cross(a, b) => expr::cross(of(a), of(b)),
        Node::Product(factors) => {
            let (numbers, others): (Vec<Expr>, Vec<Expr>) =
                factors.iter().cloned().partition(|f| f.shape().is_scalar());
            match others.as_slice() {
                [only] if !numbers.is_empty() => {
                    expr::product(numbers.into_iter().chain([of(only)]))
                }
                _ => turned_back(s, algebra, element, e),
            }
        }
        _ => turned_back(s, algebra, element, e),
    }
}

fn turned_back(s: &Symbols, algebra: &Algebra, element: &Expr, e: &Expr) -> Expr {
    let back = expr::transpose(s, element.clone());
    shorter(algebra, expr::mul(back, e.clone()))
}

/// Advected quantities, expressed by the action on their reference values, which their letters denote.
fn carried(spec: &Spec, transports: &[AdvectionRule]) -> Vec<(Letter, Expr)> {
    let list = spec.advected.iter().zip(transports);
    list.filter_map(|(a, t)| match t {
        AdvectionRule::Defined(value) | AdvectionRule::Carried { value, .. } => {
            Some((at(a.quantity, Shift::HERE), value.clone()))
        }
        AdvectionRule::Advanced => None,
    })
    .collect()
}

/// `C` in the frame of the body, if it is constant there.
fn in_body(
    spec: &Spec,
    letters: &Letters,
    i: usize,
    factor: &Expr,
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> Option<Expr> {
    let s = &letters.symbols;
    let c = &spec.configurations[i];
    let values = carried(spec, transports);
    let known = |l: &Letter| {
        s.get(l.symbol).role == Role::Parameter || values.iter().any(|(letter, _)| letter == l)
    };
    if !expr::letters(factor).iter().all(known) {
        return None;
    }
    let carried = expr::substitute(s, factor, &values);
    if c.side.is_body() && !expr::contains_role(s, &carried, Role::Element) {
        return Some(carried);
    }
    let seen = if c.side.is_body() {
        carried
    } else {
        let element = frame(s, c);
        expr::product([expr::transpose(s, element.clone()), carried, element])
    };
    let reduced = shorter(algebra, algebra.raise(&algebra.lower(&seen)));
    (!expr::contains_role(s, &reduced, Role::Element)).then_some(reduced)
}

/// The momentum received at the node at the end of the edge; see [`MoserVeselov::arrive`].
fn arrive(
    spec: &Spec,
    letters: &Letters,
    i: usize,
    b: &Balance,
    rest: &Expr,
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> Option<Expr> {
    let s = &letters.symbols;
    if transports
        .iter()
        .any(|t| matches!(t, AdvectionRule::Advanced))
    {
        return None;
    }
    let value = if spec.configurations[i].side.is_body() {
        (*rest == b.node_out).then(|| b.node_in.clone())?
    } else {
        let total = expr::add(b.increment.clone()?, rest.clone());
        let short = match total.shape().is_vector() {
            true => expr::vee(algebra.raise(&algebra.lower(&expr::hat(total.clone())))),
            false => algebra.raise(&algebra.lower(&total)),
        };
        shorter(algebra, short)
    };
    let here = |l: &Letter| {
        let constant = matches!(s.get(l.symbol).role, Role::Parameter | Role::Step);
        !constant && l.shift == Shift::HERE
    };
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    (!moving(&value) && !moving(rest) && !expr::letters(&value).iter().any(here)).then_some(value)
}

fn riccati(
    spec: &Spec,
    letters: &Letters,
    b: &Balance,
    i: usize,
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> StepEquation {
    let s = &letters.symbols;
    let c = &spec.configurations[i];
    if c.group.is_quaternionic() {
        return match quaternionic::form(spec, letters, b, i, algebra) {
            Ok((factor, real, rest)) => {
                let edge = with_node(spec, letters, b, i, factor, rest, transports, algebra);
                StepEquation::Quaternionic(Quaternionic { edge, real })
            }
            Err(why) => StepEquation::None(why),
        };
    }
    if c.group.is_linear() || c.group.is_additive() {
        return match two_sided_linear::form(spec, letters, b, i, algebra) {
            Ok(form) => StepEquation::Linear(form),
            Err(why) => StepEquation::None(why),
        };
    }
    if !c.group.is_orthogonal() {
        return StepEquation::None("the group is not SO(n)".to_owned());
    }
    let n = c.group.size();
    let outgoing = expr::substitute(s, &b.outgoing, &spec.end_of_edge());
    let matrix = if n == Dim::Fixed(3) {
        expr::hat(outgoing)
    } else {
        outgoing
    };
    let poly = algebra.lower(&matrix);
    let Some((factor, rest)) = split(algebra, &poly, c.velocity, s) else {
        let name = &s.get(c.velocity).name;
        return StepEquation::None(format!(
            "the momentum is not linear in {name} as its left factor"
        ));
    };
    let step = expr::here(s, spec.step);
    // h N = Ω C^T - C Ω^T, and the balance contains 1/h.
    let transposed = expr::mul(step, algebra.raise(&factor));
    let factor = shorter(algebra, expr::transpose(s, transposed));
    let rest = algebra.raise(&rest);
    // The node's own part, if it is the whole: it has the form that the user would write.
    let own = match n {
        Dim::Fixed(3) => expr::hat(b.node_out.clone()),
        _ => b.node_out.clone(),
    };
    let rest = if algebra.equal(&own, &rest) {
        b.node_out.clone()
    } else if n == Dim::Fixed(3) {
        shorter(algebra, expr::vee(rest))
    } else {
        rest
    };
    let mv = with_node(spec, letters, b, i, factor, rest, transports, algebra);
    let own = at(c.velocity, Shift::HERE);
    if expr::contains(&mv.factor, own) || expr::contains(&mv.rest, own) {
        let name = &s.get(c.velocity).name;
        return StepEquation::None(format!(
            "the momentum is not linear in {name} as its left factor"
        ));
    }
    let moving = |e: &Expr| expr::contains_role(s, e, Role::Velocity);
    if moving(&mv.factor) || moving(&mv.rest) {
        return StepEquation::Coupled(mv);
    }
    StepEquation::Exact(mv)
}

/// The equation with the forces at the nodes.
#[allow(clippy::too_many_arguments)]
fn with_node(
    spec: &Spec,
    letters: &Letters,
    b: &Balance,
    i: usize,
    factor: Expr,
    rest: Expr,
    transports: &[AdvectionRule],
    algebra: &Algebra,
) -> MoserVeselov {
    let flipped = expr::transpose(&letters.symbols, factor.clone());
    let arrive = arrive(spec, letters, i, b, &rest, transports, algebra);
    MoserVeselov {
        symmetric: algebra.is_zero(&expr::sub(factor.clone(), flipped)),
        in_body: in_body(spec, letters, i, &factor, transports, algebra),
        torque: arrive
            .as_ref()
            .and_then(|a| torque(spec, letters, i, &rest, a, transports, algebra)),
        arrive,
        factor,
        rest,
    }
}
