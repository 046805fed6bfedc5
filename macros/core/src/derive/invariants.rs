//! Conserved quantities: candidates built from the momentum, the advected quantities and the
//! Riccati factor, each kept only if the normal form proves it constant over one step. The energy
//! is exact where it is a combination of proven invariants, else it oscillates within O(h^2).

use super::Letters;
use super::balance::Balance;
use super::limit::Limit;
use super::recognise::{Riccati, Solve};
use super::variation::at;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::{Side, Spec};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// What an invariant is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Kind {
    /// The spatial momentum of a configuration, kept by a symmetry.
    SpatialMomentum(usize),
    /// A number made of node quantities.
    Number,
    /// The physical energy.
    Energy,
}

/// One conserved quantity at a node.
#[derive(Clone, Debug)]
pub struct Invariant {
    /// Its ASCII name.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Its value by node momenta, advected quantities and parameters. The energy has none: it is
    /// evaluated from the limit.
    pub value: Option<Expr>,
    /// Its natural scale, as a number.
    pub scale: Option<Expr>,
    /// Whether it is conserved exactly, or only oscillates.
    pub exact: bool,
    /// Why it is conserved, in a few words.
    pub reason: String,
}

/// What the search looks at.
pub struct Inputs<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// All letters.
    pub letters: &'a Letters,
    /// The balances.
    pub balances: &'a [Balance],
    /// What is solved.
    pub solve: &'a Solve,
    /// The continuous Lagrangian.
    pub limit: Option<&'a Limit>,
    /// The normal forms.
    pub algebra: &'a Algebra<'a>,
}

/// The invariants that can be proved.
pub fn invariants(x: &Inputs) -> Vec<Invariant> {
    let mut out = Vec::new();
    if x.limit.is_some() {
        let exact = energy_is_exact(x);
        out.push(Invariant {
            name: "energy".to_owned(),
            kind: Kind::Energy,
            value: None,
            scale: None,
            exact,
            reason: if exact {
                "a combination of |μ|² and μ·C²μ, both proved".to_owned()
            } else {
                "the stepper is symplectic".to_owned()
            },
        });
    }
    if let [c] = x.spec.configurations.as_slice()
        && c.group.size() == Dim::Fixed(3)
        && c.group.is_orthogonal()
    {
        momentum_and_casimirs(x, &mut out);
    }
    out
}

/// Node quantities after the step, in letters of the edge and of the node before.
fn after(x: &Inputs, e: &Expr) -> Expr {
    let s = &x.letters.symbols;
    let mut list: Vec<(Letter, Expr)> = Vec::new();
    for a in &x.spec.advected {
        list.push((at(a.quantity, Shift::HERE), a.update.clone()));
    }
    for (i, b) in x.balances.iter().enumerate() {
        list.push((
            at(x.letters.node_momentum[i], Shift::HERE),
            end(x, &b.incoming),
        ));
    }
    expr::substitute(s, e, &list)
}

/// Node quantities before the step.
fn before(x: &Inputs, e: &Expr) -> Expr {
    let s = &x.letters.symbols;
    let mut list: Vec<(Letter, Expr)> = Vec::new();
    for (i, b) in x.balances.iter().enumerate() {
        list.push((
            at(x.letters.node_momentum[i], Shift::HERE),
            end(x, &b.outgoing),
        ));
    }
    expr::substitute(s, e, &list)
}

/// Quantities at the end of the edge by those at its start.
fn end(x: &Inputs, e: &Expr) -> Expr {
    let list: Vec<(Letter, Expr)> = x
        .spec
        .advected
        .iter()
        .map(|a| (at(a.quantity, Shift::NEXT), a.update.clone()))
        .collect();
    expr::substitute(&x.letters.symbols, e, &list)
}

fn is_conserved(x: &Inputs, value: &Expr) -> bool {
    same(x, &after(x, value), &before(x, value))
}

/// Equality; of vectors in three dimensions by their skew matrices, where the algebra knows more.
fn same(x: &Inputs, a: &Expr, b: &Expr) -> bool {
    let difference = expr::sub(a.clone(), b.clone());
    if difference.shape() == Shape::vector(Dim::Fixed(3)) {
        return x.algebra.is_zero(&expr::hat(difference));
    }
    x.algebra.is_zero(&difference)
}

/// The length of a vector.
fn length(v: Expr) -> Expr {
    expr::power(expr::dot(v.clone(), v), Rational::HALF)
}

fn momentum_and_casimirs(x: &Inputs, out: &mut Vec<Invariant>) {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[0];
    let mu = expr::here(s, x.letters.node_momentum[0]);
    let w = expr::here(s, c.velocity);
    let (first, last) = (before(x, &mu), after(x, &mu));
    let last = match c.side {
        Side::Body => expr::mul(w, last),
        Side::Spatial => last,
    };
    let free = same(x, &first, &last);
    if free {
        out.push(Invariant {
            name: "spatial_momentum".to_owned(),
            kind: Kind::SpatialMomentum(0),
            value: Some(mu.clone()),
            scale: Some(length(mu.clone())),
            exact: true,
            reason: "Noether: the action is invariant under rotations of space".to_owned(),
        });
    }
    let number =
        |out: &mut Vec<Invariant>, name: String, value: Expr, scale: Expr, reason: &str| {
            let kept = value.size() < 200 && is_conserved(x, &value);
            if kept {
                out.push(Invariant {
                    name,
                    kind: Kind::Number,
                    value: Some(value),
                    scale: Some(scale),
                    exact: true,
                    reason: reason.to_owned(),
                });
            }
            kept
        };
    let square = expr::dot(mu.clone(), mu.clone());
    let has_square = number(
        out,
        "momentum_squared".to_owned(),
        square.clone(),
        square.clone(),
        "Casimir",
    );
    if let Some(Riccati::Exact(mv)) = x.solve.riccati.first() {
        let factor = mv.factor.clone();
        let value = expr::dot(
            mu.clone(),
            expr::product([factor.clone(), factor.clone(), mu.clone()]),
        );
        let size = expr::mul(
            expr::trace(expr::mul(factor.clone(), factor.clone())),
            square,
        );
        // tr(hat(μ)² C²) = μ·C²μ - |μ|² tr C², and as a trace the algebra can decide it.
        let skew = expr::hat(mu.clone());
        let proof = expr::trace(expr::product([
            skew.clone(),
            skew,
            factor.clone(),
            factor.clone(),
        ]));
        let constant = expr::letters(&factor)
            .iter()
            .all(|l| s.get(l.symbol).role == Role::Parameter);
        if constant && has_square && is_conserved(x, &proof) {
            out.push(Invariant {
                name: "momentum_quadratic".to_owned(),
                kind: Kind::Number,
                value: Some(value),
                scale: Some(size),
                exact: true,
                reason: "Manakov integral μ·C²μ".to_owned(),
            });
        }
    }
    let vectors: Vec<SymbolId> = of_shape(x, Shape::vector(Dim::Fixed(3)));
    let matrices: Vec<SymbolId> = of_shape(x, Shape::square(Dim::Fixed(3)));
    let name = |id: SymbolId| s.get(id).ascii.clone();
    // A constant vector of space is paired with a spatial momentum, an advected one with either.
    let constants = x
        .spec
        .parameters
        .iter()
        .copied()
        .filter(|p| c.side == Side::Spatial && s.get(*p).shape == Shape::vector(Dim::Fixed(3)));
    if !free {
        for v in vectors.iter().copied().chain(constants) {
            let a = expr::here(s, v);
            let value = expr::dot(mu.clone(), a.clone());
            let scale = expr::mul(length(mu.clone()), length(a));
            number(
                out,
                format!("momentum_{}", name(v)),
                value,
                scale,
                "Casimir, and momentum about a fixed axis",
            );
        }
    }
    for (i, u) in vectors.iter().enumerate() {
        for v in &vectors[i..] {
            let (a, b) = (expr::here(s, *u), expr::here(s, *v));
            let label = if u == v {
                format!("{}_squared", name(*u))
            } else {
                format!("{}_{}", name(*u), name(*v))
            };
            let scale = expr::mul(length(a.clone()), length(b.clone()));
            number(out, label, expr::dot(a, b), scale, "Casimir");
        }
    }
    for m in &matrices {
        let a = expr::here(s, *m);
        let at = expr::transpose(s, a.clone());
        let size = expr::power(expr::trace(expr::mul(at, a.clone())), Rational::HALF);
        let mut power = a.clone();
        for n in 1..=3i64 {
            let scale = expr::power(size.clone(), Rational::integer(n));
            number(
                out,
                format!("trace_{}{n}", name(*m)),
                expr::trace(power.clone()),
                scale,
                "Casimir: eigenvalues",
            );
            power = expr::mul(power, a.clone());
        }
        for (i, u) in vectors.iter().enumerate() {
            for v in &vectors[i..] {
                let (p, q) = (expr::here(s, *u), expr::here(s, *v));
                let scale = expr::product([length(p.clone()), size.clone(), length(q.clone())]);
                let value = expr::dot(p, expr::mul(a.clone(), q));
                number(
                    out,
                    format!("{}_{}_{}", name(*u), name(*m), name(*v)),
                    value,
                    scale,
                    "Casimir",
                );
            }
        }
    }
}

fn of_shape(x: &Inputs, shape: Shape) -> Vec<SymbolId> {
    let list = x.spec.advected.iter().map(|a| a.quantity);
    list.filter(|q| x.letters.symbols.get(*q).shape == shape)
        .collect()
}

/// For the free body in three dimensions the inverse of the inertia is a polynomial of degree two
/// in `C` without linear part (Cayley-Hamilton), so that the kinetic energy is a combination of
/// `|μ|²` and `μ·C²μ`. Holds when the kinetic energy of the limit is the one of `C`.
fn energy_is_exact(x: &Inputs) -> bool {
    let (Some(limit), [Riccati::Exact(mv)]) = (x.limit, x.solve.riccati.as_slice()) else {
        return false;
    };
    let s = &x.letters.symbols;
    let constant = !expr::letters(&mv.factor)
        .iter()
        .any(|l| s.get(l.symbol).role == Role::Advected);
    if !matches!(x.solve.method, super::recognise::Method::FreeMoserVeselov)
        || !constant
        || !limit.potential.is_zero()
        || !limit.linear.is_zero()
    {
        return false;
    }
    let xi = expr::here(s, x.letters.variation[0]);
    let form = expr::trace(expr::product([mv.factor.clone(), xi.clone(), xi]));
    let of_factor = expr::scale(Rational::HALF, expr::neg(form));
    debug_assert!(!matches!(limit.kinetic.node(), Node::Zero(_)));
    x.algebra.equal(&limit.kinetic, &of_factor)
}
