//! The continuous equations of motion, derived by the same calculus from the Lagrangian of the limit of small
//! steps: the Euler-Poincaré equation with advected quantities `dμ/dt = ±ad*_ζ μ + Σ ∂L/∂a ◇ a` and the transport
//! `da/dt = ζ·a`. They are printed next to the discrete equations, as in the thesis's tables A.2 to A.5. Time is
//! continuous here: no letter has a node.

use super::Letters;
use super::balance::{pairing, shorter};
use super::limit::Limit;
use super::variation::{Variation, at};
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Group, Spec};
use crate::expr::shape::Shape;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter, Node, Shift};

/// The equations of motion in continuous time, per configuration. Momenta and forces are covectors
/// as in [`crate::groups`]: vectors for SO(3), SU(2) and SE(3), skew matrices for SO(n), matrices
/// for GL(n).
#[derive(Clone, Debug)]
pub struct Continuous {
    /// The Lagrangian per unit time in the velocities `ζ` of [`Letters::rate`].
    pub lagrangian: Expr,
    /// The momentum `μ = ∂L/∂ζ` (body or spatial, by the side).
    pub momenta: Vec<Expr>,
    /// The coadjoint term, in the letter of [`Letters::node_momentum`]: `ad*_ζ μ` on the body side, `-ad*_ζ μ` on the
    /// spatial side.
    pub coadjoint: Vec<Expr>,
    /// The forces `Σ ∂L/∂a ◇ a`, quantities and elements alike.
    pub forces: Vec<Expr>,
    /// For each advected quantity the gradient of the Lagrangian.
    pub gradients: Vec<Expr>,
    /// For each advected quantity its rate of change `ζ·a`.
    pub rates: Vec<Expr>,
    /// For each configuration the rate of change of its element, `Λ ζ` or `ζ Λ`.
    pub reconstruction: Vec<Expr>,
    /// The residual of the equation of motion, in `ζ` and the accelerations of [`Letters::acceleration`]: `-dμ/dt ±
    /// ad*_ζ μ + Σ ∂L/∂a ◇ a`. It is the limit of the discrete balance over the step.
    pub balances: Vec<Expr>,
}

/// The velocity `ζ` in place of a letter of variation.
pub fn velocity(letters: &Letters, group: Group, symbol: SymbolId) -> Expr {
    let zeta = expr::here(&letters.symbols, symbol);
    group.rate(zeta)
}

/// The equations of motion of a limit.
pub fn continuous(
    spec: &Spec,
    letters: &Letters,
    variations: &[Variation],
    limit: &Limit,
    algebra: &Algebra,
) -> Continuous {
    let s = &letters.symbols;
    let to_rates: Vec<(Letter, Expr)> = spec
        .configurations
        .iter()
        .zip(letters.variation.iter().zip(&letters.rate))
        .map(|(c, (xi, zeta))| (at(*xi, Shift::HERE), velocity(letters, c.group, *zeta)))
        .collect();
    let along = |e: &Expr| expr::substitute(s, e, &to_rates);
    let short = |e: Expr| shorter(algebra, expr::collect(s, &e));
    let lagrangian = expr::collect(s, &along(&limit.lagrangian));
    // Every quantity changes along all velocities together, as it varies along all variations.
    let rates: Vec<Expr> = spec
        .advected
        .iter()
        .enumerate()
        .map(|(j, a)| {
            let parts = variations.iter().filter_map(|v| v.advected.get(j));
            let shape = s.get(a.quantity).shape;
            short(expr::sum(parts.map(|(_, e)| along(e)), shape))
        })
        .collect();
    let reconstruction: Vec<Expr> = variations.iter().map(|v| along(&v.element.1)).collect();
    let gradients = spec
        .advected
        .iter()
        .map(|a| {
            let g = expr::gradient(s, &lagrangian, at(a.quantity, Shift::HERE));
            let structure = s.get(a.quantity).structure;
            expr::collect(s, &expr::projected(s, structure, &g))
        })
        .collect();
    let elements = spec.configurations.iter().map(|c| c.element);
    let nodes = elements.chain(spec.advected.iter().map(|a| a.quantity));
    let moving: Vec<(Letter, Expr)> = nodes
        .map(|x| at(x, Shift::HERE))
        .zip(reconstruction.iter().chain(&rates).cloned())
        .collect();
    let accelerated = letters.rate.iter().zip(&letters.acceleration);
    let accelerated = accelerated.map(|(z, a)| (at(*z, Shift::HERE), expr::here(s, *a)));
    let everything: Vec<(Letter, Expr)> = moving.into_iter().chain(accelerated).collect();
    let mut out = Continuous {
        momenta: Vec::new(),
        coadjoint: Vec::new(),
        forces: Vec::new(),
        balances: Vec::new(),
        lagrangian: lagrangian.clone(),
        gradients,
        rates,
        reconstruction,
    };
    for (i, (c, v)) in spec.configurations.iter().zip(variations).enumerate() {
        let zeta = at(letters.rate[i], Shift::HERE);
        let gradient = expr::gradient(s, &lagrangian, zeta);
        let momentum = short(c.group.of_rate_gradient(s, gradient));
        let forces = forces(letters, c, v, i, &lagrangian);
        let forces = without_axial_vectors(algebra, short(forces));
        let mu = at(letters.node_momentum[i], Shift::HERE);
        let coadjoint = coadjoint(letters, c, i);
        let moved = expr::directional(s, &momentum, &everything);
        let carried = expr::substitute(s, &coadjoint, &[(mu, momentum.clone())]);
        let shape = momentum.shape();
        out.balances.push(expr::sum(
            [expr::neg(moved), carried, forces.clone()],
            shape,
        ));
        out.momenta.push(momentum);
        out.coadjoint.push(coadjoint);
        out.forces.push(forces);
    }
    out
}

/// Axial vectors of outer products as vector products, if no other axial vectors remain.
fn without_axial_vectors(algebra: &Algebra, e: Expr) -> Expr {
    fn has(e: &Expr) -> bool {
        matches!(e.node(), Node::Vee(_)) || e.children().into_iter().any(has)
    }
    if !has(&e) {
        return e;
    }
    let open = algebra.raise(&algebra.lower(&e));
    if has(&open) { e } else { open }
}

/// `Σ ∂L/∂x ◇ x` over all quantities that move with this configuration.
fn forces(
    letters: &Letters,
    c: &Configuration,
    v: &Variation,
    i: usize,
    lagrangian: &Expr,
) -> Expr {
    let s = &letters.symbols;
    let moved = v.advected.iter().chain([&v.element]);
    let terms = moved.filter_map(|(letter, change)| {
        let g = expr::gradient(s, lagrangian, *letter);
        (!g.is_zero() && !change.is_zero()).then(|| pairing(letters, &g, change))
    });
    let total = expr::sum(terms.collect::<Vec<_>>(), Shape::SCALAR);
    let xi = at(letters.variation[i], Shift::HERE);
    c.group.of_gradient(s, expr::gradient(s, &total, xi))
}

/// `ad*_ζ μ` with `<ad*_ζ μ, ξ> = <μ, [ζ, ξ]>`, with the sign of the side: velocities vary as
/// `δζ = dξ/dt + [ζ, ξ]` in the body and `dξ/dt - [ζ, ξ]` in space.
fn coadjoint(letters: &Letters, c: &Configuration, i: usize) -> Expr {
    let s = &letters.symbols;
    let mu = expr::here(s, letters.node_momentum[i]);
    let zeta = expr::here(s, letters.rate[i]);
    if c.side.is_body() {
        c.group.coadjoint(s, mu, zeta)
    } else {
        c.group.coadjoint_in_space(s, mu, zeta)
    }
}
