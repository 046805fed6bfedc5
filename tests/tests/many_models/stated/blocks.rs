//! Bodies whose coupling depends on attitudes and not on velocities, so that each velocity is solved as its own block. One model
//! has ten frames in a ring of springs, all explicit. The other has four bodies, two with a common velocity term: three blocks of
//! two kinds, one of them spatial. Compared with the variation of the unreduced action and with joint invariants.

use super::text_model::{Given, Motion, TextModel, cause, given};
use clebsch::card::OpenError;
use clebsch::nalgebra::{Matrix2, Matrix3, Vector3};
use clebsch::{Rotation, StartError, StepCause};
use clebsch_oracle::oracle::action::{DiscreteAction, Variation, rotations, stationarity};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, dot};
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Ten frames, each bound to the next by their axes, the last to the first.
fn ring_text() -> String {
    let each = |line: &dyn Fn(usize) -> String| (0..10).map(line).collect::<Vec<_>>();
    let frames =
        each(&|i| format!("group R{i}: SO<3> velocity V{i}; constraint next(R{i}) = R{i}*V{i};"));
    let velocities = each(&|i| format!("V{i}"));
    let springs = each(&|i| format!("dot(R{i}*a, R{}*b)", (i + 1) % 10));
    format!(
        "model Ring {{ param J: Sym<3>; param a, b: Vec<3>; param c: Real; {}
            lagrangian = -tr(J*({}))/h + h*c*({}); }}",
        frames.join(" "),
        velocities.join(" + "),
        springs.join(" + ")
    )
}

/// A body stated in space, a body whose kinetic energy is quartic, and two bodies with a joint.
const KINDS: &str = "model Kinds {
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
}";

/// Two bodies, one near the boundary of the domain of its potential.
const BRINK: &str = "model Brink {
    param J: Sym<3>;
    param a, z: Vec<3>;
    param w, c: Real;
    group R: SO<3> velocity V;
    group S: SO<3> velocity Y;
    constraint next(R) = R*V;
    constraint next(S) = S*Y;
    lagrangian = -tr(J*V)/h - tr(J*Y)/h - h*w*log(dot(z, R*a) + c);
}";

/// A plane map that is pushed through det = 0 beside a body, solved by Newton.
const PUSHED: &str = "model Pushed {
    param J: Sym<3>;
    param e: Real;
    group F: GL<2> velocity P;
    group R: SO<3> velocity V;
    constraint next(F) = F*P;
    constraint next(R) = R*V;
    lagrangian = -tr(J*V)/h + tr((F*(P - Id))*(F*(P - Id))^T)/(2*h)
        + (e/h^3)*tr((F*(P - Id))*(F*(P - Id))^T)^2;
}";

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

/// The largest component of the variation, relative to the size of its terms.
fn share(variation: &Variation) -> f64 {
    let largest = variation
        .derivative
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(variation.derivative.iter().all(|x| x.is_finite()));
    largest / variation.scale
}

/// The ring with random frames and momenta.
fn ring(given: &BlockData, source: &mut Source) -> Given {
    let mut all = given! { J: given.j, a: given.a, b: given.b, c: given.c };
    all.extend((0..10).map(|i| (format!("R{i}"), source.orthogonal::<3>().0.concat())));
    all.extend((0..10).map(|i| {
        let momentum = source.vector::<3>().map(|x| x * 0.5);
        (format!("body_momentum_R{i}"), momentum.to_vec())
    }));
    all
}

fn kinds(given: &BlockData, source: &mut Source) -> Given {
    let [q, p, r, s] = from_fn(|_| source.orthogonal::<3>());
    let mut m = || Vector3::from(source.vector()) * 0.3;
    given! {
        J: given.j, a: given.a, b: given.b, c: given.c, e: given.e,
        Q: q, spatial_momentum_Q: m(), P: p, body_momentum_P: m(),
        R: r, body_momentum_R: m(), S: s, body_momentum_S: m(),
    }
}

/// Steps of a motion; `look` receives the frames at three consecutive nodes.
fn along<const G: usize>(
    motion: &mut Motion,
    frames: [&str; G],
    steps: usize,
    mut look: impl FnMut(&[[Square<f64, 3>; G]; 3]),
) {
    let mut past = [frames.map(|name| motion.square(name)); 3];
    for step in 0..steps {
        motion.steps(1);
        past = [past[1], past[2], frames.map(|name| motion.square(name))];
        if step > 0 {
            look(&past);
        }
    }
}

const RING: [&str; 10] = ["R0", "R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8", "R9"];

/// A thousand rounding errors, relative to the size of the terms.
const ROUNDING: f64 = 2e-13;

#[test]
fn each_kind_of_block_solves_the_unreduced_equations() {
    let basis = rotations();
    let mut source = Source::seeded(11);
    let [of_ring, of_kinds] = [&ring_text(), KINDS].map(TextModel::read);
    for h in [0.02, 0.1, 0.2] {
        for _ in 0..20 {
            let given = BlockData::random(&mut source, h);
            let mut motion = of_ring
                .start(h, &ring(&given, &mut source))
                .expect("solvable");
            let mut worst = 0.0f64;
            along(&mut motion, RING, 6, |nodes| {
                worst = worst.max(share(&stationarity(&given, nodes, &basis)));
            });
            assert!(worst < ROUNDING, "ring: {worst:e}");
            let mut motion = of_kinds
                .start(h, &kinds(&given, &mut source))
                .expect("solvable");
            let mut worst = 0.0f64;
            along(&mut motion, ["Q", "P", "R", "S"], 6, |nodes| {
                worst = worst.max(share(&stationarity(&given, nodes, &basis)));
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
    let start = ring(&given, &mut source);
    let mut motion = TextModel::read(&ring_text())
        .start(given.h, &start)
        .expect("solvable");
    given.c = 0.5 * (1.0 + 1e-6);
    let mut least = f64::INFINITY;
    along(&mut motion, RING, 6, |nodes| {
        least = least.min(share(&stationarity(&given, nodes, &basis)));
    });
    assert!(least > ROUNDING, "{least:e}");
}

#[test]
fn frames_that_act_on_one_another_keep_their_angular_momentum() {
    let mut source = Source::seeded(13);
    for h in [1e-1, 1e-4, 1e-8] {
        let given = BlockData::random(&mut source, h);
        let start = ring(&given, &mut source);
        let mut motion = TextModel::read(&ring_text())
            .start(h, &start)
            .expect("solvable");
        let momenta = |motion: &Motion| {
            RING.map(|name| motion.vector::<3>(&format!("spatial_momentum_{name}")))
        };
        let total = |m: &Motion| momenta(m).iter().sum::<Vector3<f64>>();
        let size: f64 = momenta(&motion).iter().map(|m| m.norm()).sum();
        let (first, mut worst) = (total(&motion), 0.0f64);
        for _ in 0..2000 {
            motion.steps(1);
            worst = worse(worst, (total(&motion) - first).norm() / size);
        }
        // Per step ten sums of two forces with rounding errors of equal size; 2000 steps with random signs.
        assert!(worst < 2e-13, "h = {h:e}: {worst:e}");
    }
}

#[test]
fn a_block_beyond_its_bound_is_refused_with_a_step_that_works() {
    let mut source = Source::seeded(14);
    let given = BlockData::random(&mut source, 0.1);
    let model = TextModel::read(&ring_text());
    for fast in 0..10 {
        let mut start = ring(&given, &mut source);
        let fast = match fast {
            0 => "body_momentum_R0",
            1 => "body_momentum_R4",
            _ => "body_momentum_R9",
        };
        let momentum = start.iter_mut().find(|(name, _)| name == fast);
        let momentum = &mut momentum.expect("a momentum").1;
        momentum.iter_mut().for_each(|x| *x *= 400.0);
        let error = model.start(given.h, &start).expect_err("too fast");
        let StepCause::LeftFactor(refused) = cause(&error) else {
            panic!("{error}");
        };
        let offered = refused.largest_step.expect("a step is offered");
        assert!(0.0 < offered && offered < given.h, "{offered}");
        model
            .start(offered, &start)
            .expect("the step offered is taken");
        model
            .start(1.01 * offered, &start)
            .expect_err("a longer one is not");
    }
}

#[test]
fn the_edge_of_a_domain_is_met_once() {
    let still = [0.1, 0.2, 0.3];
    let given = |w: f64, c: f64, turn: f64, momentum: [f64; 3]| {
        given! {
            J: Matrix3::<f64>::identity(), a: [0.0, 0.0, 1.0], z: [0.0, 0.0, 1.0], w: w, c: c,
            R: Rotation::exp(&Vector3::new(turn, 0.0, 0.0)), body_momentum_R: momentum,
            S: Matrix3::<f64>::identity(), body_momentum_S: still,
        }
    };
    let model = TextModel::read(BRINK);
    // Outside the domain from the start: no step size helps, and the solver searches for none.
    let outside = given(1.0, -3.0, 0.0, still);
    let error = model.start(0.05, &outside).expect_err("outside");
    assert!(
        matches!(error, OpenError::Start(StartError::Initial(_))),
        "{error}"
    );
    // Just inside the domain: the suggested step size works.
    let edge = (-0.5f64).acos();
    for gap in [1e-2, 1e-4, 1e-6] {
        // So weak that only the boundary of the domain matters.
        let inside = given(1e-30, 0.5, edge - gap, [1.0, 0.0, 0.0]);
        let error = model.start(0.2, &inside).expect_err("over the edge");
        let StepCause::Contact(contact) = cause(&error) else {
            panic!("{error}");
        };
        let works = contact.works().expect("a shorter step");
        model
            .start(works, &inside)
            .expect("the step offered is taken");
    }
}

#[test]
fn a_block_that_loses_its_inverse_says_so() {
    let given = given! {
        J: Matrix3::<f64>::identity(), e: 1e-3,
        F: Matrix2::<f64>::identity(), body_momentum_F: [-1.0, 0.0, 0.0, -0.2],
        R: Matrix3::<f64>::identity(), body_momentum_R: [0.1, 0.2, 0.3],
    };
    for h in [0.03, 0.2, 0.7] {
        let started = TextModel::read(PUSHED).start(h, &given);
        let mut motion = started.expect("far from singular");
        // Its determinant reaches 0 at about time 1.
        let error = (0..200).find_map(|_| motion.step().err());
        let error = error.expect("a singular map");
        assert!(
            matches!(error.cause, StepCause::Contact(_)),
            "h = {h}: {error}"
        );
    }
}
