//! Terms that couple both ends of a step to positions in forms other than the midpoint of the step. Loops over sites
//! support them, and the motion is stationary for the action typed by hand.

use clebsch::scalar::largest;
use clebsch::{Dual, Real};
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory};
use nalgebra::{Matrix3, Vector3};

type D = Dual<1>;

const N: usize = 40;
const H: f64 = 0.05;

/// A ring of a model that is run by loops.
fn ring(source: &str, numbers: &dyn Fn(&str) -> Option<Vec<f64>>) -> LineTrajectory {
    let model = LineModel::read(source).expect("loops over sites take it");
    let statement = pipeline::parse_source(source).expect("is a model");
    let lattice = Lattice::read(&statement).expect("has labels");
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", N).expect("has sites");
    let choice = choice.with_ring(&lattice).expect("closes");
    model.start(&choice, H, numbers).expect("starts")
}

/// An observable at three successive nodes.
fn three(line: &mut LineTrajectory, name: &str) -> [Vec<f64>; 3] {
    // The initial data are arbitrary.
    line.step().expect("steps");
    [0, 1, 2].map(|node| {
        if node > 0 {
            line.step().expect("steps");
        }
        line.observe(name).expect("is observed")
    })
}

/// Numbers between -1 and 1, the same in every run.
fn scattered(n: usize, by: f64) -> Vec<f64> {
    (1..=n).map(|i| (by * i as f64).sin()).collect()
}

/// The action of an edge, from the positions at its two ends.
type Numbers = fn(&[D], &[D]) -> D;

/// The largest derivative of the sum of two edges at their common node, relative to the largest derivative of one edge.
fn of_numbers(action: Numbers, [a, b, c]: &[Vec<f64>; 3]) -> f64 {
    let lifted = |x: &[f64]| -> Vec<D> { x.iter().map(|x| D::constant(*x)).collect() };
    let (before, after) = (lifted(a), lifted(c));
    let each = (0..b.len()).map(|i| {
        let mut here = lifted(b);
        here[i] = D::variable(b[i], 0);
        let (into, out) = (action(&before, &here), action(&here, &after));
        let [into, out] = [into.dual[0], out.dual[0]];
        [(into + out).abs(), larger(into, out)]
    });
    let each: Vec<[f64; 2]> = each.collect();
    largest(each.iter().map(|x| x[0])) / largest(each.iter().map(|x| x[1]))
}

fn larger(a: f64, b: f64) -> f64 {
    a.abs().max(b.abs())
}

fn places(source: &str) -> [Vec<f64>; 3] {
    let mut line = ring(source, &|name| match name {
        "m" => Some(vec![1.3]),
        "c" => Some(vec![0.4]),
        "k" => Some(vec![0.7]),
        "q" => Some(scattered(N, 1.7).iter().map(|x| 0.5 * x).collect()),
        "momentum_q" => Some(scattered(N, 0.9)),
        _ => None,
    });
    three(&mut line, "q")
}

fn joined(q: &[D], to: &[D], weight: impl Fn(D, D, D, D) -> D, c: f64) -> D {
    let number = D::constant;
    let n = q.len();
    let mut sum = number(0.0);
    for i in 0..n {
        let j = (i + 1) % n;
        let [d, e] = [i, j].map(|k| to[k] - q[k]);
        sum += number(1.3 / (2.0 * H)) * d * d;
        sum += number(c / H) * weight(q[i], q[j], to[i], to[j]) * d * e;
        let r = q[j] - q[i];
        sum -= number(0.7 * H / 2.0) * r * r;
    }
    sum
}

/// One rounding of the terms of an equation, which `1/h` enlarges; Newton's method leaves a few.
const ROUNDED: f64 = 1e-13;

#[test]
fn a_coefficient_of_two_velocities_depends_on_the_places_at_the_start() {
    let source = |weight: &str| {
        format!(
            "model Joined {{ label i in 0..N; periodic; param m, c, k: Real; field q: Real at nodes;
             let d = (next(q) - q)/h; let e = next(d, i); let r = next(q, i) - q;
             lagrangian = h*m*d^2/2 + h*c*{weight}*d*e - (h/2)*k*r^2; }}"
        )
    };
    let found = places(&source("cos(r)"));
    let action: Numbers = |q, to| joined(q, to, |a, b, _, _| (b - a).cos(), 0.4);
    assert!(
        of_numbers(action, &found) < ROUNDED,
        "{}",
        of_numbers(action, &found)
    );
    // The same term at the end of the step gives another action.
    let other: Numbers = |q, to| joined(q, to, |_, _, a, b| (b - a).cos(), 0.4);
    assert!(of_numbers(other, &found) > 1e-6);
    let found = places(&source("cos(next(r))"));
    assert!(
        of_numbers(other, &found) < ROUNDED,
        "{}",
        of_numbers(other, &found)
    );
    assert!(of_numbers(action, &found) > 1e-6);
}

/// Attitudes of sites, row after row.
fn attitudes(list: &[f64]) -> Vec<Matrix3<D>> {
    let each = list.chunks(9);
    each.map(|x| Matrix3::from_row_slice(x).map(D::constant))
        .collect()
}

fn diagonal(x: [f64; 3]) -> Matrix3<D> {
    Matrix3::from_diagonal(&Vector3::from(x).map(D::constant))
}

fn hat(v: &Vector3<D>) -> Matrix3<D> {
    let zero = D::constant(0.0);
    Matrix3::new(zero, -v[2], v[1], v[2], zero, -v[0], -v[1], v[0], zero)
}

const J: [f64; 3] = [1.0, 0.7, 0.5];
const B: [f64; 3] = [0.4, 0.3, 0.6];

/// The action of an edge of turning sites, with the potential `weight` of `e·z` before and after.
fn turning(r: &[Matrix3<D>], to: &[Matrix3<D>], potential: fn(D, D) -> D) -> D {
    let (j, b, h) = (diagonal(J), diagonal(B), D::constant(H));
    let [e, z] = [[0.3, -0.5, 0.8], [0.0, 0.6, 0.8]].map(|v| Vector3::from(v).map(D::constant));
    let mut sum = D::constant(0.0);
    for i in 0..r.len() {
        let next = (i + 1) % r.len();
        sum -= (j * r[i].transpose() * to[i]).trace() / h;
        let half = h * D::constant(0.5);
        sum += half * (b * r[i].transpose() * r[next]).trace();
        sum += half * (b * to[i].transpose() * to[next]).trace();
        sum -= h * potential((r[i] * e).dot(&z), (to[i] * e).dot(&z));
    }
    sum
}

#[test]
fn potentials_join_attitudes_at_both_ends_in_any_form() {
    let mean: fn(D, D) -> D = |a, b| (a + b) * (a + b) * D::constant(0.25);
    let product: fn(D, D) -> D = |a, b| a * b;
    for (stated, potential, other) in [
        ("dot((Λ + next(Λ))*e, z)^2/4", mean, product),
        ("(dot(Λ*e, z) + dot(next(Λ)*e, z))^2/4", mean, product),
        ("dot(Λ*e, z)*dot(next(Λ)*e, z)", product, mean),
    ] {
        let source = format!(
            "model Turning {{ label i in 0..N; periodic; param e, z: Vec<3>; param J, B: Sym<3>;
             group Λ: SO<3> at nodes velocity Ω; constraint next(Λ) = Λ*Ω;
             lagrangian = -tr(J*Ω)/h + h*tr(B*Λ^T*next(Λ, i)) - h*{stated}; }}"
        );
        let square = |x: [f64; 3]| vec![x[0], 0.0, 0.0, 0.0, x[1], 0.0, 0.0, 0.0, x[2]];
        let mut line = ring(&source, &|name| match name {
            "e" => Some(vec![0.3, -0.5, 0.8]),
            "z" => Some(vec![0.0, 0.6, 0.8]),
            "J" => Some(square(J)),
            "B" => Some(square(B)),
            "Λ" => Some(
                (0..N)
                    .flat_map(|i| {
                        let turn = Vector3::new(0.3, 0.1 * i as f64, -0.2);
                        let r = nalgebra::Rotation3::new(turn);
                        r.matrix().transpose().as_slice().to_vec()
                    })
                    .collect(),
            ),
            "body_momentum_Λ" => Some(scattered(3 * N, 1.1)),
            _ => None,
        });
        let found = three(&mut line, "Λ").map(|x| attitudes(&x));
        let derivative = |potential: fn(D, D) -> D| {
            let [a, b, c] = &found;
            let mut sums = Vec::new();
            for at in 0..3 * N {
                let mut here = b.clone();
                let mut v = Vector3::repeat(D::constant(0.0));
                v[at % 3] = D::variable(0.0, 0);
                here[at / 3] *= Matrix3::identity() + hat(&v);
                let into = turning(a, &here, potential).dual[0];
                let out = turning(&here, c, potential).dual[0];
                sums.push([(into + out).abs(), larger(into, out)]);
            }
            largest(sums.iter().map(|x| x[0])) / largest(sums.iter().map(|x| x[1]))
        };
        assert!(
            derivative(potential) < ROUNDED,
            "{stated}: {}",
            derivative(potential)
        );
        assert!(derivative(other) > 1e-6, "{stated}");
    }
}
