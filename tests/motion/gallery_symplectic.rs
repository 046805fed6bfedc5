//! Checks that one step of every gallery model, attitudes included, preserves the canonical two-form on T*G to 1e-10, with the
//! exact Jacobian from dual numbers. Phases are random; data come from the cases. The list below must name every model and says how
//! to start it; named sizes go up to five. A test checks that a step size that depends on the state fails.

mod ellipsoids;
mod mixed_four;
mod points;

use super::seeded::Seeded;
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use clebsch::{
    BodyImpulse, BodyMomentum, BodyMomentumMatrix, Dual, Group, Orthogonal, Real, RigidMotion,
    Rotation, SpatialMomentum, UnitQuaternion,
};
use clebsch_models::Case;
use clebsch_oracle::handwritten::attitude::Vector;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;
use clebsch_oracle::physics::symplectic::{
    defect_of_motion, defect_of_product, defect_of_rotations,
};

/// Tolerance well above the rounding error of a product of three matrices with entries of order one to ten.
const TOLERANCE: f64 = 1e-10;

/// Random phases per case.
const PHASES: u64 = 20;

/// Attitude and body momentum with independent variations: Lambda exp(hat(xi)), mu + delta mu.
struct Phase {
    attitude: Rotation<Seeded>,
    momentum: Vector3<Seeded>,
}

fn number(values: &[f64]) -> Seeded {
    Dual::constant(values[0])
}

fn column(values: &[f64]) -> Vector3<Seeded> {
    Vector3::from_fn(|i, _| Dual::constant(values[i]))
}

fn matrix(values: &[f64]) -> Matrix3<Seeded> {
    Matrix3::from_fn(|r, c| Dual::constant(values[3 * r + c]))
}

/// A random phase of body `block`: any attitude, and a momentum of order one.
fn phase(draws: &mut Draws, block: usize) -> Phase {
    let q = draws.attitude().0.map(Dual::constant);
    let attitude = Rotation::from_quaternion(q).expect("a unit quaternion");
    let xi = Vector3::from_fn(|i, _| Dual::variable(0.0, 6 * block + i));
    let momentum = draws.direction();
    Phase {
        attitude: attitude * Rotation::exp(&xi),
        momentum: Vector3::from_fn(|i, _| Dual::variable(momentum[i], 6 * block + 3 + i)),
    }
}

impl Phase {
    /// Rotates a body vector to space.
    fn to_space(&self, v: &Vector3<Seeded>) -> Vector3<Seeded> {
        self.attitude.rotate(v)
    }

    /// Rotates a spatial vector to the body.
    fn to_body(&self, v: &Vector3<Seeded>) -> Vector3<Seeded> {
        self.attitude.inverse_rotate(v)
    }

    /// R J R^T, exactly symmetric.
    fn carried(&self, j: &Matrix3<Seeded>) -> Matrix3<Seeded> {
        let r = self.attitude.matrix();
        let seen = r * j * r.transpose();
        (seen + seen.transpose()) * Dual::constant(0.5)
    }

    /// One of the two quaternions of the attitude. Momenta on SU(2) equal those of the rotations that it covers.
    fn quaternion(&self) -> UnitQuaternion<Seeded> {
        UnitQuaternion::from_components(self.attitude.quaternion()).expect("a unit quaternion")
    }

    fn space_momentum(&self) -> SpatialMomentum<Seeded> {
        SpatialMomentum(self.to_space(&self.momentum))
    }

    fn body_momentum(&self) -> BodyMomentum<Seeded> {
        BodyMomentum(self.momentum)
    }
}

fn values(v: &Vector3<Seeded>) -> Vector {
    [v[0].real, v[1].real, v[2].real]
}

/// The step size, increased by `warp` times the first momentum component.
fn step(h: f64, warp: f64, phase: &Phase) -> Seeded {
    let one = Dual::constant(1.0);
    Dual::constant(h) * (one + Dual::constant(warp) * phase.momentum[0])
}

/// The symplectic defect of a map between phases, relative to the size of the form, whose entries are ones and momenta.
fn defect(before: &[&Phase], after: &[(Matrix3<Seeded>, Vector3<Seeded>)]) -> f64 {
    // Three rotations and three momenta for each body.
    let seeds = 6 * before.len();
    let mut jacobian = Vec::new();
    for (attitude, momentum) in after {
        let value: SMatrix<f64, 3, 3> = attitude.map(|x| x.real);
        // Lambda^T delta Lambda = hat(xi).
        let turns: Vec<Matrix3<f64>> = (0..seeds)
            .map(|seed| value.transpose() * attitude.map(|x| x.dual[seed]))
            .collect();
        for (r, c) in [(2, 1), (0, 2), (1, 0)] {
            jacobian.push(
                turns
                    .iter()
                    .map(|t| 0.5 * (t[(r, c)] - t[(c, r)]))
                    .collect(),
            );
        }
        for i in 0..3 {
            jacobian.push(momentum[i].dual[..seeds].to_vec());
        }
    }
    let before: Vec<Vector> = before.iter().map(|p| values(&p.momentum)).collect();
    let after: Vec<Vector> = after.iter().map(|(_, mu)| values(mu)).collect();
    let size = before
        .iter()
        .chain(&after)
        .flatten()
        .fold(1.0_f64, |m, x| worse(m, x.abs()));
    defect_of_product(&jacobian, &before, &after) / size
}

/// The spatial rotation of an attitude.
trait Turn<T> {
    fn turn(&self) -> Matrix3<T>;
}

impl<T: Real> Turn<T> for Rotation<T> {
    fn turn(&self) -> Matrix3<T> {
        self.matrix()
    }
}

impl<T: Real> Turn<T> for UnitQuaternion<T> {
    fn turn(&self) -> Matrix3<T> {
        self.rotation().matrix()
    }
}

/// Starts a model at a phase, steps once, and returns the new phase.
macro_rules! stepped {
    ($model:ident, $parameters:ident { $($p:ident: $value:expr),* $(,)? },
     $initial:ident { $($i:ident: $start:expr),* $(,)? }, $h:expr,
     $(($attitude:ident, $momentum:ident)),+) => {{
        let model = $model::new($parameters { $($p: $value),* }).expect("parameters of a case");
        let initial = $initial { $($i: $start),* };
        let (mut state, mut workspace) = model.start(initial, $h).expect("solvable");
        model.step(&mut state, &mut workspace).expect("solvable");
        [$((state.$attitude().turn(), state.$momentum().0)),+]
    }};
}

/// The symplectic defect of one step of a case at a random phase, with a warped step size.
type Defect = fn(&Case, &mut Draws, f64) -> f64;

fn free_body(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::free_body::*;
    let p = phase(draws, 0);
    let after = stepped!(
        FreeBody,
        FreeBodyParameters {
            J: matrix(&case.parameters[0])
        },
        FreeBodyInitial {
            Λ: p.attitude,
            body_momentum: p.body_momentum()
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn free_body_spatial(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::free_body_spatial::*;
    let p = phase(draws, 0);
    // The body is the same in every phase, so the spatial values of the case are used as body values.
    let after = stepped!(
        FreeBodySpatial,
        FreeBodySpatialParameters {
            scalar: std::marker::PhantomData::<Seeded>
        },
        FreeBodySpatialInitial {
            Λ: p.attitude,
            spatial_momentum: p.space_momentum(),
            J: p.carried(&matrix(&case.initial[2])),
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn heavy_top(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::heavy_top::*;
    let p = phase(draws, 0);
    let after = stepped!(
        HeavyTop,
        HeavyTopParameters {
            J: matrix(&case.parameters[0]),
            gU: column(&case.parameters[1]),
            z: column(&case.parameters[2]),
        },
        HeavyTopInitial {
            Λ: p.attitude,
            body_momentum: p.body_momentum()
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn heavy_top_spatial(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::heavy_top_spatial::*;
    let p = phase(draws, 0);
    let after = stepped!(
        HeavyTopSpatial,
        HeavyTopSpatialParameters {
            w: number(&case.parameters[0]),
            z: column(&case.parameters[1]),
        },
        HeavyTopSpatialInitial {
            Λ: p.attitude,
            spatial_momentum: p.space_momentum(),
            J: p.carried(&matrix(&case.initial[2])),
            χ: p.to_space(&column(&case.initial[3])),
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn body_in_quadratic_field(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::body_in_quadratic_field::*;
    let p = phase(draws, 0);
    // The axis is fixed in space, so its body components depend on the attitude.
    let after = stepped!(
        BodyInQuadraticField,
        BodyInQuadraticFieldParameters {
            J: matrix(&case.parameters[0]),
            K: matrix(&case.parameters[1]),
        },
        BodyInQuadraticFieldInitial {
            Λ: p.attitude,
            body_momentum: p.body_momentum(),
            Γ: p.to_body(&column(&case.initial[2])),
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn body_in_two_fields(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::body_in_two_fields::*;
    let p = phase(draws, 0);
    let after = stepped!(
        BodyInTwoFields,
        BodyInTwoFieldsParameters {
            J: matrix(&case.parameters[0]),
            gU: column(&case.parameters[1]),
            p: column(&case.parameters[2]),
            z: column(&case.parameters[3]),
            b: column(&case.parameters[4]),
        },
        BodyInTwoFieldsInitial {
            Λ: p.attitude,
            body_momentum: p.body_momentum()
        },
        step(case.h, warp, &p),
        (Λ, body_momentum)
    );
    defect(&[&p], &after)
}

fn coupled_bodies(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::coupled_bodies::*;
    let (p, q) = (phase(draws, 0), phase(draws, 1));
    let after = stepped!(
        CoupledBodies,
        CoupledBodiesParameters {
            J1: matrix(&case.parameters[0]),
            J2: matrix(&case.parameters[1]),
            d1: column(&case.parameters[2]),
            d2: column(&case.parameters[3]),
            eps: number(&case.parameters[4]),
        },
        CoupledBodiesInitial {
            Λ1: p.attitude,
            body_momentum_Λ1: p.body_momentum(),
            Λ2: q.attitude,
            body_momentum_Λ2: q.body_momentum(),
        },
        step(case.h, warp, &p),
        (Λ1, body_momentum_Λ1),
        (Λ2, body_momentum_Λ2)
    );
    defect(&[&p, &q], &after)
}

fn cayley_klein(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::cayley_klein::*;
    let p = phase(draws, 0);
    let after = stepped!(
        CayleyKlein,
        CayleyKleinParameters {
            I: matrix(&case.parameters[0]),
            c: number(&case.parameters[1]),
        },
        CayleyKleinInitial {
            q: p.quaternion(),
            body_momentum: p.body_momentum()
        },
        step(case.h, warp, &p),
        (q, body_momentum)
    );
    defect(&[&p], &after)
}

fn cayley_klein_spatial(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::cayley_klein_spatial::*;
    let p = phase(draws, 0);
    let after = stepped!(
        CayleyKleinSpatial,
        CayleyKleinSpatialParameters {
            c: number(&case.parameters[0])
        },
        CayleyKleinSpatialInitial {
            q: p.quaternion(),
            spatial_momentum: p.space_momentum(),
            I: p.carried(&matrix(&case.initial[2])),
        },
        step(case.h, warp, &p),
        (q, body_momentum)
    );
    defect(&[&p], &after)
}

fn kirchhoff_body(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::kirchhoff_body::*;
    let random = |draws: &mut Draws| {
        let ([a, b, c], [d, e, f]) = (draws.direction(), draws.direction());
        [a, b, c, d, e, f]
    };
    let (place, start) = (random(draws), random(draws));
    let change = |first: usize| Vector3::from_fn(|i, _| Seeded::variable(0.0, first + i));
    let q = draws.attitude().0.map(Dual::constant);
    let own = RigidMotion {
        rotation: Rotation::from_quaternion(q).expect("a unit quaternion"),
        translation: column(&place),
    };
    // This equals the exponential to first order.
    let motion = own
        * RigidMotion {
            rotation: Rotation::exp(&change(0)),
            translation: change(3),
        };
    let mu = SVector::from_fn(|i, _| Seeded::variable(start[i], 6 + i));
    let model = KirchhoffBody::new(KirchhoffBodyParameters {
        J: matrix(&case.parameters[0]),
        M: matrix(&case.parameters[1]),
        D: matrix(&case.parameters[2]),
        b: SVector::from_fn(|i, _| Dual::constant(case.parameters[3][i])),
        Z: SVector::from_fn(|i, _| Dual::constant(case.parameters[4][i])),
    })
    .expect("parameters of a case");
    let initial = KirchhoffBodyInitial {
        G: motion,
        body_momentum: BodyImpulse(mu),
    };
    let h = Dual::constant(case.h) * (Dual::constant(1.0) + Dual::constant(warp) * mu[0]);
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    model.step(&mut state, &mut workspace).expect("solvable");
    let (moved, after) = (state.G().matrix(), state.body_momentum().0);
    // G^-1 dG = [hat(xi) v; 0 0].
    let back = state.G().inverse().matrix().map(|x| x.real);
    let seeds = 12;
    let turns: Vec<_> = (0..seeds)
        .map(|seed| back * moved.map(|x| x.dual[seed]))
        .collect();
    let entries = [(2, 1), (0, 2), (1, 0), (0, 3), (1, 3), (2, 3)];
    let mut jacobian: Vec<Vec<f64>> = entries
        .iter()
        .map(|at| turns.iter().map(|t| t[*at]).collect())
        .collect();
    jacobian.extend(after.iter().map(|x| x.dual[..seeds].to_vec()));
    let (before, after) = (start, std::array::from_fn(|i| after[i].real));
    let size = before
        .iter()
        .chain(&after)
        .fold(1.0_f64, |m, x| worse(m, x.abs()));
    defect_of_motion(&jacobian, &before, &after) / size
}

/// Entries (j, i), i < j, row by row: the coordinates of a skew matrix.
fn planes(n: usize) -> Vec<(usize, usize)> {
    (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| (j, i)))
        .collect()
}

fn body_of_size<const N: usize>(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    use clebsch_models::body_n::*;
    let planes = planes(N);
    // The first seeds vary the attitude, the others the momentum.
    let d = planes.len();
    let seeds = 2 * d;
    // Momenta have any direction. The largest momentum of the cases is solvable up to 0.95 of the bound in its own direction, and
    // to less in others.
    let largest = case.initial[1]
        .iter()
        .fold(0.0_f64, |m, x| worse(m, x.abs()));
    let size = 0.4 * largest;
    let start: Vec<f64> = (0..d).map(|_| draws.uniform(-size, size)).collect();
    let turn: Vec<Seeded> = (0..d)
        .map(|_| Dual::constant(draws.uniform(-1.0, 1.0)))
        .collect();
    let change: Vec<Seeded> = (0..d).map(|k| Dual::variable(0.0, k)).collect();
    // A retraction equals the exponential to first order.
    let own = Orthogonal::<N, Seeded>::identity().retract(&turn);
    let attitude = own.retract(&change);
    let mut mu = SMatrix::<Seeded, N, N>::repeat(Dual::constant(0.0));
    for (k, (r, c)) in planes.iter().enumerate() {
        mu[(*r, *c)] = Dual::variable(start[k], d + k);
        mu[(*c, *r)] = -mu[(*r, *c)];
    }
    let model = BodyN::<N, Seeded>::new(BodyNParameters {
        C: SMatrix::from_fn(|r, c| Dual::constant(case.parameters[0][N * r + c])),
    })
    .expect("parameters of a case");
    let initial = BodyNInitial {
        Λ: attitude,
        body_momentum: BodyMomentumMatrix(mu),
    };
    let longer = Dual::constant(1.0) + Dual::constant(warp / size) * mu[planes[0]];
    let (mut state, mut workspace) = model
        .start(initial, Dual::constant(case.h) * longer)
        .expect("solvable");
    model.step(&mut state, &mut workspace).expect("solvable");
    let (moved, after) = (state.Λ().matrix(), state.body_momentum().0);
    let back = moved.map(|x| x.real).transpose();
    let turns: Vec<_> = (0..seeds)
        .map(|seed| back * moved.map(|x| x.dual[seed]))
        .collect();
    let mut jacobian: Vec<Vec<f64>> = planes
        .iter()
        .map(|at| turns.iter().map(|t| t[*at]).collect())
        .collect();
    jacobian.extend(planes.iter().map(|at| after[*at].dual[..seeds].to_vec()));
    let after: Vec<f64> = planes.iter().map(|at| after[*at].real).collect();
    let size = start
        .iter()
        .chain(&after)
        .fold(1.0_f64, |m, x| worse(m, x.abs()));
    defect_of_rotations(N, &jacobian, &start, &after) / size
}

fn body_n(case: &Case, draws: &mut Draws, warp: f64) -> f64 {
    match case.parameters[0].len() {
        9 => body_of_size::<3>(case, draws, warp),
        16 => body_of_size::<4>(case, draws, warp),
        25 => body_of_size::<5>(case, draws, warp),
        entries => panic!("no start for {entries} entries"),
    }
}

/// How to start each model.
const MODELS: [(&str, Defect); 16] = [
    ("body-in-quadratic-field", body_in_quadratic_field),
    ("body-in-two-fields", body_in_two_fields),
    ("body-n", body_n),
    ("cayley-klein", cayley_klein),
    ("cayley-klein-spatial", cayley_klein_spatial),
    ("charged-particle", points::charged_particle),
    ("coupled-bodies", coupled_bodies),
    ("ellipsoid-convective", ellipsoids::ellipsoid_convective),
    ("ellipsoid-spatial", ellipsoids::ellipsoid_spatial),
    ("free-body", free_body),
    ("free-body-spatial", free_body_spatial),
    ("heavy-top", heavy_top),
    ("heavy-top-spatial", heavy_top_spatial),
    ("kepler", points::kepler),
    ("kirchhoff-body", kirchhoff_body),
    ("mixed-four", mixed_four::mixed_four),
];

fn for_every_case(mut look: impl FnMut(&str, &Case, Defect)) {
    for entry in clebsch_models::gallery() {
        let name = entry.card.kebab;
        let (_, defect) = MODELS
            .iter()
            .find(|(known, _)| *known == name)
            .unwrap_or_else(|| panic!("say above how {name} is started"));
        let named = !entry.card.dimensions.is_empty();
        for case in &entry.cases {
            // Larger sizes would be compiled for this test alone.
            if named && case.parameters[0].len() > 25 {
                continue;
            }
            look(name, case, *defect);
        }
    }
}

#[test]
fn every_model_is_symplectic() {
    for_every_case(|name, case, defect| {
        let mut draws = Draws::new(21);
        let worst = (0..PHASES)
            .map(|_| defect(case, &mut draws, 0.0))
            .fold(0.0, worse);
        println!("{name} {}: {worst:.1e}", case.name);
        assert!(worst < TOLERANCE, "{name} {}: {worst:e}", case.name);
    });
}

#[test]
fn a_step_that_depends_on_the_state_is_not() {
    for_every_case(|name, case, defect| {
        let mut draws = Draws::new(22);
        for _ in 0..PHASES {
            let found = defect(case, &mut draws, 0.1);
            assert!(found > 1e4 * TOLERANCE, "{name} {}: {found:e}", case.name);
        }
    });
}
