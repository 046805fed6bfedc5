//! What the card shows of an invariant is what its function computes: every formula is read back and evaluated, for all
//! models of the gallery, for models with terms linear in the velocity, and for a hundred random Lagrangians, whose
//! energy follows from the Lagrangian itself. A formula that leaves out a term fails, which is shown too.

use clebsch::card::{Card, Settings, Trajectory};
use clebsch_core::check::spec::{Group, Side};
use clebsch_core::derive::invariants::Kind;
use clebsch_core::expr::shape::Dim;
use clebsch_core::expr::{self};
use clebsch_core::interpret::{Assignment, evaluate};
use clebsch_core::print::{Format, Style, expression};
use clebsch_core::{Derivation, derive_source};
use clebsch_tests::physics::draws::Draws;
use clebsch_tests::printed::{Value, quaternion, value};

clebsch::model! {
    /// Body with a rotor, in gravity whose sign stands in the parameters.
    model Gyrostat {
        param J: Sym<3>;
        param l, a, z: Vec<3>;
        param m, g: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h + dot(l, vee(Ω)) + h*m*g*dot(a, Γ);
    }
}
clebsch::model! {
    /// The same with quaternions.
    model QuaternionGyrostat {
        param I: Sym<3>;
        param l, b, z: Vec<3>;
        group q: SU<2> velocity W;
        advected Γ: Vec<3> = rot(q)^T*z;
        constraint next(q) = q*W;
        constraint next(Γ) = rot(W)^T*Γ;
        lagrangian = (2/h)*dot(im(W), I*im(W)) + 2*dot(l, im(W)) - h*dot(b, Γ);
    }
}
clebsch::model! {
    /// A rigid motion whose linear part does not stand still.
    model DriftingBody {
        param J, M: Sym<3>;
        param l, p: Vec<3>;
        param b, Z: Vec<4>;
        group G: SE<3> velocity V;
        advected P: Vec<4> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(l, vee(rot(V))) + dot(p, u) - h*dot(b, P);
    }
}
clebsch::model! {
    /// An affine body with a term linear in the velocity.
    model TurningEllipsoid {
        param C0, I0: Sym<3>;
        param B: Mat<3>;
        param a: Real;
        group Q: GL<3> velocity G;
        advected C: Sym<3> = Q^T*C0*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) + tr(B*(G - G^-1))/2 + h*a*tr(C*C);
    }
}
clebsch::model! {
    /// Two gyrostats in space, coupled by their axes.
    model TwoGyrostats {
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
    }
}
clebsch::model! {
    /// A gyrostat of four dimensions.
    model WideGyrostat {
        param C: Sym<4>;
        param L: Skew<4>;
        group Λ: SO<4> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(C*Ω)/h + tr(L*Ω);
    }
}

/// A printed formula and the function differ by the rounding of a few hundred operations on numbers of order one, and
/// what the inverse of an inertia with a condition of some tens makes of it.
const ROUNDING: f64 = 1e-12;

/// What a name is printed as.
fn printed(d: &Derivation, name: &str) -> String {
    let s = &d.letters.symbols;
    let id = s
        .ids()
        .find(|id| s.get(*id).name == name)
        .unwrap_or_else(|| panic!("no {name}"));
    let style = Style::new(&d.spec.time_index);
    expression(&expr::here(s, id), s, &style, Format::Text)
}

/// The names of velocities with the directions they may have; `momenta` are as long as they are.
fn velocities(d: &Derivation, momenta: &[Value]) -> Vec<(String, Vec<Value>)> {
    let s = &d.letters.symbols;
    let own = d.spec.configurations.iter().zip(&d.letters.rate);
    own.zip(momenta)
        .map(|((c, id), m)| (s.get(*id).name.clone(), directions(c.group, m.rows)))
        .collect()
}

/// Momenta of nothing, as long as those of the model.
fn still(d: &Derivation) -> Vec<Value> {
    let s = &d.letters.symbols;
    let shapes = d.letters.node_momentum.iter().map(|id| s.get(*id).shape);
    let sizes = shapes.map(|shape| {
        [shape.rows, shape.cols].map(|n| match n {
            Dim::Fixed(n) => n as usize,
            Dim::Named(_) => panic!("a size that has only a name"),
        })
    });
    sizes
        .map(|[rows, cols]| Value::new(rows, cols, &vec![0.0; rows * cols]))
        .collect()
}

/// Directions of a Lie algebra as its velocity is printed, of matrices with so many rows.
fn directions(group: Group, rows: usize) -> Vec<Value> {
    let columns = |n: usize| -> Vec<Value> {
        let unit = |k: usize| {
            (0..n)
                .map(|i| f64::from(u8::from(i == k)))
                .collect::<Vec<_>>()
        };
        (0..n).map(|k| Value::new(n, 1, &unit(k))).collect()
    };
    let matrices = |n: usize, pairs: Vec<(usize, usize)>, mirror: f64| -> Vec<Value> {
        let one = |(i, j): (usize, usize)| {
            let mut data = vec![0.0; n * n];
            if mirror != 0.0 {
                data[i * n + j] = mirror;
                data[j * n + i] = 1.0;
            } else {
                data[i * n + j] = 1.0;
            }
            Value::new(n, n, &data)
        };
        pairs.into_iter().map(one).collect()
    };
    let all = |n: usize| (0..n * n).map(|k| (k / n, k % n)).collect::<Vec<_>>();
    match group {
        Group::SpecialOrthogonal(Dim::Fixed(3)) | Group::UnitQuaternions => columns(3),
        Group::RigidMotions => columns(6),
        Group::SpecialOrthogonal(_) => {
            let upper = all(rows).into_iter().filter(|(i, j)| i < j);
            matrices(rows, upper.collect(), -1.0)
        }
        Group::GeneralLinear(_) => matrices(rows, all(rows), 0.0),
    }
}

fn combination(basis: &[Value], by: &[f64]) -> Value {
    let mut out = Value::new(
        basis[0].rows,
        basis[0].cols,
        &vec![0.0; basis[0].data.len()],
    );
    for (e, x) in basis.iter().zip(by) {
        out.data
            .iter_mut()
            .zip(&e.data)
            .for_each(|(o, y)| *o += x * y);
    }
    out
}

/// What stands between the commas that no bracket encloses: those of `(a, b)` are of one vector, that of `μ_{1,k}` of a
/// name.
fn apart(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut from, mut depth) = (0, 0);
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' if depth == 0 && text[at..].starts_with(", ") => {
                parts.push(text[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[from..].trim());
    parts
}

/// Evaluates `formula, where μ = ..., ...`: the velocities are what gives the momenta.
fn evaluated(d: &Derivation, formula: &str, letters: &[(String, Value)]) -> Value {
    let Some((formula, relations)) = formula.split_once(", where ") else {
        return value(formula, letters);
    };
    let relations: Vec<(&str, &str)> = apart(relations)
        .into_iter()
        .map(|r| r.split_once(" = ").expect("an equation"))
        .collect();
    let given: Vec<Value> = relations.iter().map(|(m, _)| value(m, letters)).collect();
    let own = velocities(d, &given);
    let bases: Vec<Vec<Value>> = own.iter().map(|(_, list)| list.clone()).collect();
    let count: usize = bases.iter().map(Vec::len).sum();
    let moving = |by: &[f64]| -> Vec<(String, Value)> {
        let mut all = letters.to_vec();
        let mut from = 0;
        for ((name, _), basis) in own.iter().zip(&bases) {
            all.push((
                printed(d, name),
                combination(basis, &by[from..from + basis.len()]),
            ));
            from += basis.len();
        }
        all
    };
    let momentum = |by: &[f64]| -> Vec<f64> {
        let all = moving(by);
        relations
            .iter()
            .flat_map(|(_, right)| value(right, &all).data)
            .collect()
    };
    let given: Vec<f64> = given.into_iter().flat_map(|m| m.data).collect();
    let still = momentum(&vec![0.0; count]);
    let columns: Vec<Vec<f64>> = (0..count)
        .map(|k| {
            let unit: Vec<f64> = (0..count).map(|i| f64::from(u8::from(i == k))).collect();
            momentum(&unit)
                .iter()
                .zip(&still)
                .map(|(a, b)| a - b)
                .collect()
        })
        .collect();
    // Skew matrices repeat each number: least squares, which are exact here.
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let right: Vec<f64> = given.iter().zip(&still).map(|(a, b)| a - b).collect();
    let square: Vec<f64> = columns
        .iter()
        .flat_map(|a| columns.iter().map(|b| inner(a, b)).collect::<Vec<_>>())
        .collect();
    let inverse = Value::new(count, count, &square).inverted().0;
    let projected: Vec<f64> = columns.iter().map(|a| inner(a, &right)).collect();
    let by: Vec<f64> = inverse
        .data
        .chunks(count)
        .map(|row| inner(row, &projected))
        .collect();
    value(formula, &moving(&by))
}

/// The values of all letters at the node of a trajectory.
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
        // The momentum of the side of its constraint has a letter.
        let momentum = d.spec.configurations.iter().enumerate().find(|(_, c)| {
            let base = frame(c.side);
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

/// How many numbers of a value an invariant has as a matrix that is skew.
fn coordinates(v: &Value, rows: usize) -> Vec<f64> {
    if v.data.len() == rows {
        return v.data.clone();
    }
    let n = v.rows;
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.map(|(i, j)| v.data[j * n + i]).collect()
}

/// Compares all invariants at two nodes; how many were compared.
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
            // Coefficients of a determinant, told in words.
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
    one(
        &Gyrostat::<f64>::CARD,
        &gravity,
        &[TILTED.to_vec(), mu.clone()],
    );
    let attitude = vec![0.5, 0.5, -0.5, 0.5];
    let parameters = [j.clone(), l.clone(), a.clone(), z.clone()];
    one(
        &QuaternionGyrostat::<f64>::CARD,
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
    one(&DriftingBody::<f64>::CARD, &parameters, &[place, impulse]);
    let parameters = [
        diagonal([1.2, 1.0, 0.9]),
        diagonal([0.8, 1.1, 1.3]),
        vec![0.1, 0.2, -0.1, 0.0, 0.3, 0.2, -0.2, 0.1, 0.1],
        vec![-0.4],
    ];
    let stretched = vec![1.1, 0.1, 0.0, 0.0, 0.9, 0.2, 0.1, 0.0, 1.0];
    let rate = vec![0.1, -0.2, 0.3, 0.2, 0.1, 0.0, -0.1, 0.2, 0.1];
    one(
        &TurningEllipsoid::<f64>::CARD,
        &parameters,
        &[stretched, rate],
    );
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
        &TwoGyrostats::<f64>::CARD,
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
    one(&WideGyrostat::<f64>::CARD, &parameters, &start);
}

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

/// Random values of the letters of a model, named as printed and as they are called.
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
        // The formulas hold for any matrices of the structure; inertias are kept away from zero.
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

/// The energy at a velocity, `ζ·∂L/∂ζ - L`, with the momenta `∂L/∂ζ` as they are printed: differences of a polynomial of
/// second degree are exact.
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
        // Skew covectors are paired with half their trace: the directions are their own duals.
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
        // Terms of some tens that partly cancel, through the inverse of an inertia.
        let size = 1.0 + wanted.abs() + 100.0 * zeta.iter().map(|x| x * x).sum::<f64>();
        assert!(
            (found - wanted).abs() <= ROUNDING * size,
            "{text}\n{formula}\n{found} is not {wanted}"
        );
        // The term that stays at rest taken out of the pairing is noticed.
        if let Some(cut) = without_offset(&formula) {
            let other = evaluated(&d, &cut, &at.printed).data[0];
            noticed += usize::from((other - wanted).abs() > 1e-6 * size);
        }
    }
    assert!(noticed > 20, "{noticed}");
}

/// The formula of one vector momentum without what stands beside it in the pairing, `½ (μ - l)·ζ` as `½ μ·ζ`.
fn without_offset(formula: &str) -> Option<String> {
    let (inside, rest) = formula.strip_prefix("½ (")?.split_once(")·ζ")?;
    let (momentum, _) = inside.split_once(['+', '-'])?;
    Some(format!("½ {}·ζ{rest}", momentum.trim_end()))
}
