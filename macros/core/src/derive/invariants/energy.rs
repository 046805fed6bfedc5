//! Energies. The physical energy at a node is the kinetic energy of the limit of small steps as a function of the
//! momentum, plus the potential. The discrete energy on an edge is the negative derivative of the action of the step
//! with respect to the step size. Both are bounded, as for every symplectic step, or exact if that is proved.

use super::random_step::RandomStep;
use super::{Family, Inputs, Invariant, Kind, Lax, here, is_conserved};
use crate::algebra::Rational;
use crate::algebra::assumed::eliminate;
use crate::algebra::exact::{Matrix, Point, add, inverse, mul, negate};
use crate::derive::Derivation;
use crate::derive::balance::shorter;
use crate::derive::kinetic::Kinetic;
use crate::derive::limit::DRIVEN;
use crate::expr::{self, Expr, Shift};

/// The energy, if the limit of small steps exists.
pub(super) fn energy(x: &Inputs, passages: &[RandomStep]) -> Option<Invariant> {
    x.limit?;
    let exact = !passages.is_empty()
        && passages.iter().all(|p| {
            let (a, b) = (value(x, &p.before), value(x, &p.after));
            a.is_some() && a == b
        });
    Some(Invariant {
        name: "energy".to_owned(),
        kind: Kind::Energy,
        family: Family::Energy,
        value: None,
        scale: None,
        exact,
        reason: if exact {
            "equal at both ends of every step".to_owned()
        } else {
            "the stepper is symplectic".to_owned()
        },
    })
}

/// The discrete energy of an edge, `-∂L_d/∂h`, minus its value at zero velocity.
#[derive(Clone, Debug)]
pub struct DiscreteEnergy {
    /// Its value, expressed by letters at both ends of the edge and the velocity.
    pub value: Expr,
    /// Whether it has the same value on every edge of a motion.
    pub exact: bool,
    /// The reason.
    pub reason: String,
}

impl Derivation {
    /// Whether the discrete energy of an edge is conserved, and the reason. If the kinetic energy is degenerate, a
    /// symplectic step does not bound it.
    pub fn discrete_energy(&self) -> (&'static str, &str) {
        let energy = &self.integrability.discrete_energy;
        if self.limit.as_ref().is_err_and(|why| why == DRIVEN) {
            return ("not conserved", DRIVEN);
        }
        let degenerate = self.kinetic.as_ref().and_then(Kinetic::degenerate);
        let first_order = self.kinetic.as_ref().is_some_and(|k| k.first_order);
        match (energy.exact, degenerate) {
            (true, _) => ("constant", &energy.reason),
            (false, Some(_)) if first_order => (
                "not known to be bounded",
                "the Lagrangian is linear in the velocities",
            ),
            (false, Some(_)) => (
                "not known to be bounded",
                "the kinetic energy is degenerate",
            ),
            (false, None) => ("bounded", &energy.reason),
        }
    }
}

/// The discrete energy.
pub(super) fn discrete(x: &Inputs, passages: &[RandomStep], lax: Option<&Lax>) -> DiscreteEnergy {
    let s = &x.letters.symbols;
    let h = here(x.spec.step);
    // A constant of the action would contribute h^-2. The value of the edge at zero velocity is subtracted if it is
    // constant along the motion.
    let still: Vec<(expr::Letter, Expr)> = x
        .spec
        .configurations
        .iter()
        .map(|c| (here(c.velocity), c.group.identity()))
        .collect();
    let rest = expr::substitute(s, &x.action.edge, &still);
    let at_node = expr::letters(&rest).iter().all(|l| l.shift == Shift::HERE);
    let action = if at_node && is_conserved(passages, &rest) {
        expr::sub(x.action.total.clone(), rest)
    } else {
        x.action.total.clone()
    };
    let value = shorter(x.algebra, expr::neg(expr::gradient(s, &action, h)));
    let exact = match (lax, x.spec.configurations.as_slice()) {
        (Some(lax), [c]) => {
            let c_w = expr::mul(lax.factor.clone(), expr::here(s, c.velocity));
            let difference = expr::sub(expr::trace(lax.factor.clone()), expr::trace(c_w));
            let square = expr::power(expr::here(s, x.spec.step), Rational::integer(2));
            x.algebra.equal(&value, &expr::quotient(difference, square))
        }
        _ => false,
    };
    DiscreteEnergy {
        value,
        exact,
        reason: if exact {
            "up to constants it is the trace of the left factor times the velocity, which the eigenvalues of the Lax \
                matrix determine".to_owned()
        } else {
            "the stepper is symplectic".to_owned()
        },
    }
}

/// The energy at a point: `½ (p - l)·K⁻¹(p - l) + V` in the basis of the Lie algebras.
fn value(x: &Inputs, point: &Point) -> Option<u64> {
    let limit = x.limit?;
    let s = &x.letters.symbols;
    let mut bases: Vec<(usize, Matrix)> = Vec::new();
    let mut momentum: Vec<u64> = Vec::new();
    for (i, c) in x.spec.configurations.iter().enumerate() {
        let mu = point.letter(here(x.letters.node_momentum[i]))?;
        let shape = s.get(x.letters.variation[i]).shape;
        let (rows, cols) = (point.dim(shape.rows), point.dim(shape.cols));
        for e in c.group.basis(&|n| point.dim(n)) {
            let m = element(&e, rows, cols);
            momentum.push(coordinate(&mu, &m, &e));
            bases.push((i, m));
        }
    }
    // Gradients of the kinetic energy and of the linear part with respect to each velocity.
    let variation = |i: usize| here(x.letters.variation[i]);
    let gradients = |e: &Expr| -> Vec<Expr> {
        let all = 0..x.letters.variation.len();
        all.map(|i| expr::gradient(s, e, variation(i))).collect()
    };
    let kinetic = gradients(&limit.kinetic);
    let linear = gradients(&limit.linear);
    let mut rest = point.clone();
    let zeros: Vec<Matrix> = x
        .letters
        .variation
        .iter()
        .map(|v| {
            let shape = s.get(*v).shape;
            Matrix::zeros(rest.dim(shape.rows), rest.dim(shape.cols))
        })
        .collect();
    for (i, zero) in zeros.iter().enumerate() {
        rest.set(variation(i), zero.clone());
    }
    // Gradients are linear in the velocities; a gradient does not depend on velocities that it does not contain.
    let answers: Vec<Vec<usize>> = (0..zeros.len())
        .map(|i| {
            let all = 0..kinetic.len();
            all.filter(|j| expr::contains(&kinetic[*j], variation(i)))
                .collect()
        })
        .collect();
    let mut rows: Vec<Vec<u64>> = Vec::new();
    for (i, e) in &bases {
        rest.set(variation(*i), e.clone());
        let mut values: Vec<Option<Matrix>> = vec![None; kinetic.len()];
        for j in &answers[*i] {
            values[*j] = Some(rest.value(&kinetic[*j])?);
        }
        rest.set(variation(*i), zeros[*i].clone());
        let entry = |(j, f): &(usize, Matrix)| values[*j].as_ref().map_or(0, |v| v.pairing(f));
        rows.push(bases.iter().map(entry).collect());
    }
    let offsets: Vec<Matrix> = linear
        .iter()
        .map(|g| rest.value(g))
        .collect::<Option<_>>()?;
    let p: Vec<u64> = bases
        .iter()
        .zip(&momentum)
        .map(|((j, f), m)| add(*m, negate(offsets[*j].pairing(f))))
        .collect();
    let n = rows.len();
    for (row, m) in rows.iter_mut().zip(&p) {
        row.push(*m);
    }
    if eliminate(&mut rows, n).len() < n {
        return None;
    }
    let twice = rows
        .iter()
        .zip(&p)
        .fold(0, |t, (r, m)| add(t, mul(r[n], *m)));
    let potential = rest.value(&limit.potential)?.at(0, 0);
    Some(add(mul(twice, inverse(2)?), potential))
}

fn element(entries: &[(usize, usize, i64)], rows: usize, cols: usize) -> Matrix {
    let mut m = Matrix::zeros(rows, cols);
    for (i, j, x) in entries {
        m.data[i * cols + j] = if *x < 0 { negate(1) } else { 1 };
    }
    m
}

/// The coordinate of a covector along a basis element: the component of a vector at the axis, or the entry of a
/// matrix at the element's first entry.
fn coordinate(mu: &Matrix, e: &Matrix, entries: &[(usize, usize, i64)]) -> u64 {
    if mu.cols == 1 && e.cols > 1 {
        // hat(axis) has its positive entry two rows after the axis, cyclically.
        let axis = match entries.first() {
            Some((2, 1, _)) => 0,
            Some((0, 2, _)) => 1,
            _ => 2,
        };
        return mu.at(axis, 0);
    }
    debug_assert_eq!(mu.rows, e.rows);
    entries.first().map_or(0, |(i, j, _)| mu.at(*i, *j))
}
