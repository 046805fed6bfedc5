//! The sign of the kinetic energy. Takes the quadratic form; gives the warnings that it does not depend on every
//! velocity, or is not positive for parameters as a user would give them. For given parameters, the emitted code
//! tests the state from which it starts.

use super::draw::{self, Draw};
use super::{Inputs, Topic, Warning, assumptions};
use crate::derive::kinetic;
use crate::derive::variation::at;
use crate::diagnostic::Diagnostic;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Shift};
use crate::interpret::{Assignment, evaluate};
use std::collections::BTreeSet;

/// The convention of signs, for every warning about a wrong sign.
const CONVENTION: &str = "the Lagrangian is kinetic minus potential energy: for a body with second moments J write \
    `-tr(J*Ω)/h`, which is +½ ω·Iω times the step with I = tr(J) Id - J; if you wrote another multiple of the action, give it \
    with `scale`";

/// The convention of signs for fields.
const OF_FIELDS: &str = "the Lagrangian is kinetic minus potential energy, times the step; if you wrote another multiple of \
    the action, give it with `scale`";

/// The warning that the kinetic energy does not depend on every velocity.
pub(super) fn degenerate(x: &Inputs) -> Option<Warning> {
    let kinetic = x.kinetic.filter(|k| !k.first_order)?;
    let (rank, n) = kinetic.degenerate()?;
    // With other configurations, a step may have a solution with velocities that the momenta do not determine.
    let is_alone = x.spec.configurations.len() == 1;
    let refused = match is_alone && x.solve.needs_second_moments() {
        true => {
            ". The Moser-Veselov equation then does not determine the velocity, and every choice of the parameters is rejected \
             at the start"
        }
        false => "",
    };
    let message = match rank {
        0 => "the Lagrangian has no kinetic energy: no term is quadratic in the velocities and \
              divided by `h`"
            .to_owned(),
        _ => format!(
            "the kinetic energy is degenerate: its Hessian in all velocities has rank {rank} of {n} for all parameters, so \
             momenta do not determine velocities and the energy is undefined{refused}"
        ),
    };
    let [kinetic, _] = x.examples();
    let fields = x.spec.has_only_fields();
    let help = match rank {
        0 => format!(
            "divide kinetic terms by the step once, as in `{kinetic}`; did you forget `/h`, or the factor `h` before the \
             square of a velocity that is already divided by the step?"
        ),
        _ if fields => "give every velocity a kinetic energy; did you forget `/h` in one of the terms, or write `/2*h` for `/(2*h)`?".to_owned(),
        _ if !is_alone => {
            "give every velocity a kinetic energy; did you forget `/h` in one of the terms, or write `/2*h` for `/(2*h)`? A body needs \
             second moments J with tr(J) Id - J > 0"
                .to_owned()
        }
        _ => {
            "give every velocity a kinetic energy; did you forget `/h` in one of the terms? A body needs I = tr(J) Id - J > 0, \
             and a point mass with J = m a a^T has no inertia about the line of a: declare `param S: Sym<3>`, its second \
             moments about its own centre, and write `m*a*a^T + S` for `m*a*a^T`, so that J has rank two or three; a \
             hundredth of m |a|^2 is enough"
                .to_owned()
        }
    };
    let d = Diagnostic::new(x.spec.lagrangian_place, message).help(help);
    Some(Warning::new(Topic::DegenerateKineticEnergy, d))
}

/// The number of parameter choices that are tried.
const DRAWS: u64 = 32;

/// The limit on nodes evaluated for one choice.
const EVALUATED: u64 = 10_000;

/// The warning that the kinetic energy is positive for none of the parameters that are tried.
pub(super) fn sign(x: &Inputs) -> Option<Warning> {
    let kinetic = x.kinetic?;
    match kinetic.rank? {
        (rank, n) if rank < n => return None,
        _ => {}
    }
    let gradients = kinetic::gradients(x.letters, &kinetic.energy);
    let s = &x.letters.symbols;
    let basis = kinetic::basis(x.spec, x.letters, &|n| draw::size(s, n));
    let cost: u64 = gradients.iter().map(|g| u64::from(g.size())).sum();
    if cost.saturating_mul(basis.len() as u64) > EVALUATED {
        return None;
    }
    let joining = joining(x, &gradients);
    let (mut tried, mut negative) = (0, true);
    for seed in 0..DRAWS {
        let Some(values) = draw_state(x, &kinetic.energy, &joining, seed) else {
            continue;
        };
        let Some(matrix) = hessian(x, &gradients, &values) else {
            continue;
        };
        if is_positive_definite(&matrix) {
            return None;
        }
        let opposite: Vec<Vec<f64>> = matrix
            .iter()
            .map(|row| row.iter().map(|v| -v).collect())
            .collect();
        negative &= is_positive_definite(&opposite);
        tried += 1;
    }
    if tried == 0 {
        return None;
    }
    let how = if negative { "negative" } else { "not positive" };
    let d = Diagnostic::new(
        x.spec.lagrangian_place,
        format!(
            "the kinetic energy, {}, is {how} definite for all of {tried} random choices of positive numbers and positive \
             definite matrices as parameters",
            x.text(&kinetic.energy)
        ),
    )
    .help(match x.spec.has_only_fields() {
        true => OF_FIELDS,
        false => CONVENTION,
    });
    Some(Warning::new(Topic::SignOfKineticEnergy, d))
}

/// Parameters that occur only in products of different velocities: if they are small enough, they do not change the
/// sign.
fn joining(x: &Inputs, gradients: &[Expr]) -> BTreeSet<SymbolId> {
    let s = &x.letters.symbols;
    let all = &x.letters.variation;
    let alone = gradients.iter().zip(all).map(|(gradient, own)| {
        let others = all.iter().filter(|xi| *xi != own);
        let none: Vec<_> = others
            .map(|xi| (at(*xi, Shift::HERE), expr::zero(s.get(*xi).shape)))
            .collect();
        expr::substitute(s, gradient, &none)
    });
    let of = |e: &Expr| expr::letters(e).into_iter().map(|l| l.symbol);
    let alone: BTreeSet<SymbolId> = alone.flat_map(|e| of(&e).collect::<Vec<_>>()).collect();
    let can_be_small = |id: &SymbolId| {
        let symbol = s.get(*id);
        let fixed = matches!(
            symbol.structure,
            Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion
        );
        symbol.role == Role::Parameter && !fixed && !alone.contains(id)
    };
    gradients.iter().flat_map(of).filter(can_be_small).collect()
}

/// Values for the letters of the form; the assumptions admit the parameters among them.
fn draw_state(
    x: &Inputs,
    energy: &Expr,
    joining: &BTreeSet<SymbolId>,
    seed: u64,
) -> Option<Assignment> {
    let s = &x.letters.symbols;
    let mut source = Draw::new(seed);
    let mut values = draw::nothing(s);
    // Coupling terms are small at some of the points.
    let scale = [1.0, 0.1, 0.01, 0.001][(seed % 4) as usize];
    let joined = [1.0, 0.1, 0.01, 0.001][(seed / 4 % 4) as usize];
    let mut letters: Vec<_> = expr::letters(energy).iter().map(|l| l.symbol).collect();
    letters.extend(x.spec.parameters.iter().copied());
    letters.sort();
    letters.dedup();
    for id in letters {
        if s.get(id).role == Role::Variation {
            continue;
        }
        let symbol = s.get(id);
        let mut data = draw::natural(s, id, scale, &mut source);
        if joining.contains(&id) {
            data.iter_mut().for_each(|v| *v *= joined);
        }
        let (rows, cols) = (
            draw::size(s, symbol.shape.rows),
            draw::size(s, symbol.shape.cols),
        );
        values.set(&symbol.name, 0, rows, cols, &data);
    }
    assumptions::admitted(x, values)
}

/// The matrix of the form: each column is the gradient at a basis element.
fn hessian(x: &Inputs, gradients: &[Expr], values: &Assignment) -> Option<Vec<Vec<f64>>> {
    let s = &x.letters.symbols;
    let basis = kinetic::basis(x.spec, x.letters, &|n| draw::size(s, n));
    let mut values = values.clone();
    let element = |id, e: &[(usize, usize, i64)]| {
        let shape = s.get(id).shape;
        let (rows, cols) = (draw::size(s, shape.rows), draw::size(s, shape.cols));
        let mut data = vec![0.0; rows * cols];
        for (i, j, v) in e {
            data[i * cols + j] = *v as f64;
        }
        (rows, cols, data)
    };
    let mut columns = Vec::with_capacity(basis.len());
    for (letter, e) in &basis {
        for xi in &x.letters.variation {
            let (rows, cols, data) = element(*xi, &[]);
            values.set(&s.get(*xi).name, 0, rows, cols, &data);
        }
        let (rows, cols, data) = element(letter.symbol, e);
        values.set(&s.get(letter.symbol).name, 0, rows, cols, &data);
        let parts: Vec<_> = gradients
            .iter()
            .map(|g| evaluate(s, g, &values).ok())
            .collect::<Option<_>>()?;
        let along = basis.iter().map(|(other, f)| {
            let i = x
                .letters
                .variation
                .iter()
                .position(|v| at(*v, Shift::HERE) == *other);
            let part = i.and_then(|i| parts.get(i));
            let entries = f.iter();
            part.map_or(0.0, |m| {
                entries.map(|(r, c, v)| m.get(*r, *c) * *v as f64).sum()
            })
        });
        columns.push(along.collect::<Vec<f64>>());
    }
    let finite = columns.iter().flatten().all(|v| v.is_finite());
    finite.then_some(columns)
}

/// Cholesky's elimination: all pivots are positive, to the rounding of the diagonal.
fn is_positive_definite(matrix: &[Vec<f64>]) -> bool {
    let n = matrix.len();
    let mut a = matrix.to_vec();
    for k in 0..n {
        let size = matrix[k][k].abs();
        if a[k][k] <= 1e-12 * size || a[k][k] <= 0.0 {
            return false;
        }
        let pivot = a[k].clone();
        for row in &mut a[k + 1..] {
            let f = row[k] / pivot[k];
            for (x, p) in row.iter_mut().zip(&pivot).skip(k) {
                *x -= f * p;
            }
        }
    }
    true
}
