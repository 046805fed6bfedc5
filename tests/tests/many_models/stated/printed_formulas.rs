//! Checks that the printed formula of every invariant equals its function. Formulas are parsed and evaluated for all gallery
//! models, for models with terms linear in the velocity, and for a hundred random Lagrangians, whose energy follows from the
//! Lagrangian. A test checks that a formula without one term fails.

mod lengths;
mod random;
mod reading;

use super::text_model::card;
use clebsch::card::{Card, Settings, Trajectory};
use clebsch_core::check::spec::Side;
use clebsch_core::derive::invariants::Kind;
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::printed::{Value, quaternion};
use reading::{ROUNDING, evaluated, printed};

/// A body with a rotor, in gravity whose sign is in the parameters.
const GYROSTAT: &str = "model Gyrostat {
    param J: Sym<3>;
    param l, a, z: Vec<3>;
    param m, g: Real;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h + dot(l, vee(Ω)) + h*m*g*dot(a, Γ);
}";
/// The same with quaternions.
const QUATERNION_GYROSTAT: &str = "model QuaternionGyrostat {
    param I: Sym<3>;
    param l, b, z: Vec<3>;
    group q: SU<2> velocity W;
    advected Γ: Vec<3> = rot(q)^T*z;
    constraint next(q) = q*W;
    constraint next(Γ) = rot(W)^T*Γ;
    lagrangian = (2/h)*dot(im(W), I*im(W)) + 2*dot(l, im(W)) - h*dot(b, Γ);
}";
/// A rigid motion whose linear part moves.
const DRIFTING_BODY: &str = "model DriftingBody {
    param J, M: Sym<3>;
    param l, p: Vec<3>;
    param b, Z: Vec<4>;
    group G: SE<3> velocity V;
    advected P: Vec<4> = G^T*Z;
    constraint next(G) = G*V;
    constraint next(P) = V^T*P;
    let u = (pos(V) - pos(V^-1))/2;
    lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(l, vee(rot(V))) + dot(p, u) - h*dot(b, P);
}";
/// An affine body with a term linear in the velocity.
const TURNING_ELLIPSOID: &str = "model TurningEllipsoid {
    param C0, I0: Sym<3>;
    param B: Mat<3>;
    param a: Real;
    group Q: GL<3> velocity G;
    advected C: Sym<3> = Q^T*C0*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) + tr(B*(G - G^-1))/2 + h*a*tr(C*C);
}";
/// Two gyrostats in space, coupled by their axes.
const TWO_GYROSTATS: &str = "model TwoGyrostats {
    param l, n: Vec<3>;
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
    lagrangian = -(tr(a*J) + tr(b*K))/h + dot(l, vee(a)) - dot(n, vee(b)) + h*w*dot(p, q);
}";
/// A gyrostat of four dimensions.
const WIDE_GYROSTAT: &str = "model WideGyrostat {
    param C: Sym<4>;
    param L: Skew<4>;
    group Λ: SO<4> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(C*Ω)/h + tr(L*Ω);
}";

/// The values of all symbols at a node of a trajectory.
fn letters(
    d: &Derivation,
    card: &Card,
    parameters: &[Vec<f64>],
    motion: &dyn Trajectory,
) -> Vec<(String, Value)> {
    let mut out = Vec::new();
    for (field, data) in card.parameters.iter().zip(parameters) {
        out.push((
            printed(d, field.name),
            Value::new(field.rows, field.cols, data),
        ));
    }
    let mut all = vec![0.0; card.observables.iter().map(|f| f.count()).sum()];
    motion.observe(&mut all);
    let mut from = 0;
    let symbols = &d.letters.symbols;
    for field in card.observables {
        let data = &all[from..from + field.count()];
        from += field.count();
        let whole = Value::new(field.rows, field.cols, data);
        let frame = |side| match side {
            Side::Body => "body_momentum",
            Side::Spatial => "spatial_momentum",
        };
        // Only the momentum on the side of its constraint has a symbol.
        let momentum = d.spec.configurations.iter().enumerate().find(|(_, c)| {
            let base = match c.group.is_additive() {
                true => "momentum",
                false => frame(c.side),
            };
            let element = &symbols.get(c.element).name;
            match d.spec.configurations.len() {
                1 => field.name == base,
                _ => field.name == format!("{base}_{element}"),
            }
        });
        if let Some((i, _)) = momentum {
            let name = &symbols.get(d.letters.node_momentum[i]).name;
            out.push((printed(d, name), whole));
        } else if symbols.ids().any(|id| symbols.get(id).name == field.name) {
            let whole = match field.kind {
                clebsch::card::Kind::UnitQuaternion => {
                    quaternion([data[0], data[1], data[2], data[3]])
                }
                _ => whole,
            };
            out.push((printed(d, field.name), whole));
        }
    }
    out
}

/// The independent entries of a value; a skew matrix has as many as the invariant has rows.
fn coordinates(v: &Value, rows: usize) -> Vec<f64> {
    if v.data.len() == rows {
        return v.data.clone();
    }
    let n = v.rows;
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.map(|(i, j)| v.data[j * n + i]).collect()
}

/// Compares all invariants at two nodes; returns the number of comparisons.
fn compared(card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>], h: f64) -> usize {
    let d = derive_source(card.source).unwrap_or_else(|e| panic!("{e}"));
    let opened = (card.open)(parameters, initial, Settings::step(h));
    let mut motion = opened.unwrap_or_else(|e| panic!("{}: {e}", card.name));
    let mut count = 0;
    for steps in [0, 7] {
        for _ in 0..steps {
            motion
                .step()
                .unwrap_or_else(|e| panic!("{}: {e}", card.name));
        }
        let known = letters(&d, card, parameters, motion.as_ref());
        let mut computed = vec![0.0; card.invariants.iter().map(|v| v.rows).sum()];
        let mut sizes = computed.clone();
        motion.invariants(&mut computed);
        motion.scales(&mut sizes);
        let mut from = 0;
        for (shown, derived) in card.invariants.iter().zip(&d.invariants) {
            let here = from..from + shown.rows;
            from += shown.rows;
            // The card describes coefficients of a determinant in words.
            if derived.kind == Kind::Spectrum {
                continue;
            }
            let found = coordinates(&evaluated(&d, shown.formula, &known), shown.rows);
            for ((a, b), size) in found.iter().zip(&computed[here.clone()]).zip(&sizes[here]) {
                let off = (a - b).abs();
                assert!(
                    off <= ROUNDING * (size + b.abs()),
                    "{}, {}: `{}` is {a}, computed is {b}",
                    card.name,
                    shown.name,
                    shown.formula
                );
                count += 1;
            }
        }
    }
    count
}

#[test]
fn gallery() {
    for entry in clebsch_models::gallery() {
        for case in &entry.cases {
            let card = entry.card_of(case);
            let count = compared(&card, &case.parameters, &case.initial, case.h);
            assert!(count >= 2, "{}", case.name);
        }
    }
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
const TILTED: [f64; 9] = [0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8];

fn diagonal(d: [f64; 3]) -> Vec<f64> {
    vec![d[0], 0.1, 0.0, 0.1, d[1], 0.05, 0.0, 0.05, d[2]]
}

#[test]
fn terms_linear_in_the_velocity() {
    let j = diagonal([0.9, 1.1, 1.6]);
    let l = vec![0.3, -0.1, 0.2];
    let z = vec![0.0, 0.6, 0.8];
    let a = vec![0.1, 0.2, -0.8];
    let mu = vec![0.3, -0.2, 0.6];
    let one = |card: &Card, parameters: &[Vec<f64>], initial: &[Vec<f64>]| {
        assert!(
            compared(card, parameters, initial, 0.05) >= 2,
            "{}",
            card.name
        );
    };
    let gravity = [
        j.clone(),
        l.clone(),
        a.clone(),
        z.clone(),
        vec![1.3],
        vec![0.7],
    ];
    one(&card(GYROSTAT), &gravity, &[TILTED.to_vec(), mu.clone()]);
    let attitude = vec![0.5, 0.5, -0.5, 0.5];
    let parameters = [j.clone(), l.clone(), a.clone(), z.clone()];
    one(
        &card(QUATERNION_GYROSTAT),
        &parameters,
        &[attitude, mu.clone()],
    );
    let mut place = vec![0.0; 16];
    for (i, row) in TILTED.chunks(3).enumerate() {
        place[4 * i..4 * i + 3].copy_from_slice(row);
        place[4 * i + 3] = 0.3 * i as f64 - 0.2;
    }
    place[15] = 1.0;
    let parameters = [
        j.clone(),
        diagonal([1.5, 1.2, 2.0]),
        l.clone(),
        vec![0.2, 0.1, -0.3],
        vec![0.1, 0.2, -0.8, 0.4],
        vec![0.0, 0.6, 0.8, 0.1],
    ];
    let impulse = [mu.clone(), vec![0.2, 0.1, -0.1]].concat();
    one(&card(DRIFTING_BODY), &parameters, &[place, impulse]);
    let parameters = [
        diagonal([1.2, 1.0, 0.9]),
        diagonal([0.8, 1.1, 1.3]),
        vec![0.1, 0.2, -0.1, 0.0, 0.3, 0.2, -0.2, 0.1, 0.1],
        vec![-0.4],
    ];
    let stretched = vec![1.1, 0.1, 0.0, 0.0, 0.9, 0.2, 0.1, 0.0, 1.0];
    let rate = vec![0.1, -0.2, 0.3, 0.2, 0.1, 0.0, -0.1, 0.2, 0.1];
    one(&card(TURNING_ELLIPSOID), &parameters, &[stretched, rate]);
    let start = [
        TILTED.to_vec(),
        mu.clone(),
        IDENTITY.to_vec(),
        vec![-0.4, 0.5, 0.2],
        j.clone(),
        diagonal([0.5, 1.5, 2.0]),
        a,
        vec![0.6, 0.0, 0.7],
    ];
    one(
        &card(TWO_GYROSTATS),
        &[l, vec![0.1, 0.4, -0.2], vec![0.7]],
        &start,
    );
    let square =
        |f: &dyn Fn(usize, usize) -> f64| (0..16).map(|k| f(k / 4, k % 4)).collect::<Vec<f64>>();
    let parameters = [
        square(&|i, j| if i == j { 1.0 + 0.3 * i as f64 } else { 0.05 }),
        square(&|i, j| 0.1 * (i as f64 - j as f64)),
    ];
    let start = [
        square(&|i, j| f64::from(u8::from(i == j))),
        square(&|i, j| 0.2 * (i * i) as f64 - 0.2 * (j * j) as f64),
    ];
    one(&card(WIDE_GYROSTAT), &parameters, &start);
}
