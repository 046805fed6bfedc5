//! Time per particle and step of particle-mesh shallow water in a channel with four particles per cell: depth, smoothing and forces
//! by the runtime's functionals, against a plain loop over particles. Takes no arguments; prints a table.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin particle_mesh`, a minute.

use clebsch::mesh::{Domain, Functional, Nodes, Setting, deposit, smooth};
use clebsch::nalgebra::SVector;
use clebsch_benches::blocks::computed;
use clebsch_models::fluids::particle_mesh_2d::*;
use std::hint::black_box;
use std::time::Instant;

type Place = SVector<f64, 2>;

/// Particles times steps per block.
const WORK: usize = 2_000_000;

/// Interleaved blocks for each implementation.
const BLOCKS: usize = 7;

fn main() {
    println!(
        "nanoseconds of computing time per particle and step, medians of {BLOCKS} interleaved blocks for each stepper;"
    );
    println!("the plain loop leaves smoothing to the same functional\n");
    println!("| grid | particles | runtime | depth | smoothing | forces | plain loop | ratio |");
    println!("|---|---|---|---|---|---|---|---|");
    for n in [64, 128, 256, 512] {
        for sorted in [true, false] {
            let mut water = Water::new(n, sorted);
            let mut plain = Plain::new(n, sorted);
            let mut times = [const { Vec::new() }; 4];
            for _ in 0..BLOCKS {
                let parts = water.steps((WORK / water.x.len()).max(1));
                (0..3).for_each(|i| times[i].push(parts[i]));
                times[3].push(plain.steps((WORK / plain.x.len()).max(1)));
            }
            let [depth, smoothing, forces, by_hand] = times.map(|mut t| {
                t.sort_by(f64::total_cmp);
                t[BLOCKS / 2]
            });
            let whole = depth + smoothing + forces;
            let order = if sorted {
                "in order"
            } else {
                "in random order"
            };
            println!(
                "| {n} x {n} | {order} | {whole:.1} | {depth:.1} | {smoothing:.1} | {forces:.1} | {by_hand:.1} | {:.2} |",
                whole / by_hand
            );
        }
    }
    two_threads();
}

/// The emitted stepper of a channel with 512 x 512 cells on one and on two threads, in alternating steps. Checks for equal bits,
/// and prints the ratio of wall times, which needs two idle cores.
fn two_threads() {
    let n = 512;
    let setting = setting(n);
    let x = places(n, true);
    let mass = 1.0 / x.len() as f64;
    let begun = |threads| {
        let parameters = ParticleMesh2DParameters {
            m: vec![mass; x.len()],
            w: Nodes::new(&setting).expect("a grid").weights(),
            c0: 1.0,
            f: 1.0,
            alpha: 2.0 / n as f64,
        };
        let sites = ParticleMesh2DSites {
            N: x.len(),
            n: [n, n],
            domain: setting.domain,
            scalar: Default::default(),
        };
        let model = ParticleMesh2D::new(parameters, sites).expect("a channel");
        let model = model.with_threads(threads);
        let momentum = |x: &Place| (Place::new(-x[1], x[0]) * 0.5 + Place::new(0.1, 0.2)) * mass;
        let initial = ParticleMesh2DInitial {
            X: x.clone(),
            momentum_X: x.iter().map(momentum).collect(),
        };
        let (state, work) = model.start(initial, 2e-4).expect("starts");
        (model, state, work)
    };
    let mut both = [1, 2].map(begun);
    let mut times = [const { Vec::new() }; 2];
    for _ in 0..30 {
        for ((model, state, work), times) in both.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            model.step(state, work).expect("steps");
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    let [(_, one, _), (_, two, _)] = &both;
    assert!(one.X() == two.X() && one.momentum_X() == two.momentum_X());
    let [one, two] = times.map(|mut t| {
        t.sort_by(f64::total_cmp);
        t[t.len() / 2]
    });
    println!(
        "\n512 x 512: a step on two threads takes {:.3} of the time on one, {:.1} ns per particle",
        two / one,
        one * 1e9 / x.len() as f64
    );
}

/// Particles near the nodes of a grid, in grid order or in random order.
fn places(n: usize, sorted: bool) -> Vec<Place> {
    let side = 2 * n;
    let mut seed = 1_u64;
    let mut number = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut all: Vec<_> = (0..side * side)
        .map(|a| {
            let along = [(a / side) as f64, (a % side) as f64];
            Place::from(along.map(|i| (i + number()) / side as f64))
        })
        .collect();
    if !sorted {
        for i in (1..all.len()).rev() {
            all.swap(i, (number() * i as f64) as usize);
        }
    }
    all
}

/// The implementation with functionals.
struct Water {
    deposit: deposit<f64, 2>,
    smooth: smooth<f64, 2>,
    x: Vec<Place>,
    u: Vec<Place>,
    forces: Vec<Place>,
    weights: Vec<f64>,
    depth: Vec<f64>,
    smoothed: Vec<f64>,
}

impl Water {
    fn new(n: usize, sorted: bool) -> Self {
        let x = places(n, sorted);
        let setting = setting(n);
        let mass = vec![1.0 / x.len() as f64; x.len()];
        let weights = Nodes::new(&setting).expect("a grid").weights();
        Self {
            deposit: deposit::new(&setting, (&mass,)).expect("a grid"),
            smooth: smooth::new(&setting, (2.0 / n as f64,)).expect("a grid"),
            u: vec![Place::zeros(); x.len()],
            forces: vec![Place::zeros(); x.len()],
            x,
            depth: vec![0.0; weights.len()],
            smoothed: vec![0.0; weights.len()],
            weights,
        }
    }

    /// Nanoseconds per particle and step of depth, smoothing and forces.
    fn steps(&mut self, steps: usize) -> [f64; 3] {
        let mut times = [0.0; 3];
        for _ in 0..steps {
            let begin = computed();
            self.deposit
                .value(&self.x, &mut self.depth)
                .expect("inside");
            times[0] += computed() - begin;
            let begin = computed();
            self.smooth
                .value(&self.depth, &mut self.smoothed)
                .expect("solved");
            times[1] += computed() - begin;
            let begin = computed();
            let seed = self.smoothed.iter_mut().zip(&self.weights);
            seed.for_each(|(s, w)| *s *= *w);
            let (x, seed) = (&self.x, &self.smoothed);
            self.deposit
                .pull_back(x, seed, &mut self.forces)
                .expect("inside");
            times[2] += computed() - begin;
            push(&mut self.x, &mut self.u, &self.forces);
        }
        times.map(|t| t / (steps * self.x.len()) as f64)
    }
}

fn setting(n: usize) -> Setting<2> {
    Setting {
        domain: Domain::channel([1.0, 1.0]),
        grid: Some([n, n]),
        particles: 4 * n * n,
    }
}

/// Moves particles a little.
fn push(x: &mut [Place], u: &mut [Place], forces: &[Place]) {
    for ((x, u), f) in x.iter_mut().zip(u).zip(forces) {
        *u -= f * 1e-6;
        *x += *u * 1e-6;
    }
}

/// The implementation with a plain loop over particles in the order of their numbers.
struct Plain {
    n: usize,
    smooth: smooth<f64, 2>,
    x: Vec<Place>,
    u: Vec<Place>,
    forces: Vec<Place>,
    mass: Vec<f64>,
    padded: Vec<f64>,
    depth: Vec<f64>,
    smoothed: Vec<f64>,
}

fn values(f: f64) -> [f64; 4] {
    let g = 1.0 - f;
    [
        g * g * g / 6.0,
        2.0 / 3.0 - f * f * (1.0 - 0.5 * f),
        2.0 / 3.0 - g * g * (1.0 - 0.5 * g),
        f * f * f / 6.0,
    ]
}

fn slopes(f: f64) -> [f64; 4] {
    let g = 1.0 - f;
    [
        -0.5 * g * g,
        f * (1.5 * f - 2.0),
        g * (2.0 - 1.5 * g),
        0.5 * f * f,
    ]
}

impl Plain {
    fn new(n: usize, sorted: bool) -> Self {
        let x = places(n, sorted);
        Self {
            n,
            smooth: smooth::new(&setting(n), (2.0 / n as f64,)).expect("a grid"),
            u: vec![Place::zeros(); x.len()],
            forces: vec![Place::zeros(); x.len()],
            mass: vec![1.0 / x.len() as f64; x.len()],
            x,
            padded: vec![0.0; (n + 3) * (n + 3)],
            depth: vec![0.0; (n + 1) * n],
            smoothed: vec![0.0; (n + 1) * n],
        }
    }

    /// Nanoseconds per particle and step, without the push.
    fn steps(&mut self, steps: usize) -> f64 {
        let mut time = 0.0;
        for _ in 0..steps {
            let begin = computed();
            self.deposit();
            self.smooth
                .value(&self.depth, &mut self.smoothed)
                .expect("solved");
            self.gather();
            time += computed() - begin;
            push(&mut self.x, &mut self.u, &self.forces);
        }
        black_box(&self.forces);
        time / (steps * self.x.len()) as f64
    }

    /// The cell, and the position within it.
    #[inline(always)]
    fn locate(&self, x: &Place) -> ([usize; 2], [f64; 2]) {
        let (along, across) = (x[0].abs(), x[1]);
        let across = if (0.0..1.0).contains(&across) {
            across
        } else {
            across.rem_euclid(1.0)
        };
        let (along, across) = (along * self.n as f64, across * self.n as f64);
        let (i, j) = (along as u32, across as u32);
        let fraction = [along - f64::from(i), across - f64::from(j)];
        ([i as usize, j as usize], fraction)
    }

    fn deposit(&mut self) {
        let (n, width) = (self.n, self.n + 3);
        self.padded.fill(0.0);
        for a in 0..self.x.len() {
            let (x, m) = (&self.x[a], self.mass[a]);
            let (cell, fraction) = self.locate(x);
            let (one, other) = (values(fraction[0]), values(fraction[1]));
            for (i, one) in one.iter().enumerate() {
                let from = (cell[0] + i) * width + cell[1];
                let row = &mut self.padded[from..from + 4];
                for (place, other) in row.iter_mut().zip(other) {
                    *place += m * one * other;
                }
            }
        }
        for j in 0..width {
            let (first, last) = (self.padded[j], self.padded[(n + 2) * width + j]);
            self.padded[2 * width + j] += first;
            self.padded[n * width + j] += last;
        }
        for i in 0..=n {
            let row = &mut self.padded[(i + 1) * width..(i + 2) * width];
            row[n] += row[0];
            row[1] += row[n + 1];
            row[2] += row[n + 2];
            let scale = (n * n) as f64 * if i == 0 || i == n { 2.0 } else { 1.0 };
            for j in 0..n {
                self.depth[i * n + j] = scale * row[j + 1];
            }
        }
    }

    fn gather(&mut self) {
        let (n, width) = (self.n, self.n + 3);
        for i in 0..=n {
            let row = &mut self.padded[(i + 1) * width..(i + 2) * width];
            row[1..=n].copy_from_slice(&self.smoothed[i * n..(i + 1) * n]);
            row[0] = row[n];
            row[n + 1] = row[1];
            row[n + 2] = row[2];
        }
        self.padded.copy_within(2 * width..3 * width, 0);
        self.padded
            .copy_within(n * width..(n + 1) * width, (n + 2) * width);
        for a in 0..self.x.len() {
            let (x, m) = (&self.x[a], self.mass[a]);
            let (cell, fraction) = self.locate(x);
            let (one, other) = (values(fraction[0]), values(fraction[1]));
            let (one_slope, other_slope) = (slopes(fraction[0]), slopes(fraction[1]));
            let mut sum = [0.0; 2];
            for i in 0..4 {
                let from = (cell[0] + i) * width + cell[1];
                let row = &self.padded[from..from + 4];
                for j in 0..4 {
                    sum[0] += one_slope[i] * other[j] * row[j];
                    sum[1] += one[i] * other_slope[j] * row[j];
                }
            }
            self.forces[a] = Place::new(sum[0] * m * n as f64, sum[1] * m * n as f64);
        }
    }
}
