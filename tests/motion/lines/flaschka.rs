//! The eigenvalues of Flaschka's matrix are constants of Toda's ring. Along discrete steps they oscillate with an amplitude of
//! order h^2 and do not drift.

use clebsch::nalgebra::{DMatrix, SMatrix};
use clebsch::scalar::largest;
use clebsch_models::lattices::toda_chain::*;

const SITES: usize = 9;

/// The sorted eigenvalues for unit masses and springs.
fn eigenvalues(state: &TodaChainState, length: f64) -> Vec<f64> {
    let q: Vec<f64> = state.q().iter().map(|q| q[0]).collect();
    let mut lax = DMatrix::zeros(SITES, SITES);
    for (i, p) in state.momentum_q().iter().enumerate() {
        let next = (i + 1) % SITES;
        let ahead = if next == 0 { q[0] + length } else { q[next] };
        let beside = 0.5 * (-0.5 * (ahead - q[i])).exp();
        lax[(i, i)] = -0.5 * p[0];
        lax[(i, next)] += beside;
        lax[(next, i)] += beside;
    }
    let mut values: Vec<f64> = lax.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The largest change of an eigenvalue in the first and in the second half of a run.
fn changes(h: f64, steps: usize, spring: f64) -> [f64; 2] {
    let length = 0.2;
    let parameters = TodaChainParameters {
        m: 1.0,
        a: spring,
        b: 1.0,
    };
    let sites = TodaChainSites {
        N: SITES,
        ends: TodaChainEnds::Ring { L: length },
    };
    let chain = TodaChain::new(parameters, sites).expect("a ring");
    let list = |size: f64, turn: f64| {
        let number = |i: usize| SMatrix::repeat(size * (turn * (1 + i * i) as f64).sin());
        (0..SITES).map(number).collect()
    };
    let initial = TodaChainInitial {
        q: list(0.3, 0.7),
        momentum_q: list(0.8, 1.9),
    };
    let (mut state, mut work) = chain.start(initial, h).expect("starts");
    let first = eigenvalues(&state, length);
    [0, 1].map(|_| {
        let mut most: f64 = 0.0;
        for _ in 0..steps / 2 {
            chain.step(&mut state, &mut work).expect("steps");
            let now = eigenvalues(&state, length);
            most = most.max(largest(now.iter().zip(&first).map(|(a, b)| a - b)));
        }
        most
    })
}

#[test]
fn flaschkas_eigenvalues_swing_with_the_square_of_the_step_and_do_not_drift() {
    let [early, late] = changes(0.04, 40_000, 1.0);
    // A slow modulation may raise the second half slightly; a drift would double it.
    assert!(late < 1.3 * early, "{early:e} {late:e}");
    let [half, _] = changes(0.02, 80_000, 1.0);
    let order = (early / half).log2();
    assert!(
        (order - 2.0).abs() < 0.15,
        "{early:e} {half:e}: order {order}"
    );
    // For springs twice as stiff, the eigenvalues of this matrix are not constants.
    let [other, _] = changes(0.04, 2_000, 2.0);
    assert!(other > 30.0 * early, "{early:e} {other:e}");
}
