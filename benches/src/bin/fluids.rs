//! Emitted steppers of fluids against hand-written steps with the same functionals. Compares the code between the functionals, and
//! the time per particle and step, as CPU time of one thread.
//!
//! `cargo run --release --manifest-path benches/Cargo.toml --bin fluids`

use clebsch::mesh::{
    Domain, Functional, Setting, deposit, helmholtz_depth, pair_core, smooth, voronoi_area,
};
use clebsch::nalgebra::Vector2;
use clebsch_benches::blocks::computed;
use clebsch_models::fluids::{
    particle_mesh_2d::*, shallow_water_2d::*, shallow_water_2d_regularised::*,
};

type Place = Vector2<f64>;

/// Particles along each direction.
const SIZES: [usize; 2] = [64, 128];
const STEPS: usize = 20;
const BLOCKS: usize = 7;
const F: f64 = 0.5;

fn main() {
    println!("| step | particles | emitted, ns per particle | by hand | ratio |");
    println!("|---|---|---|---|---|");
    for n in SIZES {
        row("cells", n, &mut emitted_cells(n), &mut cells(n, false));
        row(
            "cells, smoothed, with a core",
            n,
            &mut emitted_smoothed(n),
            &mut cells(n, true),
        );
        row("particle mesh", n, &mut emitted_grid(n), &mut grid(n));
    }
}

fn row(name: &str, n: usize, one: &mut dyn FnMut(), other: &mut dyn FnMut()) {
    let time = |work: &mut dyn FnMut()| {
        let begin = computed();
        (0..STEPS).for_each(|_| work());
        (computed() - begin) / (STEPS * n * n) as f64
    };
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for _ in 0..BLOCKS {
        a.push(time(one));
        b.push(time(other));
    }
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let (one, other) = (a[BLOCKS / 2], b[BLOCKS / 2]);
    println!(
        "| {name} | {} | {one:.1} | {other:.1} | {:.3} |",
        n * n,
        one / other
    );
}

/// A jittered lattice on the unit torus, equal masses, a shear.
fn start(n: usize) -> (Vec<Place>, Vec<f64>, Vec<Place>) {
    let mut seed = 1_u64;
    let mut drawn = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    let dx = 1.0 / n as f64;
    let mut x = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let offset = 0.25 + 0.5 * (j % 2) as f64;
            let at =
                Place::new(i as f64 + offset, j as f64 + 0.5) + Place::new(drawn(), drawn()) * 0.1;
            x.push(at * dx);
        }
    }
    let m = vec![1.0 / (n * n) as f64; n * n];
    let velocity = |x: &Place| Place::new(0.1 * (std::f64::consts::TAU * x[1]).sin(), 0.0);
    let p = x
        .iter()
        .zip(&m)
        .map(|(x, m)| (velocity(x) + Place::new(-x[1], x[0]) * (F / 2.0)) * *m)
        .collect();
    (x, m, p)
}

fn step_of(n: usize) -> f64 {
    0.1 / n as f64
}

fn emitted_cells(n: usize) -> impl FnMut() {
    let (x, m, p) = start(n);
    let sites = ShallowWater2DSites {
        N: n * n,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let model =
        ShallowWater2D::new(ShallowWater2DParameters { m, g: 1.0, f: F }, sites).expect("cells");
    let initial = ShallowWater2DInitial {
        X: x,
        momentum_X: p,
    };
    let (mut state, mut work) = model.start(initial, step_of(n)).expect("starts");
    move || model.step(&mut state, &mut work).expect("steps")
}

fn emitted_smoothed(n: usize) -> impl FnMut() {
    let (x, m, p) = start(n);
    let dx = 1.0 / n as f64;
    let sites = ShallowWater2DRegularisedSites {
        N: n * n,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let parameters = ShallowWater2DRegularisedParameters {
        m,
        g: 1.0,
        f: F,
        alpha: 2.0 * dx,
        rc: 0.7 * dx,
        kappa: 0.1,
    };
    let model = ShallowWater2DRegularised::new(parameters, sites).expect("cells");
    let initial = ShallowWater2DRegularisedInitial {
        X: x,
        momentum_X: p,
    };
    let (mut state, mut work) = model.start(initial, step_of(n)).expect("starts");
    move || model.step(&mut state, &mut work).expect("steps")
}

fn emitted_grid(n: usize) -> impl FnMut() {
    let (x, m, p) = start(n);
    let cells = n / 2;
    let dx = 1.0 / cells as f64;
    let sites = ParticleMesh2DSites {
        N: n * n,
        n: [cells, cells],
        domain: Domain::torus([1.0, 1.0]),
        scalar: Default::default(),
    };
    let parameters = ParticleMesh2DParameters {
        m,
        w: vec![dx * dx; cells * cells],
        c0: 1.0,
        f: F,
        alpha: 2.0 * dx,
    };
    let model = ParticleMesh2D::new(parameters, sites).expect("a grid");
    let initial = ParticleMesh2DInitial {
        X: x,
        momentum_X: p,
    };
    let (mut state, mut work) = model.start(initial, step_of(n)).expect("starts");
    move || model.step(&mut state, &mut work).expect("steps")
}

/// The drift on a rotating plane: the momentum at the start of the edge is `m (V + f/2 perp(X)) + ...`, centred.
struct Drift {
    turn: f64,
    dt: f64,
}

impl Drift {
    fn new(dt: f64) -> Self {
        let turn = F * dt / 2.0;
        Self { turn, dt }
    }

    /// Moves a particle and returns its momentum at the end of the edge.
    fn go(&self, x: &mut Place, p: &Place, m: f64) -> Place {
        let known = (p / m - Place::new(-x[1], x[0]) * (F / 2.0)) * self.dt;
        // (1 + turn perp) d = known.
        let t = self.turn;
        let d = Place::new(known[0] + t * known[1], known[1] - t * known[0]) / (1.0 + t * t);
        *x += d;
        p + Place::new(d[1], -d[0]) * (m * F / 2.0)
    }
}

/// Hand-written step: drift of all particles, functionals and their transposed derivatives, kick of all particles.
fn cells(n: usize, smoothed: bool) -> impl FnMut() {
    let (mut x, m, mut p) = start(n);
    let dx = 1.0 / n as f64;
    let dt = step_of(n);
    let setting = Setting {
        domain: Domain::torus([1.0, 1.0]),
        grid: None,
        particles: n * n,
    };
    let mut area = <voronoi_area<f64> as Functional<f64, 2>>::new(&setting, ()).expect("areas");
    let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, 2.0 * dx)).expect("a depth");
    let mut core = pair_core::<f64>::new(&setting, (&m, 0.7 * dx, 0.1)).expect("a core");
    let (mut value, mut seed) = (vec![0.0; n * n], vec![0.0; n * n]);
    let (mut push, mut more) = (vec![Place::zeros(); n * n], vec![Place::zeros(); n * n]);
    let drift = Drift::new(dt);
    move || {
        for ((x, p), m) in x.iter_mut().zip(&mut p).zip(&m) {
            *p = drift.go(x, p, *m);
        }
        if smoothed {
            depth.value(&x, &mut value).expect("a depth");
            for (seed, m) in seed.iter_mut().zip(&m) {
                *seed = dt * m / 2.0;
            }
            depth
                .pull_back(&x, &seed, &mut push)
                .expect("its derivative");
            core.value(&x, &mut value).expect("a core");
            seed.fill(dt);
            core.pull_back(&x, &seed, &mut more)
                .expect("its derivative");
            for ((p, a), b) in p.iter_mut().zip(&push).zip(&more) {
                *p -= a + b;
            }
        } else {
            area.value(&x, &mut value).expect("areas");
            for ((seed, a), m) in seed.iter_mut().zip(&value).zip(&m) {
                *seed = dt * m * m / (2.0 * a * a);
            }
            area.pull_back(&x, &seed, &mut push)
                .expect("its derivative");
            for (p, a) in p.iter_mut().zip(&push) {
                *p += a;
            }
        }
    }
}

/// The same on a grid with a self-adjoint smoother.
fn grid(n: usize) -> impl FnMut() {
    let (mut x, m, mut p) = start(n);
    let cells = n / 2;
    let dx = 1.0 / cells as f64;
    let dt = step_of(n);
    let setting = Setting {
        domain: Domain::torus([1.0, 1.0]),
        grid: Some([cells, cells]),
        particles: n * n,
    };
    let mut depth = <deposit<f64, 2> as Functional<f64, 2>>::new(&setting, (&m,)).expect("a depth");
    let mut smoother =
        <smooth<f64, 2> as Functional<f64, 2>>::new(&setting, (2.0 * dx,)).expect("a smoother");
    let nodes = cells * cells;
    let (mut h, mut s, mut seed) = (vec![0.0; nodes], vec![0.0; nodes], vec![0.0; nodes]);
    let mut push = vec![Place::zeros(); n * n];
    let drift = Drift::new(dt);
    move || {
        for ((x, p), m) in x.iter_mut().zip(&mut p).zip(&m) {
            *p = drift.go(x, p, *m);
        }
        depth.value(&x, &mut h).expect("a depth");
        smoother.value(&h, &mut s).expect("smooth");
        for (seed, s) in seed.iter_mut().zip(&s) {
            *seed = dt * dx * dx * s;
        }
        depth
            .pull_back(&x, &seed, &mut push)
            .expect("its derivative");
        for (p, a) in p.iter_mut().zip(&push) {
            *p -= a;
        }
    }
}
