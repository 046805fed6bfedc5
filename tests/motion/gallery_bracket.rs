//! Checks that every emitted step of the gallery is a Poisson map of the derived bracket: `D B D^T = B` at the image, with exact
//! derivatives. The bracket is Lie-Poisson, or includes the configurations that appear in the action. Points are random; data come
//! from the cases. The list below must name every model and says how to start it; named sizes go up to five. The test rejects a
//! step size that depends on the state, a bracket of the wrong sign, and the bracket at the wrong end of the step.

mod ellipsoids;
mod mixed_four;
mod points;

use super::seeded::{SEEDS, Seeded};
use clebsch::nalgebra::{DMatrix, Matrix3, SMatrix, SVector, Vector3};
use clebsch::{
    BodyImpulse, BodyMomentum, BodyMomentumMatrix, Dual, Group, Orthogonal, RigidMotion, Rotation,
    SpatialMomentum, UnitQuaternion,
};
use clebsch_core::derive::bracket::{Space, coordinates, skew_entries};
use clebsch_core::expr::shape::Structure;
use clebsch_core::interpret::{Assignment, Matrix};
use clebsch_core::{Derivation, derive_source};
use clebsch_models::Case;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;

/// Tolerance relative to the largest entry, well above the rounding error of a product of three matrices with up to twelve rows and
/// entries of order one to ten.
const TOLERANCE: f64 = 1e-10;

/// Random points per case.
const POINTS: u64 = 10;

/// Relative increase of the step size per unit of the first momentum component, for the warped step.
const WARP: f64 = 0.1;

/// A quantity at a node: its value, and its derivative along each seed.
struct Quantity {
    rows: usize,
    cols: usize,
    value: Vec<f64>,
    change: Vec<Vec<f64>>,
}

fn quantity<const R: usize, const C: usize>(m: &SMatrix<Seeded, R, C>) -> Quantity {
    let entries: Vec<Seeded> = (0..R * C).map(|k| m[(k / C, k % C)]).collect();
    Quantity {
        rows: R,
        cols: C,
        value: entries.iter().map(|x| x.real).collect(),
        change: (0..SEEDS)
            .map(|seed| entries.iter().map(|x| x.dual[seed]).collect())
            .collect(),
    }
}

/// Momenta, then advected quantities in order of declaration. Configurations that appear in the action come first.
type Node = Vec<Quantity>;

/// A node and the next one.
type Step = (Node, Node);

/// One step of a case from a random point. The last argument makes the step size depend on the state.
type Start = fn(&Case, &mut Draws, f64) -> Step;

fn number(values: &[f64]) -> Seeded {
    Dual::constant(values[0])
}

fn column<const R: usize>(values: &[f64]) -> SVector<Seeded, R> {
    SVector::from_fn(|i, _| Dual::constant(values[i]))
}

fn matrix(values: &[f64]) -> Matrix3<Seeded> {
    Matrix3::from_fn(|r, c| Dual::constant(values[3 * r + c]))
}

/// Independent variations of all components, with seeds from `first`.
fn seeded<const R: usize>(value: [f64; R], first: usize) -> SVector<Seeded, R> {
    SVector::from_fn(|i, _| Dual::variable(value[i], first + i))
}

fn attitude(draws: &mut Draws) -> Rotation<Seeded> {
    Rotation::from_quaternion(draws.attitude().0.map(Dual::constant)).expect("a unit quaternion")
}

fn quaternion(draws: &mut Draws) -> UnitQuaternion<Seeded> {
    let q = draws.attitude().0.map(Dual::constant);
    UnitQuaternion::from_components(q).expect("a unit quaternion")
}

/// A tensor of the case in the body frame of this attitude, with independent variations from seed `first`.
fn tensor(values: &[f64], r: &Rotation<Seeded>, first: usize) -> Matrix3<Seeded> {
    let r = r.matrix().map(|x| x.real);
    let turned = r * Matrix3::from_row_slice(values) * r.transpose();
    let mut out = Matrix3::repeat(Dual::constant(0.0));
    let upper = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    for (k, (i, j)) in upper.into_iter().enumerate() {
        out[(i, j)] = Dual::variable(turned[(i, j)], first + k);
        out[(j, i)] = out[(i, j)];
    }
    out
}

/// A vector of length 0.9 with independent variations.
fn vector(draws: &mut Draws, first: usize) -> Vector3<Seeded> {
    seeded(draws.direction().map(|x| 0.9 * x), first)
}

/// The step size, increased by `warp` times the first momentum component.
fn length(case: &Case, warp: f64, momentum: Seeded) -> Seeded {
    Dual::constant(case.h) * (Dual::constant(1.0) + Dual::constant(warp) * momentum)
}

/// Starts a model, steps once, and returns both nodes: momenta first, then advected quantities.
macro_rules! stepped {
    ($model:ident, $parameters:ident { $($p:ident: $value:expr),* $(,)? },
     $initial:ident { $($i:ident: $start:expr),* $(,)? }, $h:expr,
     [$($momentum:ident),*], [$($advected:ident),*]) => {{
        let model = $model::new($parameters { $($p: $value),* }).expect("parameters of a case");
        let initial = $initial { $($i: $start),* };
        let (mut state, mut workspace) = model.start(initial, $h).expect("solvable");
        let before = vec![$(quantity(&state.$momentum().0),)* $(quantity(&model.$advected(&state))),*];
        model.step(&mut state, &mut workspace).expect("solvable");
        let after = vec![$(quantity(&state.$momentum().0),)* $(quantity(&model.$advected(&state))),*];
        (before, after)
    }};
}

fn free_body(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::free_body::*;
    let mu = vector(draws, 0);
    stepped!(
        FreeBody,
        FreeBodyParameters {
            J: matrix(&case.parameters[0])
        },
        FreeBodyInitial {
            Λ: attitude(draws),
            body_momentum: BodyMomentum(mu)
        },
        length(case, warp, mu[0]),
        [body_momentum],
        []
    )
}

fn free_body_spatial(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::free_body_spatial::*;
    let (m, r) = (vector(draws, 0), attitude(draws));
    stepped!(
        FreeBodySpatial,
        FreeBodySpatialParameters {
            scalar: std::marker::PhantomData::<Seeded>
        },
        FreeBodySpatialInitial {
            Λ: r,
            spatial_momentum: SpatialMomentum(m),
            J: tensor(&case.initial[2], &r, 3),
        },
        length(case, warp, m[0]),
        [spatial_momentum],
        [J]
    )
}

fn heavy_top(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::heavy_top::*;
    let (mu, gamma, r) = (vector(draws, 0), vector(draws, 3), attitude(draws));
    // Chooses the spatial vertical so that its body components vary independently.
    stepped!(
        HeavyTop,
        HeavyTopParameters {
            J: matrix(&case.parameters[0]),
            gU: column(&case.parameters[1]),
            z: r.rotate(&gamma),
        },
        HeavyTopInitial {
            Λ: r,
            body_momentum: BodyMomentum(mu)
        },
        length(case, warp, mu[0]),
        [body_momentum],
        [Γ]
    )
}

fn heavy_top_spatial(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::heavy_top_spatial::*;
    let (m, r) = (vector(draws, 0), attitude(draws));
    stepped!(
        HeavyTopSpatial,
        HeavyTopSpatialParameters {
            w: number(&case.parameters[0]),
            z: column(&case.parameters[1]),
        },
        HeavyTopSpatialInitial {
            Λ: r,
            spatial_momentum: SpatialMomentum(m),
            J: tensor(&case.initial[2], &r, 3),
            χ: vector(draws, 9),
        },
        length(case, warp, m[0]),
        [spatial_momentum],
        [J, χ]
    )
}

fn body_in_quadratic_field(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::body_in_quadratic_field::*;
    let mu = vector(draws, 0);
    stepped!(
        BodyInQuadraticField,
        BodyInQuadraticFieldParameters {
            J: matrix(&case.parameters[0]),
            K: matrix(&case.parameters[1]),
        },
        BodyInQuadraticFieldInitial {
            Λ: attitude(draws),
            body_momentum: BodyMomentum(mu),
            Γ: vector(draws, 3),
        },
        length(case, warp, mu[0]),
        [body_momentum],
        [Γ]
    )
}

fn body_in_two_fields(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::body_in_two_fields::*;
    let (mu, r) = (vector(draws, 0), attitude(draws));
    let (vertical, field) = (vector(draws, 3), vector(draws, 6));
    stepped!(
        BodyInTwoFields,
        BodyInTwoFieldsParameters {
            J: matrix(&case.parameters[0]),
            gU: column(&case.parameters[1]),
            p: column(&case.parameters[2]),
            z: r.rotate(&vertical),
            b: r.rotate(&field),
        },
        BodyInTwoFieldsInitial {
            Λ: r,
            body_momentum: BodyMomentum(mu)
        },
        length(case, warp, mu[0]),
        [body_momentum],
        [Γ, B]
    )
}

fn coupled_bodies(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::coupled_bodies::*;
    let (first, second) = (vector(draws, 0), vector(draws, 3));
    let turn = Rotation::exp(&seeded([0.0; 3], 6));
    stepped!(
        CoupledBodies,
        CoupledBodiesParameters {
            J1: matrix(&case.parameters[0]),
            J2: matrix(&case.parameters[1]),
            d1: column(&case.parameters[2]),
            d2: column(&case.parameters[3]),
            eps: number(&case.parameters[4]),
        },
        CoupledBodiesInitial {
            Λ1: attitude(draws),
            body_momentum_Λ1: BodyMomentum(first),
            Λ2: attitude(draws) * turn,
            body_momentum_Λ2: BodyMomentum(second),
        },
        length(case, warp, first[0]),
        [body_momentum_Λ1, body_momentum_Λ2],
        [R]
    )
}

fn cayley_klein(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::cayley_klein::*;
    let mu = vector(draws, 0);
    stepped!(
        CayleyKlein,
        CayleyKleinParameters {
            I: matrix(&case.parameters[0]),
            c: number(&case.parameters[1]),
        },
        CayleyKleinInitial {
            q: quaternion(draws),
            body_momentum: BodyMomentum(mu)
        },
        length(case, warp, mu[0]),
        [body_momentum],
        []
    )
}

fn cayley_klein_spatial(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::cayley_klein_spatial::*;
    let (m, turn) = (vector(draws, 0), quaternion(draws));
    stepped!(
        CayleyKleinSpatial,
        CayleyKleinSpatialParameters {
            c: number(&case.parameters[0])
        },
        CayleyKleinSpatialInitial {
            q: turn,
            spatial_momentum: SpatialMomentum(m),
            I: tensor(&case.initial[2], &turn.rotation(), 3),
        },
        length(case, warp, m[0]),
        [spatial_momentum],
        [I]
    )
}

fn kirchhoff_body(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::kirchhoff_body::*;
    let ([a, b, c], [d, e, f]) = (draws.direction(), draws.direction());
    let mu = seeded([a, b, c, d, e, f].map(|x| 0.9 * x), 0);
    let g = RigidMotion {
        rotation: attitude(draws),
        translation: column(&draws.direction()),
    };
    let [x, y, z] = draws.direction();
    // Chooses the plane so that its body components vary independently: Z = G^-T P.
    let seen = seeded([x, y, z, 0.3], 6);
    stepped!(
        KirchhoffBody,
        KirchhoffBodyParameters {
            J: matrix(&case.parameters[0]),
            M: matrix(&case.parameters[1]),
            D: matrix(&case.parameters[2]),
            b: column(&case.parameters[3]),
            Z: g.inverse().matrix().transpose() * seen,
        },
        KirchhoffBodyInitial {
            G: g,
            body_momentum: BodyImpulse(mu)
        },
        length(case, warp, mu[0]),
        [body_momentum],
        [P]
    )
}

fn body_of_size<const N: usize>(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    use clebsch_models::body_n::*;
    let planes = skew_entries(N);
    // Momenta have any direction. The largest momentum of the cases is solvable up to 0.95 of the bound in its own direction, and
    // to less in others.
    let largest = case.initial[1]
        .iter()
        .fold(0.0_f64, |m, x| worse(m, x.abs()));
    let size = 0.4 * largest;
    let mut mu = SMatrix::<Seeded, N, N>::repeat(Dual::constant(0.0));
    for (k, (r, c)) in planes.iter().enumerate() {
        mu[(*r, *c)] = Dual::variable(draws.uniform(-size, size), k);
        mu[(*c, *r)] = -mu[(*r, *c)];
    }
    let turn: Vec<Seeded> = (0..planes.len())
        .map(|_| Dual::constant(draws.uniform(-1.0, 1.0)))
        .collect();
    let model = BodyN::<N, Seeded>::new(BodyNParameters {
        C: SMatrix::from_fn(|r, c| Dual::constant(case.parameters[0][N * r + c])),
    })
    .expect("parameters of a case");
    let initial = BodyNInitial {
        Λ: Orthogonal::identity().retract(&turn),
        body_momentum: BodyMomentumMatrix(mu),
    };
    let h = length(case, warp / size, mu[planes[0]]);
    let (mut state, mut workspace) = model.start(initial, h).expect("solvable");
    // In three dimensions the bracket uses a vector as the momentum.
    let seen = |m: &SMatrix<Seeded, N, N>| match N {
        3 => quantity(&SVector::<Seeded, 3>::from_fn(|i, _| m[planes[i]])),
        _ => quantity(m),
    };
    let before = vec![seen(&state.body_momentum().0)];
    model.step(&mut state, &mut workspace).expect("solvable");
    (before, vec![seen(&state.body_momentum().0)])
}

fn body_n(case: &Case, draws: &mut Draws, warp: f64) -> Step {
    match case.parameters[0].len() {
        9 => body_of_size::<3>(case, draws, warp),
        16 => body_of_size::<4>(case, draws, warp),
        25 => body_of_size::<5>(case, draws, warp),
        entries => panic!("no start for {entries} entries"),
    }
}

/// The source of the model, with the named sizes replaced by the numbers of this case.
fn of_size(source: &str, case: &Case) -> String {
    let n = case.parameters[0].len().isqrt();
    let start = source.find("dim n in ").expect("the statement of its size");
    let end = start + source[start..].find(';').expect("its end") + 1;
    let sized = [&source[..start], &source[end..]].concat();
    sized.replace("<n>", &format!("<{n}>"))
}

/// How to start each model.
const MODELS: [(&str, Start); 16] = [
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

/// The space on which the bracket closes.
fn space(d: &Derivation) -> Space {
    match d.bracket.holds_elements {
        true => Space::Phase,
        false => Space::Reduced,
    }
}

/// Names and structures of the coordinates, in the order of the bracket.
fn letters(d: &Derivation) -> Vec<(String, Structure)> {
    let momenta = d.letters.node_momentum.iter().copied();
    let phase = space(d) == Space::Phase;
    let elements = d.spec.configurations.iter().filter(|_| phase);
    let advected = d.spec.advected.iter();
    let advected = advected.filter(|a| !(phase && a.definition.is_some()));
    let others = elements
        .map(|c| c.element)
        .chain(advected.map(|a| a.quantity));
    let named = momenta.chain(others).map(|id| {
        let symbol = d.letters.symbols.get(id);
        (symbol.name.clone(), symbol.structure)
    });
    named.collect()
}

/// The variations of a node in the coordinates of the bracket: one row per coordinate, one column per seed. The number of seeds
/// equals the number of coordinates.
fn changes(letters: &[(String, Structure)], node: &Node) -> DMatrix<f64> {
    let sizes = letters.iter().zip(node);
    let seeds = sizes
        .map(|((_, structure), q)| coordinates(*structure, q.rows, q.cols).len())
        .sum();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for ((_, structure), q) in letters.iter().zip(node) {
        let seen = |change: &Vec<f64>| -> DMatrix<f64> {
            let change = DMatrix::from_row_slice(q.rows, q.cols, change);
            match structure {
                // Group elements vary by X^-1 dX.
                Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion => {
                    let own = DMatrix::from_row_slice(q.rows, q.cols, &q.value);
                    own.try_inverse().expect("an element of a group") * change
                }
                _ => change,
            }
        };
        let (own, others) = q.change.split_at(seeds);
        let unseeded = others.iter().flatten().all(|x| *x == 0.0);
        assert!(unseeded, "more seeds than coordinates");
        let seen: Vec<_> = own.iter().map(seen).collect();
        for (i, j) in coordinates(*structure, q.rows, q.cols) {
            rows.push(seen.iter().map(|m| m[(i, j)]).collect());
        }
    }
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

fn bracket(d: &Derivation, letters: &[(String, Structure)], node: &Node) -> DMatrix<f64> {
    let mut at = Assignment::new();
    for ((name, _), q) in letters.iter().zip(node) {
        at.set(name, 0, q.rows, q.cols, &q.value);
    }
    let b: Matrix = d
        .bracket_matrix(space(d), &at)
        .expect("all values are given");
    DMatrix::from_row_slice(b.rows, b.cols, &b.data)
}

/// The fault that the test introduces before it compares the brackets.
#[derive(Clone, Copy, PartialEq)]
enum Spoilt {
    Not,
    /// Flips the sign of the brackets among the first three coordinates. If these are zero, as for the momentum of a field, flips
    /// the brackets of the first coordinate with all others.
    Sign,
    /// Uses the bracket at the start of the step instead of the end.
    End,
}

/// The largest entry of `D B D^T - B'` relative to the largest entry of `B'`.
fn defect(d: &Derivation, (before, after): &Step, spoilt: Spoilt) -> f64 {
    let letters = letters(d);
    assert_eq!(
        letters.len(),
        before.len(),
        "{}: every quantity of the reduced space",
        d.spec.name
    );
    let own = changes(&letters, before)
        .try_inverse()
        .expect("seeds are coordinates");
    let jacobian = changes(&letters, after) * own;
    let at = |node: &Node| {
        let mut b = bracket(d, &letters, node);
        if spoilt == Spoilt::Sign {
            let mut block = b.view_mut((0, 0), (3, 3));
            if block.amax() > 0.0 {
                block.neg_mut();
            } else {
                b.row_mut(0).neg_mut();
                b.column_mut(0).neg_mut();
            }
        }
        b
    };
    let image = at(if spoilt == Spoilt::End { before } else { after });
    let off = &jacobian * at(before) * jacobian.transpose() - &image;
    // `amax` could ignore a NaN.
    match off.iter().all(|x| x.is_finite()) {
        true => off.amax() / image.amax(),
        false => f64::INFINITY,
    }
}

/// Visits every case with its derivation and its start.
fn for_every_case(mut look: impl FnMut(&str, &Case, &Derivation, Start)) {
    for entry in clebsch_models::gallery() {
        let name = entry.card.kebab;
        let derived = derive_source(entry.card.source).expect("derives");
        let named = !derived.spec.dimensions.is_empty();
        let (_, start) = MODELS
            .iter()
            .find(|(known, _)| *known == name)
            .unwrap_or_else(|| panic!("say above how {name} is started"));
        for case in &entry.cases {
            if !named {
                look(name, case, &derived, *start);
            } else if case.parameters[0].len() <= 25 {
                // If the dimension is open, the bracket has no matrix.
                let d = derive_source(&of_size(entry.card.source, case)).expect("derives");
                look(name, case, &d, *start);
            }
        }
    }
}

#[test]
fn steps_are_poisson_maps() {
    for_every_case(|name, case, d, start| {
        let mut draws = Draws::new(61);
        let worst = (0..POINTS)
            .map(|_| defect(d, &start(case, &mut draws, 0.0), Spoilt::Not))
            .fold(0.0, worse);
        println!("{name} {}: {worst:.1e}", case.name);
        assert!(worst < TOLERANCE, "{name} {}: {worst:e}", case.name);
    });
}

#[test]
fn wrong_brackets_are_noticed() {
    for_every_case(|name, case, d, start| {
        let mut draws = Draws::new(62);
        let step = start(case, &mut draws, 0.0);
        // The bracket of fields alone is constant.
        let letters = letters(d);
        if bracket(d, &letters, &step.0) != bracket(d, &letters, &step.1) {
            let late = defect(d, &step, Spoilt::End);
            assert!(
                late > 1e4 * TOLERANCE,
                "{name} {}, wrong end: {late:e}",
                case.name
            );
        }
        // The bracket of a single momentum is linear, so its overall sign cancels.
        if step.0.len() > 1 {
            let sign = defect(d, &step, Spoilt::Sign);
            assert!(
                sign > 1e4 * TOLERANCE,
                "{name} {}, wrong sign: {sign:e}",
                case.name
            );
        }
    });
}

#[test]
fn a_step_that_depends_on_the_state_is_no_poisson_map() {
    for_every_case(|name, case, d, start| {
        let mut draws = Draws::new(63);
        let found = defect(d, &start(case, &mut draws, WARP), Spoilt::Not);
        assert!(found > 1e4 * TOLERANCE, "{name} {}: {found:e}", case.name);
    });
}
