//! Generated steppers on SU(2) and SE(3): reference states, the double cover of SO(3), conserved
//! momenta, bounded energies, measured orders, reversibility, every scalar, no allocation.

use super::allocations::allocations;
use super::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, SVector, Vector3, Vector4};
use clebsch::{
    BodyImpulse, BodyMomentum, DoubleDouble, Group, Lanes, Real, RigidMotion, Rotation,
    SpatialMomentum, UnitQuaternion,
};
use clebsch_models::cayley_klein::{CayleyKlein, CayleyKleinInitial, CayleyKleinParameters};
use clebsch_models::cayley_klein_spatial::{
    CayleyKleinSpatial, CayleyKleinSpatialInitial, CayleyKleinSpatialParameters,
};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::kirchhoff_body::{
    KirchhoffBody, KirchhoffBodyInitial, KirchhoffBodyParameters, KirchhoffBodyState,
    KirchhoffBodyWorkspace,
};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::order::confirms;
use clebsch_oracle::reference::quaternion::{
    M0, MOMENTS, MOMENTUM_C0, MOMENTUM_C1, QUATERNION_C0, QUATERNION_C1,
};
use clebsch_oracle::reference::{H, NODES, TOLERANCE};

fn lifted<T: Real, const R: usize>(v: &SVector<f64, R>) -> SVector<T, R> {
    v.map(T::from_f64)
}

fn diagonal<T: Real>(d: [f64; 3]) -> Matrix3<T> {
    Matrix3::from_diagonal(&Vector3::from(d.map(T::from_f64)))
}

fn body<T: Real>(
    moments: [f64; 3],
    c: f64,
    momentum: [f64; 3],
    h: f64,
) -> (
    CayleyKlein<T>,
    clebsch_models::cayley_klein::CayleyKleinState<T>,
    clebsch_models::cayley_klein::CayleyKleinWorkspace<T>,
) {
    let model = CayleyKlein::new(CayleyKleinParameters {
        I: diagonal(moments),
        c: T::from_f64(c),
    })
    .expect("a body");
    let initial = CayleyKleinInitial {
        q: UnitQuaternion::identity(),
        body_momentum: BodyMomentum(lifted(&Vector3::from(momentum))),
    };
    let (state, work) = model.start(initial, T::from_f64(h)).expect("solvable");
    (model, state, work)
}

/// The largest deviation from the recorded states.
fn deviation(c: f64, quaternions: [[f64; 4]; 4], momenta: [[f64; 3]; 4]) -> f64 {
    let (model, mut state, mut work) = body::<f64>(MOMENTS, c, M0, H);
    let mut worst: f64 = 0.0;
    for k in 1..=1000 {
        model.step(&mut state, &mut work).expect("solvable");
        if let Some(i) = NODES.iter().position(|n| *n == k) {
            let (q, mu) = (state.q().components(), state.body_momentum().0);
            for (found, wanted) in q.iter().zip(quaternions[i]) {
                worst = worse(worst, (found - wanted).abs());
            }
            for (found, wanted) in mu.iter().zip(momenta[i]) {
                worst = worse(worst, (found - wanted).abs());
            }
        }
    }
    worst
}

#[test]
fn reference_states_of_both_members_of_the_family() {
    let moser_veselov = deviation(0.0, QUATERNION_C0, MOMENTUM_C0);
    let thesis = deviation(1.0, QUATERNION_C1, MOMENTUM_C1);
    println!("c = 0: {moser_veselov:e}, c = 1: {thesis:e}");
    assert!(moser_veselov < TOLERANCE, "{moser_veselov:e}");
    assert!(thesis < TOLERANCE, "{thesis:e}");
    // The comparison distinguishes the two values of c.
    assert!(deviation(0.0, QUATERNION_C1, MOMENTUM_C1) > 1e-3);
}

#[test]
fn without_c_it_is_the_body_on_so3_seen_from_its_double_cover() {
    let moments = [3.5, 2.5, 2.0];
    let apart = |c: f64| {
        let (model, mut state, mut work) = body::<f64>(moments, c, M0, H);
        let half = moments.iter().sum::<f64>() / 2.0;
        let free = FreeBody::new(FreeBodyParameters {
            J: diagonal(moments.map(|i| half - i)),
        })
        .expect("a body");
        let initial = FreeBodyInitial {
            Λ: Rotation::identity(),
            body_momentum: BodyMomentum(Vector3::from(M0)),
        };
        let (mut other, mut solver) = free.start(initial, H).expect("solvable");
        let mut worst: f64 = 0.0;
        for _ in 0..1000 {
            model.step(&mut state, &mut work).expect("solvable");
            free.step(&mut other, &mut solver).expect("solvable");
            let difference = state.q().rotation().matrix() - other.Λ().matrix();
            worst = worse(worst, difference.amax());
        }
        worst
    };
    let same = apart(0.0);
    println!("{same:e}");
    assert!(same < TOLERANCE, "{same:e}");
    assert!(apart(1.0) > 1e-5);
}

#[test]
fn body_and_space_give_one_motion() {
    let moments = [3.5, 2.5, 2.0];
    for c in [0.0, 1.0] {
        let (model, mut state, mut work) = body::<f64>(moments, c, M0, H);
        let spatial = CayleyKleinSpatial::new(CayleyKleinSpatialParameters { c }).expect("c");
        let initial = CayleyKleinSpatialInitial {
            q: UnitQuaternion::identity(),
            spatial_momentum: SpatialMomentum(Vector3::from(M0)),
            I: diagonal(moments),
        };
        let (mut other, mut scratch) = spatial.start(initial, H).expect("solvable");
        let mut worst: f64 = 0.0;
        for _ in 0..1000 {
            model.step(&mut state, &mut work).expect("solvable");
            spatial.step(&mut other, &mut scratch).expect("solvable");
            for (a, b) in state.q().components().iter().zip(other.q().components()) {
                worst = worse(worst, (a - b).abs());
            }
            // The step preserves the momentum exactly.
            assert_eq!(other.spatial_momentum().0, Vector3::from(M0));
        }
        println!("c = {c}: {worst:e}");
        assert!(worst < TOLERANCE, "{worst:e}");
    }
}

#[test]
fn energies_of_the_family() {
    let range = |c: f64, h: f64| {
        let (model, mut state, mut work) = body::<f64>([3.5, 2.5, 2.0], c, [-0.5, 0.0, 1.0], h);
        let start = model.energy(&state);
        let (mut low, mut high) = (start, start);
        for _ in 0..(200.0 / h) as usize {
            model.step(&mut state, &mut work).expect("solvable");
            let e = model.energy(&state);
            (low, high) = (low.min(e), high.max(e));
        }
        high - low
    };
    // Exact for c = 0; for c = 1 an oscillation proportional to h^2.
    assert!(range(0.0, 0.1) < 1e-13);
    let (coarse, fine) = (range(1.0, 0.1), range(1.0, 0.05));
    println!("{coarse:e} {fine:e}");
    assert!(coarse > 1e-8);
    assert!((coarse / fine - 4.0).abs() < 0.1, "{}", coarse / fine);
}

/// A rotated and translated initial state of Kirchhoff's body, with its parameters.
struct Case {
    b: Vector4<f64>,
    coupling: Matrix3<f64>,
}

impl Case {
    fn parameters<T: Real>(&self) -> KirchhoffBodyParameters<T> {
        KirchhoffBodyParameters {
            J: INERTIA.map(T::from_f64),
            M: MASS.map(T::from_f64),
            D: self.coupling.map(T::from_f64),
            b: lifted(&self.b),
            Z: lifted(&Vector4::new(0.0, 0.0, 1.0, 0.0)),
        }
    }

    fn start<T: Real>(
        &self,
        h: f64,
    ) -> (
        KirchhoffBody<T>,
        KirchhoffBodyState<T>,
        KirchhoffBodyWorkspace<T>,
    ) {
        let model = KirchhoffBody::new(self.parameters()).expect("a body");
        let initial = KirchhoffBodyInitial {
            G: RigidMotion {
                rotation: Rotation::exp(&lifted(&Vector3::new(0.3, -0.7, 0.4))),
                translation: lifted(&Vector3::new(0.2, 0.5, -0.1)),
            },
            body_momentum: BodyImpulse(lifted(&SVector::<f64, 6>::from(IMPULSE))),
        };
        let (state, work) = model.start(initial, T::from_f64(h)).expect("solvable");
        (model, state, work)
    }
}

const INERTIA: Matrix3<f64> = Matrix3::new(1.0, 0.1, 0.0, 0.1, 0.7, -0.05, 0.0, -0.05, 0.4);
const MASS: Matrix3<f64> = Matrix3::new(1.5, 0.2, 0.1, 0.2, 2.0, 0.0, 0.1, 0.0, 3.0);
const IMPULSE: [f64; 6] = [0.3, -0.2, 0.8, 0.9, 0.2, 0.4];

fn heavy() -> Case {
    Case {
        b: Vector4::new(0.1, 0.05, -0.2, 0.3),
        coupling: Matrix3::new(0.1, 0.05, 0.0, -0.02, -0.05, 0.1, 0.0, 0.03, 0.15),
    }
}

fn neutral() -> Case {
    Case {
        b: Vector4::zeros(),
        ..heavy()
    }
}

/// Kirchhoff's equations (Lamb, Hydrodynamics, 124) for impulse, attitude and position, integrated by the classical fourth-order
/// Runge-Kutta method and written independently of generated code.
fn kirchhoff(
    case: &Case,
    time: f64,
    steps: usize,
) -> (Matrix3<f64>, Vector3<f64>, SVector<f64, 6>) {
    let inertia = Matrix3::identity() * INERTIA.trace() - INERTIA;
    let mut mass = SVector::<f64, 36>::zeros();
    let mut whole = clebsch::nalgebra::Matrix6::<f64>::zeros();
    whole.fixed_view_mut::<3, 3>(0, 0).copy_from(&inertia);
    whole.fixed_view_mut::<3, 3>(0, 3).copy_from(&case.coupling);
    whole
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&case.coupling.transpose());
    whole.fixed_view_mut::<3, 3>(3, 3).copy_from(&MASS);
    mass.copy_from_slice(whole.as_slice());
    let inverse = whole.try_inverse().expect("positive");
    type Phase = (Matrix3<f64>, Vector3<f64>, SVector<f64, 6>);
    let rate = |(r, _, m): &Phase| -> Phase {
        let velocity = inverse * m;
        let (w, v) = (
            velocity.fixed_rows::<3>(0).into_owned(),
            velocity.fixed_rows::<3>(3).into_owned(),
        );
        let (a, l) = (
            m.fixed_rows::<3>(0).into_owned(),
            m.fixed_rows::<3>(3).into_owned(),
        );
        let up = r.transpose() * Vector3::z();
        let lever = case.b.fixed_rows::<3>(0).into_owned();
        let torque = a.cross(&w) + l.cross(&v) + up.cross(&lever);
        let force = l.cross(&w) - up * case.b[3];
        let mut change = SVector::<f64, 6>::zeros();
        change.fixed_rows_mut::<3>(0).copy_from(&torque);
        change.fixed_rows_mut::<3>(3).copy_from(&force);
        (r * w.cross_matrix(), r * v, change)
    };
    let (_, start, _) = case.start::<f64>(0.01);
    let g = start.G();
    let mut phase: Phase = (
        g.rotation.matrix(),
        g.translation,
        SVector::<f64, 6>::from(IMPULSE),
    );
    let h = time / steps as f64;
    let moved = |p: &Phase, k: &Phase, s: f64| (p.0 + k.0 * s, p.1 + k.1 * s, p.2 + k.2 * s);
    for _ in 0..steps {
        let k1 = rate(&phase);
        let k2 = rate(&moved(&phase, &k1, h / 2.0));
        let k3 = rate(&moved(&phase, &k2, h / 2.0));
        let k4 = rate(&moved(&phase, &k3, h));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            phase = moved(&phase, &k, h * weight / 6.0);
        }
    }
    phase
}

/// The error of the fourth-order method at its step size of 1e-3 is about 1e-13.
const FLOOR: f64 = 1e-12;

#[test]
fn kirchhoff_body_is_of_second_order() {
    for case in [neutral(), heavy()] {
        let (turn, place, impulse) = kirchhoff(&case, 2.0, 4_000);
        let (mut attitude, mut position, mut momentum) = (Vec::new(), Vec::new(), Vec::new());
        for steps in [40, 80, 160, 320, 640] {
            let (model, mut state, mut work) = case.start::<f64>(2.0 / f64::from(steps));
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("solvable");
            }
            attitude.push((state.G().rotation.matrix() - turn).amax());
            position.push((state.G().translation - place).amax());
            momentum.push((state.body_momentum().0 - impulse).amax());
        }
        for errors in [attitude, position, momentum] {
            println!("{errors:?}");
            assert!(confirms(&errors, 2.0, FLOOR), "{errors:?}");
        }
    }
}

/// Newton's method on the translations uses the complete Jacobian. From rest, each correction squares the residual; along a motion,
/// one or two corrections per step suffice. If the Jacobian lacked a term, each correction would leave a fixed fraction of the
/// residual.
#[test]
fn rotations_in_a_fluid_are_found_by_the_whole_derivative() {
    // A heavy body accelerates until large steps have no solution.
    for (case, h) in [(neutral(), 0.05), (neutral(), 0.2), (heavy(), 0.05)] {
        let (model, mut state, mut work) = case.start::<f64>(h);
        model.step(&mut state, &mut work).expect("solvable");
        let first = work.solved();
        assert!(first.tangents <= 4 && first.corrections <= 5, "{first:?}");
        let mut corrections = 0;
        for _ in 0..1000 {
            model.step(&mut state, &mut work).expect("solvable");
            corrections += work.solved().corrections;
        }
        // A few steps have a worse initial guess and need a third correction.
        assert!(corrections < 2500, "{corrections}");
    }
}

#[test]
fn kirchhoff_body_keeps_its_momenta_and_bounds_its_energy() {
    // In a fluid of the same density the step conserves the whole impulse.
    let (model, mut state, mut work) = neutral().start::<f64>(0.05);
    let (impulse, energy) = (state.spatial_momentum().0, model.energy(&state));
    let (mut worst, mut moments): (f64, f64) = (0.0, 0.0);
    for _ in 0..20_000 {
        model.step(&mut state, &mut work).expect("solvable");
        let now = state.spatial_momentum().0;
        let [moment, linear] = [0, 3].map(|at| now.fixed_rows::<3>(at).into_owned());
        assert_eq!(linear, impulse.fixed_rows::<3>(3).into_owned());
        // The state stores the moment about the body's origin. The moment about the spatial origin adds the lever arm term and has
        // the rounding error of both.
        let lever = state.G().translation.norm() * linear.norm();
        let size = lever + state.body_momentum().0.fixed_rows::<3>(0).norm();
        let off = (moment - impulse.fixed_rows::<3>(0)).norm();
        moments = worse(moments, off / size);
        worst = worse(worst, (model.energy(&state) - energy).abs());
    }
    println!("energy {worst:e} of {energy:e}, moment {moments:e} of its terms");
    assert!(moments < 4.0 * f64::EPSILON, "{moments:e}");
    assert!(worst < 2e-3 * energy, "{worst:e}");
    // Weight preserves the horizontal impulse and the angular momentum about the vertical.
    let (model, mut state, mut work) = heavy().start::<f64>(0.02);
    let (before, energy) = (state.spatial_momentum().0, model.energy(&state));
    let mut worst: f64 = 0.0;
    for _ in 0..500 {
        model.step(&mut state, &mut work).expect("solvable");
        let now = state.spatial_momentum().0;
        for i in [2, 3, 4] {
            worst = worse(worst, (now[i] - before[i]).abs());
        }
    }
    // The step adds a vertical torque that vanishes up to the rounding of lever arm and height.
    assert!(worst < 1e-12, "{worst:e}");
    assert!((state.spatial_momentum().0[5] - before[5]).abs() > 1.0);
    let drift = (model.energy(&state) - energy).abs();
    assert!(drift < 1e-2 * energy.abs(), "{drift:e}");
}

#[test]
fn a_step_back_undoes_a_step() {
    // The action is reversible: the motion with reversed momentum returns to the start.
    let case = heavy();
    let (model, start, mut work) = case.start::<f64>(0.05);
    let mut state = start;
    for _ in 0..50 {
        model.step(&mut state, &mut work).expect("solvable");
    }
    let initial = KirchhoffBodyInitial {
        G: state.G(),
        body_momentum: BodyImpulse(-state.body_momentum().0),
    };
    let (mut state, mut work) = model.start(initial, 0.05).expect("solvable");
    for _ in 0..50 {
        model.step(&mut state, &mut work).expect("solvable");
    }
    let back = (state.G().matrix() - start.G().matrix()).amax();
    println!("{back:e}");
    assert!(back < 1e-12, "{back:e}");
    let momentum = (state.body_momentum().0 + start.body_momentum().0).amax();
    assert!(momentum < 1e-12, "{momentum:e}");
}

#[test]
fn every_scalar_runs() {
    let steps = 20;
    let run = |case: &Case| {
        let (model, mut state, mut work) = case.start::<f64>(0.05);
        for _ in 0..steps {
            model.step(&mut state, &mut work).expect("solvable");
        }
        state
    };
    let plain = run(&heavy());
    let (model, mut wide, mut work) = heavy().start::<Lanes<4>>(0.05);
    for _ in 0..steps {
        model.step(&mut wide, &mut work).expect("solvable");
    }
    for lane in 0..4 {
        let found = wide.G().matrix().map(|x| x.0[lane]);
        assert!((found - plain.G().matrix()).amax() < 1e-13);
    }
    let (model, mut long, mut work) = heavy().start::<DoubleDouble>(0.05);
    for _ in 0..steps {
        model.step(&mut long, &mut work).expect("solvable");
    }
    let found = long.G().matrix().map(|x| x.value());
    assert!((found - plain.G().matrix()).amax() < 1e-13);
    assert!(Group::<DoubleDouble>::distance_from_group(&long.G().rotation) < 1e-29);
    // The derivative with respect to the net weight, against a finite difference of two runs.
    let case = heavy();
    let mut parameters = case.parameters::<Seeded>();
    parameters.b[3] = Seeded::variable(case.b[3], 0);
    let model = KirchhoffBody::new(parameters).expect("a body");
    let (_, start, _) = case.start::<Seeded>(0.05);
    let initial = KirchhoffBodyInitial {
        G: start.G(),
        body_momentum: start.body_momentum(),
    };
    let (mut state, mut work) = model
        .start(initial, Seeded::from_f64(0.05))
        .expect("solvable");
    for _ in 0..steps {
        model.step(&mut state, &mut work).expect("solvable");
    }
    let exact = state.G().matrix().map(|x| x.dual[0]);
    let shifted = |by: f64| {
        let mut other = heavy();
        other.b[3] += by;
        run(&other).G().matrix()
    };
    let difference = (shifted(1e-5) - shifted(-1e-5)) / 2e-5;
    assert!((exact - difference).amax() < 1e-8);
    assert!(exact.amax() > 1e-2);
    // The same check for quaternions.
    let (model, mut state, mut work) = body::<DoubleDouble>(MOMENTS, 1.0, M0, H);
    for _ in 0..10 {
        model.step(&mut state, &mut work).expect("solvable");
    }
    for (found, wanted) in state.q().components().iter().zip(QUATERNION_C1[1]) {
        assert!((found.value() - wanted).abs() < 1e-15);
    }
}

#[test]
fn steps_allocate_nothing() {
    let (model, mut state, mut work) = body::<f64>(MOMENTS, 1.0, M0, H);
    let (other, mut place, mut scratch) = heavy().start::<f64>(0.02);
    let count = allocations(|| {
        for _ in 0..100 {
            model.step(&mut state, &mut work).expect("solvable");
            other.step(&mut place, &mut scratch).expect("solvable");
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn what_cannot_run_is_refused() {
    let (_, start, _) = body::<f64>(MOMENTS, 0.0, M0, H);
    let model = CayleyKlein::new(CayleyKleinParameters {
        I: diagonal(MOMENTS),
        c: 0.0,
    })
    .expect("a body");
    let fast = CayleyKleinInitial {
        q: start.q(),
        body_momentum: BodyMomentum(Vector3::from(M0) * 100.0),
    };
    assert!(model.start(fast, H).is_err());
    assert!(model.start(fast, f64::NAN).is_err());
    let lost = KirchhoffBodyInitial {
        G: RigidMotion {
            rotation: Rotation::identity(),
            translation: Vector3::new(0.0, f64::NAN, 0.0),
        },
        body_momentum: BodyImpulse(SVector::<f64, 6>::from(IMPULSE)),
    };
    let body = KirchhoffBody::new(heavy().parameters::<f64>()).expect("a body");
    let refusal = body.start(lost, 0.02).expect_err("refused").to_string();
    assert!(refusal.contains('G'), "{refusal}");
    let mut lopsided = heavy().parameters::<f64>();
    lopsided.M[(0, 1)] += 1.0;
    assert!(KirchhoffBody::new(lopsided).is_err());
}
