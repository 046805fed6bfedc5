//! Fields and groups in one model, against the variation of the action in flat coordinates by dual numbers: four bodies of four
//! kinds, and a rigid motion stated as a rotation and a position.

use super::fields::{Flat, ROUNDING, at_ends, minus, of, worst};
use super::text_model::{Given, Motion, TextModel, given};
use clebsch::nalgebra::{Matrix3, Vector3, Vector6};
use clebsch::{RigidMotion, Rotation};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, cross, dot, hat};
use std::array::from_fn;

/// A rotation, a rigid motion, a unit quaternion and a field, bound by springs; the kinetic energy of
/// the field is quartic.
const MIXED_FOUR: &str = "model MixedFour {
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
}";

/// A body in a fluid, by its rigid motion.
const WHOLE: &str = "model Whole {
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
}";

/// The same, stated by its attitude and its position.
const SPLIT: &str = "model Split {
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
}";

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

/// Rotation and position of the rigid motion.
fn placed(motion: &Motion) -> (Matrix3<f64>, Vector3<f64>) {
    let g = motion.matrix::<4, 4>("G");
    let turn = g.fixed_view::<3, 3>(0, 0).into_owned();
    (turn, g.fixed_view::<3, 1>(0, 3).into_owned())
}

fn nodes_of(motion: &Motion) -> Vec<f64> {
    let (turn, place) = placed(motion);
    [
        motion.numbers("R"),
        turn.transpose().as_slice().to_vec(),
        place.as_slice().to_vec(),
        motion.numbers("q"),
        motion.numbers("X"),
    ]
    .concat()
}

fn matrix(a: &Square<f64, 3>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| a.0[i][j])
}

fn rotation(source: &mut Source) -> Rotation {
    Rotation::from_matrix(&matrix(&source.orthogonal())).expect("a rotation")
}

fn mixed(source: &mut Source, h: f64) -> (OfMixed, Given) {
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
    let [r, rotation, q] = [(); 3].map(|()| rotation(source));
    let own = given! {
        J: given.j, A: given.a, p: given.p, s: given.s, e: given.e, g: given.g,
        m: given.m, M: given.heavy, k: given.k, b: given.b, c: given.c,
        R: r, body_momentum_R: Vector3::from(source.vector()) * 0.3,
        G: RigidMotion { rotation, translation: Vector3::from(source.vector()) },
        body_momentum_G: Vector6::from(source.vector()) * 0.3,
        q: q.quaternion(), body_momentum_q: Vector3::from(source.vector()) * 0.3,
        X: source.vector::<3>(), momentum_X: Vector3::from(source.vector()) * 0.3,
    };
    (given, own)
}

#[test]
fn four_kinds_solve_the_unreduced_equations_together() {
    let mut source = Source::seeded(38);
    let model = TextModel::read(MIXED_FOUR);
    for h in [0.02, 0.1] {
        for _ in 0..10 {
            let (given, own) = mixed(&mut source, h);
            let found = worst(
                &given,
                &mut model.start(h, &own).expect("solvable"),
                nodes_of,
            );
            assert!(found < ROUNDING, "{found:e}");
        }
    }
}

#[test]
fn four_kinds_keep_their_total_momentum() {
    let mut source = Source::seeded(39);
    for h in [1e-1, 1e-4, 1e-8] {
        let (given, mut own) = mixed(&mut source, h);
        for (name, value) in &mut own {
            if name == "X" {
                *value = vec![0.0; 3];
            }
        }
        let axis = Vector3::from(given.g);
        let mut motion = TextModel::read(MIXED_FOUR)
            .start(h, &own)
            .expect("solvable");
        let about = |m: &Motion| {
            let [r, q] = ["R", "q"].map(|name| m.vector::<3>(&format!("spatial_momentum_{name}")));
            let impulse = m.vector::<6>("spatial_momentum_G");
            let field = m.vector::<3>("X").cross(&m.vector("momentum_X"));
            (r + q + impulse.fixed_rows::<3>(0) + field).dot(&axis)
        };
        let first = about(&motion);
        let mut scale = first.abs() + axis.norm();
        for _ in 0..2000 {
            motion.steps(1);
            let reach = motion.vector::<3>("X").norm() + placed(&motion).1.norm();
            let field = motion.vector::<3>("momentum_X").norm()
                + motion.vector::<6>("spatial_momentum_G").norm();
            scale = scale.max(axis.norm() * (1.0 + reach) * (1.0 + field));
        }
        // Rounding errors of 2000 steps, relative to the size of the momentum.
        let drift = (about(&motion) - first).abs() / scale;
        assert!(drift < 1e-12, "{h:e}: {drift:e}");
    }
}

/// A rigid motion equals a rotation and a position: two statements of one motion, on different groups and with different Jacobians.
#[test]
fn a_rotation_and_a_place_move_as_a_rigid_motion() {
    let mut source = Source::seeded(41);
    for h in [0.02, 0.05] {
        let common = given! {
            J: source.positive::<3>(), M: source.positive::<3>(), D: source.matrix::<3>().scaled(0.05),
            c: Vector3::from(source.vector()) * 0.2, z: source.vector::<3>(), w: source.between(-0.3, 0.3),
        };
        let turn = rotation(&mut source);
        let place = Vector3::from(source.vector());
        let [angular, linear] = [(); 2].map(|()| Vector3::from(source.vector()) * 0.3);
        let motion = RigidMotion {
            rotation: turn,
            translation: place,
        };
        let mut impulse = Vector6::zeros();
        impulse.fixed_rows_mut::<3>(0).copy_from(&angular);
        impulse.fixed_rows_mut::<3>(3).copy_from(&linear);
        let one = [common.clone(), given! { G: motion, body_momentum: impulse }].concat();
        let split = given! {
            R: turn, body_momentum_R: angular, x: place, momentum_x: turn.matrix() * linear,
        };
        let mut one = TextModel::read(WHOLE).start(h, &one).expect("solvable");
        let other = [common, split].concat();
        let mut other = TextModel::read(SPLIT).start(h, &other).expect("solvable");
        one.steps(100);
        other.steps(100);
        let (turn, place) = placed(&one);
        let apart = (place - other.vector("x")).norm() + (turn - other.matrix("R")).norm();
        // A hundred steps with a few rounding errors each, amplified by the motion.
        assert!(apart < 1e-12, "{h}: {apart:e}");
    }
}
