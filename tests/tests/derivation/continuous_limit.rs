//! The continuous equations of motion as the limit of the discrete ones. Along a smooth curve that solves nothing, the discrete
//! balance over the step size tends to the continuous equation with the order of the scheme. Measures the order from two step
//! sizes, and checks that a changed equation is not the limit.

use clebsch_core::{Assignment, Derivation, derive_source};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::physics::measure::worse;

/// Square matrices of any size, row by row.
#[derive(Clone)]
struct Matrix(usize, Vec<f64>);

impl Matrix {
    fn from_fn(n: usize, f: impl FnMut(usize) -> f64) -> Matrix {
        Matrix(n, (0..n * n).map(f).collect())
    }

    fn identity(n: usize) -> Matrix {
        Matrix::from_fn(n, |k| f64::from(u8::from(k / n == k % n)))
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.1[i * self.0 + j]
    }

    fn times(&self, b: &Matrix) -> Matrix {
        let n = self.0;
        Matrix::from_fn(n, |k| {
            (0..n).map(|m| self.at(k / n, m) * b.at(m, k % n)).sum()
        })
    }

    fn plus(&self, b: &Matrix) -> Matrix {
        Matrix(
            self.0,
            self.1.iter().zip(&b.1).map(|(x, y)| x + y).collect(),
        )
    }

    fn scaled(&self, x: f64) -> Matrix {
        Matrix(self.0, self.1.iter().map(|y| x * y).collect())
    }

    fn transposed(&self) -> Matrix {
        let n = self.0;
        Matrix::from_fn(n, |k| self.at(k % n, k / n))
    }

    /// `Σ x^n/n!`; 20 terms reach rounding for the small arguments here.
    fn exponential(&self) -> Matrix {
        let mut power = Matrix::identity(self.0);
        let mut sum = power.clone();
        for n in 1..20 {
            power = power.times(self).scaled(1.0 / f64::from(n));
            sum = sum.plus(&power);
        }
        sum
    }
}

/// One group of a model: its symbols and element type.
#[derive(Clone, Copy)]
struct Body {
    element: &'static str,
    size: usize,
    orthogonal: bool,
    spatial: bool,
}

const fn rotation(element: &'static str, size: usize, spatial: bool) -> Body {
    Body {
        element,
        size,
        orthogonal: true,
        spatial,
    }
}

/// A model, its groups, parameters (name, rows, columns, symmetric), and advected quantities without a definition, with their
/// values at a node.
struct Case {
    text: &'static str,
    bodies: Vec<Body>,
    parameters: Vec<(&'static str, usize, usize, bool)>,
    carried: Vec<(&'static str, usize, usize, Carry)>,
}

type Carry = fn(&Matrix, &[f64]) -> Vec<f64>;

/// `Λ(t)` with velocity `A` and acceleration `2 B` at `t = 0`: `Λ0 exp(tA) exp(t²B)` in the body,
/// `exp(t²B) exp(tA) Λ0` in space.
struct Curve {
    body: Body,
    start: Matrix,
    velocity: Matrix,
    half_acceleration: Matrix,
}

impl Curve {
    fn random(body: Body, source: &mut Source) -> Curve {
        let n = body.size;
        let mut algebra = || {
            let a = Matrix::from_fn(n, |_| source.between(-1.0, 1.0));
            if body.orthogonal {
                a.plus(&a.transposed().scaled(-1.0)).scaled(0.5)
            } else {
                a.scaled(0.5)
            }
        };
        let (start, velocity, half_acceleration) = (algebra(), algebra(), algebra());
        Curve {
            body,
            start: start.exponential(),
            velocity,
            half_acceleration,
        }
    }

    fn at(&self, t: f64) -> Matrix {
        let first = self.velocity.scaled(t).exponential();
        let second = self.half_acceleration.scaled(t * t).exponential();
        if self.body.spatial {
            second.times(&first).times(&self.start)
        } else {
            self.start.times(&first).times(&second)
        }
    }

    /// In the engine's coordinates of the Lie algebra: the axial vector for SO(3).
    fn coordinates(&self, a: &Matrix) -> (usize, usize, Vec<f64>) {
        if self.body.orthogonal && self.body.size == 3 {
            (3, 1, vec![a.at(2, 1), a.at(0, 2), a.at(1, 0)])
        } else {
            (a.0, a.0, a.1.clone())
        }
    }
}

fn parameters(case: &Case, source: &mut Source) -> Vec<(&'static str, usize, usize, Vec<f64>)> {
    let draw = |(name, rows, cols, symmetric): &(&'static str, usize, usize, bool)| {
        let mut data: Vec<f64> = (0..rows * cols)
            .map(|_| source.between(-1.0, 1.0))
            .collect();
        if *symmetric {
            // Positive definite, so that determinants of advected quantities have logarithms.
            let a = Matrix(*rows, data);
            let positive = a.times(&a.transposed()).plus(&Matrix::identity(*rows));
            data = positive.1;
        }
        (*name, *rows, *cols, data)
    };
    case.parameters.iter().map(draw).collect()
}

/// The discrete balance over the step size, and the continuous one.
struct Balances {
    discrete: Vec<f64>,
    continuous: Vec<f64>,
}

fn balances(d: &Derivation, case: &Case, h: f64, seed: u64) -> Balances {
    let mut source = Source::seeded(seed);
    let curves: Vec<Curve> = case
        .bodies
        .iter()
        .map(|b| Curve::random(*b, &mut source))
        .collect();
    let mut values = Assignment::new();
    values.set_scalar("h", h);
    for (name, rows, cols, data) in parameters(case, &mut source) {
        values.set(name, 0, rows, cols, &data);
    }
    let reference: Vec<f64> = (0..9).map(|_| source.between(-1.0, 1.0)).collect();
    for level in [-1i8, 0, 1] {
        for c in &curves {
            let g = c.at(f64::from(level) * h);
            values.set(c.body.element, level, g.0, g.0, &g.1);
        }
        for (name, rows, cols, carry) in &case.carried {
            let g = curves[0].at(f64::from(level) * h);
            values.set(name, level, *rows, *cols, &carry(&g, &reference));
        }
    }
    let s = &d.letters.symbols;
    for (i, c) in curves.iter().enumerate() {
        let (rate, acceleration) = (d.letters.rate[i], d.letters.acceleration[i]);
        let (rows, cols, data) = c.coordinates(&c.velocity);
        values.set(&s.get(rate).name, 0, rows, cols, &data);
        let (rows, cols, data) = c.coordinates(&c.half_acceleration.scaled(2.0));
        values.set(&s.get(acceleration).name, 0, rows, cols, &data);
    }
    let discrete = d.residual(&values).unwrap();
    Balances {
        discrete: discrete.iter().map(|r| r / h).collect(),
        continuous: d.continuous_balance(&values).unwrap().expect("a limit"),
    }
}

fn largest_gap(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |m, (x, y)| worse(m, (x - y).abs()))
}

fn cases() -> Vec<Case> {
    let vector_in_body: Carry = |g, r| {
        let v = &r[..3];
        (0..3)
            .map(|i| (0..3).map(|j| g.at(j, i) * v[j]).sum())
            .collect()
    };
    let vector_in_space: Carry = |g, r| {
        let v = &r[..3];
        (0..3)
            .map(|i| (0..3).map(|j| g.at(i, j) * v[j]).sum())
            .collect()
    };
    let tensor_in_space: Carry = |g, r| {
        let a = Matrix(3, r.to_vec());
        let symmetric = a.plus(&a.transposed());
        g.times(&symmetric).times(&g.transposed()).1
    };
    vec![
        Case {
            text: "model FreeBody { param J: Sym<3>; group Λ: SO<3> velocity Ω;
                constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h; }",
            bodies: vec![rotation("Λ", 3, false)],
            parameters: vec![("J", 3, 3, true)],
            carried: vec![],
        },
        Case {
            text: "model Quadratic { param J, K: Sym<3>; group Λ: SO<3> velocity Ω;
                advected Γ: Vec<3>; constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
                lagrangian = -tr(J*Ω)/h - (h/2)*dot(Γ, K*Γ); }",
            bodies: vec![rotation("Λ", 3, false)],
            parameters: vec![("J", 3, 3, true), ("K", 3, 3, true)],
            carried: vec![("Γ", 3, 1, vector_in_body)],
        },
        Case {
            text: "model SpatialTop { param w: Real; param z: Vec<3>; group Λ: SO<3> velocity ω;
                advected J: Sym<3>; advected chi: Vec<3>;
                constraint next(Λ) = ω*Λ; constraint next(J) = ω*J*ω^T;
                constraint next(chi) = ω*chi;
                lagrangian = -tr(ω*J)/h - h*w*dot(chi, z); }",
            bodies: vec![rotation("Λ", 3, true)],
            parameters: vec![("w", 1, 1, false), ("z", 3, 1, false)],
            carried: vec![("J", 3, 3, tensor_in_space), ("chi", 3, 1, vector_in_space)],
        },
        Case {
            text: "model Coupled { param J1, J2: Sym<3>; param d1, d2: Vec<3>; param eps: Real;
                group Λ1: SO<3> velocity Ω1; group Λ2: SO<3> velocity Ω2;
                advected R: SO<3> = Λ1^T*Λ2;
                constraint next(Λ1) = Λ1*Ω1; constraint next(Λ2) = Λ2*Ω2;
                constraint next(R) = Ω1^T*R*Ω2;
                lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2)
                    + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h; }",
            bodies: vec![rotation("Λ1", 3, false), rotation("Λ2", 3, false)],
            parameters: vec![
                ("J1", 3, 3, true),
                ("J2", 3, 3, true),
                ("d1", 3, 1, false),
                ("d2", 3, 1, false),
                ("eps", 1, 1, false),
            ],
            carried: vec![],
        },
        Case {
            text: "model Four { param J: Sym<4>; group Λ: SO<4> velocity Ω;
                constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h; }",
            bodies: vec![rotation("Λ", 4, false)],
            parameters: vec![("J", 4, 4, true)],
            carried: vec![],
        },
        Case {
            text: "model Ellipsoid { param C0, I0: Sym<3>; param a, b, c, d: Real;
                group Q: GL<3> velocity G; advected C: Sym<3> = Q^T*C0*Q;
                constraint next(Q) = Q*G; constraint next(C) = G^T*C*G;
                let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
                lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W; }",
            bodies: vec![Body {
                element: "Q",
                size: 3,
                orthogonal: false,
                spatial: false,
            }],
            parameters: vec![
                ("C0", 3, 3, true),
                ("I0", 3, 3, true),
                ("a", 1, 1, false),
                ("b", 1, 1, false),
                ("c", 1, 1, false),
                ("d", 1, 1, false),
            ],
            carried: vec![],
        },
        Case {
            text: "model SpatialEllipsoid { param C0, I0: Sym<3>; group Q: GL<3> velocity γ;
                advected S: Sym<3> = Q*I0*Q^T;
                constraint next(Q) = γ*Q; constraint next(S) = γ*S*γ^T;
                lagrangian = tr(C0*(γ - Id)*S*(γ - Id)^T)/(2*h); }",
            bodies: vec![Body {
                element: "Q",
                size: 3,
                orthogonal: false,
                spatial: true,
            }],
            parameters: vec![("C0", 3, 3, true), ("I0", 3, 3, true)],
            carried: vec![],
        },
        // A potential of the element, and a term linear in the velocity.
        Case {
            text: "model Driven { param J, K: Sym<3>; param u, z: Vec<3>;
                group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
                lagrangian = -tr(J*Ω)/h - h*dot(u, Λ*K*z) + dot(u, vee(Ω)); }",
            bodies: vec![rotation("Λ", 3, false)],
            parameters: vec![
                ("J", 3, 3, true),
                ("K", 3, 3, true),
                ("u", 3, 1, false),
                ("z", 3, 1, false),
            ],
            carried: vec![],
        },
    ]
}

fn derivation(case: &Case) -> Derivation {
    derive_source(case.text).unwrap_or_else(|e| panic!("{}\n{e}", case.text))
}

#[test]
fn the_balance_over_the_step_tends_to_the_continuous_equations() {
    for case in cases() {
        let d = derivation(&case);
        for seed in 1..=5 {
            let gap = |h: f64| {
                let b = balances(&d, &case, h, seed);
                largest_gap(&b.discrete, &b.continuous)
            };
            let (coarse, fine) = (gap(2e-2), gap(1e-2));
            let order = (coarse / fine).log2();
            // The residual is a difference of momenta of size 1/h, divided by h; its rounding error is 1e-16/h², or 1e-12.
            println!("{order:.3} {fine:e}");
            assert!(d.reversible, "{}", case.text);
            // A large fourth-order term changes the slope by less than this.
            assert!((order - 2.0).abs() < 0.1, "{}: order {order}", case.text);
        }
    }
}

#[test]
fn another_equation_is_not_the_limit() {
    for case in cases() {
        let d = derivation(&case);
        // A curve with another seed, and the equation with the opposite sign, must not be the limit.
        let here = balances(&d, &case, 1e-3, 1);
        let there = balances(&d, &case, 1e-3, 2);
        let right = largest_gap(&here.discrete, &here.continuous);
        assert!(right < 1e-3, "{}: {right:e}", case.text);
        assert!(
            largest_gap(&here.discrete, &there.continuous) > 1e-2,
            "{}",
            case.text
        );
        let opposite: Vec<f64> = here.continuous.iter().map(|x| -x).collect();
        assert!(
            largest_gap(&here.discrete, &opposite) > 1e-2,
            "{}",
            case.text
        );
    }
}
