//! Runs of chapters 4 and 5 of the thesis with consistent data: energies, potential vorticity, orders.

use clebsch::mesh::Domain;
use clebsch::mesh::placement::{self, Jitter};
use clebsch::nalgebra::{SMatrix, Vector2};
use clebsch::scalar::largest;
use clebsch_models::fluids::particle_mesh_1d::*;
use clebsch_models::fluids::particle_mesh_2d::*;
use clebsch_models::fluids::shallow_water_2d_regularised::*;
use clebsch_models::lattices::shallow_water_1d::*;
use std::f64::consts::{PI, TAU};

fn one(x: f64) -> SMatrix<f64, 1, 1> {
    SMatrix::repeat(x)
}

/// Experiment 1 of section 4.8: a bump of mass on a ring, initially at rest, with f = 2 pi and wave speed 2 pi.
struct Bump {
    model: ShallowWater1D,
    mass: Vec<f64>,
    x: Vec<f64>,
}

const CELLS: usize = 128;

impl Bump {
    fn new() -> Self {
        let dx = TAU / CELLS as f64;
        let x: Vec<f64> = (0..CELLS).map(|i| i as f64 * dx).collect();
        let bump = |x: &f64| 1.0 + 0.1 * (-800.0 * ((x - PI) / TAU).powi(2)).exp();
        let mass: Vec<f64> = x.iter().map(|x| dx * bump(x)).collect();
        let parameters = ShallowWater1DParameters {
            m: mass.clone(),
            g: 4.0 * PI * PI,
            f: TAU,
        };
        let ends = ShallowWater1DEnds::Ring { L: TAU };
        let sites = ShallowWater1DSites { N: CELLS, ends };
        let model = ShallowWater1D::new(parameters, sites).expect("a ring");
        Self { model, mass, x }
    }

    /// At rest, the transverse momentum is the momentum of the rotating frame.
    fn start(&self, dt: f64) -> (ShallowWater1DState, ShallowWater1DWorkspace) {
        let across = self.mass.iter().zip(&self.x).map(|(m, x)| one(m * TAU * x));
        let initial = ShallowWater1DInitial {
            X: self.x.iter().map(|x| one(*x)).collect(),
            Y: vec![one(0.0); CELLS],
            momentum_X: vec![one(0.0); CELLS],
            momentum_Y: across.collect(),
        };
        self.model.start(initial, dt).expect("starts")
    }

    /// The relative displacement of odd and even particles, in units of their spacing. This mode does not change the depth.
    fn odd_from_even(&self, state: &ShallowWater1DState) -> f64 {
        let moved = state.X().iter().zip(&self.x).enumerate();
        let each = moved.map(|(i, (x, x0))| (x[0] - x0) * if i % 2 == 0 { -1.0 } else { 1.0 });
        2.0 * each.sum::<f64>() / TAU
    }

    /// The mean absolute energy error up to time 20.
    fn energy_error(&self, dt: f64) -> f64 {
        let (mut state, mut work) = self.start(dt);
        let first = self.model.energy(&state);
        let steps = (20.0 / dt).round() as usize;
        let mut sum = 0.0;
        for _ in 0..steps {
            self.model.step(&mut state, &mut work).expect("steps");
            sum += (self.model.energy(&state) - first).abs();
        }
        sum / steps as f64
    }
}

#[test]
fn energy_errors_of_shallow_water_on_a_ring_are_those_of_an_independent_program() {
    let bump = Bump::new();
    // Values of an independent program, to four digits; its means cover the same nodes except the first.
    let known = [
        (0.0125, 7.735e-4),
        (0.01, 4.837e-4),
        (0.005, 1.189e-4),
        (0.0025, 2.965e-5),
    ];
    let found = known.map(|(dt, _)| bump.energy_error(dt));
    for ((dt, known), found) in known.iter().zip(&found) {
        assert!(
            (found / known - 1.0).abs() < 2e-2,
            "dt = {dt}: {found:e} for {known:e}"
        );
    }
    // Doubling the step size quadruples the error. The largest step size is near the stability limit 2 dx/c = 0.0156.
    for pair in found[1..].windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}

#[test]
fn over_a_million_steps_potential_vorticity_is_constant_and_the_energy_does_not_drift() {
    let bump = Bump::new();
    let (mut state, mut work) = bump.start(0.01);
    // q = (zeta + f)/h with zeta = dV/dX: the transverse momentum per mass is V + f X.
    let vorticity = |s: &ShallowWater1DState, a: usize| {
        let c = |i: usize| s.momentum_Y()[i][0] / bump.mass[i];
        (c(a + 1) - c(a - 1)) / (2.0 * bump.mass[a])
    };
    let first: Vec<f64> = (1..CELLS - 1).map(|a| vorticity(&state, a)).collect();
    let energy = bump.model.energy(&state);
    let steps = 1_000_000;
    let mut tenths = [0.0; 10];
    let (mut worst, mut apart) = (0.0_f64, 0.0);
    for k in 0..steps {
        bump.model.step(&mut state, &mut work).expect("steps");
        if k % 20 == 0 {
            let off = (bump.model.energy(&state) - energy) / energy;
            worst = worst.max(off.abs());
            tenths[10 * k / steps] += off * 200.0 / steps as f64;
            apart = largest([apart, bump.odd_from_even(&state)]);
        }
    }
    // The transverse momenta are cyclic and exactly conserved.
    let after: Vec<f64> = (1..CELLS - 1).map(|a| vorticity(&state, a)).collect();
    assert_eq!(first, after);
    // Measured: 8.9e-6. Means over tenths of the run range from -4.1e-6 to -4.9e-6.
    assert!(worst < 2e-5, "{worst:e}");
    // Only rotation, as a spring of frequency f, opposes the relative motion of odd and even particles. Measured: 1.5e-3.
    assert!(apart < 1e-2, "{apart:e}");
    // The motion thermalises: means wander within the step error, 5e-4 of 125.
    let (low, high) = tenths
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!(high - low < 2e-6, "{tenths:?}");
}

/// A bump of mass between walls, initially at rest: the largest relative energy error, and the means over quarters of the run.
fn line_between_walls(c0: f64, a0: f64, steps: usize) -> (f64, [f64; 4]) {
    let (count, cells) = (256, 63);
    let dx = TAU / cells as f64;
    let x: Vec<f64> = (0..count)
        .map(|i| (i as f64 + 0.5) * TAU / count as f64)
        .collect();
    let bump = |x: &f64| 1.0 + a0 * (-800.0 * ((x - PI) / TAU).powi(2)).exp();
    let parameters = ParticleMesh1DParameters {
        m: x.iter().map(|x| TAU / count as f64 * bump(x)).collect(),
        w: (0..=cells)
            .map(|i| if i % cells == 0 { dx / 2.0 } else { dx })
            .collect(),
        c0,
        alpha: 2.0 * dx,
    };
    let sites = ParticleMesh1DSites {
        N: count,
        n: [cells],
        domain: Domain::basin([TAU]),
        scalar: Default::default(),
    };
    let model = ParticleMesh1D::new(parameters, sites).expect("a basin");
    let initial = ParticleMesh1DInitial {
        X: x.iter().map(|x| one(*x)).collect(),
        momentum_X: vec![one(0.0); count],
    };
    let (mut state, mut work) = model.start(initial, 5e-3).expect("starts");
    let first = model.energy(&state);
    let (mut worst, mut quarters) = (0.0_f64, [0.0; 4]);
    for k in 0..steps {
        model.step(&mut state, &mut work).expect("steps");
        if k % 50 == 0 {
            let off = (model.energy(&state) - first) / first;
            worst = worst.max(off.abs());
            quarters[4 * k / steps] += off * 200.0 / steps as f64;
        }
    }
    (worst, quarters)
}

#[test]
fn particles_on_a_grid_between_walls_keep_their_energy() {
    // The error grows with the square of the bump height. An independent program gives 1.2e-8 at height 0.1.
    let (worst, quarters) = line_between_walls(1.0, 0.2, 100_000);
    assert!(worst < 1e-7, "{worst:e}");
    // With a drift, the means of the quarters would grow as 1, 3, 5, 7.
    let last = quarters[3] / quarters[0];
    assert!((0.7..1.3).contains(&last), "{quarters:?}");
    let (small, _) = line_between_walls(1.0, 0.1, 20_000);
    let ratio = line_between_walls(1.0, 0.2, 20_000).0 / small;
    assert!((3.0..5.0).contains(&ratio), "{ratio}");
}

/// Two vortices in a rotating channel: the largest relative energy error up to time 3, and the fraction of kinetic energy.
fn channel(dt: f64) -> (f64, f64) {
    let (along, cells) = (128, 63);
    let (count, length, f) = (along * along, TAU, TAU);
    let dx = length / cells as f64;
    let rows = 64;
    let dy = length / rows as f64;
    let centres = [
        (0.1, Vector2::new(PI - 0.8, PI)),
        (-0.1, Vector2::new(PI + 0.8, PI)),
    ];
    let bump = |x: &Vector2<f64>, c: &Vector2<f64>| (-(x - c).norm_squared() / 0.5).exp();
    let x: Vec<Vector2<f64>> = (0..count)
        .map(|a| {
            Vector2::new((a / along) as f64 + 0.5, (a % along) as f64 + 0.5)
                * (length / along as f64)
        })
        .collect();
    let depth = |x: &Vector2<f64>| 1.0 + centres.iter().map(|(s, c)| s * bump(x, c)).sum::<f64>();
    let m: Vec<f64> = x
        .iter()
        .map(|x| length * length / count as f64 * depth(x))
        .collect();
    // Geostrophic balance: f V is the rotated depth gradient times the square of the wave speed.
    let momentum = x.iter().zip(&m).map(|(x, m)| {
        let slope = centres.iter().fold(Vector2::zeros(), |g, (s, c)| {
            g - (x - c) * (4.0 * s * bump(x, c))
        });
        let velocity = Vector2::new(-slope[1], slope[0]) * (TAU * TAU / f);
        (velocity + Vector2::new(-x[1], x[0]) * (f / 2.0)) * *m
    });
    let initial = ParticleMesh2DInitial {
        X: x.clone(),
        momentum_X: momentum.collect(),
    };
    let at_wall = |i: usize| i == 0 || i == cells;
    let weight = |i: usize| dy * if at_wall(i) { dx / 2.0 } else { dx };
    let parameters = ParticleMesh2DParameters {
        m,
        w: (0..=cells)
            .flat_map(|i| (0..rows).map(move |_| weight(i)))
            .collect(),
        c0: TAU,
        f,
        alpha: 2.0 * dx,
    };
    let sites = ParticleMesh2DSites {
        N: count,
        n: [cells, rows],
        domain: Domain::channel([length, length]),
        scalar: Default::default(),
    };
    let model = ParticleMesh2D::new(parameters, sites).expect("a channel");
    let (mut state, mut work) = model.start(initial, dt).expect("starts");
    let first = model.energy(&state);
    let (kinetic, _) = model.energies(&state);
    let mut worst = 0.0_f64;
    for k in 0..(3.0 / dt) as usize {
        model.step(&mut state, &mut work).expect("steps");
        // Samples at the same times for any step size.
        if (k + 1) % (0.1 / dt).round() as usize == 0 {
            worst = worst.max((model.energy(&state) - first).abs());
        }
    }
    (worst / first, worst / kinetic)
}

#[test]
fn vortices_in_a_rotating_channel_keep_their_energy_to_second_order() {
    let (long, of_kinetic) = channel(5e-3);
    let (short, _) = channel(2.5e-3);
    assert!(long < 3e-8 && of_kinetic < 3e-5, "{long:e} {of_kinetic:e}");
    let order = (long / short).log2();
    assert!((order - 2.0).abs() < 0.15, "{order}");
}

/// Without topography, only rotation acts on the total: the sum of the kinetic momenta rotates by 2 atan(f dt/2) per step.
#[test]
fn the_total_kinetic_momentum_turns_by_the_angle_of_a_centred_rotation() {
    let (side, f, dt) = (12, 3.0, 0.02);
    let count = side * side;
    let jitter = Jitter { size: 0.3, seed: 2 };
    let x = placement::lattice(&Domain::torus([1.0, 1.0]), [side, side], true, jitter);
    let m: Vec<f64> = (0..count)
        .map(|a| (1.0 + 0.3 * (a as f64).sin()) / count as f64)
        .collect();
    let perp = |x: &Vector2<f64>| Vector2::new(-x[1], x[0]);
    let velocity = |a: usize| Vector2::new(0.3 + 0.1 * (3.0 * a as f64).sin(), 0.1);
    let momentum = x.iter().zip(&m).enumerate();
    let momentum = momentum.map(|(a, (x, m))| (velocity(a) + perp(x) * (f / 2.0)) * *m);
    let initial = ShallowWater2DRegularisedInitial {
        X: x.clone(),
        momentum_X: momentum.collect(),
    };
    let parameters = ShallowWater2DRegularisedParameters {
        m: m.clone(),
        g: 1.0,
        f,
        alpha: 2.0 / side as f64,
        rc: 0.7 / side as f64,
        kappa: 0.1,
    };
    let sites = ShallowWater2DRegularisedSites {
        N: count,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let model = ShallowWater2DRegularised::new(parameters, sites).expect("a torus");
    let (mut state, mut work) = model.start(initial, dt).expect("starts");
    let total = |s: &ShallowWater2DRegularisedState| -> Vector2<f64> {
        let each = s.X().iter().zip(s.momentum_X()).zip(&m);
        each.map(|((x, p), m)| p - perp(x) * (m * f / 2.0)).sum()
    };
    let first = total(&state);
    let steps = 200;
    for _ in 0..steps {
        model.step(&mut state, &mut work).expect("steps");
    }
    let (sin, cos) = (f64::from(steps) * 2.0 * (f * dt / 2.0).atan()).sin_cos();
    let turned = Vector2::new(
        cos * first[0] + sin * first[1],
        cos * first[1] - sin * first[0],
    );
    // Rounding of 144 momenta over 200 steps; the terms have the size of the momentum of the rotating frame.
    let off = (total(&state) - turned).norm() / first.norm();
    assert!(off < 1e-12, "{off:e}");
}
