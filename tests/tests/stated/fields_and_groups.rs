//! Fields and groups in one model, against the variation of the action in flat coordinates by dual numbers: four bodies of four
//! kinds, and a rigid motion stated as a rotation and a position.

use super::fields::{Flat, ROUNDING, at_ends, minus, of, worst};
use clebsch::nalgebra::{Matrix3, Vector3, Vector6};
use clebsch::{
    Additive, BodyImpulse, BodyMomentum, FieldMomentum, RigidMotion, Rotation, UnitQuaternion,
};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, cross, dot, hat};
use std::array::from_fn;

clebsch::model! {
    /// A rotation, a rigid motion, a unit quaternion and a field, bound by springs; the kinetic energy of
    /// the field is quartic.
    model MixedFour {
        param J, A: Sym<3>;
        param p, s, e, g: Vec<3>;
        param m, M, k, b, c: Real;
        group R: SO<3> velocity V;
        group G: SE<3> velocity W;
        group q: SU<2> velocity Y;
        field X: Vec<3>;
        constraint next(R) = R*V;
        constraint next(G) = G*W;
        constraint next(q) = q*Y;
        let d = next(X) - X;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*V)/h - tr(A*rot(W))/h + M*dot(y, y)/(2*h) - (4*c/h)*re(Y)
            + m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 + h*m*dot(g, X)
            - (h*k/2)*dot(X - R*p, X - R*p)
            - (h*k/2)*dot(pos(G) + rot(G)*s - X, pos(G) + rot(G)*s - X)
            - h*k*dot(rot(q)*e, R*p);
    }
}

clebsch::model! {
    /// A body in a fluid, by its rigid motion.
    model Whole {
        param J, M: Sym<3>;
        param D: Mat<3>;
        param c, z: Vec<3>;
        param w: Real;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let u = (rot(G) + rot(next(G)))^T*(pos(next(G)) - pos(G))/2;
        let turn = rot(G)^T*rot(next(G));
        lagrangian = -tr(J*turn)/h + dot(u, M*u)/(2*h) + dot(vee(turn), D*u)/h
            - h*dot(c, rot(G)^T*z) - h*w*dot(z, pos(G));
    }
}

clebsch::model! {
    /// The same, stated by its attitude and its position.
    model Split {
        param J, M: Sym<3>;
        param D: Mat<3>;
        param c, z: Vec<3>;
        param w: Real;
        group R: SO<3> velocity V;
        field x: Vec<3>;
        constraint next(R) = R*V;
        let u = (R + R*V)^T*(next(x) - x)/2;
        lagrangian = -tr(J*V)/h + dot(u, M*u)/(2*h) + dot(vee(V), D*u)/h
            - h*dot(c, R^T*z) - h*w*dot(z, x);
    }
}

/// Flat coordinates: the rotation (9, row-major), the motion (9 and 3), the quaternion (4), the field (3).
struct OfMixed {
    h: f64,
    j: Square<f64, 3>,
    a: Square<f64, 3>,
    p: [f64; 3],
    s: [f64; 3],
    e: [f64; 3],
    g: [f64; 3],
    m: f64,
    heavy: f64,
    k: f64,
    b: f64,
    c: f64,
}

fn turn<T: Number>(node: &[T]) -> Square<T, 3> {
    Square::from_entries(|i, j| node[3 * i + j])
}

fn vector<T: Number>(node: &[T]) -> [T; 3] {
    from_fn(|i| node[i])
}

/// `q v q*` of a unit quaternion `(w, x, y, z)`.
fn turned_by<T: Number>(q: &[T], v: &[T; 3]) -> [T; 3] {
    let axis: [T; 3] = from_fn(|i| q[i + 1]);
    let once = cross(&axis, v);
    let twice = cross(&axis, &once);
    from_fn(|i| v[i] + of::<T>(2.0) * (q[0] * once[i] + twice[i]))
}

impl Flat for OfMixed {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        // One summand per product: near the identity the products cancel in the sum, and each has its own rounding error.
        let trace = |j: &Square<f64, 3>, at: usize| {
            let [r0, r1] = [tail, head].map(|n| turn(&n[at..]));
            let all = (0..27).map(|n| [n / 9, n / 3 % 3, n % 3]);
            let each =
                all.map(|[i, j_, k]| of::<T>(-j.0[i][j_] / self.h) * r0.0[k][j_] * r1.0[k][i]);
            each.collect::<Vec<T>>()
        };
        let place: [T; 3] = minus(&head[18..], &tail[18..]);
        let d: [T; 3] = minus(&head[25..], &tail[25..]);
        let real = (0..4).fold(of::<T>(0.0), |sum, i| sum + tail[21 + i] * head[21 + i]);
        let speed = dot(&d, &d);
        let mut all = vec![
            of::<T>(0.5 * self.heavy / self.h) * dot(&place, &place),
            of::<T>(-4.0 * self.c / self.h) * real,
            of::<T>(0.5 * self.m / self.h) * speed,
            of::<T>(self.b / self.h.powi(3)) * speed * speed,
        ];
        all.extend(trace(&self.j, 0));
        all.extend(trace(&self.a, 9));
        all.extend(at_ends(tail, head, |n| {
            of::<T>(self.h * self.m) * dot(&constant_column(&self.g), &vector(&n[25..]))
        }));
        let spring = |x: [T; 3]| of::<T>(-0.5 * self.h * self.k) * dot(&x, &x);
        all.extend(at_ends(tail, head, |n| {
            spring(minus(&n[25..], &turn(n).apply(&constant_column(&self.p))))
        }));
        all.extend(at_ends(tail, head, |n| {
            let arm = turn(&n[9..]).apply(&constant_column(&self.s));
            spring(from_fn(|i| n[18 + i] + arm[i] - n[25 + i]))
        }));
        all.extend(at_ends(tail, head, |n| {
            let one = turned_by(&n[21..25], &constant_column(&self.e));
            let other = turn(n).apply(&constant_column(&self.p));
            of::<T>(-self.h * self.k) * dot(&one, &other)
        }));
        all
    }

    fn directions(&self, node: &[f64]) -> Vec<Vec<f64>> {
        let mut out = Vec::new();
        let unit = |i: usize| -> [f64; 3] { from_fn(|j| f64::from(u8::from(i == j))) };
        for at in [0, 9] {
            for i in 0..3 {
                let moved = turn(&node[at..]) * hat(&unit(i));
                let mut all = vec![0.0; node.len()];
                (0..9).for_each(|k| all[at + k] = moved.0[k / 3][k % 3]);
                out.push(all);
            }
        }
        let q = &node[21..25];
        for i in 0..3 {
            // q times half the unit i.
            let mut all = vec![0.0; node.len()];
            let axis: [f64; 3] = from_fn(|j| q[j + 1]);
            let turned = cross(&axis, &unit(i));
            all[21] = -0.5 * axis[i];
            (0..3).for_each(|j| all[22 + j] = 0.5 * (q[0] * unit(i)[j] + turned[j]));
            out.push(all);
        }
        for k in (18..21).chain(25..28) {
            let mut all = vec![0.0; node.len()];
            all[k] = 1.0;
            out.push(all);
        }
        out
    }
}

fn nodes_of(s: &MixedFourState<f64>) -> Vec<f64> {
    let rows = |m: Matrix3<f64>| m.transpose().as_slice().to_vec();
    [
        rows(s.R().matrix()),
        rows(s.G().rotation.matrix()),
        s.G().translation.as_slice().to_vec(),
        s.q().components().to_vec(),
        s.X().matrix().as_slice().to_vec(),
    ]
    .concat()
}

fn mixed(source: &mut Source, h: f64) -> (OfMixed, MixedFour, MixedFourInitial) {
    let given = OfMixed {
        h,
        j: source.positive(),
        a: source.positive(),
        p: source.vector(),
        s: source.vector(),
        e: source.vector(),
        g: source.vector(),
        m: source.between(0.5, 2.0),
        heavy: source.between(0.5, 2.0),
        k: source.between(0.1, 1.0),
        b: source.between(0.01, 0.1),
        c: source.between(0.5, 2.0),
    };
    let matrix = |a: &Square<f64, 3>| Matrix3::from_fn(|i, j| a.0[i][j]);
    let model = MixedFour::new(MixedFourParameters {
        J: matrix(&given.j),
        A: matrix(&given.a),
        p: Vector3::from(given.p),
        s: Vector3::from(given.s),
        e: Vector3::from(given.e),
        g: Vector3::from(given.g),
        m: given.m,
        M: given.heavy,
        k: given.k,
        b: given.b,
        c: given.c,
    });
    let mut rotation = || {
        let m: Square<f64, 3> = source.orthogonal();
        Rotation::from_matrix(&matrix(&m)).expect("a rotation")
    };
    let (r, turn, q) = (rotation(), rotation(), rotation());
    let initial = MixedFourInitial {
        R: r,
        body_momentum_R: BodyMomentum(Vector3::from(source.vector()) * 0.3),
        G: RigidMotion {
            rotation: turn,
            translation: Vector3::from(source.vector()),
        },
        body_momentum_G: BodyImpulse(Vector6::from(source.vector()) * 0.3),
        q: UnitQuaternion::from_components(q.quaternion()).expect("of length 1"),
        body_momentum_q: BodyMomentum(Vector3::from(source.vector()) * 0.3),
        X: Additive::new(Vector3::from(source.vector())),
        momentum_X: FieldMomentum(Vector3::from(source.vector()) * 0.3),
    };
    (given, model.expect("parameters"), initial)
}

#[test]
fn four_kinds_solve_the_unreduced_equations_together() {
    let mut source = Source::seeded(38);
    for h in [0.02, 0.1] {
        for _ in 0..10 {
            let (given, model, initial) = mixed(&mut source, h);
            let (start, _) = model.start(initial, h).expect("solvable");
            let found = worst(&given, &model, start, h, nodes_of);
            assert!(found < ROUNDING, "{found:e}");
        }
    }
}

#[test]
fn four_kinds_keep_their_total_momentum() {
    let mut source = Source::seeded(39);
    for h in [1e-1, 1e-4, 1e-8] {
        let (_, model, mut initial) = mixed(&mut source, h);
        initial.X = Additive::new(Vector3::zeros());
        let axis = model.parameters().g;
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let about = |s: &MixedFourState<f64>| {
            let turned = s.spatial_momentum_R().0 + s.spatial_momentum_q().0;
            let motion = s.spatial_momentum_G().0.fixed_rows::<3>(0).into_owned();
            let field = s.X().matrix().cross(&s.momentum_X().0);
            (turned + motion + field).dot(&axis)
        };
        let first = about(&state);
        let mut scale = first.abs() + axis.norm();
        for _ in 0..2000 {
            model.step(&mut state, &mut work).expect("solvable");
            let reach = state.X().matrix().norm() + state.G().translation.norm();
            let field = state.momentum_X().0.norm() + state.spatial_momentum_G().0.norm();
            scale = scale.max(axis.norm() * (1.0 + reach) * (1.0 + field));
        }
        // Rounding errors of 2000 steps, relative to the size of the momentum.
        let drift = (about(&state) - first).abs() / scale;
        assert!(drift < 1e-12, "{h:e}: {drift:e}");
    }
}

/// A rigid motion equals a rotation and a position: two statements of one motion, on different groups and with different Jacobians.
#[test]
fn a_rotation_and_a_place_move_as_a_rigid_motion() {
    let mut source = Source::seeded(41);
    for h in [0.02, 0.05] {
        let matrix = |a: &Square<f64, 3>| Matrix3::from_fn(|i, j| a.0[i][j]);
        let (j, m) = (matrix(&source.positive()), matrix(&source.positive()));
        let d = matrix(&source.matrix()) * 0.05;
        let c = Vector3::from(source.vector()) * 0.2;
        let z = Vector3::from(source.vector());
        let w = source.between(-0.3, 0.3);
        let turn: Square<f64, 3> = source.orthogonal();
        let turn = Rotation::from_matrix(&matrix(&turn)).expect("a rotation");
        let place = Vector3::from(source.vector());
        let [angular, linear] = [(); 2].map(|()| Vector3::from(source.vector()) * 0.3);
        let whole = Whole::new(WholeParameters {
            J: j,
            M: m,
            D: d,
            c,
            z,
            w,
        });
        let split = Split::new(SplitParameters {
            J: j,
            M: m,
            D: d,
            c,
            z,
            w,
        });
        let (whole, split) = (whole.expect("parameters"), split.expect("parameters"));
        let mut impulse = Vector6::zeros();
        impulse.fixed_rows_mut::<3>(0).copy_from(&angular);
        impulse.fixed_rows_mut::<3>(3).copy_from(&linear);
        let one = WholeInitial {
            G: RigidMotion {
                rotation: turn,
                translation: place,
            },
            body_momentum: BodyImpulse(impulse),
        };
        let other = SplitInitial {
            R: turn,
            body_momentum_R: BodyMomentum(angular),
            x: Additive::new(place),
            momentum_x: FieldMomentum(turn.matrix() * linear),
        };
        let (mut one, mut one_work) = whole.start(one, h).expect("solvable");
        let (mut other, mut other_work) = split.start(other, h).expect("solvable");
        for _ in 0..100 {
            whole.step(&mut one, &mut one_work).expect("solvable");
            split.step(&mut other, &mut other_work).expect("solvable");
        }
        let apart = (one.G().translation - other.x().matrix()).norm()
            + (one.G().rotation.matrix() - other.R().matrix()).norm();
        // A hundred steps with a few rounding errors each, amplified by the motion.
        assert!(apart < 1e-12, "{h}: {apart:e}");
    }
}
