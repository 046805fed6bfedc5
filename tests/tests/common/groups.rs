//! Sums of random terms on SU(2), SE(2) and SE(3), on both sides, against the variation of unreduced actions at random
//! points that solve nothing. A further group is a further name in `of_every_group!`, by its `TermSum`.

use super::oracle_bridge::{AGREEMENT, assignment, disagreement};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::{DiscreteAction, Side, TermSum, stationarity};
use clebsch_oracle::oracle::points::{Given, Source};
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Points for each sum of random terms.
const POINTS_EACH: usize = 20;

/// Three nodes of a configuration.
pub type Nodes<const N: usize> = [[Square<f64, N>; 1]; 3];

/// The derivation of what must not be refused.
pub fn derived(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|errors| panic!("{text}\nis refused:\n{errors}"))
}

/// The worst disagreement over some points.
pub fn worst<const N: usize, A: DiscreteAction<N, 1>>(
    d: &Derivation,
    source: &mut Source,
    points: usize,
    basis: &[Square<f64, N>],
    node: fn(&mut Source) -> [Square<f64, N>; 1],
    system: impl Fn(&mut Source) -> (A, f64),
    given: impl Fn(&A, &Nodes<N>) -> Vec<Given>,
) -> f64 {
    let mut worst: f64 = 0.0;
    for _ in 0..points {
        let (action, h) = system(source);
        let nodes: Nodes<N> = from_fn(|_| node(source));
        let oracle = stationarity(&action, &nodes, basis);
        let values = assignment(&given(&action, &nodes), ("h", h));
        let engine = d.residual(&values).expect("all values are given");
        worst = worse(worst, disagreement(&oracle, &engine));
    }
    worst
}

/// The worst disagreement of the sum of some terms.
fn of_terms<const N: usize, S: TermSum<N>>(
    terms: &[usize],
    side: Side,
    defined: bool,
    seed: u64,
    points: usize,
) -> f64 {
    worst(
        &derived(&S::text(side, terms, defined)),
        &mut Source::seeded(seed),
        points,
        &S::basis(),
        S::node,
        |s| {
            let a = S::random(s, side, terms);
            let h = a.step();
            (a, h)
        },
        S::given,
    )
}

/// Calls a function for the sums of terms of every group, with further arguments.
macro_rules! of_every_group {
    ($call:ident $(, $argument:expr)*) => {{
        use clebsch_oracle::oracle::action::{
            motions::MotionSum, plane::PlaneSum, quaternions::QuaternionSum,
        };
        $call::<4, QuaternionSum>("SU(2)" $(, $argument)*);
        $call::<3, PlaneSum>("SE(2)" $(, $argument)*);
        $call::<4, MotionSum>("SE(3)" $(, $argument)*);
    }};
}
pub(crate) use of_every_group;

/// One in so many of the terms, each beside the kinetic one.
pub fn every_term<const N: usize, S: TermSum<N>>(group: &str, one_in: usize) {
    for side in [Side::Body, Side::Space] {
        for (term, text) in S::TERMS.iter().enumerate().skip(1).step_by(one_in) {
            for defined in [true, false] {
                let found = of_terms::<N, S>(&[0, term], side, defined, 53, 60);
                assert!(found < AGREEMENT, "{group}, {side:?} {text}: {found:e}");
            }
        }
    }
}

/// So many sums of random terms.
pub fn random_lagrangians<const N: usize, S: TermSum<N>>(group: &str, count: usize) {
    let mut source = Source::seeded(55);
    let mut worst: f64 = 0.0;
    for n in 0..count {
        let side = if n % 2 == 0 { Side::Body } else { Side::Space };
        let terms = S::choice(&mut source);
        let found = of_terms::<N, S>(&terms, side, n % 3 == 0, n as u64, POINTS_EACH);
        assert!(found < AGREEMENT, "{group}, {terms:?}, {side:?}: {found:e}");
        worst = worse(worst, found);
    }
    println!("{group}: worst {worst:e}");
}
