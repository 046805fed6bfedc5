//! Derivatives in entries beside the diagonal of a symmetric matrix. Takes a gradient; puts these derivatives into it.

use super::Observed;
use crate::derivatives::expression::Expression;
use crate::derivatives::problem::Problem;
use crate::terminal::failure::Failure;
use clebsch::card::Kind;
use clebsch::derivatives::Gradient;
use clebsch::scalar::largest;

/// The size of entries beside the diagonal where derivatives in them are taken, relative to the matrix.
pub(super) const NEARBY: f64 = 1e-9;

/// Smaller differences of derivatives, relative to the largest one, are rounding or of second order.
const NONE: f64 = 1e-6;

/// Steps of bodies in their principal axes do not read the entries beside the diagonal of the moments, so that recorded
/// steps miss derivatives in them. Puts the derivatives of a body with small entries in their place; gives whether
/// there are any.
pub(super) fn off_diagonal(
    problem: &Problem,
    of: &Expression,
    sum: bool,
    found: &mut Gradient,
) -> Result<bool, Failure> {
    let mut case = problem.plan.case.clone();
    let mut entries: Vec<(usize, usize)> = Vec::new();
    let fields = problem.card.parameters.iter().zip(&mut case.parameters);
    for (field, (own, values)) in fields.enumerate() {
        if !matches!(own.kind, Kind::Symmetric | Kind::SecondMoments) {
            continue;
        }
        let size = largest(values.iter().map(|x| x.abs()));
        for (at, value) in values.iter_mut().enumerate() {
            let is_beside = at / own.cols != at % own.cols;
            if is_beside && *value == 0.0 {
                *value = NEARBY * size;
                entries.push((field, at));
            }
        }
    }
    if entries.is_empty() {
        return Ok(false);
    }
    let steps = problem.plan.case.steps;
    let mut cost = Observed {
        of,
        last: steps,
        sum,
        value: 0.0,
    };
    let nearby = problem
        .open_case(&case)
        .and_then(|mut flow| flow.gradient(steps, &mut cost))
        .map_err(|why| problem.refused(&why))?;
    let all = || nearby.parameters.iter().chain(&nearby.initial).flatten();
    let size = largest(all().map(|x| x.abs()));
    let mut any = false;
    for (field, at) in entries {
        let slope = nearby.parameters.get(field).and_then(|own| own.get(at));
        let place = found
            .parameters
            .get_mut(field)
            .and_then(|own| own.get_mut(at));
        if let (Some(slope), Some(place)) = (slope, place)
            && (slope - *place).abs() > NONE * size
        {
            *place = *slope;
            any = true;
        }
    }
    Ok(any)
}
