//! Noether momenta: of every set of coupled configurations in the space frame, of each one in its
//! body frame; whole, or about an axis that the parameters or the basis give. A symmetry of the
//! action is not asked for: that the momentum is conserved is proved itself.

use super::homogeneous;
use super::passage::Passage;
use super::{Candidate, Family, Inputs, Invariant, Kind, here, is_conserved, length};
use crate::algebra::Rational;
use crate::algebra::assumed::rank;
use crate::algebra::exact::{Matrix, Point};
use crate::check::spec::{Group, Side};
use crate::derive::action::summands;
use crate::derive::{bracket, lie};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Part, Shift};

/// Sets of configurations that the action couples, in order of declaration.
pub(super) fn components(x: &Inputs) -> Vec<Vec<usize>> {
    let count = x.spec.configurations.len();
    let mut of: Vec<usize> = (0..count).collect();
    for term in summands(&x.action.total) {
        let letters = expr::letters(&term);
        let met: Vec<usize> = (0..count).filter(|i| touches(x, &letters, *i)).collect();
        if let Some(first) = met.first().map(|i| of[*i]) {
            let joined: Vec<usize> = met.iter().map(|i| of[*i]).collect();
            for o in &mut of {
                if joined.contains(o) {
                    *o = first;
                }
            }
        }
    }
    let mut out: Vec<Vec<usize>> = Vec::new();
    for i in 0..count {
        match out.iter_mut().find(|set| of[set[0]] == of[i]) {
            Some(set) => set.push(i),
            None => out.push(vec![i]),
        }
    }
    out
}

fn touches(x: &Inputs, letters: &[Letter], i: usize) -> bool {
    let c = &x.spec.configurations[i];
    let own = |l: &Letter| l.symbol == c.element || l.symbol == c.velocity;
    letters.iter().any(|l| {
        own(l)
            || x.spec
                .advected
                .iter()
                .any(|a| a.quantity == l.symbol && expr::letters(&a.update).iter().any(own))
    })
}

/// The node momentum in the space frame.
fn in_space(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::Body)
}

/// The node momentum in the body frame.
fn in_body(x: &Inputs, i: usize) -> Expr {
    turned(x, i, Side::Spatial)
}

/// The node momentum, carried to the other frame if it is stated on this side.
fn turned(x: &Inputs, i: usize, from: Side) -> Expr {
    let s = &x.letters.symbols;
    let c = &x.spec.configurations[i];
    let mu = expr::here(s, x.letters.node_momentum[i]);
    if c.side != from {
        return mu;
    }
    let g = expr::here(s, c.element);
    let g = match c.side {
        Side::Body => g,
        Side::Spatial => expr::inverse(s, g),
    };
    lie::to_space(s, c.group, &g, mu)
}

/// Most parameters that are tried as axes or forms.
const AXES: usize = 12;

fn ascii(x: &Inputs, id: crate::expr::symbol::SymbolId) -> String {
    x.letters.symbols.get(id).ascii.clone()
}

fn kept(c: Candidate, kind: Kind, reason: String) -> Invariant {
    Invariant {
        name: c.name,
        kind,
        family: Family::Noether,
        value: Some(c.value),
        scale: Some(c.scale),
        exact: true,
        reason,
    }
}

/// Momenta in the space frame: of each set of coupled configurations the whole, or else its parts.
pub(super) fn of_space(x: &Inputs, passages: &[Passage]) -> Vec<Invariant> {
    let sets = components(x);
    let several = sets.len() > 1;
    let mut out = Vec::new();
    for set in &sets {
        let Some(&first) = set.first() else { continue };
        let group = x.spec.configurations[first].group;
        let alike = set.iter().all(|i| x.spec.configurations[*i].group == group);
        if !alike {
            continue;
        }
        let parts: Vec<Expr> = set.iter().map(|i| in_space(x, *i)).collect();
        let shape = parts[0].shape();
        let total = expr::sum(parts.clone(), shape);
        let scale = expr::sum(parts.iter().map(|p| length(x, p)), Shape::SCALAR);
        let suffix: String = if several {
            let names = set
                .iter()
                .map(|i| ascii(x, x.spec.configurations[*i].element));
            names.map(|n| format!("_{n}")).collect()
        } else {
            String::new()
        };
        let who = match group {
            Group::SpecialOrthogonal(_) | Group::UnitQuaternions => "rotations of space",
            Group::RigidMotions => "rigid motions of space",
            Group::GeneralLinear(_) => "linear maps of space",
        };
        if is_conserved(passages, &total) {
            let (kind, name) = match (set.as_slice(), x.spec.configurations.as_slice()) {
                ([only], [_]) => (Kind::SpatialMomentum(*only), "spatial_momentum".to_owned()),
                ([only], _) => (
                    Kind::TotalMomentum(vec![*only]),
                    format!("spatial_momentum{suffix}"),
                ),
                (all, _) => (
                    Kind::TotalMomentum(all.to_vec()),
                    format!("total_momentum{suffix}"),
                ),
            };
            let c = Candidate {
                name,
                value: total,
                scale,
            };
            out.push(kept(
                c,
                kind,
                format!("Noether: the action is invariant under {who}"),
            ));
            continue;
        }
        let stem = match set.as_slice() {
            [i] if x.spec.configurations[*i].side == Side::Spatial => "momentum",
            [_] => "spatial_momentum",
            _ => "total_momentum",
        };
        for mut c in about_axes(x, group, &total, &scale) {
            if is_conserved(passages, &c.value) {
                c.name = format!("{stem}{suffix}_{}", c.name);
                let reason = "Noether: the action is invariant under what keeps the axis in space";
                out.push(kept(c, Kind::Value, reason.to_owned()));
            }
        }
    }
    out
}

/// Momenta in body frames: of each configuration, whole or about an axis.
pub(super) fn of_bodies(x: &Inputs, passages: &[Passage]) -> Vec<Invariant> {
    let mut out = Vec::new();
    for (i, c) in x.spec.configurations.iter().enumerate() {
        let mu = in_body(x, i);
        let scale = length(x, &mu);
        let stem = match c.side {
            Side::Body => "momentum",
            Side::Spatial => "body_momentum",
        };
        let suffix = match x.spec.configurations.len() {
            1 => String::new(),
            _ => format!("_{}", ascii(x, c.element)),
        };
        let reason = "Noether: the action is invariant under motions of the body's own frame";
        if is_conserved(passages, &mu) {
            let c = Candidate {
                name: format!("body_momentum_whole{suffix}"),
                value: mu,
                scale,
            };
            out.push(kept(c, Kind::Value, reason.to_owned()));
            continue;
        }
        for mut c in about_axes(x, c.group, &mu, &scale) {
            if is_conserved(passages, &c.value) {
                c.name = format!("{stem}{suffix}_{}", c.name);
                let reason =
                    "Noether: the action is invariant under what keeps the axis in the body";
                out.push(kept(c, Kind::Value, reason.to_owned()));
            }
        }
    }
    out
}

/// Parts of a momentum, with the name of what singles them out.
fn about_axes(x: &Inputs, group: Group, m: &Expr, size: &Expr) -> Vec<Candidate> {
    let s = &x.letters.symbols;
    let n = match group {
        Group::SpecialOrthogonal(n) | Group::GeneralLinear(n) => n,
        Group::UnitQuaternions | Group::RigidMotions => Dim::Fixed(3),
    };
    let parameters = |shape: Shape| {
        let list = x.spec.parameters.iter().copied();
        list.filter(move |p| s.get(*p).shape == shape)
    };
    let mut axes: Vec<(String, Expr, Expr)> = Vec::new();
    let count = match n {
        Dim::Fixed(n) => n.min(8) as u8,
        Dim::Named(_) => 0,
    };
    for axis in 0..count {
        let name = format!("E{}", axis + 1);
        axes.push((name, expr::unit(n, axis), expr::integer(1)));
    }
    for p in parameters(Shape::vector(n)).take(AXES) {
        let v = expr::here(s, p);
        axes.push((ascii(x, p), v.clone(), length(x, &v)));
    }
    let square = |e: &Expr| expr::power(e.clone(), Rational::integer(2));
    let mut out = Vec::new();
    match group {
        Group::RigidMotions => {
            // The angular part is a sum of two that both grow with the distance of the body.
            let moved = x.spec.configurations.iter();
            let moved = moved.filter(|c| c.group == Group::RigidMotions);
            let lever = moved.map(|c| {
                let place = expr::column(s, &expr::here(s, c.element));
                length(x, &place)
            });
            let lever = expr::sum(lever, Shape::SCALAR);
            let moment = expr::mul(lever, length(x, &bracket::linear(s, m)));
            let with_lever = expr::add(size.clone(), moment);
            // Homogeneous vectors, planes and points, have a part in space.
            for p in parameters(Shape::vector(Dim::Fixed(4))).take(AXES) {
                let whole = expr::here(s, p);
                out.push(Candidate {
                    name: format!("moment_about_{}", ascii(x, p)),
                    value: homogeneous::moment(s, m, &whole),
                    scale: expr::mul(with_lever.clone(), length(x, &whole)),
                });
                let v = homogeneous::spatial_part(s, &whole);
                axes.push((ascii(x, p), v.clone(), length(x, &v)));
            }
            for (which, part, size) in [
                ("linear", bracket::linear(s, m), size),
                ("angular", bracket::angular(s, m), &with_lever),
            ] {
                out.push(Candidate {
                    name: which.to_owned(),
                    value: part.clone(),
                    scale: size.clone(),
                });
                for (name, v, long) in &axes {
                    out.push(Candidate {
                        name: format!("{which}_{name}"),
                        value: expr::dot(part.clone(), v.clone()),
                        scale: expr::mul(size.clone(), long.clone()),
                    });
                }
                // What is left when the part along an axis is not kept.
                for (name, v, long) in axes.iter().skip(usize::from(count)) {
                    out.push(Candidate {
                        name: format!("{which}_across_{name}"),
                        value: expr::cross(v.clone(), part.clone()),
                        scale: expr::mul(size.clone(), long.clone()),
                    });
                }
            }
        }
        Group::SpecialOrthogonal(Dim::Fixed(3)) | Group::UnitQuaternions => {
            for (name, v, long) in axes {
                out.push(Candidate {
                    name,
                    value: expr::dot(m.clone(), v),
                    scale: expr::mul(size.clone(), long),
                });
            }
        }
        // What keeps an axis a: |a|² m less its parts along a.
        Group::SpecialOrthogonal(_) => {
            for (name, v, long) in &axes {
                let row = expr::transpose(s, v.clone());
                let outer = expr::mul(v.clone(), row);
                let shape = m.shape();
                let value = expr::sum(
                    [
                        expr::mul(expr::dot(v.clone(), v.clone()), m.clone()),
                        expr::neg(expr::mul(outer.clone(), m.clone())),
                        expr::neg(expr::mul(m.clone(), outer)),
                    ],
                    shape,
                );
                out.push(Candidate {
                    name: name.clone(),
                    value,
                    scale: expr::mul(size.clone(), square(long)),
                });
            }
            // Planes that two axes span.
            for (i, (first, u, long)) in axes.iter().enumerate() {
                for (second, v, other) in &axes[i + 1..] {
                    out.push(Candidate {
                        name: format!("{first}_{second}"),
                        value: expr::dot(u.clone(), expr::mul(m.clone(), v.clone())),
                        scale: expr::product([size.clone(), long.clone(), other.clone()]),
                    });
                }
            }
        }
        // What keeps a quadratic form: for δQ = ζ Q with ζ^T P + P ζ = 0 the skew part of P⁻¹ m.
        Group::GeneralLinear(n) => {
            let mut forms = vec![("identity".to_owned(), expr::identity(n))];
            for p in parameters(Shape::square(n)).take(AXES) {
                if s.get(p).structure.is_symmetric() {
                    let e = expr::here(s, p);
                    forms.push((
                        format!("{}_inverse", ascii(x, p)),
                        expr::inverse(s, e.clone()),
                    ));
                    forms.push((ascii(x, p), e));
                }
            }
            for (name, p) in forms {
                for (side, product) in [
                    ("", expr::mul(p.clone(), m.clone())),
                    ("_right", expr::mul(m.clone(), p.clone())),
                ] {
                    if side == "_right" && name == "identity" {
                        continue;
                    }
                    out.push(Candidate {
                        name: format!("skew_{name}{side}"),
                        value: expr::part(Part::Skew, product),
                        scale: expr::mul(size.clone(), length(x, &p)),
                    });
                }
            }
        }
    }
    out
}

/// Whether a momentum is independent of those found, all read on the phase space.
pub(super) fn is_new(x: &Inputs, passages: &[Passage], found: &[Invariant], v: &Invariant) -> bool {
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
    // A number with one momentum in it, as a bracket `μ·a`.
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

/// Differentials of the entries of an invariant on the phase space: momenta, elements, and what is
/// carried without a definition.
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
    // Entry (i, j) is the pairing with a constant matrix: linear in it, so one derivative serves.
    let mut out = vec![vec![0; coordinates.len()]; rows * cols];
    let mut derivative: Option<(Letter, Expr)> = None;
    // The change of a letter is a letter of its shape: itself, at a label that nothing else has.
    let marker = |l: Letter| Letter {
        symbol: l.symbol,
        shift: Shift {
            time: 0,
            label: [1, 0],
        },
    };
    for (k, (l, t)) in coordinates.iter().enumerate() {
        let mark = marker(*l);
        if derivative.as_ref().is_none_or(|(of, _)| of != l) {
            let change = expr::letter(s, mark.symbol, mark.shift);
            derivative = Some((*l, expr::directional(s, &value, &[(*l, change)])));
        }
        let Some((_, d)) = &derivative else { continue };
        let mut p = point.clone();
        p.set(mark, t.clone());
        let moved = p.value(d)?;
        for (row, entry) in out.iter_mut().zip(&moved.data) {
            row[k] = *entry;
        }
    }
    Some(out)
}

/// Tangent directions at a letter's value that keep its structure, one for each coordinate.
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
    // A translation has no mirror image, a turn has.
    let turn = |i: usize, j: usize| unit(i, j, (j < 3).then(|| crate::algebra::exact::negate(1)));
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
