//! Checks hand-written steppers against the variation of the unreduced action. Two steps from random states make the action
//! stationary at the middle node, and its derivatives at both ends equal the momenta of the stepper. A test checks that a stepper
//! of another body fails.

// Index loops over small arrays keep the shape of the formulas.
#![allow(clippy::needless_range_loop)]

use clebsch_oracle::handwritten::attitude::{Quaternion, Vector, apply_transposed};
use clebsch_oracle::handwritten::body_in_field::{BodyInField, Field, QuadraticField, TwoFields};
use clebsch_oracle::handwritten::body_n::BodyN;
use clebsch_oracle::handwritten::cayley_klein::CayleyKlein;
use clebsch_oracle::handwritten::coupled_bodies::{CoupledBodies, Pair};
use clebsch_oracle::handwritten::free_body_spatial::FreeBodySpatial;
use clebsch_oracle::handwritten::heavy_top_spatial::{HeavyTopSpatial, SpatialTop};
use clebsch_oracle::handwritten::kirchhoff_body::{KirchhoffBody, Momentum, Submerged};
use clebsch_oracle::oracle::action::{
    DiscreteAction, NodeRule, Variation, bodies, coupled, momentum_in, momentum_out, rotations,
    spatial, stationarity,
};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, dot, vee};
use std::array::from_fn;

/// Random states of every system.
const STATES: usize = 500;

/// A hundred rounding errors of the largest summand of the action, which contains quaternions, their matrices and products of
/// these.
const ROUNDING: f64 = 1e-14;

/// Three nodes, and the momenta at the first two in the axes along which the action is varied.
struct Steps<const N: usize, const G: usize> {
    nodes: [[Square<f64, N>; G]; 3],
    momenta: [Vec<f64>; 2],
}

/// Largest violation of stationarity and of both momenta, relative to the scale of the action.
fn violation<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    basis: &[Square<f64, N>],
    steps: &Steps<N, G>,
) -> f64 {
    let [first, second, _] = &steps.nodes;
    let off = |found: &Variation, wanted: &[f64]| -> f64 {
        assert_eq!(found.derivative.len(), wanted.len());
        let pairs = found.derivative.iter().zip(wanted);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worse) / found.scale
    };
    let still = stationarity(action, &steps.nodes, basis);
    let zero = vec![0.0; still.derivative.len()];
    let out = momentum_out(action, first, second, basis);
    let into = momentum_in(action, first, second, basis);
    [
        off(&still, &zero),
        off(&out, &steps.momenta[0]),
        off(&into, &steps.momenta[1]),
    ]
    .into_iter()
    .fold(0.0, worse)
}

fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}

/// Largest violation over random states; at most one in ten may fail to step.
fn worst(name: &str, mut state: impl FnMut(&mut Source) -> Option<f64>) -> f64 {
    let mut source = Source::seeded(77);
    let (mut largest, mut refused) = (0.0, 0);
    for _ in 0..STATES {
        match state(&mut source) {
            Some(v) => largest = worse(largest, v),
            None => refused += 1,
        }
    }
    println!("{name}: {largest:.1e}, {refused} refused");
    assert!(10 * refused < STATES, "{name}: {refused} refused");
    largest
}

fn rotation(source: &mut Source) -> Quaternion {
    Quaternion::from_matrix(&source.orthogonal::<3>().0)
}

fn square(q: &Quaternion) -> Square<f64, 3> {
    Square(q.matrix())
}

fn body_violation(source: &mut Source, mistaken: f64) -> Option<f64> {
    let h = source.between(0.05, 0.3);
    let q = rotation(source);
    let second_moment = source.positive::<3>();
    let action = spatial::FreeBodySpatial { h, second_moment };
    let seen = square(&q) * second_moment * square(&q).transpose();
    let seen = Square::from_entries(|i, j| 0.5 * (seen.0[i][j] + seen.0[j][i]));
    let seen = seen.scaled(1.0 + mistaken);
    let m = source.vector();
    let mut body = FreeBodySpatial::start(&seen.0, &q, &m, h).ok()?;
    let mut nodes = [[square(&q)]; 3];
    for node in &mut nodes[1..] {
        body.step();
        *node = [square(&body.attitude())];
    }
    let momenta = [m.to_vec(), body.spatial_momentum().to_vec()];
    Some(violation(&action, &rotations(), &Steps { nodes, momenta }))
}

#[test]
fn free_body_spatial() {
    let off = worst("free body, spatial", |source| body_violation(source, 0.0));
    assert!(off < ROUNDING, "{off:e}");
}

#[test]
fn a_wrong_body_is_noticed() {
    let mut source = Source::seeded(78);
    for _ in 0..20 {
        let off = body_violation(&mut source, 1e-7).expect("solvable");
        assert!(off > 100.0 * ROUNDING, "{off:e}");
    }
}

#[test]
fn heavy_top_spatial() {
    let off = worst("heavy top, spatial", |source| {
        let h = source.between(0.05, 0.3);
        let q = rotation(source);
        let action = spatial::HeavyTopSpatial {
            h,
            second_moment: source.positive(),
            lever: source.vector(),
            vertical: source.vector(),
            weight: source.between(0.2, 2.0),
        };
        let seen = square(&q) * action.second_moment * square(&q).transpose();
        let top = SpatialTop {
            weight: action.weight,
            up: action.vertical,
            poinsot: Square::from_entries(|i, j| 0.5 * (seen.0[i][j] + seen.0[j][i])).0,
            arm: square(&q).apply(&action.lever),
        };
        let m = source.vector();
        let mut motion = HeavyTopSpatial::start(&top, &q, &m, h).ok()?;
        let mut nodes = [[square(&q)]; 3];
        let mut momenta = [m.to_vec(), Vec::new()];
        for n in 1..3 {
            motion.step().ok()?;
            nodes[n] = [square(&motion.attitude())];
            if n == 1 {
                momenta[1] = motion.spatial_momentum().to_vec();
            }
        }
        Some(violation(&action, &rotations(), &Steps { nodes, momenta }))
    });
    assert!(off < ROUNDING, "{off:e}");
}

#[test]
fn coupled_bodies() {
    let off = worst("coupled bodies", |source| {
        let h = source.between(0.05, 0.3);
        let arms = [source.vector(), source.vector()];
        let reduced_mass = source.between(0.1, 1.0);
        let second_moments = arms.map(|arm: Vector| {
            let own = source.positive::<3>();
            Square::from_entries(|i, j| own.0[i][j] + reduced_mass * (arm[i] * arm[j]))
        });
        let action = coupled::CoupledBodies::<true> {
            h,
            second_moments,
            arms,
            reduced_mass,
            reference: Square::identity(),
        };
        let q = [rotation(source), rotation(source)];
        let mu = [source.vector(), source.vector()];
        let pair = Pair {
            poinsots: second_moments.map(|j| j.0),
            arms,
            eps: reduced_mass,
        };
        let mut motion = CoupledBodies::start(&pair, &q, &mu, h).ok()?;
        let mut nodes = [q.map(|q| square(&q)); 3];
        let mut momenta = [mu.concat(), Vec::new()];
        for n in 1..3 {
            motion.step().ok()?;
            nodes[n] = motion.attitudes().map(|q| square(&q));
            if n == 1 {
                momenta[1] = motion.body_momenta().concat();
            }
        }
        Some(violation(&action, &rotations(), &Steps { nodes, momenta }))
    });
    assert!(off < ROUNDING, "{off:e}");
}

/// A body in a field: draws a state, makes two steps, and compares.
fn in_field<F: Field>(
    source: &mut Source,
    h: f64,
    second_moment: &Square<f64, 3>,
    field: &F,
    action: &impl DiscreteAction<3, 1>,
) -> Option<f64> {
    let q = rotation(source);
    let mu = source.vector();
    let mut motion = BodyInField::start(&second_moment.0, field, &q, &mu, h).ok()?;
    let mut nodes = [[square(&q)]; 3];
    let mut momenta = [mu.to_vec(), Vec::new()];
    for n in 1..3 {
        motion.step().ok()?;
        nodes[n] = [square(&motion.attitude())];
        if n == 1 {
            momenta[1] = motion.body_momentum().to_vec();
        }
    }
    Some(violation(action, &rotations(), &Steps { nodes, momenta }))
}

#[test]
fn body_in_quadratic_field() {
    let off = worst("quadratic field", |source| {
        let action = bodies::QuadraticField {
            h: source.between(0.05, 0.3),
            second_moment: source.positive(),
            form: source.symmetric(),
            direction: source.vector(),
        };
        let field = QuadraticField {
            stiffness: action.form.0,
            axis: action.direction,
        };
        in_field(source, action.h, &action.second_moment, &field, &action)
    });
    assert!(off < ROUNDING, "{off:e}");
}

/// Energy gU . Lambda^T z - p . Lambda^T b, in spatial form.
struct TwoUniformFields {
    h: f64,
    second_moment: Square<f64, 3>,
    fields: TwoFields,
}

impl DiscreteAction<3, 1> for TwoUniformFields {
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        let potential = |attitude: &Square<T, 3>| {
            let along = |body: &Vector, space: &Vector| {
                dot(
                    &attitude.apply(&constant_column(body)),
                    &constant_column(space),
                )
            };
            let f = &self.fields;
            -T::constant(self.h) * (along(&f.weight, &f.up) - along(&f.dipole, &f.field))
        };
        let turn = tail[0].transpose() * head[0];
        vec![
            -(Square::constant(&self.second_moment) * turn).trace() / T::constant(self.h),
            NodeRule::Symmetric.split(potential(&tail[0]), potential(&head[0])),
        ]
    }
}

#[test]
fn body_in_two_fields() {
    let off = worst("two fields", |source| {
        let action = TwoUniformFields {
            h: source.between(0.05, 0.3),
            second_moment: source.positive(),
            fields: TwoFields {
                weight: source.vector(),
                dipole: source.vector(),
                up: source.vector(),
                field: source.vector(),
            },
        };
        in_field(
            source,
            action.h,
            &action.second_moment,
            &action.fields,
            &action,
        )
    });
    assert!(off < ROUNDING, "{off:e}");
}

/// The family on SU(2), with quaternions as left-multiplication matrices.
struct Family {
    h: f64,
    c: f64,
    moments: Vector,
}

impl DiscreteAction<4, 1> for Family {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let w = tail[0].transpose() * head[0];
        let mut summands = vec![-T::constant(4.0 * self.c / self.h) * w.0[0][0]];
        for i in 0..3 {
            let part = w.0[i + 1][0];
            summands.push(T::constant(2.0 * (self.moments[i] - self.c) / self.h) * part * part);
        }
        summands
    }
}

fn left(q: [f64; 4]) -> Square<f64, 4> {
    let [w, x, y, z] = q;
    Square([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
}

#[test]
fn cayley_klein() {
    // A rotation by xi is the quaternion exp(xi/2).
    let basis = [1, 2, 3].map(|i| left(from_fn(|j| if i == j { 0.5 } else { 0.0 })));
    let off = worst("Cayley-Klein", |source| {
        let second = from_fn::<f64, 3, _>(|_| source.between(0.2, 1.0));
        let total: f64 = second.iter().sum();
        let action = Family {
            h: source.between(0.05, 0.3),
            c: source.between(-0.5, 1.5),
            moments: second.map(|j| total - j),
        };
        let q = rotation(source);
        let mu = source.vector();
        let mut motion = CayleyKlein::start(&action.moments, action.c, &q, &mu, action.h).ok()?;
        assert!(motion.residual().ok()? < 1e-15);
        let mut nodes = [[left(q.0)]; 3];
        let mut momenta = [mu.to_vec(), Vec::new()];
        for n in 1..3 {
            motion.step().ok()?;
            nodes[n] = [left(motion.quaternion().0)];
            if n == 1 {
                momenta[1] = motion.body_momentum().to_vec();
                let from_attitude =
                    apply_transposed(&motion.quaternion().matrix(), &motion.spatial_momentum());
                assert!((0..3).all(|i| (from_attitude[i] - momenta[1][i]).abs() < 1e-14));
            }
        }
        Some(violation(&action, &basis, &Steps { nodes, momenta }))
    });
    assert!(off < ROUNDING, "{off:e}");
}

/// -tr(J Om)/h in N dimensions.
struct BodyOf<const N: usize> {
    h: f64,
    j: [f64; N],
}

impl<const N: usize> DiscreteAction<N, 1> for BodyOf<N> {
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let turn = tail[0].transpose() * head[0];
        (0..N)
            .map(|i| -T::constant(self.j[i] / self.h) * turn.0[i][i])
            .collect()
    }
}

fn in_dimensions<const N: usize>(momentum: f64) -> f64 {
    let pairs: Vec<(usize, usize)> = (0..N).flat_map(|i| (0..i).map(move |k| (i, k))).collect();
    let basis: Vec<Square<f64, N>> = pairs
        .iter()
        .map(|&(a, b)| {
            Square::from_entries(|i, j| {
                f64::from(u8::from((i, j) == (a, b))) - f64::from(u8::from((i, j) == (b, a)))
            })
        })
        .collect();
    worst(
        &format!("{N} dimensions, momenta to {momentum}"),
        |source| {
            let action = BodyOf::<N> {
                h: source.between(0.05, 0.2),
                j: from_fn(|_| source.between(0.3, 2.0)),
            };
            let attitude = source.orthogonal::<N>();
            let mu = source.skew::<N>().scaled(momentum);
            let listed =
                |m: &[[f64; N]; N]| -> Vec<f64> { pairs.iter().map(|&(a, b)| m[a][b]).collect() };
            let mut motion = BodyN::start(&action.j, &attitude.0, &mu.0, action.h).ok()?;
            let mut nodes = [[attitude]; 3];
            let mut momenta = [listed(&mu.0), Vec::new()];
            for n in 1..3 {
                motion.step().ok()?;
                nodes[n] = [Square(motion.attitude())];
                if n == 1 {
                    momenta[1] = listed(&motion.body_momentum());
                }
            }
            Some(violation(&action, &basis, &Steps { nodes, momenta }))
        },
    )
}

#[test]
fn bodies_in_four_and_eight_dimensions() {
    // The larger momenta exceed the range of the fast iteration and need Newton's method on the group.
    for off in [
        in_dimensions::<4>(0.5),
        in_dimensions::<8>(0.5),
        in_dimensions::<4>(2.0),
        in_dimensions::<8>(1.0),
    ] {
        assert!(off < ROUNDING, "{off:e}");
    }
}

/// A body in a fluid with homogeneous matrices; every term uses the attitudes and positions at both ends.
struct InFluid {
    h: f64,
    body: Submerged,
}

impl DiscreteAction<4, 1> for InFluid {
    fn edge<T: Number>(&self, tail: &[Square<T, 4>; 1], head: &[Square<T, 4>; 1]) -> Vec<T> {
        let body = &self.body;
        let (h, half) = (T::constant(self.h), T::constant(0.5));
        let attitude = |g: &Square<T, 4>| Square::<T, 3>::from_entries(|i, j| g.0[i][j]);
        let position = |g: &Square<T, 4>| -> [T; 3] { from_fn(|i| g.0[i][3]) };
        let (from, to) = (attitude(&tail[0]), attitude(&head[0]));
        let turn = from.transpose() * to;
        let moved: [T; 3] = from_fn(|i| head[0].0[i][3] - tail[0].0[i][3]);
        let (near, far) = (from.transpose().apply(&moved), to.transpose().apply(&moved));
        let u: [T; 3] = from_fn(|i| half * (near[i] + far[i]));
        let masses = Square::constant(&Square(body.masses));
        let coupling = Square::constant(&Square(body.coupling));
        let potential = |g: &Square<T, 4>| {
            let up = constant_column(&body.up);
            let moment = attitude(g).apply(&constant_column(&body.moment));
            -h * (dot(&moment, &up) + T::constant(body.weight) * dot(&position(g), &up))
        };
        vec![
            -(Square::constant(&Square(body.poinsot)) * turn).trace() / h,
            half * dot(&u, &masses.apply(&u)) / h,
            dot(&vee(&turn), &coupling.apply(&u)) / h,
            NodeRule::Symmetric.split(potential(&tail[0]), potential(&head[0])),
        ]
    }
}

#[test]
fn kirchhoff_body() {
    // Rotations about the body axes, then translations along them.
    let basis: Vec<Square<f64, 4>> = (0..6)
        .map(|n| {
            let turn = rotations();
            Square::from_entries(|i, j| match (n < 3, i < 3, j < 3) {
                (true, true, true) => turn[n].0[i][j],
                (false, true, false) if i + 3 == n => 1.0,
                _ => 0.0,
            })
        })
        .collect();
    let rigid = |q: &Quaternion, x: &Vector| {
        let r = q.matrix();
        Square::<f64, 4>::from_entries(|i, j| match (i < 3, j < 3) {
            (true, true) => r[i][j],
            (true, false) => x[i],
            (false, true) => 0.0,
            (false, false) => 1.0,
        })
    };
    let off = worst("Kirchhoff", |source| {
        let action = InFluid {
            h: source.between(0.02, 0.1),
            body: Submerged {
                poinsot: source.positive::<3>().0,
                masses: source.positive::<3>().0,
                coupling: source.matrix::<3>().scaled(0.1).0,
                moment: source.vector(),
                weight: source.between(-1.0, 1.0),
                up: source.vector(),
            },
        };
        let (q, x) = (rotation(source), source.vector());
        let mu = Momentum {
            angular: source.vector(),
            linear: source.vector(),
        };
        let mut motion = KirchhoffBody::start(&action.body, &q, &x, &mu, action.h).ok()?;
        let listed = |m: &Momentum| [m.angular, m.linear].concat();
        let mut nodes = [[rigid(&q, &x)]; 3];
        let mut momenta = [listed(&mu), Vec::new()];
        for n in 1..3 {
            motion.step().ok()?;
            nodes[n] = [rigid(&motion.attitude(), &motion.position())];
            if n == 1 {
                momenta[1] = listed(&motion.body_momentum());
            }
        }
        Some(violation(&action, &basis, &Steps { nodes, momenta }))
    });
    assert!(off < ROUNDING, "{off:e}");
}
