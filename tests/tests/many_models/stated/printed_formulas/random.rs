//! A hundred random Lagrangians: the printed energy equals the energy computed from the Lagrangian.

use super::reading::{ROUNDING, combination, evaluated, printed, still, velocities};
use clebsch_core::derive::invariants::Kind;
use clebsch_core::expr::shape::Dim;
use clebsch_core::interpret::{Assignment, evaluate};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::printed::{Value, quaternion};

/// A random Lagrangian over one or two groups, with kinetic energies, linear terms and potentials of either sign.
fn random(draws: &mut Draws, index: usize) -> String {
    let pick = |draws: &mut Draws, n: usize| draws.uniform(0.0, n as f64) as usize;
    let bodies = 1 + pick(draws, 2);
    let (mut head, mut groups, mut terms) = (String::new(), String::new(), Vec::new());
    let mut number = || format!("({}/7)", 1 + pick(draws, 12));
    for b in 1..=bodies {
        let numbers: Vec<String> = (0..4).map(|_| number()).collect();
        let [n0, n1, n2, n3] = [&numbers[0], &numbers[1], &numbers[2], &numbers[3]];
        let kind = (index + 3 * b) % 6;
        head +=
            &format!("param J{b}, M{b}: Sym<3>; param l{b}, a{b}, z{b}: Vec<3>; param w{b}: Real;");
        let sign = |n: usize| if (index >> n) & 1 == 0 { "-" } else { "+" };
        let update = |body: bool| match body {
            true => format!("constraint next(X{b}) = X{b}*V{b};"),
            false => format!("constraint next(X{b}) = V{b}*X{b};"),
        };
        match kind {
            0 | 1 => {
                groups += &format!("group X{b}: SO<3> velocity V{b}; {}", update(kind == 0));
                terms.push(format!("- {n0}*tr(J{b}*V{b})/h"));
                terms.push(format!("{} {n1}*dot(l{b}, vee(V{b}))", sign(0)));
                terms.push(format!("{} h*w{b}*dot(a{b}, X{b}*z{b})", sign(1)));
                terms.push(format!(
                    "{} h*{n2}*dot(X{b}*a{b}, X{b}*M{b}*l{b} - w{b}*a{b})",
                    sign(2)
                ));
            }
            2 => {
                groups += &format!("group X{b}: SU<2> velocity V{b}; {}", update(true));
                terms.push(format!("+ {n0}*dot(im(V{b}), J{b}*im(V{b}))/h"));
                terms.push(format!("{} {n1}*dot(l{b}, im(V{b}))", sign(0)));
                terms.push(format!("{} h*w{b}*dot(a{b}, rot(X{b})*z{b})", sign(1)));
            }
            3 => {
                groups += &format!("group X{b}: SE<3> velocity V{b}; {}", update(true));
                terms.push(format!(
                    "- {n0}*tr(J{b}*rot(V{b}))/h + {n3}*dot(pos(V{b}), M{b}*pos(V{b}))/h"
                ));
                terms.push(format!(
                    "{} {n1}*dot(l{b}, vee(rot(V{b}))) {} dot(a{b}, pos(V{b}))",
                    sign(0),
                    sign(1)
                ));
                terms.push(format!(
                    "{} h*w{b}*dot(z{b}, pos(X{b})) {} h*{n2}*dot(a{b}, rot(X{b})*l{b})",
                    sign(2),
                    sign(3)
                ));
            }
            4 => {
                groups += &format!("group X{b}: GL<3> velocity V{b}; {}", update(true));
                terms.push(format!(
                    "+ {n0}*tr(M{b}*(V{b} - Id)*J{b}*(V{b} - Id)^T)/h {} {n1}*tr(J{b}*V{b})",
                    sign(0)
                ));
                terms.push(format!("{} h*w{b}*dot(a{b}, X{b}*z{b})", sign(1)));
            }
            _ => {
                head += &format!("param C{b}: Sym<4>; param L{b}: Skew<4>;");
                groups += &format!("group X{b}: SO<4> velocity V{b}; {}", update(true));
                terms.push(format!(
                    "- {n0}*tr(C{b}*V{b})/h {} {n1}*tr(L{b}*V{b})",
                    sign(0)
                ));
                terms.push(format!("{} h*w{b}*tr(X{b}*C{b})", sign(1)));
            }
        }
    }
    format!(
        "model Random{index} {{ {head} {groups} lagrangian = {}; }}",
        terms.join(" ").trim_start_matches("+ ")
    )
}

/// Random values of the symbols of a model, by their printed names and by their names in the model.
struct Drawn {
    printed: Vec<(String, Value)>,
    called: Assignment,
}

fn drawn(d: &Derivation, draws: &mut Draws) -> Drawn {
    use clebsch_core::expr::shape::Structure;
    use clebsch_core::expr::symbol::Role;
    let s = &d.letters.symbols;
    let mut out = Drawn {
        printed: Vec::new(),
        called: Assignment::new(),
    };
    for id in s.ids() {
        let symbol = s.get(id);
        if !matches!(
            symbol.role,
            Role::Parameter | Role::Advected | Role::Element
        ) {
            continue;
        }
        let [rows, cols] = [symbol.shape.rows, symbol.shape.cols].map(|n| match n {
            Dim::Fixed(n) => n as usize,
            Dim::Named(_) => panic!("a size that has only a name"),
        });
        // The formulas hold for any matrices of the right structure; inertias are bounded away from zero.
        let mut m = Value::new(
            rows,
            cols,
            &(0..rows * cols)
                .map(|_| draws.uniform(-1.0, 1.0))
                .collect::<Vec<_>>(),
        );
        for i in 0..rows {
            for j in 0..cols.min(rows) {
                let mirror = m.data[j * cols + i];
                match symbol.structure {
                    Structure::Symmetric if i > j => m.data[i * cols + j] = mirror,
                    Structure::Symmetric if i == j => m.data[i * cols + j] += 4.0,
                    Structure::Skew if i > j => m.data[i * cols + j] = -mirror,
                    Structure::Skew if i == j => m.data[i * cols + j] = 0.0,
                    Structure::RigidMotion if i == 3 => {
                        m.data[i * cols + j] = f64::from(u8::from(j == 3))
                    }
                    _ => {}
                }
            }
        }
        if symbol.structure == Structure::UnitQuaternion {
            m = quaternion([m.data[0], m.data[1], m.data[2], m.data[3]]);
        }
        out.called.set(&symbol.name, 0, rows, cols, &m.data);
        out.printed.push((printed(d, &symbol.name), m));
    }
    out
}

/// The energy at a velocity, `ζ·∂L/∂ζ - L`, and the momenta `∂L/∂ζ` by their printed names. Differences of a quadratic polynomial
/// are exact.
fn energy(d: &Derivation, at: &Drawn, by: &[f64]) -> (f64, Vec<(String, Value)>) {
    let s = &d.letters.symbols;
    let lagrangian = &d.continuous.as_ref().expect("a limit").lagrangian;
    let own = velocities(d, &still(d));
    let bases: Vec<Vec<Value>> = own.iter().map(|(_, list)| list.clone()).collect();
    let l = |by: &[f64]| -> f64 {
        let mut values = at.called.clone();
        let mut from = 0;
        for ((name, _), basis) in own.iter().zip(&bases) {
            let zeta = combination(basis, &by[from..from + basis.len()]);
            from += basis.len();
            values.set(name, 0, zeta.rows, zeta.cols, &zeta.data);
        }
        evaluate(s, lagrangian, &values)
            .expect("all values are given")
            .get(0, 0)
    };
    let gradient: Vec<f64> = (0..by.len())
        .map(|k| {
            let moved = |x: f64| {
                by.iter()
                    .enumerate()
                    .map(|(i, y)| if i == k { y + x } else { *y })
                    .collect::<Vec<_>>()
            };
            (l(&moved(1.0)) - l(&moved(-1.0))) / 2.0
        })
        .collect();
    let mut momenta = Vec::new();
    let mut from = 0;
    for (((_, _), basis), id) in own.iter().zip(&bases).zip(&d.letters.node_momentum) {
        let part = &gradient[from..from + basis.len()];
        from += basis.len();
        // Skew covectors pair with half the trace, so the directions are their own duals.
        let covector = combination(basis, part);
        momenta.push((printed(d, &s.get(*id).name), covector));
    }
    let work: f64 = gradient.iter().zip(by).map(|(p, z)| p * z).sum();
    (work - l(by), momenta)
}

#[test]
fn random_lagrangians() {
    let mut draws = Draws::new(29);
    let mut noticed = 0;
    for index in 0..100 {
        let text = random(&mut draws, index);
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
        let shown = d
            .invariants
            .iter()
            .find(|v| v.kind == Kind::Energy)
            .expect("an energy");
        let formula = clebsch_core::emit::formula(&d, shown);
        let mut at = drawn(&d, &mut draws);
        let own = velocities(&d, &still(&d));
        let count: usize = own.iter().map(|(_, list)| list.len()).sum();
        let zeta: Vec<f64> = (0..count).map(|_| draws.uniform(-1.0, 1.0)).collect();
        let (wanted, momenta) = energy(&d, &at, &zeta);
        at.printed.extend(momenta);
        let found = evaluated(&d, &formula, &at.printed).data[0];
        // Terms of a few tens that partly cancel, through the inverse of an inertia.
        let size = 1.0 + wanted.abs() + 100.0 * zeta.iter().map(|x| x * x).sum::<f64>();
        assert!(
            (found - wanted).abs() <= ROUNDING * size,
            "{text}\n{formula}\n{found} is not {wanted}"
        );
        // The comparison detects a missing velocity-independent term in the pairing.
        if let Some(cut) = without_offset(&formula) {
            let other = evaluated(&d, &cut, &at.printed).data[0];
            noticed += usize::from((other - wanted).abs() > 1e-6 * size);
        }
    }
    assert!(noticed > 20, "{noticed}");
}

/// The formula of a single vector momentum without the offset in the pairing: `½ (μ - l)·ζ` becomes `½ μ·ζ`.
fn without_offset(formula: &str) -> Option<String> {
    let (inside, rest) = formula.strip_prefix("½ (")?.split_once(")·ζ")?;
    let (momentum, _) = inside.split_once(['+', '-'])?;
    Some(format!("½ {}·ζ{rest}", momentum.trim_end()))
}
