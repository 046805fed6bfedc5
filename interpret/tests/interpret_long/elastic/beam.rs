//! Compares the geometrically exact rod with the Timoshenko theory of beams that bend and shear, for small motions
//! across its axis. The tests are the frequencies of a beam on two supports, and cantilevers at equilibrium.
//!
//! Let w be the deflection and θ the rotation of a section. The strains are `w' - θ` and `θ'`. The balances of force
//! and moment are `A w'' (in time) = S (w' - θ)'` and `I θ'' (in time) = K θ'' + S (w' - θ)`. Per unit of length, A is
//! the mass and I the inertia; S and K are the stiffnesses against shear and bending.
//!
//! On two supports, `w = W sin(k x) cos(ω t)` and `θ = Θ cos(k x) cos(ω t)` with `k = n π/L`. The ends satisfy w = 0
//! and θ' = 0. The balances hold if `(S k² - A ω²) W = S k Θ` and `(K k² + S - I ω²) Θ = S k W`. Hence `A I ω⁴ - (A (K
//! k² + S) + I S k²) ω² + S K k⁴ = 0`: the smaller root bends, the larger root shears. On sections of length s,
//! differences of sines at nodes are cosines at segments times `(2/s) sin(k s/2)`. This factor replaces k, and nothing
//! else changes. With steps of size h, `(2/h) sin(ω h/2)` replaces ω.
//!
//! At equilibrium under its weight q, a cantilever has `w(L) = q L⁴/(8 K) + q L²/(2 S)`. Under a force P on its end, it
//! has `w(L) = P L³/(3 K) + P L/S`. In both, the moment is integrated twice and the shear force once.

use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::sync::Arc;

const ROD: &str = include_str!("../../../../models/lattices/geometrically-exact-rod.clebsch");

/// Length and mass per unit length are one; the beam is thick, so that shear and rotary inertia have a visible
/// effect.
const SHEAR: f64 = 100.0;
const INERTIA: f64 = 0.01;
/// Against bending about the second axis: B1 + B3, since `tr(B) Id - B` are the stiffnesses.
const BENDING: f64 = 1.0;

/// A rod of n segments with its end conditions.
struct Beam {
    model: Arc<LineModel>,
    choice: ChainConfig,
    n: usize,
    weight: f64,
    force: f64,
}

/// Positions and rotations in the plane of bending.
struct Shape {
    /// Transverse and axial positions, at each node.
    places: Vec<[f64; 2]>,
    /// Rotation angles, at each segment.
    turns: Vec<f64>,
}

impl Beam {
    fn new(text: &str, n: usize, ends: [&str; 2]) -> Self {
        let lattice = Lattice::read(&pipeline::parse_source(text).expect("is a model"));
        let lattice = lattice.expect("has labels");
        let choice = ChainConfig::representative(&lattice, 1);
        let choice = choice.with_count(&lattice, "i", n).expect("has sites");
        let choice = choice
            .with_end(&lattice, false, ends[0])
            .expect("begins so");
        let choice = choice.with_end(&lattice, true, ends[1]).expect("ends so");
        Self {
            model: LineModel::read(text).expect("has loops over sites"),
            choice,
            n,
            weight: 0.0,
            force: 0.0,
        }
    }

    fn section(&self) -> f64 {
        1.0 / self.n as f64
    }

    fn straight(&self) -> Shape {
        Shape {
            places: (0..=self.n)
                .map(|i| [0.0, i as f64 * self.section()])
                .collect(),
            turns: vec![0.0; self.n],
        }
    }

    /// From rest in a given shape.
    fn start(&self, shape: &Shape, h: f64) -> LineTrajectory {
        let s = self.section();
        let one = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let diagonal = |a, b, c| vec![a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c];
        let numbers = |name: &str| {
            Some(match name {
                "s" => vec![s],
                "m" => (0..=self.n)
                    .map(|i| if i == 0 || i == self.n { s / 2.0 } else { s })
                    .collect(),
                "J" => diagonal(0.75 * INERTIA, 0.6 * INERTIA, 0.25 * INERTIA).repeat(self.n),
                "S" => diagonal(SHEAR, SHEAR, 2.0 * SHEAR),
                "B" => diagonal(0.7 * BENDING, 0.5 * BENDING, 0.3 * BENDING),
                "g" => vec![self.weight, 0.0, 0.0],
                "force" => vec![self.force, 0.0, 0.0],
                "Λw" | "Λw_0" | "Λw_N" => one.to_vec(),
                "φ" => shape
                    .places
                    .iter()
                    .flat_map(|x| [x[0], 0.0, x[1]])
                    .collect(),
                "momentum_φ" => vec![0.0; 3 * (self.n + 1)],
                "Λ" => shape
                    .turns
                    .iter()
                    .flat_map(|t| [t.cos(), 0.0, t.sin(), 0.0, 1.0, 0.0, -t.sin(), 0.0, t.cos()])
                    .collect(),
                "body_momentum_Λ" => vec![0.0; 3 * self.n],
                _ => return None,
            })
        };
        let started = self.model.start(&self.choice, h, &numbers);
        started.unwrap_or_else(|e| panic!("{e}"))
    }
}

/// Both roots of `A I ω⁴ - (A (K k² + S) + I S k²) ω² + S K k⁴ = 0`, the squares of the frequencies.
fn timoshenko(k: f64) -> [f64; 2] {
    let b = BENDING * k * k + SHEAR + INERTIA * SHEAR * k * k;
    let c = SHEAR * BENDING * k.powi(4);
    let larger = (b + (b * b - 4.0 * INERTIA * c).sqrt()) / (2.0 * INERTIA);
    [c / (INERTIA * larger), larger]
}

/// The square of the frequency with which the beam of this text swings, started in a shape of `n` half waves.
fn measured(text: &str, n: usize, waves: f64, branch: usize) -> f64 {
    let beam = Beam::new(text, n, ["pinned", "pinned"]);
    let s = beam.section();
    let k = waves * PI;
    let seen = 2.0 / s * (0.5 * k * s).sin();
    let square = timoshenko(seen)[branch];
    // Small enough that its square is below the bound; fixed supports stretch the beam by this square.
    let turn = 1e-5;
    let deflection = turn * SHEAR * seen / (SHEAR * seen * seen - square);
    let mut shape = beam.straight();
    for (i, place) in shape.places.iter_mut().enumerate().take(n).skip(1) {
        place[0] = deflection * (k * s * i as f64).sin();
    }
    for (i, t) in shape.turns.iter_mut().enumerate() {
        *t = turn * (k * s * (i as f64 + 0.5)).cos();
    }
    let h = 1e-3;
    let mut line = beam.start(&shape, h);
    // The component along the initial mode: for `cos(ω t)`, the sum of the neighbours in time is 2 cos(ω h) times the
    // value.
    let amplitude = |line: &mut LineTrajectory| {
        let places = line.observe("φ").expect("is seen");
        let sum = (0..=n).map(|i| places[3 * i] * (k * s * i as f64).sin());
        sum.sum::<f64>()
    };
    let mut all = vec![amplitude(&mut line)];
    for _ in 0..600 {
        line.step().expect("steps");
        all.push(amplitude(&mut line));
    }
    let (mut both, mut own) = (0.0, 0.0);
    for w in all.windows(3) {
        both += (w[0] - 2.0 * w[1] + w[2]) * w[1];
        own += w[1] * w[1];
    }
    // (2/h)² sin²(ω h/2) = (2 - 2 cos(ω h))/h²
    -both / (own * h * h)
}

/// Rounding of strains, 1e-16 of 1e-5, over (ω h)² = 1e-4 of the slowest mode, averaged over the run; and the square
/// of the amplitude.
const MEASURED: f64 = 1e-6;

/// Long, since six modes are followed on rods of up to forty segments.
#[test]
fn a_beam_on_two_supports_has_the_frequencies_of_timoshenko() {
    for waves in [1.0, 2.0, 3.0] {
        for branch in [0, 1] {
            let exact = timoshenko(waves * PI)[branch];
            let errors = [10, 20, 40].map(|n| {
                let found = measured(ROD, n, waves, branch);
                let s = 1.0 / n as f64;
                let own = timoshenko(2.0 / s * (0.5 * waves * PI * s).sin())[branch];
                let off = (found / own - 1.0).abs();
                assert!(
                    off < MEASURED,
                    "{n} {waves} {branch}: {found} {own} {off:e}"
                );
                (found / exact).sqrt() - 1.0
            });
            for pair in errors.windows(2) {
                let order = (pair[0] / pair[1]).log2();
                assert!((order - 2.0).abs() < 0.05, "{waves} {branch}: {errors:?}");
            }
        }
        // The Euler-Bernoulli beam is wrong by a tenth or more: the shear has a visible effect.
        let bends = BENDING * (waves * PI).powi(4);
        assert!(bends / timoshenko(waves * PI)[0] > 1.1);
    }
}

/// Half the shear energy, and bending with its sign turned.
#[test]
fn another_energy_has_other_frequencies() {
    for (term, other) in [
        ("(h*s/2)*dot(F, S*F)", "(h*s/4)*dot(F, S*F)"),
        ("+ (h/s)*tr(B*", "+ (h/(2*s))*tr(B*"),
    ] {
        assert!(ROD.contains(term));
        let found = measured(&ROD.replace(term, other), 20, 1.0, 0);
        let own = timoshenko(40.0 * (PI / 40.0).sin())[0];
        assert!((found / own - 1.0).abs() > 1e-2, "{other}: {found} {own}");
    }
}

/// The deflection of the far end in equilibrium: the shape from which a step creates no momentum, by Newton's method.
fn deflection(beam: &Beam) -> f64 {
    let n = beam.n;
    let read = |x: &DVector<f64>| {
        let mut shape = beam.straight();
        for i in 0..n {
            let [across, along] = &mut shape.places[i + 1];
            *across += x[3 * i];
            *along += x[3 * i + 1];
            shape.turns[i] = x[3 * i + 2];
        }
        shape
    };
    let left = |x: &DVector<f64>| {
        let mut line = beam.start(&read(x), 1e-4);
        line.step().expect("steps");
        let p = line.observe("momentum_φ").expect("is seen");
        let m = line.observe("body_momentum_Λ").expect("is seen");
        DVector::from_fn(3 * n, |k, _| {
            let i = k / 3;
            [p[3 * (i + 1)], p[3 * (i + 1) + 2], m[3 * i + 1]][k % 3]
        })
    };
    let mut x = DVector::zeros(3 * n);
    let here = left(&x);
    // The tangent of the straight rod. The load is so small that one tangent suffices.
    let moved = 1e-6;
    let mut tangent = DMatrix::zeros(3 * n, 3 * n);
    for k in 0..3 * n {
        x[k] = moved;
        tangent.set_column(k, &((left(&x) - &here) / moved));
        x[k] = 0.0;
    }
    let solved = tangent.lu();
    let mut last = f64::INFINITY;
    for _ in 0..20 {
        let change = solved.solve(&left(&x)).expect("a rod that is held");
        last = change.amax();
        x -= change;
    }
    assert!(last < 1e-12, "{last:e}");
    x[3 * (n - 1)]
}

/// Relative errors for 10, 20 and 40 sections: they are of second order, and the errors after extrapolation are
/// smaller.
fn of_second_order(what: &str, exact: f64, load: impl Fn(&mut Beam)) {
    let found = [10, 20, 40].map(|n| {
        let mut beam = Beam::new(ROD, n, ["clamped", "load"]);
        load(&mut beam);
        deflection(&beam)
    });
    let errors = found.map(|w| w / exact - 1.0);
    println!("{what}: {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{what}: {errors:?}");
    }
    assert!(errors[0].abs() < 1e-2, "{what}: {errors:?}");
    let limit = (4.0 * errors[2] - errors[1]) / 3.0;
    assert!(limit.abs() < 1e-6, "{what}: {limit:e}");
}

/// Long, since beams of three sizes are derived and their equilibria computed.
#[test]
fn cantilevers_at_rest_are_those_of_beam_theory() {
    let load = 1e-4;
    let weight = load / (8.0 * BENDING) + load / (2.0 * SHEAR);
    of_second_order("weight", weight, |beam| beam.weight = load);
    let end = load / (3.0 * BENDING) + load / SHEAR;
    of_second_order("force on the end", end, |beam| beam.force = load);
}
