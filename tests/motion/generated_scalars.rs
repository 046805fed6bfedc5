//! One emitted stepper with several scalar types. Lanes step like single runs, double-double solves its own equation to its own
//! precision, and dual numbers give the derivative of a trajectory. Tests cover both gallery models and a model that needs Newton's
//! method.

use super::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::solvers::moser_veselov::MoserVeselovError;
use clebsch::{BodyMomentum, DoubleDouble, Lanes, Real, Rotation, StartError, StepCause};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::heavy_top::{
    HeavyTop, HeavyTopConfiguration, HeavyTopInitial, HeavyTopParameters,
};

clebsch::model! {
    /// A top whose kinetic energy is not linear in the velocity: solved by Newton.
    model SoftTop {
        param J: Sym<3>;
        param gU: Vec<3>;
        param c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ) + (c/h)*tr(Ω - Id)^2;
    }
}

const H: f64 = 0.1;
const STEPS: usize = 50;

fn lift<T: Real, const R: usize, const C: usize>(a: SMatrix<f64, R, C>) -> SMatrix<T, R, C> {
    a.map(T::from_f64)
}

fn poinsot() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.1, -0.05, 0.1, 1.2, 0.15, -0.05, 0.15, 0.7)
}

fn momentum(i: usize) -> Vector3<f64> {
    Vector3::new(0.1 + 0.05 * i as f64, -0.2, 0.8 - 0.1 * i as f64)
}

fn attitude<T: Real>() -> Rotation<T> {
    Rotation::exp(&lift(Vector3::new(0.3, -0.7, 0.2)))
}

/// The body momentum after a number of steps from this initial momentum.
trait Run {
    fn run<T: Real>(momentum: SVector<T, 3>, h: T) -> SVector<T, 3>;
}

struct Free;
struct Heavy;
struct Soft;

impl Run for Free {
    fn run<T: Real>(momentum: SVector<T, 3>, h: T) -> SVector<T, 3> {
        let model = FreeBody::new(FreeBodyParameters { J: lift(poinsot()) }).unwrap();
        let initial = FreeBodyInitial {
            Λ: attitude(),
            body_momentum: BodyMomentum(momentum),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
        }
        state.body_momentum().0
    }
}

fn heavy<T: Real>() -> HeavyTop<T> {
    HeavyTop::new(HeavyTopParameters {
        J: lift(poinsot()),
        gU: lift(Vector3::new(0.1, -0.2, 0.6)),
        z: lift(Vector3::z()),
    })
    .unwrap()
}

impl Run for Heavy {
    fn run<T: Real>(momentum: SVector<T, 3>, h: T) -> SVector<T, 3> {
        let model = heavy();
        let initial = HeavyTopInitial {
            Λ: attitude(),
            body_momentum: BodyMomentum(momentum),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
        }
        state.body_momentum().0
    }
}

impl Run for Soft {
    fn run<T: Real>(momentum: SVector<T, 3>, h: T) -> SVector<T, 3> {
        let model = SoftTop::new(SoftTopParameters {
            J: lift(poinsot()),
            gU: lift(Vector3::new(0.1, -0.2, 0.6)),
            c: T::from_f64(0.05),
        })
        .unwrap();
        let initial = SoftTopInitial {
            Λ: attitude(),
            body_momentum: BodyMomentum(momentum),
            Γ: lift(Vector3::new(0.6, 0.0, 0.8)),
        };
        let (mut state, mut work) = model.start(initial, h).unwrap();
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
        }
        state.body_momentum().0
    }
}

fn lanes_step_like_single_runs<M: Run>() {
    let starts: [Vector3<f64>; 4] = std::array::from_fn(momentum);
    let together = SVector::<Lanes<4>, 3>::from_fn(|i, _| Lanes(starts.map(|m| m[i])));
    let ended = M::run(together, Lanes([H; 4]));
    for (lane, start) in starts.into_iter().enumerate() {
        let alone = M::run(start, H);
        for i in 0..3 {
            // All lanes iterate until the slowest converges. The difference is a few rounding errors per step, with little
            // amplification in 50 steps.
            let gap = (ended[i].lane(lane) - alone[i]).abs();
            assert!(gap < 1e-13, "lane {lane}: {gap:e}");
        }
    }
}

fn duals_differentiate<M: Run>() {
    // Forward differences in double-double: the truncation error, step times curvature, is far below the rounding error of the dual
    // run.
    let step = 1e-14;
    let base = M::run(
        momentum(0).map(DoubleDouble::from_f64),
        DoubleDouble::from_f64(H),
    );
    let seeded = SVector::from_fn(|i, _| Seeded::variable(momentum(0)[i], i));
    let dual = M::run(seeded, Seeded::from_f64(H));
    for j in 0..3 {
        let mut moved = momentum(0).map(DoubleDouble::from_f64);
        moved[j] += DoubleDouble::from_f64(step);
        let moved = M::run(moved, DoubleDouble::from_f64(H));
        for i in 0..3 {
            let slope = ((moved[i] - base[i]) / DoubleDouble::from_f64(step)).value();
            let gap = (dual[i].dual[j] - slope).abs();
            assert!(gap < 1e-11 * (1.0 + slope.abs()), "component {i}: {gap:e}");
        }
    }
}

fn double_double_refines<M: Run>() {
    let fine = M::run(
        momentum(0).map(DoubleDouble::from_f64),
        DoubleDouble::from_f64(H),
    );
    let coarse = M::run(momentum(0), H);
    for i in 0..3 {
        let gap = (fine[i].value() - coarse[i]).abs();
        assert!(gap < 1e-12, "{gap:e}");
    }
}

#[test]
fn free_body() {
    lanes_step_like_single_runs::<Free>();
    duals_differentiate::<Free>();
    double_double_refines::<Free>();
}

#[test]
fn heavy_top() {
    lanes_step_like_single_runs::<Heavy>();
    duals_differentiate::<Heavy>();
    double_double_refines::<Heavy>();
}

#[test]
fn newton() {
    lanes_step_like_single_runs::<Soft>();
    duals_differentiate::<Soft>();
    double_double_refines::<Soft>();
}

#[test]
fn double_double_solves_its_own_equation() {
    let model = heavy::<DoubleDouble>();
    let h = DoubleDouble::from_f64(H);
    let initial = HeavyTopInitial {
        Λ: attitude(),
        body_momentum: BodyMomentum(momentum(0).map(DoubleDouble::from_f64)),
    };
    let (mut state, mut work) = model.start(initial, h).unwrap();
    let here = |s: &clebsch_models::heavy_top::HeavyTopState<DoubleDouble>| HeavyTopConfiguration {
        Λ: s.Λ(),
    };
    let mut nodes = vec![here(&state)];
    for _ in 0..2 {
        model.step(&mut state, &mut work).unwrap();
        nodes.push(here(&state));
    }
    let residual = model.balance(h, &nodes[0], &nodes[1], &nodes[2]);
    // 32 digits, less the factor 1/h and a few dozen operations.
    assert!(
        residual.iter().all(|r| r.magnitude() < 1e-28),
        "{residual:?}"
    );
}

/// The error of the first step of size `h` of the heavy top with these body momenta.
fn refusal<T: Real>(momentum: SVector<T, 3>, h: f64) -> MoserVeselovError {
    let model = heavy::<T>();
    let initial = HeavyTopInitial {
        Λ: attitude(),
        body_momentum: BodyMomentum(momentum),
    };
    match model.start(initial, T::from_f64(h)).unwrap_err() {
        StartError::Refused(StepCause::MoserVeselov(e)) => e,
        other => panic!("{other}"),
    }
}

#[test]
fn the_largest_step_told_is_one_that_every_lane_can_make() {
    let h = 2.0;
    let fast = |i: usize| momentum(i) * [3.0, 5.0, 9.0, 4.0][i];
    let alone: Vec<f64> = (0..4)
        .map(|i| refusal(fast(i), h).largest_step.unwrap())
        .collect();
    let slowest = (0..4)
        .min_by(|a, b| alone[*a].total_cmp(&alone[*b]))
        .unwrap();
    assert!(slowest != 0, "lane 0 would hide a fault: {alone:?}");
    let together = SVector::from_fn(|row, _| Lanes(std::array::from_fn(|i| fast(i)[row])));
    let e = refusal::<Lanes<4>>(together, h);
    assert_eq!(e.lane as usize, slowest);
    assert_eq!(e.largest_step, Some(alone[slowest]));
    assert!(
        // Messages count from 1.
        e.to_string()
            .starts_with(&format!("lane {}: ", slowest + 1)),
        "{e}"
    );
}
