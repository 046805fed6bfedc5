//! Changes that a comparison must detect: a sign or a range in the hand-written action, and a summand in the derived residual.

use super::compare::{Variation, WHAT, agrees, disagreement, found, order, ordered, typed, values};
use super::sum::{Sum, Typed};
use super::{AGREEMENT, Ends, derived};
use clebsch_core::{Assignment, Derivation};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::sizes::CHANGED_SEGMENTS;

/// The change.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Change {
    None,
    /// The sign of the summand with this index.
    Sign(usize),
    /// The range of the sum with this index: shifts its first and its last site.
    Range(usize, isize, isize),
}

/// Every shift of one end of a range by one site.
const ENDS_MOVED: [(isize, isize); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// The number of summands that vary; a constant summand has only rounding errors as slopes.
fn varying(v: &Variation) -> usize {
    let largest = v.largest.iter().copied().fold(0.0, worse);
    let moves = v.largest.iter().filter(|x| **x > AGREEMENT * largest);
    moves.count()
}

/// Whether to change the hand-written action term by term at this number of segments. `LATTICE_CHANGES=12` includes longer chains
/// and takes a minute.
fn is_changed(segments: usize) -> bool {
    segments as u64 <= asked_for("LATTICE_CHANGES", CHANGED_SEGMENTS)
}

/// Checks that the derivation for these numbers of sites agrees with the hand-written action, and that the comparison detects
/// changes of either. The last label counts the segments. Returns the action and, for short chains, the number of changes and how
/// many of them only move constants.
pub fn judged<M: Typed>(
    text: &str,
    counts: &[(&str, usize)],
    ends: Ends,
    typed: impl Fn(&mut Source) -> M,
) -> (M, Option<(usize, usize)>) {
    let segments = counts.last().map_or(0, |(_, n)| *n);
    let mut source = Source::seeded(segments as u64);
    let d = derived(text, counts, ends);
    let model = typed(&mut source);
    agrees(&d, &model, &mut source);
    if segments == 3 {
        let left = unseen(&d, &model, &mut source);
        assert!(left.is_empty(), "{left:?}");
    }
    let changes = is_changed(segments).then(|| changes_are_seen(&d, &model, &mut source));
    (model, changes)
}

/// Checks that the comparison detects every change of a sign, or of a range by one site, that moves the action. Returns the number
/// of changes, and how many only move constants.
fn changes_are_seen(d: &Derivation, model: &impl Typed, source: &mut Source) -> (usize, usize) {
    let nodes = [(); 3].map(|()| model.draw(source));
    let found = found(d, model, &nodes);
    let mut sum = Sum::new(Change::None);
    model.action(&nodes[1], &nodes[2], &mut sum);
    let whole = typed(model, &nodes, Change::None);
    let largest = whole[2].largest.iter().copied().fold(0.0, worse);
    let signs = (0..sum.summands.len()).map(Change::Sign);
    let ranges = (0..sum.sums.len()).flat_map(|i| ENDS_MOVED.map(|(a, b)| Change::Range(i, a, b)));
    let (mut all, mut constant) = (0, 0);
    for change in signs.chain(ranges) {
        all += 1;
        let changed = typed(model, &nodes, change);
        let moves = match change {
            Change::Sign(i) => whole[2].largest[i] > AGREEMENT * largest,
            _ => varying(&whole[2]) != varying(&changed[2]),
        };
        for ((wanted, found), what) in changed.iter().zip(&found).zip(WHAT) {
            let apart = disagreement(wanted, found).0;
            assert_eq!(
                apart > AGREEMENT,
                moves,
                "{}: {change:?} puts the {what} {apart:e} apart",
                d.spec.name
            );
        }
        constant += usize::from(!moves);
    }
    (all, constant)
}

/// Descriptions of summands of the derived residual whose removal or negation still agrees with the hand-written action at three
/// random points.
fn unseen(d: &Derivation, model: &impl Typed, source: &mut Source) -> Vec<String> {
    let points: Vec<(Assignment, Variation)> = (0..3)
        .map(|_| {
            let nodes = [(); 3].map(|()| model.draw(source));
            let [_, _, residual] = typed(model, &nodes, Change::None);
            (values(model, &nodes), residual)
        })
        .collect();
    let order = order(d, model);
    let mutants = d.mutations();
    assert!(mutants.len() > d.spec.configurations.len());
    let alive = mutants.iter().filter(|m| {
        points.iter().all(|(values, wanted)| {
            let found = m.residual(values);
            found.is_ok_and(|r| disagreement(wanted, &ordered(&r, &order, model)).0 <= AGREEMENT)
        })
    });
    alive.map(|m| m.describe()).collect()
}
