//! The smoothed depth and the short-range repulsion, against dense linear algebra, sums over all pairs, known potentials and linear
//! wave theory.

use super::derivatives::{
    Plane, against_differences, against_duals, numbers, random, second_derivatives, seeds, setting,
};
use clebsch::Dual;
use clebsch::line::Threads;
use clebsch::mesh::placement::{Jitter, hexagonal, lattice, scattered};
use clebsch::mesh::{
    Domain, Functional, MeshError, Voronoi, helmholtz_depth, pair_core, second_moment, voronoi_area,
};
use clebsch::nalgebra::{DMatrix, DVector};
use clebsch::saved::{Saved, Words};

/// The brick lattice with known potentials.
fn bricks() -> Vec<Plane> {
    lattice(
        &Domain::torus([1.0, 1.0]),
        [12, 12],
        true,
        Jitter { size: 0.3, seed: 1 },
    )
}

fn energy(at: &[Plane], m: &[f64], alpha: f64) -> f64 {
    let mut depth =
        helmholtz_depth::<f64>::new(&setting([1.0, 1.0], at.len()), (m, alpha)).unwrap();
    let mut phi = vec![0.0; at.len()];
    depth.value(at, &mut phi).unwrap();
    m.iter().zip(&phi).map(|(m, p)| m * p / 2.0).sum()
}

/// Compares the solution with a dense solution, whose stiffness is assembled from triangle gradients.
#[test]
fn the_depth_solves_its_equation() {
    for (count, alpha) in [(1, 0.3), (3, 0.2), (40, 0.0), (40, 0.1), (40, 3.0)] {
        let lengths = [1.2, 0.9];
        let at = random(lengths, count, 4);
        let mut next = numbers(8);
        let m: Vec<f64> = (0..count).map(|_| 0.5 + next()).collect();
        let mut depth = helmholtz_depth::<f64>::new(&setting(lengths, count), (&m, alpha)).unwrap();
        let mut phi = vec![0.0; count];
        depth.value(&at, &mut phi).unwrap();
        let mut matrix = DMatrix::<f64>::zeros(count, count);
        let mut mesh = Voronoi::<f64>::new(&Domain::torus(lengths), count).unwrap();
        mesh.update(&at).unwrap();
        let mut areas = vec![0.0; count];
        mesh.areas(&mut areas).unwrap();
        for a in 0..count {
            matrix[(a, a)] += areas[a];
        }
        for triangle in mesh.triangles() {
            let [d, _, back] = triangle.sides;
            let e = -back;
            let det = d[0] * e[1] - d[1] * e[0];
            let gradients = [
                Plane::new(d[1] - e[1], e[0] - d[0]) / det,
                Plane::new(e[1], -e[0]) / det,
                Plane::new(-d[1], d[0]) / det,
            ];
            for i in 0..3 {
                for j in 0..3 {
                    let entry = alpha * alpha * gradients[i].dot(&gradients[j]) * det / 2.0;
                    matrix[(triangle.sites[i], triangle.sites[j])] += entry;
                }
            }
        }
        let exact = matrix.lu().solve(&DVector::from_column_slice(&m)).unwrap();
        let size = exact.amax();
        for a in 0..count {
            // The residual of the iteration times the condition number of the matrix.
            assert!(
                (phi[a] - exact[a]).abs() < 1e-9 * size,
                "{count} {alpha} {a}"
            );
        }
        // Once more, from the stored solution.
        depth.value(&at, &mut phi).unwrap();
        assert_eq!(depth.products().0, 0);
    }
}

#[test]
fn depths_pull_back() {
    for (rows, lengths) in [
        ([2, 2], [1.0, 1.3]),
        ([3, 2], [1.0, 1.0]),
        ([6, 6], [1.2, 0.9]),
    ] {
        let jitter = Jitter {
            size: 0.3,
            seed: 21,
        };
        let at = lattice(&Domain::torus(lengths), rows, true, jitter);
        let count = at.len();
        let mut next = numbers(7);
        let m: Vec<f64> = (0..count).map(|_| 0.5 + next()).collect();
        let setting = setting(lengths, count);
        let duals: Vec<_> = m.iter().map(|m| Dual::<1>::constant(*m)).collect();
        for alpha in [0.0, 0.3] {
            let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, alpha)).unwrap();
            let alpha = Dual::constant(alpha);
            let mut dual = helmholtz_depth::<Dual<1>>::new(&setting, (&duals, alpha)).unwrap();
            let multiple: Vec<f64> = m.iter().map(|m| -0.37 * m).collect();
            for (seed, second) in [(seeds(count), true), (multiple, false)] {
                // The residual of the iteration, divided by the difference step.
                against_differences(&mut depth, &at, &seed, 2e-4, 1e-8);
                against_duals(&mut depth, &mut dual, &at, &seed);
                assert_eq!(depth.products().1 > 0, second);
            }
        }
    }
}

/// Energies of bricks with smoothed depths and with a core, to twelve digits.
#[test]
fn potentials_are_the_known_ones() {
    let at = bricks();
    let m = vec![1.0 / 144.0; 144];
    for (alpha, known) in [
        (0.5, 0.507_363_163_605),
        (1.0, 0.503_542_368_321),
        (2.0, 0.501_213_815_761),
    ] {
        let found = energy(&at, &m, alpha / 12.0);
        assert!((found - known).abs() < 1e-11, "{alpha}: {found}");
    }
    let mut core = pair_core::<f64>::new(&setting([1.0, 1.0], 144), (&m, 0.9 / 12.0, 0.1)).unwrap();
    let mut out = vec![0.0; 144];
    core.value(&at, &mut out).unwrap();
    let bare = 0.512_531_582_646;
    let found = bare + out.iter().sum::<f64>();
    assert!((found - 0.513_159_242_694).abs() < 1e-11, "{found}");
}

/// The core against a sum over all pairs and all their copies, for radii up to half of the domain.
#[test]
fn the_core_is_the_sum_over_pairs() {
    let lengths = [1.0, 0.7];
    for (count, radius) in [(2, 0.35), (5, 0.3), (50, 0.2), (50, 0.1), (300, 0.02)] {
        let at = random(lengths, count, 13);
        let m = vec![0.25; count];
        let mut core = pair_core::<f64>::new(&setting(lengths, count), (&m, radius, 3.0)).unwrap();
        let mut out = vec![0.0; count];
        core.value(&at, &mut out).unwrap();
        let mut met = 0;
        for a in 0..count {
            let mut sum = 0.0;
            for b in (0..count).filter(|&b| b != a) {
                let apart = at[b] - at[a];
                let apart =
                    Plane::from_fn(|k, _| apart[k] - (apart[k] / lengths[k]).round() * lengths[k]);
                if apart.norm() < radius {
                    sum += 0.5 * 0.25 * 3.0 * (1.0 - apart.norm() / radius).powi(3);
                    met += 1;
                }
            }
            assert!(
                (out[a] - sum).abs() < 1e-14,
                "{count} {radius} {a}: {} {sum}",
                out[a]
            );
        }
        assert_eq!(core.pairs(), met / 2);
        against_differences(&mut core, &at, &seeds(count), 5e-6, 1e-7);
        let duals = vec![Dual::<1>::constant(0.25); count];
        let data = (&duals[..], Dual::constant(radius), Dual::constant(3.0));
        let mut dual = pair_core::<Dual<1>>::new(&setting(lengths, count), data).unwrap();
        against_duals(&mut core, &mut dual, &at, &seeds(count));
    }
    let at = [[0.1, 0.1], [1.1, 0.8]].map(Plane::from);
    let mut core = pair_core::<f64>::new(&setting(lengths, 2), (&[1.0, 1.0], 0.1, 1.0)).unwrap();
    let refused = core.value(&at, &mut [0.0; 2]);
    // 0.1 + 0.7 and 0.8 differ by rounding.
    assert!(
        refused.is_ok()
            || refused
                == Err(MeshError::Coincident {
                    first: 0,
                    second: 1
                })
    );
    for (m, radius, strength) in [
        (1.0, 0.36, 1.0),
        (1.0, -0.1, 1.0),
        (0.0, 0.1, 1.0),
        (1.0, 0.1, -1.0),
        (1.0, f64::NAN, 1.0),
    ] {
        assert!(pair_core::<f64>::new(&setting(lengths, 2), (&[m, m], radius, strength)).is_err());
    }
}

/// Accelerations of particles for `g/2 sum m phi`, or for `g/2 sum m^2/A` without smoothing.
fn accelerations(at: &[Plane], m: &[f64], alpha: Option<f64>) -> Vec<Plane> {
    let setting = setting([1.0, 1.0], at.len());
    let mut values = vec![0.0; at.len()];
    let mut gradient = vec![Plane::zeros(); at.len()];
    match alpha {
        Some(alpha) => {
            let mut depth = helmholtz_depth::<f64>::new(&setting, (m, alpha)).unwrap();
            depth.value(at, &mut values).unwrap();
            let seed: Vec<f64> = m.iter().map(|m| m / 2.0).collect();
            depth.pull_back(at, &seed, &mut gradient).unwrap();
        }
        None => {
            let mut area = voronoi_area::<f64>::new(&setting, ()).unwrap();
            area.value(at, &mut values).unwrap();
            let seed: Vec<f64> = m
                .iter()
                .zip(&values)
                .map(|(m, a)| -0.5 * (m / a).powi(2))
                .collect();
            area.pull_back(at, &seed, &mut gradient).unwrap();
        }
    }
    gradient.iter().zip(m).map(|(g, m)| -g / *m).collect()
}

/// A lake of constant depth stays at rest on irregular meshes, and forces sum to zero on any mesh.
#[test]
fn a_lake_stays_at_rest() {
    let domain = Domain::torus([1.0, 1.0]);
    for n in [16, 32, 48] {
        let at = lattice(&domain, [n, n], true, Jitter { size: 0.1, seed: 3 });
        let alpha = 2.0 / n as f64;
        let mut mesh = Voronoi::new(&domain, at.len()).unwrap();
        let m = helmholtz_depth::masses(&mut mesh, &at, alpha, &vec![1.0; at.len()]).unwrap();
        for alpha in [None, Some(alpha)] {
            let all = accelerations(&at, &m, alpha);
            let largest = clebsch::scalar::largest(all.iter().map(|a| a.norm()));
            // Rounding errors of forces of size c^2/dx.
            assert!(largest < 1e-12 * n as f64, "{n} {alpha:?}: {largest}");
        }
        let mut core =
            pair_core::<f64>::new(&setting([1.0, 1.0], at.len()), (&m, 0.7 / n as f64, 0.1))
                .unwrap();
        let mut out = vec![1.0; at.len()];
        core.value(&at, &mut out).unwrap();
        assert!(out.iter().all(|x| *x == 0.0));
        // A non-constant depth.
        let m = vec![1.0 / at.len() as f64; at.len()];
        let sum: Plane = accelerations(&at, &m, Some(alpha))
            .iter()
            .map(|a| a / at.len() as f64)
            .sum();
        assert!(sum.norm() < 1e-13, "{sum}");
    }
}

/// `omega/(c k)` of plane waves with `k = 2 pi` on a lattice, by the Rayleigh quotient of the forces.
fn wave(at: &[Plane], alpha: Option<f64>, transverse: bool) -> f64 {
    let k = core::f64::consts::TAU;
    let m = vec![1.0 / at.len() as f64; at.len()];
    let size = 1e-5;
    let along = usize::from(transverse);
    let moved: Vec<Plane> = at
        .iter()
        .map(|x| {
            let mut y = *x;
            y[along] += size * (k * x[0]).sin();
            y
        })
        .collect();
    let force = accelerations(&moved, &m, alpha);
    let (mut work, mut norm) = (0.0, 0.0);
    for (x, a) in at.iter().zip(&force) {
        let wave = (k * x[0]).sin();
        work -= a[along] * wave;
        norm += size * wave * wave;
    }
    let square: f64 = work / norm;
    square.abs().sqrt().copysign(square) / k
}

/// Wave speeds on hexagons and squares; shear meets no resistance.
#[test]
fn waves_have_the_known_speeds() {
    let domain = Domain::torus([1.0, 1.0]);
    let hexagons = hexagonal(&domain, 24, Jitter::NONE);
    let squares = lattice(&domain, [24, 24], false, Jitter::NONE);
    for (at, speeds) in [
        (&hexagons, [0.9915, 0.9637, 0.8926]),
        (&squares, [0.9886, 0.9566, 0.8764]),
    ] {
        let spacing = (1.0 / at.len() as f64).sqrt();
        for (alpha, known) in [None, Some(spacing), Some(2.0 * spacing)]
            .into_iter()
            .zip(speeds)
        {
            let found = wave(at, alpha, false);
            println!(
                "{} {alpha:?}: {found} ({known}), transverse {}",
                at.len(),
                wave(at, alpha, true)
            );
            assert!((found - known).abs() < 1e-3, "{alpha:?}: {found} {known}");
            assert!(wave(at, alpha, true).abs() < 1e-3);
        }
    }
}

/// A steady shear from random positions: the flow stays ordered, particles stay apart, energy is conserved.
#[test]
fn steady_shear_keeps_its_order() {
    let n = 24;
    let domain = Domain::torus([1.0, 1.0]);
    let mut at = scattered(&domain, n * n, 100, 1).unwrap();
    let spacing = 1.0 / n as f64;
    let setting = setting([1.0, 1.0], n * n);
    let mut area = voronoi_area::<f64>::new(&setting, ()).unwrap();
    let mut m = vec![0.0; n * n];
    area.value(&at, &mut m).unwrap();
    let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, 2.0 * spacing)).unwrap();
    let mean = m.iter().sum::<f64>() / m.len() as f64;
    // The strength for the mean mass of a layer of depth 1.
    let strength = 0.1 / (n * n) as f64 / mean;
    let mut core = pair_core::<f64>::new(&setting, (&m, 0.7 * spacing, strength)).unwrap();
    let profile: Vec<f64> = at
        .iter()
        .map(|x| 0.1 * (core::f64::consts::TAU * x[1]).sin())
        .collect();
    let mut velocity: Vec<Plane> = profile.iter().map(|u| Plane::new(*u, 0.0)).collect();
    let seed: Vec<f64> = m.iter().map(|m| m / 2.0).collect();
    let (mut phi, mut near) = (vec![0.0; n * n], vec![0.0; n * n]);
    let (mut first, mut second) = (vec![Plane::zeros(); n * n], vec![Plane::zeros(); n * n]);
    let ones = vec![1.0; n * n];
    let mut products = 0;
    let mut push = |at: &[Plane], velocity: &mut [Plane], dt: f64| -> f64 {
        depth.value(at, &mut phi).unwrap();
        depth.pull_back(at, &seed, &mut first).unwrap();
        core.value(at, &mut near).unwrap();
        core.pull_back(at, &ones, &mut second).unwrap();
        products += depth.products().0;
        for (a, v) in velocity.iter_mut().enumerate() {
            *v -= (first[a] + second[a]) * (dt / m[a]);
        }
        (0..m.len()).map(|a| seed[a] * phi[a] + near[a]).sum()
    };
    let kinetic = |v: &[Plane]| -> f64 {
        v.iter()
            .zip(&m)
            .map(|(v, m)| m * v.norm_squared() / 2.0)
            .sum()
    };
    let coherent = |v: &[Plane]| -> f64 {
        let along = |f: &dyn Fn(usize) -> f64| -> f64 {
            (0..m.len()).map(|a| m[a] * profile[a] * f(a)).sum()
        };
        (along(&|a| v[a][0]) / along(&|a| profile[a])).powi(2)
    };
    let before = kinetic(&velocity);
    let dt = 0.2 * spacing;
    let steps = (1.0 / dt).round() as usize;
    let mut mesh = Voronoi::new(&domain, n * n).unwrap();
    let (mut first, mut spread, mut nearest) = (None, 0.0_f64, 1.0_f64);
    push(&at, &mut velocity, 0.5 * dt);
    // Each bound is slightly beyond the value for one seed; later, motions of different seeds diverge.
    for (from, until, kept) in [(0, 1, 0.997), (1, 2, 0.98), (2, 5, 0.85)] {
        for _ in from * steps..until * steps {
            for (x, v) in at.iter_mut().zip(&velocity) {
                *x += v * dt;
            }
            let potential = push(&at, &mut velocity, 0.5 * dt);
            let energy = kinetic(&velocity) + potential;
            spread = spread.max((energy - *first.get_or_insert(energy)).abs() / before);
            push(&at, &mut velocity, 0.5 * dt);
        }
        mesh.update(&at).unwrap();
        nearest = nearest.min(mesh.nearest().value / spacing);
        let order = coherent(&velocity);
        println!(
            "t = {until}: coherent {order}, energy {spread:e} of the kinetic, nearest {nearest}"
        );
        assert!(order >= kept, "{until}: {order}");
    }
    println!("{} products a step", products as f64 / (5 * steps) as f64);
    assert!(spread < 1e-4, "{spread:e}");
    assert!(nearest >= 0.45, "{nearest}");
}

/// The second-moment energy gives the fluid a shear stiffness: transverse waves.
#[test]
fn second_moments_resist_shear() {
    let domain = Domain::torus([1.0, 1.0]);
    let at = hexagonal(&domain, 24, Jitter::NONE);
    let k = core::f64::consts::TAU;
    let mut moment = second_moment::<f64>::new(&setting([1.0, 1.0], at.len()), ()).unwrap();
    let mut out = vec![0.0; at.len()];
    let mut gradient = vec![Plane::zeros(); at.len()];
    let moved: Vec<Plane> = at
        .iter()
        .map(|x| Plane::new(x[0], x[1] + 1e-5 * (k * x[0]).sin()))
        .collect();
    moment.value(&moved, &mut out).unwrap();
    // (chi g / dx^2)/2 for each particle.
    let seed = vec![0.05 * at.len() as f64; at.len()];
    moment.pull_back(&moved, &seed, &mut gradient).unwrap();
    let (mut work, mut norm) = (0.0, 0.0);
    for (x, g) in at.iter().zip(&gradient) {
        let wave = (k * x[0]).sin();
        work += g[1] * wave * at.len() as f64;
        norm += 1e-5 * wave * wave;
    }
    let speed = (work / norm).sqrt() / k;
    assert!((speed - 0.0704).abs() < 2e-4, "{speed}");
}

/// The number of threads does not change a bit of depths, derivatives and flips (with the feature `rayon`; otherwise there is one
/// thread).
#[test]
fn threads_change_no_bit() {
    let domain = Domain::torus([1.0, 1.0]);
    let n = 100;
    let start = lattice(&domain, [n, n], true, Jitter { size: 0.3, seed: 2 });
    let m = vec![1e-4; n * n];
    let setting = setting([1.0, 1.0], n * n);
    let run = |threads: usize| {
        let mut at = start.clone();
        let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, 0.02)).unwrap();
        depth.share(Threads(threads));
        let mut next = numbers(3);
        let (mut phi, mut force) = (vec![0.0; n * n], vec![Plane::zeros(); n * n]);
        for _ in 0..5 {
            for x in &mut at {
                *x += Plane::new(next() - 0.5, next() - 0.5) * 5e-4;
            }
            depth.value(&at, &mut phi).unwrap();
            depth.pull_back(&at, &m, &mut force).unwrap();
        }
        assert!(depth.mesh().counted().flips > 10);
        (phi, force, depth.products(), depth.mesh().counted())
    };
    let one = run(1);
    for threads in [2, 3, 5] {
        assert!(run(threads) == one, "{threads}");
    }
}

/// A new depth with restored data continues bit for bit; data that do not describe a mesh are rejected.
#[test]
fn a_resumed_mesh_goes_on_to_the_same_bits() {
    let at = bricks();
    let m = vec![1.0 / 144.0; 144];
    let setting = setting([1.0, 1.0], 144);
    let fresh = || helmholtz_depth::<f64>::new(&setting, (&m, 0.15)).unwrap();
    let mut next = numbers(3);
    let velocity: Vec<Plane> = at
        .iter()
        .map(|_| Plane::new(next() - 0.3, next() - 0.5))
        .collect();
    let place = |step: usize| -> Vec<Plane> {
        let time = 0.004 * step as f64;
        at.iter()
            .zip(&velocity)
            .map(|(x, v)| x + v * time)
            .collect()
    };
    let run = |depth: &mut helmholtz_depth<f64>, steps: core::ops::Range<usize>| {
        let (mut phi, mut force) = (vec![0.0; 144], vec![Plane::zeros(); 144]);
        for step in steps {
            depth.value(&place(step), &mut phi).unwrap();
            depth.pull_back(&place(step), &m, &mut force).unwrap();
        }
        (phi, force, depth.mesh().counted())
    };
    let mut whole = fresh();
    run(&mut whole, 0..200);
    let mut words = Words::gathered();
    whole.words(&mut words);
    let list = words.into_list().unwrap();
    let put = |list: Vec<u64>| {
        let mut resumed = fresh();
        let mut words = Words::given(list);
        resumed.words(&mut words);
        (words.all_put(), resumed)
    };
    // Repeats the last step, then makes further steps.
    for until in [200, 260] {
        let (fits, mut resumed) = put(list.clone());
        assert!(fits);
        let resumed = run(&mut resumed, 199..until);
        assert!(resumed == run(&mut whole.clone(), 199..until), "{until}");
        assert!(resumed.2.flips > 100, "{:?}", resumed.2);
    }
    for (place, word) in [(0, 6 * 144 - 6), (1, 900), (7, 3), (2, 5), (3, u64::MAX)] {
        let mut list = list.clone();
        list[place] = word;
        let (fits, mut resumed) = put(list);
        assert!(!fits, "{place}");
        // The depth works after a rejected restore.
        let mut phi = vec![0.0; 144];
        resumed.value(&at, &mut phi).unwrap();
    }
}

/// Every functional with particles that move by dual numbers; the smoothed depth with and without a second solution.
#[test]
fn second_derivatives_are_symmetric() {
    let jitter = Jitter { size: 0.3, seed: 8 };
    let at = lattice(&Domain::torus([1.0, 0.9]), [4, 4], true, jitter);
    let setting = setting([1.0, 0.9], 16);
    let mut next = numbers(12);
    let m: Vec<f64> = at.iter().map(|_| 0.5 + next()).collect();
    let duals: Vec<_> = m.iter().map(|m| Dual::<1>::constant(*m)).collect();
    let seed = seeds(16);
    let constant = Dual::<1>::constant;
    let mut area = voronoi_area::<f64>::new(&setting, ()).unwrap();
    let mut dual = voronoi_area::<Dual<1>>::new(&setting, ()).unwrap();
    second_derivatives(&mut area, &mut dual, &at, &seed, 1e-6);
    let mut moment = second_moment::<f64>::new(&setting, ()).unwrap();
    let mut dual = second_moment::<Dual<1>>::new(&setting, ()).unwrap();
    second_derivatives(&mut moment, &mut dual, &at, &seed, 1e-6);
    let mut core = pair_core::<f64>::new(&setting, (&m, 0.4, 2.0)).unwrap();
    let data = (&duals[..], constant(0.4), constant(2.0));
    let mut dual = pair_core::<Dual<1>>::new(&setting, data).unwrap();
    second_derivatives(&mut core, &mut dual, &at, &seed, 1e-6);
    let multiple: Vec<f64> = m.iter().map(|m| -0.37 * m).collect();
    for seed in [seed, multiple] {
        let mut depth = helmholtz_depth::<f64>::new(&setting, (&m, 0.2)).unwrap();
        let data = (&duals[..], constant(0.2));
        let mut dual = helmholtz_depth::<Dual<1>>::new(&setting, data).unwrap();
        // The residual of the iteration, divided by the difference step.
        second_derivatives(&mut depth, &mut dual, &at, &seed, 1e-6);
    }
}
