//! Moves a start that was typed with eight digits onto its constraints. Takes the numbers of a node; gives the nearest
//! configuration that satisfies the constraints to rounding, and its distance.

use crate::displacement::{Frame, Velocity, moved};
use crate::group::Group;
use crate::holds::{Rate, gradients, is_long};
use crate::judge::LEFT_OF_WHAT_IS_HELD;
use crate::matrix::Matrix;
use crate::number::{Number, UNIT, larger};
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::{Moving, all_moving, varied};
use crate::stated::{Role, Side, Stated};

/// The largest residual of a constraint, relative to its terms, that is corrected. A larger residual is a mistake,
/// which the model reports. The model accepts 1e-9 of a larger measure: it adds to the terms their change with each
/// variable, as many times the terms as the constraint has degrees. Every start that the model accepts is corrected.
const NEAR: f64 = 1e-8;

/// The largest number of corrections. Each correction squares the residual.
const CORRECTIONS: usize = 4;

/// The largest number of iterations for one correction.
const ITERATIONS: usize = 4000;

/// A start that was moved.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectedStart {
    /// The numbers of the node.
    pub node: Vec<f64>,
    /// The constraint with the largest residual.
    pub name: String,
    /// Its residual before the move.
    pub off: f64,
    /// The largest change of a number.
    pub by: f64,
}

/// Moves a start onto its constraints. Returns nothing if it satisfies them to rounding, or if it is too far from them.
///
/// # Errors
/// Why the statement cannot be evaluated.
pub fn onto_constraints(
    stated: &Stated,
    setup: &Setup,
    node: &[f64],
) -> Result<Option<ProjectedStart>, String> {
    let mut holds = stated.holds.iter();
    if stated.holds.is_empty() || holds.any(|h| h.of_sums && is_long(stated, setup, h)) {
        return Ok(None);
    }
    let moving = all_moving(stated, setup);
    let start = rates(stated, setup, node, &moving)?;
    let worst = start.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    let Some(worst) = worst.filter(|worst| ratio(worst) > 1.0) else {
        return Ok(None);
    };
    // If a residual is NaN, the start is not near.
    let is_near = |rate: &Rate| rate.value.abs() <= NEAR * rate.error / UNIT;
    if !start.iter().all(is_near) {
        return Ok(None);
    }
    let count = moving.iter().map(|m| 2 * m.components).sum();
    let (mut at, mut left) = (node.to_vec(), most(&start));
    let mut rates_here = start.clone();
    for _ in 0..CORRECTIONS {
        let change = correction(&rates_here, count);
        let next = changed(stated, setup, &moving, &at, &change).ok_or("sizes do not match")?;
        let rates_next = rates(stated, setup, &next, &moving)?;
        let left_next = most(&rates_next);
        // Stop when only rounding is left.
        if left_next >= left || left_next.is_nan() {
            break;
        }
        (at, left, rates_here) = (next, left_next, rates_next);
    }
    let by = at
        .iter()
        .zip(node)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, larger);
    Ok((left <= 1.0).then(|| ProjectedStart {
        node: at,
        name: worst.name.clone(),
        off: worst.value.abs(),
        by,
    }))
}

/// The residual of a constraint, in units of the residual that rounding explains.
fn ratio(rate: &Rate) -> f64 {
    match rate.value == 0.0 {
        true => 0.0,
        false => rate.value.abs() / (LEFT_OF_WHAT_IS_HELD * rate.error),
    }
}

fn most(all: &[Rate]) -> f64 {
    all.iter().map(ratio).fold(0.0, larger)
}

fn rates(
    stated: &Stated,
    setup: &Setup,
    node: &[f64],
    moving: &[Moving<'_>],
) -> Result<Vec<Rate>, String> {
    let by = varied(moving);
    let scene = Scene::new(stated, setup, [node, node], &by);
    let mut all = gradients(&scene, stated, setup, moving)?;
    all.retain(|rate| !rate.slopes.is_empty());
    Ok(all)
}

/// The smallest change of all variables that removes the residuals, by conjugate gradients.
fn correction(rates: &[Rate], count: usize) -> Vec<f64> {
    let spread = |weights: &[f64]| {
        let mut out = vec![0.0; count];
        for (rate, weight) in rates.iter().zip(weights) {
            for (of, slope) in &rate.slopes {
                if let Some(x) = out.get_mut(*of) {
                    *x += slope * weight;
                }
            }
        }
        out
    };
    let gathered = |change: &[f64]| -> Vec<f64> {
        let of = |rate: &Rate| {
            let each = rate.slopes.iter();
            each.map(|(of, slope)| slope * change.get(*of).copied().unwrap_or(0.0))
                .sum()
        };
        rates.iter().map(of).collect()
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let mut weights = vec![0.0; rates.len()];
    let mut left: Vec<f64> = rates.iter().map(|rate| -rate.value).collect();
    let mut along = left.clone();
    let mut size = dot(&left, &left);
    let end = 1e-20 * size;
    for _ in 0..ITERATIONS.min(2 * rates.len() + 8) {
        let through = gathered(&spread(&along));
        let curvature = dot(&along, &through);
        if !(curvature > 0.0 && size > end) {
            break;
        }
        let step = size / curvature;
        for (w, d) in weights.iter_mut().zip(&along) {
            *w += step * d;
        }
        for (l, t) in left.iter_mut().zip(&through) {
            *l -= step * t;
        }
        let next = dot(&left, &left);
        for (d, l) in along.iter_mut().zip(&left) {
            *d = l + next / size * *d;
        }
        size = next;
    }
    spread(&weights)
}

/// The numbers of a node after a change of its variables.
fn changed(
    stated: &Stated,
    setup: &Setup,
    moving: &[Moving<'_>],
    node: &[f64],
    change: &[f64],
) -> Option<Vec<f64>> {
    let mut out = node.to_vec();
    for m in moving {
        let role = &stated.quantities.get(m.name)?.role;
        let own = setup.observed(m.name, m.site)?;
        let first = usize::try_from(m.first).ok()?;
        let components = change.get(first..first + m.components)?;
        if components.iter().all(|x| *x == 0.0) {
            continue;
        }
        let numbers = own.of(node);
        let velocity = velocity(role, numbers, components)?;
        let next = moved(role, numbers, &velocity, 1.0)?;
        let place = out.get_mut(own.from..own.from + next.len())?;
        place.copy_from_slice(&next);
    }
    Some(out)
}

/// A variation as a velocity over unit time.
fn velocity(role: &Role, numbers: &[f64], components: &[f64]) -> Option<Velocity> {
    let (group, side) = match role {
        Role::Element(group, side) => (*group, *side),
        _ => {
            return Some(Velocity {
                turning: None,
                moving: Some(components.to_vec()),
            });
        }
    };
    let frame = match side {
        Side::Body => Frame::Body,
        Side::Space => Frame::Space,
    };
    let turning = |count: usize| Some((components.get(..count)?.to_vec(), frame));
    match group {
        Group::Rotation(_) | Group::Quaternion => Some(Velocity {
            turning: turning(components.len()),
            moving: None,
        }),
        Group::Motion(n) => {
            let rate = rate(group, side, numbers, components)?;
            Some(Velocity {
                turning: turning(components.len().checked_sub(n)?),
                moving: Some((0..n).map(|i| rate.at(i, n).value).collect()),
            })
        }
        Group::Linear(n) => {
            let rate = rate(group, side, numbers, components)?;
            Some(Velocity {
                turning: None,
                moving: Some((0..n * n).map(|k| rate.at(k / n, k % n).value).collect()),
            })
        }
    }
}

/// The rate of change of a matrix.
fn rate(group: Group, side: Side, numbers: &[f64], components: &[f64]) -> Option<Matrix> {
    let n = group.rows();
    let mut generator = vec![0.0; n * n];
    for (entries, rate) in group.basis().iter().zip(components) {
        for (i, j, c) in entries {
            *generator.get_mut(i * n + j)? += rate * c;
        }
    }
    let generator = Matrix::from_entries(n, n, |i, j| {
        Number::exact(generator.get(i * n + j).copied().unwrap_or(f64::NAN))
    });
    let element = group.element(side, numbers, 0.0)?;
    match side {
        Side::Body => element.times(&generator),
        Side::Space => generator.times(&element),
    }
}
