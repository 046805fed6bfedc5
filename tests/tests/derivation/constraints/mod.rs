//! Enforced constraints. Compares the equations with constraint forces with the variation of the action with multipliers, by dual
//! numbers at random points that solve nothing. Also tests the motion on the constraint set, where multipliers are forces.

mod hinge;

use clebsch::card::Settings;
use clebsch::functions::carlson_rf;
use clebsch::integrate::Stepper;
use clebsch::nalgebra::{Matrix3, Vector2, Vector3};
use clebsch::{Additive, BodyMomentum, FieldMomentum, Problem, Rotation, StartError};
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use std::array::from_fn;

clebsch::model! {
    /// A mass on a rod of length L, and a second one on a rod that hangs from it.
    model DoublePendulum {
        param m, M, L, l, g: Real;
        field x, y: Vec<2>;
        hold a: dot(x, x) = L^2;
        hold b: dot(y - x, y - x) = l^2;
        let u = next(x) - x;
        let v = next(y) - y;
        lagrangian = (m*dot(u, u) + M*dot(v, v))/(2*h) - h*g*(m*x[2] + M*y[2]);
    }
}

clebsch::model! {
    /// A mass on a sphere.
    model Spherical {
        param m, L, g: Real;
        field x: Vec<3>;
        hold λ: dot(x, x) = L^2;
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*x[3];
    }
}

clebsch::model! {
    /// Two masses on spheres and a body, without coupling: three blocks, two of them constrained.
    model Apart {
        param m, M, L, l, g: Real;
        param J: Sym<3>;
        field x, y: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        hold a: dot(x, x) = L^2;
        hold b: dot(y, y) = l^2;
        let u = next(x) - x;
        let v = next(y) - y;
        lagrangian = (m*dot(u, u) + M*dot(v, v))/(2*h) - h*g*(m*x[3] + M*y[3]) - tr(J*Ω)/h;
    }
}

clebsch::model! {
    /// A deformable body of constant volume with self-gravity.
    model Drop {
        param I0: Sym<3>;
        param M: Real;
        given RF(Sym<3>): Real = clebsch::functions::carlson_rf;
        field Q: Mat<3>;
        hold λ: det(Q) = 1;
        lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) + h*(3/5)*M^2*RF(Q*Q^T);
    }
}

clebsch::model! {
    /// The same body, constrained by the sum of its squares.
    model Sphere {
        param I0: Sym<3>;
        param k: Real;
        field Q: Mat<3>;
        hold λ: tr(Q^T*Q) = 3;
        lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - h*k*Q[1, 1];
    }
}

clebsch::model! {
    /// A body about its centre of mass, suspended at a body-fixed point.
    model Hung {
        param J: Sym<3>;
        param m: Real;
        param a, g: Vec<3>;
        field X: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        hold n: X + Λ*a = 0;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - tr(J*Ω)/h + h*m*dot(g, X);
    }
}

/// The derivative of the action of two edges and of the multiplier terms along a direction at the node.
fn slope(node: &[f64], direction: &[f64], action: impl Fn(&[Dual]) -> Vec<Dual>) -> (f64, f64) {
    let moved: Vec<Dual> = node
        .iter()
        .zip(direction)
        .map(|(value, slope)| Dual {
            value: *value,
            slope: *slope,
        })
        .collect();
    let terms = action(&moved);
    let total: f64 = terms.iter().map(|t| t.slope).sum();
    (total, terms.iter().map(|t| t.slope.abs()).sum())
}

fn still(x: &[f64]) -> Vec<Dual> {
    x.iter().map(|v| Dual::constant(*v)).collect()
}

fn of(x: f64) -> Dual {
    Dual::constant(x)
}

fn square(m: f64, a: &[Dual], b: &[Dual]) -> Dual {
    let terms = a.iter().zip(b).map(|(a, b)| (*b - *a) * (*b - *a));
    of(m) * terms.fold(of(0.0), |sum, t| sum + t)
}

fn unit(n: usize, i: usize) -> Vec<f64> {
    (0..n).map(|j| f64::from(u8::from(i == j))).collect()
}

/// A few rounding errors in each of the terms, which are of order one.
const ROUNDING: f64 = 1e-13;

fn det(q: &[Dual]) -> Dual {
    q[0] * (q[4] * q[8] - q[5] * q[7])
        + q[1] * (q[5] * q[6] - q[3] * q[8])
        + q[2] * (q[3] * q[7] - q[4] * q[6])
}

/// ½ tr(V I0 V^T), with row-major entries.
fn kinetic(i0: &Matrix3<f64>, a: &[Dual], b: &[Dual]) -> Dual {
    let v: Vec<Dual> = a.iter().zip(b).map(|(a, b)| *b - *a).collect();
    let mut sum = of(0.0);
    for row in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                sum = sum + of(0.5 * i0[(j, k)]) * v[3 * row + j] * v[3 * row + k];
            }
        }
    }
    sum
}

fn random_matrix(source: &mut Source) -> Matrix3<f64> {
    Matrix3::from_fn(|_, _| source.between(-1.0, 1.0))
}

fn second_moments(source: &mut Source) -> Matrix3<f64> {
    let a = random_matrix(source);
    a * a.transpose() + Matrix3::identity()
}

/// Row-major matrix entries.
fn rows(m: &Matrix3<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

#[test]
fn reactions_are_the_variation_of_their_work() {
    let mut source = Source::seeded(71);
    for _ in 0..50 {
        let h = source.between(0.05, 0.5);
        let [m, big, long, short, g] = from_fn(|_| source.between(0.5, 2.0));
        let model = DoublePendulum::new(DoublePendulumParameters {
            m,
            M: big,
            L: long,
            l: short,
            g,
        })
        .expect("parameters");
        let nodes: [[f64; 4]; 3] = from_fn(|_| from_fn(|_| source.between(-1.0, 1.0)));
        let [a, b] = from_fn(|_| source.between(-3.0, 3.0));
        let at = |n: &[f64; 4]| DoublePendulumConfiguration {
            x: Additive::new(Vector2::new(n[0], n[1])),
            y: Additive::new(Vector2::new(n[2], n[3])),
            a,
            b,
        };
        let found = model.balance(h, &at(&nodes[0]), &at(&nodes[1]), &at(&nodes[2]));
        for i in 0..4 {
            let (wanted, scale) = slope(&nodes[1], &unit(4, i), |q| {
                let (before, after) = (still(&nodes[0]), still(&nodes[2]));
                let mut all = Vec::new();
                for (tail, head) in [(&before[..], q), (q, &after[..])] {
                    all.push(square(m / (2.0 * h), &tail[..2], &head[..2]));
                    all.push(square(big / (2.0 * h), &tail[2..], &head[2..]));
                }
                all.push(of(-h * g * m) * q[1] + of(-h * g * big) * q[3]);
                all.push(of(h * a) * (square(1.0, &still(&[0.0; 2]), &q[..2]) - of(long * long)));
                all.push(of(h * b) * (square(1.0, &q[..2], &q[2..]) - of(short * short)));
                all
            });
            assert!(
                (found[i] - wanted).abs() <= ROUNDING * scale,
                "{i}: {} {wanted}",
                found[i]
            );
            // Without the constraint forces, the equation differs.
            let free = model.balance(
                h,
                &at(&nodes[0]),
                &DoublePendulumConfiguration {
                    a: 0.0,
                    b: 0.0,
                    ..at(&nodes[1])
                },
                &at(&nodes[2]),
            );
            assert!((free[i] - wanted).abs() > 1e-6 * scale);
        }
    }
}

#[test]
fn reactions_on_matrices_have_their_metric_factors() {
    let mut source = Source::seeded(72);
    for _ in 0..30 {
        let h = source.between(0.05, 0.5);
        let (i0, big) = (second_moments(&mut source), source.between(0.5, 2.0));
        let nodes: [Matrix3<f64>; 3] =
            from_fn(|_| Matrix3::identity() + random_matrix(&mut source) * 0.3);
        let multiplier = source.between(-3.0, 3.0);
        let drop = Drop::new(DropParameters { I0: i0, M: big }).expect("parameters");
        let at = |q: &Matrix3<f64>| DropConfiguration {
            Q: Additive::new(*q),
            λ: multiplier,
        };
        let found = drop.balance(h, &at(&nodes[0]), &at(&nodes[1]), &at(&nodes[2]));
        let all: [Vec<f64>; 3] = from_fn(|i| rows(&nodes[i]));
        for i in 0..9 {
            let (wanted, scale) = slope(&all[1], &unit(9, i), |q| {
                let (before, after) = (still(&all[0]), still(&all[2]));
                // R_F along the direction of its argument, by its definition as an integral.
                let gravity = gravity(q);
                vec![
                    of(1.0 / h) * kinetic(&i0, &before, q),
                    of(1.0 / h) * kinetic(&i0, q, &after),
                    of(h * 0.6 * big * big) * gravity,
                    of(h * multiplier) * (det(q) - of(1.0)),
                ]
            });
            let off = (found[i] - wanted).abs() / scale;
            assert!(off <= 1e-11, "{i}: {off:e}");
        }
        let k = source.between(0.5, 2.0);
        let sphere = Sphere::new(SphereParameters { I0: i0, k }).expect("parameters");
        let at = |q: &Matrix3<f64>| SphereConfiguration {
            Q: Additive::new(*q),
            λ: multiplier,
        };
        let found = sphere.balance(h, &at(&nodes[0]), &at(&nodes[1]), &at(&nodes[2]));
        for i in 0..9 {
            let (wanted, scale) = slope(&all[1], &unit(9, i), |q| {
                let (before, after) = (still(&all[0]), still(&all[2]));
                vec![
                    of(1.0 / h) * kinetic(&i0, &before, q),
                    of(1.0 / h) * kinetic(&i0, q, &after),
                    of(-h * k) * q[0],
                    of(h * multiplier) * (square(1.0, &still(&[0.0; 9]), q) - of(3.0)),
                ]
            });
            assert!((found[i] - wanted).abs() <= ROUNDING * scale, "{i}");
        }
    }
}

/// ½ ∫ det(Q Qᵀ + s)^{-1/2} ds by the double exponential rule.
fn gravity(q: &[Dual]) -> Dual {
    let entry =
        |i: usize, j: usize| (0..3).fold(of(0.0), |sum, k| sum + q[3 * i + k] * q[3 * j + k]);
    let b: Vec<Dual> = (0..9).map(|at| entry(at / 3, at % 3)).collect();
    let step = 1.0 / 32.0;
    let mut sum = of(0.0);
    for k in -200..=200 {
        let t = step * f64::from(k);
        let s = (1.5 * t.sinh()).exp();
        let weight = 0.5 * s * 1.5 * t.cosh() * step;
        if !(weight.is_finite() && s < 1e40) {
            continue;
        }
        let mut shifted = b.clone();
        for i in [0, 4, 8] {
            shifted[i] = shifted[i] + of(s);
        }
        sum = sum + of(weight) / det(&shifted).sqrt();
    }
    sum
}

#[test]
fn reactions_turn_bodies() {
    let mut source = Source::seeded(73);
    for _ in 0..30 {
        let h = source.between(0.05, 0.5);
        let (j, m) = (second_moments(&mut source), source.between(0.5, 2.0));
        let [a, g, n]: [Vector3<f64>; 3] = from_fn(|_| Vector3::from(source.vector()));
        let model = Hung::new(HungParameters { J: j, m, a, g }).expect("parameters");
        let places: [Vector3<f64>; 3] = from_fn(|_| Vector3::from(source.vector()));
        let turns: [Rotation; 3] =
            from_fn(|_| Rotation::exp(&(Vector3::from(source.vector()) * 0.8)));
        let at = |i: usize| HungConfiguration {
            X: Additive::new(places[i]),
            Λ: turns[i],
            n,
        };
        let found = model.balance(h, &at(0), &at(1), &at(2));
        let matrices: [Matrix3<f64>; 3] = from_fn(|i| turns[i].matrix());
        for axis in 0..3 {
            // The derivative of Λ along Λ hat(e).
            let mut hat = Matrix3::zeros();
            let e = Vector3::from_fn(|i, _| f64::from(u8::from(i == axis)));
            for col in 0..3 {
                let unit = Vector3::from_fn(|i, _| f64::from(u8::from(i == col)));
                hat.set_column(col, &e.cross(&unit));
            }
            let moved = matrices[1] * hat;
            let edge = |tail: &Matrix3<f64>, head: &Matrix3<f64>| {
                -(j * tail.transpose() * head).trace() / h
            };
            let terms = [
                edge(&matrices[0], &moved),
                edge(&moved, &matrices[2]),
                h * n.dot(&(moved * a)),
            ];
            let (wanted, scale) = (
                terms.iter().sum::<f64>(),
                terms.iter().map(|t| t.abs()).sum::<f64>(),
            );
            assert!(
                (found[3 + axis] - wanted).abs() <= ROUNDING * scale,
                "{axis}"
            );
            let reaction = h * n[axis];
            let force = m / h * (2.0 * places[1][axis] - places[0][axis] - places[2][axis])
                + h * m * g[axis];
            let scale = reaction.abs() + force.abs() + m / h;
            assert!(
                (found[axis] - force - reaction).abs() <= ROUNDING * scale,
                "{axis}"
            );
        }
    }
}

/// A spherical pendulum: the constraint and its rate, the vertical momentum, the energy, and the multiplier as the tension of the
/// rod, to second order.
#[test]
fn a_pendulum_keeps_its_length_and_shows_its_tension() {
    let (m, long, g) = (1.3, 0.5, 9.81);
    let parameters = SphericalParameters { m, L: long, g };
    let model = Spherical::new(parameters).expect("parameters");
    let start = || SphericalInitial {
        x: Additive::new(Vector3::new(0.3, 0.0, -0.4)),
        momentum: FieldMomentum(Vector3::new(0.0, 0.6, 0.0)),
    };
    let mut errors = Vec::new();
    for steps in [100, 200, 400] {
        let h = 1.0 / f64::from(steps);
        let (mut state, mut work) = model.start(start(), h).expect("starts");
        let first = model.energy(&state);
        let mut largest = 0.0f64;
        for _ in 0..steps {
            let before = state;
            model.step(&mut state, &mut work).expect("steps");
            // The solver accepts a residual below sixteen rounding errors of its terms.
            assert!(model.constraint_lambda(&state).abs() < 1e-14);
            assert!(model.constraint_rate_lambda(&state).abs() < 1e-14);
            // The tension from the equation of motion, at the midpoint of the step.
            let tension = |s: &SphericalState| {
                let (x, p) = (s.x().matrix(), s.momentum().0);
                -(p.dot(&p) / m - m * g * x[2]) / (2.0 * long * long)
            };
            let mean = 0.5 * (tension(&before) + tension(&state));
            largest = largest.max((state.λ() - mean).abs());
        }
        assert!((model.energy(&state) - first).abs() < 1.0 * h * h * 50.0);
        errors.push(largest);
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "{errors:?}");
    }
}

/// Blocks with separate constraints: each moves as in a separate model, bit for bit.
#[test]
fn bodies_held_apart_move_as_each_alone() {
    let (h, g) = (0.01, 9.81);
    let ([m, big], [long, short]) = ([1.3, 2e4], [0.5, 0.25]);
    let parameters = ApartParameters {
        m,
        M: big,
        L: long,
        l: short,
        g,
        J: Matrix3::from_diagonal(&Vector3::new(0.3, 0.2, 0.4)),
    };
    let starts = [
        (Vector3::new(0.3, 0.0, -0.4), Vector3::new(0.0, 0.6, 0.0)),
        (Vector3::new(0.0, 0.15, 0.2), Vector3::new(9e3, 0.0, 0.0)),
    ];
    let model = Apart::new(parameters).expect("parameters");
    let initial = ApartInitial {
        x: Additive::new(starts[0].0),
        momentum_x: FieldMomentum(starts[0].1),
        y: Additive::new(starts[1].0),
        momentum_y: FieldMomentum(starts[1].1),
        Λ: Rotation::identity(),
        body_momentum_Λ: BodyMomentum(Vector3::new(0.4, -0.1, 0.2)),
    };
    let (mut state, mut work) = model.start(initial, h).expect("starts");
    let mut alone: Vec<_> = [(m, long), (big, short)]
        .into_iter()
        .zip(starts)
        .map(|((m, long), (x, p))| {
            let model = Spherical::new(SphericalParameters { m, L: long, g }).expect("parameters");
            let initial = SphericalInitial {
                x: Additive::new(x),
                momentum: FieldMomentum(p),
            };
            let (state, work) = model.start(initial, h).expect("starts");
            (model, state, work)
        })
        .collect();
    for _ in 0..500 {
        model.step(&mut state, &mut work).expect("steps");
        for (model, state, work) in &mut alone {
            model.step(state, work).expect("steps");
        }
        let [x, y] = [state.x().matrix(), state.y().matrix()];
        assert_eq!([x, y], [0, 1].map(|i| alone[i].1.x().matrix()));
        assert_eq!([state.a(), state.b()], [0, 1].map(|i| alone[i].1.λ()));
    }
}

/// A body suspended at a point moves like a body with moments about that point.
#[test]
fn a_hung_body_is_one_with_other_moments() {
    let j = Matrix3::from_diagonal(&Vector3::new(0.3, 0.2, 0.4));
    let (m, a) = (0.7, Vector3::new(0.1, -0.2, 0.5));
    let g = Vector3::new(0.0, 0.0, -1.0);
    let model = Hung::new(HungParameters { J: j, m, a, g }).expect("parameters");
    let inertia = |j: Matrix3<f64>| Matrix3::identity() * j.trace() - j;
    let turn = Vector3::new(0.4, 0.9, -0.3);
    // X = -Λ a.
    let momentum = -m * turn.cross(&a);
    let h = 1e-3;
    let initial = HungInitial {
        X: Additive::new(-a),
        momentum_X: FieldMomentum(momentum),
        Λ: Rotation::identity(),
        body_momentum_Λ: clebsch::BodyMomentum(inertia(j) * turn),
    };
    let (mut state, mut work) = model.start(initial, h).expect("starts");
    let steps = 500;
    for _ in 0..steps {
        model.step(&mut state, &mut work).expect("steps");
    }
    // The body about the fixed point, by a Runge-Kutta method: I dω/dt = Iω × ω - a × Λᵀ m g.
    let about = inertia(j + a * a.transpose() * m);
    let inverse = about.try_inverse().expect("regular");
    let rate = |w: Vector3<f64>, r: Matrix3<f64>| {
        let torque = (-a * m).cross(&(r.transpose() * g));
        let mut hat = Matrix3::zeros();
        for col in 0..3 {
            let unit = Vector3::from_fn(|i, _| f64::from(u8::from(i == col)));
            hat.set_column(col, &w.cross(&unit));
        }
        (inverse * ((about * w).cross(&w) + torque), r * hat)
    };
    let (mut w, mut r) = (turn, Matrix3::identity());
    for _ in 0..steps {
        let (a1, b1) = rate(w, r);
        let (a2, b2) = rate(w + a1 * (h / 2.0), r + b1 * (h / 2.0));
        let (a3, b3) = rate(w + a2 * (h / 2.0), r + b2 * (h / 2.0));
        let (a4, b4) = rate(w + a3 * h, r + b3 * h);
        w += (a1 + a2 * 2.0 + a3 * 2.0 + a4) * (h / 6.0);
        r += (b1 + b2 * 2.0 + b3 * 2.0 + b4) * (h / 6.0);
    }
    // Second order: a few times h².
    assert!(
        (state.Λ().matrix() - r).norm() < 3.0 * h * h,
        "{}",
        (state.Λ().matrix() - r).norm()
    );
    assert!((state.X().matrix() + state.Λ().matrix() * a).norm() < 1e-14);
}

#[test]
fn data_off_a_constraint_are_refused_with_numbers() {
    let model = Spherical::new(SphericalParameters {
        m: 1.0,
        L: 1.0,
        g: 1.0,
    })
    .expect("parameters");
    let start = |x: [f64; 3], p: [f64; 3]| {
        let initial = SphericalInitial {
            x: Additive::new(Vector3::from(x)),
            momentum: FieldMomentum(Vector3::from(p)),
        };
        model.start(initial, 0.01).map(|_| ())
    };
    assert!(start([0.6, 0.0, 0.8], [0.8, 0.3, -0.6]).is_ok());
    let Err(StartError::Initial(e)) = start([0.6, 0.0, 0.9], [0.0; 3]) else {
        panic!("off the sphere");
    };
    assert_eq!(e.field, "λ");
    assert!(
        matches!(e.problem, Problem::OffConstraint { size, .. } if (size - 0.17).abs() < 1e-12)
    );
    let Err(StartError::Initial(e)) = start([0.6, 0.0, 0.8], [0.6, 0.3, 0.8]) else {
        panic!("away from the sphere");
    };
    // The normal part of the momentum is 0.5 times the constraint gradient, which is twice the position.
    assert!(
        matches!(e.problem, Problem::AcrossConstraint { impulse, taken, .. }
            if (impulse - 0.5).abs() < 1e-12 && (taken - 1.0).abs() < 1e-12),
        "{e}"
    );
}

#[test]
fn a_drop_keeps_volume_and_angular_momentum() {
    let i0 = Matrix3::new(0.2, 0.03, 0.0, 0.03, 0.25, 0.01, 0.0, 0.01, 0.15);
    let model = Drop::new(DropParameters { I0: i0, M: 1.0 }).expect("parameters");
    let velocity = Matrix3::new(0.1, 0.5, 0.0, -0.4, 0.2, 0.1, 0.2, 0.0, -0.3);
    let initial = DropInitial {
        Q: Additive::new(Matrix3::identity()),
        momentum: FieldMomentum(velocity * i0),
    };
    let settings = Settings::step(0.02);
    let (mut state, mut work) = model.start(initial, settings.h).expect("starts");
    let angular = |s: &DropState| {
        let m = s.momentum().0 * s.Q().matrix().transpose();
        m - m.transpose()
    };
    let (first, energy) = (angular(&state), model.energy(&state));
    for _ in 0..2000 {
        model.advance(&mut state, &mut work).expect("steps");
    }
    // A thousand rounding errors of momenta of order one; without the metric factors the momentum would change by 3e-3.
    assert!((angular(&state) - first).norm() < 2e-13);
    assert!((state.Q().matrix().determinant() - 1.0).abs() < 1e-14);
    assert!((model.energy(&state) - energy).abs() < 1e-3);
    assert!((carlson_rf.value(&Matrix3::<f64>::identity()) - 1.0).abs() < 1e-15);
}
