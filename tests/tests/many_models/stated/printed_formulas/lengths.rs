//! Equations of a satellite about a planet as printed in documents, with powers of lengths and with names of the model. The parsed
//! formulas equal the hand-written consequences of the potential.

use super::reading::ROUNDING;
use clebsch_core::derive_source;
use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::Format;
use clebsch_oracle::printed::{Value, value};

const NAMED: &str = "model Satellite {
    param m, GM: Real;
    param J: Sym<3>;
    group Λ: SO<3> velocity Ω;
    field x: Vec<3>;
    constraint next(Λ) = Λ*Ω;
    let r = sqrt(dot(x, x));
    let I = tr(J)*Id - J;
    let y = Λ^T*x;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - tr(J*Ω)/h + h*GM*m/r + h*GM*tr(I)/(2*r^3)
        - (3/2)*h*GM*dot(y, I*y)/r^5;
}";

const UNNAMED: &str = "model Satellite {
    param m, GM: Real;
    param J: Sym<3>;
    group Λ: SO<3> velocity Ω;
    field x: Vec<3>;
    constraint next(Λ) = Λ*Ω;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - tr(J*Ω)/h + h*GM*m/sqrt(dot(x, x))
        + h*GM*tr(tr(J)*Id - J)/(2*sqrt(dot(x, x))^3)
        - (3/2)*h*GM*dot(Λ^T*x, (tr(J)*Id - J)*Λ^T*x)/sqrt(dot(x, x))^5;
}";

type V = [f64; 3];
type M = [V; 3];

const H: f64 = 0.3;
const MASS: f64 = 1.7;
const GM: f64 = 0.9;
const J: M = [[0.9, 0.1, -0.05], [0.1, 1.2, 0.07], [-0.05, 0.07, 0.6]];
const TURN: M = [[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]];
const STEP: V = [0.11, -0.2, 0.07];

fn dot(a: V, b: V) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn times(a: &M, v: V) -> V {
    [dot(a[0], v), dot(a[1], v), dot(a[2], v)]
}

fn turned(a: &M) -> M {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[j][i]))
}

/// The gradient of `GM m/r + GM tr(I)/(2 r^3) - (3/2) GM y·I y/r^5` with respect to the position.
fn gradient(x: V) -> V {
    let trace = J[0][0] + J[1][1] + J[2][2];
    let inertia = |v: V| {
        let j = times(&J, v);
        [0, 1, 2].map(|i| trace * v[i] - j[i])
    };
    let y = times(&turned(&TURN), x);
    let seen = times(&TURN, inertia(y));
    let r = dot(x, x).sqrt();
    let along =
        -MASS / r.powi(3) - 1.5 * (2.0 * trace) / r.powi(5) + 7.5 * dot(y, inertia(y)) / r.powi(7);
    [0, 1, 2].map(|i| GM * (along * x[i] - 3.0 * seen[i] / r.powi(5)))
}

/// The symbols of a node, printed with this index.
fn letters(x: V, index: &str) -> Vec<(String, Value)> {
    vec![
        (format!("x{index}"), Value::new(3, 1, &x)),
        (format!("Λ{index}"), Value::new(3, 3, &TURN.concat())),
    ]
}

/// The definitions in a document, in order, appended to the known symbols.
fn with_names(text: &str, mut known: Vec<(String, Value)>) -> Vec<(String, Value)> {
    for line in text.lines().filter_map(|l| l.strip_prefix("We write ")) {
        for definition in line.trim_end_matches('.').split("; ") {
            let (name, meaning) = definition.split_once(" := ").expect("a definition");
            for index in ["_k", "_{k+1}", ""] {
                let at = |text: &str| text.replace("_k", index);
                if known.iter().all(|(own, _)| *own != at(name)) {
                    let meant = value(&at(meaning), &known);
                    known.push((at(name), meant));
                }
            }
        }
    }
    known
}

#[test]
fn lengths_and_names() {
    let here = [1.1, -0.4, 0.8];
    let next = [0, 1, 2].map(|i| here[i] + STEP[i]);
    for model in [NAMED, UNNAMED] {
        let d = derive_source(model).expect("a model");
        let text = printed_telling(&d, Format::Text, 100_000, Citations::NONE, Some(model));
        assert_eq!(model == NAMED, text.contains("We write "), "{text}");
        let mut known = vec![
            ("h".to_owned(), Value::number(H)),
            ("m".to_owned(), Value::number(MASS)),
            ("GM".to_owned(), Value::number(GM)),
            ("J".to_owned(), Value::new(3, 3, &J.concat())),
            ("Δx_k".to_owned(), Value::new(3, 1, &STEP)),
        ];
        known.extend(letters(here, "_k"));
        known.extend(letters(next, "_{k+1}"));
        known.extend(letters(here, ""));
        let known = with_names(&text, known);
        let of = |left: &str| {
            let equations = text
                .lines()
                .filter_map(|l| l.split_once(")   ").or(l.split_once(")  ")));
            let mut found = equations.filter_map(|(_, e)| e.trim().strip_prefix(left));
            let right = found
                .next()
                .unwrap_or_else(|| panic!("no {left} in {text}"));
            value(right, &known).data
        };
        for (left, x, sign, kinetic) in [
            ("p_{2,k} = ", here, -0.5 * H, 1.0),
            ("p_{2,k+1} = ", next, 0.5 * H, 1.0),
            ("∇_{x_k} ℓ_{k-1} + ∇_{x_k} ℓ_k = ", here, H, 0.0),
            ("dp₂/dt = ∇_x L = ", here, 1.0, 0.0),
        ] {
            let force = gradient(x);
            let found = of(left);
            for i in 0..3 {
                let wanted = kinetic * MASS * STEP[i] / H + sign * force[i];
                let off = (found[i] - wanted).abs();
                assert!(
                    off <= ROUNDING * (1.0 + wanted.abs()),
                    "{left}{found:?}, {i}: {wanted}"
                );
            }
        }
    }
}
