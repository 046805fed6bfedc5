//! How long ordered particle motion persists: steady shear and Taylor-Green vortices from random positions, for functionals that
//! smooth the depth and keep particles apart. Takes the numbers of particles along a side and the number of seeds; prints a table
//! of the kinetic energy that remains in the initial profile. The example `noisy_vortices` of `clebsch-comparisons` shows that
//! hardly any of the loss is physical.
//!
//! `cargo run --release -p clebsch --example thermalisation -- 24 32 48 --seeds 5`, some minutes

use clebsch::mesh::{
    Domain, Functional, MeshError, Setting, Voronoi, deposit, helmholtz_depth, helmholtz_twice,
    kernel_depth, pair_core, placement, smooth, voronoi_area,
};
use clebsch::nalgebra::Vector2;
use std::f64::consts::{SQRT_2, TAU};

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
    let seeds = seeds.get(1).and_then(number).unwrap_or(5);
    println!(
        "| flow | side | potential | kept, median | kept, least | nearest, least | energy, most | products |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for flow in [Flow::Shear, Flow::Vortices] {
        for &side in &sides {
            for potential in POTENTIALS {
                row(flow, side, potential, seeds);
            }
        }
    }
}

/// The initial flow.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flow {
    /// `0.1 sin(2 pi y)` along x, without rotation, for five units of time.
    Shear,
    /// Four vortices in balance on a plane with f = 2 pi, for one turnover.
    Vortices,
}

impl Flow {
    fn coriolis(self) -> f64 {
        match self {
            Self::Shear => 0.0,
            Self::Vortices => TAU,
        }
    }

    fn until(self) -> f64 {
        match self {
            Self::Shear => 5.0,
            Self::Vortices => 10.0,
        }
    }

    fn velocity(self, at: &Place) -> Place {
        let (sx, cx) = (TAU * at[0]).sin_cos();
        let (sy, cy) = (TAU * at[1]).sin_cos();
        match self {
            Self::Shear => Place::new(0.1 * sy, 0.0),
            Self::Vortices => Place::new(0.1 * sx * cy, -0.1 * cx * sy),
        }
    }

    /// The depth in balance with the velocity. `factor` multiplies each wave, as a function of its two squared wave numbers.
    fn depth(self, at: &Place, factor: impl Fn(f64, f64) -> f64) -> f64 {
        match self {
            Self::Shear => 1.0,
            Self::Vortices => {
                let [x, y] = [TAU * at[0], TAU * at[1]];
                let twice = ((2.0 * x).cos() + (2.0 * y).cos()) * factor(4.0 * TAU * TAU, 0.0);
                let once = x.sin() * y.sin() * factor(TAU * TAU, TAU * TAU);
                1.0 + 0.0025 * twice - 0.1 * once
            }
        }
    }
}

/// The potential energy. Lengths are in mean particle distances, strengths in squared wave speeds.
#[derive(Clone, Copy, Debug)]
enum Depth {
    Area,
    Once(f64),
    Twice(f64),
    Kernel(f64),
    Grid(f64),
}

#[derive(Clone, Copy, Debug)]
struct Potential {
    name: &'static str,
    depth: Depth,
    core: Core,
}

/// The repulsion of particles, within 0.7 of their mean distance.
#[derive(Clone, Copy, Debug)]
enum Core {
    None,
    /// With this strength.
    Fixed(f64),
    /// Adapted to the shear between neighbours: this multiple of the squared velocity difference over one particle distance.
    Shear(f64),
}

impl Core {
    fn strength(self, spacing: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Fixed(strength) => strength,
            Self::Shear(factor) => factor * (0.1 * TAU * spacing).powi(2),
        }
    }
}

const USUAL: Core = Core::Fixed(0.1);

const POTENTIALS: [Potential; 7] = [
    of("voronoi_area", Depth::Area, Core::Fixed(0.03)),
    of("helmholtz_depth, 2 dx", Depth::Once(2.0), USUAL),
    of(
        "the same, core by shear",
        Depth::Once(2.0),
        Core::Shear(15.0),
    ),
    of("helmholtz_twice, sqrt(2) dx", Depth::Twice(SQRT_2), USUAL),
    of("helmholtz_twice, 2 dx", Depth::Twice(2.0), USUAL),
    of("kernel_depth, 2 dx", Depth::Kernel(2.0), USUAL),
    of("deposit, smooth, 2 dx", Depth::Grid(2.0), Core::None),
];

const fn of(name: &'static str, depth: Depth, core: Core) -> Potential {
    Potential { name, depth, core }
}

/// Adds the derivative of a potential energy at the positions; returns the energy and the number of operator applications.
type Force = Box<dyn FnMut(&[Place], &mut [Place]) -> Result<(f64, usize), MeshError>>;

/// The initial masses of a flow, and the force on them.
fn force(setting: &Setting<2>, at: &[Place], flow: Flow, depth: Depth) -> (Vec<f64>, Force) {
    let count = at.len();
    let spacing = (1.0 / count as f64).sqrt();
    let mut mesh = Voronoi::new(&setting.domain, count).expect("a torus");
    mesh.update(at).expect("a mesh");
    let mut areas = vec![0.0; count];
    mesh.areas(&mut areas).expect("areas");
    let wanted: Vec<f64> = at.iter().map(|x| flow.depth(x, |_, _| 1.0)).collect();
    let mut back = vec![Place::zeros(); count];
    let mut values = vec![0.0; count];
    macro_rules! smoothed {
        ($f:ident, $alpha:expr) => {{
            let alpha = $alpha * spacing;
            let m = $f::masses(&mut mesh, at, alpha, &wanted).expect("masses");
            let mut depth = $f::<f64>::new(setting, (&m, alpha)).expect("a depth");
            let seed: Vec<f64> = m.iter().map(|m| m / 2.0).collect();
            let force = move |at: &[Place], out: &mut [Place]| {
                depth.value(at, &mut values)?;
                depth.pull_back(at, &seed, &mut back)?;
                out.iter_mut().zip(&back).for_each(|(out, b)| *out += b);
                let energy = seed.iter().zip(&values).map(|(s, v)| s * v).sum();
                Ok((energy, depth.products().0))
            };
            (m, Box::new(force) as Force)
        }};
    }
    match depth {
        Depth::Once(alpha) => smoothed!(helmholtz_depth, alpha),
        Depth::Twice(alpha) => smoothed!(helmholtz_twice, alpha),
        Depth::Kernel(alpha) => smoothed!(kernel_depth, alpha),
        Depth::Area => {
            let m: Vec<f64> = areas.iter().zip(&wanted).map(|(a, h)| a * h).collect();
            let mut area = voronoi_area::<f64>::new(setting, ()).expect("areas");
            let (mut seed, masses) = (vec![0.0; count], m.clone());
            let force = move |at: &[Place], out: &mut [Place]| {
                area.value(at, &mut values)?;
                let mut energy = 0.0;
                for ((seed, a), m) in seed.iter_mut().zip(&values).zip(&masses) {
                    energy += m * m / (2.0 * a);
                    *seed = -m * m / (2.0 * a * a);
                }
                area.pull_back(at, &seed, &mut back)?;
                out.iter_mut().zip(&back).for_each(|(out, b)| *out += b);
                Ok((energy, 0))
            };
            (m, Box::new(force))
        }
        Depth::Grid(alpha) => {
            let alpha = alpha * spacing;
            let (one, two) = (alpha * alpha, alpha.powi(4));
            let of = |x: &Place| flow.depth(x, |k, l| 1.0 + one * (k + l) + two * k * l);
            let m: Vec<f64> = areas.iter().zip(at).map(|(a, x)| a * of(x)).collect();
            let cells = (count as f64).sqrt().round() as usize / 2;
            let grid = Setting {
                grid: Some([cells, cells]),
                ..setting.clone()
            };
            let mut depth =
                <deposit<f64, 2> as Functional<f64, 2>>::new(&grid, (&m,)).expect("a grid");
            let mut smoother =
                <smooth<f64, 2> as Functional<f64, 2>>::new(&grid, (alpha,)).expect("a grid");
            let nodes = cells * cells;
            let (mut h, mut s) = (vec![0.0; nodes], vec![0.0; nodes]);
            let force = move |at: &[Place], out: &mut [Place]| {
                depth.value(at, &mut h)?;
                smoother.value(&h, &mut s)?;
                let weight = 1.0 / nodes as f64;
                let energy = h.iter().zip(&s).map(|(h, s)| weight * h * s / 2.0).sum();
                s.iter_mut().for_each(|s| *s *= weight);
                depth.pull_back(at, &s, &mut back)?;
                out.iter_mut().zip(&back).for_each(|(out, b)| *out += b);
                Ok((energy, 0))
            };
            (m, Box::new(force))
        }
    }
}

/// The results of one run.
struct Left {
    /// Fraction of the kinetic energy that remains in the initial profile.
    kept: f64,
    /// The smallest particle distance, in mean distances.
    nearest: f64,
    /// The largest change of the energy, relative to the kinetic energy.
    energy: f64,
    /// Operator applications per step.
    products: f64,
}

fn run(flow: Flow, side: usize, potential: Potential, seed: u64) -> Result<Left, MeshError> {
    let domain = Domain::torus([1.0, 1.0]);
    let count = side * side;
    let spacing = 1.0 / side as f64;
    let mut at = placement::scattered(&domain, count, 100, seed).expect("places");
    let setting = Setting {
        domain,
        grid: None,
        particles: count,
    };
    let (m, mut push) = force(&setting, &at, flow, potential.depth);
    let strength = potential.core.strength(spacing);
    let mut core = pair_core::<f64>::new(&setting, (&m, 0.7 * spacing, strength)).expect("a core");
    let mut mesh = Voronoi::new(&setting.domain, count).expect("a torus");
    let mut velocity: Vec<Place> = at.iter().map(|x| flow.velocity(x)).collect();
    let along = |at: &[Place], velocity: &[Place]| -> f64 {
        let each = at.iter().zip(velocity).zip(&m);
        each.map(|((x, v), m)| m * flow.velocity(x).dot(v)).sum()
    };
    let first = along(&at, &velocity);
    let dt = 0.2 * spacing;
    let steps = (flow.until() / dt).round() as usize;
    let turn = flow.coriolis() * dt / 2.0;
    let ones = vec![1.0; count];
    let (mut near, mut back, mut sum) = (vec![0.0; count], at.clone(), at.clone());
    let mut accelerations =
        |at: &[Place], sum: &mut Vec<Place>| -> Result<(f64, usize), MeshError> {
            sum.fill(Place::zeros());
            let (energy, products) = push(at, sum)?;
            core.value(at, &mut near)?;
            core.pull_back(at, &ones, &mut back)?;
            for ((sum, back), m) in sum.iter_mut().zip(&back).zip(&m) {
                *sum = -(*sum + back) / *m;
            }
            Ok((energy + near.iter().sum::<f64>(), products))
        };
    let kinetic = |velocity: &[Place]| -> f64 {
        let each = velocity.iter().zip(&m);
        each.map(|(v, m)| m * v.norm_squared() / 2.0).sum()
    };
    let (potential, _) = accelerations(&at, &mut sum)?;
    let scale = kinetic(&velocity);
    let begin = scale + potential;
    let mut left = Left {
        kept: 0.0,
        nearest: 1.0,
        energy: 0.0,
        products: 0.0,
    };
    for step in 0..steps {
        for ((x, v), a) in at.iter_mut().zip(&mut velocity).zip(&sum) {
            *v += a * (dt / 2.0);
            // Centred: (1 + turn perp) u = v.
            let u = Place::new(v[0] + turn * v[1], v[1] - turn * v[0]) / (1.0 + turn * turn);
            *x += u * dt;
            *v = u * 2.0 - *v;
        }
        let (potential, products) = accelerations(&at, &mut sum)?;
        for (v, a) in velocity.iter_mut().zip(&sum) {
            *v += a * (dt / 2.0);
        }
        left.products += products as f64 / steps as f64;
        let change = (kinetic(&velocity) + potential - begin).abs() / scale;
        left.energy = left.energy.max(change);
        if step % 10 == 0 {
            mesh.update(&at)?;
            left.nearest = left.nearest.min(mesh.nearest().value / spacing);
        }
    }
    left.kept = (along(&at, &velocity) / first).powi(2);
    Ok(left)
}

fn row(flow: Flow, side: usize, potential: Potential, seeds: usize) {
    let runs: Vec<_> = std::thread::scope(|scope| {
        let start = |seed| scope.spawn(move || run(flow, side, potential, seed));
        let all: Vec<_> = (1..=seeds as u64).map(start).collect();
        let ended = all.into_iter().map(|run| run.join().expect("ends"));
        ended.collect()
    });
    let flow = match flow {
        Flow::Shear => "shear",
        Flow::Vortices => "vortices",
    };
    let name = potential.name;
    let mut good = Vec::new();
    for run in runs {
        match run {
            Ok(left) => good.push(left),
            Err(error) => println!("| {flow} | {side} | {name} | {error} | | | | |"),
        }
    }
    if good.is_empty() {
        return;
    }
    good.sort_by(|a, b| a.kept.total_cmp(&b.kept));
    let nearest = 1.0 / clebsch::scalar::largest(good.iter().map(|l| 1.0 / l.nearest));
    let energy = clebsch::scalar::largest(good.iter().map(|l| l.energy));
    println!(
        "| {flow} | {side} | {name} | {:.3} | {:.3} | {nearest:.2} | {energy:.1e} | {:.0} |",
        good[good.len() / 2].kept,
        good[0].kept,
        good[0].products
    );
}
