//! What the smoothness of splines does to the energy of particle-mesh shallow water: two vortices in a rotating channel
//! for 6000 steps by cubic and by quintic splines. Prints errors of the energy, of its start and of the kinetic one.
//!
//! `cargo run --release -p clebsch --example splines`, a minute

use clebsch::mesh::{Domain, Functional, Nodes, Setting, deposit, deposit_quintic, smooth};
use clebsch::nalgebra::Vector2;
use clebsch::scalar::largest;
use std::f64::consts::{PI, TAU};

type Place = Vector2<f64>;

const SIDE: usize = 128;
const CELLS: [usize; 2] = [63, 64];
const STEPS: usize = 6000;
/// Coriolis parameter, and the speed of long waves.
const F: f64 = TAU;
const SPEED: f64 = TAU;

fn main() {
    println!(
        "| splines | step | 1500 steps | 6000 steps | of the kinetic energy | means of quarters |"
    );
    println!("|---|---|---|---|---|---|");
    for dt in [5e-3, 2.5e-3] {
        run::<deposit<f64, 2>>("cubic", dt);
        run::<deposit_quintic<f64, 2>>("quintic", dt);
    }
}

/// A high and a low side by side, and the slope of the depth.
fn depth(x: &Place) -> (f64, Place) {
    let mut all = (1.0, Place::zeros());
    for (height, at) in [(0.1, -0.8), (-0.1, 0.8)] {
        let from = x - Place::new(PI + at, PI);
        let bump = height * (-from.norm_squared() / 0.5).exp();
        all.0 += bump;
        all.1 -= from * (4.0 * bump);
    }
    all
}

fn run<D>(name: &str, dt: f64)
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
    let m: Vec<f64> = x.iter().map(|x| depth(x).0 * cell * cell).collect();
    // In balance.
    let velocity = |x: &Place| Place::new(-depth(x).1[1], depth(x).1[0]) * (SPEED * SPEED / F);
    let mut v: Vec<Place> = x.iter().map(velocity).collect();
    let alpha = 2.0 * TAU / CELLS[0] as f64;
    let weights = Nodes::new(&setting).expect("a grid").weights::<f64>();
    let mut deposit = D::new(&setting, (&m,)).expect("a grid");
    let mut smoother =
        <smooth<f64, 2> as Functional<f64, 2>>::new(&setting, (alpha,)).expect("a grid");
    let (mut h, mut s) = (vec![0.0; weights.len()], vec![0.0; weights.len()]);
    let mut pulls = vec![Place::zeros(); count];
    // The potential energy; the pulls with it.
    let mut force = |x: &[Place], pulls: &mut [Place]| -> f64 {
        deposit.value(x, &mut h).expect("inside");
        smoother.value(&h, &mut s).expect("solved");
        let mut energy = 0.0;
        for ((s, h), w) in s.iter_mut().zip(&h).zip(&weights) {
            energy += SPEED * SPEED / 2.0 * w * *h * *s;
            *s *= SPEED * SPEED * w;
        }
        deposit.pull_back(x, &s, pulls).expect("inside");
        energy
    };
    let kinetic = |v: &[Place]| -> f64 {
        let each = v.iter().zip(&m);
        each.map(|(v, m)| m * v.norm_squared() / 2.0).sum()
    };
    let scale = kinetic(&v);
    let first = scale + force(&x, &mut pulls);
    let box_of = [TAU / CELLS[0] as f64, TAU / CELLS[1] as f64];
    let turn = F * dt / 2.0;
    let mut errors = Vec::with_capacity(STEPS);
    for _ in 0..STEPS {
        for (site, ((x, v), pull)) in x.iter_mut().zip(&mut v).zip(&pulls).enumerate() {
            *v -= pull * (dt / (2.0 * m[site]));
            let u = Place::new(v[0] + turn * v[1], v[1] - turn * v[0]) / (1.0 + turn * turn);
            *v = u * 2.0 - *v;
            let (mut to, mut turned) = ((*x + u * dt).into(), (*v).into());
            let reflected = setting.domain.reflect(site, &box_of, &mut to, &mut turned);
            reflected.expect("hardly beyond a wall");
            (*x, *v) = (to.into(), turned.into());
        }
        let potential = force(&x, &mut pulls);
        for ((v, pull), m) in v.iter_mut().zip(&pulls).zip(&m) {
            *v -= pull * (dt / (2.0 * m));
        }
        errors.push((kinetic(&v) + potential) / first - 1.0);
    }
    let [early, all] = [1500, STEPS].map(|n| largest(errors[..n].iter().copied()));
    let quarters = errors.chunks(STEPS / 4);
    let means: Vec<String> = quarters
        .map(|q| format!("{:.1e}", q.iter().sum::<f64>() / q.len() as f64))
        .collect();
    println!(
        "| {name} | {dt} | {early:.1e} | {all:.1e} | {:.1e} | {} |",
        all * first / scale,
        means.join(", ")
    );
}
