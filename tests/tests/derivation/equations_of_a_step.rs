//! The input of Newton's method: momenta in components of the velocities, and their Jacobian in closed form, against the derived
//! momenta and their directional derivatives. Covers models on every spatial group; a Jacobian with one transposed block fails.

use clebsch_core::check::spec::Side;
use clebsch_core::derive::parts::{Parts, Velocity};
use clebsch_core::derive::tangent::Direction;
use clebsch_core::expr::shape::{Dim, Structure};
use clebsch_core::expr::symbol::Symbols;
use clebsch_core::expr::{self, Expr};
use clebsch_core::interpret::{Assignment, Matrix, evaluate};
use clebsch_core::print::{Format, Style, expression};
use clebsch_core::schedule::LoopInvariants;
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

/// Statements with coupled velocities, nonlinear in the velocity, or on another group.
const MODELS: [(&str, &str); 6] = [
    (
        "two joined bodies",
        "model Joined { param J1, J2: Sym<3>; param d1, d2: Vec<3>; param eps: Real;
         group Λ1: SO<3> velocity Ω1; group Λ2: SO<3> velocity Ω2;
         advected R: SO<3> = Λ1^T*Λ2;
         constraint next(Λ1) = Λ1*Ω1; constraint next(Λ2) = Λ2*Ω2;
         constraint next(R) = Ω1^T*R*Ω2;
         lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h; }",
    ),
    (
        "not separable",
        "model Rough { param J: Sym<3>; param a: Vec<3>; param z: Vec<3>;
         group Λ: SO<3> velocity Ω; advected Γ: Vec<3> = Λ^T*z;
         constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
         lagrangian = -tr(J*Ω)/h - tr(J*Ω)^2/h - h*dot(a, Γ)*tr(Ω)
                      - dot(a, Ω*a)^2/h + dot(vee(Ω), J*vee(Ω))/h; }",
    ),
    (
        "seen from space",
        "model Space { param z, a: Vec<3>; group Λ: SO<3> velocity ω;
         advected J: Sym<3>; advected chi: Vec<3>;
         constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T; constraint next(chi) = ω*chi;
         lagrangian = -tr(ω*J)/h - tr(ω*J)*dot(z, ω*a)/h - h*dot(chi, z); }",
    ),
    (
        "unit quaternions",
        "model Quaternion { param S: Sym<3>; param c: Real; param z: Vec<3>;
         group q: SU<2> velocity W; advected Γ: Vec<3> = rot(q)^T*z;
         constraint next(q) = q*W; constraint next(Γ) = rot(W)^T*Γ;
         lagrangian = -(4*c/h)*re(W) + (2/h)*dot(im(W), (S - c*Id)*im(W))
                      + re(W)^2*dot(z, im(W)) - h*dot(S*z, Γ); }",
    ),
    (
        "rigid motions",
        "model Motion { param J, M: Sym<3>; param D: Mat<3>; param b, Z: Vec<4>;
         group G: SE<3> velocity V; advected P: Vec<4> = G^T*Z;
         constraint next(G) = G*V; constraint next(P) = V^T*P;
         let u = (pos(V) - pos(V^-1))/2;
         lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(vee(rot(V)), D*u)/h
                      + dot(u, u)*tr(rot(V))/h - h*dot(b, P); }",
    ),
    (
        "a rotation and a quaternion",
        "model Mixed { param J, S: Sym<3>; param a: Vec<3>; param eps: Real;
         group Λ: SO<3> velocity Ω; group q: SU<2> velocity W;
         constraint next(Λ) = Λ*Ω; constraint next(q) = q*W;
         lagrangian = -tr(J*Ω)/h + (2/h)*dot(im(W), S*im(W)) + eps*dot(im(W), Ω*a)*re(W)/h; }",
    ),
];

/// Momenta on the outgoing edge, with its end expressed by its start and the velocities.
fn momenta(d: &Derivation) -> Vec<Expr> {
    let forward = d.spec.end_of_edge();
    let list = d.balances.iter();
    list.map(|b| expr::substitute(&d.letters.symbols, &b.outgoing, &forward))
        .collect()
}

fn rotation([w, x, y, z]: [f64; 4]) -> Vec<f64> {
    vec![
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

struct Point {
    values: Assignment,
    draws: Draws,
}

impl Point {
    fn numbers(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.draws.uniform(-1.0, 1.0)).collect()
    }

    fn quaternion(&mut self) -> [f64; 4] {
        let q = self.numbers(4);
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        [0, 1, 2, 3].map(|i| q[i] / length)
    }

    /// Gives every symbol at the node and its edge a random value of its structure, and assigns the velocity components.
    fn draw(&mut self, d: &Derivation, parts: &Parts) {
        let s = &d.letters.symbols;
        for id in s.ids() {
            let symbol = s.get(id);
            let (Dim::Fixed(rows), Dim::Fixed(cols)) = (symbol.shape.rows, symbol.shape.cols)
            else {
                continue;
            };
            let (rows, cols) = (rows as usize, cols as usize);
            let configuration = d.spec.configurations.iter().position(|c| c.velocity == id);
            let part = configuration.map(|i| parts.velocities[i]);
            let named = |id| parts.symbols.get(id).name.clone();
            let q = self.quaternion();
            let [w, x, y, z] = q;
            let data = match symbol.structure {
                Structure::Orthogonal => rotation(q),
                Structure::UnitQuaternion => {
                    if let Some(Velocity::Quaternion(re, im)) = part {
                        self.values.set(&named(re), 0, 1, 1, &[w]);
                        self.values.set(&named(im), 0, 3, 1, &[x, y, z]);
                    }
                    vec![w, -x, -y, -z, x, w, -z, y, y, z, w, -x, z, -y, x, w]
                }
                Structure::RigidMotion => {
                    let (r, p) = (rotation(q), self.numbers(3));
                    if let Some(Velocity::Motion(rot, pos)) = part {
                        self.values.set(&named(rot), 0, 3, 3, &r);
                        self.values.set(&named(pos), 0, 3, 1, &p);
                    }
                    let row = |i: usize| [r[3 * i], r[3 * i + 1], r[3 * i + 2], p[i]];
                    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat()
                }
                structure => {
                    let mut data = self.numbers(rows * cols);
                    for i in 0..rows {
                        for j in 0..i.min(cols) {
                            match structure {
                                Structure::Symmetric => data[i * cols + j] = data[j * cols + i],
                                Structure::Skew => data[i * cols + j] = -data[j * cols + i],
                                Structure::Diagonal => {
                                    data[i * cols + j] = 0.0;
                                    data[j * cols + i] = 0.0;
                                }
                                _ => {}
                            }
                        }
                    }
                    data
                }
            };
            self.values.set(&symbol.name, 0, rows, cols, &data);
        }
    }

    fn at(&self, s: &Symbols, e: &Expr) -> Matrix {
        evaluate(s, e, &self.values).expect("every letter has a value")
    }
}

/// The largest difference of two matrices, relative to their size or one, whichever is larger.
fn difference(a: &Matrix, b: &Matrix) -> f64 {
    assert_eq!((a.rows, a.cols), (b.rows, b.cols));
    let pairs = a.data.iter().zip(&b.data);
    let worst = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, worse);
    let size = a.data.iter().fold(1.0_f64, |m, x| worse(m, x.abs()));
    worst / size
}

/// Checks momenta and Jacobian at random points; returns the largest difference of each. `flaw` modifies the Jacobian first.
fn worst(source: &str, flaw: fn(Expr) -> Expr) -> [f64; 2] {
    let d = derive_source(source).expect("a model");
    let parts = Parts::of(&d.spec, &d.letters).expect("groups of space");
    let derived = momenta(&d);
    let split = parts.covectors(&derived);
    let written: Vec<Expr> = split
        .iter()
        .map(|e| parts.write(e).expect("written in the parts"))
        .collect();
    let direction = Direction {
        symbols: &parts.symbols,
        letter: parts.direction,
    };
    let varies = |l| parts.varies(l);
    let mut known = LoopInvariants::new(&parts.symbols, &varies, "k");
    let mut checks = Vec::new();
    let momenta: Vec<Expr> = written
        .iter()
        .map(|e| known.apart(&expr::factored(&parts.symbols, e)))
        .collect();
    for e in &written {
        for change in [Side::Body, Side::Spatial]
            .map(|side| parts.changes(side))
            .concat()
        {
            let derivative = expr::directional(&parts.symbols, e, &change);
            let collected = expr::collect(&parts.symbols, &derivative);
            let matrix = direction.matrix(&collected);
            let style = Style::new("k");
            let text = || expression(&collected, &parts.symbols, &style, Format::Text);
            let matrix = matrix.unwrap_or_else(|| panic!("no rule: {}", text()));
            let block = known.apart(&flaw(expr::factored(&parts.symbols, &matrix)));
            checks.push((derivative, block));
        }
    }
    let mut worst = [0.0_f64; 2];
    for seed in 0..50 {
        let mut point = Point {
            values: Assignment::new(),
            draws: Draws::new(seed),
        };
        point.draw(&d, &parts);
        for (name, value) in &known.values {
            let value = point.at(&known.symbols, value);
            let name = &known.symbols.get(*name).name;
            point
                .values
                .set(name, 0, value.rows, value.cols, &value.data);
        }
        for (whole, own) in split.iter().zip(&momenta) {
            let (a, b) = (
                point.at(&parts.symbols, whole),
                point.at(&known.symbols, own),
            );
            worst[0] = worse(worst[0], difference(&a, &b));
        }
        for axis in 0..3 {
            let unit = [0, 1, 2].map(|i| f64::from(u8::from(i == axis)));
            let name = &parts.symbols.get(parts.direction).name;
            point.values.set(name, 0, 3, 1, &unit);
            for (derivative, block) in &checks {
                let column = point.at(&parts.symbols, derivative);
                let block = point.at(&known.symbols, block);
                let data = (0..3).map(|i| block.get(i, axis)).collect();
                let own = Matrix {
                    rows: 3,
                    cols: 1,
                    data,
                };
                worst[1] = worse(worst[1], difference(&column, &own));
            }
        }
    }
    worst
}

/// Several hundred products of up to ten factors below two: a few hundred rounding errors.
const ROUNDING: f64 = 1e-13;

#[test]
fn parts_and_closed_tangents_are_the_derived_ones() {
    for (name, source) in MODELS {
        let [momenta, tangents] = worst(source, |e| e);
        assert!(
            momenta < ROUNDING,
            "{name}: momenta differ by {momenta:.1e}"
        );
        assert!(
            tangents < ROUNDING,
            "{name}: tangents differ by {tangents:.1e}"
        );
    }
}

#[test]
fn a_wrong_tangent_is_noticed() {
    for (name, source) in MODELS {
        let [_, tangents] = worst(source, expr::neg);
        assert!(tangents > 1e-3, "{name}");
    }
}
