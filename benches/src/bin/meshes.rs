//! Time per particle and step of moving Voronoi meshes: update by flips or reconstruction, areas with derivatives, smoothed depths,
//! cores. The particles move like a fluid layer, in vortices with a tenth of the wave speed. Takes the numbers of particles, or
//! none for 1e4, 1e5 and 1e6; prints a table. `cargo run --release --manifest-path benches/Cargo.toml --bin meshes`, two minutes.

use clebsch::mesh::placement::{Jitter, lattice, relax};
use clebsch::mesh::{
    Domain, Functional, Setting, Voronoi, helmholtz_depth, pair_core, voronoi_area,
};
use clebsch::nalgebra::SVector;
use clebsch_benches::blocks::computed;

type Plane = SVector<f64, 2>;

/// Steps before the measurement, and measured steps.
const BEFORE: usize = 10;
const STEPS: usize = 20;

fn main() {
    println!("{}", env!("RUSTC_VERSION"));
    println!("nanoseconds of computing time per particle and step, means of {STEPS} steps\n");
    println!(
        "| particles | areas: anew | followed | derivative | flips | depth | derivative | products | core | derivative |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let given: Vec<usize> = std::env::args()
        .skip(1)
        .filter_map(|n| n.parse().ok())
        .collect();
    let sizes = if given.is_empty() {
        vec![10_000, 100_000, 1_000_000]
    } else {
        given
    };
    for size in sizes {
        let rows = (size as f64).sqrt().round() as usize;
        if let Err(error) = measure(rows) {
            println!("| {size} | {error} |");
        }
    }
}

/// Times of each part of a step.
#[derive(Default)]
struct Times([f64; 7]);

impl Times {
    fn add<R>(&mut self, which: usize, work: impl FnOnce() -> R) -> R {
        let begin = computed();
        let result = work();
        self.0[which] += computed() - begin;
        result
    }
}

fn measure(n: usize) -> Result<(), Box<dyn std::error::Error>> {
    let count = n * n;
    let domain = Domain::torus([1.0, 1.0]);
    let setting = Setting {
        domain,
        grid: None,
        particles: count,
    };
    let mut at = lattice(&domain, [n, n], true, Jitter { size: 0.3, seed: 1 });
    relax(&mut Voronoi::new(&domain, count)?, &mut at, 5)?;
    let spacing = 1.0 / n as f64;
    let m = vec![spacing * spacing; count];
    let mut area = voronoi_area::<f64>::new(&setting, ())?;
    let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, 2.0 * spacing))?;
    let mut core = pair_core::<f64>::new(&setting, (&m, 0.7 * spacing, 0.1))?;
    let k = std::f64::consts::TAU;
    let mut velocity: Vec<Plane> = at
        .iter()
        .map(|x| {
            let (sx, cx) = (k * x[0]).sin_cos();
            let (sy, cy) = (k * x[1]).sin_cos();
            Plane::new(0.1 * sx * cy, -0.1 * cx * sy)
        })
        .collect();
    let seed: Vec<f64> = m.iter().map(|m| 0.5 * m).collect();
    let ones = vec![1.0; count];
    let mut values = vec![0.0; count];
    let [mut force, mut push, mut unused] = [0; 3].map(|_| vec![Plane::zeros(); count]);
    let mut times = Times::default();
    let (mut products, mut flips) = (0, 0);
    let dt = 0.2 * spacing;
    for step in 0..BEFORE + STEPS {
        if step == BEFORE {
            times = Times::default();
            products = 0;
            flips = area.mesh().counted().flips;
        }
        times.add(0, || area.value(&at, &mut values))?;
        times.add(1, || area.pull_back(&at, &seed, &mut unused))?;
        times.add(2, || depth.value(&at, &mut values))?;
        times.add(3, || depth.pull_back(&at, &seed, &mut force))?;
        times.add(4, || core.value(&at, &mut values))?;
        times.add(5, || core.pull_back(&at, &ones, &mut push))?;
        products += depth.products().0;
        for a in 0..count {
            velocity[a] -= (force[a] + push[a]) * (dt / m[a]);
            at[a] += velocity[a] * dt;
        }
    }
    let anew = {
        let mut area = voronoi_area::<f64>::new(&setting, ())?;
        let mut once = Times::default();
        once.add(0, || area.value(&at, &mut values))?;
        once.0[0] / count as f64
    };
    let counted = area.mesh().counted();
    let each = |which: usize| times.0[which] / (STEPS * count) as f64;
    println!(
        "| {count} | {anew:.0} | {:.0} | {:.0} | {:.4} | {:.0} | {:.0} | {:.1} | {:.0} | {:.0} |",
        each(0),
        each(1),
        (counted.flips - flips) as f64 / (STEPS * count) as f64,
        each(2),
        each(3),
        products as f64 / STEPS as f64,
        each(4),
        each(5),
    );
    if counted.rebuilds > 1 {
        println!("| | made anew {} times |", counted.rebuilds - 1);
    }
    Ok(())
}
