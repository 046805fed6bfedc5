//! How short the waves of a small motion are along a line of sites. Takes the velocities of all degrees of freedom,
//! and the neighbours by the names of a card; gives a number.

use super::moves::Moves;
use std::collections::HashMap;
use std::ops::Range;

/// The degrees of freedom of each configuration and of its next neighbour, such as `q_3` and `q_4`.
pub(super) fn neighbours(moves: &[Moves], names: &[&str]) -> Vec<[Range<usize>; 2]> {
    let mut from = 0;
    let mut own = Vec::new();
    for (body, name) in moves.iter().zip(names) {
        own.push((*name, from..from + body.count()));
        from += body.count();
    }
    let sites: HashMap<(&str, usize), &Range<usize>> = own
        .iter()
        .filter_map(|(name, range)| Some((site(name)?, range)))
        .collect();
    let beside = |(name, range): &(&str, Range<usize>)| {
        let (stem, number) = site(name)?;
        let next = *sites.get(&(stem, number + 1))?;
        (next.len() == range.len()).then(|| [range.clone(), next.clone()])
    };
    own.iter().filter_map(beside).collect()
}

/// The name without the number at its end, and the number.
fn site(name: &str) -> Option<(&str, usize)> {
    let (stem, number) = name.rsplit_once('_')?;
    Some((stem, number.parse().ok()?))
}

/// How much neighbours move against each other, relative to their motion: 0 if they move alike, 2 if they alternate,
/// `1 - cos(k)` for a wave whose phase changes by `k` from site to site. 0 without neighbours.
pub(super) fn shortness(velocity: &[f64], units: &[f64], pairs: &[[Range<usize>; 2]]) -> f64 {
    let (mut apart, mut all) = (0.0, 0.0);
    for [here, there] in pairs {
        for (i, j) in here.clone().zip(there.clone()) {
            let [a, b] = [velocity[i] / units[i], velocity[j] / units[j]];
            apart += (a - b).powi(2);
            all += a * a + b * b;
        }
    }
    if all > 0.0 { apart / all } else { 0.0 }
}
