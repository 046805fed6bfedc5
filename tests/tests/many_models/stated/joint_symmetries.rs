//! Momenta of symmetries that move several configurations together, or that change the action by a total difference, along emitted
//! steppers. They are conserved to rounding. If a statement breaks the symmetry, its list omits the momentum and the motion does
//! not conserve it.

use super::text_model::card;
use clebsch::card::{Card, Conserved, Settings, Trajectory};

/// A quaternion and a rotation in gravity, with coupled axes; each has its own vertical.
const TWO_VERTICALS: &str = "model TwoVerticals {
    param I, J: Sym<3>;
    param a, b, y, z, d, e: Vec<3>;
    param w: Real;
    group q: SU<2> velocity W;
    group Λ: SO<3> velocity Ω;
    constraint next(q) = q*W;
    constraint next(Λ) = Λ*Ω;
    lagrangian = (2/h)*dot(im(W), I*im(W)) - tr(J*Ω)/h
        - h*dot(a, rot(q)^T*z) - h*dot(b, Λ^T*y) - h*w*dot(rot(q)*d, Λ*e);
}";
/// The same with one vertical.
const ONE_VERTICAL: &str = "model OneVertical {
    param I, J: Sym<3>;
    param a, b, z, d, e: Vec<3>;
    param w: Real;
    group q: SU<2> velocity W;
    group Λ: SO<3> velocity Ω;
    constraint next(q) = q*W;
    constraint next(Λ) = Λ*Ω;
    lagrangian = (2/h)*dot(im(W), I*im(W)) - tr(J*Ω)/h
        - h*dot(a, rot(q)^T*z) - h*dot(b, Λ^T*z) - h*w*dot(rot(q)*d, Λ*e);
}";
/// A rigid motion and a rotation in gravity, coupled by their axes.
const MOTION_AND_ROTATION: &str = "model MotionAndRotation {
    param J, K: Sym<3>;
    param m, g, k: Real;
    param a, d, z: Vec<3>;
    group G: SE<3> velocity V;
    group Λ: SO<3> velocity Ω;
    constraint next(G) = G*V;
    constraint next(Λ) = Λ*Ω;
    let x = pos(next(G)) - pos(G);
    lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - tr(K*Ω)/h
        - h*m*g*dot(z, pos(G)) - h*k*dot(rot(G)*a, Λ*d);
}";
/// Two isotropic bodies whose potential depends on their relative rotation in space.
const ISOTROPIC: &str = "model Isotropic {
    param c, d: Real;
    param A: Mat<3>;
    group P: SO<3> velocity U;
    group Q: SO<3> velocity V;
    constraint next(P) = P*U;
    constraint next(Q) = Q*V;
    lagrangian = -(c*tr(U) + d*tr(V))/h - h*tr(A*P*Q^T);
}";
/// A potential that depends only on the angle of a rotation.
const ANGLE: &str = "model Angle {
    param c, k: Real;
    group Λ: SO<3> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -c*tr(Ω)/h + h*k*tr(Λ);
}";
/// A charged body in a uniform magnetic field: shifts change the action by a total difference.
const CHARGE: &str = "model Charge {
    param J: Sym<3>;
    param m: Real;
    param B: Vec<3>;
    group G: SE<3> velocity V;
    constraint next(G) = G*V;
    let x = pos(next(G)) - pos(G);
    lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) + dot(B, cross(pos(G), pos(next(G))))/2;
}";
/// An affine body whose potential contains one entry of its configuration.
const AFFINE: &str = "model Affine {
    param I0: Sym<3>;
    param a, b: Vec<3>;
    group Q: GL<3> velocity G;
    constraint next(Q) = Q*G;
    let D = next(Q) - Q;
    lagrangian = tr(D*I0*D^T)/(2*h) - h*dot(a, Q*b)^2;
}";

/// Each operation adds an independent error of 1e-16 of the scale; 500 steps of a few hundred operations reach about 1e-13, and the
/// margin is a factor of ten.
const ROUNDING: f64 = 1e-12;

const STEPS: usize = 500;
const STEP: f64 = 0.05;

fn open(card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>]) -> Box<dyn Trajectory> {
    let opened = (card.open)(parameters, initial, Settings::step(STEP));
    opened.unwrap_or_else(|e| panic!("{}: {e}", card.name))
}

/// Runs a model and compares the drift of every exact invariant with its scale; the invariants must include `wanted`.
fn hold(card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>], wanted: &[&str]) {
    for name in wanted {
        assert!(
            card.invariants.iter().any(|v| v.name == *name),
            "{name} in {}",
            card.name
        );
    }
    let mut run = open(card, parameters, initial);
    let count: usize = card.invariants.iter().map(|v| v.rows).sum();
    let mut first = vec![0.0; count];
    let (mut scales, mut now) = (first.clone(), first.clone());
    run.invariants(&mut first);
    run.scales(&mut scales);
    assert!(
        scales.iter().all(|s| s.is_finite() && *s > 0.0),
        "{}: {scales:?}",
        card.name
    );
    let mut moved = false;
    for node in 0..STEPS {
        run.step().unwrap_or_else(|e| panic!("{}: {e}", card.name));
        run.invariants(&mut now);
        let mut at = 0;
        for v in card.invariants {
            for i in at..at + v.rows {
                let off = (now[i] - first[i]).abs() / scales[i];
                match v.conserved {
                    Conserved::Exactly => {
                        assert!(
                            off < ROUNDING,
                            "{}, node {node}, {}: {off:e}",
                            card.name,
                            v.name
                        );
                    }
                    Conserved::Boundedly => moved |= off > 1e-9,
                }
            }
            at += v.rows;
        }
    }
    // The energy changes, so the momenta could have changed.
    let bounded = card
        .invariants
        .iter()
        .any(|v| matches!(v.conserved, Conserved::Boundedly));
    assert!(moved || !bounded, "{}", card.name);
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
const TILTED: [f64; 9] = [0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8];
const QUARTER: [f64; 4] = [0.5, 0.5, -0.5, 0.5];

fn inertia(d: [f64; 3]) -> Vec<f64> {
    vec![d[0], 0.1, 0.0, 0.1, d[1], 0.05, 0.0, 0.05, d[2]]
}

fn placed(turn: &[f64], place: [f64; 3]) -> Vec<f64> {
    let mut out = vec![0.0; 16];
    for (i, row) in turn.chunks(3).enumerate() {
        out[4 * i..4 * i + 3].copy_from_slice(row);
        out[4 * i + 3] = place[i];
    }
    out[15] = 1.0;
    out
}

/// Parameters of two bodies on different groups, with a common vertical or two different ones.
fn verticals(second: Option<[f64; 3]>) -> Vec<Vec<f64>> {
    let z = [0.0, 0.6, 0.8];
    let mut out = vec![
        inertia([0.9, 1.1, 1.6]),
        inertia([0.7, 1.3, 1.0]),
        vec![0.1, 0.2, -0.8],
        vec![0.4, -0.3, 0.2],
    ];
    out.extend(second.map(|y| y.to_vec()));
    out.extend([
        z.to_vec(),
        vec![0.3, 0.0, 0.4],
        vec![0.0, 0.5, -0.2],
        vec![0.5],
    ]);
    out
}

fn two_bodies() -> Vec<Vec<f64>> {
    vec![
        QUARTER.to_vec(),
        vec![0.3, -0.2, 0.6],
        TILTED.to_vec(),
        vec![-0.4, 0.5, 0.2],
    ]
}

#[test]
fn quaternion_and_rotation() {
    hold(
        &card(ONE_VERTICAL),
        &verticals(None),
        &two_bodies(),
        &["total_momentum_z"],
    );
}

/// The largest change of the sum of both spatial momenta along z.
fn vertical_drift(second: [f64; 3]) -> f64 {
    let card = &card(TWO_VERTICALS);
    assert!(
        card.invariants
            .iter()
            .all(|v| !v.name.contains("total_momentum"))
    );
    let mut run = open(card, &verticals(Some(second)), &two_bodies());
    let count: usize = card.observables.iter().map(|f| f.count()).sum();
    let total = |run: &dyn Trajectory| {
        let mut all = vec![0.0; count];
        run.observe(&mut all);
        let mut from = 0;
        let mut sum = 0.0;
        for f in card.observables {
            if f.name.starts_with("spatial_momentum") {
                sum += 0.6 * all[from + 1] + 0.8 * all[from + 2];
            }
            from += f.count();
        }
        sum
    };
    let first = total(run.as_ref());
    let mut worst = 0.0f64;
    for _ in 0..STEPS {
        run.step().unwrap_or_else(|e| panic!("{e}"));
        worst = worst.max((total(run.as_ref()) - first).abs());
    }
    worst
}

#[test]
fn a_second_vertical_breaks_the_sum() {
    assert!(vertical_drift([0.0, 0.6, 0.8]) < ROUNDING);
    assert!(vertical_drift([0.0, 0.8, 0.6]) > 1e-3);
}

#[test]
fn rigid_motion_and_rotation() {
    let parameters = [
        inertia([0.9, 1.1, 1.6]),
        inertia([0.7, 1.3, 1.0]),
        vec![1.5],
        // A weak weight, so that the body does not fall far: moments about a fixed origin are exact to rounding of |x| |p|.
        vec![0.02],
        vec![0.4],
        vec![0.1, 0.2, -0.8],
        vec![0.4, -0.3, 0.2],
        vec![0.0, 0.6, 0.8],
    ];
    let start = [
        placed(&TILTED, [0.3, -0.1, 0.2]),
        vec![0.3, -0.2, 0.6, 0.5, -0.4, 0.1],
        IDENTITY.to_vec(),
        vec![-0.4, 0.5, 0.2],
    ];
    let names = [
        "spatial_momentum_G_linear_across_z",
        "total_momentum_angular_z",
    ];
    hold(&card(MOTION_AND_ROTATION), &parameters, &start, &names);
}

#[test]
fn isotropic_bodies() {
    let parameters = [
        vec![0.8],
        vec![1.1],
        vec![0.3, 0.1, -0.2, 0.4, 0.2, 0.1, 0.0, -0.3, 0.5],
    ];
    let start = [
        TILTED.to_vec(),
        vec![0.3, -0.2, 0.6],
        IDENTITY.to_vec(),
        vec![-0.4, 0.5, 0.2],
    ];
    hold(
        &card(ISOTROPIC),
        &parameters,
        &start,
        &["total_body_momentum"],
    );
}

#[test]
fn space_and_body_together() {
    let start = [TILTED.to_vec(), vec![0.3, -0.2, 0.6]];
    hold(
        &card(ANGLE),
        &[vec![0.8], vec![0.5]],
        &start,
        &["joint_momentum"],
    );
}

#[test]
fn charge_in_a_uniform_field() {
    let parameters = [inertia([0.9, 1.1, 1.6]), vec![1.5], vec![0.3, -0.4, 0.9]];
    let start = [
        placed(&TILTED, [0.3, -0.1, 0.2]),
        vec![0.3, -0.2, 0.6, 0.5, -0.4, 0.1],
    ];
    hold(
        &card(CHARGE),
        &parameters,
        &start,
        &["spatial_momentum_linear", "spin"],
    );
}

#[test]
fn entries_that_the_potential_does_not_hold() {
    let parameters = [
        inertia([0.9, 1.1, 1.6]),
        vec![0.3, -0.4, 0.9],
        vec![0.5, 0.2, 0.1],
    ];
    let stretched = vec![1.1, 0.1, 0.0, 0.0, 0.9, 0.2, 0.1, 0.0, 1.0];
    let rate = vec![0.02, -0.01, 0.03, 0.02, 0.01, 0.0, -0.01, 0.02, 0.01];
    let names = [
        "coordinate_momentum_columns_across_a",
        "coordinate_momentum_rows_across_b",
    ];
    hold(&card(AFFINE), &parameters, &[stretched, rate], &names);
}
