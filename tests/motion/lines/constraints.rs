//! Enforced constraints along chains: rejected starts and their sites, conserved quantities, and the symplectic form on the
//! constraint set.

use super::models::{Chain, Ends, Kirchhoff, Random, Wide};
use clebsch::Real;
use clebsch::line::LineError;
use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::{BodyMomentum, Rotation, Snapshot, StepCause};
use clebsch_models::lattices::hanging_chain::*;
use clebsch_models::lattices::kirchhoff_rod::*;

/// The site that the error of a start names.
fn at_site(told: &LineError) -> usize {
    match told {
        LineError::Site { at, .. } | LineError::Step { at, .. } => at.site,
        other => panic!("{other}"),
    }
}

#[test]
fn data_off_the_constraints_are_refused_at_their_site() {
    let rod = Kirchhoff {
        n: 12,
        ends: Ends::Open(0, 0),
    };
    let stepper = rod.stepper();
    let mut initial = rod.initial(1);
    initial.Λ[7] = initial.Λ[7] * Rotation::exp(&Vector3::new(1e-4, 0.0, 0.0));
    let told = stepper.start(initial, 0.02).expect_err("is off");
    assert_eq!(at_site(&told), 7, "{told}");
    assert!(
        told.to_string().contains("violates the constraint"),
        "{told}"
    );
    let mut initial = rod.initial(1);
    initial.momentum_φ[5] += Vector3::new(0.3, 0.0, 0.0);
    let told = stepper.start(initial, 0.02).expect_err("is across");
    assert!((4..=5).contains(&at_site(&told)), "{told}");
    assert!(
        told.to_string()
            .contains("is not tangent to the constraint"),
        "{told}"
    );
}

#[test]
fn constraints_that_follow_from_others_are_refused() {
    // Two links between the same beads.
    let parameters = HangingChainParameters {
        m: vec![1.0; 2],
        a: vec![0.5; 2],
        g: Vector3::zeros(),
    };
    let sites = HangingChainSites {
        N: 2,
        ends: HangingChainEnds::Ring,
    };
    let ring = HangingChain::new(parameters, sites).expect("a ring");
    let initial = HangingChainInitial {
        x: vec![Vector3::zeros(), Vector3::x() * 0.5],
        momentum_x: vec![Vector3::zeros(); 2],
    };
    let told = ring.start(initial, 0.01).expect_err("one distance twice");
    assert!(told.to_string().contains("not determined"), "{told}");
    // A closed chain with collinear links, and a taut chain between two fixed beads.
    for (n, ends) in [
        (4, HangingChainEnds::Ring),
        (
            5,
            HangingChainEnds::Open {
                first: HangingChainFirst::Pinned,
                last: HangingChainLast::Pinned,
            },
        ),
    ] {
        let ring = ends == HangingChainEnds::Ring;
        let nodes = n + usize::from(!ring);
        let place = |i: usize| {
            if ring {
                [0.0, 0.5, 1.0, 0.5][i]
            } else {
                0.5 * i as f64
            }
        };
        let parameters = HangingChainParameters {
            m: vec![1.0; nodes],
            a: vec![0.5; n],
            g: Vector3::new(0.0, 0.0, -1.0),
        };
        let chain =
            HangingChain::new(parameters, HangingChainSites { N: n, ends }).expect("a chain");
        let initial = HangingChainInitial {
            x: (0..nodes)
                .map(|i| Vector3::new(0.6, 0.0, 0.8) * place(i))
                .collect(),
            momentum_x: vec![Vector3::zeros(); nodes],
        };
        let told = chain
            .start(initial, 0.01)
            .expect_err("they lie on one line");
        assert!(told.to_string().contains("not determined"), "{told}");
    }
    // One section between fixed positions, and a ring of one section.
    for ends in [Ends::Open(1, 1), Ends::Ring] {
        let rod = Kirchhoff { n: 1, ends };
        let told = rod
            .stepper()
            .start(rod.initial(0), 0.02)
            .expect_err("turns alone");
        assert!(told.to_string().contains("not determined"), "{told}");
    }
}

#[test]
fn a_step_that_is_too_long_leaves_the_state_and_names_a_shorter_one() {
    let chain = Chain { n: 8, ends: 0 };
    let (stepper, initial) = (chain.stepper(), chain.initial(2));
    let (state, _) = stepper.start(initial.clone(), 0.01).expect("starts");
    let mut moved = state.clone();
    let mut work = stepper.workspace(&state, 40.0).expect("a workspace");
    let told = stepper.step(&mut moved, &mut work).expect_err("too long");
    assert!(moved == state);
    let LineError::Step {
        at, cause, works, ..
    } = told
    else {
        panic!("{told}");
    };
    assert!(at.quantity == "λ" && at.site < 8, "{told}");
    assert!(matches!(cause, StepCause::NoReaction(_)), "{told}");
    let works = works.expect("a shorter step");
    let mut work = stepper.workspace(&state, works).expect("a workspace");
    stepper.step(&mut moved, &mut work).expect("steps");
    assert_eq!(moved.node(), 1);
}

#[test]
fn a_free_rod_keeps_its_momenta_its_constraints_and_its_energy() {
    let n = 20;
    let parameters = KirchhoffRodParameters {
        s: 0.5,
        m: vec![0.6; n + 1],
        J: vec![Matrix3::from_diagonal(&Vector3::new(0.3, 0.4, 0.5)); n],
        B: Matrix3::from_diagonal(&Vector3::new(0.5, 0.4, 0.7)),
        g: Vector3::zeros(),
    };
    let ends = KirchhoffRodEnds::Open {
        first: KirchhoffRodFirst::Free,
        last: KirchhoffRodLast::Free,
    };
    let model = KirchhoffRod::new(parameters, KirchhoffRodSites { N: n, ends }).expect("a rod");
    let rod = Kirchhoff {
        n,
        ends: Ends::Open(0, 0),
    };
    let mut initial = rod.initial(5);
    // The momenta of these velocities, with these masses and moments.
    let turning = Matrix3::from_diagonal(&Vector3::new(0.9, 0.8, 0.7)) * 0.5;
    let mut r = Random::new(9);
    let mut v = r.vector() * 0.3;
    for i in 0..n {
        let (turn, spin) = (initial.Λ[i].matrix(), r.vector());
        initial.momentum_φ[i] = v * 0.6;
        v += turn * spin.cross(&Vector3::z()) * 0.5;
        initial.body_momentum_Λ[i] = BodyMomentum(turning * spin);
    }
    initial.momentum_φ[n] = v * 0.6;
    let (mut state, mut work) = model.start(initial, 0.02).expect("starts");
    let linear = |s: &KirchhoffRodState| s.momentum_φ().iter().sum::<Vector3<f64>>();
    let angular = |s: &KirchhoffRodState| {
        let places = s.φ().iter().zip(s.momentum_φ()).map(|(x, p)| x.cross(p));
        let spins = s.spatial_momentum_Λ().map(|m| m.0);
        places.chain(spins).sum::<Vector3<f64>>()
    };
    let (p, j, energy) = (linear(&state), angular(&state), model.energy(&state));
    let mut worst = [0.0_f64; 5];
    for _ in 0..10_000 {
        model.step(&mut state, &mut work).expect("steps");
        let off = [
            (linear(&state) - p).amax(),
            (angular(&state) - j).amax(),
            model.constraint_n(&state),
            model.constraint_rate_n(&state),
            (model.energy(&state) - energy).abs() / energy,
        ];
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off);
        }
    }
    // Random walks of 1e4 rounding errors, for momenta up to ten and positions up to a hundred.
    assert!(worst[0] < 2e-12 && worst[1] < 1e-10, "{worst:?}");
    // Twenty segments, each with thirty-two rounding errors of positions up to sixty; the total grows like the square root.
    assert!(worst[2] < 2e-11 && worst[3] < 1e-12, "{worst:?}");
    assert!(worst[4] < 5e-3, "{worst:?}");
    assert!(state.n().len() == n && state.n().iter().all(|n| n.norm() > 1e-6));
}

#[test]
fn a_held_state_is_kept_with_its_multipliers() {
    let chain = Chain { n: 6, ends: 1 };
    let stepper = chain.stepper();
    let (mut state, mut work) = stepper.start(chain.initial(1), 0.01).expect("starts");
    let (mut again, _) = (state.clone(), ());
    for _ in 0..5 {
        stepper.step(&mut state, &mut work).expect("steps");
    }
    assert!(again.λ().iter().all(|λ| λ[0] == 0.0) && state.λ().iter().all(|λ| λ[0] != 0.0));
    let bytes = Snapshot::of(&state).expect("is kept").to_bytes();
    let kept = Snapshot::from_bytes(&bytes).expect("is read");
    kept.put_into(&mut again).expect("fits");
    assert!(again == state);
}

/// At equilibrium, the tension in a hanging chain equals the weight below.
#[test]
fn multipliers_are_forces() {
    let (n, a) = (10, 0.3);
    let parameters = HangingChainParameters {
        m: vec![0.2; n + 1],
        a: vec![a; n],
        g: Vector3::new(0.0, 0.0, -9.0),
    };
    let ends = HangingChainEnds::Open {
        first: HangingChainFirst::Pinned,
        last: HangingChainLast::Free,
    };
    let chain = HangingChain::new(parameters, HangingChainSites { N: n, ends }).expect("a chain");
    let initial = HangingChainInitial {
        x: (0..=n)
            .map(|i| Vector3::new(0.0, 0.0, -a * i as f64))
            .collect(),
        momentum_x: vec![Vector3::zeros(); n + 1],
    };
    let (mut state, mut work) = chain.start(initial, 0.01).expect("starts");
    chain.step(&mut state, &mut work).expect("steps");
    for (i, λ) in state.λ().iter().enumerate() {
        // The gradient of the squared length is twice the link vector.
        let (tension, weight) = (-2.0 * λ[0] * a, 0.2 * 9.0 * (n - i) as f64);
        assert!(
            (tension - weight).abs() < 1e-12 * weight,
            "{i}: {tension} {weight}"
        );
    }
}

/// The form `dx ^ dp` of two beads and their link, pulled back to the ten coordinates of the constraint set, before and after a
/// run.
#[test]
fn the_symplectic_form_on_the_constraints_is_kept() {
    let k = Wide::constant;
    let start = |u: &[Wide]| -> [Vector3<Wide>; 4] {
        let (sin, cos) = ([u[3].sin(), u[4].sin()], [u[3].cos(), u[4].cos()]);
        let link = Vector3::new(sin[0] * cos[1], sin[0] * sin[1], cos[0]) * k(0.7);
        let across = [
            Vector3::new(cos[0] * cos[1], cos[0] * sin[1], -sin[0]),
            Vector3::new(-sin[1], cos[1], k(0.0)),
        ];
        let (x, v) = (
            Vector3::new(u[0], u[1], u[2]),
            Vector3::new(u[5], u[6], u[7]),
        );
        let turned = v + (across[0] * u[8] + across[1] * u[9]) * k(0.7);
        [x, x + link, v * k(1.2), turned * k(0.8)]
    };
    let form = |all: &[Vector3<Wide>; 4]| {
        let [x, y, p, q] = all;
        SMatrix::<f64, 10, 10>::from_fn(|i, j| {
            let pair = |x: &Vector3<Wide>, p: &Vector3<Wide>| -> f64 {
                (0..3)
                    .map(|a| x[a].dual[i] * p[a].dual[j] - x[a].dual[j] * p[a].dual[i])
                    .sum()
            };
            pair(x, p) + pair(y, q)
        })
    };
    let mut r = Random::new(3);
    let u: Vec<Wide> = (0..10)
        .map(|i| Wide::variable(0.5 + 0.4 * r.number(), i))
        .collect();
    let begin = start(&u);
    let parameters = HangingChainParameters {
        m: vec![k(1.2), k(0.8)],
        a: vec![k(0.7)],
        g: Vector3::new(0.1, 0.2, -0.8).map(k),
    };
    let ends = HangingChainEnds::Open {
        first: HangingChainFirst::Free,
        last: HangingChainLast::Free,
    };
    let chain = HangingChain::new(parameters, HangingChainSites { N: 1, ends }).expect("a chain");
    let initial = HangingChainInitial {
        x: vec![begin[0], begin[1]],
        momentum_x: vec![begin[2], begin[3]],
    };
    let (mut state, mut work) = chain.start(initial, k(0.05)).expect("starts");
    for _ in 0..5 {
        chain.step(&mut state, &mut work).expect("steps");
    }
    let (x, p) = (state.x(), state.momentum_x());
    let (before, after) = (form(&begin), form(&[x[0], x[1], p[0], p[1]]));
    let off = (after - before).amax() / before.amax();
    assert!(off < 1e-13, "{off:e}");
    // The chain has moved.
    assert!((x[0] - begin[0]).map(|x| x.value()).amax() > 0.05);
    // A momentum with an additional impulse along the link breaks the form.
    let pushed = p[1] + (x[1] - x[0]) * (x[1] - x[0]).dot(&p[0]) * k(1e-3);
    let wrong = form(&[x[0], x[1], p[0], pushed]);
    assert!((wrong - before).amax() / before.amax() > 1e-5);
}

/// Many sites: every constraint holds, with one shared workspace.
#[test]
fn long_lines_are_held() {
    let n = 20_000;
    let rod = Kirchhoff {
        n,
        ends: Ends::Open(0, 0),
    };
    let start = |threads| {
        let stepper = rod.stepper().with_threads(threads);
        let (mut state, mut work) = stepper.start(rod.initial(3), 1e-3).expect("starts");
        for _ in 0..5 {
            stepper.step(&mut state, &mut work).expect("steps");
        }
        let size = stepper.constraint_size_n(&state);
        let off = stepper.constraint_n(&state);
        assert!(off < 32.0 * f64::EPSILON * size, "{off:e} of {size:e}");
        state
    };
    // The number of threads does not change a bit.
    assert!(start(1) == start(3));
}
