//! Proofs that serve for later steps: within which lengths of rest every solution is the principal
//! root.
//! Takes the equations and the beginning of the curve; gives the lengths.

use super::curve::Curve;
use super::principal::Found;
use super::region::Strain;
use super::stage::{Stage, fits};
use crate::solvers::newton::lasting::{NEARBY, TIMES};
use crate::solvers::newton::node::Spread;

/// Looks for a reach of at least `wanted`: the largest where it serves at every node.
pub(super) fn lasting(
    curve: &dyn Curve,
    rest: &Stage,
    wanted: &[f64],
    everywhere: bool,
) -> Option<Found> {
    let centre = curve.rest();
    let strain = |radii: &[f64]| {
        let tangent = curve.enclosed(Spread::HERE, centre, radii);
        Strain::over(curve.parts(), rest.inverse(), &tangent)
    };
    let reach = match everywhere {
        true => everywhere_alike(&strain, wanted),
        false => nearby(&strain, wanted),
    };
    Some(Found::Principal {
        reach: reach?,
        spread: Spread::TURNED,
    })
}

fn times_all(x: &[f64], times: f64) -> Vec<f64> {
    x.iter().map(|x| times * x).collect()
}

/// The largest reach, where the tangent is the same at every node.
fn everywhere_alike(strain: &dyn Fn(&[f64]) -> Strain, wanted: &[f64]) -> Option<Vec<f64>> {
    let mut best: Option<Vec<f64>> = None;
    for times in TIMES {
        let radii = times_all(wanted, times);
        let whole = strain(&radii);
        let half = strain(&times_all(&radii, 0.5));
        // Regular in the whole region: also where the velocity does not come.
        let away = whole.spread(&radii).map(|_| &whole);
        let next = away.and_then(|whole| reach(&whole.mean(&half), Some(whole), &radii));
        // Larger as long as the reach grows.
        let worse = match (&next, &best) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(n), Some(b)) => b[0] >= n[0],
        };
        if worse && best.as_ref().is_some_and(|reach| fits(wanted, reach)) {
            break;
        }
        best = if worse { best } else { next };
    }
    best.filter(|reach| fits(wanted, reach))
}

/// A reach where the tangent is another at every node.
fn nearby(strain: &dyn Fn(&[f64]) -> Strain, wanted: &[f64]) -> Option<Vec<f64>> {
    NEARBY.iter().find_map(|times| {
        let radii = times_all(wanted, *times);
        let whole = strain(&radii);
        // Regular in the whole region: also where the velocity does not come.
        whole.spread(&radii)?;
        let within = |mean: &Strain| {
            let reach = reach(mean, None, &radii);
            reach.filter(|reach| fits(wanted, reach))
        };
        // The mean along lines does not exceed the strain of the whole region, which is known by now.
        within(&whole).or_else(|| within(&whole.mean(&strain(&times_all(&radii, 0.5)))))
    })
}

/// Within which lengths of rest a solution `c` is the principal root, given the mean strain `e` along
/// lines from rest. With `x = B (T(c) - T(0))` the curve to it, seen from rest, is no longer than
/// `τ (1 - e)^-1 |x|`, and `|x|` does not exceed `(1 + e) |c|`: it stays in the region if that does
/// not exceed the radii.
///
/// Given the strain `back` between any two places as well, it is also no farther from `c` than
/// `(1 - τ) (1 - back)^-1 |x|`: no farther from rest than the smaller of the first and of `|c|` with
/// the second, which is largest where both are the same. A region that serves at other nodes keeps
/// the margin that this would take.
fn reach(mean: &Strain, back: Option<&Strain>, radii: &[f64]) -> Option<Vec<f64>> {
    let pulled = mean.pull(radii);
    let away = mean.spread(&pulled)?;
    let back = match back {
        Some(strain) => strain.spread(&pulled)?.into_iter().map(Some).collect(),
        None => vec![None; radii.len()],
    };
    let triples = radii.iter().zip(away).zip(back);
    let share = triples.fold(1.0, |least: f64, ((r, away), back)| {
        let farthest = match back {
            Some(back) => away * (r + back) / (away + back),
            None => away,
        };
        least.min(r / farthest)
    });
    (share > 0.0).then(|| radii.iter().map(|r| share * r).collect())
}
