//! Decides whether a momentum is independent of others as a function on the phase space. Takes invariants and a
//! general point; compares ranks of differentials in exact arithmetic.

use super::random_step::RandomStep;
use super::{Family, Inputs, Invariant, here};
use crate::algebra::assumed::rank;
use crate::algebra::exact::{Matrix, Point};
use crate::derive::bracket;
use crate::expr::shape::Structure;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};

/// Whether a momentum is independent of those found, all as functions on the phase space.
pub(super) fn is_new(
    x: &Inputs,
    passages: &[RandomStep],
    found: &[Invariant],
    v: &Invariant,
) -> bool {
    let Some(p) = passages.first() else {
        return false;
    };
    let linear = |v: &Invariant| {
        let noether = v.family == Family::Noether;
        noether || v.value.as_ref().is_some_and(|e| is_linear(x, e))
    };
    let mut rows = Vec::new();
    for known in found.iter().filter(|f| linear(f)) {
        rows.extend(differentials(x, &p.before, known).unwrap_or_default());
    }
    let before = rank(&rows);
    let Some(own) = differentials(x, &p.before, v) else {
        return false;
    };
    rows.extend(own);
    rank(&rows) > before
}

fn is_linear(x: &Inputs, e: &Expr) -> bool {
    // A scalar that contains one momentum, such as a bracket `μ·a`.
    let momenta = &x.letters.node_momentum;
    fn count(e: &Expr, momenta: &[crate::expr::symbol::SymbolId]) -> usize {
        match e.node() {
            expr::Node::Letter(l) => usize::from(momenta.contains(&l.symbol)),
            _ => e.children().into_iter().map(|c| count(c, momenta)).sum(),
        }
    }
    count(e, momenta) > 0
        && !matches!(e.node(), expr::Node::Power(..))
        && x.letters.node_momentum.iter().all(|m| {
            let second = expr::gradient(&x.letters.symbols, e, here(*m));
            !expr::letters(&second)
                .iter()
                .any(|l| momenta.contains(&l.symbol))
        })
}

/// Whether a Casimir has the same value in every state and for all parameters: zero, or a combination of advected
/// quantities such as `tr(A B)`, where `B` is the inverse of `A`. A length that is always the same is listed, as a
/// Casimir whose drift is checked.
pub(super) fn is_same_for_all(x: &Inputs, passages: &[RandomStep], v: &Invariant) -> bool {
    let Some(value) = &v.value else {
        return false;
    };
    let rows = x.spec.configurations.first().map(|c| c.group.size());
    let size = |p: &RandomStep| rows.map(|n| p.before.dim(n));
    let Some(first) = passages.first() else {
        return false;
    };
    // Named dimensions vary from step to step, and such a scalar varies with them.
    let alike: Vec<Option<Matrix>> = passages
        .iter()
        .filter(|p| size(p) == size(first))
        .map(|p| p.before.value(value))
        .collect();
    let Some(Some(own)) = alike.first() else {
        return false;
    };
    let mut symbols: Vec<_> = expr::letters(value).iter().map(|l| l.symbol).collect();
    symbols.sort();
    symbols.dedup();
    alike.len() > 1
        && alike.iter().all(|value| value.as_ref() == Some(own))
        && (own.vanishes() || symbols.len() > 1)
}

/// Differentials of the entries of an invariant on the phase space: momenta, elements, and advected quantities
/// without a definition.
fn differentials(x: &Inputs, point: &Point, v: &Invariant) -> Option<Vec<Vec<u64>>> {
    let s = &x.letters.symbols;
    let value = v.value.clone()?;
    let definitions: Vec<(Letter, Expr)> = x
        .spec
        .advected
        .iter()
        .filter_map(|a| Some((here(a.quantity), a.definition.clone()?)))
        .collect();
    let value = expr::substitute(s, &value, &definitions);
    let shape = value.shape();
    let (rows, cols) = (point.dim(shape.rows), point.dim(shape.cols));
    let mut coordinates: Vec<(Letter, Matrix)> = Vec::new();
    for id in s.ids() {
        let symbol = s.get(id);
        let of_phase = match symbol.role {
            Role::Element => true,
            Role::Derived => x.letters.node_momentum.contains(&id),
            Role::Advected => x
                .spec
                .advected
                .iter()
                .any(|a| a.quantity == id && a.definition.is_none()),
            Role::Step | Role::Parameter | Role::Velocity | Role::Multiplier | Role::Variation => {
                false
            }
        };
        if of_phase {
            for t in tangents(point, here(id), symbol.structure)? {
                coordinates.push((here(id), t));
            }
        }
    }
    // Entry (i, j) is the pairing with a constant matrix. It is linear in the matrix, so one derivative is enough.
    let mut out = vec![vec![0; coordinates.len()]; rows * cols];
    let mut derivative: Option<(Letter, Expr)> = None;
    // The change of a letter is a letter of its shape: the letter itself, at an unused label.
    let marker = |l: Letter| Letter {
        symbol: l.symbol,
        shift: Shift {
            time: 0,
            label: [1, 0],
        },
    };
    let mut p = point.clone();
    for (k, (l, t)) in coordinates.iter().enumerate() {
        if !expr::contains(&value, *l) {
            continue;
        }
        let mark = marker(*l);
        if derivative.as_ref().is_none_or(|(of, _)| of != l) {
            let change = expr::letter(s, mark.symbol, mark.shift);
            derivative = Some((*l, expr::directional(s, &value, &[(*l, change)])));
        }
        let Some((_, d)) = &derivative else { continue };
        p.set(mark, t.clone());
        let moved = p.value(d)?;
        for (row, entry) in out.iter_mut().zip(&moved.data) {
            row[k] = *entry;
        }
    }
    Some(out)
}

/// Tangent directions at a letter's value that preserve its structure, one per coordinate.
pub(super) fn tangents(point: &Point, l: Letter, structure: Structure) -> Option<Vec<Matrix>> {
    let value = point.letter(l)?;
    let (rows, cols) = (value.rows, value.cols);
    let entries = bracket::coordinates(structure, rows, cols);
    let unit = |i: usize, j: usize, mirror: Option<u64>| {
        let mut m = Matrix::zeros(rows, cols);
        m.data[i * cols + j] = 1;
        if let Some(sign) = mirror.filter(|_| i != j) {
            m.data[j * cols + i] = sign;
        }
        m
    };
    let minus = Some(crate::algebra::exact::negate(1));
    // A rotation has a mirrored entry of opposite sign; a translation does not.
    let turn = |i: usize, j: usize| {
        unit(
            i,
            j,
            (j + 1 < cols).then(|| crate::algebra::exact::negate(1)),
        )
    };
    let list = entries.into_iter().map(|(i, j)| match structure {
        Structure::UnitQuaternion => {
            let axis = [1, 2, 3].map(|k| u64::from(k == i));
            value.times(&crate::algebra::exact::pure(&axis))
        }
        Structure::RigidMotion => value.times(&turn(i, j)),
        Structure::General | Structure::Invertible | Structure::Diagonal => unit(i, j, None),
        Structure::Symmetric => unit(i, j, Some(1)),
        Structure::Skew => unit(i, j, minus),
        Structure::Orthogonal => value.times(&unit(i, j, minus)),
    });
    Some(list.collect())
}
