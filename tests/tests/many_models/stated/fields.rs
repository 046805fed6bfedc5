//! Fields, which are additive vectors, against the variation of the action in flat coordinates by dual numbers. Also tests
//! classical results: Störmer-Verlet, the centred rotation in a magnetic field, and momenta of translations and rotations.

use super::text_model::{Given, Motion, TextModel, given};
use clebsch::nalgebra::{Vector2, Vector3};
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{constant_column, cross, dot};
use std::array::from_fn;

/// A planet about a fixed sun.
const PLANET: &str = "model Planet {
    param m, k: Real;
    field X: Vec<3>;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*k/sqrt(dot(X, X));
}";

/// A charge in a magnetic and an electric field.
const CHARGE: &str = "model Charge {
    param m, q: Real;
    param B, E: Vec<3>;
    field X: Vec<3>;
    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h)
        + (q/2)*dot(cross(B, X), next(X) - X) + h*q*dot(E, X);
}";

/// The action of an edge in flat coordinates, term by term, and the directions of variation at a node.
pub(super) trait Flat {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T>;

    fn directions(&self, node: &[f64]) -> Vec<Vec<f64>> {
        let unit = |i: usize| (0..node.len()).map(move |j| f64::from(u8::from(i == j)));
        (0..node.len()).map(|i| unit(i).collect()).collect()
    }
}

/// The largest derivative of the action of two edges at the middle node, relative to the size of its terms.
pub(super) fn share<A: Flat>(action: &A, nodes: &[Vec<f64>; 3]) -> f64 {
    let still = |x: &[f64]| -> Vec<Dual> { x.iter().map(|v| Dual::constant(*v)).collect() };
    let (before, after) = (still(&nodes[0]), still(&nodes[2]));
    let (mut largest, mut scale) = (0.0f64, 0.0f64);
    for direction in action.directions(&nodes[1]) {
        let moved: Vec<Dual> = nodes[1]
            .iter()
            .zip(&direction)
            .map(|(value, slope)| Dual {
                value: *value,
                slope: *slope,
            })
            .collect();
        let terms = action.edge(&before, &moved).into_iter();
        let terms: Vec<f64> = terms
            .chain(action.edge(&moved, &after))
            .map(|t| t.slope)
            .collect();
        assert!(terms.iter().all(|t| t.is_finite()));
        largest = largest.max(terms.iter().sum::<f64>().abs());
        scale = scale.max(terms.iter().map(|t| t.abs()).sum());
    }
    largest / scale
}

/// The largest such ratio along several steps.
pub(super) fn worst<A: Flat>(
    action: &A,
    motion: &mut Motion,
    flat: impl Fn(&Motion) -> Vec<f64>,
) -> f64 {
    let mut past = [(); 3].map(|()| flat(motion));
    let mut worst = 0.0f64;
    for step in 0..8 {
        motion.steps(1);
        past.rotate_left(1);
        past[2] = flat(motion);
        if step > 0 {
            worst = worst.max(share(action, &past));
        }
    }
    worst
}

/// A thousand rounding errors, relative to the size of the terms.
pub(super) const ROUNDING: f64 = 2e-13;

pub(super) fn minus<T: Number, const N: usize>(a: &[T], b: &[T]) -> [T; N] {
    from_fn(|i| a[i] - b[i])
}

pub(super) fn of<T: Number>(x: f64) -> T {
    T::constant(x)
}

/// A potential term, half at either end of the edge.
pub(super) fn at_ends<T: Number>(tail: &[T], head: &[T], term: impl Fn(&[T]) -> T) -> [T; 2] {
    [tail, head].map(|node| of::<T>(0.5) * term(node))
}

/// Parameters of the vector models, by their names in the models.
struct VectorData {
    h: f64,
    m: f64,
    k: f64,
    q: f64,
    b: [f64; 3],
    e: [f64; 3],
}

impl VectorData {
    fn random(source: &mut Source, h: f64) -> VectorData {
        VectorData {
            h,
            m: source.between(0.5, 2.0),
            k: source.between(0.5, 2.0),
            q: source.between(-2.0, 2.0),
            b: source.vector(),
            e: source.vector(),
        }
    }
}

struct OfPlanet<'a>(&'a VectorData);

impl Flat for OfPlanet<'_> {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let (g, d) = (self.0, minus::<T, 3>(head, tail));
        let mut all = vec![of::<T>(0.5 * g.m / g.h) * dot(&d, &d)];
        all.extend(at_ends(tail, head, |x| {
            let x: [T; 3] = from_fn(|i| x[i]);
            of::<T>(g.h * g.m * g.k) / dot(&x, &x).sqrt()
        }));
        all
    }
}

struct OfCharge<'a>(&'a VectorData);

impl Flat for OfCharge<'_> {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let (g, d) = (self.0, minus::<T, 3>(head, tail));
        let x: [T; 3] = from_fn(|i| tail[i]);
        let turned = cross(&constant_column(&g.b), &x);
        let mut all = vec![
            of::<T>(0.5 * g.m / g.h) * dot(&d, &d),
            of::<T>(0.5 * g.q) * dot(&turned, &d),
        ];
        all.extend(at_ends(tail, head, |x| {
            let x: [T; 3] = from_fn(|i| x[i]);
            of::<T>(g.h * g.q) * dot(&constant_column(&g.e), &x)
        }));
        all
    }
}

fn started(text: &str, h: f64, given: &Given) -> Motion {
    TextModel::read(text).start(h, given).expect("solvable")
}

fn planet(given: &VectorData, source: &mut Source) -> Motion {
    let momentum = Vector3::from(source.vector()) * 0.5;
    let own = given! { m: given.m, k: given.k, X: [1.0, 0.2, -0.1], momentum: momentum };
    started(PLANET, given.h, &own)
}

fn charge(given: &VectorData, source: &mut Source) -> Motion {
    let own = given! {
        m: given.m, q: given.q, B: given.b, E: given.e, X: source.vector::<3>(), momentum: source.vector::<3>(),
    };
    started(CHARGE, given.h, &own)
}

fn place(motion: &Motion) -> Vec<f64> {
    motion.numbers("X")
}

#[test]
fn vectors_solve_the_unreduced_equations() {
    let mut source = Source::seeded(31);
    for h in [0.01, 0.1, 0.3] {
        for _ in 0..20 {
            let given = VectorData::random(&mut source, h);
            let found = worst(&OfPlanet(&given), &mut planet(&given, &mut source), place);
            assert!(found < ROUNDING, "planet: {found:e}");
            let found = worst(&OfCharge(&given), &mut charge(&given, &mut source), place);
            assert!(found < ROUNDING, "charge: {found:e}");
        }
    }
}

/// Negative control: an action with a different force disagrees.
#[test]
fn the_oracle_notices_another_force() {
    let mut source = Source::seeded(32);
    let mut given = VectorData::random(&mut source, 0.1);
    let mut motion = planet(&given, &mut source);
    given.k *= 1.0 + 1e-6;
    let found = worst(&OfPlanet(&given), &mut motion, place);
    assert!(found > ROUNDING, "{found:e}");
}

/// Without an electric field, a step rotates the kinetic momentum `m V` of a charge about `B` by exactly `2 atan(q |B| h/2m)`:
/// Boris's centred rotation.
#[test]
fn a_charge_turns_as_boris_has_it() {
    let mut source = Source::seeded(33);
    for h in [0.01, 0.2, 3.0] {
        let mut given = VectorData::random(&mut source, h);
        (given.b, given.e) = ([0.0, 0.0, 1.7], [0.0; 3]);
        let mut motion = charge(&given, &mut source);
        let mut place = || {
            let place = motion.vector::<3>("X");
            motion.steps(1);
            place
        };
        let place = [place(), place(), place()];
        let steps = [place[1] - place[0], place[2] - place[1]];
        let plane = steps.map(|d| Vector2::new(d.x, d.y));
        let turned = plane[0].perp(&plane[1]).atan2(plane[0].dot(&plane[1]));
        // With this sign of the vector potential, a positive charge rotates in the negative sense about B.
        let expected = -2.0 * (given.q * 1.7 * h / (2.0 * given.m)).atan();
        assert!((turned - expected).abs() < 1e-13, "{turned} {expected}");
        assert!((plane[0].norm() - plane[1].norm()).abs() < 1e-14 * plane[0].norm() + 1e-15);
        assert!((steps[0].z - steps[1].z).abs() < 1e-14 * steps[0].norm() + 1e-15);
    }
}

/// The angular momentum of a planet is exact, and a step equals the Störmer-Verlet formula: half a kick, a drift, half a kick.
#[test]
fn a_planet_is_stoermer_verlet() {
    let mut source = Source::seeded(34);
    let given = VectorData::random(&mut source, 0.05);
    let mut motion = planet(&given, &mut source);
    let force = |x: Vector3<f64>| -x * (given.m * given.k / x.norm().powi(3));
    let node = |m: &Motion| (m.vector::<3>("X"), m.vector::<3>("momentum"));
    let (mut x, mut p) = node(&motion);
    let about = x.cross(&p);
    for _ in 0..1000 {
        motion.steps(1);
        p += force(x) * (0.5 * given.h);
        x += p * (given.h / given.m);
        p += force(x) * (0.5 * given.h);
    }
    let (place, momentum) = node(&motion);
    // The motion amplifies rounding, linearly in time for a closed orbit.
    assert!((place - x).norm() < 1e-10 * x.norm());
    assert!((momentum - p).norm() < 1e-10 * p.norm());
    let off = (place.cross(&momentum) - about).norm() / (place.norm() * p.norm());
    assert!(off < 1e-13, "{off:e}");
}
