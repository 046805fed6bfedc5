//! Chains in unit quaternions: the symplectic form, momenta, comparison with the rod in rotations, and the choice of quaternion
//! signs.

use super::models::{EndCondition, QRod, Random, Rod, Spins, TwistedSpinsOf, Wide, turn};
use clebsch::nalgebra::{DMatrix, Matrix3, Vector3};
use clebsch::{BodyMomentum, Real, Rotation, UnitQuaternion};
use clebsch_models::lattices::coupled_tops::*;
use clebsch_models::lattices::geometrically_exact_rod::*;
use clebsch_models::lattices::quaternion_rod::*;

/// The number of derivatives of a [`Wide`].
const AT_ONCE: usize = 12;

const SECTIONS: usize = 5;
const NODES: usize = 6;
/// Three coordinates per node and section.
const HALF: usize = 3 * (NODES + SECTIONS);

/// The form at a state: `dx ^ dp` of positions, and for rotations and body momenta the additional term in the momentum.
fn form(momenta: &[Vector3<f64>]) -> DMatrix<f64> {
    let mut form = DMatrix::zeros(2 * HALF, 2 * HALF);
    for i in 0..HALF {
        form[(i, HALF + i)] = 1.0;
        form[(HALF + i, i)] = -1.0;
    }
    for (i, m) in momenta.iter().enumerate() {
        let hat = Matrix3::new(0.0, -m[2], m[1], m[2], 0.0, -m[0], -m[1], m[0], 0.0);
        let at = 3 * (NODES + i);
        for (r, c) in (0..3).flat_map(|r| (0..3).map(move |c| (r, c))) {
            // m . (a x b) = a . (b x m)
            form[(at + r, at + c)] = -hat[(r, c)];
        }
    }
    form
}

/// Three steps of a rod. Writes the derivatives of the final coordinates with respect to twelve of the initial ones, from `first`
/// on, to `map`, and returns the final body momenta. The compiler takes much longer for numbers with all 66 derivatives.
fn derivatives(rod: &QRod, first: usize, map: &mut DMatrix<f64>) -> Vec<Vector3<f64>> {
    let k = Wide::constant;
    let seeded = first..(first + AT_ONCE).min(2 * HALF);
    let given = rod.initial(3);
    let variable = |v: &Vector3<f64>, from: usize| {
        Vector3::from_fn(|axis, _| match seeded.contains(&(from + axis)) {
            true => Wide::variable(v[axis], from + axis - first),
            false => k(v[axis]),
        })
    };
    let mut initial = QuaternionRodInitial {
        φ: Vec::new(),
        momentum_φ: Vec::new(),
        q: Vec::new(),
        body_momentum_q: Vec::new(),
    };
    for (i, (x, p)) in given.φ.iter().zip(&given.momentum_φ).enumerate() {
        initial.φ.push(variable(x, 3 * i));
        initial.momentum_φ.push(variable(p, HALF + 3 * i));
    }
    for i in 0..SECTIONS {
        let at = 3 * (NODES + i);
        let half = variable(&Vector3::zeros(), at) * k(0.5);
        let by = UnitQuaternion::from_components([k(1.0), half[0], half[1], half[2]]);
        let own = UnitQuaternion::from_components(given.q[i].components().map(k));
        let q = own.expect("of unit length") * by.expect("of unit length");
        initial.q.push(q);
        let m = variable(&given.body_momentum_q[i].0, HALF + at);
        initial.body_momentum_q.push(BodyMomentum(m));
    }
    let model = rod.stepper_of(&k);
    let (mut state, mut work) = model.start(initial, k(0.02)).expect("starts");
    for _ in 0..3 {
        model.step(&mut state, &mut work).expect("steps");
    }
    let mut put = |row: usize, v: &Vector3<Wide>| {
        for axis in 0..3 {
            for column in seeded.clone() {
                map[(row + axis, column)] = v[axis].dual[column - first];
            }
        }
    };
    for (i, (x, p)) in state.φ().iter().zip(state.momentum_φ()).enumerate() {
        put(3 * i, x);
        put(HALF + 3 * i, p);
    }
    let mut after = Vec::new();
    for (i, (q, m)) in state.q().zip(state.body_momentum_q()).enumerate() {
        let at = 3 * (NODES + i);
        let own = UnitQuaternion::from_components(q.components().map(|x| k(x.value())));
        let change = own.expect("of unit length").inverse() * q;
        put(at, &(change.imaginary() * k(2.0)));
        put(HALF + at, &m.0);
        after.push(m.0.map(|x| x.value()));
    }
    after
}

#[test]
fn the_symplectic_form_is_kept() {
    for ends in [0, 9] {
        let rod = QRod { n: SECTIONS, ends };
        let given = rod.initial(3);
        let before: Vec<Vector3<f64>> = given.body_momentum_q.iter().map(|m| m.0).collect();
        // Final coordinates as functions of the initial ones.
        let mut map = DMatrix::zeros(2 * HALF, 2 * HALF);
        let mut after = Vec::new();
        for first in (0..2 * HALF).step_by(AT_ONCE) {
            after = derivatives(&rod, first, &mut map);
        }
        // A ring has one node fewer; the map leaves the coordinates of the missing node unchanged.
        for i in 3 * given.φ.len()..3 * NODES {
            (map[(i, i)], map[(HALF + i, HALF + i)]) = (1.0, 1.0);
        }
        let (start, end) = (form(&before), form(&after));
        let off = (map.transpose() * &end * &map - &start).amax() / map.amax().powi(2);
        // Sums of about sixty products.
        assert!(off < 1e-13, "ends {ends}: {off:e}");
        // Without the momentum term, the step does not preserve the form.
        let none = vec![Vector3::zeros(); SECTIONS];
        let (start, end) = (form(&none), form(&none));
        let off = (map.transpose() * &end * &map - &start).amax() / map.amax().powi(2);
        assert!(off > 1e-5, "ends {ends}: {off:e}");
    }
}

#[test]
fn a_free_rod_keeps_its_momenta_and_its_energy() {
    let n = 20;
    let rod = QRod { n, ends: 0 };
    let parameters = QuaternionRodParameters {
        g: Vector3::zeros(),
        ..rod.parameters(&|x| x)
    };
    let ends = QuaternionRodEnds::Open {
        first: QuaternionRodFirst::Free,
        last: QuaternionRodLast::Free,
    };
    let model = QuaternionRod::new(parameters, QuaternionRodSites { N: n, ends }).expect("a rod");
    let (mut state, mut work) = model.start(rod.initial(5), 0.02).expect("starts");
    let linear = |s: &QuaternionRodState| s.momentum_φ().iter().sum::<Vector3<f64>>();
    let angular = |s: &QuaternionRodState| {
        let places = s.φ().iter().zip(s.momentum_φ()).map(|(x, p)| x.cross(p));
        let spins = s.spatial_momentum_q().map(|m| m.0);
        places.chain(spins).sum::<Vector3<f64>>()
    };
    let (p, j, energy) = (linear(&state), angular(&state), model.energy(&state));
    let mut worst = [0.0_f64; 3];
    for _ in 0..10_000 {
        model.step(&mut state, &mut work).expect("steps");
        let off = [
            (linear(&state) - p).amax(),
            (angular(&state) - j).amax(),
            (model.energy(&state) - energy).abs() / energy,
        ];
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off);
        }
    }
    // Random walks of 1e4 rounding errors, for momenta up to one and positions up to a hundred.
    assert!(worst[0] < 1e-12 && worst[1] < 1e-10, "{worst:?}");
    assert!(worst[2] < 5e-3, "{worst:?}");
}

/// If the stiffness uses `2 u.K u` for `tr(K)/2 - K`, both rods are equal, because squaring the imaginary part of the half angle
/// gives the trace term of the full angle.
#[test]
fn the_rod_in_quaternions_is_the_one_in_rotations() {
    let second = |m: Matrix3<f64>| Matrix3::identity() * (m.trace() / 2.0) - m;
    for (ends, held) in [
        (0, [EndCondition::Free, EndCondition::Free]),
        (4, [EndCondition::Pinned, EndCondition::Pinned]),
        (8, [EndCondition::Clamped, EndCondition::Load]),
    ] {
        let (one, other) = (QRod { n: 12, ends }, Rod::new(12, Some(held)));
        let (q, r) = (one.parameters(&|x| x), other.parameters());
        let parameters = GeometricallyExactRodParameters {
            s: q.s,
            m: q.m.clone(),
            J: q.I.iter().map(|m| second(*m)).collect(),
            S: q.S,
            B: second(q.K),
            g: r.g,
        };
        let rotations = GeometricallyExactRod::new(parameters, other.sites()).expect("a rod");
        let (quaternions, given) = (one.stepper(), one.initial(2));
        let initial = GeometricallyExactRodInitial {
            φ: given.φ.clone(),
            momentum_φ: given.momentum_φ.clone(),
            Λ: given.q.iter().map(|q| q.rotation()).collect(),
            body_momentum_Λ: given.body_momentum_q.clone(),
        };
        let (mut a, mut at_a) = quaternions.start(given, 0.02).expect("starts");
        let (mut b, mut at_b) = rotations.start(initial, 0.02).expect("starts");
        for _ in 0..200 {
            quaternions.step(&mut a, &mut at_a).expect("steps");
            rotations.step(&mut b, &mut at_b).expect("steps");
        }
        let places = a.φ().iter().zip(b.φ()).map(|(x, y)| (x - y).amax());
        let turns = a.q().zip(b.Λ());
        let turns = turns.map(|(q, r)| (q.rotation().matrix() - r.matrix()).amax());
        let momenta = a.body_momentum_q().zip(b.body_momentum_Λ());
        let momenta = momenta.map(|(x, y)| (x.0 - y.0).amax());
        let off = clebsch::scalar::largest(places.chain(turns).chain(momenta));
        // Two hundred steps with a few rounding errors each, in numbers up to ten that grow with time.
        assert!(off < 1e-11, "ends {ends}: {off:e}");
    }
}

/// Stiffness and inertia that use the real part change the response to angles of size `e` by a relative `e^2`.
#[test]
fn what_goes_by_the_real_part_differs_by_the_square_of_the_angles() {
    let n = 8;
    let spins = Spins { n, ring: false };
    let own = TwistedSpinsOf::of(&spins);
    let second = |m: Matrix3<f64>| Matrix3::identity() * (m.trace() / 2.0) - m;
    let tops = CoupledTops::new(
        CoupledTopsParameters {
            s: own.s,
            J: second(own.inertia) / own.s,
            C: second(own.stiffness),
            gU: Vector3::zeros(),
            z: Vector3::z(),
        },
        CoupledTopsSites {
            N: n,
            ends: CoupledTopsEnds::Open,
        },
    );
    let tops = tops.expect("tops");
    let apart = |e: f64| {
        let mut r = Random::new(11);
        let turns: Vec<Vector3<f64>> = (0..=n).map(|_| r.vector() * e).collect();
        let momenta: Vec<_> = (0..=n).map(|_| BodyMomentum(r.vector() * e)).collect();
        let (one, mut at_one) = (own.model.clone(), Vec::new());
        let initial = own.initial(turns.iter().map(|v| turn(*v)).collect(), momenta.clone());
        let (mut a, mut work) = one.start(initial, 0.04).expect("starts");
        let initial = CoupledTopsInitial {
            Λ: turns.iter().map(Rotation::exp).collect(),
            body_momentum_Λ: momenta,
        };
        let (mut b, mut beside) = tops.start(initial, 0.04).expect("starts");
        for _ in 0..25 {
            one.step(&mut a, &mut work).expect("steps");
            tops.step(&mut b, &mut beside).expect("steps");
        }
        at_one.extend(a.body_momentum_q().zip(b.body_momentum_Λ()));
        let off = at_one.iter().map(|(x, y)| (x.0 - y.0).amax());
        clebsch::scalar::largest(off) / e
    };
    let (wide, narrow) = (apart(0.2), apart(0.1));
    let order = (wide / narrow).log2();
    println!("relative differences {wide:e} and {narrow:e}: order {order}");
    assert!((1.9..2.1).contains(&order), "{wide:e} {narrow:e}: {order}");
}

#[test]
fn signs_that_are_given_change_nothing_but_themselves() {
    for ends in 0..10 {
        let rod = QRod { n: 12, ends };
        let (stepper, mut given) = (rod.stepper(), rod.initial(6));
        let mut other = given.clone();
        for (i, (one, other)) in given.q.iter_mut().zip(&mut other.q).enumerate() {
            let sign = if i * i % 5 < 2 { -1.0 } else { 1.0 };
            let q = one.components();
            *one = UnitQuaternion::from_components(q).expect("unit");
            *other = UnitQuaternion::from_components(q.map(|x| x * sign)).expect("unit");
        }
        let (mut a, mut at_a) = stepper.start(given, 0.02).expect("starts");
        let (mut b, mut at_b) = stepper.start(other, 0.02).expect("starts");
        for _ in 0..20 {
            stepper.step(&mut a, &mut at_a).expect("steps");
            stepper.step(&mut b, &mut at_b).expect("steps");
        }
        assert!(a.φ() == b.φ() && a.momentum_φ() == b.momentum_φ());
        assert!(a.body_momentum_q().eq(b.body_momentum_q()));
        let agree = |s: &QuaternionRodState| {
            let q: Vec<UnitQuaternion> = s.q().collect();
            q.windows(2).all(|w| (w[0].inverse() * w[1]).real() > 0.0)
        };
        assert!(agree(&a) && agree(&b));
    }
}

/// Sections along a circle rotate once around. A chain whose terms ignore the quaternion sign accepts this ring; a chain whose
/// terms depend on the sign rejects it.
#[test]
fn a_ring_with_an_odd_number_of_turns_is_told_where_a_term_sees_it() {
    let n = 12;
    let around = |turns: f64| -> Vec<UnitQuaternion> {
        let angle = |i: usize| std::f64::consts::TAU * turns * i as f64 / n as f64;
        (0..n).map(|i| turn(Vector3::x() * angle(i))).collect()
    };
    let rod = QRod { n, ends: 9 };
    let initial = QuaternionRodInitial {
        q: around(1.0),
        ..rod.initial(1)
    };
    rod.stepper().start(initial, 1e-3).expect("starts");
    let own = TwistedSpinsOf::of(&Spins { n, ring: true });
    let still = vec![BodyMomentum(Vector3::zeros()); n];
    for (turns, is_told) in [(0.0, false), (1.0, true), (2.0, false), (3.0, true)] {
        let started = own
            .model
            .start(own.initial(around(turns), still.clone()), 1e-3);
        let told = started.map(|_| ()).map_err(|e| e.to_string());
        assert_eq!(told.is_err(), is_told, "{turns}: {told:?}");
        if let Err(told) = told {
            assert!(told.contains("an odd number of turns"), "{told}");
        }
    }
}
