//! Proofs that serve for later steps: within which lengths of rest every solution is the principal
//! root.
//! Takes the equations and the beginning of the curve; gives the lengths.

use super::bounds::Region;
use super::node::Spread;
use super::principal::{Equations, Traced};
use super::region::Strain;
use super::stage::{Stage, fits};
use crate::groups::Group;

/// How much larger than the velocity at hand the regions are.
pub(super) const TIMES: [f64; 5] = [1.5, 1.8, 2.4, 4.0, 8.0];

/// The same where the tangent is another at every node. What serves nearby is soon proved anew: the
/// first region that will do is taken.
pub(super) const NEARBY: [f64; 3] = [2.4, 1.8, 1.5];

/// Looks for a reach of at least `wanted`: the largest where it serves at every node.
pub(super) fn lasting<G, E, const D: usize, const K: usize>(
    equations: &Equations<G, E, D, K>,
    rest: &Stage<G, D>,
    wanted: &[f64; D],
    everywhere: bool,
) -> Option<Traced<G, D>>
where
    G: Group<f64>,
    E: Region<K, Centre = G>,
{
    let strain = |radii: &[f64; D]| {
        let region = E::around(&G::identity(), radii, 0);
        let tangent = (equations.enclosed)(Spread::HERE, &region);
        Strain::over::<E, K>(rest.inverse(), &tangent, radii)
    };
    let reach = match everywhere {
        true => everywhere_alike::<G, D>(&strain, wanted),
        false => nearby::<G, D>(&strain, wanted),
    };
    Some(Traced::Principal {
        reach: reach?,
        spread: Spread::TURNED,
    })
}

/// The largest reach, where the tangent is the same at every node.
fn everywhere_alike<G: Group<f64>, const D: usize>(
    strain: &dyn Fn(&[f64; D]) -> Strain<D>,
    wanted: &[f64; D],
) -> Option<[f64; D]> {
    let mut best: Option<[f64; D]> = None;
    for times in TIMES {
        let radii = wanted.map(|x| times * x);
        let whole = strain(&radii);
        let half = strain(&radii.map(|r| 0.5 * r));
        // Regular in the whole region: also where the velocity does not come.
        let away = whole.spread(&radii).map(|_| &whole);
        let next = away.and_then(|whole| {
            let back = Some(whole);
            reach(&whole.mean(&half), back, &radii, G::PARTS.min(D))
        });
        // Larger as long as the reach grows.
        let worse = next.is_none_or(|n| best.is_some_and(|b| b[0] >= n[0]));
        if worse && best.is_some_and(|reach| fits::<G, D>(wanted, &reach)) {
            break;
        }
        best = if worse { best } else { next };
    }
    best.filter(|reach| fits::<G, D>(wanted, reach))
}

/// A reach where the tangent is another at every node.
fn nearby<G: Group<f64>, const D: usize>(
    strain: &dyn Fn(&[f64; D]) -> Strain<D>,
    wanted: &[f64; D],
) -> Option<[f64; D]> {
    NEARBY.iter().find_map(|times| {
        let radii = wanted.map(|x| times * x);
        let whole = strain(&radii);
        // Regular in the whole region: also where the velocity does not come.
        whole.spread(&radii)?;
        let within = |mean: &Strain<D>| {
            let reach = reach(mean, None, &radii, G::PARTS.min(D));
            reach.filter(|reach| fits::<G, D>(wanted, reach))
        };
        // The mean along lines does not exceed the strain of the whole region, which is known by now.
        within(&whole).or_else(|| within(&whole.mean(&strain(&radii.map(|r| 0.5 * r)))))
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
fn reach<const D: usize>(
    mean: &Strain<D>,
    back: Option<&Strain<D>>,
    radii: &[f64; D],
    parts: usize,
) -> Option<[f64; D]> {
    let pulled = mean.pull(radii);
    let away = mean.spread(&pulled)?;
    let back = match back {
        Some(strain) => strain.spread(&pulled)?.map(Some),
        None => [None; D],
    };
    let triples = radii.iter().zip(away).zip(back).take(parts);
    let share = triples.fold(1.0, |least: f64, ((r, away), back)| {
        let farthest = match back {
            Some(back) => away * (r + back) / (away + back),
            None => away,
        };
        least.min(r / farthest)
    });
    (share > 0.0).then(|| radii.map(|r| share * r))
}
