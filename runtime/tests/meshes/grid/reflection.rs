//! Reflection of particles that cross walls.

use super::common::*;
use clebsch::mesh::*;
use clebsch::nalgebra::SVector;
use clebsch::{Dual, Real};

#[test]
fn a_particle_beyond_a_wall_is_put_back_and_turned() {
    let domain = Domain::channel([2.0, 1.0]);
    let cell = [0.1, 0.1];
    for (x, u, to, turned, count) in [
        ([-0.05, 3.5], [-1.0, 2.0], [0.05, 3.5], [1.0, 2.0], 1),
        ([2.0625, -1.0], [1.0, 2.0], [1.9375, -1.0], [-1.0, 2.0], 1),
        ([0.0, 0.5], [-1.0, 2.0], [0.0, 0.5], [-1.0, 2.0], 0),
        ([1.0, 0.5], [-1.0, 2.0], [1.0, 0.5], [-1.0, 2.0], 0),
    ] {
        let (mut x, mut u) = (x, u);
        assert_eq!(domain.reflect(4, &cell, &mut x, &mut u), Ok(count));
        assert_eq!((x, u), (to, turned));
    }
    let (mut x, mut u) = ([-0.03, 1.01], [-1.0, 2.0]);
    let both = Domain::basin([2.0, 1.0]).reflect(0, &cell, &mut x, &mut u);
    assert_eq!((both, u), (Ok(2), [1.0, -2.0]));
}

#[test]
fn too_far_is_an_error_that_leaves_the_particle() {
    let domain = Domain::basin([2.0, 1.0]);
    let cell = [0.125, 0.25];
    for (x, expected) in [
        ([-0.25, 0.5], MeshError::Outside { site: 4, by: 0.25 }),
        ([-0.0625, 1.5], MeshError::Outside { site: 4, by: 0.5 }),
        ([f64::NAN, 0.5], MeshError::NotFinite { site: 4 }),
    ] {
        let (mut y, mut u) = (x, [1.0, 2.0]);
        assert_eq!(domain.reflect(4, &cell, &mut y, &mut u), Err(expected));
        assert_eq!(u, [1.0, 2.0]);
        assert_eq!(y.map(f64::to_bits), x.map(f64::to_bits));
    }
}

#[test]
fn reflection_is_symplectic() {
    // Mirrors position and momentum: determinant 1 in each pair.
    let mut x = [Dual::<2>::variable(-0.05, 0)];
    let mut u = [Dual::<2>::variable(-1.0, 1)];
    let count = Domain::basin([1.0]).reflect(0, &[0.1], &mut x, &mut u);
    assert_eq!(count, Ok(1));
    assert_eq!((x[0].dual, u[0].dual), ([-1.0, 0.0], [0.0, -1.0]));
    assert!(x[0].value() > 0.0 && u[0].value() > 0.0);
}

#[test]
fn reflection_changes_no_depth() {
    let of = setting(Domain::basin([1.0, 1.0]), [8, 16], 50);
    let at = places(&of, 3);
    let mass = Numbers::new(4).list(50);
    let mut deposit = deposit::<f64, 2>::new(&of, (&mass,)).expect("a grid");
    let before: Vec<_> = at.iter().map(|x| SVector::from(*x)).collect();
    let before = values(&mut deposit, &before);
    let (mut crossed, mut after) = (0, vec![]);
    for (site, x) in at.iter().enumerate() {
        let (mut x, mut u) = (*x, [1.0, 1.0]);
        let cell = [1.0 / 8.0, 1.0 / 16.0];
        crossed += of
            .domain
            .reflect(site, &cell, &mut x, &mut u)
            .expect("near");
        after.push(SVector::from(x));
    }
    assert!(crossed > 10);
    let after = values(&mut deposit, &after);
    let scale = largest(before.iter().copied());
    // Reflection at the far wall rounds a coordinate once more.
    assert!(largest(before.iter().zip(&after).map(|(b, a)| b - a)) < 1e-14 * scale);
}
