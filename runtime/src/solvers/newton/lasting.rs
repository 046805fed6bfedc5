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
const TIMES: [f64; 5] = [1.5, 1.8, 2.4, 4.0, 8.0];

/// Looks for the largest reach of at least `wanted`.
pub(super) fn lasting<G, E, const D: usize, const K: usize>(
    equations: &Equations<G, E, D, K>,
    rest: &Stage<G, D>,
    wanted: &[f64; D],
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
    let mut best: Option<[f64; D]> = None;
    for times in TIMES {
        let radii = wanted.map(|x| times * x);
        let whole = strain(&radii);
        let half = strain(&radii.map(|r| 0.5 * r));
        let regular = whole.spread(&radii).is_some();
        let next = reach(&whole.mean(&half), &radii, G::PARTS.min(D)).filter(|_| regular);
        // Larger as long as the reach grows.
        let worse = next.is_none_or(|n| best.is_some_and(|b| b[0] >= n[0]));
        if worse && best.is_some_and(|reach| fits::<G, D>(wanted, &reach)) {
            break;
        }
        best = if worse { best } else { next };
    }
    let reach = best.filter(|reach| fits::<G, D>(wanted, reach))?;
    Some(Traced::Principal {
        reach,
        spread: Spread::TURNED,
    })
}

/// Within which lengths of rest a solution is the principal root: there `(1 - e)^-1 |x|` does not
/// exceed the radii, since `|x|` does not exceed `(1 + e) |c|`, both with the mean strain.
fn reach<const D: usize>(strain: &Strain<D>, radii: &[f64; D], parts: usize) -> Option<[f64; D]> {
    let needed = strain.spread(&strain.pull(radii))?;
    let pairs = radii.iter().zip(&needed).take(parts);
    let share = pairs.fold(1.0, |least: f64, (r, y)| least.min(r / y));
    (share > 0.0).then(|| radii.map(|r| share * r))
}
