//! Checks that every emitted step is a Poisson map of the derived Lie-Poisson bracket: `D B D^T = B` at the image, with exact
//! derivatives. Covers models on both sides, with tensors and with several bodies. A bracket with a wrong sign fails, and so do
//! quantities from different nodes.

use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::{BodyMomentum, Dual, Rotation, SpatialMomentum};
use clebsch_core::derive::bracket::Space;
use clebsch_core::derive::invariants::Family;
use clebsch_core::interpret::{Assignment, Matrix, evaluate};
use clebsch_core::{Derivation, derive_source, expr};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

clebsch::model! {
    model Body {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}
clebsch::model! {
    model Top {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
    }
}
clebsch::model! {
    model TopInSpace {
        param w: Real;
        param z: Vec<3>;
        group Λ: SO<3> velocity ω;
        advected J: Sym<3>;
        advected chi: Vec<3>;
        constraint next(Λ) = ω*Λ;
        constraint next(J) = ω*J*ω^T;
        constraint next(chi) = ω*chi;
        lagrangian = -tr(ω*J)/h - h*w*dot(chi, z);
    }
}
clebsch::model! {
    model Joined {
        param J1, J2: Sym<3>;
        param d1, d2: Vec<3>;
        param eps: Real;
        group Λ1: SO<3> velocity Ω1;
        group Λ2: SO<3> velocity Ω2;
        advected R: SO<3> = Λ1^T*Λ2;
        constraint next(Λ1) = Λ1*Ω1;
        constraint next(Λ2) = Λ2*Ω2;
        constraint next(R) = Ω1^T*R*Ω2;
        lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;
    }
}

/// Tolerance relative to the largest entry, well above the rounding error of a product of three matrices with up to twelve rows and
/// entries of order one.
const TOLERANCE: f64 = 1e-10;

/// One step: the derivation, the points before and after, and the Jacobian in the coordinates of the bracket.
struct Step {
    derivation: Derivation,
    before: Assignment,
    after: Assignment,
    jacobian: Vec<Vec<f64>>,
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
    assert_eq!(d.len(), n);
    let mut worst = 0.0f64;
    for i in 0..n {
        for j in 0..n {
            let mut sum = -image.get(i, j);
            for k in 0..n {
                for l in 0..n {
                    sum += d[i][k] * b.get(k, l) * d[j][l];
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

fn constants<const N: usize, const R: usize, const C: usize>(
    m: &SMatrix<f64, R, C>,
) -> SMatrix<Dual<N>, R, C> {
    m.map(Dual::constant)
}

fn variables<const N: usize>(v: &Vector3<f64>, first: usize) -> Vector3<Dual<N>> {
    Vector3::from_fn(|i, _| Dual::variable(v[i], first + i))
}

/// Upper triangle, row by row.
const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

fn gradients<const N: usize>(x: impl IntoIterator<Item = Dual<N>>) -> Vec<Vec<f64>> {
    x.into_iter().map(|x| x.dual.to_vec()).collect()
}

fn set<const N: usize, const R: usize, const C: usize>(
    to: &mut Assignment,
    name: &str,
    m: &SMatrix<Dual<N>, R, C>,
) {
    let rows: Vec<f64> = (0..R * C).map(|k| m[(k / C, k % C)].real).collect();
    to.set(name, 0, R, C, &rows);
}

/// `X^T dX` as an axial vector.
fn turns<const N: usize>(x: &Matrix3<Dual<N>>) -> Vec<Vec<f64>> {
    let value = x.map(|e| e.real);
    let entry = |r: usize, c: usize| -> Vec<f64> {
        (0..N)
            .map(|k| (value.transpose() * x.map(|e| e.dual[k]))[(r, c)])
            .collect()
    };
    vec![entry(2, 1), entry(0, 2), entry(1, 0)]
}

fn vector(draws: &mut Draws) -> Vector3<f64> {
    let start = draws.heavy_top();
    Vector3::from_row_slice(&start.body_momentum).normalize() * 0.9
}

fn rotation<const N: usize>(draws: &mut Draws) -> Rotation<Dual<N>> {
    let start = draws.heavy_top();
    let q = start.attitude.0.map(Dual::constant);
    Rotation::from_quaternion(q).expect("a unit quaternion")
}

fn poinsot(scale: f64) -> Matrix3<f64> {
    Matrix3::new(1.1, 0.1, 0.0, 0.1, 1.4, -0.2, 0.0, -0.2, 1.9) * scale
}

fn body(draws: &mut Draws) -> Step {
    type T = Dual<3>;
    let model = Body::<T>::new(BodyParameters {
        J: constants(&poinsot(1.0)),
    })
    .expect("a body");
    let mu = variables::<3>(&vector(draws), 0);
    let initial = BodyInitial {
        Λ: rotation(draws),
        body_momentum: BodyMomentum(mu),
    };
    let (mut state, mut work) = model.start(initial, T::constant(0.1)).expect("solvable");
    model.step(&mut state, &mut work).expect("solvable");
    let (mut before, mut after) = (Assignment::new(), Assignment::new());
    set(&mut before, "μ", &mu);
    let moved = state.body_momentum().0;
    set(&mut after, "μ", &moved);
    Step {
        derivation: derive_source(Body::<f64>::SOURCE).expect("derives"),
        before,
        after,
        jacobian: gradients(moved.iter().copied()),
    }
}

/// The heavy top. With `late`, pairs the vertical of the next node with the momentum of this node.
fn top(draws: &mut Draws, late: bool) -> Step {
    type T = Dual<6>;
    let attitude = rotation::<6>(draws);
    let (mu, gamma) = (
        variables::<6>(&vector(draws), 0),
        variables::<6>(&vector(draws), 3),
    );
    let model = Top::<T>::new(TopParameters {
        J: constants(&poinsot(1.0)),
        gU: constants(&Vector3::new(0.4, -0.3, 0.9)),
        z: attitude.rotate(&gamma),
    })
    .expect("a top");
    let initial = TopInitial {
        Λ: attitude,
        body_momentum: BodyMomentum(mu),
    };
    let (mut state, mut work) = model.start(initial, T::constant(0.1)).expect("solvable");
    let (mut before, mut after) = (Assignment::new(), Assignment::new());
    let mut own = (state.body_momentum().0, model.Γ(&state));
    model.step(&mut state, &mut work).expect("solvable");
    let mut moved = (state.body_momentum().0, model.Γ(&state));
    if late {
        // Both points, and both ends of the derivative, combine the momentum of one node with the vertical of the next; this map is
        // not Poisson.
        own.1 = moved.1;
        model.step(&mut state, &mut work).expect("solvable");
        moved.1 = model.Γ(&state);
    }
    set(&mut before, "μ", &own.0);
    set(&mut before, "Γ", &own.1);
    set(&mut after, "μ", &moved.0);
    set(&mut after, "Γ", &moved.1);
    let columns = |pair: &(Vector3<T>, Vector3<T>)| {
        let rows = gradients(pair.0.iter().chain(&pair.1).copied());
        SMatrix::<f64, 6, 6>::from_fn(|i, j| rows[i][j])
    };
    let d = columns(&moved) * columns(&own).try_inverse().expect("coordinates");
    Step {
        derivation: derive_source(Top::<f64>::SOURCE).expect("derives"),
        before,
        after,
        jacobian: (0..6)
            .map(|i| (0..6).map(|j| d[(i, j)]).collect())
            .collect(),
    }
}

fn top_in_space(draws: &mut Draws) -> Step {
    type T = Dual<12>;
    let value = poinsot(1.0);
    let mut j = constants::<12, 3, 3>(&value);
    for (k, (r, c)) in UPPER.into_iter().enumerate() {
        j[(r, c)] = T::variable(value[(r, c)], 3 + k);
        j[(c, r)] = j[(r, c)];
    }
    let (m, chi) = (
        variables::<12>(&vector(draws), 0),
        variables::<12>(&vector(draws), 9),
    );
    let model = TopInSpace::<T>::new(TopInSpaceParameters {
        w: T::constant(1.3),
        z: constants(&Vector3::new(0.0, 0.6, 0.8)),
    })
    .expect("a top");
    let initial = TopInSpaceInitial {
        Λ: rotation(draws),
        spatial_momentum: SpatialMomentum(m),
        J: j,
        chi,
    };
    let (mut state, mut work) = model.start(initial, T::constant(0.1)).expect("solvable");
    let (mut before, mut after) = (Assignment::new(), Assignment::new());
    set(&mut before, "m", &m);
    set(&mut before, "J", &j);
    set(&mut before, "chi", &chi);
    model.step(&mut state, &mut work).expect("solvable");
    let (m, j, chi) = (
        state.spatial_momentum().0,
        model.J(&state),
        model.chi(&state),
    );
    set(&mut after, "m", &m);
    set(&mut after, "J", &j);
    set(&mut after, "chi", &chi);
    let tensor = UPPER.map(|(r, c)| j[(r, c)]);
    Step {
        derivation: derive_source(TopInSpace::<f64>::SOURCE).expect("derives"),
        before,
        after,
        jacobian: gradients(m.iter().copied().chain(tensor).chain(chi.iter().copied())),
    }
}

fn joined(draws: &mut Draws) -> Step {
    type T = Dual<9>;
    let model = Joined::<T>::new(JoinedParameters {
        J1: constants(&poinsot(1.0)),
        J2: constants(&poinsot(1.2)),
        d1: constants(&Vector3::new(0.3, 0.0, 0.5)),
        d2: constants(&Vector3::new(-0.2, 0.4, 0.1)),
        eps: T::constant(0.5),
    })
    .expect("two bodies");
    let (first, second) = (
        variables::<9>(&vector(draws), 0),
        variables::<9>(&vector(draws), 3),
    );
    let axis = Vector3::from_fn(|i, _| T::variable(0.0, 6 + i));
    let initial = JoinedInitial {
        Λ1: rotation(draws),
        body_momentum_Λ1: BodyMomentum(first),
        Λ2: rotation::<9>(draws) * Rotation::exp(&axis),
        body_momentum_Λ2: BodyMomentum(second),
    };
    let (mut state, mut work) = model.start(initial, T::constant(0.1)).expect("solvable");
    let (mut before, mut after) = (Assignment::new(), Assignment::new());
    set(&mut before, "μ1", &first);
    set(&mut before, "μ2", &second);
    set(&mut before, "R", &model.R(&state));
    model.step(&mut state, &mut work).expect("solvable");
    let (first, second, r) = (
        state.body_momentum_Λ1().0,
        state.body_momentum_Λ2().0,
        model.R(&state),
    );
    set(&mut after, "μ1", &first);
    set(&mut after, "μ2", &second);
    set(&mut after, "R", &r);
    let mut jacobian = gradients(first.iter().chain(&second).copied());
    jacobian.extend(turns(&r));
    Step {
        derivation: derive_source(Joined::<f64>::SOURCE).expect("derives"),
        before,
        after,
        jacobian,
    }
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
