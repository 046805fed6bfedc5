//! Time per site and step of chains compiled for any number of sites. Compares Toda's chain, the sine-Gordon equation, coupled
//! tops, elastic and inextensible rods, shallow water and velocity-coupled bodies with hand-written steppers. Also compares tops
//! and rod with single heavy tops, the rod in quaternions with the rod in rotations, and constrained chains with the elastic rod.
//! Takes part of a row's name to select rows; prints a table.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin lines [-- ROW]`, two minutes.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables, non_snake_case)]

#[path = "lines/explicit.rs"]
mod explicit;

use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::{BodyMomentum, Rotation, UnitQuaternion};
use clebsch_benches::blocks::computed;
use clebsch_comparisons::handwritten::attitude::{Quaternion, Vector};
use clebsch_comparisons::handwritten::lattices::body_chain::{Bodies, BodyChain};
use clebsch_comparisons::handwritten::lattices::inextensible_rod::{self, InextensibleRod};
use clebsch_models::lattices::{
    coupled_body_chain::*, hanging_chain::*, kirchhoff_rod::*, quaternion_rod::*,
    shallow_water_1d::*,
};
use explicit::{
    lone, rod, rod_by_hand, sine, sine_by_hand, toda, toda_by_hand, tops, tops_by_hand,
};
use std::hint::black_box;
use std::time::Instant;

/// Sites times steps per block.
const WORK: usize = 1_000_000;

/// Interleaved blocks for each implementation.
const BLOCKS: usize = 11;

const SIZES: [usize; 4] = [100, 1_000, 10_000, 100_000];

/// The block for a number of sites.
type Block = fn(usize) -> Box<dyn FnMut()>;

fn main() {
    explicit::same_motions(100);
    println!("{}", env!("RUSTC_VERSION"));
    println!(
        "nanoseconds of computing time per site and step, medians of {BLOCKS} interleaved blocks for each stepper\n"
    );
    println!("| line | sites | generated | beside | ratio |");
    println!("|---|---|---|---|---|");
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let rows: [(&str, Block, Block); 12] = [
        (
            "Toda's chain, a ring, beside a plain loop",
            |n| Box::new(toda(n)),
            |n| Box::new(toda_by_hand(n)),
        ),
        (
            "sine-Gordon, free ends, beside a plain loop",
            |n| Box::new(sine(n)),
            |n| Box::new(sine_by_hand(n)),
        ),
        (
            "coupled tops, beside loops by hand",
            |n| Box::new(tops(n, 1)),
            |n| Box::new(tops_by_hand(n)),
        ),
        (
            "elastic rod, beside loops by hand",
            |n| Box::new(rod(n)),
            |n| Box::new(rod_by_hand(n)),
        ),
        (
            "shallow water, a ring, beside a plain loop",
            |n| Box::new(water(n)),
            |n| Box::new(water_by_hand(n)),
        ),
        (
            "coupled tops, beside the lone heavy top",
            |n| Box::new(tops(n, 1)),
            |n| Box::new(lone(n)),
        ),
        (
            "elastic rod, beside the lone heavy top",
            |n| Box::new(rod(n)),
            |n| Box::new(lone(n)),
        ),
        (
            "elastic rod in quaternions, beside the one in rotations",
            |n| Box::new(in_quaternions(n)),
            |n| Box::new(rod(n)),
        ),
        (
            "inextensible rod, beside the elastic one",
            |n| Box::new(inextensible(n)),
            |n| Box::new(rod(n)),
        ),
        (
            "inextensible rod, beside one by hand",
            |n| Box::new(inextensible(n)),
            |n| Box::new(inextensible_by_hand(n)),
        ),
        (
            "chain of rigid links, beside the elastic rod",
            |n| Box::new(links(n)),
            |n| Box::new(rod(n)),
        ),
        (
            "bodies joined by their velocities, beside a stepper by hand",
            |n| Box::new(bodies(n)),
            |n| Box::new(bodies_by_hand(n)),
        ),
    ];
    for (name, one, other) in rows.into_iter().filter(|(name, ..)| name.contains(&wanted)) {
        for n in SIZES {
            let (one, other) = both(&mut *one(n), &mut *other(n));
            row(name, n, one, other);
        }
    }
    if !wanted.is_empty() {
        return;
    }
    let wall = |threads| {
        let mut block = tops(100_000, threads);
        let begin = Instant::now();
        for _ in 0..BLOCKS {
            block();
        }
        begin.elapsed().as_secs_f64()
    };
    println!(
        "\ncoupled tops, 100000 sites: two threads take {:.3} of the time of one",
        wall(2) / wall(1)
    );
}

fn row(name: &str, n: usize, one: f64, other: f64) {
    println!(
        "| {name} | {n} | {one:.2} | {other:.2} | {:.3} |",
        one / other
    );
}

/// Medians of both, in nanoseconds per site and step.
fn both(one: &mut dyn FnMut(), other: &mut dyn FnMut()) -> (f64, f64) {
    let time = |work: &mut dyn FnMut()| {
        let begin = computed();
        work();
        (computed() - begin) / WORK as f64
    };
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for _ in 0..BLOCKS {
        a.push(time(one));
        b.push(time(other));
    }
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    (a[BLOCKS / 2], b[BLOCKS / 2])
}

fn number(x: f64) -> SMatrix<f64, 1, 1> {
    SMatrix::repeat(x)
}

fn water(n: usize) -> impl FnMut() {
    let sites = ShallowWater1DSites {
        N: n,
        ends: ShallowWater1DEnds::Ring { L: n as f64 },
    };
    let parameters = ShallowWater1DParameters {
        m: vec![1.0; n],
        g: 1.0,
        f: 0.5,
    };
    let water = ShallowWater1D::new(parameters, sites).expect("water");
    let initial = ShallowWater1DInitial {
        X: (0..n)
            .map(|i| number(i as f64 + 0.1 * (0.3 * i as f64).sin()))
            .collect(),
        momentum_X: vec![number(0.0); n],
        Y: vec![number(0.0); n],
        momentum_Y: (0..n).map(|i| number(0.5 * i as f64)).collect(),
    };
    let (mut state, mut work) = water.start(initial, 0.02).expect("starts");
    move || {
        for _ in 0..WORK / n {
            water.step(&mut state, &mut work).expect("steps");
        }
        black_box(&state);
    }
}

fn water_by_hand(n: usize) -> impl FnMut() {
    let (dt, g, f) = black_box((0.02, 1.0, 0.5));
    let m = vec![1.0; n];
    let length = n as f64;
    let mut x: Vec<f64> = (0..n)
        .map(|i| i as f64 + 0.1 * (0.3 * i as f64).sin())
        .collect();
    let mut y = vec![0.0; n];
    let mut p = vec![0.0; n];
    let r: Vec<f64> = (0..n).map(|i| 0.5 * i as f64).collect();
    let mut pressure = vec![0.0; n];
    let mut force = vec![0.0; n];
    move || {
        for _ in 0..WORK / n {
            // Momenta are linear in both velocities.
            for i in 0..n {
                let (a, b, c) = (m[i] / dt, -0.5 * m[i] * f, m[i] * f * x[i]);
                let (known_x, known_y) = (p[i] + 0.5 * force[i], r[i] - c);
                let determinant = a * a + b * b;
                let u = (a * known_x - b * known_y) / determinant;
                let v = (a * known_y + b * known_x) / determinant;
                x[i] += u;
                y[i] += v;
                p[i] += 0.5 * force[i] + m[i] * f * v;
            }
            for i in 0..n {
                let next = if i + 1 < n { x[i + 1] } else { x[0] + length };
                let before = if i > 0 { x[i - 1] } else { x[n - 1] - length };
                let gap = next - before;
                pressure[i] = dt * g * m[i] * m[i] / (gap * gap);
            }
            for i in 0..n {
                let next = pressure[if i + 1 < n { i + 1 } else { 0 }];
                let before = pressure[if i > 0 { i - 1 } else { n - 1 }];
                force[i] = before - next;
                p[i] += 0.5 * force[i];
            }
        }
        black_box((&x, &y, &p));
    }
}

fn diagonal(a: f64, b: f64, c: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(a, b, c))
}

/// The same rod in unit quaternions, with the stiffnesses and inertias that correspond to the second moments.
fn in_quaternions(n: usize) -> impl FnMut() {
    let s = 0.1;
    let mass = |i: usize| s * if i == 0 || i == n { 0.5 } else { 1.0 };
    let parameters = QuaternionRodParameters {
        s,
        m: (0..=n).map(mass).collect(),
        I: vec![diagonal(0.03, 0.03, 0.02); n],
        S: diagonal(100.0, 100.0, 200.0),
        K: diagonal(3.0, 3.0, 2.0),
        g: Vector3::zeros(),
    };
    let ends = QuaternionRodEnds::Open {
        first: QuaternionRodFirst::Free,
        last: QuaternionRodLast::Free,
    };
    let rod = QuaternionRod::new(parameters, QuaternionRodSites { N: n, ends }).expect("a rod");
    let initial = QuaternionRodInitial {
        φ: (0..=n).map(|i| Vector3::z() * (s * i as f64)).collect(),
        momentum_φ: (0..=n)
            .map(|i| Vector3::x() * (1e-3 * (0.2 * i as f64).sin()))
            .collect(),
        q: vec![UnitQuaternion::identity(); n],
        body_momentum_q: vec![BodyMomentum(Vector3::new(0.0, 1e-5, 1e-4)); n],
    };
    let (mut state, mut work) = rod.start(initial, 0.001).expect("starts");
    move || {
        for _ in 0..WORK / n {
            rod.step(&mut state, &mut work).expect("steps");
        }
        black_box(&state);
    }
}

/// A free inextensible rod with waves in the rotation of its sections.
struct Waves {
    masses: Vec<f64>,
    places: Vec<Vector>,
    momenta: Vec<Vector>,
    body_momenta: Vec<Vector>,
}

const SPACING: f64 = 0.1;
const SECTION: [f64; 3] = [0.01, 0.01, 0.02];
const BENDING: [f64; 3] = [1.0, 1.0, 2.0];

fn waves(n: usize) -> Waves {
    let mass = |i: usize| SPACING * if i == 0 || i == n { 0.5 } else { 1.0 };
    let spin = |i: usize| Vector3::new(0.0, 1e-3 * (0.2 * i as f64).sin(), 1e-3);
    let mut v = vec![Vector3::zeros()];
    for i in 0..n {
        v.push(v[i] + spin(i).cross(&Vector3::z()) * SPACING);
    }
    let turning = diagonal(0.03, 0.03, 0.02) * SPACING;
    let plain = |v: Vector3<f64>| v.data.0[0];
    Waves {
        masses: (0..=n).map(mass).collect(),
        places: (0..=n).map(|i| [0.0, 0.0, SPACING * i as f64]).collect(),
        momenta: (0..=n).map(|i| plain(v[i] * mass(i))).collect(),
        body_momenta: (0..n).map(|i| plain(turning * spin(i))).collect(),
    }
}

fn vectors(all: &[Vector]) -> Vec<Vector3<f64>> {
    all.iter().map(|x| Vector3::from(*x)).collect()
}

fn inextensible(n: usize) -> impl FnMut() {
    let waves = waves(n);
    let parameters = KirchhoffRodParameters {
        s: SPACING,
        m: waves.masses,
        J: vec![Matrix3::from_diagonal(&SECTION.into()); n],
        B: Matrix3::from_diagonal(&BENDING.into()),
        g: Vector3::zeros(),
    };
    let ends = KirchhoffRodEnds::Open {
        first: KirchhoffRodFirst::Free,
        last: KirchhoffRodLast::Free,
    };
    let rod = KirchhoffRod::new(parameters, KirchhoffRodSites { N: n, ends }).expect("a rod");
    let turning = vectors(&waves.body_momenta).into_iter();
    let initial = KirchhoffRodInitial {
        φ: vectors(&waves.places),
        momentum_φ: vectors(&waves.momenta),
        Λ: vec![Rotation::identity(); n],
        body_momentum_Λ: turning.map(BodyMomentum).collect(),
    };
    let (mut state, mut work) = rod.start(initial, 0.001).expect("starts");
    let mut own = unstretched(n);
    for _ in 0..20 {
        rod.step(&mut state, &mut work).expect("steps");
        own.step().expect("steps");
    }
    // In each of twenty steps, forces are solved to a few rounding errors of positions, which reach sites/10, times mass over step
    // size.
    let bound = 20.0 * 32.0 * f64::EPSILON * (SPACING * n as f64) * SPACING / 0.001;
    let far = state.momentum_φ().iter().zip(own.momenta());
    let far = clebsch::scalar::largest(far.map(|(x, y)| (x - Vector3::from(*y)).amax()));
    assert!(far < bound, "both are the same motion: {far:e}");
    move || {
        for _ in 0..WORK / n {
            rod.step(&mut state, &mut work).expect("steps");
        }
        black_box(&state);
    }
}

fn rows_of([a, b, c]: Vector) -> [Vector; 3] {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

fn unstretched(n: usize) -> InextensibleRod {
    let waves = waves(n);
    let (first, last) = (inextensible_rod::First::Free, inextensible_rod::Last::Free);
    let rod = inextensible_rod::Rod {
        spacing: SPACING,
        masses: waves.masses,
        poinsots: vec![rows_of(SECTION)],
        stiffness: rows_of(BENDING),
        gravity: [0.0; 3],
        ends: inextensible_rod::Ends::Open(first, last),
    };
    let turns = vec![Quaternion::IDENTITY; n];
    let (places, momenta, turning) = (&waves.places, &waves.momenta, &waves.body_momenta);
    InextensibleRod::start(&rod, places, momenta, &turns, turning, 0.001).expect("starts")
}

fn inextensible_by_hand(n: usize) -> impl FnMut() {
    let mut rod = unstretched(n);
    move || {
        for _ in 0..WORK / n {
            rod.step().expect("steps");
        }
        black_box(rod.momenta());
    }
}

/// A free chain of rigid links with waves.
fn links(n: usize) -> impl FnMut() {
    let a = 0.1;
    let parameters = HangingChainParameters {
        m: vec![0.1; n + 1],
        a: vec![a; n],
        g: Vector3::zeros(),
    };
    let ends = HangingChainEnds::Open {
        first: HangingChainFirst::Free,
        last: HangingChainLast::Free,
    };
    let chain = HangingChain::new(parameters, HangingChainSites { N: n, ends }).expect("a chain");
    let initial = HangingChainInitial {
        x: (0..=n).map(|i| Vector3::z() * (a * i as f64)).collect(),
        momentum_x: (0..=n)
            .map(|i| Vector3::x() * (1e-3 * (0.2 * i as f64).sin()))
            .collect(),
    };
    let (mut state, mut work) = chain.start(initial, 0.001).expect("starts");
    move || {
        for _ in 0..WORK / n {
            chain.step(&mut state, &mut work).expect("steps");
        }
        black_box(&state);
    }
}

/// Attitudes and momenta of a chain of bodies.
fn of_bodies(n: usize) -> (Vec<Rotation>, Vec<Vector3<f64>>) {
    let turns =
        (0..n).map(|i| Rotation::exp(&Vector3::new(0.2 * (0.1 * i as f64).sin(), 0.6, 0.0)));
    let momenta = (0..n).map(|i| Vector3::new(0.1, 0.3 * (0.2 * i as f64).cos(), 0.5));
    (turns.collect(), momenta.collect())
}

const MOMENTS: [f64; 3] = [1.0, 0.8, 0.6];
const PLACE: [f64; 3] = [0.3, 0.4, 0.5];

fn bodies(n: usize) -> impl FnMut() {
    let [a, b, c] = MOMENTS;
    let parameters = CoupledBodyChainParameters {
        J: diagonal(a, b, c),
        d: PLACE.into(),
        eps: 0.4,
    };
    let sites = CoupledBodyChainSites {
        N: n - 1,
        ends: CoupledBodyChainEnds::Open,
    };
    let row = CoupledBodyChain::new(parameters, sites).expect("bodies");
    let (turns, momenta) = of_bodies(n);
    let initial = CoupledBodyChainInitial {
        Λ: turns,
        body_momentum_Λ: momenta.into_iter().map(BodyMomentum).collect(),
    };
    let (mut state, mut work) = row.start(initial, 0.02).expect("starts");
    let mut own = by_hand(n);
    for _ in 0..20 {
        row.step(&mut state, &mut work).expect("steps");
        own.step().expect("steps");
    }
    // Twenty steps with a few rounding errors each.
    let far = state.spatial_momentum_Λ().zip(own.spatial_momenta());
    let far = clebsch::scalar::largest(far.map(|(x, y)| (x.0 - Vector3::from(y)).amax()));
    assert!(far < 1e-12, "both are the same motion: {far:e}");
    move || {
        for _ in 0..WORK / n {
            row.step(&mut state, &mut work).expect("steps");
        }
        black_box(&state);
    }
}

fn by_hand(n: usize) -> BodyChain {
    let (turns, momenta) = of_bodies(n);
    let turns: Vec<Quaternion> = turns.iter().map(|q| Quaternion(q.quaternion())).collect();
    let momenta: Vec<Vector> = momenta.iter().map(|m| m.data.0[0]).collect();
    let bodies = Bodies {
        poinsot: rows_of(MOMENTS),
        arm: PLACE,
        eps: 0.4,
    };
    BodyChain::start(&bodies, false, &turns, &momenta, 0.02).expect("starts")
}

fn bodies_by_hand(n: usize) -> impl FnMut() {
    let mut row = by_hand(n);
    move || {
        for _ in 0..WORK / n {
            row.step().expect("steps");
        }
        black_box(row.spatial_momenta().next());
    }
}
