//! The discrete Euler-Lagrange balance at node k: the contributions of the two adjacent edges to the variation of the
//! action, split by source (the velocity, and quantities at the node), each as an element of the dual of the Lie
//! algebra.

use super::Letters;
use super::action::Action;
use super::cancellation;
use super::intermediate_positions;
use super::rounding::Rounding;
use super::variation::{Variation, at};
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Spec};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

/// The balance of one configuration. Every part is a covector of the Lie algebra in the form of [`crate::groups`]: a
/// vector for SO(3) and SU(2), a skew matrix for SO(n), a matrix for GL(n), an angular vector stacked on a linear one
/// for SE(3).
#[derive(Clone, Debug)]
pub struct Balance {
    /// Gradient of the action of the outgoing edge with respect to its velocity.
    pub gradient: Expr,
    /// The contribution of the velocity to the outgoing edge: `R`, with a plus sign in the node momentum.
    pub edge_out: Expr,
    /// The contribution of quantities at node k to the outgoing edge: the node momentum is `edge_out + node_out`.
    pub node_out: Expr,
    /// The contribution of the velocity to the incoming edge, written on the outgoing edge of node k-1 shifted to
    /// start at k: the transported `R`.
    pub edge_in: Expr,
    /// The contribution of quantities at the end of the edge, written on the edge that starts at k (so that they are
    /// evaluated at k+1): the momentum at k+1 is `edge_in + node_in`.
    pub node_in: Expr,
    /// The node momentum on the outgoing edge: `edge_out + node_out`, in its shortest form.
    pub outgoing: Expr,
    /// The node momentum at the end of the edge: `edge_in + node_in`, in its shortest form.
    pub incoming: Expr,
    /// On the spatial side: the increment of the momentum in the step, if it is free of velocities (zero if the
    /// momentum is conserved). Adding the increment protects conserved quantities from rounding errors.
    pub increment: Option<Expr>,
    /// For each advected quantity: gradient of the outgoing edge at its start and at its end.
    pub advected_gradients: Vec<(Expr, Expr)>,
    /// The variation of the action of the outgoing edge of node k, a scalar linear in `ξ`.
    pub variation_out: Expr,
    /// The variation of the action of the incoming edge of node k.
    pub variation_in: Expr,
}

/// The balances of all configurations.
pub fn balances(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    variations: &[Variation],
    algebra: &Algebra,
) -> Vec<Balance> {
    let pairs = spec.configurations.iter().zip(variations).enumerate();
    pairs
        .map(|(i, (c, v))| balance(spec, letters, action, v, c, i, algebra))
        .collect()
}

fn balance(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    v: &Variation,
    c: &Configuration,
    i: usize,
    algebra: &Algebra,
) -> Balance {
    let s = &letters.symbols;
    let l = &action.total;
    let xi = at(letters.variation[i], Shift::HERE);
    let gradient = expr::gradient(s, l, at(c.velocity, Shift::HERE));
    let velocity_next = expr::shift_time(s, &v.incoming.1, Shift::NEXT.time);
    let dual = |pairing: Expr| {
        let y = expr::gradient(s, &pairing, xi);
        c.group.of_gradient(s, y)
    };
    let edge_out = dual(expr::neg(pairing(letters, &gradient, &v.outgoing.1)));
    let edge_in = dual(pairing(letters, &gradient, &velocity_next));
    // Quantities at a node: the algebra gives short forms.
    let nodes_of = |l: &Expr, shift: Shift| {
        let mut terms = Vec::new();
        for (letter, change) in v.advected.iter().chain([&v.element]) {
            let wrt = Letter {
                symbol: letter.symbol,
                shift,
            };
            if change.is_zero() {
                continue;
            }
            let g = expr::gradient(s, l, wrt);
            if !g.is_zero() {
                let change = expr::shift_time(s, change, shift.time);
                terms.push(pairing(letters, &g, &change));
            }
        }
        dual(expr::sum(terms, Shape::SCALAR))
    };
    let nodes_short = |l: &Expr, shift| shorter(algebra, nodes_of(l, shift));
    let advected_gradients = spec
        .advected
        .iter()
        .map(|a| {
            let g = |shift| expr::gradient(s, l, at(a.quantity, shift));
            (g(Shift::HERE), g(Shift::NEXT))
        })
        .collect();
    let before = expr::shift_time(s, l, Shift::PREVIOUS.time);
    let (derived_out, derived_in) = (edge_out, edge_in);
    let (edge_out, edge_in) = (
        shorter(algebra, derived_out.clone()),
        shorter(algebra, derived_in.clone()),
    );
    let (node_out, node_in) = (
        expr::neg(nodes_short(l, Shift::HERE)),
        nodes_short(l, Shift::NEXT),
    );
    let total = |a: &Expr, b: &Expr, derived: &dyn Fn() -> Expr| {
        let whole = shorter(algebra, expr::add(a.clone(), b.clone()));
        rounded_least(spec, algebra, without_zeros(algebra, whole), derived)
    };
    let outgoing = total(&edge_out, &node_out, &|| {
        expr::sub(derived_out.clone(), nodes_of(l, Shift::HERE))
    });
    let incoming = total(&edge_in, &node_in, &|| {
        expr::add(derived_in.clone(), nodes_of(l, Shift::NEXT))
    });
    // The contribution of the potentials, if the step adds nothing else.
    let acting = || {
        if c.side.is_body() {
            return None;
        }
        let at = |shift| nodes_short(&action.distributed, shift);
        let added = shorter(algebra, expr::add(at(Shift::HERE), at(Shift::NEXT)));
        let step = expr::sub(incoming.clone(), outgoing.clone());
        let rest = forward(spec, s, &expr::sub(step, added.clone()));
        let moving = expr::contains_role(s, &added, Role::Velocity);
        (!moving && algebra.is_zero(&rest)).then_some(added)
    };
    let increment = match increment(s, c, &outgoing, &incoming, algebra) {
        // Its expanded form may have lost the cancellation between positions.
        Some(added) if cancellation::error(algebra, &added) > 0.0 => Some(match acting() {
            Some(derived) => cancellation::nearer(algebra, added, derived),
            None => added,
        }),
        Some(added) => Some(added),
        None => acting(),
    };
    Balance {
        increment,
        outgoing,
        incoming,
        edge_out,
        node_out,
        edge_in,
        node_in,
        gradient,
        advected_gradients,
        variation_out: expr::directional(s, l, &v.on_outgoing()),
        variation_in: expr::directional(s, &before, &v.on_incoming()),
    }
}

/// The order of rounding of a momentum that is linear in the velocity: a rounded matrix, divided by the step size.
const LINEAR: f64 = -1.0;

/// The largest momentum of which two forms are compared.
const LARGEST: u32 = 2_000;

/// The short form of a momentum, or the derived form if its rounding error is smaller for small steps: powers of
/// `vee(Ω)` stay products of small numbers in it. The short form is used if its rounding error is at most that of a
/// momentum linear in the velocity, unless the derived form has none at all for small steps.
fn rounded_least(spec: &Spec, algebra: &Algebra, short: Expr, derived: &dyn Fn() -> Expr) -> Expr {
    let symbols = algebra.symbols();
    if short.size() > LARGEST || !expr::contains_role(symbols, &short, Role::Velocity) {
        return short;
    }
    let rounding = Rounding {
        spec,
        symbols,
        algebra,
    };
    let known = rounding.error(&short);
    if known >= 0.0 {
        return short;
    }
    let derived = derived();
    let own = rounding.error(&derived);
    match own > known && (known < LINEAR || own >= 0.0) {
        true => derived,
        false => short,
    }
}

/// Expresses quantities at the end of the edge by its start and the velocities.
fn forward(spec: &Spec, s: &Symbols, e: &Expr) -> Expr {
    let groups = spec.configurations.iter().map(|c| (c.element, &c.update));
    let advected = spec.advected.iter().map(|a| (a.quantity, &a.update));
    let list: Vec<(Letter, Expr)> = groups
        .chain(advected)
        .map(|(x, update)| (at(x, Shift::NEXT), update.clone()))
        .collect();
    expr::substitute(s, e, &list)
}

fn increment(
    s: &Symbols,
    c: &Configuration,
    outgoing: &Expr,
    incoming: &Expr,
    algebra: &Algebra,
) -> Option<Expr> {
    if c.side.is_body() {
        return None;
    }
    let difference = expr::sub(incoming.clone(), outgoing.clone());
    let axial = difference.shape() == Shape::vector(Dim::Fixed(3));
    let reduced = if axial && c.group.only_turns() {
        // Axial vectors cancel in the form of skew matrices.
        expr::vee(algebra.raise(&algebra.lower(&expr::hat(difference))))
    } else {
        algebra.raise(&algebra.lower(&difference))
    };
    let reduced = shorter(algebra, reduced);
    (!expr::contains_role(s, &reduced, Role::Velocity)).then_some(reduced)
}

/// `<a, b> = tr(a^T b)`.
pub fn pairing(letters: &Letters, a: &Expr, b: &Expr) -> Expr {
    if a.shape().is_scalar() {
        expr::mul(a.clone(), b.clone())
    } else if a.shape().is_vector() {
        expr::dot(a.clone(), b.clone())
    } else {
        let t = expr::transpose(&letters.symbols, a.clone());
        expr::trace(expr::mul(t, b.clone()))
    }
}

/// The expression without terms that vanish, such as the axial vector of `S S^-1`.
fn without_zeros(algebra: &Algebra, mut e: Expr) -> Expr {
    // A larger residual is unchanged: the cost of the search is quadratic in its size.
    while e.size() < 1_000 {
        let idle = expr::changes(algebra.symbols(), &e)
            .into_iter()
            .find(|c| !c.flipped && algebra.agree(&e, &c.changed));
        match idle {
            // Dropping the only term of zero changes nothing.
            Some(c) if c.changed != e => e = c.changed,
            _ => break,
        }
    }
    e
}

/// Whether the letters of `a` are a proper subset of the letters of `b`.
fn has_fewer_letters(a: &Expr, b: &Expr) -> bool {
    let (some, all) = (expr::letters(a), expr::letters(b));
    some.len() < all.len() && some.iter().all(|l| all.contains(l))
}

/// The reduced form of the algebra, if it is smaller than the expression or free of a letter that cancels: `V V^T` of
/// a rotation, if no velocity is known. The expression is unchanged if the reduced form has larger rounding errors
/// for positions far from the origin. Powers of positions between two nodes stay powers.
pub fn shorter(algebra: &Algebra, e: Expr) -> Expr {
    if let (Some(rows), false) = (expr::rows_in_parts(&e), e.is_zero()) {
        // The angular and the linear part separately.
        let [angular, linear] = rows.map(|(at, count)| {
            let part = expr::rows_of(algebra.symbols(), &e, at, count);
            cancellation::least(algebra, algebra.shortest(&part), &part)
        });
        return expr::stacked(angular, linear);
    }
    let reduced = algebra.shortest(&e);
    let preferred = reduced.size() <= e.size() || has_fewer_letters(&reduced, &e);
    if algebra.exhausted() || !preferred {
        return e;
    }
    let in_between = intermediate_positions::reduced(algebra, &e, &reduced);
    let in_between = in_between.filter(|form| form.size() <= e.size().max(reduced.size()));
    cancellation::nearer(algebra, in_between.unwrap_or(reduced), e)
}
