//! Errata of chapter 5 of the thesis, particles on a grid. Each test evaluates the printed and the correct form; the printed form
//! fails, and the correct form holds to rounding.

use super::common::*;
use super::depth::spline;
use clebsch::mesh::*;
use clebsch::nalgebra::{Matrix4, Vector4};
use clebsch::{Dual, Real};

const LENGTH: f64 = 1.5;

const CELLS: usize = 12;

/// A one-dimensional basin with particles of different masses.
fn basin() -> (Setting<1>, Vec<f64>, Vec<f64>) {
    let of = setting(Domain::basin([LENGTH]), [CELLS], 40);
    let mut numbers = Numbers::new(51);
    let at = numbers.list(40).iter().map(|x| x * LENGTH).collect();
    let mass = numbers.list(40).iter().map(|m| 0.5 + m).collect();
    (of, at, mass)
}

/// (5.8) without its factor: the splines of a node and its images at all particles.
fn gathered(at: &[f64], mass: &[f64]) -> Vec<f64> {
    let spacing = LENGTH / CELLS as f64;
    let node = |i: usize| {
        let one = |x: f64| spline(3, x / spacing - i as f64);
        let each = at.iter().zip(mass);
        each.map(|(x, m)| m * (one(*x) + one(-x) + one(2.0 * LENGTH - x)))
            .sum()
    };
    (0..=CELLS).map(node).collect()
}

#[test]
fn five_8_weighs_by_the_inverse_of_the_integral_of_the_spline() {
    let (of, at, mass) = basin();
    let weights = Nodes::new(&of).expect("a grid").weights::<f64>();
    let spacing = LENGTH / CELLS as f64;
    let whole = sum(mass.iter().copied());
    let on_grid = |factor: f64| {
        let all = gathered(&at, &mass).into_iter().zip(&weights);
        sum(all.map(|(h, w)| factor * h * w))
    };
    // The integral of the spline is the spacing.
    assert!((on_grid(spacing) / whole - 1.0).abs() > 0.9);
    assert!((on_grid(1.0 / spacing) / whole - 1.0).abs() < 1e-14);
    let mut deposit = deposit::<f64, 1>::new(&of, (&mass,)).expect("a grid");
    let found = values(&mut deposit, &at);
    for (found, expected) in found.iter().zip(gathered(&at, &mass)) {
        assert!((found - expected / spacing).abs() < 1e-12);
    }
}

/// The potential energy with these node weights, and its derivative with respect to one position.
fn slope(of: &Setting<1>, at: &[f64], mass: &[f64], weights: &[f64], particle: usize) -> f64 {
    type T = Dual<1>;
    let wide = |all: &[f64]| all.iter().map(|x| T::constant(*x)).collect::<Vec<_>>();
    let mut moved = wide(at);
    moved[particle].dual = [1.0];
    let mut deposit = deposit::<T, 1>::new(of, (&wide(mass),)).expect("a grid");
    let mut smooth = smooth::<T, 1>::new(of, (T::constant(0.3),)).expect("a grid");
    let h = values(&mut deposit, &moved);
    let s = values(&mut smooth, &h);
    let all = weights.iter().zip(h).zip(s);
    let energy = all.fold(T::constant(0.0), |sum, ((w, h), s)| {
        sum + T::from_f64(w / 2.0) * h * s
    });
    energy.dual[0]
}

#[test]
fn five_15_gives_nodes_on_walls_a_whole_weight() {
    let (of, at, mass) = basin();
    let spacing = LENGTH / CELLS as f64;
    let mut deposit = deposit::<f64, 1>::new(&of, (&mass,)).expect("a grid");
    let mut smooth = smooth::<f64, 1>::new(&of, (0.3,)).expect("a grid");
    let h = values(&mut deposit, &at);
    let s = values(&mut smooth, &h);
    // (5.14): the smoothed depth, continued evenly to the node behind each wall, with the slopes of all splines.
    let force = |a: usize| {
        let change = |x: f64| {
            let along = |i: i32| {
                let node = (i.unsigned_abs() as usize).min(2 * CELLS - i.unsigned_abs() as usize);
                let u = x / spacing - f64::from(i);
                // The slope of a cubic spline is a difference of two quadratic splines.
                s[node] * (spline(2, u + 0.5) - spline(2, u - 0.5)) / spacing
            };
            (-1..=CELLS as i32 + 1).map(along).sum::<f64>()
        };
        mass[a] * change(at[a])
    };
    let size = largest((0..at.len()).map(force));
    let plain = vec![spacing; CELLS + 1];
    let weights = Nodes::new(&of).expect("a grid").weights::<f64>();
    let off = |weights: &[f64]| {
        let each = |a| slope(&of, &at, &mass, weights, a) - force(a);
        largest((0..at.len()).map(each)) / size
    };
    assert!(off(&plain) > 0.5, "{}", off(&plain));
    assert!(off(&weights) < 1e-12, "{:e}", off(&weights));
}

#[test]
fn section_5_3_the_smoothing_matrix_is_not_symmetric() {
    let of = setting(Domain::basin([LENGTH]), [CELLS], 0);
    let weights = Nodes::new(&of).expect("a grid").weights::<f64>();
    let mut smooth = smooth::<f64, 1>::new(&of, (0.3,)).expect("a grid");
    let unit = |j: usize| (0..=CELLS).map(|i| f64::from(i == j)).collect::<Vec<_>>();
    let columns: Vec<_> = (0..=CELLS).map(|j| values(&mut smooth, &unit(j))).collect();
    let s = |i: usize, j: usize| columns[j][i];
    let pairs = || (0..=CELLS).flat_map(|i| (0..i).map(move |j| (i, j)));
    assert!(largest(pairs().map(|(i, j)| s(i, j) - s(j, i))) > 0.05);
    let weighted = pairs().map(|(i, j)| weights[i] * s(i, j) - weights[j] * s(j, i));
    assert!(largest(weighted) < 1e-16);
    // (5.25) therefore needs the transpose on the right; otherwise it does not preserve constants.
    let all = || 0..=CELLS;
    let rows = all().map(|i| sum(all().map(|j| s(i, j))) - 1.0);
    let columns = all().map(|j| sum(all().map(|i| s(i, j))) - 1.0);
    assert!(largest(rows) < 1e-15);
    assert!(largest(columns) > 0.05);
}

#[test]
fn five_28_has_the_wave_numbers_of_a_period_of_2_pi() {
    let of = setting(Domain::torus([LENGTH]), [CELLS], 0);
    let alpha = 0.3;
    let mut smooth = smooth::<f64, 1>::new(&of, (alpha,)).expect("a grid");
    let k = 2.0 * core::f64::consts::PI / LENGTH;
    let places = Nodes::new(&of).expect("a grid").places();
    let wave: Vec<f64> = places.iter().map(|x| (k * x[0]).cos()).collect();
    let found = values(&mut smooth, &wave);
    assert!((found[0] - 1.0 / (1.0 + (alpha * k).powi(2))).abs() < 1e-14);
    assert!((found[0] - 1.0 / (1.0 + alpha * alpha)).abs() > 0.3);
}

/// One step of (5.16) for a particle of unit mass in the potential `|X|²/2`, with this sign of the rotation term.
fn step(state: Vector4<f64>, f: f64, dt: f64, sign: f64) -> Vector4<f64> {
    let [x, y, u, v] = [state[0], state[1], state[2], state[3]];
    // `P1 = P0 - dt/2 (X + sign f k x (P0 + P1)/2)`, with `k x P = (-v, u)`.
    let half = |[x, y]: [f64; 2], [u, v]: [f64; 2]| {
        let b = sign * f * dt / 4.0;
        let (p, q) = (u - dt / 2.0 * x + b * v, v - dt / 2.0 * y - b * u);
        let determinant = 1.0 + b * b;
        [(p + b * q) / determinant, (q - b * p) / determinant]
    };
    let middle = half([x, y], [u, v]);
    let at = [x + dt * middle[0], y + dt * middle[1]];
    let [u, v] = half(at, middle);
    Vector4::new(at[0], at[1], u, v)
}

/// The centred rotation between kicks, where `(X1 - X0)/dt` is the mean of the velocities before and after.
fn centred(state: Vector4<f64>, f: f64, dt: f64) -> Vector4<f64> {
    let b = f * dt / 2.0;
    let [x, y] = [state[0], state[1]];
    let (u, v) = (state[2] - dt / 2.0 * x, state[3] - dt / 2.0 * y);
    let (p, q) = ((u + b * v) / (1.0 + b * b), (v - b * u) / (1.0 + b * b));
    let at = [x + dt * p, y + dt * q];
    let (u, v) = (p + b * q, q - b * p);
    Vector4::new(at[0], at[1], u - dt / 2.0 * at[0], v - dt / 2.0 * at[1])
}

/// The exact rotation between kicks.
fn exact(state: Vector4<f64>, f: f64, dt: f64) -> Vector4<f64> {
    let (sin, cos) = (f * dt).sin_cos();
    let [x, y] = [state[0], state[1]];
    let (u, v) = (state[2] - dt / 2.0 * x, state[3] - dt / 2.0 * y);
    let at = [
        x + (u * sin + v * (1.0 - cos)) / f,
        y + (v * sin - u * (1.0 - cos)) / f,
    ];
    let (u, v) = (cos * u + sin * v, cos * v - sin * u);
    Vector4::new(at[0], at[1], u - dt / 2.0 * at[0], v - dt / 2.0 * at[1])
}

#[test]
fn five_16_turns_the_wrong_way() {
    // (5.14) at rest in the middle: `P' = -f k x P = f (v, -u)`, up to rounding over the step size and first-order terms.
    let (f, dt) = (1.3, 1e-6);
    let state = Vector4::new(0.0, 0.0, 0.7, -0.4);
    let wanted = [f * state[3], -f * state[2]];
    let off = |sign: f64| {
        let rate = (step(state, f, dt, sign) - state) / dt;
        (rate[2] - wanted[0]).abs() + (rate[3] - wanted[1]).abs()
    };
    assert!(off(-1.0) > 1.0 && off(1.0) < 1e-5);
}

#[test]
fn five_16_is_not_symplectic() {
    let (f, dt) = (1.3, 0.3);
    // `dX ∧ dU - f dX ∧ dY`, with X and U = P/m, which equals the two-form in canonical momenta.
    let mut form = Matrix4::zeros();
    for (i, j, entry) in [(0, 2, 1.0), (1, 3, 1.0), (0, 1, -f)] {
        form[(i, j)] = entry;
        form[(j, i)] = -entry;
    }
    let defect = |step: &dyn Fn(Vector4<f64>) -> Vector4<f64>| {
        let columns = [0, 1, 2, 3].map(|i| step(Matrix4::identity().column(i).into()));
        let tangent = Matrix4::from_columns(&columns);
        (tangent.transpose() * form * tangent - form).amax()
    };
    assert!(defect(&|z| step(z, f, dt, 1.0)) > 1e-3);
    assert!(defect(&|z| centred(z, f, dt)) < 1e-15);
    assert!(defect(&|z| exact(z, f, dt)) < 1e-15);
}
