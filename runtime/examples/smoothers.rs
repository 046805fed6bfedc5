//! The anisotropy of direction-by-direction smoothing, compared with the isotropic smoother. Measures frequencies of waves of equal
//! length along an axis and at an angle, the wave ring of a round hill of water released at rest, and the angular momentum of a
//! tilted elliptical hill, which should stay zero. Prints two tables.
//!
//! `cargo run --release -p clebsch --example smoothers`, half a minute

use clebsch::mesh::{Domain, Functional, Nodes, Setting, deposit, smooth, smooth_isotropic};
use clebsch::nalgebra::Vector2;
use std::f64::consts::TAU;

type Place = Vector2<f64>;

/// The length of the torus for the released hills: much longer than waves travel.
const LENGTH: f64 = 2.0 * TAU;

fn main() {
    println!("| domain | α k | split, axis | split, askew | isotropic, axis | isotropic, askew |");
    println!("|---|---|---|---|---|---|");
    for (name, domain) in [
        ("torus", Domain::torus([TAU; 2])),
        ("basin", Domain::basin([TAU; 2])),
    ] {
        for ratio in [0.25, 0.5, 1.0, 2.0] {
            let split = frequencies::<smooth<f64, 2>>(domain, ratio);
            let whole = frequencies::<smooth_isotropic<f64, 2>>(domain, ratio);
            println!(
                "| {name} | {ratio} | {:.4} | {:.4} | {:.4} | {:.4} |",
                split[0], split[1], whole[0], whole[1]
            );
        }
    }
    println!(
        "\n| cells | α | split, fourfold part | isotropic | split, angular momentum | isotropic |"
    );
    println!("|---|---|---|---|---|---|");
    for cells in [64, 128] {
        for alpha in [0.4, 0.2] {
            let split = released::<smooth<f64, 2>>(cells, alpha);
            let whole = released::<smooth_isotropic<f64, 2>>(cells, alpha);
            println!(
                "| {cells} | {alpha:.3} | {:.1e} | {:.1e} | {:.1e} | {:.1e} |",
                split[0], whole[0], split[1], whole[1]
            );
        }
    }
}

/// Frequencies of waves with unit depth and speed, with five periods per domain length, along an axis and in the ratio 3 to 4, on
/// 128 cells. Relative to the frequency on the plane, `k / sqrt(1 + α²k²)`.
fn frequencies<S>(domain: Domain<2>, ratio: f64) -> [f64; 2]
where
    S: for<'a> Functional<f64, 2, Argument = f64, Data<'a> = (f64,)>,
{
    let setting = Setting {
        domain,
        grid: Some([128; 2]),
        particles: 1,
    };
    let nodes = Nodes::new(&setting).expect("a grid");
    let side = (nodes.count() as f64).sqrt().round() as usize;
    let weights = nodes.weights::<f64>();
    let mut smoother = S::new(&setting, (ratio / 5.0,)).expect("a length");
    [[5.0, 0.0], [3.0, 4.0]].map(|k| {
        let at = |i: usize| TAU * i as f64 / 128.0;
        let wave = |n: usize| (k[0] * at(n / side)).cos() * (k[1] * at(n % side)).cos();
        let wave: Vec<f64> = (0..side * side).map(wave).collect();
        let mut smoothed = wave.clone();
        smoother.value(&wave, &mut smoothed).expect("solved");
        let product = |other: &[f64]| -> f64 {
            let all = weights.iter().zip(&wave).zip(other);
            all.map(|((w, a), b)| w * a * b).sum()
        };
        (product(&smoothed) / product(&wave) * (1.0 + ratio * ratio)).sqrt()
    })
}

/// A hill of water in the middle of a torus, on unit depth: round, or twice as long as wide and rotated by 0.4 radians.
fn hill(x: Place, round: bool) -> f64 {
    let r = x - Place::repeat(LENGTH / 2.0);
    let (sin, cos) = 0.4_f64.sin_cos();
    let (long, short) = (cos * r[0] + sin * r[1], cos * r[1] - sin * r[0]);
    let [a, b] = if round { [2.0, 2.0] } else { [1.0, 4.0] };
    1.0 + 0.3 * (-a * long * long - b * short * short).exp()
}

/// After 1.5 time units with unit wave speed: the fourfold component of the wave ring from a round hill, relative to the wave, and
/// the angular momentum of an elliptical hill, relative to the sum of the absolute values for all particles.
fn released<S>(cells: usize, alpha: f64) -> [f64; 2]
where
    S: for<'a> Functional<f64, 2, Argument = f64, Data<'a> = (f64,)>,
{
    [true, false].map(|round| {
        let side = 4 * cells;
        let setting = Setting {
            domain: Domain::torus([LENGTH; 2]),
            grid: Some([cells; 2]),
            particles: side * side,
        };
        let cell = LENGTH / side as f64;
        let place = |a: usize| Place::new((a / side) as f64 + 0.5, (a % side) as f64 + 0.5) * cell;
        let mut x: Vec<Place> = (0..side * side).map(place).collect();
        let m: Vec<f64> = x.iter().map(|x| hill(*x, round) * cell * cell).collect();
        let weights = Nodes::new(&setting).expect("a grid").weights::<f64>();
        let mut deposit = deposit::<f64, 2>::new(&setting, (&m,)).expect("a grid");
        let mut smoother = S::new(&setting, (alpha,)).expect("a length");
        let (mut depth, mut smoothed) = (vec![0.0; weights.len()], vec![0.0; weights.len()]);
        let (mut v, mut pulls) = (vec![Place::zeros(); x.len()], vec![Place::zeros(); x.len()]);
        let steps = 75;
        let dt = 1.5 / f64::from(steps);
        for step in 0..=steps {
            deposit.value(&x, &mut depth).expect("inside");
            smoother.value(&depth, &mut smoothed).expect("solved");
            let seed: Vec<f64> = smoothed.iter().zip(&weights).map(|(s, w)| s * w).collect();
            deposit.pull_back(&x, &seed, &mut pulls).expect("inside");
            // Half a kick at both ends.
            let kick = if step % steps == 0 { dt / 2.0 } else { dt };
            for ((v, pull), m) in v.iter_mut().zip(&pulls).zip(&m) {
                *v -= pull * (kick / m);
            }
            if step < steps {
                x.iter_mut().zip(&v).for_each(|(x, v)| *x += v * dt);
            }
        }
        let ratio = |all: &mut dyn Iterator<Item = (f64, f64)>| -> f64 {
            let (mut sum, mut sizes) = (0.0, 0.0);
            all.for_each(|(x, size)| (sum, sizes) = (sum + x, sizes + size));
            (sum / sizes).abs()
        };
        if round {
            ratio(&mut smoothed.iter().enumerate().map(|(n, s)| {
                let at =
                    Place::new((n / cells) as f64, (n % cells) as f64) * (LENGTH / cells as f64);
                let r = at - Place::repeat(LENGTH / 2.0);
                // Restricted to the ring of the wave front.
                let wave = (s - 1.0) * (-((r.norm() - 1.6) / 0.4).powi(2)).exp();
                (wave * (4.0 * r[1].atan2(r[0])).cos(), wave.abs())
            }))
        } else {
            ratio(&mut x.iter().zip(&v).zip(&m).map(|((x, v), m)| {
                let arm = x - Place::repeat(LENGTH / 2.0);
                (m * arm.perp(v), m * arm.norm() * v.norm())
            }))
        }
    })
}
