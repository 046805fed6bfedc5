//! Depths smoothed twice or by a kernel: their equations, exact derivatives, lakes at rest, waves, and the continuity of forces at
//! a change of neighbours.

use super::derivatives::{
    Plane, against_differences, against_duals, numbers, random, second_derivatives, seeds, setting,
};
use clebsch::Dual;
use clebsch::line::Threads;
use clebsch::mesh::placement::{Jitter, hexagonal, lattice};
use clebsch::mesh::{
    Domain, Functional, Voronoi, helmholtz_depth, helmholtz_twice, kernel_depth, voronoi_area,
};
use clebsch::nalgebra::SVector;
use clebsch::saved::{Saved, Words};

/// A smoothed depth over plain numbers.
trait Depth:
    Functional<f64, 2, Argument = Plane> + for<'a> Functional<f64, 2, Data<'a> = (&'a [f64], f64)>
{
}
impl<F> Depth for F where
    F: Functional<f64, 2, Argument = Plane>
        + for<'a> Functional<f64, 2, Data<'a> = (&'a [f64], f64)>
{
}

fn masses(count: usize) -> Vec<f64> {
    let mut next = numbers(7);
    (0..count).map(|_| 0.5 + next()).collect()
}

fn bricks(lengths: [f64; 2], rows: [usize; 2], size: f64) -> Vec<Plane> {
    let jitter = Jitter { size, seed: 21 };
    lattice(&Domain::torus(lengths), rows, true, jitter)
}

fn value<F: Depth>(at: &[Plane], m: &[f64], alpha: f64) -> Vec<f64> {
    let setting = setting([1.0, 1.0], at.len());
    let mut depth = F::new(&setting, (m, alpha)).unwrap();
    let mut phi = vec![0.0; at.len()];
    depth.value(at, &mut phi).unwrap();
    phi
}

/// The accelerations of the potential energy `sum m phi/2`.
fn accelerations<F: Depth>(at: &[Plane], m: &[f64], alpha: f64) -> Vec<Plane> {
    let setting = setting([1.0, 1.0], at.len());
    let mut depth = F::new(&setting, (m, alpha)).unwrap();
    let (mut phi, mut gradient) = (vec![0.0; at.len()], vec![Plane::zeros(); at.len()]);
    depth.value(at, &mut phi).unwrap();
    let seed: Vec<f64> = m.iter().map(|m| m / 2.0).collect();
    depth.pull_back(at, &seed, &mut gradient).unwrap();
    gradient.iter().zip(m).map(|(g, m)| -g / *m).collect()
}

/// Smoothing twice equals smoothing once with the masses from the areas and the once-smoothed depth.
#[test]
fn twice_is_once_and_once_more() {
    for (count, alpha) in [(1, 0.3), (40, 0.0), (40, 0.1), (40, 0.7)] {
        let at = random([1.0, 1.0], count, 4);
        let m = masses(count);
        let once = value::<helmholtz_depth<f64>>(&at, &m, alpha);
        let mut areas = vec![0.0; count];
        let mut area = voronoi_area::<f64>::new(&setting([1.0, 1.0], count), ()).unwrap();
        area.value(&at, &mut areas).unwrap();
        let again: Vec<f64> = areas.iter().zip(&once).map(|(a, h)| a * h).collect();
        let expected = value::<helmholtz_depth<f64>>(&at, &again, alpha);
        let found = value::<helmholtz_twice<f64>>(&at, &m, alpha);
        let mut mesh = Voronoi::new(&Domain::torus([1.0, 1.0]), count).unwrap();
        let back = helmholtz_twice::masses(&mut mesh, &at, alpha, &found).unwrap();
        for a in 0..count {
            // Residuals of 1e-12 times the condition number of the matrices.
            assert!((found[a] - expected[a]).abs() < 1e-9 * expected[a].abs().max(1.0));
            assert!((back[a] - m[a]).abs() < 1e-9, "{a}: {} {}", back[a], m[a]);
        }
    }
}

/// The equation of the kernel depth, by sums over all pairs.
#[test]
fn the_kernels_depth_solves_its_equation() {
    let lengths = [1.0, 1.0];
    for (count, alpha) in [(2, 0.2), (40, 0.1), (200, 0.05), (200, 0.5)] {
        let at = random(lengths, count, 4);
        let m = masses(count);
        let phi = value::<kernel_depth<f64>>(&at, &m, alpha);
        let mut areas = vec![0.0; count];
        let mut area = voronoi_area::<f64>::new(&setting(lengths, count), ()).unwrap();
        area.value(&at, &mut areas).unwrap();
        let radius = (2.5 / (count as f64).sqrt()).min(0.5);
        for a in 0..count {
            let mut sum = areas[a] * phi[a];
            for b in (0..count).filter(|&b| b != a) {
                let apart = (at[b] - at[a]).map(|x| x - x.round());
                let q = apart.norm() / radius;
                if q < 1.0 {
                    let factor = 1008.0 / (5.0 * core::f64::consts::PI * radius.powi(4));
                    let kernel = factor * (1.0 - q).powi(4) * (1.0 + 4.0 * q);
                    sum += alpha * alpha * areas[a] * areas[b] * kernel * (phi[a] - phi[b]);
                }
            }
            // 1e-12 of the norm of the masses.
            assert!((sum - m[a]).abs() < 1e-10, "{count} {a}: {sum} {}", m[a]);
        }
    }
}

/// Derivatives of both depths with respect to positions, by differences and dual numbers, with seeds proportional to the masses and
/// other seeds.
#[test]
fn they_pull_back() {
    fn check<R, D>(new: impl Fn(&[f64], f64, [f64; 2]) -> (R, D))
    where
        R: Functional<f64, 2, Argument = Plane>,
        D: Functional<Dual<1>, 2, Argument = SVector<Dual<1>, 2>>,
    {
        for (rows, lengths) in [
            ([2, 2], [1.0, 1.3]),
            ([3, 2], [1.0, 1.0]),
            ([6, 6], [1.2, 0.9]),
        ] {
            let at = bricks(lengths, rows, 0.3);
            let m = masses(at.len());
            let multiple: Vec<f64> = m.iter().map(|m| -0.37 * m).collect();
            for alpha in [0.0, 0.3] {
                let (mut depth, mut dual) = new(&m, alpha, lengths);
                for seed in [seeds(at.len()), multiple.clone()] {
                    // The error of differences has two parts of 5e-8: the iteration residual 1e-12 times both condition numbers
                    // over the step, and the truncation error for close particles.
                    against_differences(&mut depth, &at, &seed, 5e-4, 1e-7);
                    against_duals(&mut depth, &mut dual, &at, &seed);
                }
            }
        }
        let at = bricks([1.0, 0.9], [4, 4], 0.3);
        let m = masses(16);
        let (mut depth, mut dual) = new(&m, 0.2, [1.0, 0.9]);
        second_derivatives(&mut depth, &mut dual, &at, &seeds(16), 1e-6);
        second_derivatives(&mut depth, &mut dual, &at, &m, 1e-6);
    }
    let duals = |m: &[f64]| -> Vec<_> { m.iter().map(|m| Dual::<1>::constant(*m)).collect() };
    check(|m, alpha, lengths| {
        let setting = setting(lengths, m.len());
        let data = (&duals(m)[..], Dual::constant(alpha));
        let dual = helmholtz_twice::<Dual<1>>::new(&setting, data).unwrap();
        (helmholtz_twice::new(&setting, (m, alpha)).unwrap(), dual)
    });
    check(|m, alpha, lengths| {
        let setting = setting(lengths, m.len());
        let data = (&duals(m)[..], Dual::constant(alpha));
        let dual = kernel_depth::<Dual<1>>::new(&setting, data).unwrap();
        (kernel_depth::new(&setting, (m, alpha)).unwrap(), dual)
    });
}

/// A lake of constant depth stays at rest on irregular meshes, and forces sum to zero on any mesh.
#[test]
fn a_lake_stays_at_rest() {
    fn check<F: Depth>(n: usize, alpha: f64) {
        let at = bricks([1.0, 1.0], [n, n], 0.1);
        let mut area = voronoi_area::<f64>::new(&setting([1.0, 1.0], n * n), ()).unwrap();
        let mut m = vec![0.0; n * n];
        area.value(&at, &mut m).unwrap();
        let all = accelerations::<F>(&at, &m, alpha);
        let most = clebsch::scalar::largest(all.iter().map(|a| a.norm()));
        // Rounding errors of forces of size c^2/dx.
        assert!(most < 1e-12 * n as f64, "{n}: {most}");
        let m = vec![1.0 / (n * n) as f64; n * n];
        let all = accelerations::<F>(&at, &m, alpha);
        let sum: Plane = all.iter().map(|a| a / (n * n) as f64).sum();
        assert!(sum.norm() < 1e-13, "{sum}");
        let most = clebsch::scalar::largest(all.iter().map(|a| a.norm()));
        assert!(most > 1e-3, "a heap moves: {most}");
    }
    for n in [16, 32] {
        check::<helmholtz_twice<f64>>(n, 2.0 / n as f64);
        check::<kernel_depth<f64>>(n, 2.0 / n as f64);
    }
}

/// `omega/(c k)` of waves with `k = 2 pi` along x, by the Rayleigh quotient of the forces.
fn wave<F: Depth>(at: &[Plane], alpha: f64, transverse: bool) -> f64 {
    let k = core::f64::consts::TAU;
    let m = vec![1.0 / at.len() as f64; at.len()];
    let along = usize::from(transverse);
    let size = 1e-5;
    let moved: Vec<Plane> = at
        .iter()
        .map(|x| {
            let mut y = *x;
            y[along] += size * (k * x[0]).sin();
            y
        })
        .collect();
    let (mut work, mut norm) = (0.0, 0.0);
    for (x, a) in at.iter().zip(accelerations::<F>(&moved, &m, alpha)) {
        let wave = (k * x[0]).sin();
        work -= a[along] * wave;
        norm += size * wave * wave;
    }
    let square: f64 = work / norm;
    square.abs().sqrt().copysign(square) / k
}

/// On a lattice, smoothing once multiplies waves by a factor and smoothing twice by its square. The kernel follows the dispersion
/// relation up to the square of the particle distance. Shear meets no resistance.
#[test]
fn waves_are_smoothed_twice() {
    let domain = Domain::torus([1.0, 1.0]);
    let mut apart = Vec::new();
    for n in [16, 32] {
        let at = hexagonal(&domain, n, Jitter::NONE);
        let alpha = 2.0 / n as f64;
        let bare = wave::<helmholtz_depth<f64>>(&at, 0.0, false);
        let once = wave::<helmholtz_depth<f64>>(&at, alpha, false);
        let twice = wave::<helmholtz_twice<f64>>(&at, alpha, false);
        // Amplitudes of 1e-5 change speeds by their square.
        assert!((twice * bare - once * once).abs() < 1e-6, "{n}: {twice}");
        let kernel = wave::<kernel_depth<f64>>(&at, alpha, false);
        let exact = 1.0 / (1.0 + (core::f64::consts::TAU * alpha).powi(2)).sqrt();
        apart.push((kernel - exact).abs());
        for across in [
            wave::<helmholtz_twice<f64>>(&at, alpha, true),
            wave::<kernel_depth<f64>>(&at, alpha, true),
        ] {
            assert!(across.abs() < 1e-3, "{n}: {across}");
        }
    }
    println!("{apart:?}");
    assert!(apart[0] < 0.05 && apart[1] < apart[0] / 3.0, "{apart:?}");
}

/// Discrete wave speeds converge to the dispersion relation with the square of the particle distance, unsmoothed, smoothed once and
/// twice.
#[test]
fn speeds_approach_the_dispersion_relation_with_the_square_of_the_distance() {
    let domain = Domain::torus([1.0, 1.0]);
    let k = core::f64::consts::TAU;
    for alpha in [0.0, 0.05, 0.1] {
        let apart = [16, 32].map(|n| {
            let at = lattice(&domain, [n, n], false, Jitter::NONE);
            let factor = 1.0 / (1.0 + (alpha * k).powi(2));
            let once = wave::<helmholtz_depth<f64>>(&at, alpha, false) - factor.sqrt();
            let twice = wave::<helmholtz_twice<f64>>(&at, alpha, false) - factor;
            [once.abs(), twice.abs()]
        });
        for (coarse, fine) in apart[0].iter().zip(&apart[1]) {
            let order = (coarse / fine).log2();
            assert!((order - 2.0).abs() < 0.1, "{alpha}: {coarse:e} {fine:e}");
        }
    }
}

/// If four particles lie on a circle, their neighbours change. The force of a smoothed depth jumps there, less if it is smoothed
/// twice; the force of a kernel depth is continuous.
#[test]
fn only_the_kernels_force_is_continuous_where_neighbours_change() {
    let n = 12;
    let mut at = bricks([1.0, 1.0], [n, n], 0.3);
    let m = masses(n * n);
    let m: Vec<f64> = m.iter().map(|m| m / (n * n) as f64).collect();
    // Finds the flip by bisection on the number of flips of a mesh.
    let mut mesh = Voronoi::new(&Domain::torus([1.0, 1.0]), n * n).unwrap();
    let start = at[50];
    let place = |s: f64| start + Plane::new(0.6, 0.35) * (s / n as f64);
    let mut flipped = |at: &mut Vec<Plane>, s: f64| {
        at[50] = place(0.0);
        mesh.update(at).unwrap();
        let before = mesh.counted().flips;
        at[50] = place(s);
        mesh.update(at).unwrap();
        mesh.counted().flips > before
    };
    let (mut low, mut high) = (0.0, 1.0);
    assert!(flipped(&mut at, high));
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        if flipped(&mut at, middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    // The jump over a distance of 2e-6, against the change over the same distance elsewhere.
    let mut jump = |force: &dyn Fn(&[Plane]) -> Vec<Plane>| {
        let mut change = |s: f64| {
            at[50] = place(s - 1e-6);
            let before = force(&at);
            at[50] = place(s + 1e-6);
            let pairs = before.iter().zip(force(&at));
            clebsch::scalar::largest(pairs.map(|(a, b)| (a - b).norm()))
        };
        change(high) / change(high + 1e-4)
    };
    let alpha = 2.0 / n as f64;
    let once = jump(&|at| accelerations::<helmholtz_depth<f64>>(at, &m, alpha));
    let twice = jump(&|at| accelerations::<helmholtz_twice<f64>>(at, &m, alpha));
    let kernel = jump(&|at| accelerations::<kernel_depth<f64>>(at, &m, alpha));
    println!("jumps: {once} {twice} {kernel}");
    assert!(once > 10.0 && kernel < 3.0, "{once} {twice} {kernel}");
}

/// Neither the number of threads (with the feature `rayon`) nor saving and restoring changes a bit.
#[test]
fn threads_and_resuming_change_no_bit() {
    let n = 64;
    let start = bricks([1.0, 1.0], [n, n], 0.3);
    let m = vec![1.0 / (n * n) as f64; n * n];
    let setting = setting([1.0, 1.0], n * n);
    let seed = seeds(n * n);
    fn steps<F: Depth>(depth: &mut F, at: &[Plane], seed: &[f64], from: usize) -> Vec<f64> {
        let (mut phi, mut force) = (vec![0.0; at.len()], vec![Plane::zeros(); at.len()]);
        for step in from..from + 3 {
            let turned = |(a, x): (usize, &Plane)| {
                x + Plane::new((a as f64).sin(), (a as f64).cos()) * (1e-3 * step as f64)
            };
            let moved: Vec<Plane> = at.iter().enumerate().map(turned).collect();
            depth.value(&moved, &mut phi).unwrap();
            depth.pull_back(&moved, seed, &mut force).unwrap();
        }
        phi.extend(force.iter().flat_map(|f| [f[0], f[1]]));
        phi
    }
    macro_rules! check {
        ($f:ident) => {
            let run = |threads| {
                let mut depth = $f::<f64>::new(&setting, (&m, 0.03)).unwrap();
                depth.share(Threads(threads));
                let first = steps(&mut depth, &start, &seed, 0);
                (depth, first)
            };
            let (mut one, first) = run(1);
            for threads in [2, 3] {
                assert!(run(threads).1 == first, "{threads}");
            }
            let mut words = Words::gathered();
            one.words(&mut words);
            let mut words = Words::given(words.into_list().unwrap());
            let mut resumed = $f::<f64>::new(&setting, (&m, 0.03)).unwrap();
            resumed.words(&mut words);
            assert!(words.all_put());
            let expected = steps(&mut one, &start, &seed, 3);
            assert!(steps(&mut resumed, &start, &seed, 3) == expected);
        };
    }
    check!(helmholtz_twice);
    check!(kernel_depth);
}
