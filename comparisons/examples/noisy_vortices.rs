//! Measures how much of the decay of ordered motion in particle fluids is physical. Solves the Taylor-Green vortices of the example
//! `thermalisation` with a pseudospectral method, from the same noisy fields as the particles. Masses and momenta of the Voronoi
//! cells are distributed over the boxes of a grid. Takes the numbers of particles along a side and the number of seeds; prints a
//! table of the fraction of kinetic energy that remains in the initial profile after one turnover.
//!
//! `cargo run --release -p clebsch-comparisons --example noisy_vortices -- 24 32 48 --seeds 5`, some minutes

use clebsch::mesh::{Domain, Voronoi, helmholtz_depth, helmholtz_twice, placement};
use clebsch::nalgebra::Vector2;
use clebsch_comparisons::shallow_water::{Fields, Smoothing, Spectral};
use std::f64::consts::TAU;

type Place = Vector2<f64>;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |text: &String| text.parse::<usize>().ok();
    let split = arguments.iter().position(|a| a == "--seeds");
    let (sides, seeds) = arguments.split_at(split.unwrap_or(arguments.len()));
    let mut sides: Vec<usize> = sides.iter().filter_map(number).collect();
    if sides.is_empty() {
        sides = vec![24, 32, 48];
    }
    let seeds = seeds.get(1).and_then(number).unwrap_or(5) as u64;
    println!(
        "| side | depth | grid | noise | kept, median | kept, least | energy, most | smooth |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for side in sides {
        for depth in [Depth::Area, Depth::Once, Depth::Twice] {
            row(side, depth, seeds);
        }
    }
}

/// The depth of particles: from the area of the Voronoi cell, or smoothed over two mean particle distances.
#[derive(Clone, Copy, Debug)]
enum Depth {
    Area,
    Once,
    Twice,
}

impl Depth {
    /// The smoothing length of the equations for particles at this mean distance, and the kind of smoothing.
    fn smoothing(self, spacing: f64) -> (f64, Smoothing) {
        match self {
            Self::Area => (0.0, Smoothing::Isotropic),
            Self::Once => (2.0 * spacing, Smoothing::Isotropic),
            Self::Twice => (2.0 * spacing, Smoothing::Twice),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Area => "voronoi_area",
            Self::Once => "helmholtz_depth, 2 dx",
            Self::Twice => "helmholtz_twice, 2 dx",
        }
    }
}

fn velocity(at: Place) -> Place {
    let (sx, cx) = (TAU * at[0]).sin_cos();
    let (sy, cy) = (TAU * at[1]).sin_cos();
    Place::new(0.1 * sx * cy, -0.1 * cx * sy)
}

/// The depth that balances `velocity` on a plane with f = 2π, in units of the mean depth and the wave speed. `factor` multiplies
/// each wave, as a function of its squared wave number.
fn depth(at: Place, factor: impl Fn(f64) -> f64) -> f64 {
    let [x, y] = [TAU * at[0], TAU * at[1]];
    let twice = ((2.0 * x).cos() + (2.0 * y).cos()) * factor(4.0 * TAU * TAU);
    1.0 + 0.0025 * twice - 0.1 * x.sin() * y.sin() * factor(2.0 * TAU * TAU)
}

/// Depth and velocity in the boxes of a grid, from the masses and momenta of the Voronoi cells of randomly placed particles.
fn noisy(side: usize, boxes: usize, of: Depth, seed: u64) -> Fields {
    let domain = Domain::torus([1.0, 1.0]);
    let count = side * side;
    let at: Vec<Place> = placement::scattered(&domain, count, 100, seed).expect("places");
    let mut mesh = Voronoi::new(&domain, count).expect("a torus");
    mesh.update(&at).expect("a mesh");
    let wanted: Vec<f64> = at.iter().map(|x| depth(*x, |_| 1.0)).collect();
    let (alpha, _) = of.smoothing(1.0 / side as f64);
    let masses = match of {
        Depth::Area => {
            let mut areas = vec![0.0; count];
            mesh.areas(&mut areas).expect("areas");
            areas.iter().zip(&wanted).map(|(a, h)| a * h).collect()
        }
        Depth::Once => helmholtz_depth::masses(&mut mesh, &at, alpha, &wanted).expect("masses"),
        Depth::Twice => helmholtz_twice::masses(&mut mesh, &at, alpha, &wanted).expect("masses"),
    };
    let on_grid = |of: &dyn Fn(Place) -> f64| {
        let each: Vec<f64> = masses.iter().zip(&at).map(|(m, x)| m * of(*x)).collect();
        let mut out = vec![0.0; boxes * boxes];
        mesh.rezone(&each, [boxes; 2], &mut out).expect("a grid");
        // In `rezone`, x is contiguous; here y is.
        let turned = |k: usize| out[k % boxes * boxes + k / boxes];
        (0..boxes * boxes).map(turned).collect::<Vec<f64>>()
    };
    let mass = on_grid(&|_| 1.0);
    let mean = |momentum: Vec<f64>| momentum.iter().zip(&mass).map(|(p, m)| p / m).collect();
    Fields {
        u: mean(on_grid(&|x| velocity(x)[0])),
        v: mean(on_grid(&|x| velocity(x)[1])),
        h: mass.iter().map(|m| m * (boxes * boxes) as f64).collect(),
    }
}

/// The same fields without particles: a depth whose smoothed value balances the velocity.
fn smooth(boxes: usize, spectral: &Spectral, (alpha, smoothing): (f64, Smoothing)) -> Fields {
    let half = Place::repeat(0.5 / boxes as f64);
    spectral.fields(|x| {
        let x = Place::from(x) + half;
        let times = if smoothing == Smoothing::Twice { 2 } else { 1 };
        let factor = |square: f64| (1.0 + alpha * alpha * square).powi(times);
        [depth(x, factor), velocity(x)[0], velocity(x)[1]]
    })
}

/// The results of a run.
#[derive(Clone, Copy)]
struct Left {
    /// Fraction of the kinetic energy that remains in the initial profile.
    kept: f64,
    /// Change of the energy, relative to the kinetic energy.
    energy: f64,
    /// Fraction of the initial kinetic energy outside the initial profile.
    noise: f64,
}

fn run(boxes: usize, spectral: &mut Spectral, mut now: Fields) -> Left {
    spectral.truncate(&mut now);
    let profile = smooth(boxes, spectral, (0.0, Smoothing::Isotropic));
    let along = |of: &Fields| -> f64 {
        let each =
            (0..of.h.len()).map(|i| of.h[i] * (of.u[i] * profile.u[i] + of.v[i] * profile.v[i]));
        each.sum::<f64>() / of.h.len() as f64
    };
    let square = (0..now.h.len()).map(|i| now.h[i] * (profile.u[i].powi(2) + profile.v[i].powi(2)));
    let square = square.sum::<f64>() / now.h.len() as f64;
    let (first, [kinetic, potential]) = (along(&now), spectral.energy(&now));
    // A third of the stability limit of the classical Runge-Kutta method, for advected waves.
    let time = 10.0;
    let carried = 0.2 * TAU * boxes as f64 / 3.0;
    let steps = (time * (spectral.fastest_wave() + carried)).ceil() as usize;
    for _ in 0..steps {
        spectral.step(&mut now, time / steps as f64);
    }
    let after: f64 = spectral.energy(&now).iter().sum();
    Left {
        kept: (along(&now) / first).powi(2),
        energy: (after - kinetic - potential).abs() / kinetic,
        noise: 1.0 - first * first / (2.0 * kinetic * square),
    }
}

fn row(side: usize, of: Depth, seeds: u64) {
    // Wave numbers up to a third of the number of boxes are kept. This covers almost all waves that the particles
    // resolve, up to half the number of particles along a side.
    let boxes = (4 * side / 3).next_power_of_two();
    let made = || {
        let smoothing = of.smoothing(1.0 / side as f64);
        Spectral::new([1.0; 2], false, [boxes; 2], smoothing, 1.0, TAU).expect("powers of two")
    };
    let exact = smooth(boxes, &made(), of.smoothing(1.0 / side as f64));
    let starts = (1..=seeds)
        .map(|seed| noisy(side, boxes, of, seed))
        .chain([exact]);
    let mut runs: Vec<Left> = std::thread::scope(|scope| {
        let begun = |start| scope.spawn(move || run(boxes, &mut made(), start));
        let all: Vec<_> = starts.map(begun).collect();
        all.into_iter()
            .map(|run| run.join().expect("ends"))
            .collect()
    });
    let smooth = runs.pop().expect("a run without noise").kept;
    runs.sort_by(|a, b| a.kept.total_cmp(&b.kept));
    if let (Some(middle), Some(least)) = (runs.get(runs.len() / 2), runs.first()) {
        let energy = runs
            .iter()
            .map(|l| l.energy)
            .max_by(f64::total_cmp)
            .unwrap_or(0.0);
        println!(
            "| {side} | {} | {boxes} | {:.1e} | {:.3} | {:.3} | {energy:.1e} | {smooth:.3} |",
            of.name(),
            middle.noise,
            middle.kept,
            least.kept,
        );
    }
}
