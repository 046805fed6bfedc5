//! Deposit against explicit images of particles, and the mass on the grid.

use super::common::*;
use clebsch::Dual;
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

/// The splines of a node at a particle and at all of its images, divided by the spacing.
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
        // Coordinates several periods away have lost two bits, which slopes of size 1 / spacing amplify.
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
    // One rounding error of random sign for each of 16 or 36 spline values per particle.
    assert!(
        (on_grid / whole - 1.0).abs() < 1e-15,
        "{}",
        on_grid / whole - 1.0
    );
    // The splines are nonnegative, and so is the depth.
    assert!(found.iter().all(|h| *h >= 0.0));
}

#[test]
fn depth_is_that_of_particles_and_their_images() {
    for domain in lines() {
        // Includes grids narrower than a spline.
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
        // Exact for x y between walls; in a periodic direction, for functions that vanish at its ends.
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
    // A position many periods away is equivalent to one inside.
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

/// Values and derivatives with this number of threads.
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

/// A function that interpolates nodal values.
type Interpolate<F, T> = fn(&mut F, &[T], &mut [T]) -> Result<(), MeshError>;

/// Compares nodal values at particles with explicit splines, derivatives by dual numbers with the pull-back of weighted values, and
/// their sum over masses with the sum over nodes.
fn interpolated<const D: usize, A, B, F, G>(
    of: &Setting<D>,
    own: Interpolate<F, f64>,
    twin: Interpolate<G, Dual<1>>,
    p: usize,
) where
    A: Field<f64, D> + Send + Sync,
    B: Field<Dual<1>, D> + Send + Sync,
    F: for<'a> Functional<f64, D, Argument = A, Data<'a> = (&'a [f64],)>,
    G: for<'a> Functional<Dual<1>, D, Argument = B, Data<'a> = (&'a [Dual<1>],)>,
{
    let at = places(of, 7);
    let mass: Vec<f64> = Numbers::new(3).list(of.particles);
    let nodes = Nodes::new(of).expect("a grid");
    let weights = nodes.weights::<f64>();
    let nodal = Numbers::new(4).list(nodes.count());
    let mut deposit = F::new(of, (&mass,)).expect("a grid");
    let fields: Vec<A> = at.iter().map(|x| A::of(*x)).collect();
    let on_grid = values(&mut deposit, &fields);
    let mut found = vec![0.0; at.len()];
    own(&mut deposit, &nodal, &mut found).expect("as many");
    for (x, found) in at.iter().zip(&found) {
        let one = |(i, s): (usize, &f64)| {
            let index = nodes.indices(i);
            let factor = |d: usize| {
                let (length, wall) = (of.domain.lengths[d], of.domain.walls[d]);
                let cells = of.grid.expect("a grid")[d];
                along(p, length, cells, wall, index[d] as f64, x[d])
            };
            s * weights[i] * (0..D).map(factor).product::<f64>()
        };
        let expected: f64 = nodal.iter().enumerate().map(one).sum();
        // As above, for a mean of numbers up to 1.
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    let at_particles = sum(found.iter().zip(&mass).map(|(s, m)| s * m));
    let at_nodes = on_grid.iter().zip(&nodal).zip(&weights);
    let at_nodes = sum(at_nodes.map(|((h, s), w)| h * s * w));
    assert!((at_particles / at_nodes - 1.0).abs() < 1e-14);
    let seed: Vec<f64> = nodal.iter().zip(&weights).map(|(s, w)| s * w).collect();
    let mut slopes = vec![A::of([0.0; D]); at.len()];
    deposit
        .pull_back(&fields, &seed, &mut slopes)
        .expect("a gradient");
    // For numbers up to 1, one cell apart. In a periodic direction, a grid of one cell has zero slope.
    let cells = of.grid.expect("a grid");
    let scale = largest((0..D).map(|d| cells[d] as f64 / of.domain.lengths[d]));
    let wide = vec![Dual::constant(1.0); at.len()];
    let nodal: Vec<_> = nodal.iter().map(|s| Dual::constant(*s)).collect();
    let mut moved = G::new(of, (&wide,)).expect("a grid");
    for d in 0..D {
        let places = at.iter().map(|x| {
            let mut x = x.map(Dual::constant);
            x[d].dual = [1.0];
            B::of(x)
        });
        values(&mut moved, &places.collect::<Vec<_>>());
        let mut out = vec![Dual::constant(0.0); at.len()];
        twin(&mut moved, &nodal, &mut out).expect("as many");
        for ((found, m), slope) in out.iter().zip(&mass).zip(&slopes) {
            let off = (found.dual[0] * m - slope.parts()[d]).abs() / scale;
            assert!(off < 1e-14, "{off:e}");
        }
    }
    assert!(own(&mut deposit, &[], &mut found).is_err());
}

#[test]
fn what_stands_at_nodes_is_interpolated_by_the_same_splines() {
    type Twin = Dual<1>;
    type Place<T> = SVector<T, 2>;
    for domain in lines() {
        for cells in [1, 3, 24] {
            let of = setting(domain, [cells], 60);
            type Cubic<T> = deposit<T, 1>;
            type Quintic<T> = deposit_quintic<T, 1>;
            let (own, twin) = (Cubic::<f64>::interpolate, Cubic::<Twin>::interpolate);
            interpolated::<1, f64, Twin, Cubic<f64>, Cubic<Twin>>(&of, own, twin, 3);
            let (own, twin) = (Quintic::<f64>::interpolate, Quintic::<Twin>::interpolate);
            interpolated::<1, f64, Twin, Quintic<f64>, Quintic<Twin>>(&of, own, twin, 5);
        }
    }
    for domain in planes() {
        for grid in [[1, 2], [9, 4], [20, 13]] {
            let of = setting(domain, grid, 100);
            type Cubic<T> = deposit<T, 2>;
            type Quintic<T> = deposit_quintic<T, 2>;
            let (own, twin) = (Cubic::<f64>::interpolate, Cubic::<Twin>::interpolate);
            interpolated::<2, Place<f64>, Place<Twin>, Cubic<f64>, Cubic<Twin>>(&of, own, twin, 3);
            let (own, twin) = (Quintic::<f64>::interpolate, Quintic::<Twin>::interpolate);
            interpolated::<2, Place<f64>, Place<Twin>, Quintic<f64>, Quintic<Twin>>(
                &of, own, twin, 5,
            );
        }
    }
}
