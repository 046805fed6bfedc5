//! Deposit against images of particles that are written out, and the mass on the grid.

use crate::common::*;
use clebsch::line::Threads;
use clebsch::mesh::*;
use clebsch::nalgebra::SVector;

/// The B-spline of degree `p`, by the recursion of Cox and de Boor.
pub fn spline(p: usize, x: f64) -> f64 {
    if p == 0 {
        return f64::from((-0.5..0.5).contains(&x));
    }
    let half = (p as f64 + 1.0) / 2.0;
    if x.abs() >= half {
        return 0.0;
    }
    ((half + x) * spline(p - 1, x + 0.5) + (half - x) * spline(p - 1, x - 0.5)) / p as f64
}

/// The splines of a node at a particle and at all of its images, over the spacing.
fn along(p: usize, length: f64, cells: usize, wall: Wall, node: f64, x: f64) -> f64 {
    let spacing = length / cells as f64;
    let near = |image: f64| spline(p, image / spacing - node) / spacing;
    let far = -12..=12;
    far.map(|k| match wall {
        Wall::Periodic => near(x + f64::from(k) * length),
        Wall::Solid => {
            let shift = 2.0 * f64::from(k) * length;
            near(x + shift) + near(shift - x)
        }
    })
    .sum()
}

fn compare<const D: usize, F, A: Field<f64, D> + Send + Sync>(p: usize, of: &Setting<D>)
where
    F: for<'a> Functional<f64, D, Argument = A, Data<'a> = (&'a [f64],)>,
{
    let at = places(of, 7);
    let mass: Vec<f64> = Numbers::new(3).list(of.particles);
    let nodes = Nodes::new(of).expect("a grid");
    let mut deposit = F::new(of, (&mass,)).expect("a grid");
    let fields: Vec<A> = at.iter().map(|x| A::of(*x)).collect();
    let found = values(&mut deposit, &fields);
    assert_eq!(found.len(), nodes.count());
    for (i, found) in found.iter().enumerate() {
        let index = nodes.indices(i);
        let one = |(x, m): (&[f64; D], &f64)| {
            let factor = |d: usize| {
                let (length, wall) = (of.domain.lengths[d], of.domain.walls[d]);
                let cells = of.grid.expect("a grid")[d];
                along(p, length, cells, wall, index[d] as f64, x[d])
            };
            m * (0..D).map(factor).product::<f64>()
        };
        let expected: f64 = at.iter().zip(&mass).map(one).sum();
        // Coordinates some periods away have lost two bits, which slopes of 1 / spacing multiply.
        let scale = at.len() as f64 / of.domain.measure();
        assert!(
            (found - expected).abs() < 1e-13 * scale,
            "{:?} {:?} node {i}: {found} {expected}",
            of.domain,
            of.grid
        );
    }
    let weights = nodes.weights::<f64>();
    let on_grid = sum(found.iter().zip(&weights).map(|(h, w)| h * w));
    let whole = sum(mass.iter().copied());
    // The errors of one rounding each, of random sign, of 16 or 36 values of splines per particle.
    assert!(
        (on_grid / whole - 1.0).abs() < 1e-15,
        "{}",
        on_grid / whole - 1.0
    );
    // Every value of the splines is positive, and so is the depth.
    assert!(found.iter().all(|h| *h >= 0.0));
}

#[test]
fn depth_is_that_of_particles_and_their_images() {
    for domain in lines() {
        // Also grids that are narrower than a spline.
        for cells in [1, 2, 3, 5, 24] {
            let of = setting(domain, [cells], 200);
            compare::<1, deposit<f64, 1>, f64>(3, &of);
            compare::<1, deposit_quintic<f64, 1>, f64>(5, &of);
        }
    }
    for domain in planes() {
        for grid in [[1, 2], [3, 1], [2, 7], [9, 4], [20, 13]] {
            let of = setting(domain, grid, 300);
            compare::<2, deposit<f64, 2>, SVector<f64, 2>>(3, &of);
            compare::<2, deposit_quintic<f64, 2>, SVector<f64, 2>>(5, &of);
        }
    }
}

#[test]
fn weights_are_those_of_the_trapezoid_rule() {
    for domain in planes() {
        let of = setting(domain, [6, 8], 0);
        let nodes = Nodes::new(&of).expect("a grid");
        let (weights, places) = (nodes.weights::<f64>(), nodes.places());
        assert!((sum(weights.iter().copied()) / domain.measure() - 1.0).abs() < 1e-15);
        // Exact for x y wherever it is between walls; around a period, for what vanishes at its ends.
        let halves = |d: usize, x: f64| match domain.walls[d] {
            Wall::Solid => x,
            Wall::Periodic => (core::f64::consts::PI * x / domain.lengths[d])
                .sin()
                .powi(2),
        };
        let found = sum(weights
            .iter()
            .zip(&places)
            .map(|(w, x)| w * halves(0, x[0]) * halves(1, x[1])));
        let exact = |d: usize| match domain.walls[d] {
            Wall::Solid => domain.lengths[d].powi(2) / 2.0,
            Wall::Periodic => domain.lengths[d] / 2.0,
        };
        assert!((found / (exact(0) * exact(1)) - 1.0).abs() < 1e-15);
    }
}

#[test]
fn what_cannot_be_deposited_is_an_error_with_the_particle() {
    let of = setting(Domain::channel([1.0, 1.0]), [10, 10], 3);
    let mut deposit = deposit::<f64, 2>::new(&of, (&[1.0; 3],)).expect("a grid");
    let inside = SVector::<f64, 2>::new(0.5, 0.5);
    let mut out = vec![0.0; deposit.sites()];
    for (x, expected) in [
        ([f64::NAN, 0.5], MeshError::NotFinite { site: 1 }),
        ([0.5, f64::INFINITY], MeshError::NotFinite { site: 1 }),
        ([-0.25, 0.5], MeshError::Outside { site: 1, by: 0.25 }),
        ([1.25, 0.5], MeshError::Outside { site: 1, by: 0.25 }),
    ] {
        let at = [inside, SVector::from(x), inside];
        assert_eq!(deposit.value(&at, &mut out), Err(expected));
    }
    // Far away around the period is a place like others.
    for far in [1e9, -1e9, 1e300, -1e300] {
        let at = [inside, SVector::from([0.5, far]), inside];
        assert_eq!(deposit.value(&at, &mut out), Ok(()));
    }
    let few = deposit.value(&[inside; 2], &mut out);
    assert_eq!(few, Err(MeshError::Count { given: 2, sites: 3 }));
    let no_grid = Setting {
        grid: None,
        ..of.clone()
    };
    assert!(clebsch::mesh::deposit::<f64, 2>::new(&no_grid, (&[1.0; 3],)).is_err());
    assert!(clebsch::mesh::deposit::<f64, 2>::new(&of, (&[1.0; 2],)).is_err());
    assert!(clebsch::mesh::deposit::<f64, 2>::new(&of, (&[1.0, f64::NAN, 1.0],)).is_err());
    let narrow = setting(Domain::basin([1.0, 0.0]), [10, 10], 3);
    assert!(clebsch::mesh::deposit::<f64, 2>::new(&narrow, (&[1.0; 3],)).is_err());
    let empty = setting(Domain::basin([1.0, 1.0]), [10, 0], 3);
    assert!(clebsch::mesh::deposit::<f64, 2>::new(&empty, (&[1.0; 3],)).is_err());
}

/// Values and derivatives with so many threads.
fn shared(threads: usize, of: &Setting<2>, at: &[SVector<f64, 2>], mass: &[f64]) -> Vec<f64> {
    let mut deposit = deposit::<f64, 2>::new(of, (mass,)).expect("a grid");
    deposit.share(Threads(threads));
    let mut found = values(&mut deposit, at);
    let mut forces = vec![SVector::zeros(); at.len()];
    let seed = found.clone();
    deposit
        .pull_back(at, &seed, &mut forces)
        .expect("a gradient");
    found.extend(forces.iter().flat_map(|f| [f[0], f[1]]));
    found
}

#[test]
fn threads_change_no_bit() {
    // More rows than two stripes, and more particles than one thread sorts at a time.
    for domain in planes() {
        let of = setting(domain, [37, 20], 70_000);
        let at: Vec<_> = places(&of, 5).into_iter().map(SVector::from).collect();
        let mass = Numbers::new(6).list(of.particles);
        let one = shared(1, &of, &at, &mass);
        for threads in [2, 3, 5, 8, 1000] {
            assert!(one == shared(threads, &of, &at, &mass), "{threads} threads");
        }
    }
}
