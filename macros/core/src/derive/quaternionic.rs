//! The equation of a step on SU(2) that reduces to a scalar equation: with the velocity `w + v`, the balance is `w A
//! v + v x A v + β v = h N / 2`, `A` symmetric. Takes the balance; gives `A`, `β` and the part of the node momentum
//! that does not belong to the edge, or the reason why the balance is not of this form.

use super::Letters;
use super::balance::{Balance, shorter};
use super::parts::{Parts, Velocity};
use super::select_solver::MoserVeselov;
use super::tangent::Direction;
use super::variation::at;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::Spec;
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Shift};

/// The parts of such an equation.
#[derive(Clone, Debug)]
pub struct Quaternionic {
    /// The fields shared with a Moser-Veselov equation; the factor is `A`.
    pub edge: MoserVeselov,
    /// `β`, which depends on parameters only.
    pub real: Expr,
}

/// `A`, `β` and the remainder of the node momentum.
///
/// Two derivatives of the balance give both: with respect to `w`, and with respect to `v` at zero. It is then proved
/// that the balance has this form for all numbers `w` and `v`.
pub(super) fn form(
    spec: &Spec,
    letters: &Letters,
    b: &Balance,
    i: usize,
    algebra: &Algebra,
) -> Result<(Expr, Expr, Expr), String> {
    let name = &letters.symbols.get(spec.configurations[i].velocity).name;
    // As the balance of a model with a single configuration.
    let own = Spec {
        configurations: vec![spec.configurations[i].clone()],
        ..spec.clone()
    };
    let s = &letters.symbols;
    let whole = read(&own, letters, &b.outgoing, algebra).map(|(a, real, rest)| {
        let is_own = algebra.equal(&b.node_out, &rest);
        (a, real, if is_own { b.node_out.clone() } else { rest })
    });
    // Forces at the node may contain the quaternion itself, which is not split into parts.
    let without_node = || {
        let (a, real, rest) = read(&own, letters, &b.edge_out, algebra)?;
        let known = !expr::contains_role(s, &b.node_out, Role::Velocity);
        (known && rest.is_zero()).then(|| (a, real, b.node_out.clone()))
    };
    whole
        .or_else(without_node)
        .ok_or_else(|| {
            format!("the Lagrangian is not a quadratic form in the imaginary part of {name} plus a multiple of its real part")
        })
}

fn read(
    spec: &Spec,
    letters: &Letters,
    outgoing: &Expr,
    algebra: &Algebra,
) -> Option<(Expr, Expr, Expr)> {
    let parts = Parts::of(spec, letters)?;
    let [Velocity::Quaternion(re, im)] = parts.velocities[..] else {
        return None;
    };
    let s = &parts.symbols;
    let outgoing = expr::substitute(&letters.symbols, outgoing, &spec.end_of_edge());
    let momentum = parts.write(&outgoing)?;
    let inner = algebra.over(s);
    let (w, v) = (expr::here(s, re), expr::here(s, im));
    let [re, im] = [re, im].map(|id| at(id, Shift::HERE));
    // They must not contain velocities of other configurations either.
    let free = |e: &Expr| {
        !expr::contains(e, re)
            && !expr::contains(e, im)
            && !expr::contains_role(s, e, Role::Velocity)
    };
    let vector = Shape::vector(Dim::Fixed(3));
    let (nothing, zero) = (expr::integer(0), expr::zero(vector));
    let by_number = expr::directional(s, &momentum, &[(re, expr::integer(1))]);
    let by_number = expr::collect(s, &by_number);
    let of = |letter| Direction { symbols: s, letter };
    let a = of(im.symbol).matrix(&by_number)?;
    let still = expr::substitute(s, &momentum, &[(re, nothing.clone())]);
    let eta = expr::here(s, parts.direction);
    let by_vector = expr::directional(s, &still, &[(im, eta)]);
    let by_vector = expr::substitute(s, &by_vector, &[(im, zero.clone())]);
    let multiple = of(parts.direction).matrix(&expr::collect(s, &by_vector))?;
    let real = expr::scale(Rational::new(1, 3)?, expr::trace(multiple));
    let rest = expr::substitute(s, &still, &[(im, zero)]);
    let raised = |e: &Expr| shorter(&inner, e.clone());
    let (a, real, rest) = (raised(&a), raised(&real), raised(&rest));
    if ![&a, &real, &rest].into_iter().all(free) {
        return None;
    }
    let image = expr::mul(a.clone(), v.clone());
    let terms = [
        expr::mul(w, image.clone()),
        expr::cross(v.clone(), image),
        expr::mul(real.clone(), v),
        rest.clone(),
    ];
    let difference = expr::sub(momentum, expr::sum(terms, vector));
    let symmetric = expr::sub(a.clone(), expr::transpose(s, a.clone()));
    let proved = inner.is_zero(&difference) && inner.is_zero(&symmetric);
    algebra.charge(&inner);
    // h N / 2: the balance contains 2/h.
    let half = expr::scale(Rational::HALF, expr::here(&letters.symbols, spec.step));
    let scaled = |e: Expr| {
        let e = expr::mul(half.clone(), e);
        shorter(algebra, algebra.raise(&algebra.lower(&e)))
    };
    let (a, real) = (scaled(a), scaled(real));
    let constant = |l: &expr::Letter| letters.symbols.get(l.symbol).role == Role::Parameter;
    (proved && expr::letters(&real).iter().all(constant)).then_some((a, real, rest))
}
