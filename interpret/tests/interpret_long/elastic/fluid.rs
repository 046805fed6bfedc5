//! Homogeneous fluid ellipsoids of Dirichlet and Riemann against known results: the modes of a sphere, the stability
//! limit of Maclaurin's spheroids, the pressure of a sphere at rest, the invariants of any motion. Density and
//! constant of gravitation are one, the reference is a unit ball.

use clebsch::card::{Card, Settings, Trajectory};
use core::f64::consts::PI;

const MODEL: &str = include_str!("../../../../models/elastic/fluid-ellipsoid.clebsch");

const MASS: f64 = 4.0 * PI / 3.0;

type Square = [f64; 9];

fn times(a: &Square, b: &Square) -> Square {
    core::array::from_fn(|n| (0..3).map(|k| a[n / 3 * 3 + k] * b[k * 3 + n % 3]).sum())
}

fn transposed(a: &Square) -> Square {
    core::array::from_fn(|n| a[n % 3 * 3 + n / 3])
}

fn diagonal(x: f64, y: f64, z: f64) -> Square {
    [x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z]
}

fn determinant(a: &Square) -> f64 {
    a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6])
        + a[2] * (a[3] * a[7] - a[4] * a[6])
}

/// A trajectory of this placement and velocity.
struct Fluid {
    card: Card,
    of: Box<dyn Trajectory>,
}

impl Fluid {
    fn new(q: &Square, velocity: &Square, h: f64) -> Fluid {
        let card = clebsch_interpret::card(MODEL).expect("is read");
        let moments = diagonal(MASS / 5.0, MASS / 5.0, MASS / 5.0);
        let parameters = [moments.to_vec(), vec![MASS]];
        let initial = [q.to_vec(), times(velocity, &moments).to_vec()];
        let of = (card.open)(&parameters, &initial, Settings::step(h));
        let of = of.unwrap_or_else(|e| panic!("{e}"));
        Fluid { card, of }
    }

    fn seen(&self, name: &str) -> Vec<f64> {
        let mut all = vec![0.0; self.card.observable_count()];
        self.of.observe(&mut all);
        let mut from = 0;
        for field in self.card.observables {
            if field.ascii == name {
                return all[from..from + field.count()].to_vec();
            }
            from += field.count();
        }
        panic!("{name} is no observable")
    }

    fn square(&self, name: &str) -> Square {
        self.seen(name).try_into().expect("nine numbers")
    }

    fn step(&mut self) {
        self.of.step().unwrap_or_else(|e| panic!("{e}"));
    }

    fn energy(&self) -> f64 {
        let mut all = vec![0.0; self.card.invariant_count()];
        self.of.invariants(&mut all);
        all[0]
    }
}

/// Semi-axes and square of the angular velocity of a spheroid of this eccentricity in equilibrium (Maclaurin).
fn spheroid(e: f64) -> (f64, f64, f64) {
    let c = (1.0 - e * e).sqrt();
    let a = (1.0 - e * e).powf(-1.0 / 6.0);
    let rate = 2.0 * c * (3.0 - 2.0 * e * e) * e.asin() / e.powi(3) - 6.0 * (1.0 - e * e) / (e * e);
    (a, a * c, PI * rate)
}

/// Positions follow the Störmer scheme, so the second difference of a small motion is its force: the squared
/// frequency is 16 pi/15 for each of the five modes, up to the amplitude and to rounding over amplitude and h².
#[test]
fn a_sphere_has_five_modes_of_one_frequency() {
    let (small, h) = (1e-5, 0.01);
    let root = 1.0 / (1.0_f64 - small * small).cbrt();
    let shear = |i: usize, j: usize| {
        let mut q = diagonal(root, root, root);
        (q[3 * i + j], q[3 * j + i]) = (small * root, small * root);
        q
    };
    let stretched = |x: f64, y: f64| diagonal(1.0 + x, 1.0 + y, 1.0 / ((1.0 + x) * (1.0 + y)));
    for (q, at) in [
        (stretched(small, 0.0), 0),
        (stretched(small, -small), 4),
        (shear(0, 1), 1),
        (shear(0, 2), 2),
        (shear(1, 2), 5),
    ] {
        let one = determinant(&q).cbrt();
        let q: Square = q.map(|x| x / one);
        let mut fluid = Fluid::new(&q, &[0.0; 9], h);
        let part = |q: &Square| q[at] - if at % 4 == 0 { 1.0 } else { 0.0 };
        let mut seen = vec![part(&q)];
        for _ in 0..20 {
            fluid.step();
            seen.push(part(&fluid.square("Q")));
        }
        for three in seen.windows(3).skip(5) {
            let square = -(three[2] - 2.0 * three[1] + three[0]) / (h * h * three[1]);
            assert!(
                (square / (16.0 * PI / 15.0) - 1.0).abs() < 2e-4,
                "{at}: {square}"
            );
        }
    }
}

/// The deviation of a spheroid from rotational symmetry at these times, relative to the initial deviation.
fn out_of_round(e: f64, times_at: &[f64]) -> Vec<f64> {
    let (a, c, square) = spheroid(e);
    let (small, h) = (1e-6, 0.02);
    let q = diagonal(a * (1.0 + small), a / (1.0 + small), c);
    let turn = [
        0.0,
        -square.sqrt(),
        0.0,
        square.sqrt(),
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    ];
    let mut fluid = Fluid::new(&q, &times(&turn, &q), h);
    let off = |q: &Square| {
        let b = times(q, &transposed(q));
        (0.25 * (b[0] - b[4]).powi(2) + b[1] * b[1]).sqrt() / (b[0] + b[4])
    };
    let start = off(&q);
    let mut steps = 0;
    let at = times_at.iter().map(|time| {
        while f64::from(steps) * h < time - 0.5 * h {
            fluid.step();
            steps += 1;
        }
        off(&fluid.square("Q")) / start
    });
    at.collect()
}

/// From an eccentricity of 0.9529 on a bar grows, with the rate of the theory of second harmonics (Chandrasekhar):
/// the square root of Ω² - 4 B11.
#[test]
fn flat_spheroids_are_unstable() {
    for (e, bound) in [(0.6, 3.0), (0.9, 3.0), (0.94, 4.0)] {
        let grown = out_of_round(e, &[5.0, 10.0, 15.0, 20.0]);
        assert!(grown.iter().all(|x| *x < bound), "{e}: {grown:?}");
    }
    for (e, rate) in [(0.97, 0.4020), (0.98, 0.4942)] {
        let grown = out_of_round(e, &[12.0, 18.0]);
        let found = (grown[1] / grown[0]).ln() / 6.0;
        assert!(grown[1] > 300.0, "{e}: {grown:?}");
        // The remainder of the initial motion, e^(-2·12 rate), and the square of the step.
        assert!((found / rate - 1.0).abs() < 0.02, "{e}: {found} {rate}");
    }
}

/// A sphere at rest stays at rest, and the multiplier is its pressure, M²/5, for any step size: the other roots of
/// the cubic grow if the step becomes short.
#[test]
fn the_multiplier_of_a_sphere_at_rest_is_its_pressure() {
    for h in [0.1, 0.01, 1e-3] {
        let mut fluid = Fluid::new(&diagonal(1.0, 1.0, 1.0), &[0.0; 9], h);
        for _ in 0..20 {
            fluid.step();
        }
        let found = fluid.seen("lambda")[0].abs();
        assert!(
            (found / (MASS * MASS / 5.0) - 1.0).abs() < 1e-9,
            "{h}: {found}"
        );
        let found = fluid.square("Q");
        let off = found
            .iter()
            .zip(diagonal(1.0, 1.0, 1.0))
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, |a: f64, b| if b > a { b } else { a }) < 1e-12);
    }
}

/// An ellipsoid that rotates, streams and pulsates: volume, angular momentum and circulation over 1e4 steps; the
/// energy error is bounded by the square of the step, without a trend.
#[test]
fn a_riemann_ellipsoid_keeps_what_it_should() {
    let q = diagonal(1.2, 1.0, 1.0 / 1.2);
    // Without divergence: tr(Q⁻¹ V) = 0.
    let gradient = [0.1, -0.7, 0.2, 0.5, -0.05, 0.1, -0.1, 0.15, -0.05];
    let mut fluid = Fluid::new(&q, &times(&gradient, &q), 0.01);
    let kept = |fluid: &Fluid| {
        let (q, p) = (fluid.square("Q"), fluid.square("momentum"));
        let (turning, streaming) = (times(&p, &transposed(&q)), times(&transposed(&q), &p));
        let skew = |m: &Square| [m[1] - m[3], m[2] - m[6], m[5] - m[7]];
        (
            determinant(&q),
            [skew(&turning), skew(&streaming)].concat(),
            fluid.energy(),
        )
    };
    let (_, momenta, energy) = kept(&fluid);
    let mut means = [0.0; 2];
    for step in 0..10_000 {
        fluid.step();
        let (volume, now, here) = kept(&fluid);
        assert!((volume - 1.0).abs() < 1e-13, "{step}: {volume}");
        for (a, b) in now.iter().zip(&momenta) {
            // Rounding of 1e4 steps, as a walk.
            assert!((a - b).abs() < 1e-11, "{step}: {a} {b}");
        }
        assert!(
            (here / energy - 1.0).abs() < 1e-3,
            "{step}: {here} {energy}"
        );
        means[step / 5000] += here / 5000.0;
    }
    assert!((means[1] / means[0] - 1.0).abs() < 1e-5, "{means:?}");
}
