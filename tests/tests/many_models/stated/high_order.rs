//! Orders above two, by step halving. Compositions of a heavy top and of a free body are compared with their Taylor series.
//! Compositions of coupled bodies and of a top outside the gallery (Newton's method) are compared with much finer steps. Also tests
//! modified moments in double-double arithmetic for a body outside the gallery, and the error for one-sided models.

use super::text_model::{Given, TextModel, card, given};
use clebsch::card::{OpenError, Settings};
use clebsch::integrate::{Composition, CompositionOrder};
use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::solvers::moser_veselov::Order;
use clebsch::{BodyMomentum, DoubleDouble, Real, Rotation};
use clebsch_models::heavy_top::HeavyTopParameters;
use clebsch_oracle::physics::measure::worse;

type Quad = DoubleDouble;

/// A top whose kinetic energy is not linear in the velocity.
const STIFF_TOP: &str = "model StiffTop {
    param J: Sym<3>;
    param K: Sym<3>;
    param c: Real;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3>;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*dot(Γ, K*Γ)/2 + (c/h)*tr(Ω - Id)^2;
}";

clebsch::model! {
    /// A free body with another name and sign.
    model Tumbler {
        scale -h;
        param P: Sym<3>;
        group R: SO<3> velocity W;
        constraint next(R) = R*W;
        lagrangian = tr(W*P);
    }
}

/// The heavy top with its weight at the end of each step.
const LATE_TOP: &str = "model LateTop {
    param J: Sym<3>;
    param gU: Vec<3>;
    param z: Vec<3>;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    node incoming;
    lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
}";

fn quad<const R: usize, const C: usize>(a: SMatrix<f64, R, C>) -> SMatrix<Quad, R, C> {
    a.map(Quad::from_f64)
}

fn poinsot() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.1, -0.05, 0.1, 1.2, 0.15, -0.05, 0.15, 0.7)
}

fn attitude() -> Rotation<Quad> {
    Rotation::exp(&quad(Vector3::new(0.3, -0.2, 0.5)))
}

/// The numbers of a state.
fn numbers(rotation: Rotation<Quad>, momentum: Vector3<Quad>) -> Vec<Quad> {
    let turned = rotation.matrix();
    turned.iter().chain(&momentum).copied().collect()
}

fn apart(a: &[Quad], b: &[Quad]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |m, (x, y)| worse(m, (*x - *y).magnitude()))
}

/// Measures each order by halving the step size of a run to the final state `end`.
fn measured(
    name: &str,
    steps: u32,
    end: impl Fn(CompositionOrder, u32) -> Vec<Quad>,
    exact: &[Quad],
) {
    for order in CompositionOrder::ALL {
        // At the step sizes of the other orders, the higher orders reach the rounding of their coefficients and of the steps.
        let steps = match order {
            CompositionOrder::Eight => steps / 8,
            CompositionOrder::Six => steps / 2,
            _ => steps,
        };
        let [coarse, fine] = [steps, 2 * steps].map(|n| apart(&end(order, n), exact));
        let measured = (coarse / fine).log2();
        println!("{name}, order {order}: {measured:.3} ({coarse:.1e}, {fine:.1e})");
        // The coefficients of the composition have rounding errors of 1e-16 of a step.
        assert!(fine > 1e-14, "{name}: {fine:e}");
        let nominal = f64::from(order.number());
        assert!((measured - nominal).abs() < 0.15, "{name}: {measured}");
    }
}

/// The final state of a composed run of a card over a time that is a power of two, so that step sizes are exact.
fn end(
    model: &TextModel,
    given: &Given,
    bodies: &[[&str; 2]],
    time: f64,
) -> impl Fn(CompositionOrder, u32) -> Vec<Quad> {
    move |order, steps| {
        let settings = Settings::step(time / f64::from(steps)).of_order(order.number());
        let mut motion = model.start_with(settings, given).expect("solvable");
        motion.steps(steps as usize);
        let parts = bodies.iter().flat_map(|[attitude, momentum]| {
            let turned = motion.matrix::<3, 3>(attitude).as_slice().to_vec();
            [turned, motion.numbers(momentum)].concat()
        });
        parts.map(Quad::from_f64).collect()
    }
}

/// Number of terms of the series.
const TERMS: usize = 26;

/// The motion of the heavy top `mu' = mu x w + Γ x gU`, `R' = R hat(w)`, `Γ = R^T z`, by its Taylor series; independent of all code
/// above.
fn series(
    start: (Matrix3<Quad>, Vector3<Quad>),
    top: &HeavyTopParameters<Quad>,
    time: f64,
) -> Vec<Quad> {
    let inertia = Matrix3::from_diagonal_element(top.J.trace()) - top.J;
    let inverse = clebsch::linalg::inverse(&inertia).expect("regular");
    let (mut attitude, mut momentum) = start;
    let pieces = 64;
    let h = Quad::from_f64(time / f64::from(pieces));
    for _ in 0..pieces {
        let (mut r, mut m) = (vec![attitude], vec![momentum]);
        for k in 0..TERMS {
            let (mut dr, mut dm) = (Matrix3::zeros(), Vector3::zeros());
            for j in 0..=k {
                let w = inverse * m[k - j];
                dr += r[j] * clebsch::linalg::hat(&w);
                dm += m[j].cross(&w);
            }
            dm += r[k].tr_mul(&top.z).cross(&top.gU);
            let over = Quad::from_f64(1.0) / Quad::from_f64((k + 1) as f64);
            r.push(dr * over);
            m.push(dm * over);
        }
        attitude = r.iter().rev().fold(Matrix3::zeros(), |s, x| s * h + x);
        momentum = m.iter().rev().fold(Vector3::zeros(), |s, x| s * h + x);
    }
    attitude.iter().chain(momentum.iter()).copied().collect()
}

const MOMENTUM: [f64; 3] = [0.2, -0.4, 0.9];

fn heavy_top() -> HeavyTopParameters<Quad> {
    HeavyTopParameters {
        J: quad(poinsot()),
        gU: quad(Vector3::new(0.1, -0.2, 0.6)),
        z: quad(Vector3::z()),
    }
}

#[test]
fn compositions_of_the_heavy_top() {
    let turned = Rotation::exp(&Vector3::new(0.3, -0.2, 0.5));
    let given = given! {
        J: poinsot(), gU: [0.1, -0.2, 0.6], z: [0.0, 0.0, 1.0], Λ: turned, body_momentum: MOMENTUM,
    };
    let start = (attitude().matrix(), quad(Vector3::from(MOMENTUM)));
    let exact = series(start, &heavy_top(), 4.0);
    let model = TextModel::gallery("heavy-top");
    let end = end(&model, &given, &[["Λ", "body_momentum"]], 4.0);
    measured("heavy top", 128, end, &exact);
}

fn free_body() -> (Tumbler<Quad>, TumblerInitial<Quad>, Vec<Quad>) {
    let model = Tumbler::new(TumblerParameters { P: quad(poinsot()) }).unwrap();
    let mu = quad(Vector3::from(MOMENTUM));
    let initial = TumblerInitial {
        R: attitude(),
        body_momentum: BodyMomentum(mu),
    };
    let weightless = HeavyTopParameters {
        gU: Vector3::zeros(),
        ..heavy_top()
    };
    let exact = series((attitude().matrix(), mu), &weightless, 4.0);
    (model, initial, exact)
}

/// In double-double arithmetic.
#[test]
fn compositions_of_the_free_body() {
    let (model, initial, exact) = free_body();
    let (start, _) = model.start(initial, Quad::from_f64(0.1)).unwrap();
    let end = |order: CompositionOrder, steps: u32| {
        let h = Quad::from_f64(4.0 / f64::from(steps));
        let mut state = start;
        let mut composed = Composition::start(&model, &state, h, order).expect("solvable");
        for _ in 0..steps {
            composed.step(&model, &mut state).expect("solvable");
        }
        numbers(state.R(), state.body_momentum().0)
    };
    measured("free body", 64, end, &exact);
}

#[test]
fn compositions_of_coupled_bodies() {
    let given = given! {
        J1: poinsot(), J2: Matrix3::from_diagonal(&Vector3::new(1.1, 0.8, 0.9)),
        d1: [0.3, 0.1, 0.0], d2: [-0.2, 0.4, 0.1], eps: 0.5,
        Λ1: Rotation::exp(&Vector3::new(0.3, -0.2, 0.5)), body_momentum_Λ1: MOMENTUM,
        Λ2: Rotation::identity(), body_momentum_Λ2: [-0.6, 0.1, 0.3],
    };
    let model = TextModel::gallery("coupled-bodies");
    let bodies = [["Λ1", "body_momentum_Λ1"], ["Λ2", "body_momentum_Λ2"]];
    let end = end(&model, &given, &bodies, 2.0);
    let exact = end(CompositionOrder::Eight, 512);
    measured("coupled", 32, end, &exact);
}

#[test]
fn compositions_of_a_model_in_no_gallery() {
    let given = given! {
        J: poinsot(), K: Matrix3::new(0.4, 0.2, 0.0, 0.2, 0.9, 0.1, 0.0, 0.1, 0.2), c: 0.05,
        Λ: Rotation::exp(&Vector3::new(0.3, -0.2, 0.5)), body_momentum: MOMENTUM, Γ: [0.6, 0.0, 0.8],
    };
    let model = TextModel::read(STIFF_TOP);
    let end = end(&model, &given, &[["Λ", "body_momentum"]], 4.0);
    let exact = end(CompositionOrder::Eight, 512);
    measured("in no gallery", 64, end, &exact);
}

#[test]
fn modified_moments_for_a_model_in_no_gallery() {
    let (model, initial, exact) = free_body();
    for order in Order::ALL {
        let error = |steps: u32| {
            let h = Quad::from_f64(4.0 / f64::from(steps));
            let (mut state, mut work) = model.start_with(initial, h, order).unwrap();
            for _ in 0..steps {
                model.step(&mut state, &mut work).unwrap();
            }
            apart(&numbers(state.R(), state.body_momentum().0), &exact)
        };
        let (coarse, fine) = (error(32), error(64));
        let measured = (coarse / fine).log2();
        println!("free, order {order}: {measured:.3} ({coarse:.1e}, {fine:.1e})");
        assert!(
            (measured - f64::from(order.number())).abs() < 0.15,
            "{order}: {measured}"
        );
    }
}

#[test]
fn cards_open_compositions_of_every_order() {
    let matrix = |m: Matrix3<f64>| m.transpose().as_slice().to_vec();
    let parameters = [matrix(poinsot()), vec![0.1, -0.2, 0.6], vec![0.0, 0.0, 1.0]];
    let mu = Vector3::new(0.2, -0.4, 0.9);
    let initial = [matrix(Matrix3::identity()), mu.as_slice().to_vec()];
    let card = TextModel::gallery("heavy-top").card;
    let time = 4.0;
    let end = |order: u32, steps: u32| {
        let settings = Settings::step(time / f64::from(steps)).of_order(order);
        let mut trajectory = (card.open)(&parameters, &initial, settings).expect("solvable");
        for _ in 0..steps {
            trajectory.step().expect("solvable");
        }
        let mut out = vec![0.0; card.observable_count()];
        trajectory.observe(&mut out);
        out.into_iter().map(Quad::from_f64).collect::<Vec<_>>()
    };
    let exact = end(8, 128);
    for (order, steps) in [(2, 32), (4, 32), (6, 32), (8, 16)] {
        let [coarse, fine] = [steps, 2 * steps].map(|n| apart(&end(order, n), &exact));
        let measured = (coarse / fine).log2();
        println!("card, order {order}: {measured:.3} ({coarse:.1e}, {fine:.1e})");
        assert!(
            (measured - f64::from(order)).abs() < 0.5,
            "{order}: {measured}"
        );
    }
}

#[test]
fn one_sided_models_offer_no_composition() {
    let card = card(LATE_TOP);
    assert_eq!((card.orders, card.reversible), (&[1][..], false));
    let matrix = |m: Matrix3<f64>| m.transpose().as_slice().to_vec();
    let parameters = [matrix(poinsot()), vec![0.1, -0.2, 0.6], vec![0.0, 0.0, 1.0]];
    let initial = [matrix(Matrix3::identity()), vec![0.2, -0.4, 0.9]];
    let open = |s: Settings| (card.open)(&parameters, &initial, s).map(|_| ());
    assert_eq!(open(Settings::step(0.1)), Ok(()));
    let refused = open(Settings::step(0.1).of_order(4)).unwrap_err();
    assert!(matches!(refused, OpenError::Order { asked: 4, .. }));
    assert!(refused.to_string().contains("node symmetric"), "{refused}");
    // With the weight split evenly between both ends, the same data work.
    let card = TextModel::gallery("heavy-top").card;
    for order in card.orders {
        let settings = Settings::step(0.1).of_order(*order);
        assert!(
            (card.open)(&parameters, &initial, settings).is_ok(),
            "{order}"
        );
    }
}

#[test]
fn compensation_is_made_where_it_is_known_and_refused_elsewhere() {
    let matrix = |m: Matrix3<f64>| m.transpose().as_slice().to_vec();
    let free = [matrix(poinsot())];
    let initial = [matrix(Matrix3::identity()), vec![0.2, -0.4, 0.9]];
    let card = TextModel::gallery("free-body").card;
    let open = |order: u32, compensated: bool| {
        let settings = Settings {
            compensated,
            ..Settings::step(0.1).of_order(order)
        };
        (card.open)(&free, &initial, settings)
    };
    for order in Settings::COMPENSATED {
        // Compensation changes the result by less than the error of a step; at order four the change exceeds rounding.
        let ends = [false, true].map(|compensated| {
            let mut trajectory = open(order, compensated).expect("solvable");
            for _ in 0..100 {
                trajectory.step().expect("solvable");
            }
            let mut out = vec![0.0; card.observable_count()];
            trajectory.observe(&mut out);
            out
        });
        let [plain, turned] = &ends;
        let apart = plain.iter().zip(turned).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, worse);
        assert!(apart < 1e-4, "{order}: {apart}");
        assert!(order > 4 || apart > 1e-12, "{order}: {apart}");
    }
    for order in [2, 10] {
        let refused = open(order, true).map(|_| ()).unwrap_err();
        assert!(matches!(refused, OpenError::Compensation { .. }), "{order}");
        assert!(refused.to_string().contains("leave out the compensation"));
    }
    // A composition is symplectic without compensation, so it rejects the option.
    let top = [matrix(poinsot()), vec![0.1, -0.2, 0.6], vec![0.0, 0.0, 1.0]];
    let settings = Settings {
        compensated: true,
        ..Settings::step(0.1).of_order(4)
    };
    let composed = TextModel::gallery("heavy-top").card;
    let refused = (composed.open)(&top, &initial, settings).map(|_| ());
    assert!(matches!(refused, Err(OpenError::Compensation { .. })));
}
