//! The body in any dimension: residual and steps against the oracle, invariants, order, solvability bound, and its solvers against
//! each other. The Manakov spectrum is computed here and not taken from the card.

use super::text_model::{Given, Motion, TextModel, cause, given};
use clebsch::card::Settings;
use clebsch::nalgebra::{DMatrix, SMatrix};
use clebsch::solvers::Method;
use clebsch::solvers::left_factor::{LeftFactor, Refusal};
use clebsch::{BodyMomentumMatrix, Orthogonal, StartError, StepCause};
use clebsch_models::body_n::{BodyN, BodyNConfiguration, BodyNInitial, BodyNParameters};
use clebsch_oracle::oracle::action::{DiscreteAction, momentum_out, sensitivity, stationarity};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

const H: f64 = 0.1;

/// The unreduced action of one step.
struct Body<const N: usize> {
    h: f64,
    c: Square<f64, N>,
}

impl<const N: usize> DiscreteAction<N, 1> for Body<N> {
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let c = Square::<T, N>::constant(&self.c).transpose();
        vec![-(c * tail[0].transpose() * head[0]).trace() / T::constant(self.h)]
    }
}

fn planes<const N: usize>() -> Vec<Square<f64, N>> {
    let pairs = (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            Square::from_entries(|r, c| {
                f64::from(u8::from((r, c) == (j, i))) - f64::from(u8::from((r, c) == (i, j)))
            })
        })
        .collect()
}

fn matrix<const N: usize>(a: &Square<f64, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| a.0[i][j])
}

fn square<const N: usize>(a: SMatrix<f64, N, N>) -> Square<f64, N> {
    Square::from_entries(|i, j| a[(i, j)])
}

/// A random factor, symmetric or not.
fn factor<const N: usize>(source: &mut Source, symmetric: bool) -> SMatrix<f64, N, N> {
    let p = matrix(&source.positive::<N>());
    match symmetric {
        true => p,
        false => p + matrix(&source.skew::<N>()) * 0.15,
    }
}

/// The model of the gallery.
fn body<const N: usize>() -> TextModel {
    TextModel::gallery("body-n").of_size(N)
}

/// A random start: attitude, and a momentum at this fraction of the bound for the step size `H`.
fn drawn<const N: usize>(
    source: &mut Source,
    c: SMatrix<f64, N, N>,
    fraction: f64,
) -> [SMatrix<f64, N, N>; 2] {
    let m = matrix(&source.skew::<N>());
    let reach = LeftFactor::new(c).expect("a factor").reach(&(m * H));
    [matrix(&source.orthogonal::<N>()), m * (fraction / reach)]
}

/// Data with such a momentum.
fn at_fraction<const N: usize>(source: &mut Source, c: SMatrix<f64, N, N>, fraction: f64) -> Given {
    let [attitude, momentum] = drawn(source, c, fraction);
    given! { C: c, Λ: attitude, body_momentum: momentum }
}

fn started<const N: usize>(h: f64, given: &Given) -> Motion {
    body::<N>().start(h, given).expect("solvable")
}

fn residual_and_steps<const N: usize>() {
    let mut source = Source::seeded(3);
    let (basis, steps) = (planes::<N>(), body::<N>());
    let mut worst = [0.0f64; 3];
    for point in 0..200 {
        let c = factor::<N>(&mut source, point % 2 == 0);
        let system = Body {
            h: source.between(0.1, 1.0),
            c: square(c),
        };
        let nodes: [[Square<f64, N>; 1]; 3] = from_fn(|_| [source.orthogonal()]);
        let oracle = stationarity(&system, &nodes, &basis);
        let model = BodyN::<N>::new(BodyNParameters { C: c }).expect("parameters");
        let [before, here, after] = nodes.map(|[node]| BodyNConfiguration {
            Λ: Orthogonal::from_matrix(&matrix(&node)).expect("a rotation"),
        });
        let found = model.balance(system.h, &before, &here, &after);
        for (i, found) in found.iter().enumerate() {
            // Components beyond the coordinates of this size are zero.
            let expected = oracle.derivative.get(i).copied().unwrap_or(0.0);
            worst[0] = worse(worst[0], (found - expected).abs() / oracle.scale);
        }
        // Steps from a state solve the equations of the unreduced action.
        let [attitude, momentum] = drawn(&mut source, c, 0.6);
        let system = Body { h: H, c: square(c) };
        let given = given! { C: c, Λ: attitude, body_momentum: momentum };
        let mut motion = steps
            .start_with(Settings::step(H).to_inquire(), &given)
            .expect("solvable");
        let mut nodes = [[motion.square("Λ")]; 3];
        for node in &mut nodes[1..] {
            motion.steps(1);
            *node = [motion.square("Λ")];
        }
        let residual = stationarity(&system, &nodes, &basis);
        let sensitive = sensitivity(&nodes, &basis, |n| {
            stationarity(&system, n, &basis).derivative
        });
        for r in &residual.derivative {
            worst[1] = worse(worst[1], r.abs() / (residual.scale + sensitive));
        }
        let out = momentum_out(&system, &nodes[0], &nodes[1], &basis);
        let pairs = (0..N).flat_map(|i| (i + 1..N).map(move |j| (i, j)));
        for (found, (i, j)) in out.derivative.iter().zip(pairs) {
            worst[2] = worse(
                worst[2],
                (found - momentum[(j, i)]).abs() / (out.scale + sensitive),
            );
        }
    }
    println!("n = {N}: {worst:?}");
    // A thousand rounding errors, amplified by the sensitivity to the entries of the group elements.
    assert!(worst.iter().all(|w| *w < 1e-13), "n = {N}: {worst:?}");
}

#[test]
fn residuals_and_steps_are_those_of_the_unreduced_action() {
    residual_and_steps::<3>();
    residual_and_steps::<4>();
    residual_and_steps::<5>();
    residual_and_steps::<6>();
    residual_and_steps::<8>();
}

/// `det(M + λ J²)` at several `λ`, relative to Hadamard's bound, the size of its summands.
fn spectrum<const N: usize>(m: &SMatrix<f64, N, N>, j: &SMatrix<f64, N, N>) -> Vec<f64> {
    let square = j * j;
    let lambdas = [0.25, 0.5, 1.0, 2.0].map(|x| x * m.norm() / square.norm());
    lambdas
        .iter()
        .map(|l| {
            let sum = DMatrix::from_fn(N, N, |i, k| m[(i, k)] + l * square[(i, k)]);
            sum.determinant() / (sum.norm() / (N as f64).sqrt()).powi(N as i32)
        })
        .collect()
}

fn keeps_spectrum<const N: usize>() {
    let mut source = Source::seeded(5);
    let j = factor::<N>(&mut source, true);
    let mut motion = started::<N>(H, &at_fraction(&mut source, j, 0.3));
    let start = motion.matrix::<N, N>("body_momentum");
    let first = spectrum(&start, &j);
    let (mut worst, mut moved) = (0.0f64, 0.0f64);
    let mut other: f64 = 0.0;
    let wrong = j + matrix(&square(SMatrix::from_diagonal_element(0.1)));
    let before = spectrum(&start, &wrong);
    for _ in 0..10_000 {
        motion.steps(1);
        let m = motion.matrix::<N, N>("body_momentum");
        for (a, b) in spectrum(&m, &j).iter().zip(&first) {
            worst = worse(worst, (a - b).abs());
        }
        for (a, b) in spectrum(&m, &wrong).iter().zip(&before) {
            other = worse(other, (a - b).abs());
        }
        moved = worse(moved, (m - start).amax());
    }
    println!("n = {N}: spectrum {worst:e}, of another matrix {other:e}, momentum {moved:e}");
    assert!(worst < 1e-12, "n = {N}: {worst:e}");
    // The momentum itself changes, and the spectrum with a different matrix is not conserved.
    assert!(moved > 1e-2 && other > 1e-6, "n = {N}: {moved:e} {other:e}");
}

#[test]
fn the_spectrum_of_manakov_is_kept() {
    keeps_spectrum::<3>();
    keeps_spectrum::<4>();
    keeps_spectrum::<5>();
    keeps_spectrum::<6>();
}

#[test]
fn spatial_momentum_of_the_edges_is_kept_for_a_hundred_thousand_steps() {
    let mut source = Source::seeded(6);
    for symmetric in [true, false] {
        let c = factor::<4>(&mut source, symmetric);
        let mut motion = started::<4>(H, &at_fraction(&mut source, c, 0.3));
        let first = motion.matrix::<4, 4>("spatial_momentum");
        let (mut worst, mut group) = (0.0f64, 0.0f64);
        // Every 64th of a hundred thousand edges.
        for _ in 0..1563 {
            let before = motion.matrix::<4, 4>("Λ");
            motion.steps(1);
            // Computed from the configurations alone, not from stored values.
            let a = before.transpose() * motion.matrix::<4, 4>("Λ") * c.transpose() / H;
            let m = before * (a - a.transpose()) * before.transpose();
            worst = worse(worst, (m - first).amax() / first.amax());
            let gram = before.transpose() * before - SMatrix::<f64, 4, 4>::identity();
            group = worse(group, gram.amax());
            motion.steps(63);
        }
        println!("momentum {worst:e}, group {group:e}");
        assert!(worst < 1e-12 && group < 1e-14, "{worst:e} {group:e}");
    }
}

#[test]
fn order_two() {
    let mut source = Source::seeded(7);
    let c = factor::<4>(&mut source, true);
    let given = at_fraction(&mut source, c, 0.3);
    let at = |h: f64| {
        let mut motion = started::<4>(h, &given);
        motion.steps((2.0 / h).round() as usize);
        ["Λ", "body_momentum"].map(|name| motion.matrix::<4, 4>(name))
    };
    let steps = [0.04, 0.02, 0.01, 0.005].map(at);
    // For order two, differences of neighbours decrease by a factor of four.
    let apart: Vec<(f64, f64)> = steps
        .windows(2)
        .map(|w| ((w[0][0] - w[1][0]).amax(), (w[0][1] - w[1][1]).amax()))
        .collect();
    for w in apart.windows(2) {
        let orders = [(w[0].0 / w[1].0).log2(), (w[0].1 / w[1].1).log2()];
        println!("{orders:?}");
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.05), "{orders:?}");
    }
}

/// The same body with assumptions about its factor.
const ASSUMED: &str = "model Assumed {
    dim n in 3..=4;
    param C: Mat<n>;
    assume C^T == C;
    group Λ: SO<n> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(C^T*Ω)/h;
}";

#[test]
fn with_a_factor_assumed_symmetric_steps_are_reversible_and_compose() {
    let (model, general) = (TextModel::read(ASSUMED).of_size(4), body::<4>().card);
    assert!(model.card.reversible && !general.reversible);
    assert_eq!((model.card.order, general.order), (2, 1));
    let mut source = Source::seeded(12);
    let c = factor::<4>(&mut source, true);
    let [attitude, momentum] = drawn(&mut source, c, 0.3);
    let given = |c: SMatrix<f64, 4, 4>| given! { C: c, Λ: attitude, body_momentum: momentum };
    let end = |order: u32, h: f64| {
        let settings = Settings::step(h).of_order(order);
        let mut motion = model
            .start_with(settings, &given(c))
            .expect("a symmetric factor");
        motion.steps((1.0 / h).round() as usize);
        motion.observed()
    };
    let exact = end(8, 0.02);
    for (order, steps) in [(2, [0.05, 0.025]), (4, [0.1, 0.05])] {
        let [coarse, fine] = steps.map(|h| {
            let pairs = end(order, h).into_iter().zip(exact.clone());
            pairs.fold(0.0_f64, |m, (a, b)| worse(m, (a - b).abs()))
        });
        let found = (coarse / fine).log2();
        println!("order {order}: {found}, {coarse:e}, {fine:e}");
        assert!((found - f64::from(order)).abs() < 0.3, "{order}: {found}");
    }
    // The constructor checks the assumption.
    let turned = factor::<4>(&mut source, false);
    assert!(model.start(H, &given(turned)).is_err());
}

fn bound<const N: usize>() {
    let mut source = Source::seeded(8);
    let c = factor::<N>(&mut source, false);
    let given = at_fraction(&mut source, c, 1.0 + 1e-6);
    let error = body::<N>().start(H, &given).expect_err("beyond the bound");
    let StepCause::LeftFactor(e) = cause(&error) else {
        panic!("{error}");
    };
    assert_eq!(e.refusal, Refusal::BeyondBound);
    assert!((e.ratio - 1.0 - 1e-6).abs() < 1e-9, "{e}");
    let largest = e.largest_step.expect("searched");
    assert!((largest / H - 1.0 + 1e-6).abs() < 1e-9, "{e}");
    assert!(body::<N>().start(largest, &given).is_ok());
    let given = at_fraction(&mut source, c, 1.0 - 1e-6);
    assert!(body::<N>().start(H, &given).is_ok());
}

#[test]
fn steps_beyond_the_bound_are_refused_with_the_largest_that_is_not() {
    bound::<4>();
    bound::<6>();
    bound::<8>();
}

fn solvers<const N: usize>(names: &[Method]) {
    let mut source = Source::seeded(9);
    let c = factor::<N>(&mut source, false);
    let given = at_fraction(&mut source, c, 0.5);
    let ends: Vec<_> = names
        .iter()
        .map(|method| {
            let settings = Settings {
                solver: Some(*method),
                ..Settings::step(H)
            };
            let mut motion = body::<N>().start_with(settings, &given).expect("solvable");
            motion.steps(100);
            motion.matrix::<N, N>("Λ")
        })
        .collect();
    for end in &ends {
        // A hundred steps with the rounding error of the invariant subspace.
        assert!((end - ends[0]).amax() < 1e-11, "n = {N}");
    }
}

#[test]
fn solvers_by_name_agree() {
    solvers::<3>(&Method::ALL);
    solvers::<4>(&[Method::LieNewton, Method::Sign, Method::Schur]);
    solvers::<7>(&[Method::LieNewton, Method::Sign, Method::Schur]);
    let mut source = Source::seeded(10);
    let c = factor::<4>(&mut source, true);
    let [attitude, momentum] = drawn(&mut source, c, 0.5);
    let model = BodyN::<4>::new(BodyNParameters { C: c }).expect("parameters");
    let initial = BodyNInitial {
        Λ: Orthogonal::from_matrix(&attitude).expect("a rotation"),
        body_momentum: BodyMomentumMatrix(momentum),
    };
    let refused = model.start_with(initial, H, Method::Kappa);
    let Err(StartError::Refused(StepCause::LeftFactor(e))) = refused else {
        panic!("kappa is for three dimensions");
    };
    assert_eq!(e.refusal, Refusal::DoesNotApply);
}

#[test]
fn cards_are_one_a_size() {
    let entry = clebsch_models::find("body-n").expect("in the gallery");
    let sizes: Vec<usize> = entry
        .cards()
        .iter()
        .map(|c| c.dimensions[0].value)
        .collect();
    assert_eq!(sizes, [4, 3, 5, 6, 7, 8]);
    for case in &entry.cases {
        let card = entry.card_of(case);
        assert_eq!(card.parameters[0].count(), case.parameters[0].len());
        let open = |settings| (card.open)(&case.parameters, &case.initial, settings);
        let plain = Settings::step(case.h);
        open(plain).expect("a good case").step().expect("solvable");
        for method in Method::ALL {
            let settings = Settings {
                solver: Some(method),
                ..plain
            };
            let offered = card.solvers.contains(&method.name());
            assert_eq!(open(settings).is_ok(), offered, "{} {method}", case.name);
        }
    }
    assert!((entry.card.sized)(&[9]).is_none());
}
