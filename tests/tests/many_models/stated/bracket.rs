//! Checks that every step is a Poisson map of the derived Lie-Poisson bracket: `D B D^T = B` at the image. Covers models on both
//! sides, with tensors and with several bodies. A bracket with a wrong sign fails, and so do quantities from different nodes. The
//! derivatives are differences of steps; the tests of the gallery take exact derivatives.

use super::stated_models::{COUPLED_BODIES, HEAVY_TOP_SPATIAL};
use super::text_model::{Given, Motion, TextModel, given};
use clebsch::Rotation;
use clebsch::card::Settings;
use clebsch::nalgebra::{DMatrix, Matrix3, Vector3};
use clebsch_core::derive::bracket::Space;
use clebsch_core::derive::invariants::Family;
use clebsch_core::interpret::{Assignment, Matrix, evaluate};
use clebsch_core::{Derivation, derive_source, expr};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

const BODY: &str = "model Body {
    param J: Sym<3>;
    group Λ: SO<3> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(J*Ω)/h;
}";
const TOP: &str = "model Top {
    param J: Sym<3>;
    param gU, z: Vec<3>;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
}";

/// Tolerance relative to the largest entry, well above the rounding error of a product of three matrices with up to twelve rows and
/// entries of order one.
const TOLERANCE: f64 = 1e-10;

/// The displacement of the differences. Their error is its sixth power, and the rounding of a step divided by it.
const APART: f64 = 1e-2;

/// One step: the derivation, the points before and after, and the Jacobian in the coordinates of the bracket.
struct Step {
    derivation: Derivation,
    before: Assignment,
    after: Assignment,
    jacobian: DMatrix<f64>,
}

fn values(m: &Matrix) -> &[f64] {
    &m.data
}

/// The largest entry of `D B D^T - B'` relative to the largest entry of `B'`; `change` modifies the brackets first.
fn defect(step: &Step, change: impl Fn(&mut Matrix)) -> f64 {
    let at = |point: &Assignment| {
        let mut b = step
            .derivation
            .bracket_matrix(Space::Reduced, point)
            .expect("all values are given");
        change(&mut b);
        b
    };
    let (b, image) = (at(&step.before), at(&step.after));
    let (d, n) = (&step.jacobian, b.rows);
    assert_eq!(d.shape(), (n, n));
    let mut worst = 0.0f64;
    for i in 0..n {
        for j in 0..n {
            let mut sum = -image.get(i, j);
            for k in 0..n {
                for l in 0..n {
                    sum += d[(i, k)] * b.get(k, l) * d[(j, l)];
                }
            }
            worst = worse(worst, sum.abs());
        }
    }
    let size = values(&image).iter().fold(0.0f64, |m, x| worse(m, x.abs()));
    worst / size
}

fn unchanged(_: &mut Matrix) {}

/// Flips the sign of the brackets of the first momentum with itself.
fn wrong_sign(b: &mut Matrix) {
    for i in 0..3 {
        for j in 0..3 {
            b.data[i * b.cols + j] = -b.data[i * b.cols + j];
        }
    }
}

/// Upper triangle, row by row.
const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// How a quantity varies.
#[derive(Clone, Copy)]
enum Varies {
    /// By all components.
    Freely,
    /// As a symmetric matrix.
    Symmetric,
    /// As a rotation.
    Turning,
}

/// A quantity of a bracket: its name there, the name of its observable, and how it varies.
type Quantity = (&'static str, &'static str, Varies);

/// A change in the coordinates of the bracket.
fn coordinates(varies: Varies, value: &[f64], change: &[f64]) -> Vec<f64> {
    match varies {
        Varies::Freely => change.to_vec(),
        Varies::Symmetric => UPPER.map(|(r, c)| change[3 * r + c]).to_vec(),
        // `X^T dX` as an axial vector.
        Varies::Turning => {
            let turned = Matrix3::from_row_slice(value).tr_mul(&Matrix3::from_row_slice(change));
            vec![turned[(2, 1)], turned[(0, 2)], turned[(1, 0)]]
        }
    }
}

fn seen(motion: &Motion, quantities: &[Quantity]) -> Vec<Vec<f64>> {
    quantities
        .iter()
        .map(|(_, name, _)| motion.numbers(name))
        .collect()
}

/// The derivative of lists of numbers along displacement `k` of `count`, by differences of sixth order.
fn derivative(k: usize, count: usize, run: &dyn Fn(&[f64]) -> Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut sum: Vec<Vec<f64>> = Vec::new();
    for (away, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        for sign in [1.0, -1.0] {
            let mut moved = vec![0.0; count];
            moved[k] = sign * away * APART;
            let found = run(&moved);
            sum.resize_with(found.len(), Vec::new);
            for (sum, list) in sum.iter_mut().zip(found) {
                sum.resize(list.len(), 0.0);
                for (sum, x) in sum.iter_mut().zip(list) {
                    *sum += sign * weight * x / (60.0 * APART);
                }
            }
        }
    }
    sum
}

/// A step of a model from the values that `start` gives for displacements. With `late`, pairs the second quantity of the next node
/// with the first quantity of this node.
fn step(text: &str, quantities: &[Quantity], late: bool, start: &dyn Fn(&[f64]) -> Given) -> Step {
    let model = TextModel::read(text);
    let run = |moved: &[f64]| {
        let one_step = Settings::step(0.1).to_inquire();
        let mut motion = model.start_with(one_step, &start(moved)).expect("solvable");
        let mut nodes = vec![seen(&motion, quantities)];
        for _ in 0..=usize::from(late) {
            motion.steps(1);
            nodes.push(seen(&motion, quantities));
        }
        if late {
            // Both points, and both ends of the derivative, combine the momentum of one node with the vertical of the next; this
            // map is not Poisson.
            nodes[0][1] = nodes[1][1].clone();
            nodes[1][1] = nodes[2][1].clone();
        }
        nodes.truncate(2);
        nodes.concat()
    };
    let derivation = derive_source(text).expect("derives");
    let count = quantities.iter().map(|(.., varies)| match varies {
        Varies::Symmetric => 6,
        _ => 3,
    });
    let count = count.sum();
    let values = run(&vec![0.0; count]);
    let mut columns = [(); 2].map(|()| Vec::new());
    for k in 0..count {
        let changes = derivative(k, count, &run);
        let half = quantities.len();
        for (node, columns) in columns.iter_mut().enumerate() {
            for (i, (.., varies)) in quantities.iter().enumerate() {
                let at = node * half + i;
                columns.extend(coordinates(*varies, &values[at], &changes[at]));
            }
        }
    }
    let [before, after] = columns.map(|c| DMatrix::from_vec(count, count, c));
    let assigned = |from: usize| {
        let mut out = Assignment::new();
        for ((name, ..), list) in quantities.iter().zip(&values[from..]) {
            let cols = if list.len() == 9 { 3 } else { 1 };
            out.set(name, 0, 3, cols, list);
        }
        out
    };
    Step {
        derivation,
        before: assigned(0),
        after: assigned(quantities.len()),
        jacobian: after * before.try_inverse().expect("coordinates"),
    }
}

fn vector(draws: &mut Draws) -> Vector3<f64> {
    let start = draws.heavy_top();
    Vector3::from_row_slice(&start.body_momentum).normalize() * 0.9
}

fn rotation(draws: &mut Draws) -> Rotation {
    Rotation::from_quaternion(draws.heavy_top().attitude.0).expect("a unit quaternion")
}

fn poinsot(scale: f64) -> Matrix3<f64> {
    Matrix3::new(1.1, 0.1, 0.0, 0.1, 1.4, -0.2, 0.0, -0.2, 1.9) * scale
}

/// Three displacements, from the given one on.
fn three(moved: &[f64], first: usize) -> Vector3<f64> {
    Vector3::from_row_slice(&moved[first..first + 3])
}

fn body(draws: &mut Draws) -> Step {
    let (mu, attitude) = (vector(draws), rotation(draws));
    let quantities = [("μ", "body_momentum", Varies::Freely)];
    step(BODY, &quantities, false, &|moved| {
        given! { J: poinsot(1.0), Λ: attitude, body_momentum: mu + three(moved, 0) }
    })
}

/// The heavy top. With `late`, pairs the vertical of the next node with the momentum of this node.
fn top(draws: &mut Draws, late: bool) -> Step {
    let attitude = rotation(draws);
    let (mu, gamma) = (vector(draws), vector(draws));
    let quantities = [
        ("μ", "body_momentum", Varies::Freely),
        ("Γ", "Γ", Varies::Freely),
    ];
    step(TOP, &quantities, late, &|moved| {
        given! {
            J: poinsot(1.0), gU: [0.4, -0.3, 0.9], z: attitude.rotate(&(gamma + three(moved, 3))),
            Λ: attitude, body_momentum: mu + three(moved, 0),
        }
    })
}

fn top_in_space(draws: &mut Draws) -> Step {
    let (m, chi, attitude) = (vector(draws), vector(draws), rotation(draws));
    let quantities = [
        ("m", "spatial_momentum", Varies::Freely),
        ("J", "J", Varies::Symmetric),
        ("chi", "chi", Varies::Freely),
    ];
    step(HEAVY_TOP_SPATIAL, &quantities, false, &|moved| {
        let mut j = poinsot(1.0);
        for ((r, c), x) in UPPER.into_iter().zip(&moved[3..]) {
            j[(r, c)] += x;
            j[(c, r)] = j[(r, c)];
        }
        given! {
            w: 1.3, z: [0.0, 0.6, 0.8], Λ: attitude, spatial_momentum: m + three(moved, 0), J: j,
            chi: chi + three(moved, 9),
        }
    })
}

fn joined(draws: &mut Draws) -> Step {
    let (first, second) = (vector(draws), vector(draws));
    let [one, two] = [(); 2].map(|()| rotation(draws));
    let quantities = [
        ("μ1", "body_momentum_Λ1", Varies::Freely),
        ("μ2", "body_momentum_Λ2", Varies::Freely),
        ("R", "R", Varies::Turning),
    ];
    step(COUPLED_BODIES, &quantities, false, &|moved| {
        given! {
            J1: poinsot(1.0), J2: poinsot(1.2), d1: [0.3, 0.0, 0.5], d2: [-0.2, 0.4, 0.1], eps: 0.5,
            Λ1: one, body_momentum_Λ1: first + three(moved, 0),
            Λ2: two * Rotation::exp(&three(moved, 6)), body_momentum_Λ2: second + three(moved, 3),
        }
    })
}

fn is_poisson(name: &str, step: &Step) {
    let (right, wrong) = (defect(step, unchanged), defect(step, wrong_sign));
    assert!(right < TOLERANCE, "{name}: {right:e}");
    assert!(wrong > 1e4 * TOLERANCE, "{name}, wrong sign: {wrong:e}");
}

#[test]
fn steps_are_poisson_maps() {
    let mut draws = Draws::new(61);
    for _ in 0..20 {
        is_poisson("top", &top(&mut draws, false));
        is_poisson("top in space", &top_in_space(&mut draws));
        is_poisson("joined bodies", &joined(&mut draws));
        // The bracket of the free body is linear in one momentum, so its overall sign cancels.
        let right = defect(&body(&mut draws), unchanged);
        assert!(right < TOLERANCE, "body: {right:e}");
    }
}

#[test]
fn quantities_of_different_nodes_make_no_poisson_map() {
    let mut draws = Draws::new(62);
    for _ in 0..20 {
        let late = defect(&top(&mut draws, true), unchanged);
        assert!(late > 1e4 * TOLERANCE, "{late:e}");
    }
}

#[test]
fn casimirs_commute_with_everything() {
    let mut draws = Draws::new(63);
    for step in [
        body(&mut draws),
        top(&mut draws, false),
        top_in_space(&mut draws),
        joined(&mut draws),
    ] {
        let d = &step.derivation;
        let (s, spec) = (&d.letters.symbols, &d.spec);
        let b = d
            .bracket_matrix(Space::Reduced, &step.before)
            .expect("given");
        let momenta = d.letters.node_momentum.iter().copied();
        let letters: Vec<_> = momenta
            .chain(spec.advected.iter().map(|a| a.quantity))
            .collect();
        let casimirs = d.invariants.iter().filter(|v| v.family == Family::Casimir);
        let mut count = 0;
        for v in casimirs {
            let value = v.value.as_ref().expect("a formula");
            let mut gradient = Vec::new();
            for id in &letters {
                let at = expr::Letter {
                    symbol: *id,
                    shift: expr::Shift::HERE,
                };
                let g = evaluate(s, &expr::gradient(s, value, at), &step.before).expect("given");
                gradient.extend(match (s.get(*id).name.as_str(), g.rows * g.cols) {
                    // The derivative along a symmetric variation.
                    ("J", _) => UPPER
                        .map(|(i, j)| {
                            if i == j {
                                g.get(i, i)
                            } else {
                                g.get(i, j) + g.get(j, i)
                            }
                        })
                        .to_vec(),
                    ("R", _) => {
                        let r = evaluate(s, &expr::here(s, *id), &step.before).expect("given");
                        let r = Matrix3::from_row_slice(&r.data);
                        let turned = r.transpose() * Matrix3::from_row_slice(&g.data);
                        [(2, 1), (0, 2), (1, 0)]
                            .map(|(i, j)| turned[(i, j)] - turned[(j, i)])
                            .to_vec()
                    }
                    _ => g.data,
                });
            }
            let images =
                (0..b.rows).map(|i| (0..b.cols).map(|j| b.get(i, j) * gradient[j]).sum::<f64>());
            let worst = images.fold(0.0f64, |m, x: f64| worse(m, x.abs()));
            // A few dozen products of numbers of order one to ten.
            assert!(worst < 1e-12, "{}: {worst:e}", v.name);
            assert!(gradient.iter().any(|x| x.abs() > 1e-3), "{}", v.name);
            count += 1;
        }
        let (dimension, rank) = d.integrability.rank().expect("fixed sizes");
        assert_eq!(count, dimension - rank, "{}", spec.name);
    }
}
