//! Invariants of stated models along emitted steppers, for models outside the gallery, opened through their cards. Every exact
//! invariant holds to rounding, bounded invariants oscillate, and data that violate an assumption are rejected.

use super::text_model::{TextModel, card};
use clebsch::card::{Card, Conserved, Settings};
use clebsch_oracle::physics::measure::worse;

clebsch::model! {
    /// Lagrange's top, stated by assumptions on its parameters.
    model LagrangeTop {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        assume J*hat(E3) == hat(E3)*J;
        assume cross(gU, E3) == 0;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
    }
}

/// Two joined bodies, the first one hung up in gravity.
const HANGING_PAIR: &str = "model HangingPair {
    param J1, J2: Sym<3>;
    param d1, d2, g, z: Vec<3>;
    param eps: Real;
    group A: SO<3> velocity a;
    group B: SO<3> velocity b;
    advected R: SO<3> = A^T*B;
    advected G: Vec<3> = A^T*z;
    constraint next(A) = A*a;
    constraint next(B) = B*b;
    constraint next(R) = a^T*R*b;
    constraint next(G) = a^T*G;
    lagrangian = -(tr(J1*a) + tr(J2*b) + eps*dot((a - Id)*d1, R*(b - Id)*d2))/h - h*dot(g, G);
}";

/// Two bodies in the space frame whose axes attract each other.
const ATTRACTING_PAIR: &str = "model AttractingPair {
    param w: Real;
    group A: SO<3> velocity a;
    group B: SO<3> velocity b;
    advected J: Sym<3>;
    advected K: Sym<3>;
    advected p: Vec<3>;
    advected q: Vec<3>;
    constraint next(A) = a*A;
    constraint next(B) = b*B;
    constraint next(J) = a*J*a^T;
    constraint next(K) = b*K*b^T;
    constraint next(p) = a*p;
    constraint next(q) = b*q;
    lagrangian = -(tr(a*J) + tr(b*K))/h + h*w*dot(p, q);
}";

clebsch::model! {
    /// Free body in any dimension.
    model FreeBodyN {
        dim n in 4..=8;
        param C: Sym<n>;
        group Λ: SO<n> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(C*Ω)/h;
    }
}

/// The same in four dimensions, in the space frame.
const FREE_BODY_IN_SPACE: &str = "model FreeBodyInSpace {
    param C: Sym<4>;
    group Λ: SO<4> velocity ω;
    constraint next(Λ) = ω*Λ;
    lagrangian = -tr(C*Λ^T*next(Λ))/h;
}";

/// Ellipsoid, convective.
const ELLIPSOID: &str = "model Ellipsoid {
    param C0, I0: Sym<3>;
    param a: Real;
    group Q: GL<3> velocity G;
    advected C: Sym<3> = Q^T*C0*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*a*(tr(C*C)/4 - log(det(C))/2);
}";

/// Each operation adds an independent error of 1e-16 of the scale; 2000 steps of a few hundred operations reach about 1e-13.
const ROUNDING: f64 = 1e-12;

const STEPS: usize = 2_000;

/// Largest change of each invariant relative to its scale.
fn drifts(
    card: &Card,
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    h: f64,
) -> Vec<(String, bool, f64)> {
    let mut run = match (card.open)(parameters, initial, Settings::step(h)) {
        Ok(run) => run,
        Err(e) => panic!("{}: {e}", card.name),
    };
    let count: usize = card.invariants.iter().map(|v| v.rows).sum();
    let mut first = vec![0.0; count];
    let (mut scales, mut now, mut worst) = (first.clone(), first.clone(), first.clone());
    run.invariants(&mut first);
    run.scales(&mut scales);
    for _ in 0..STEPS {
        run.step().expect("solvable");
        run.invariants(&mut now);
        for i in 0..count {
            let off = (now[i] - first[i]).abs() / scales[i];
            worst[i] = worse(worst[i], off);
        }
    }
    let mut at = 0;
    card.invariants
        .iter()
        .map(|v| {
            let own = worst[at..at + v.rows].iter().copied().fold(0.0, worse);
            at += v.rows;
            (
                v.name.to_owned(),
                matches!(v.conserved, Conserved::Exactly),
                own,
            )
        })
        .collect()
}

fn hold(found: &[(String, bool, f64)], names: &[&str]) {
    println!("{found:?}");
    let listed: Vec<&str> = found.iter().map(|(n, ..)| n.as_str()).collect();
    assert_eq!(listed, names);
    for (name, exact, drift) in found {
        if *exact {
            assert!(*drift < ROUNDING, "{name}: {drift:e}");
        } else {
            // Bounded invariants visibly oscillate, so the measurement can detect a change.
            assert!(*drift > 1e-8 && *drift < 1e-1, "{name}: {drift:e}");
        }
    }
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
const TILTED: [f64; 9] = [0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8];

fn diagonal(d: [f64; 3]) -> Vec<f64> {
    vec![d[0], 0.0, 0.0, 0.0, d[1], 0.0, 0.0, 0.0, d[2]]
}

#[test]
fn lagrange_top() {
    let start = [TILTED.to_vec(), vec![0.1, -0.2, 1.0]];
    let parameters = |j: [f64; 3], g: [f64; 3]| vec![diagonal(j), g.to_vec(), vec![0.0, 0.0, 1.0]];
    let card = &card(LagrangeTop::<f64>::SOURCE);
    let found = drifts(
        card,
        &parameters([0.5, 0.5, 1.5], [0.0, 0.0, 1.3]),
        &start,
        0.1,
    );
    hold(
        &found,
        &["energy", "momentum_Gamma", "Gamma_squared", "momentum_E3"],
    );
    for (j, g, what) in [
        ([0.5, 0.6, 1.5], [0.0, 0.0, 1.3], "J"),
        ([0.5, 0.5, 1.5], [1e-9, 0.0, 1.3], "gU"),
    ] {
        let refused = (card.open)(&parameters(j, g), &start, Settings::step(0.1)).map(|_| ());
        let message = refused.expect_err("breaks an assumption").to_string();
        assert!(message.contains(what), "{message}");
    }
    // A deviation of a tenth of the last digit is parameter rounding and does not violate the assumption.
    let almost = parameters([0.5, 0.5, 1.5], [1e-17, 0.0, 1.3]);
    assert!((card.open)(&almost, &start, Settings::step(0.1)).is_ok());
}

#[test]
fn hanging_pair() {
    let j = diagonal([0.9, 1.1, 1.6]);
    let parameters = [
        j.clone(),
        j,
        vec![0.3, 0.0, 0.4],
        vec![0.0, 0.5, -0.2],
        vec![0.1, 0.2, -0.8],
        vec![0.0, 0.6, 0.8],
        vec![0.5],
    ];
    let start = [
        TILTED.to_vec(),
        vec![0.3, -0.2, 0.6],
        IDENTITY.to_vec(),
        vec![-0.4, 0.5, 0.2],
    ];
    let found = drifts(&card(HANGING_PAIR), &parameters, &start, 0.05);
    hold(&found, &["energy", "total_momentum_G", "G_squared"]);
}

#[test]
fn attracting_pair() {
    let start = [
        TILTED.to_vec(),
        vec![0.3, -0.2, 0.6],
        IDENTITY.to_vec(),
        vec![-0.4, 0.5, 0.2],
        diagonal([0.9, 1.1, 1.6]),
        diagonal([0.5, 1.5, 2.0]),
        vec![0.1, 0.2, -0.8],
        vec![0.6, 0.0, 0.7],
    ];
    let found = drifts(&card(ATTRACTING_PAIR), &[vec![0.7]], &start, 0.05);
    let casimirs = [
        "p_squared",
        "q_squared",
        "trace_J1",
        "trace_J2",
        "trace_J3",
        "trace_K1",
        "trace_K2",
        "trace_K3",
        "p_J_p",
        "q_K_q",
        "p_J2_p",
        "q_K2_q",
    ];
    hold(
        &found,
        &[&["energy", "total_momentum"][..], &casimirs].concat(),
    );
}

/// A row-major square matrix from a function of row and column.
fn square(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    (0..n * n).map(|k| entry(k / n, k % n)).collect()
}

/// A symmetric, nearly diagonal matrix.
fn inertia(n: usize) -> Vec<f64> {
    square(n, |i, j| match i == j {
        true => 1.0 + 0.3 * i as f64,
        false => 0.05 / (1.0 + i as f64 + j as f64),
    })
}

fn momentum(n: usize) -> Vec<f64> {
    let entry = |i: usize, j: usize| 0.4 / (1.0 + i as f64) - 0.1 * j as f64;
    square(n, |i, j| entry(i, j) - entry(j, i))
}

fn identity(n: usize) -> Vec<f64> {
    square(n, |i, j| f64::from(u8::from(i == j)))
}

#[test]
fn free_bodies_of_every_dimension() {
    let counts = [(4, 4), (5, 6), (6, 9), (7, 12), (8, 16)];
    for (n, count) in counts {
        let sized = TextModel::read(FreeBodyN::<4>::SOURCE).of_size(n).card;
        let manakov = sized.invariants.iter().find(|v| v.name == "manakov");
        assert_eq!(manakov.map(|v| v.rows), Some(count));
        let start = [identity(n), momentum(n)];
        let found = drifts(&sized, &[inertia(n)], &start, 0.1);
        let names = [
            "energy",
            "spatial_momentum",
            "momentum_squared",
            "trace_momentum4",
            "trace_momentum6",
            "trace_momentum8",
            "manakov",
        ];
        hold(&found, &names);
    }
    let found = drifts(
        &card(FREE_BODY_IN_SPACE),
        &[inertia(4)],
        &[identity(4), momentum(4)],
        0.1,
    );
    let traces = [
        "trace_C_space1",
        "trace_C_space2",
        "trace_C_space3",
        "trace_C_space4",
    ];
    hold(
        &found,
        &[&["energy", "spatial_momentum"][..], &traces, &["manakov"]].concat(),
    );
}

#[test]
fn ellipsoid() {
    let start = [
        square(3, |i, j| {
            f64::from(u8::from(i == j)) + 0.05 * (i as f64 - j as f64)
        }),
        square(3, |i, j| 0.1 * (i as f64 + 1.0) - 0.15 * j as f64),
    ];
    let found = drifts(
        &card(ELLIPSOID),
        &[identity(3), inertia(3), vec![0.7]],
        &start,
        0.02,
    );
    hold(
        &found,
        &[
            "energy",
            "angular_momentum_C_2",
            "spatial_momentum_skew_C0_inverse",
        ],
    );
}

#[test]
fn discrete_energies() {
    use clebsch::nalgebra::{Matrix3, Vector3};
    use clebsch::{BodyMomentum, Rotation};
    let model = LagrangeTop::new(LagrangeTopParameters {
        J: Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)),
        gU: Vector3::new(0.0, 0.0, 1.3),
        z: Vector3::z(),
    })
    .expect("a symmetric top");
    let initial = LagrangeTopInitial {
        Λ: Rotation::exp(&Vector3::new(0.5, 0.2, 0.0)),
        body_momentum: BodyMomentum(Vector3::new(0.3, -0.2, 1.0)),
    };
    // The mean of the energies of both ends, up to second-order terms in h.
    let gap = |h: f64| {
        let (mut state, mut work) = model.start(initial, h).expect("solvable");
        let before = state;
        model.step(&mut state, &mut work).expect("solvable");
        let mean = (model.energy(&before) + model.energy(&state)) / 2.0;
        (model.discrete_energy(h, &before, &state) - mean).abs()
    };
    let ratio = gap(0.02) / gap(0.01);
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    // For the free body, every edge has the same energy.
    let body = FreeBodyN::<4>::new(FreeBodyNParameters {
        C: clebsch::nalgebra::SMatrix::from_row_slice(&inertia(4)),
    })
    .expect("a body");
    let initial = FreeBodyNInitial {
        Λ: clebsch::Orthogonal::identity(),
        body_momentum: clebsch::BodyMomentumMatrix(clebsch::nalgebra::SMatrix::from_row_slice(
            &momentum(4),
        )),
    };
    let (mut state, mut work) = body.start(initial, 0.1).expect("solvable");
    let mut first = None;
    for _ in 0..500 {
        let before = state;
        body.step(&mut state, &mut work).expect("solvable");
        let now = body.discrete_energy(0.1, &before, &state);
        let first = *first.get_or_insert(now);
        // Traces of order one over h^2 = 0.01 cancel to the energy, which amplifies rounding a hundredfold.
        assert!((now - first).abs() < 1e-12, "{now} {first}");
    }
}
