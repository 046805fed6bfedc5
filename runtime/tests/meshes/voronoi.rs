//! Voronoi cells on the periodic plane, against independent formulas: cells cut out of half planes, differences of areas and
//! moments, known potentials.

use super::cut::cell;
use super::derivatives::{
    Plane, against_differences, against_duals, numbers, random, seeds, setting,
};
use clebsch::mesh::placement::{Jitter, hexagonal, lattice, scattered};
use clebsch::mesh::{Domain, Functional, MeshError, Setting, Voronoi, second_moment, voronoi_area};
use clebsch::{Dual, Real};

fn areas_of(lengths: [f64; 2], at: &[Plane]) -> Result<Vec<f64>, MeshError> {
    let mut area = voronoi_area::<f64>::new(&setting(lengths, at.len()), ()).unwrap();
    let mut out = vec![0.0; at.len()];
    area.value(at, &mut out)?;
    Ok(out)
}

/// Between 1 and 60 particles, by mesh and by cutting: areas, centres of mass, moments, and the sum of areas.
#[test]
fn cells_are_those_cut_out_of_half_planes() {
    for count in (1..=20).chain([33, 60]) {
        for seed in 0..6 {
            let lengths = [[1.0, 1.0], [3.0, 0.7], [0.2, 2.5]][seed as usize % 3];
            let at = random(lengths, count, seed);
            let mut mesh = Voronoi::<f64>::new(&Domain::torus(lengths), count).unwrap();
            mesh.update(&at).unwrap();
            // A new mesh needs no flips.
            assert_eq!(mesh.counted().flips, 0);
            let mut areas = vec![0.0; count];
            let mut centres = vec![Plane::zeros(); count];
            let mut moments = vec![0.0; count];
            mesh.areas(&mut areas).unwrap();
            mesh.centroids(&areas, &mut centres).unwrap();
            mesh.second_moments(&mut moments).unwrap();
            let whole = lengths[0] * lengths[1];
            let sum: f64 = areas.iter().sum();
            assert!((sum / whole - 1.0).abs() < 1e-13, "{count} {seed}: {sum}");
            let size = lengths[0].max(lengths[1]);
            for a in 0..count {
                let own = cell(lengths, &at, a);
                // Rounding, and the circumcentres of flat triangles.
                let near = |x: f64, y: f64, scale: f64| (x - y).abs() < 1e-10 * scale;
                assert!(
                    near(areas[a], own.area, whole),
                    "{count} {seed} {a}: {} {}",
                    areas[a],
                    own.area
                );
                assert!(
                    near(moments[a], own.moment, whole * size * size),
                    "{count} {seed} {a}"
                );
                let off = (centres[a] * areas[a] - own.first).norm();
                assert!(near(off, 0.0, whole * size), "{count} {seed} {a}: {off}");
            }
        }
    }
}

/// Lattices, where every in-circle test is a tie, have equal areas.
#[test]
fn lattices_have_equal_cells() {
    for n in 1..12 {
        for shifted in [false, true] {
            let rows = if shifted { 2 * n } else { n };
            let at = lattice(&Domain::torus([1.0, 1.0]), [n, rows], shifted, Jitter::NONE);
            for area in areas_of([1.0, 1.0], &at).unwrap() {
                assert!(
                    (area * at.len() as f64 - 1.0).abs() < 1e-12,
                    "{n} {shifted} {area}"
                );
            }
        }
    }
}

/// An updated mesh equals a new one: areas agree for particles that move independently for many steps, across the seams and many
/// periods away.
#[test]
fn flips_and_making_anew_give_the_same_cells() {
    let lengths = [1.0, 0.8];
    for (count, step) in [(3, 0.02), (7, 0.02), (400, 0.004), (400, 0.05)] {
        let mut at = random(lengths, count, 5);
        let mut next = numbers(9);
        let velocity: Vec<Plane> = (0..count)
            .map(|_| Plane::new(next() - 0.3, next() - 0.3))
            .collect();
        let mut followed = voronoi_area::<f64>::new(&setting(lengths, count), ()).unwrap();
        let mut out = vec![0.0; count];
        for k in 0..400 {
            for (x, v) in at.iter_mut().zip(&velocity) {
                *x += v * step;
            }
            followed.value(&at, &mut out).unwrap();
            let sum: f64 = out.iter().sum();
            // Positions several periods away.
            assert!((sum / 0.8 - 1.0).abs() < 2e-13, "{count} {step} {k}: {sum}");
            if k % 10 == 0 {
                let anew = areas_of(lengths, &at).unwrap();
                for (a, b) in out.iter().zip(&anew) {
                    assert!((a - b).abs() < 1e-11, "{count} {step} {k}: {a} {b}");
                }
            }
        }
        let counted = followed.mesh().counted();
        println!("{count} particles, {step}: {counted:?}");
        // Large steps invert triangles.
        assert_eq!(counted.flips > 0, step < 0.05, "{counted:?}");
    }
}

/// Rows of a lattice slide past each other by exact fractions of their distance, so that every in-circle test is repeatedly a tie.
/// Cells equal those of a new mesh, and areas are equal if the rows form a lattice.
#[test]
fn rows_slide_through_ties() {
    let n = 8;
    let mut at = lattice(&Domain::torus([1.0, 1.0]), [n, n], false, Jitter::NONE);
    let mut followed = voronoi_area::<f64>::new(&setting([1.0, 1.0], n * n), ()).unwrap();
    let mut out = vec![0.0; n * n];
    for step in 0..=128 {
        followed.value(&at, &mut out).unwrap();
        let anew = areas_of([1.0, 1.0], &at).unwrap();
        for (a, area) in out.iter().enumerate() {
            assert!((area - anew[a]).abs() < 1e-14);
            // Every row has the same shift to both neighbours.
            assert!((area - 1.0 / 64.0).abs() < 1e-14, "{step} {a}: {area}");
        }
        for (k, x) in at.iter_mut().enumerate() {
            x[0] += if (k / n) % 2 == 0 {
                1.0 / 64.0
            } else {
                -1.0 / 64.0
            };
        }
    }
    let counted = followed.mesh().counted();
    assert!(counted.flips > 500 && counted.rebuilds == 1, "{counted:?}");
}

/// Degenerate positions are an error that names the particles, and the mesh continues to work.
#[test]
fn degenerate_places_are_refused() {
    let mut area = voronoi_area::<f64>::new(&setting([1.0, 1.0], 4), ()).unwrap();
    let good = [[0.1, 0.1], [0.6, 0.2], [0.4, 0.7], [0.9, 0.8]].map(Plane::from);
    let mut out = [0.0; 4];
    area.value(&good, &mut out).unwrap();
    let before = out;
    for other in [[0.6, 0.2], [-0.4, 3.2], [0.6 + 1e-16, 0.2]] {
        let mut bad = good;
        bad[3] = Plane::from(other);
        let refused = area.value(&bad, &mut out).unwrap_err();
        assert_eq!(
            refused,
            MeshError::Coincident {
                first: 1,
                second: 3
            }
        );
        area.value(&good, &mut out).unwrap();
        assert_eq!(out, before);
    }
    for bad in [f64::NAN, f64::INFINITY, 1e300, -1e18] {
        let mut at = good;
        at[2][1] = bad;
        let refused = area.value(&at, &mut out).unwrap_err();
        let expected = if bad.abs() < f64::MAX {
            let periods = bad.abs();
            MeshError::TooFar { site: 2, periods }
        } else {
            MeshError::NotFinite { site: 2 }
        };
        assert_eq!(refused, expected);
        area.value(&good, &mut out).unwrap();
        assert_eq!(out, before);
    }
    let refused = area.value(&good[..3], &mut out).unwrap_err();
    assert_eq!(refused, MeshError::Count { given: 3, sites: 4 });
    for lengths in [
        [0.0, 1.0],
        [1.0, -2.0],
        [f64::NAN, 1.0],
        [1.0, f64::INFINITY],
        [1.0, 1e-9],
    ] {
        assert!(voronoi_area::<f64>::new(&setting(lengths, 4), ()).is_err());
    }
    assert!(voronoi_area::<f64>::new(&setting([1.0, 1.0], 0), ()).is_err());
    let basin = Setting {
        domain: Domain::basin([1.0, 1.0]),
        grid: None,
        particles: 4,
    };
    assert!(voronoi_area::<f64>::new(&basin, ()).is_err());
}

/// Sites on few lines, all collinear, on a circle, or in clusters: the mesh terminates without panic, with the right sum.
#[test]
fn special_positions_are_meshed() {
    let mut next = numbers(3);
    let mut sets: Vec<Vec<Plane>> = Vec::new();
    for count in [2, 3, 5, 16, 100] {
        let n = count as f64;
        sets.push((0..count).map(|i| Plane::new(i as f64 / n, 0.25)).collect());
        sets.push(
            (0..count)
                .map(|i| Plane::new(i as f64 / n, i as f64 / n))
                .collect(),
        );
        let turn = core::f64::consts::TAU / n;
        sets.push(
            (0..count)
                .map(|i| {
                    Plane::new(
                        0.5 + 0.25 * (turn * i as f64).cos(),
                        0.5 + 0.25 * (turn * i as f64).sin(),
                    )
                })
                .collect(),
        );
        sets.push(
            (0..count)
                .map(|_| Plane::new(0.5 + 1e-9 * next(), 0.5 + 1e-9 * next()))
                .collect(),
        );
        sets.push(
            (0..count)
                .map(|_| {
                    Plane::new(
                        (8.0 * next()).floor() / 8.0 + 1e-13 * next(),
                        (8.0 * next()).floor() / 8.0,
                    )
                })
                .collect(),
        );
    }
    for (k, at) in sets.iter().enumerate() {
        match areas_of([1.0, 1.0], at) {
            Ok(areas) => {
                let sum: f64 = areas.iter().sum();
                // Clusters have a size of 1e-13 of the domain, and circumcentres far away.
                assert!((sum - 1.0).abs() < 1e-13, "set {k}: {sum}");
                assert!(areas.iter().all(|a| a.is_finite()), "set {k}");
            }
            Err(MeshError::Coincident { first, second }) => {
                let apart = at[first] - at[second];
                let apart = apart.map(|x| x - x.round());
                assert!(apart.norm() < 1e-14, "set {k}: {first} {second}");
            }
            Err(MeshError::Flat { sites }) => {
                // Edges of at most one billionth of the domain.
                let [a, b, c] = sites.map(|site| at[site]);
                let shortest = [a - b, b - c, c - a].map(|x| x.map(|x| x - x.round()).norm());
                assert!(shortest.iter().any(|x| *x < 1e-8), "set {k}: {shortest:?}");
            }
            Err(other) => panic!("set {k}: {other}"),
        }
    }
}

#[test]
fn areas_pull_back() {
    for (count, lengths) in [(3, [1.0, 1.3]), (5, [1.0, 1.0]), (40, [1.2, 0.9])] {
        let at = random(lengths, count, 21);
        let setting = setting(lengths, count);
        let mut area = voronoi_area::<f64>::new(&setting, ()).unwrap();
        against_differences(&mut area, &at, &seeds(count), 5e-6, 1e-8);
        let mut dual = voronoi_area::<Dual<1>>::new(&setting, ()).unwrap();
        against_duals(&mut area, &mut dual, &at, &seeds(count));
    }
}

#[test]
fn second_moments_pull_back() {
    for (count, lengths) in [(2, [1.0, 1.3]), (5, [1.0, 1.0]), (40, [1.2, 0.9])] {
        let at = random(lengths, count, 21);
        let setting = setting(lengths, count);
        let mut moment = second_moment::<f64>::new(&setting, ()).unwrap();
        against_differences(&mut moment, &at, &seeds(count), 5e-6, 1e-8);
        let mut dual = second_moment::<Dual<1>>::new(&setting, ()).unwrap();
        against_duals(&mut moment, &mut dual, &at, &seeds(count));
    }
}

/// Half of `sum m^2/A`, and the second-moment term, on bricks: known to twelve digits.
#[test]
fn potentials_are_the_known_ones() {
    let domain = Domain::torus([1.0, 1.0]);
    let at = lattice(&domain, [12, 12], true, Jitter { size: 0.3, seed: 1 });
    let m = 1.0 / 144.0;
    let areas = areas_of([1.0, 1.0], &at).unwrap();
    let bare: f64 = areas.iter().map(|a| m * m / a / 2.0).sum();
    assert!((bare - 0.512_531_582_646).abs() < 1e-12, "{bare}");
    let mut moment = second_moment::<f64>::new(&setting([1.0, 1.0], 144), ()).unwrap();
    let mut out = vec![0.0; 144];
    moment.value(&at, &mut out).unwrap();
    let stiff = bare + 0.5 * 0.3 * 144.0 * out.iter().sum::<f64>();
    assert!((stiff - 0.540_546_384_102).abs() < 1e-12, "{stiff}");
}

/// Initial positions: the requested number of particles, and nearly equal cells after relaxation.
#[test]
fn starts_are_even() {
    let domain = Domain::torus([1.0, 1.0]);
    assert_eq!(hexagonal(&domain, 24, Jitter::NONE).len(), 24 * 28);
    let at = scattered(&domain, 256, 100, 1).unwrap();
    let areas = areas_of([1.0, 1.0], &at).unwrap();
    let spread = areas.iter().map(|a| (a * 256.0 - 1.0).powi(2)).sum::<f64>() / 256.0;
    assert!(spread.sqrt() < 0.1, "{}", spread.sqrt());
    assert!(at[0].iter().all(|x| x.value().is_finite()));
}
