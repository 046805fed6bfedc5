//! Ensembles: compares many bodies in lanes with each body alone, for any number of lanes and threads, task size and instruction
//! set. Also checks which body the error names if one fails.

use clebsch::integrate::{Ensemble, InstructionSet, Model, Stepper};
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::solvers::moser_veselov::Order;
use clebsch::{
    BodyImpulse, BodyMomentum, BodyMomentumMatrix, OfScalars, Orthogonal, RigidMotion, Rotation,
    StartError, StepCause, UnitQuaternion,
};
use clebsch_models::body_n::{BodyN, BodyNInitial, BodyNParameters};
use clebsch_models::cayley_klein::{CayleyKlein, CayleyKleinInitial, CayleyKleinParameters};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters,
};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::heavy_top::{HeavyTop, HeavyTopInitial, HeavyTopParameters};
use clebsch_models::kirchhoff_body::{
    KirchhoffBody, KirchhoffBodyInitial, KirchhoffBodyParameters,
};
use clebsch_oracle::physics::measure::worse;
use rand_xoshiro::Xoshiro256StarStar;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

clebsch::model! {
    /// A top in a quadratic field, on a hinge that stiffens: in no gallery, stepped by Newton.
    model HingedTop {
        param J: Sym<3>;
        param K: Sym<3>;
        param c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(Γ, K*Γ)/2 + (c/h)*tr(Ω - Id)^2;
    }
}

/// Step size of all runs.
const H: f64 = 0.1;

/// Number of bodies, not a multiple of any lane count in use.
const BODIES: usize = 21;

/// Random numbers in [-1, 1].
struct Draw(Xoshiro256StarStar);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256StarStar::seed_from_u64(seed))
    }

    fn number(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector<const N: usize>(&mut self) -> SVector<f64, N> {
        SVector::from_fn(|_, _| self.number())
    }

    fn rotation(&mut self) -> Rotation {
        Rotation::exp(&(self.vector() * 2.0))
    }

    /// A random symmetric matrix with eigenvalues in [1, 2].
    fn positive(&mut self) -> Matrix3<f64> {
        let r = self.rotation().matrix();
        let d = self.vector::<3>().map(|x| 1.5 + 0.5 * x);
        let a = r * Matrix3::from_diagonal(&d) * r.transpose();
        (a + a.transpose()) * 0.5
    }
}

fn list<X>(seed: u64, count: usize, mut one: impl FnMut(&mut Draw) -> X) -> Vec<X> {
    let mut draw = Draw::new(seed);
    (0..count).map(|_| one(&mut draw)).collect()
}

fn free_bodies(count: usize) -> Vec<(FreeBodyParameters, FreeBodyInitial)> {
    list(1, count, |x| {
        let initial = FreeBodyInitial {
            Λ: x.rotation(),
            body_momentum: BodyMomentum(x.vector()),
        };
        (FreeBodyParameters { J: x.positive() }, initial)
    })
}

fn heavy_tops(count: usize) -> Vec<(HeavyTopParameters, HeavyTopInitial)> {
    list(2, count, |x| {
        let parameters = HeavyTopParameters {
            J: x.positive(),
            gU: x.vector(),
            z: x.vector::<3>().normalize(),
        };
        let initial = HeavyTopInitial {
            Λ: x.rotation(),
            body_momentum: BodyMomentum(x.vector()),
        };
        (parameters, initial)
    })
}

fn hinged_tops(count: usize) -> Vec<(HingedTopParameters, HingedTopInitial)> {
    list(3, count, |x| {
        let parameters = HingedTopParameters {
            J: x.positive(),
            K: x.positive(),
            c: 0.1 * x.number(),
        };
        let initial = HingedTopInitial {
            Λ: x.rotation(),
            body_momentum: BodyMomentum(x.vector()),
            Γ: x.vector::<3>().normalize(),
        };
        (parameters, initial)
    })
}

fn coupled_bodies(count: usize) -> Vec<(CoupledBodiesParameters, CoupledBodiesInitial)> {
    list(4, count, |x| {
        let parameters = CoupledBodiesParameters {
            J1: x.positive(),
            J2: x.positive(),
            d1: x.vector(),
            d2: x.vector(),
            eps: 0.1,
        };
        let initial = CoupledBodiesInitial {
            Λ1: x.rotation(),
            body_momentum_Λ1: BodyMomentum(x.vector()),
            Λ2: x.rotation(),
            body_momentum_Λ2: BodyMomentum(x.vector()),
        };
        (parameters, initial)
    })
}

/// All scalars of a body.
fn numbers<X: OfScalars<Scalar = f64>>(x: &X) -> Vec<f64> {
    let mut all = Vec::new();
    let _ = x.over(&mut |x: f64| {
        all.push(x);
        x
    });
    all
}

/// The states after `steps` steps, each body alone.
fn alone<M: Model<Scalar = f64>>(
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
    steps: u64,
) -> Vec<Vec<f64>> {
    let run = |(parameters, initial): &(M::Parameters, M::Initial)| {
        let model = M::of(*parameters).expect("admissible");
        let mut state = model.begin(*initial).expect("admissible");
        let mut workspace = model.prepare(&state, H, choice).expect("solvable");
        model
            .advance_many(&mut state, &mut workspace, steps)
            .expect("solvable");
        assert_eq!(M::node(&state), steps);
        numbers(&state)
    };
    bodies.iter().map(run).collect()
}

fn ensemble<M: Model<Scalar = f64>, const N: usize>(
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
) -> Ensemble<M, N> {
    Ensemble::start_with(bodies.iter().copied(), H, choice).expect("admissible")
}

fn states<M: Model<Scalar = f64>, const N: usize>(ensemble: &Ensemble<M, N>) -> Vec<Vec<f64>> {
    ensemble
        .bodies()
        .map(|(_, state)| numbers(&state))
        .collect()
}

/// The states after `steps` steps, in lanes.
fn together<M: Model<Scalar = f64>, const N: usize>(
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
    steps: u64,
) -> Vec<Vec<f64>> {
    let mut ensemble = ensemble::<M, N>(bodies, choice);
    ensemble.run(steps).expect("solvable");
    states(&ensemble)
}

/// The largest difference between two runs.
fn gap(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b).flat_map(|(x, y)| {
        assert_eq!(x.len(), y.len());
        x.iter().zip(y)
    });
    pairs.fold(0.0, |worst, (x, y)| {
        let d = (x - y).abs();
        // NaN counts as the largest difference.
        if d <= worst { worst } else { d }
    })
}

/// The difference after `steps` steps between bodies in lanes and bodies alone, for 4 and 8 lanes.
fn gaps<M: Model<Scalar = f64>>(
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
    steps: u64,
) -> f64 {
    let wanted = alone::<M>(bodies, choice, steps);
    let four = gap(&together::<M, 4>(bodies, choice, steps), &wanted);
    let eight = gap(&together::<M, 8>(bodies, choice, steps), &wanted);
    worse(four, eight)
}

/// Like `gaps`, but in 4 lanes only: each lane count compiles the model again. For tests in which the lane count does not matter.
fn gap_in_four<M: Model<Scalar = f64>>(
    bodies: &[(M::Parameters, M::Initial)],
    choice: M::Choice,
    steps: u64,
) -> f64 {
    let wanted = alone::<M>(bodies, choice, steps);
    gap(&together::<M, 4>(bodies, choice, steps), &wanted)
}

#[test]
fn explicit_steps_side_by_side_are_those_alone_bit_for_bit() {
    let bodies = free_bodies(BODIES);
    for order in Order::ALL {
        assert_eq!(gaps::<FreeBody>(&bodies, order, 1000), 0.0, "order {order}");
    }
}

#[test]
fn quartics_side_by_side_are_those_alone_bit_for_bit() {
    let slow = heavy_tops(BODIES);
    assert_eq!(gaps::<HeavyTop>(&slow, None, 1000), 0.0);
    // Momenta up to nearly the largest that the step admits, so that lanes mix slow and fast bodies. In some lanes the root then
    // takes more than one iteration, or converges slowly.
    let mut fast = slow;
    for (i, (_, initial)) in fast.iter_mut().enumerate() {
        let length = 10f64.powf(i as f64 / 15.0 - 0.1);
        initial.body_momentum.0 = initial.body_momentum.0.normalize() * length;
    }
    assert_eq!(gaps::<HeavyTop>(&fast, None, 1000), 0.0);
}

#[test]
fn newton_steps_in_ensembles_are_those_alone_bit_for_bit() {
    assert_eq!(gap_in_four::<HingedTop>(&hinged_tops(BODIES), (), 100), 0.0);
    assert_eq!(
        gap_in_four::<CoupledBodies>(&coupled_bodies(BODIES), (), 100),
        0.0
    );
    // Newton iterations differ from body to body, so these models step one body at a time; models without iteration share lanes.
    let apart = [
        HingedTop::<f64>::SIDE_BY_SIDE,
        CoupledBodies::<f64>::SIDE_BY_SIDE,
    ];
    let together = [FreeBody::<f64>::SIDE_BY_SIDE, HeavyTop::<f64>::SIDE_BY_SIDE];
    assert_eq!((apart, together), ([false; 2], [true; 2]));
}

#[test]
fn bodies_that_step_alone_fail_as_those_in_lanes_do() {
    let mut bodies = hinged_tops(BODIES);
    bodies[17].0.K *= 3000.0;
    let mut ensemble = Ensemble::<HingedTop, 4>::start(bodies.clone(), H).expect("slow at first");
    let before = states(&ensemble);
    let refused = ensemble.run(200).expect_err("too stiff");
    assert_eq!((refused.body, refused.among, refused.failed), (17, 1, 1));
    for (i, state) in states(&ensemble).iter().enumerate() {
        let stays = (16..20).contains(&i);
        assert_eq!(*state == before[i], stays, "body {i}");
    }
    // `observe` evaluates energies in lanes.
    let energies: Vec<f64> = ensemble.observe(|m, s| m.energy(s)).collect();
    for (i, (parameters, state)) in ensemble.bodies().enumerate() {
        let model = HingedTop::new(parameters).expect("admissible");
        assert_eq!(energies[i], model.energy(&state), "body {i}");
    }
}

#[test]
fn every_group_is_gathered_and_scattered() {
    let quaternions = list(5, BODIES, |x| {
        let [w, a, b, c] = x.rotation().quaternion();
        let initial = CayleyKleinInitial {
            q: UnitQuaternion::from_components([w, a, b, c]).expect("unit"),
            body_momentum: BodyMomentum(x.vector()),
        };
        let moments = x.vector::<3>().map(|m| 2.5 + 0.5 * m);
        let parameters = CayleyKleinParameters {
            I: Matrix3::from_diagonal(&moments),
            c: 1.0 + 0.1 * x.number(),
        };
        (parameters, initial)
    });
    let motions = list(6, BODIES, |x| {
        let parameters = KirchhoffBodyParameters {
            J: x.positive(),
            M: x.positive(),
            D: Matrix3::from_fn(|_, _| 0.1 * x.number()),
            b: SVector::from([0.1 * x.number(), 0.1, 0.0, 0.0]),
            Z: SVector::from([0.0, 0.0, 1.0, 0.0]),
        };
        let initial = KirchhoffBodyInitial {
            G: RigidMotion {
                rotation: x.rotation(),
                translation: x.vector(),
            },
            body_momentum: BodyImpulse(x.vector() * 0.5),
        };
        (parameters, initial)
    });
    let matrices = list(7, BODIES, |x| {
        let mut skew = SMatrix::<f64, 4, 4>::from_fn(|_, _| x.number());
        skew = (skew - skew.transpose()) * 0.5;
        let diagonal = x.vector::<4>().map(|c| 1.5 + 0.5 * c);
        let initial = BodyNInitial {
            Λ: Orthogonal::identity(),
            body_momentum: BodyMomentumMatrix(skew),
        };
        let parameters = BodyNParameters::<4> {
            C: SMatrix::from_diagonal(&diagonal),
        };
        (parameters, initial)
    });
    for (name, gap) in [
        ("SU(2)", gap_in_four::<CayleyKlein>(&quaternions, (), 100)),
        ("SE(3)", gap_in_four::<KirchhoffBody>(&motions, (), 100)),
        ("SO(4)", gap_in_four::<BodyN<4>>(&matrices, None, 100)),
    ] {
        assert_eq!(gap, 0.0, "{name}");
    }
}

/// Checks that the comparison detects two exchanged bodies, and one scalar of one body changed by one rounding error.
#[test]
fn a_wrong_lane_is_seen() {
    let (bodies, steps) = (free_bodies(BODIES), 200);
    let right = alone::<FreeBody>(&bodies, Order::Two, steps);
    let mut exchanged = bodies.clone();
    exchanged.swap(8, 9);
    let found = together::<FreeBody, 8>(&exchanged, Order::Two, steps);
    assert!(gap(&found, &right) > 0.1);
    let mut nudged = bodies;
    nudged[13].1.body_momentum.0.x *= 1.0 + f64::EPSILON;
    let found = together::<FreeBody, 8>(&nudged, Order::Two, steps);
    let wrong: Vec<usize> = (0..BODIES).filter(|i| found[*i] != right[*i]).collect();
    assert_eq!(wrong, [13]);
    // The comparison also detects a change in bodies that step one at a time.
    let bodies = hinged_tops(BODIES);
    let right = alone::<HingedTop>(&bodies, (), 100);
    let mut nudged = bodies;
    nudged[20].0.K *= 1.0 + 1e-9;
    let found = together::<HingedTop, 4>(&nudged, (), 100);
    let wrong: Vec<usize> = (0..BODIES).filter(|i| found[*i] != right[*i]).collect();
    assert_eq!(wrong, [20]);
}

#[test]
fn threads_tasks_and_instructions_do_not_matter() {
    fn check<M: Model<Scalar = f64>>(bodies: &[(M::Parameters, M::Initial)], choice: M::Choice) {
        let start = || ensemble::<M, 4>(bodies, choice);
        let mut one = start();
        one.run(100).expect("solvable");
        let wanted = states(&one);
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.expect("threads");
            for block in [1, 3, 1000] {
                let mut many = start().with_block(block);
                pool.install(|| many.run_parallel(100)).expect("solvable");
                assert_eq!(states(&many), wanted, "{threads} threads, block {block}");
            }
        }
        for set in [
            InstructionSet::Build,
            InstructionSet::Avx2,
            InstructionSet::Best,
        ] {
            let mut other = start().with_instructions(set);
            other.run(100).expect("solvable");
            assert_eq!(states(&other), wanted, "{set:?}");
        }
        // The same run, split into several calls.
        let mut pieces = start();
        for count in [1, 0, 36, 63] {
            pieces.run(count).expect("solvable");
        }
        assert_eq!(states(&pieces), wanted);
    }
    check::<FreeBody>(&free_bodies(50), Order::Ten);
    check::<HeavyTop>(&heavy_tops(50), None);
    check::<HingedTop>(&hinged_tops(50), ());
}

#[test]
fn bodies_can_be_taken_out_and_go_on() {
    let bodies = heavy_tops(BODIES);
    let whole = together::<HeavyTop, 8>(&bodies, None, 100);
    let mut first = ensemble::<HeavyTop, 8>(&bodies, None);
    first.run(60).expect("solvable");
    assert_eq!((first.len(), first.is_empty()), (BODIES, false));
    assert!(first.body(BODIES).is_none());
    // One body is ahead of the others.
    let mut taken: Vec<_> = first.bodies().collect();
    let model = HeavyTop::new(taken[3].0).expect("admissible");
    let mut workspace = model.workspace(&taken[3].1, H).expect("solvable");
    model
        .step(&mut taken[3].1, &mut workspace)
        .expect("solvable");
    let mut second = Ensemble::<HeavyTop, 4>::resume(taken, H, None).expect("solvable");
    second.run(40).expect("solvable");
    let nodes: Vec<u64> = second.bodies().map(|(_, s)| s.node()).collect();
    assert!((0..BODIES).all(|i| nodes[i] == if i == 3 { 101 } else { 100 }));
    let energies: Vec<f64> = second.observe(|m, s| m.energy(s)).collect();
    for (i, (parameters, state)) in second.bodies().enumerate() {
        let energy = HeavyTop::new(parameters)
            .expect("admissible")
            .energy(&state);
        assert_eq!(energies[i], energy, "body {i}");
        // The start recomputes the momentum of the edge, with one rounding error.
        let gap = gap(&[numbers(&state)], &[whole[i].clone()]);
        assert!(i == 3 || gap < 1e-13, "body {i}: {gap:e}");
    }
    assert_eq!(energies.len(), BODIES);
    let none = Ensemble::<HeavyTop, 4>::start([], H).expect("nothing to refuse");
    assert!(none.is_empty());
}

#[test]
fn the_body_that_fails_is_named() {
    // An inadmissible body in an incomplete group of lanes.
    let mut bodies = heavy_tops(BODIES);
    bodies[18].0.gU.x = f64::NAN;
    let refused = Ensemble::<HeavyTop, 8>::start(bodies, H).expect_err("NaN");
    assert_eq!((refused.body, refused.failed), (18, 1));
    assert!(
        refused.to_string().starts_with("body at index 18: "),
        "{refused}"
    );
    // The momentum is too large for the step size.
    let mut bodies = heavy_tops(BODIES);
    bodies[11].1.body_momentum.0 *= 1e3;
    let refused = Ensemble::<HeavyTop, 8>::start(bodies, H).expect_err("too fast");
    assert_eq!((refused.body, refused.among), (11, 1));
    assert!(matches!(
        refused.cause,
        StartError::Refused(StepCause::MoserVeselov(_))
    ));
    // Heavy bodies fall until the step size is too large for them.
    let mut bodies = heavy_tops(BODIES);
    for heavy in [5, 13] {
        bodies[heavy].0.gU *= 150.0;
    }
    let mut ensemble = Ensemble::<HeavyTop, 4>::start(bodies.clone(), H).expect("slow at first");
    let before: Vec<_> = ensemble.bodies().map(|(_, state)| state).collect();
    let refused = ensemble.run(200).expect_err("too fast");
    assert_eq!((refused.body, refused.among, refused.failed), (5, 1, 2));
    // The error equals the error of this body alone.
    let model = HeavyTop::new(bodies[5].0).expect("admissible");
    let (mut state, mut workspace) = model.start(bodies[5].1, H).expect("slow at first");
    let alone = model.advance_many(&mut state, &mut workspace, 200);
    assert_eq!(alone.expect_err("too fast"), refused.cause);
    assert!(
        refused.to_string().ends_with("(2 bodies failed)"),
        "{refused}"
    );
    // Bodies in the same lanes as the failed ones keep their state; all others complete their steps.
    for (i, (_, state)) in ensemble.bodies().enumerate() {
        let stays = (4..8).contains(&i) || (12..16).contains(&i);
        assert_eq!(state == before[i], stays, "body {i}");
        assert_eq!(state.node(), if stays { 0 } else { 200 }, "body {i}");
    }
}

#[test]
fn a_body_at_rest_disturbs_no_one() {
    let mut bodies = free_bodies(BODIES);
    bodies[2].1.body_momentum.0 = Vector3::zeros();
    assert_eq!(gaps::<FreeBody>(&bodies, Order::Two, 200), 0.0);
}
