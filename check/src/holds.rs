//! Constraints: they vanish at both nodes, and their forces act along their gradients. Takes the residuals of the
//! momenta at a node; gives the part that no multipliers explain.

use crate::evaluate::Here;
use crate::judge::Part;
use crate::number::{UNIT, larger};
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::{Moving, indices};
use crate::stated::{Hold, Stated};
use crate::terms::TermTime;
use crate::value::Value;

/// If a constraint sums over more sites than this, the sum is not evaluated. Its gradients at the judged sites come
/// from single terms.
const SUMMED: usize = 4096;

/// The smallest unit of an equation, relative to the largest unit.
const LEAST_UNIT: f64 = 1e-60;

/// The gradient of one component of a constraint at one node, by variables of the step.
pub struct Gradient(Vec<(usize, f64, f64)>);

/// All components of constraints at a node: the residual and the gradient of each.
///
/// # Errors
/// One cannot be evaluated.
pub fn held(
    scene: &Scene<'_>,
    stated: &Stated,
    setup: &Setup,
    moving: &[Moving<'_>],
    node: usize,
) -> Result<(Vec<Part>, Vec<Gradient>), String> {
    let (mut parts, mut gradients) = (Vec::new(), Vec::new());
    for hold in &stated.holds {
        let own = parts.len();
        for (index, value) in values(scene, stated, setup, (hold, moving), node)? {
            let Value::Known(m) = value else {
                return Err(format!("the constraint `{}` has no size", hold.name));
            };
            for x in m.entries.iter() {
                let slopes = x
                    .slopes
                    .iter()
                    .filter_map(|s| Some((usize::try_from(s.of).ok()?, s.value, s.error)));
                let gradient: Vec<_> = slopes.collect();
                // A constraint without varied quantities needs no multiplier.
                if gradient.is_empty() {
                    continue;
                }
                gradients.push(Gradient(gradient));
                if x.error.is_finite() && !(hold.of_sums && is_long(stated, setup, hold)) {
                    parts.push(Part::held(&hold.name, index, node, x));
                }
            }
        }
        // The solver finds all multipliers of a chain together. Every site gets the bound of the judged site with the
        // largest rounding.
        let most = parts
            .iter()
            .skip(own)
            .map(|p: &Part| p.bound)
            .fold(0.0, larger);
        parts.iter_mut().skip(own).for_each(|p| p.bound = most);
    }
    Ok((parts, gradients))
}

/// The gradient of one component of a constraint by the variables of a node.
#[derive(Clone, Debug)]
pub struct Rate {
    /// The name of the constraint.
    pub name: String,
    /// The index along a label, of one that is counted.
    pub site: Option<usize>,
    /// The residual of the constraint.
    pub value: f64,
    /// A bound on the error of the residual.
    pub error: f64,
    /// Variables and derivatives.
    pub slopes: Vec<(usize, f64)>,
}

/// The gradients of all components of constraints at the first node.
///
/// # Errors
/// One cannot be evaluated.
pub fn gradients(
    scene: &Scene<'_>,
    stated: &Stated,
    setup: &Setup,
    moving: &[Moving<'_>],
) -> Result<Vec<Rate>, String> {
    let mut out = Vec::new();
    for hold in &stated.holds {
        for (index, value) in values(scene, stated, setup, (hold, moving), 0)? {
            let Value::Known(m) = value else {
                return Err(format!("the constraint `{}` has no size", hold.name));
            };
            let site = index.and_then(|i| usize::try_from(i).ok());
            for x in m.entries.iter() {
                let slopes = x.slopes.iter();
                let gradient = slopes.filter_map(|s| Some((usize::try_from(s.of).ok()?, s.value)));
                out.push(Rate {
                    name: hold.name.clone(),
                    site,
                    value: x.value,
                    error: x.error,
                    slopes: gradient.collect(),
                });
            }
        }
    }
    Ok(out)
}

/// Whether a constraint sums over more sites than are summed.
pub fn is_long(stated: &Stated, setup: &Setup, hold: &Hold) -> bool {
    let count = hold
        .value
        .label
        .map_or(0, |l| setup.counts.get(l).copied().unwrap_or(0));
    stated.line.is_some() && count > SUMMED
}

type Indexed = Vec<(Option<i64>, Value)>;

fn values(
    scene: &Scene<'_>,
    stated: &Stated,
    setup: &Setup,
    (hold, moving): (&Hold, &[Moving<'_>]),
    node: usize,
) -> Result<Indexed, String> {
    let time = i32::try_from(node).unwrap_or(1);
    let level = match hold.value.lives {
        TermTime::Node(level) => level,
        _ => 0,
    };
    let at = |index: i64| Here::at(index).later(time - level);
    let term = &hold.value;
    if hold.of_sums {
        let long = is_long(stated, setup, hold);
        let over = long.then(|| indices(stated, setup, term, moving));
        let value = scene.value_with_sums(&term.value, at(0), over)?;
        return Ok(vec![(None, value)]);
    }
    let all = indices(stated, setup, term, moving).into_iter();
    all.map(|i| {
        Ok((
            Some(i).filter(|_| term.label.is_some()),
            scene.value(&term.value, at(i))?,
        ))
    })
    .collect()
}

/// Removes from the residuals of a node the part that multipliers explain, by a projection in units of the bounds. The
/// projection also gives the new bounds.
pub fn without_reactions(residuals: &mut [Part], variables: &[usize], gradients: &[Gradient]) {
    // An equation without terms has zero rounding. Its unit is small relative to the others, but its square does not
    // underflow.
    let most = residuals.iter().map(|r| r.bound).fold(0.0, larger);
    let least = if most > 0.0 { LEAST_UNIT * most } else { 1.0 };
    let unit: Vec<f64> = residuals.iter().map(|r| r.bound.max(least)).collect();
    let mut frame: Vec<Vec<f64>> = Vec::new();
    let place = |of: usize| variables.iter().position(|v| *v == of);
    let mut columns: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for Gradient(slopes) in gradients {
        let (mut column, mut wrong) = (vec![0.0; unit.len()], vec![0.0; unit.len()]);
        for (of, value, error) in slopes {
            if let Some(i) = place(*of) {
                (column[i], wrong[i]) = (value / unit[i], *error);
            }
        }
        columns.push((column, wrong));
    }
    for (column, _) in &columns {
        let mut direction = column.clone();
        let before = length(&direction);
        take_away(&frame, &mut direction);
        let left = length(&direction);
        if left > 1e-9 * before && left > 0.0 {
            direction.iter_mut().for_each(|x| *x /= left);
            frame.push(direction);
        }
    }
    let mut scaled: Vec<f64> = residuals
        .iter()
        .zip(&unit)
        .map(|(r, u)| r.residual / u)
        .collect();
    // The sizes of multipliers, for the errors of gradients.
    let reaction: Vec<f64> = columns
        .iter()
        .map(|(c, _)| {
            let size = dot(c, c);
            if size > 0.0 {
                dot(c, &scaled).abs() / size
            } else {
                0.0
            }
        })
        .collect();
    let before = length(&scaled);
    take_away(&frame, &mut scaled);
    for (i, part) in residuals.iter_mut().enumerate() {
        let overlap = |j: usize| -> f64 { frame.iter().map(|f| f[i] * f[j]).sum() };
        let spread: f64 = (0..unit.len())
            .map(|j| (f64::from(u8::from(i == j)) - overlap(j)).abs())
            .sum();
        let of_gradients: f64 = columns
            .iter()
            .zip(&reaction)
            .map(|((_, w), size)| w[i] * size)
            .sum();
        part.residual = scaled[i] * unit[i];
        part.bound = unit[i] * (spread.max(1.0) + 16.0 * UNIT * before) + of_gradients;
    }
}

/// Subtracts from `x` its components along orthonormal directions. It does so twice, since the first pass leaves
/// rounding errors.
fn take_away(frame: &[Vec<f64>], x: &mut [f64]) {
    for _ in 0..2 {
        for known in frame {
            let along = dot(known, x);
            x.iter_mut().zip(known).for_each(|(x, y)| *x -= along * y);
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn length(a: &[f64]) -> f64 {
    let most = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    match most > 0.0 && most.is_finite() {
        true => {
            most * a
                .iter()
                .map(|x| (x / most) * (x / most))
                .sum::<f64>()
                .sqrt()
        }
        false => 0.0,
    }
}
