//! Mesh operators: gradient, divergence, curl, circulation, distances and boxes of a grid, tested by identities and by definitions.

use super::cut::cell;
use super::derivatives::{Plane, numbers, random};
use clebsch::mesh::placement::{Jitter, lattice};
use clebsch::mesh::{Domain, MeshError, Voronoi};
use core::f64::consts::TAU;

const UNIT: [f64; 2] = [1.0, 1.0];

fn mesh_of(lengths: [f64; 2], at: &[Plane]) -> Voronoi<f64> {
    let mut mesh = Voronoi::new(&Domain::torus(lengths), at.len()).unwrap();
    mesh.update(at).unwrap();
    mesh
}

fn bricks(n: usize, size: f64) -> Vec<Plane> {
    lattice(&Domain::torus(UNIT), [n, n], true, Jitter { size, seed: 5 })
}

fn areas_of(mesh: &Voronoi<f64>) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.sites()];
    mesh.areas(&mut areas).unwrap();
    areas
}

fn vectors(count: usize, seed: u64) -> Vec<Plane> {
    let mut next = numbers(seed);
    (0..count)
        .map(|_| Plane::new(next() - 0.5, next() - 0.5))
        .collect()
}

/// For linear functions, away from the periodic seam.
#[test]
fn gradient_and_curl_are_exact_of_linear_functions() {
    let at = bricks(16, 0.3);
    let mesh = mesh_of(UNIT, &at);
    let q: Vec<f64> = at.iter().map(|x| 2.0 * x[0] - 3.0 * x[1]).collect();
    let u: Vec<Plane> = at
        .iter()
        .map(|x| Plane::new(x[0] - 4.0 * x[1], 7.0 * x[0] + x[1]))
        .collect();
    let mut gradient = vec![Plane::zeros(); at.len()];
    let mut means = gradient.clone();
    let mut curl = vec![0.0; at.len()];
    let mut potential = curl.clone();
    mesh.gradient(&q, &mut gradient).unwrap();
    mesh.gradient_of_means(&q, &mut means).unwrap();
    mesh.curl(&u, &mut curl).unwrap();
    let (f, h) = (vec![5.0; at.len()], vec![2.0; at.len()]);
    mesh.potential_vorticity(&u, &f, &h, &mut potential)
        .unwrap();
    let (mut seen, mut worst) = (0, 0.0_f64);
    for (a, x) in at.iter().enumerate() {
        if x.iter().all(|x| (0.2..0.8).contains(x)) {
            assert!((gradient[a] - Plane::new(2.0, -3.0)).norm() < 1e-12);
            assert!((curl[a] - 11.0).abs() < 1e-12);
            assert!((potential[a] - 8.0).abs() < 1e-12);
            worst = worst.max((means[a] - Plane::new(2.0, -3.0)).norm());
            seen += 1;
        }
    }
    assert!(seen > 50);
    assert!(worst > 0.1, "{worst}");
}

/// Gradient and divergence are negative adjoints, and the divergence is the rate of change of areas.
#[test]
fn divergence_is_the_rate_of_areas() {
    let lengths = [1.2, 0.9];
    let at = random(lengths, 60, 2);
    let mesh = mesh_of(lengths, &at);
    let areas = areas_of(&mesh);
    let u = vectors(60, 3);
    let q: Vec<f64> = vectors(60, 4).iter().map(|v| v[0]).collect();
    let (mut divergence, mut of_means) = (vec![0.0; 60], vec![0.0; 60]);
    let (mut gradient, mut by_means) = (vec![Plane::zeros(); 60], vec![Plane::zeros(); 60]);
    mesh.divergence(&u, &mut divergence).unwrap();
    mesh.divergence_of_means(&u, &mut of_means).unwrap();
    mesh.gradient(&q, &mut gradient).unwrap();
    mesh.gradient_of_means(&q, &mut by_means).unwrap();
    for (d, g) in [(&divergence, &gradient), (&of_means, &by_means)] {
        let one: f64 = (0..60).map(|a| areas[a] * q[a] * d[a]).sum();
        let other: f64 = (0..60).map(|a| areas[a] * u[a].dot(&g[a])).sum();
        assert!((one + other).abs() < 1e-12, "{one} {other}");
    }
    let h = 1e-7;
    let moved = |h: f64| -> Vec<f64> {
        let at: Vec<Plane> = at.iter().zip(&u).map(|(x, u)| x + u * h).collect();
        areas_of(&mesh_of(lengths, &at))
    };
    let (above, below) = (moved(h), moved(-h));
    for a in 0..60 {
        let rate = (above[a] - below[a]) / (2.0 * h * areas[a]);
        assert!(
            (divergence[a] - rate).abs() < 1e-5 * (1.0 + rate.abs()),
            "{a}: {} {rate}",
            divergence[a]
        );
    }
}

/// Orders of accuracy on regular lattices and for irregular particles. For irregular particles, errors of the exact gradient
/// decrease with the spacing; errors of the mean-value gradient do not.
#[test]
fn orders_of_consistency() {
    let error = |n: usize, size: f64, of_means: bool| -> f64 {
        let at = bricks(n, size);
        let mesh = mesh_of(UNIT, &at);
        let q: Vec<f64> = at
            .iter()
            .map(|x| (TAU * x[0]).sin() * (TAU * x[1]).cos())
            .collect();
        let mut gradient = vec![Plane::zeros(); at.len()];
        if of_means {
            mesh.gradient_of_means(&q, &mut gradient).unwrap();
        } else {
            mesh.gradient(&q, &mut gradient).unwrap();
        }
        let (mut off, mut size) = (0.0, 0.0);
        for (x, g) in at.iter().zip(&gradient) {
            let (sx, cx) = (TAU * x[0]).sin_cos();
            let (sy, cy) = (TAU * x[1]).sin_cos();
            let exact = Plane::new(cx * cy, -sx * sy) * TAU;
            off += (g - exact).norm_squared();
            size += exact.norm_squared();
        }
        (off / size).sqrt()
    };
    for of_means in [false, true] {
        let order = (error(16, 0.0, of_means) / error(32, 0.0, of_means)).log2();
        assert!((order - 2.0).abs() < 0.1, "{of_means}: {order}");
    }
    let [exact, means] =
        [false, true].map(|of_means| [16, 32, 64].map(|n| error(n, 0.1, of_means)));
    println!("jitter 0.1: exact {exact:?}, means {means:?}");
    assert!((exact[1] / exact[2]).log2() > 0.8, "{exact:?}");
    assert!((means[1] / means[2]).log2() < 0.3, "{means:?}");
}

/// A common shallow-water operator, `-(1/(m A)) sum (m_a h_a + m_b h_b)/2 l n`, is not the force. It gives twice the force if the
/// masses follow the depth, a force at rest, and a nonzero total momentum; even for equal masses it is far from the exact force.
#[test]
fn the_operator_of_means_is_no_force_of_shallow_water() {
    let acceleration = |mesh: &Voronoi<f64>, m: &[f64], exact: bool| -> Vec<Plane> {
        let areas = areas_of(mesh);
        let count = m.len();
        let mut out = vec![Plane::zeros(); count];
        let depth = |a: usize| m[a] / areas[a];
        if exact {
            let q: Vec<f64> = (0..count).map(|a| 0.5 * depth(a) * depth(a)).collect();
            mesh.gradient(&q, &mut out).unwrap();
            (0..count).map(|a| -out[a] * (areas[a] / m[a])).collect()
        } else {
            let q: Vec<f64> = (0..count).map(|a| m[a] * depth(a)).collect();
            mesh.gradient_of_means(&q, &mut out).unwrap();
            (0..count).map(|a| -out[a] / m[a]).collect()
        }
    };
    let norm = |f: &[Plane]| f.iter().map(|f| f.norm_squared()).sum::<f64>().sqrt();
    let apart = |f: &[Plane], g: &[Plane]| -> f64 {
        let difference: Vec<Plane> = f.iter().zip(g).map(|(f, g)| f - g).collect();
        norm(&difference) / norm(g)
    };
    // A regular lattice with a varying depth.
    let at = bricks(32, 0.0);
    let mesh = mesh_of(UNIT, &at);
    let areas = areas_of(&mesh);
    let depth = |x: &Plane| 1.0 + 0.1 * (TAU * x[0]).sin();
    let m: Vec<f64> = at.iter().zip(&areas).map(|(x, a)| a * depth(x)).collect();
    let (exact, other) = (
        acceleration(&mesh, &m, true),
        acceleration(&mesh, &m, false),
    );
    let twice: Vec<Plane> = exact.iter().map(|f| f * 2.0).collect();
    assert!(apart(&other, &twice) < 0.05, "{}", apart(&other, &twice));
    // At rest on an irregular mesh.
    let at = bricks(16, 0.3);
    let mesh = mesh_of(UNIT, &at);
    let m = areas_of(&mesh);
    let sum = |f: &[Plane]| f.iter().zip(&m).map(|(f, m)| f * *m).sum::<Plane>().norm();
    let (exact, other) = (
        acceleration(&mesh, &m, true),
        acceleration(&mesh, &m, false),
    );
    assert!(
        norm(&exact) < 1e-11 && norm(&other) > 1.0,
        "{} {}",
        norm(&exact),
        norm(&other)
    );
    assert!(
        sum(&exact) < 1e-13 && sum(&other) > 1e-4,
        "{} {}",
        sum(&exact),
        sum(&other)
    );
    // Equal masses.
    let m = vec![1.0 / 256.0; 256];
    let (exact, other) = (
        acceleration(&mesh, &m, true),
        acceleration(&mesh, &m, false),
    );
    let off = apart(&other, &exact);
    println!("equal masses, jitter 0.3: {off} of the exact force");
    assert!(off > 0.2, "{off}");
}

/// Circulations around triangles sum to zero, and only accelerations change them.
#[test]
fn circulation_changes_by_acceleration_alone() {
    let at = bricks(8, 0.2);
    let mesh = mesh_of(UNIT, &at);
    let count = at.len();
    let (u, force) = (vectors(count, 6), vectors(count, 7));
    let triangles = 2 * count;
    let (mut circulation, mut rate) = (vec![0.0; triangles], vec![0.0; triangles]);
    mesh.circulations(&u, &mut circulation).unwrap();
    mesh.circulations(&force, &mut rate).unwrap();
    assert!(circulation.iter().sum::<f64>().abs() < 1e-13);
    let h = 1e-5;
    let later = |h: f64| -> Vec<f64> {
        let at: Vec<Plane> = (0..count).map(|a| at[a] + u[a] * h).collect();
        let u: Vec<Plane> = (0..count).map(|a| u[a] + force[a] * h).collect();
        // The same mesh after a displacement.
        let mut mesh = mesh.clone();
        mesh.update(&at).unwrap();
        assert_eq!(mesh.counted().flips, 0);
        let mut out = vec![0.0; triangles];
        mesh.circulations(&u, &mut out).unwrap();
        out
    };
    let (above, below) = (later(h), later(-h));
    for t in 0..triangles {
        let found = (above[t] - below[t]) / (2.0 * h);
        assert!((found - rate[t]).abs() < 1e-9, "{t}: {found} {}", rate[t]);
    }
    // The curl of a solid rotation, from triangles.
    let turning: Vec<Plane> = at
        .iter()
        .map(|x| Plane::new(-3.0 * x[1], 3.0 * x[0]))
        .collect();
    mesh.circulations(&turning, &mut circulation).unwrap();
    for (triangle, circulation) in mesh.triangles().zip(&circulation) {
        if triangle
            .sites
            .iter()
            .all(|&a| at[a].iter().all(|x| (0.2..0.8).contains(x)))
        {
            assert!((circulation - 3.0 * triangle.twice_area).abs() < 1e-13);
        }
    }
}

/// The two closest of all copies.
#[test]
fn the_nearest_are_neighbours() {
    for count in [1, 2, 3, 10, 200] {
        let lengths = [1.0, 0.6];
        let at = random(lengths, count, 31);
        let found = mesh_of(lengths, &at).nearest();
        let mut nearest = 0.6_f64;
        for a in 0..count {
            for b in 0..a {
                let apart = at[a] - at[b];
                let apart =
                    Plane::from_fn(|k, _| apart[k] - (apart[k] / lengths[k]).round() * lengths[k]);
                nearest = nearest.min(apart.norm());
            }
        }
        assert!(
            (found.value - nearest).abs() < 1e-14,
            "{count}: {} {nearest}",
            found.value
        );
        let rate = mesh_of(lengths, &at).fastest(&vec![2.0; count]).unwrap();
        assert!((rate.value * nearest - 2.0).abs() < 1e-11);
    }
}

/// Polygons equal the cells, and the boxes receive all of their mass.
#[test]
fn boxes_get_the_mass_of_cells() {
    for (count, grid) in [
        (1, [3, 2]),
        (2, [1, 1]),
        (5, [4, 7]),
        (50, [3, 3]),
        (50, [30, 20]),
    ] {
        let lengths = [1.3, 0.8];
        let at = random(lengths, count, 17);
        let mesh = mesh_of(lengths, &at);
        mesh.polygons(|site, corners| {
            let own = cell(lengths, &at, site);
            let turned = |k: usize| corners[k % corners.len()];
            let twice: f64 = (0..corners.len())
                .map(|k| turned(k)[0] * turned(k + 1)[1] - turned(k)[1] * turned(k + 1)[0])
                .sum();
            assert!((0.5 * twice - own.area).abs() < 1e-11);
            for corner in &own.corners {
                let near = corners
                    .iter()
                    .map(|c| (c - corner).norm())
                    .fold(1.0, f64::min);
                assert!(near < 1e-9, "{count} {site}: {near}");
            }
        });
        let boxes = grid[0] * grid[1];
        let mut out = vec![0.0; boxes];
        // A depth of 1.
        mesh.rezone(&areas_of(&mesh), grid, &mut out).unwrap();
        let each = 1.3 * 0.8 / boxes as f64;
        assert!(
            out.iter().all(|x| (x - each).abs() < 1e-12),
            "{count} {grid:?} {out:?}"
        );
        // A depth per cell: the mass of each box by many sample points.
        let mut next = numbers(2);
        let depth: Vec<f64> = (0..count).map(|_| 0.5 + next()).collect();
        let m: Vec<f64> = areas_of(&mesh)
            .iter()
            .zip(&depth)
            .map(|(a, h)| a * h)
            .collect();
        mesh.rezone(&m, grid, &mut out).unwrap();
        let (sum, whole): (f64, f64) = (out.iter().sum(), m.iter().sum());
        assert!(
            (sum / whole - 1.0).abs() < 1e-14 * boxes as f64,
            "{sum} {whole}"
        );
        for (k, found) in out.iter().enumerate().step_by(7) {
            let points = 60_u32;
            let mut mean = 0.0;
            for p in (0..points * points).map(f64::from) {
                let side = f64::from(points);
                let x = (p % side + 0.5) / side + (k % grid[0]) as f64;
                let y = ((p / side).floor() + 0.5) / side + (k / grid[0]) as f64;
                let x = Plane::new(x * 1.3 / grid[0] as f64, y * 0.8 / grid[1] as f64);
                let distance = |a: &usize| {
                    let apart = at[*a] - x;
                    Plane::from_fn(|k, _| apart[k] - (apart[k] / lengths[k]).round() * lengths[k])
                        .norm()
                };
                let nearest = (0..count)
                    .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                    .unwrap();
                mean += depth[nearest] / f64::from(points * points);
            }
            assert!(
                (found / each - mean).abs() < 0.02,
                "{count} {grid:?} {k}: {} {mean}",
                found / each
            );
        }
    }
    let mesh = mesh_of(UNIT, &bricks(4, 0.1));
    let refused = mesh.rezone(&[1.0; 16], [2, 2], &mut [0.0; 5]);
    assert_eq!(refused, Err(MeshError::Count { given: 5, sites: 4 }));
}
