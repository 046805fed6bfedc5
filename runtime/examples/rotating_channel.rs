//! Particle-mesh shallow water in a rotating channel: two vortices for 6000 steps. Compares how initial balance, rotation scheme,
//! splines and step size affect energy and potential vorticity. Prints the energy error after 1500 and 6000 steps relative to the
//! kinetic energy, and the means over its quarters. Also prints the changes of the nodal sum of the potential vorticity and of the
//! mass.
//!
//! `cargo run --release -p clebsch --example rotating_channel`, two minutes

use clebsch::mesh::{Domain, Functional, Nodes, Setting, deposit, deposit_quintic, smooth};
use clebsch::nalgebra::Vector2;
use clebsch::scalar::largest;
use std::f64::consts::{PI, TAU};

type Place = Vector2<f64>;

const SIDE: usize = 128;
const CELLS: [usize; 2] = [63, 64];
/// Coriolis parameter, and the speed of long waves.
const F: f64 = TAU;
const SPEED: f64 = TAU;

fn main() {
    let steps = std::env::args().nth(1).and_then(|n| n.parse().ok());
    let steps = steps.unwrap_or(6000);
    println!(
        "| balance of | rotation | splines | step | {} steps | {steps} steps | of the kinetic energy | means of quarters | vorticity | mass |",
        steps / 4
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for start in [Start::Depth, Start::Sharpened, Start::Smoothed] {
        for rotation in [Rotation::Centred, Rotation::Exact, Rotation::Midpoint] {
            run::<deposit<f64, 2>>("cubic", start, rotation, 5e-3, steps);
        }
        for dt in [5e-3, 2.5e-3] {
            run::<deposit_quintic<f64, 2>>("quintic", start, Rotation::Centred, dt, steps);
        }
        run::<deposit<f64, 2>>("cubic", start, Rotation::Centred, 2.5e-3, steps);
    }
}

/// The depth that balances the initial velocities: the particle depth from a formula; the same formula for the smoothed depth,
/// with the particle depth sharpened accordingly; or the smoothed depth on the grid, whose gradient is the force.
#[derive(Clone, Copy, Debug)]
enum Start {
    Depth,
    Sharpened,
    Smoothed,
}

/// The rotation of velocities: about the mean of both ends of a step, as in the discrete Lagrangian; by the flow of a free particle
/// on a rotating plane; or by midpoint rules for both half steps, including their kicks.
#[derive(Clone, Copy, Debug)]
enum Rotation {
    Centred,
    Exact,
    Midpoint,
}

/// A velocity rotated by a quarter turn, in the sense of the Coriolis force.
fn turned(v: Place) -> Place {
    Place::new(v[1], -v[0])
}

/// The solution of `u = v + a turned(u)`.
fn solved(v: Place, a: f64) -> Place {
    (v + turned(v) * a) / (1.0 + a * a)
}

impl Rotation {
    /// Half a step: the kick of an acceleration, and the corresponding rotation.
    fn half(self, v: Place, acceleration: Place, dt: f64) -> Place {
        let kick = acceleration * (dt / 2.0);
        let a = F * dt / 4.0;
        match self {
            Self::Midpoint => solved(v + turned(v) * a + kick, a),
            _ => v + kick,
        }
    }

    /// The displacement of a step, and the velocity after it.
    fn way(self, v: Place, dt: f64) -> (Place, Place) {
        match self {
            Self::Centred => {
                let u = solved(v, F * dt / 2.0);
                (u * dt, u * 2.0 - v)
            }
            Self::Exact => {
                let (sin, cos) = (F * dt).sin_cos();
                let way = v * sin + turned(v) * (1.0 - cos);
                (way / F, v * cos + turned(v) * sin)
            }
            Self::Midpoint => (v * dt, v),
        }
    }
}

/// A high next to a low, and the gradient of the depth. The depth is sharpened over the length `alpha`, by
/// `(1 - α²∂_1²)(1 - α²∂_2²)`.
fn depth(x: &Place, alpha: f64) -> (f64, Place) {
    let mut all = (1.0, Place::zeros());
    for (height, at) in [(0.1, -0.8), (-0.1, 0.8)] {
        let from = x - Place::new(PI + at, PI);
        let bump = height * (-from.norm_squared() / 0.5).exp();
        let sharpened = from.map(|x| 1.0 + 4.0 * alpha * alpha * (1.0 - 4.0 * x * x));
        all.0 += bump * sharpened[0] * sharpened[1];
        all.1 -= from * (4.0 * bump);
    }
    all
}

/// The smoothing length, two cells.
const ALPHA: f64 = 2.0 * TAU / CELLS[0] as f64;

/// Grid fields and forces.
struct Water<D> {
    setting: Setting<2>,
    m: Vec<f64>,
    weights: Vec<f64>,
    deposit: D,
    smoother: smooth<f64, 2>,
    depth: Vec<f64>,
    smoothed: Vec<f64>,
}

impl<D> Water<D>
where
    D: for<'a> Functional<f64, 2, Argument = Place, Data<'a> = (&'a [f64],)>,
{
    fn new(setting: Setting<2>, m: Vec<f64>) -> Self {
        let weights = Nodes::new(&setting).expect("a grid").weights::<f64>();
        Self {
            deposit: D::new(&setting, (&m,)).expect("a grid"),
            smoother: Functional::<f64, 2>::new(&setting, (ALPHA,)).expect("a grid"),
            depth: vec![0.0; weights.len()],
            smoothed: vec![0.0; weights.len()],
            weights,
            m,
            setting,
        }
    }

    /// The potential energy; writes the accelerations to `out`.
    fn force(&mut self, x: &[Place], out: &mut [Place]) -> f64 {
        let Self {
            depth, smoothed, ..
        } = self;
        self.deposit.value(x, depth).expect("inside");
        self.smoother.value(depth, smoothed).expect("solved");
        let mut energy = 0.0;
        for ((s, h), w) in smoothed.iter_mut().zip(depth.iter()).zip(&self.weights) {
            energy += SPEED * SPEED / 2.0 * w * *h * *s;
            *s *= -SPEED * SPEED * w;
        }
        self.deposit.pull_back(x, smoothed, out).expect("inside");
        out.iter_mut().zip(&self.m).for_each(|(a, m)| *a /= *m);
        energy
    }

    /// The sum over nodes of `(ζ + f)/h`, from the mass-weighted velocity at nodes and its centred differences inside; and the
    /// relative error of the mass.
    fn vorticity(&mut self, x: &[Place], v: &[Place]) -> (f64, f64) {
        self.deposit.value(x, &mut self.depth).expect("inside");
        let at_nodes: Vec<Vec<f64>> = [0, 1]
            .map(|d| {
                let momenta: Vec<f64> = v.iter().zip(&self.m).map(|(v, m)| m * v[d]).collect();
                let mut out = vec![0.0; self.depth.len()];
                let mut deposit = D::new(&self.setting, (&momenta,)).expect("a grid");
                deposit.value(x, &mut out).expect("inside");
                out.iter_mut().zip(&self.depth).for_each(|(p, h)| *p /= *h);
                out
            })
            .into();
        let [across, along] = CELLS;
        let [dx, dy] = CELLS.map(|n| TAU / n as f64);
        let mut sum = 0.0;
        for i in 0..=across {
            let (low, high) = (i.saturating_sub(1), (i + 1).min(across));
            for j in 0..along {
                let (below, above) = ((j + along - 1) % along, (j + 1) % along);
                let of = |d: usize, i: usize, j: usize| at_nodes[d][i * along + j];
                let zeta = (of(1, high, j) - of(1, low, j)) / ((high - low) as f64 * dx)
                    - (of(0, i, above) - of(0, i, below)) / (2.0 * dy);
                sum += (zeta + F) / self.depth[i * along + j];
            }
        }
        let mass: f64 = self
            .depth
            .iter()
            .zip(&self.weights)
            .map(|(h, w)| h * w)
            .sum();
        (sum, mass / self.m.iter().sum::<f64>() - 1.0)
    }
}

fn run<D>(name: &str, start: Start, rotation: Rotation, dt: f64, steps: usize)
where
    D: for<'a> Functional<f64, 2, Argument = Place, Data<'a> = (&'a [f64],)>,
{
    let count = SIDE * SIDE;
    let setting = Setting {
        domain: Domain::channel([TAU; 2]),
        grid: Some(CELLS),
        particles: count,
    };
    let cell = TAU / SIDE as f64;
    let place = |a: usize| Place::new((a / SIDE) as f64 + 0.5, (a % SIDE) as f64 + 0.5) * cell;
    let mut x: Vec<Place> = (0..count).map(place).collect();
    let sharpened = match start {
        Start::Sharpened => ALPHA,
        Start::Depth | Start::Smoothed => 0.0,
    };
    let m = x.iter().map(|x| depth(x, sharpened).0 * cell * cell);
    let m: Vec<f64> = m.collect();
    let domain = setting.domain;
    let mut water = Water::<D>::new(setting, m);
    let mut pulls = vec![Place::zeros(); count];
    let potential = water.force(&x, &mut pulls);
    // In balance, the acceleration and f times the rotated velocity cancel.
    let accelerations = x.iter().zip(&pulls).map(|(x, pull)| match start {
        Start::Depth | Start::Sharpened => depth(x, 0.0).1 * (-SPEED * SPEED),
        Start::Smoothed => *pull,
    });
    let mut v: Vec<Place> = accelerations.map(|a| turned(a) / F).collect();
    let kinetic = |v: &[Place], m: &[f64]| -> f64 {
        let each = v.iter().zip(m);
        each.map(|(v, m)| m * v.norm_squared() / 2.0).sum()
    };
    let scale = kinetic(&v, &water.m);
    let first = scale + potential;
    let (vorticity, _) = water.vorticity(&x, &v);
    let box_of = CELLS.map(|n| TAU / n as f64);
    let mut errors = Vec::with_capacity(steps);
    let (mut changed, mut mass) = (0.0_f64, 0.0_f64);
    for step in 0..steps {
        for (site, ((x, v), pull)) in x.iter_mut().zip(&mut v).zip(&pulls).enumerate() {
            let (way, after) = rotation.way(rotation.half(*v, *pull, dt), dt);
            let (mut to, mut turned) = ((*x + way).into(), after.into());
            let reflected = domain.reflect(site, &box_of, &mut to, &mut turned);
            reflected.expect("hardly beyond a wall");
            (*x, *v) = (to.into(), turned.into());
        }
        let potential = water.force(&x, &mut pulls);
        for (v, pull) in v.iter_mut().zip(&pulls) {
            *v = rotation.half(*v, *pull, dt);
        }
        errors.push((kinetic(&v, &water.m) + potential) / first - 1.0);
        if (step + 1) % 50 == 0 {
            let (sum, total) = water.vorticity(&x, &v);
            changed = largest([changed, sum / vorticity - 1.0]);
            mass = largest([mass, total]);
        }
    }
    let [early, all] = [steps / 4, steps].map(|n| largest(errors[..n].iter().copied()));
    let quarters = errors.chunks(steps / 4);
    let means: Vec<String> = quarters
        .map(|q| format!("{:.1e}", q.iter().sum::<f64>() / q.len() as f64))
        .collect();
    let start = format!("{start:?}").to_lowercase();
    let rotation = format!("{rotation:?}").to_lowercase();
    println!(
        "| {start} | {rotation} | {name} | {dt} | {early:.1e} | {all:.1e} | {:.1e} | {} | {changed:.1e} | {mass:.0e} |",
        all * first / scale,
        means.join(", ")
    );
}
