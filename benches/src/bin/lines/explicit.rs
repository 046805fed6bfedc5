//! Chains with explicit steps, compiled and hand-written, and the single heavy top. Gives blocks of work for a number of sites, and
//! checks that both implementations give the same motion.

use super::{WORK, diagonal, number};
use clebsch::nalgebra::Vector3;
use clebsch::{BodyMomentum, Rotation, scalar::largest};
use clebsch_comparisons::handwritten::attitude::{Matrix, Quaternion, Vector};
use clebsch_comparisons::handwritten::lattices::{
    coupled_tops as tops_hand, geometrically_exact_rod as rod_hand, sine_gordon as sine_hand,
    toda_chain as toda_hand,
};
use clebsch_models::heavy_top::{HeavyTop, HeavyTopInitial, HeavyTopParameters};
use clebsch_models::lattices::{
    coupled_tops::*, geometrically_exact_rod::*, sine_gordon::*, toda_chain::*,
};
use std::hint::black_box;

/// Compiled steps from a state.
macro_rules! compiled {
    ($n:expr, $line:expr, $initial:expr, $h:expr) => {{
        let line = $line;
        let (mut state, mut work) = line.start($initial, $h).expect("starts");
        move || {
            for _ in 0..WORK / $n {
                line.step(&mut state, &mut work).expect("steps");
            }
            black_box(&state);
        }
    }};
}

/// Checks that the momenta of both implementations agree after twenty steps.
macro_rules! apart {
    ($line:expr, $initial:expr, $h:expr, $state:ident => $momenta:expr, $hand:ident = $start:expr => $stepped:expr, $theirs:expr) => {{
        let line = $line;
        let (mut $state, mut work) = line.start($initial, $h).expect("starts");
        let mut $hand = $start;
        for _ in 0..20 {
            line.step(&mut $state, &mut work).expect("steps");
            $stepped;
        }
        let (ours, theirs): (Vec<f64>, Vec<f64>) = ($momenta.collect(), $theirs.collect());
        assert_eq!(ours.len(), theirs.len());
        let far = largest(ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()));
        // Twenty steps with a few rounding errors each, for momenta of order one.
        assert!(far < 1e-12, "both are the same motion: {far:e}");
    }};
}

/// Checks that both implementations agree for this number of sites.
pub fn same_motions(n: usize) {
    apart!(
        toda_chain(n), toda_initial(n), 0.01, state => state.momentum_q().iter().map(|p| p[0]),
        hand = toda_started(n) => hand.step(), hand.momenta().iter().copied()
    );
    apart!(
        wire(n), wire_initial(n), 0.01, state => state.momentum_u().iter().map(|p| p[0]),
        hand = wire_started(n) => hand.step(), hand.momenta().iter().copied()
    );
    apart!(
        row(n), row_initial(n), 0.01,
        state => state.spatial_momentum_Λ().flat_map(|m| [m.0[0], m.0[1], m.0[2]]),
        hand = row_started(n) => hand.step().expect("steps"), hand.spatial_momenta().flatten()
    );
    apart!(
        elastic(n), elastic_initial(n), 0.001,
        state => state.momentum_φ().iter().copied().chain(state.spatial_momentum_Λ().map(|m| m.0))
            .flat_map(|m| [m[0], m[1], m[2]]),
        hand = elastic_started(n) => hand.step().expect("steps"),
        hand.momenta().chain(hand.spatial_momenta()).flatten()
    );
}

fn wave(n: usize, size: f64, number_of_waves: f64) -> Vec<f64> {
    (0..n)
        .map(|i| size * (number_of_waves * i as f64).sin())
        .collect()
}

fn toda_chain(n: usize) -> TodaChain {
    let sites = TodaChainSites {
        N: n,
        ends: TodaChainEnds::Ring { L: 0.0 },
    };
    let parameters = TodaChainParameters {
        m: 1.0,
        a: 1.0,
        b: 1.0,
    };
    TodaChain::new(parameters, sites).expect("a chain")
}

fn toda_initial(n: usize) -> TodaChainInitial {
    TodaChainInitial {
        q: wave(n, 0.1, 0.3).into_iter().map(number).collect(),
        momentum_q: wave(n, 0.1, 0.7).into_iter().map(number).collect(),
    }
}

fn toda_started(n: usize) -> toda_hand::TodaChain {
    let (mass, stiffness, softening, h) = black_box((1.0, 1.0, 1.0, 0.01));
    let springs = toda_hand::Springs {
        mass,
        stiffness,
        softening,
    };
    let ring = toda_hand::Ends::Ring(0.0);
    toda_hand::TodaChain::start(springs, ring, &wave(n, 0.1, 0.3), &wave(n, 0.1, 0.7), h)
}

/// Toda's chain, a ring.
pub fn toda(n: usize) -> impl FnMut() {
    compiled!(n, toda_chain(n), toda_initial(n), 0.01)
}

/// Toda's chain, hand-written.
pub fn toda_by_hand(n: usize) -> impl FnMut() {
    let mut chain = toda_started(n);
    move || {
        (0..WORK / n).for_each(|_| chain.step());
        black_box(&chain);
    }
}

fn weights(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| if i == 0 || i == n - 1 { 0.25 } else { 0.5 })
        .collect()
}

fn wire(n: usize) -> SineGordon {
    let parameters = SineGordonParameters {
        s: 0.5,
        w: weights(n),
        k: 1.0,
    };
    let ends = SineGordonEnds::Open {
        first: SineGordonFirst::Free,
        last: SineGordonLast::Free,
    };
    SineGordon::new(parameters, SineGordonSites { N: n - 1, ends }).expect("a line")
}

fn wire_initial(n: usize) -> SineGordonInitial {
    SineGordonInitial {
        u: wave(n, 2.0, 0.1).into_iter().map(number).collect(),
        momentum_u: wave(n, 0.1, 0.7).into_iter().map(number).collect(),
    }
}

fn wire_started(n: usize) -> sine_hand::SineGordon {
    let wire = sine_hand::Wire {
        spacing: 0.5,
        weights: weights(n),
        stiffness: 1.0,
        ends: sine_hand::Ends::Open {
            first_pinned: false,
            last_pinned: false,
        },
    };
    sine_hand::SineGordon::start(&wire, &wave(n, 2.0, 0.1), &wave(n, 0.1, 0.7), 0.01)
}

/// The sine-Gordon equation, both ends free.
pub fn sine(n: usize) -> impl FnMut() {
    compiled!(n, wire(n), wire_initial(n), 0.01)
}

/// The sine-Gordon equation, hand-written.
pub fn sine_by_hand(n: usize) -> impl FnMut() {
    let mut line = wire_started(n);
    move || {
        (0..WORK / n).for_each(|_| line.step());
        black_box(&line);
    }
}

fn row(n: usize) -> CoupledTops {
    let parameters = CoupledTopsParameters {
        s: 1.0,
        J: diagonal(0.5, 0.5, 1.5),
        C: diagonal(0.3, 0.3, 0.3),
        gU: Vector3::z(),
        z: Vector3::z(),
    };
    let sites = CoupledTopsSites {
        N: n - 1,
        ends: CoupledTopsEnds::Open,
    };
    CoupledTops::new(parameters, sites).expect("tops")
}

fn leaning(n: usize) -> Vec<Rotation> {
    let axes = wave(n, 0.2, 0.1).into_iter();
    axes.map(|x| Rotation::exp(&Vector3::new(x, 0.6, 0.0)))
        .collect()
}

fn row_initial(n: usize) -> CoupledTopsInitial {
    CoupledTopsInitial {
        Λ: leaning(n),
        body_momentum_Λ: vec![BodyMomentum(Vector3::new(0.1, 0.0, 3.0)); n],
    }
}

const fn matrix([a, b, c]: Vector) -> Matrix {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

fn row_started(n: usize) -> tops_hand::CoupledTops {
    let row = tops_hand::Row {
        spacing: 1.0,
        poinsot: matrix([0.5, 0.5, 1.5]),
        stiffness: matrix([0.3; 3]),
        weight: [0.0, 0.0, 1.0],
        up: [0.0, 0.0, 1.0],
        ring: false,
    };
    let attitudes: Vec<Quaternion> = leaning(n)
        .iter()
        .map(|q| Quaternion(q.quaternion()))
        .collect();
    tops_hand::CoupledTops::start(&row, &attitudes, &vec![[0.1, 0.0, 3.0]; n], 0.01)
        .expect("starts")
}

/// Coupled heavy tops with free ends on `threads` threads.
pub fn tops(n: usize, threads: usize) -> impl FnMut() {
    compiled!(n, row(n).with_threads(threads), row_initial(n), 0.01)
}

/// Coupled heavy tops, hand-written.
pub fn tops_by_hand(n: usize) -> impl FnMut() {
    let mut tops = row_started(n);
    move || {
        (0..WORK / n).for_each(|_| tops.step().expect("steps"));
        black_box(&tops);
    }
}

/// A single heavy top; the number of steps does not depend on the number of sites.
pub fn lone(_: usize) -> impl FnMut() {
    let parameters = HeavyTopParameters {
        J: diagonal(0.5, 0.5, 1.5),
        gU: Vector3::z(),
        z: Vector3::z(),
    };
    let initial = HeavyTopInitial {
        Λ: Rotation::exp(&Vector3::new(0.0, 0.6, 0.0)),
        body_momentum: BodyMomentum(Vector3::new(0.1, 0.0, 3.0)),
    };
    compiled!(1, HeavyTop::new(parameters).expect("a top"), initial, 0.01)
}

/// Node spacing of the rod.
const LENGTH: f64 = 0.1;

fn masses(n: usize) -> Vec<f64> {
    (0..=n)
        .map(|i| LENGTH * if i == 0 || i == n { 0.5 } else { 1.0 })
        .collect()
}

fn elastic(n: usize) -> GeometricallyExactRod {
    let parameters = GeometricallyExactRodParameters {
        s: LENGTH,
        m: masses(n),
        J: vec![diagonal(0.01, 0.01, 0.02); n],
        S: diagonal(100.0, 100.0, 200.0),
        B: diagonal(1.0, 1.0, 2.0),
        g: Vector3::zeros(),
    };
    let ends = GeometricallyExactRodEnds::Open {
        first: GeometricallyExactRodFirst::Free,
        last: GeometricallyExactRodLast::Free,
    };
    GeometricallyExactRod::new(parameters, GeometricallyExactRodSites { N: n, ends })
        .expect("a rod")
}

fn elastic_initial(n: usize) -> GeometricallyExactRodInitial {
    GeometricallyExactRodInitial {
        φ: (0..=n)
            .map(|i| Vector3::z() * (LENGTH * i as f64))
            .collect(),
        momentum_φ: wave(n + 1, 1e-3, 0.2)
            .into_iter()
            .map(|p| Vector3::x() * p)
            .collect(),
        Λ: vec![Rotation::identity(); n],
        body_momentum_Λ: vec![BodyMomentum(Vector3::new(0.0, 1e-5, 1e-4)); n],
    }
}

fn elastic_started(n: usize) -> rod_hand::ElasticRod {
    let rod = rod_hand::Rod {
        spacing: LENGTH,
        masses: masses(n),
        poinsots: vec![matrix([0.01, 0.01, 0.02]); n],
        shear: matrix([100.0, 100.0, 200.0]),
        bending: matrix([1.0, 1.0, 2.0]),
        gravity: [0.0; 3],
        ends: rod_hand::Ends::Open {
            first: rod_hand::End::FREE,
            last: rod_hand::End::FREE,
        },
    };
    let places: Vec<Vector> = (0..=n).map(|i| [0.0, 0.0, LENGTH * i as f64]).collect();
    let momenta: Vec<Vector> = wave(n + 1, 1e-3, 0.2)
        .iter()
        .map(|p| [*p, 0.0, 0.0])
        .collect();
    let attitudes = vec![Quaternion::IDENTITY; n];
    let turning = vec![[0.0, 1e-5, 1e-4]; n];
    rod_hand::ElasticRod::start(&rod, &places, &momenta, &attitudes, &turning, 0.001)
        .expect("starts")
}

/// An elastic rod, both ends free.
pub fn rod(n: usize) -> impl FnMut() {
    compiled!(n, elastic(n), elastic_initial(n), 0.001)
}

/// The elastic rod, hand-written.
pub fn rod_by_hand(n: usize) -> impl FnMut() {
    let mut rod = elastic_started(n);
    move || {
        (0..WORK / n).for_each(|_| rod.step().expect("steps"));
        black_box(&rod);
    }
}
