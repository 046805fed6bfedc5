//! The quantities that are held fixed in a search for equilibria. Takes the option `--fix` and the start; gives
//! components of invariants, and initial values.

use crate::derivatives::coordinates::{self, turns};
use crate::derivatives::flow::{Steps, matrix};
use crate::derivatives::problem::Problem;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch::card::{Card, Conserved};
use clebsch::nalgebra::DVector;
use clebsch_analysis::Flow;

/// A fixed quantity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fixed {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub place: Place,
}

/// Where a fixed quantity is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A component of the invariants.
    Invariant(usize),
    /// A local coordinate that is an entry of an initial value.
    Coordinate(usize),
}

/// The fixed quantities that are not proved invariants. A critical point at these need not be a steady motion.
pub(crate) fn unproved<'a>(card: &Card, fixed: &'a [Fixed]) -> Vec<&'a str> {
    let exact: Vec<bool> = components(card).map(|(_, _, exact)| exact).collect();
    let is_proved = |own: &&Fixed| match own.place {
        Place::Invariant(at) => exact.get(at) == Some(&true),
        Place::Coordinate(_) => false,
    };
    let others = fixed.iter().filter(|own| !is_proved(own));
    others.map(|own| own.name.as_str()).collect()
}

/// A value counts as zero below this part of the largest one.
const ZERO: f64 = 1e-12;

/// The component of the invariants that is the energy.
pub(crate) fn energy(card: &Card) -> Option<usize> {
    components(card).position(|(name, _, _)| name == "energy")
}

/// Each component of the invariants: the name of the invariant, its component, and whether it is conserved exactly.
fn components(card: &Card) -> impl Iterator<Item = (&'static str, String, bool)> {
    card.invariants.iter().flat_map(|own| {
        (1..=own.rows).map(|i| {
            let name = match own.rows {
                1 => own.name.to_owned(),
                _ => format!("{}.{i}", own.name),
            };
            (own.name, name, own.conserved == Conserved::Exactly)
        })
    })
}

/// The quantities that `--fix` names. `values` are the invariants at the start.
///
/// # Errors
/// Usage: a name is not known.
pub(crate) fn fixed(
    problem: &Problem,
    steps: &Steps,
    option: Option<&str>,
    values: &[f64],
    dimensions: &[usize],
) -> Result<Vec<Fixed>, Failure> {
    let card = &problem.card;
    let all: Vec<(&str, String, bool)> = components(card).collect();
    let choose = |is: &dyn Fn(usize, &str, bool) -> bool| -> Vec<Fixed> {
        let own = all.iter().enumerate();
        let own = own.filter(|(i, (name, _, exact))| is(*i, name, *exact) && *name != "energy");
        let fixed = own.map(|(i, (_, name, _))| Fixed {
            name: name.clone(),
            place: Place::Invariant(i),
        });
        fixed.collect()
    };
    let largest = clebsch::scalar::largest(values.iter().map(|x| x.abs()));
    let is_zero = |i: usize| {
        values
            .get(i)
            .is_none_or(|x| x.abs() <= ZERO * largest.max(1.0))
    };
    let Some(option) = option else {
        // All components of an invariant, if one is not zero.
        let moves = |name: &str| {
            let mut own = all.iter().enumerate();
            own.any(|(i, (whole, ..))| *whole == name && !is_zero(i))
        };
        let candidates = choose(&|_, name, exact| exact && moves(name));
        return Ok(independent(steps, candidates, energy(card)));
    };
    match option.trim() {
        "none" => return Ok(Vec::new()),
        "all" => return Ok(choose(&|_, _, exact| exact)),
        _ => {}
    }
    let mut found = Vec::new();
    let locals = coordinates::local(card, dimensions);
    let moves = card.initial.iter().zip(dimensions);
    let plain: Vec<bool> = moves
        .flat_map(|(field, count)| std::iter::repeat_n(!turns(field), *count))
        .collect();
    for name in option.split(',').map(str::trim) {
        let own = choose(&|i, whole, _| {
            whole == name || all.get(i).is_some_and(|(_, own, _)| own == name)
        });
        let coordinate = locals.iter().position(|own| own == name);
        let coordinate = coordinate.filter(|at| plain.get(*at) == Some(&true));
        match (own.is_empty(), coordinate) {
            (false, _) => found.extend(own),
            (true, Some(at)) => found.push(Fixed {
                name: name.to_owned(),
                place: Place::Coordinate(at),
            }),
            (true, None) => {
                let names = card.invariants.iter().map(|own| own.name);
                let names = names.filter(|name| *name != "energy");
                let plain = locals.iter().zip(&plain).filter(|(_, plain)| **plain);
                let names = names.chain(plain.map(|(name, _)| name.as_str()));
                return Err(Failure::Usage(format!(
                    "--fix {}: there is no such invariant or initial value{}",
                    shown(name),
                    did_you_mean(name, names.chain(["none", "all"]))
                )));
            }
        }
    }
    Ok(found)
}

/// The size of the displacement to a state without special properties.
const NEARBY: f64 = 0.1;

/// A gradient within this part of itself of the span of others depends on them.
const DEPENDENT: f64 = 1e-8;

/// The quantities whose gradients are independent of those before them, and do not have the gradient of the energy in
/// their span. With such a quantity, every state would be a critical point.
fn independent(steps: &Steps, candidates: Vec<Fixed>, energy: Option<usize>) -> Vec<Fixed> {
    let by = |i: usize| NEARBY * (1.0 + 1.618 * (i + 1) as f64).sin();
    let by: Vec<f64> = (0..steps.dimension()).map(by).collect();
    let near = steps.moved(&steps.start(), &by);
    let Ok(slopes) = near.and_then(|near| steps.with(|own| own.conserved(&near))) else {
        return candidates;
    };
    let slopes = matrix(&slopes);
    let row = |at: usize| -> Option<DVector<f64>> {
        (at < slopes.nrows()).then(|| slopes.row(at).transpose())
    };
    let energy = energy.and_then(row);
    let size = slopes.amax().max(f64::MIN_POSITIVE);
    // An orthonormal basis of the gradients.
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut kept = Vec::new();
    for own in candidates {
        let Place::Invariant(at) = own.place else {
            continue;
        };
        let Some(gradient) = row(at) else { continue };
        let rest = outside(&basis, &gradient);
        if rest.norm() <= DEPENDENT * size {
            continue;
        }
        basis.push(rest.normalize());
        let spans = energy
            .as_ref()
            .is_some_and(|energy| outside(&basis, energy).norm() <= DEPENDENT * energy.norm());
        match spans {
            true => drop(basis.pop()),
            false => kept.push(own),
        }
    }
    kept
}

/// The part of a vector orthogonal to a basis.
fn outside(basis: &[DVector<f64>], of: &DVector<f64>) -> DVector<f64> {
    let mut rest = of.clone();
    // The second pass removes rounding of the first.
    for _ in 0..2 {
        for own in basis {
            rest.axpy(-own.dot(&rest), own, 1.0);
        }
    }
    rest
}
