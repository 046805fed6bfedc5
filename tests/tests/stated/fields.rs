//! Fields: configurations that are added, against the variation of the action
//! in flat coordinates, by dual numbers. What classical mechanics knows of them: Störmer-Verlet, the
//! centred rotation in a magnetic field, momenta of translations and rotations.

use clebsch::integrate::Stepper;
use clebsch::nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use clebsch::{Additive, FieldMomentum};
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, constant_column, cross, dot};
use std::array::from_fn;

clebsch::model! {
    /// A planet about a fixed sun.
    model Planet {
        param m, k: Real;
        field X: Vec<3>;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*k/sqrt(dot(X, X));
    }
}

clebsch::model! {
    /// A charge in a magnetic and an electric field.
    model Charge {
        param m, q: Real;
        param B, E: Vec<3>;
        field X: Vec<3>;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h)
            + (q/2)*dot(cross(B, X), next(X) - X) + h*q*dot(E, X);
    }
}

clebsch::model! {
    /// Two masses on springs in a plane, the first one hung from the origin.
    model Pendulum {
        param m, M, k, l: Real;
        param g: Vec<2>;
        field a, b: Vec<2>;
        lagrangian = m*dot(next(a) - a, next(a) - a)/(2*h) + M*dot(next(b) - b, next(b) - b)/(2*h)
            + h*m*dot(g, a) + h*M*dot(g, b)
            - (h*k/2)*(sqrt(dot(a, a)) - l)^2 - (h*k/2)*(sqrt(dot(b - a, b - a)) - l)^2;
    }
}

clebsch::model! {
    /// Two numbers bound by an exponential, one of them heavier with its place.
    model Numbers {
        param m, a, b: Real;
        field x, y: Real;
        lagrangian = m*(next(x) - x)^2/(2*h) + m*(1 + a*y^2)*(next(y) - y)^2/(2*h)
            - h*(a/b)*exp(-b*(x - y)) - h*a*x^2;
    }
}

clebsch::model! {
    /// The placement of a deformable body as a field of matrices.
    model Placement {
        param I0: Sym<3>;
        param k: Real;
        field Q: Mat<3>;
        lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - h*k*tr(Q^T*Q*Q^T*Q);
    }
}

clebsch::model! {
    /// A field of two rows and three columns whose inertia has two sides.
    model Sheet {
        param A: Sym<2>;
        param B: Sym<3>;
        param k: Real;
        field F: Mat<2, 3>;
        lagrangian = tr(A*(next(F) - F)*B*(next(F) - F)^T)/(2*h) - h*k*tr(F*F^T)^2;
    }
}

/// The action of an edge in flat coordinates, term by term, and the directions in which a node may move.
pub(super) trait Flat {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T>;

    fn directions(&self, node: &[f64]) -> Vec<Vec<f64>> {
        let unit = |i: usize| (0..node.len()).map(move |j| f64::from(u8::from(i == j)));
        (0..node.len()).map(|i| unit(i).collect()).collect()
    }
}

/// The largest derivative of the action of two edges as the node between them moves, of the size of its
/// terms.
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

/// The largest share along some steps.
pub(super) fn worst<A: Flat, M: Stepper<Scalar = f64>>(
    action: &A,
    model: &M,
    start: M::State,
    h: f64,
    flat: impl Fn(&M::State) -> Vec<f64>,
) -> f64
where
    M::State: Copy,
{
    let mut work = model.workspace(&start, h).expect("solvable");
    let mut past = [start; 3];
    let mut worst = 0.0f64;
    for step in 0..8 {
        let mut state = past[2];
        model.advance(&mut state, &mut work).expect("solvable");
        past = [past[1], past[2], state];
        if step > 0 {
            worst = worst.max(share(action, &past.map(|s| flat(&s))));
        }
    }
    worst
}

/// A thousand roundings of the size of the terms.
pub(super) const ROUNDING: f64 = 2e-13;

pub(super) fn minus<T: Number, const N: usize>(a: &[T], b: &[T]) -> [T; N] {
    from_fn(|i| a[i] - b[i])
}

pub(super) fn of<T: Number>(x: f64) -> T {
    T::constant(x)
}

/// A force at both ends of the edge.
pub(super) fn at_ends<T: Number>(tail: &[T], head: &[T], term: impl Fn(&[T]) -> T) -> [T; 2] {
    [tail, head].map(|node| of::<T>(0.5) * term(node))
}

/// Parameters of the models of vectors, by their names there.
struct Given {
    h: f64,
    m: f64,
    k: f64,
    q: f64,
    b: [f64; 3],
    e: [f64; 3],
}

impl Given {
    fn random(source: &mut Source, h: f64) -> Given {
        Given {
            h,
            m: source.between(0.5, 2.0),
            k: source.between(0.5, 2.0),
            q: source.between(-2.0, 2.0),
            b: source.vector(),
            e: source.vector(),
        }
    }
}

struct OfPlanet<'a>(&'a Given);

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

struct OfCharge<'a>(&'a Given);

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

fn planet(given: &Given, source: &mut Source) -> (Planet, PlanetInitial) {
    let model = Planet::new(PlanetParameters {
        m: given.m,
        k: given.k,
    });
    let initial = PlanetInitial {
        X: Additive::new(Vector3::new(1.0, 0.2, -0.1)),
        momentum: FieldMomentum(Vector3::from(source.vector()) * 0.5),
    };
    (model.expect("parameters"), initial)
}

fn charge(given: &Given, source: &mut Source) -> (Charge, ChargeInitial) {
    let model = Charge::new(ChargeParameters {
        m: given.m,
        q: given.q,
        B: Vector3::from(given.b),
        E: Vector3::from(given.e),
    });
    let initial = ChargeInitial {
        X: Additive::new(Vector3::from(source.vector())),
        momentum: FieldMomentum(Vector3::from(source.vector())),
    };
    (model.expect("parameters"), initial)
}

#[test]
fn vectors_solve_the_unreduced_equations() {
    let mut source = Source::seeded(31);
    for h in [0.01, 0.1, 0.3] {
        for _ in 0..20 {
            let given = Given::random(&mut source, h);
            let (model, initial) = planet(&given, &mut source);
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &PlanetState<f64>| s.X().matrix().as_slice().to_vec();
            let found = worst(&OfPlanet(&given), &model, start, h, flat);
            assert!(found < ROUNDING, "planet: {found:e}");
            let (model, initial) = charge(&given, &mut source);
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &ChargeState<f64>| s.X().matrix().as_slice().to_vec();
            let found = worst(&OfCharge(&given), &model, start, h, flat);
            assert!(found < ROUNDING, "charge: {found:e}");
        }
    }
}

/// A mutation that must be seen: the action with another force.
#[test]
fn the_oracle_notices_another_force() {
    let mut source = Source::seeded(32);
    let mut given = Given::random(&mut source, 0.1);
    let (model, initial) = planet(&given, &mut source);
    let (start, _) = model.start(initial, given.h).expect("solvable");
    given.k *= 1.0 + 1e-6;
    let flat = |s: &PlanetState<f64>| s.X().matrix().as_slice().to_vec();
    let found = worst(&OfPlanet(&given), &model, start, given.h, flat);
    assert!(found > ROUNDING, "{found:e}");
}

/// The kinetic momentum `m V` of a charge is turned about `B` by exactly `2 atan(q |B| h/2m)` a step,
/// where there is no electric field: the centred rotation of Boris.
#[test]
fn a_charge_turns_as_boris_has_it() {
    let mut source = Source::seeded(33);
    for h in [0.01, 0.2, 3.0] {
        let mut given = Given::random(&mut source, h);
        (given.b, given.e) = ([0.0, 0.0, 1.7], [0.0; 3]);
        let (model, initial) = charge(&given, &mut source);
        let (start, mut work) = model.start(initial, h).expect("solvable");
        let mut nodes = [start; 3];
        for k in 1..3 {
            nodes[k] = nodes[k - 1];
            model.step(&mut nodes[k], &mut work).expect("solvable");
        }
        let place = nodes.map(|s| s.X().matrix());
        let steps = [place[1] - place[0], place[2] - place[1]];
        let plane = steps.map(|d| Vector2::new(d.x, d.y));
        let turned = plane[0].perp(&plane[1]).atan2(plane[0].dot(&plane[1]));
        // With this sign of the vector potential a positive charge turns against B.
        let expected = -2.0 * (given.q * 1.7 * h / (2.0 * given.m)).atan();
        assert!((turned - expected).abs() < 1e-13, "{turned} {expected}");
        assert!((plane[0].norm() - plane[1].norm()).abs() < 1e-14 * plane[0].norm() + 1e-15);
        assert!((steps[0].z - steps[1].z).abs() < 1e-14 * steps[0].norm() + 1e-15);
    }
}

/// Angular momentum of a planet is exact, and a step is Störmer-Verlet to the bit pattern of its
/// formula: half a kick, a drift, half a kick.
#[test]
fn a_planet_is_stoermer_verlet() {
    let mut source = Source::seeded(34);
    let given = Given::random(&mut source, 0.05);
    let (model, initial) = planet(&given, &mut source);
    let (mut state, mut work) = model.start(initial, given.h).expect("solvable");
    let force = |x: Vector3<f64>| -x * (given.m * given.k / x.norm().powi(3));
    let (mut x, mut p) = (state.X().matrix(), state.momentum().0);
    let about = x.cross(&p);
    for _ in 0..1000 {
        model.step(&mut state, &mut work).expect("solvable");
        p += force(x) * (0.5 * given.h);
        x += p * (given.h / given.m);
        p += force(x) * (0.5 * given.h);
    }
    // Rounding is magnified by the motion, linearly in time for a closed orbit.
    assert!((state.X().matrix() - x).norm() < 1e-10 * x.norm());
    assert!((state.momentum().0 - p).norm() < 1e-10 * p.norm());
    let now = state.X().matrix().cross(&state.momentum().0);
    let scale = state.X().matrix().norm() * p.norm();
    assert!(
        (now - about).norm() < 1e-13 * scale,
        "{:e}",
        (now - about).norm() / scale
    );
}

struct OfPendulum {
    h: f64,
    m: f64,
    heavy: f64,
    k: f64,
    l: f64,
    g: [f64; 2],
}

impl Flat for OfPendulum {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let d: [T; 4] = minus(head, tail);
        let mut all = vec![
            of::<T>(0.5 * self.m / self.h) * (d[0] * d[0] + d[1] * d[1]),
            of::<T>(0.5 * self.heavy / self.h) * (d[2] * d[2] + d[3] * d[3]),
        ];
        let hung = |x: &[T]| of::<T>(self.g[0]) * x[0] + of::<T>(self.g[1]) * x[1];
        let spring = |x: T, y: T| {
            let stretch = (x * x + y * y).sqrt() - of(self.l);
            of::<T>(-0.5 * self.h * self.k) * stretch * stretch
        };
        all.extend(at_ends(tail, head, |x| {
            of::<T>(self.h * self.m) * hung(&x[..2])
        }));
        all.extend(at_ends(tail, head, |x| {
            of::<T>(self.h * self.heavy) * hung(&x[2..])
        }));
        all.extend(at_ends(tail, head, |x| spring(x[0], x[1])));
        all.extend(at_ends(tail, head, |x| spring(x[2] - x[0], x[3] - x[1])));
        all
    }
}

#[test]
fn a_pendulum_of_two_springs_solves_the_unreduced_equations() {
    let mut source = Source::seeded(35);
    for h in [0.01, 0.1] {
        for _ in 0..20 {
            let given = OfPendulum {
                h,
                m: source.between(0.5, 2.0),
                heavy: source.between(0.5, 2.0),
                k: source.between(1.0, 20.0),
                l: source.between(0.5, 1.0),
                g: source.vector(),
            };
            let model = Pendulum::new(PendulumParameters {
                m: given.m,
                M: given.heavy,
                k: given.k,
                l: given.l,
                g: Vector2::from(given.g),
            });
            let model = model.expect("parameters");
            let initial = PendulumInitial {
                a: Additive::new(Vector2::new(0.3, -0.8)),
                momentum_a: FieldMomentum(Vector2::from(source.vector())),
                b: Additive::new(Vector2::new(0.5, -1.9)),
                momentum_b: FieldMomentum(Vector2::from(source.vector())),
            };
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &PendulumState<f64>| {
                [s.a().matrix().as_slice(), s.b().matrix().as_slice()].concat()
            };
            let found = worst(&given, &model, start, h, flat);
            assert!(found < ROUNDING, "{found:e}");
        }
    }
}

struct OfNumbers {
    h: f64,
    m: f64,
    a: f64,
    b: f64,
}

impl Flat for OfNumbers {
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let d: [T; 2] = minus(head, tail);
        let weight = of::<T>(1.0) + of::<T>(self.a) * tail[1] * tail[1];
        let mut all = vec![
            of::<T>(0.5 * self.m / self.h) * d[0] * d[0],
            of::<T>(0.5 * self.m / self.h) * weight * d[1] * d[1],
        ];
        all.extend(at_ends(tail, head, |x| {
            of::<T>(-self.h * self.a / self.b) * (of::<T>(-self.b) * (x[0] - x[1])).exp()
        }));
        all.extend(at_ends(tail, head, |x| {
            of::<T>(-self.h * self.a) * x[0] * x[0]
        }));
        all
    }
}

#[test]
fn numbers_solve_the_unreduced_equations() {
    let mut source = Source::seeded(36);
    for h in [0.01, 0.1] {
        for _ in 0..20 {
            let given = OfNumbers {
                h,
                m: source.between(0.5, 2.0),
                a: source.between(0.1, 1.0),
                b: source.between(0.5, 1.5),
            };
            let (m, a, b) = (given.m, given.a, given.b);
            let model = Numbers::new(NumbersParameters { m, a, b }).expect("parameters");
            let mut number = || SMatrix::<f64, 1, 1>::new(source.between(-1.0, 1.0));
            let initial = NumbersInitial {
                x: Additive::new(number()),
                momentum_x: FieldMomentum(number()),
                y: Additive::new(number()),
                momentum_y: FieldMomentum(number()),
            };
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &NumbersState<f64>| vec![s.x().matrix()[0], s.y().matrix()[0]];
            let found = worst(&given, &model, start, h, flat);
            assert!(found < ROUNDING, "{found:e}");
        }
    }
}

/// Kinetic terms `tr(A ΔF B ΔFᵀ)/2h` and a potential `k tr(F^T F F^T F)` or `k tr(F F^T)²`.
struct OfMatrix<const R: usize, const C: usize> {
    h: f64,
    k: f64,
    a: Square<f64, R>,
    b: Square<f64, C>,
    /// Whether the potential is the square of a trace.
    of_trace: bool,
}

impl<const R: usize, const C: usize> Flat for OfMatrix<R, C> {
    /// Column by column.
    fn edge<T: Number>(&self, tail: &[T], head: &[T]) -> Vec<T> {
        let d: Vec<T> = tail.iter().zip(head).map(|(a, b)| *b - *a).collect();
        let mut kinetic = of::<T>(0.0);
        for i in 0..R {
            for j in 0..R {
                for k in 0..C {
                    for l in 0..C {
                        let weight = of::<T>(self.a.0[i][j] * self.b.0[k][l]);
                        kinetic = kinetic + weight * d[R * k + j] * d[R * l + i];
                    }
                }
            }
        }
        let mut all = vec![of::<T>(0.5 / self.h) * kinetic];
        all.extend(at_ends(tail, head, |f| {
            let form: Square<T, C> = Square::from_entries(|k, l| {
                (0..R).fold(of(0.0), |sum, i| sum + f[R * k + i] * f[R * l + i])
            });
            let value = match self.of_trace {
                true => form.trace() * form.trace(),
                false => (form * form).trace(),
            };
            of::<T>(-self.h * self.k) * value
        }));
        all
    }
}

fn array<const R: usize, const C: usize>(source: &mut Source) -> SMatrix<f64, R, C> {
    SMatrix::from_fn(|_, _| source.between(-1.0, 1.0))
}

#[test]
fn matrices_solve_the_unreduced_equations() {
    let mut source = Source::seeded(37);
    for h in [0.01, 0.1] {
        for _ in 0..20 {
            let k = source.between(0.1, 1.0);
            let given = OfMatrix::<3, 3> {
                h,
                k,
                a: Square::identity(),
                b: source.positive(),
                of_trace: false,
            };
            let model = Placement::new(PlacementParameters {
                I0: Matrix3::from_fn(|i, j| given.b.0[i][j]),
                k,
            });
            let model = model.expect("parameters");
            let initial = PlacementInitial {
                Q: Additive::new(array(&mut source)),
                momentum: FieldMomentum(array(&mut source)),
            };
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &PlacementState<f64>| s.Q().matrix().as_slice().to_vec();
            let found = worst(&given, &model, start, h, flat);
            assert!(found < ROUNDING, "placement: {found:e}");
            let given = OfMatrix::<2, 3> {
                h,
                k,
                a: source.positive(),
                b: source.positive(),
                of_trace: true,
            };
            let model = Sheet::new(SheetParameters {
                A: SMatrix::from_fn(|i, j| given.a.0[i][j]),
                B: SMatrix::from_fn(|i, j| given.b.0[i][j]),
                k,
            });
            let model = model.expect("parameters");
            let initial = SheetInitial {
                F: Additive::new(array(&mut source)),
                momentum: FieldMomentum(array(&mut source)),
            };
            let (start, _) = model.start(initial, h).expect("solvable");
            let flat = |s: &SheetState<f64>| s.F().matrix().as_slice().to_vec();
            let found = worst(&given, &model, start, h, flat);
            assert!(found < ROUNDING, "sheet: {found:e}");
        }
    }
}
