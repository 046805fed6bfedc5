//! Bodies whose coupling depends on attitudes and not on velocities, so that each velocity is solved as its own block. One model
//! has ten frames in a ring of springs, all explicit. The other has four bodies, two with a common velocity term: three blocks of
//! two kinds, one of them spatial. Compared with the variation of the unreduced action and with joint invariants.

use clebsch::integrate::Stepper;
use clebsch::nalgebra::{Matrix2, Matrix3, Vector3};
use clebsch::{
    BodyMomentum, BodyMomentumMatrix, Linear, Rotation, SpatialMomentum, StartError, StepCause,
};
use clebsch_oracle::oracle::action::{DiscreteAction, Variation, rotations, stationarity};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, dot};
use std::array::from_fn;

clebsch::model! {
    /// Ten frames, each bound to the next by their axes, the last to the first.
    model Ring {
        param J: Sym<3>;
        param a, b: Vec<3>;
        param c: Real;
        group R0: SO<3> velocity V0;
        group R1: SO<3> velocity V1;
        group R2: SO<3> velocity V2;
        group R3: SO<3> velocity V3;
        group R4: SO<3> velocity V4;
        group R5: SO<3> velocity V5;
        group R6: SO<3> velocity V6;
        group R7: SO<3> velocity V7;
        group R8: SO<3> velocity V8;
        group R9: SO<3> velocity V9;
        constraint next(R0) = R0*V0;
        constraint next(R1) = R1*V1;
        constraint next(R2) = R2*V2;
        constraint next(R3) = R3*V3;
        constraint next(R4) = R4*V4;
        constraint next(R5) = R5*V5;
        constraint next(R6) = R6*V6;
        constraint next(R7) = R7*V7;
        constraint next(R8) = R8*V8;
        constraint next(R9) = R9*V9;
        lagrangian = -tr(J*(V0 + V1 + V2 + V3 + V4 + V5 + V6 + V7 + V8 + V9))/h
            + h*c*(dot(R0*a, R1*b) + dot(R1*a, R2*b) + dot(R2*a, R3*b) + dot(R3*a, R4*b)
                 + dot(R4*a, R5*b) + dot(R5*a, R6*b) + dot(R6*a, R7*b) + dot(R7*a, R8*b)
                 + dot(R8*a, R9*b) + dot(R9*a, R0*b));
    }
}

clebsch::model! {
    /// A body stated in space, a body whose kinetic energy is quartic, and two bodies with a joint.
    model Kinds {
        param J: Sym<3>;
        param a, b: Vec<3>;
        param c, e: Real;
        group Q: SO<3> velocity U;
        group P: SO<3> velocity W;
        group R: SO<3> velocity V;
        group S: SO<3> velocity Y;
        constraint next(Q) = U*Q;
        constraint next(P) = P*W;
        constraint next(R) = R*V;
        constraint next(S) = S*Y;
        lagrangian = -(tr(J*Q^T*U*Q) + tr(J*W) + tr(J*V) + tr(J*Y))/h
            + (e/h^3)*tr(Id - W)^2
            - (e/h)*dot(R*(V - Id)*a, S*(Y - Id)*b)
            + h*c*(dot(Q*a, P*b) + dot(P*a, R*b) + dot(S*a, Q*b));
    }
}

clebsch::model! {
    /// Two bodies, one near the boundary of the domain of its potential.
    model Brink {
        param J: Sym<3>;
        param a, z: Vec<3>;
        param w, c: Real;
        group R: SO<3> velocity V;
        group S: SO<3> velocity Y;
        constraint next(R) = R*V;
        constraint next(S) = S*Y;
        lagrangian = -tr(J*V)/h - tr(J*Y)/h - h*w*log(dot(z, R*a) + c);
    }
}

clebsch::model! {
    /// A plane map that is pushed through det = 0 beside a body, solved by Newton.
    model Pushed {
        param J: Sym<3>;
        param e: Real;
        group F: GL<2> velocity P;
        group R: SO<3> velocity V;
        constraint next(F) = F*P;
        constraint next(R) = R*V;
        lagrangian = -tr(J*V)/h + tr((F*(P - Id))*(F*(P - Id))^T)/(2*h)
            + (e/h^3)*tr((F*(P - Id))*(F*(P - Id))^T)^2;
    }
}

/// The data of both models.
struct BlockData {
    h: f64,
    j: Square<f64, 3>,
    a: [f64; 3],
    b: [f64; 3],
    c: f64,
    e: f64,
}

impl BlockData {
    fn random(source: &mut Source, h: f64) -> BlockData {
        BlockData {
            h,
            j: source.positive(),
            a: source.vector(),
            b: source.vector(),
            c: source.between(-1.0, 1.0),
            e: source.between(0.01, 0.05),
        }
    }

    fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.j.0[i][j])
    }

    fn kinetic<T: Number>(&self, tail: &Square<T, 3>, head: &Square<T, 3>) -> T {
        -(Square::constant(&self.j) * tail.transpose() * *head).trace() / T::constant(self.h)
    }

    /// A spring between two directions, half at either end of the edge.
    fn spring<T: Number>(&self, one: [&Square<T, 3>; 2], other: [&Square<T, 3>; 2]) -> [T; 2] {
        let (a, b) = (constant_column(&self.a), constant_column(&self.b));
        [0, 1].map(|k| {
            T::constant(0.5 * self.h * self.c) * dot(&one[k].apply(&a), &other[k].apply(&b))
        })
    }
}

impl DiscreteAction<3, 10> for BlockData {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 10], head: &[Square<T, 3>; 10]) -> Vec<T> {
        let mut all: Vec<T> = (0..10).map(|i| self.kinetic(&tail[i], &head[i])).collect();
        for i in 0..10 {
            let next = (i + 1) % 10;
            all.extend(self.spring([&tail[i], &head[i]], [&tail[next], &head[next]]));
        }
        all
    }
}

impl DiscreteAction<3, 4> for BlockData {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 4], head: &[Square<T, 3>; 4]) -> Vec<T> {
        let mut all: Vec<T> = (0..4).map(|i| self.kinetic(&tail[i], &head[i])).collect();
        let turned = T::constant(3.0) - (tail[1].transpose() * head[1]).trace();
        all.push(T::constant(self.e / self.h.powi(3)) * turned * turned);
        let moved = |i: usize, arm: &[f64; 3]| -> [T; 3] {
            let arm = constant_column(arm);
            let (from, to) = (tail[i].apply(&arm), head[i].apply(&arm));
            from_fn(|k| to[k] - from[k])
        };
        all.push(-(T::constant(self.e / self.h) * dot(&moved(2, &self.a), &moved(3, &self.b))));
        for (i, j) in [(0, 1), (1, 2), (3, 0)] {
            all.extend(self.spring([&tail[i], &head[i]], [&tail[j], &head[j]]));
        }
        all
    }
}

fn square(r: &Rotation) -> Square<f64, 3> {
    let m = r.matrix();
    Square::from_entries(|i, j| m[(i, j)])
}

fn rotation(source: &mut Source) -> Rotation {
    let m: Square<f64, 3> = source.orthogonal();
    Rotation::from_matrix(&Matrix3::from_fn(|i, j| m.0[i][j])).expect("a rotation")
}

/// The frames of the ring.
fn frames(s: &RingState<f64>) -> [Square<f64, 3>; 10] {
    let all = [
        s.R0(),
        s.R1(),
        s.R2(),
        s.R3(),
        s.R4(),
        s.R5(),
        s.R6(),
        s.R7(),
        s.R8(),
        s.R9(),
    ];
    all.map(|r| square(&r))
}

/// The largest component of the variation, relative to the size of its terms.
fn share(variation: &Variation) -> f64 {
    let largest = variation
        .derivative
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(variation.derivative.iter().all(|x| x.is_finite()));
    largest / variation.scale
}

fn ring(given: &BlockData, source: &mut Source) -> (Ring, RingInitial) {
    let model = Ring::new(RingParameters {
        J: given.matrix(),
        a: Vector3::from(given.a),
        b: Vector3::from(given.b),
        c: given.c,
    });
    let mut r = || rotation(source);
    let [r0, r1, r2, r3, r4, r5, r6, r7, r8, r9] = from_fn(|_| r());
    let mut m = || BodyMomentum(Vector3::from(source.vector()) * 0.5);
    let initial = RingInitial {
        R0: r0,
        body_momentum_R0: m(),
        R1: r1,
        body_momentum_R1: m(),
        R2: r2,
        body_momentum_R2: m(),
        R3: r3,
        body_momentum_R3: m(),
        R4: r4,
        body_momentum_R4: m(),
        R5: r5,
        body_momentum_R5: m(),
        R6: r6,
        body_momentum_R6: m(),
        R7: r7,
        body_momentum_R7: m(),
        R8: r8,
        body_momentum_R8: m(),
        R9: r9,
        body_momentum_R9: m(),
    };
    (model.expect("positive"), initial)
}

fn kinds(given: &BlockData, source: &mut Source) -> (Kinds, KindsInitial) {
    let model = Kinds::new(KindsParameters {
        J: given.matrix(),
        a: Vector3::from(given.a),
        b: Vector3::from(given.b),
        c: given.c,
        e: given.e,
    });
    let [q, p, r, s] = from_fn(|_| rotation(source));
    let mut m = || Vector3::from(source.vector()) * 0.3;
    let initial = KindsInitial {
        Q: q,
        spatial_momentum_Q: SpatialMomentum(m()),
        P: p,
        body_momentum_P: BodyMomentum(m()),
        R: r,
        body_momentum_R: BodyMomentum(m()),
        S: s,
        body_momentum_S: BodyMomentum(m()),
    };
    (model.expect("positive"), initial)
}

/// Steps of a motion; `look` receives three consecutive nodes.
fn along<M: Stepper<Scalar = f64>>(
    model: &M,
    start: M::State,
    h: f64,
    steps: usize,
    mut look: impl FnMut(&[M::State; 3]),
) where
    M::State: Copy,
{
    let mut work = model.workspace(&start, h).expect("solvable");
    let mut past = [start; 3];
    for step in 0..steps {
        let mut state = past[2];
        model.advance(&mut state, &mut work).expect("solvable");
        past = [past[1], past[2], state];
        if step > 0 {
            look(&past);
        }
    }
}

/// A thousand rounding errors, relative to the size of the terms.
const ROUNDING: f64 = 2e-13;

#[test]
fn each_kind_of_block_solves_the_unreduced_equations() {
    let basis = rotations();
    let mut source = Source::seeded(11);
    for h in [0.02, 0.1, 0.2] {
        for _ in 0..20 {
            let given = BlockData::random(&mut source, h);
            let (model, initial) = ring(&given, &mut source);
            let (start, _) = model.start(initial, h).expect("solvable");
            let mut worst = 0.0f64;
            along(&model, start, h, 6, |past| {
                let nodes = past.map(|s| frames(&s));
                worst = worst.max(share(&stationarity(&given, &nodes, &basis)));
            });
            assert!(worst < ROUNDING, "ring: {worst:e}");
            let (model, initial) = kinds(&given, &mut source);
            let (start, _) = model.start(initial, h).expect("solvable");
            let mut worst = 0.0f64;
            along(&model, start, h, 6, |past| {
                let nodes = past.map(|s| [s.Q(), s.P(), s.R(), s.S()].map(|r| square(&r)));
                worst = worst.max(share(&stationarity(&given, &nodes, &basis)));
            });
            assert!(worst < ROUNDING, "kinds: {worst:e}");
        }
    }
}

#[test]
fn the_oracle_notices_a_spring_that_is_missing() {
    let basis = rotations();
    let mut source = Source::seeded(12);
    let mut given = BlockData::random(&mut source, 0.1);
    given.c = 0.5;
    let (model, initial) = ring(&given, &mut source);
    let (start, _) = model.start(initial, given.h).expect("solvable");
    given.c = 0.5 * (1.0 + 1e-6);
    let mut least = f64::INFINITY;
    along(&model, start, given.h, 6, |past| {
        let nodes = past.map(|s| frames(&s));
        least = least.min(share(&stationarity(&given, &nodes, &basis)));
    });
    assert!(least > ROUNDING, "{least:e}");
}

#[test]
fn frames_that_act_on_one_another_keep_their_angular_momentum() {
    let mut source = Source::seeded(13);
    for h in [1e-1, 1e-4, 1e-8] {
        let given = BlockData::random(&mut source, h);
        let (model, initial) = ring(&given, &mut source);
        let (start, _) = model.start(initial, h).expect("solvable");
        let momenta = |s: &RingState<f64>| {
            [
                s.spatial_momentum_R0(),
                s.spatial_momentum_R1(),
                s.spatial_momentum_R2(),
                s.spatial_momentum_R3(),
                s.spatial_momentum_R4(),
                s.spatial_momentum_R5(),
                s.spatial_momentum_R6(),
                s.spatial_momentum_R7(),
                s.spatial_momentum_R8(),
                s.spatial_momentum_R9(),
            ]
        };
        let total =
            |s: &RingState<f64>| momenta(s).iter().fold(Vector3::zeros(), |sum, m| sum + m.0);
        let size: f64 = momenta(&start).iter().map(|m| m.0.norm()).sum();
        let (first, mut worst) = (total(&start), 0.0f64);
        along(&model, start, h, 2000, |past| {
            worst = worst.max((total(&past[2]) - first).norm() / size);
        });
        // Per step ten sums of two forces with rounding errors of equal size; 2000 steps with random signs.
        assert!(worst < 2e-13, "h = {h:e}: {worst:e}");
    }
}

#[test]
fn a_block_beyond_its_bound_is_refused_with_a_step_that_works() {
    let mut source = Source::seeded(14);
    let given = BlockData::random(&mut source, 0.1);
    for fast in 0..10 {
        let (model, mut initial) = ring(&given, &mut source);
        let momentum = match fast {
            0 => &mut initial.body_momentum_R0,
            1 => &mut initial.body_momentum_R4,
            _ => &mut initial.body_momentum_R9,
        };
        momentum.0 *= 400.0;
        let error = model.start(initial, given.h).expect_err("too fast");
        let StartError::Refused(StepCause::LeftFactor(refused)) = &error else {
            panic!("{error}");
        };
        let offered = refused.largest_step.expect("a step is offered");
        assert!(0.0 < offered && offered < given.h, "{offered}");
        model
            .start(initial, offered)
            .expect("the step offered is taken");
        model
            .start(initial, 1.01 * offered)
            .expect_err("a longer one is not");
    }
}

#[test]
fn the_edge_of_a_domain_is_met_once() {
    let model = |w: f64, c: f64| {
        let model = Brink::new(BrinkParameters {
            J: Matrix3::identity(),
            a: Vector3::z(),
            z: Vector3::z(),
            w,
            c,
        });
        model.expect("admitted")
    };
    let still = BodyMomentum(Vector3::new(0.1, 0.2, 0.3));
    let at = |turn: f64| BrinkInitial {
        R: Rotation::exp(&Vector3::new(turn, 0.0, 0.0)),
        body_momentum_R: still,
        S: Rotation::identity(),
        body_momentum_S: still,
    };
    // Outside the domain from the start: no step size helps, and the solver searches for none.
    let error = model(1.0, -3.0).start(at(0.0), 0.05).expect_err("outside");
    assert!(matches!(error, StartError::Initial(_)), "{error}");
    // Just inside the domain: the suggested step size works.
    let edge = (-0.5f64).acos();
    for gap in [1e-2, 1e-4, 1e-6] {
        let mut initial = at(edge - gap);
        initial.body_momentum_R = BodyMomentum(Vector3::x());
        // So weak that only the boundary of the domain matters.
        let model = model(1e-30, 0.5);
        let error = model.start(initial, 0.2).expect_err("over the edge");
        let StartError::Refused(StepCause::Contact(contact)) = error else {
            panic!("{error}");
        };
        let works = contact.works().expect("a shorter step");
        model
            .start(initial, works)
            .expect("the step offered is taken");
    }
}

#[test]
fn a_block_that_loses_its_inverse_says_so() {
    let model = Pushed::new(PushedParameters {
        J: Matrix3::identity(),
        e: 1e-3,
    });
    let model = model.expect("admitted");
    let initial = PushedInitial {
        F: Linear::identity(),
        body_momentum_F: BodyMomentumMatrix(Matrix2::new(-1.0, 0.0, 0.0, -0.2)),
        R: Rotation::identity(),
        body_momentum_R: BodyMomentum(Vector3::new(0.1, 0.2, 0.3)),
    };
    for h in [0.03, 0.2, 0.7] {
        let (mut state, mut work) = model.start(initial, h).expect("far from singular");
        let error = loop {
            if let Err(e) = model.step(&mut state, &mut work) {
                break e;
            }
            assert!(
                state.node() < 200,
                "its determinant reaches 0 at about time 1"
            );
        };
        assert!(
            matches!(error.cause, StepCause::Contact(_)),
            "h = {h}: {error}"
        );
    }
}
