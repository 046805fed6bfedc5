//! Symmetry breaking by a grid: the total force on all particles, which vanishes without a grid, and the torque, which vanishes for
//! an isotropic smoother.

use super::common::*;
use clebsch::mesh::*;
use clebsch::nalgebra::SVector;
use core::f64::consts::TAU;

type Place = SVector<f64, 2>;

/// Particles on a torus and their masses, four per cell, random within the cells of a lattice: an elliptical hill with tilted axes.
fn hill(cells: usize) -> (Setting<2>, Vec<Place>, Vec<f64>) {
    let side = 2 * cells;
    let of = setting(Domain::torus([TAU; 2]), [cells; 2], side * side);
    let mut numbers = Numbers::new(31);
    let spacing = TAU / side as f64;
    let mut place = |a: usize| {
        let along = [a / side, a % side].map(|i| i as f64);
        Place::new(along[0] + numbers.next(), along[1] + numbers.next()) * spacing
    };
    let at: Vec<Place> = (0..side * side).map(&mut place).collect();
    let depth = |x: &Place| {
        let r = x - Place::repeat(TAU / 2.0);
        let (sin, cos) = 0.4_f64.sin_cos();
        let (long, short) = (cos * r[0] + sin * r[1], cos * r[1] - sin * r[0]);
        1.0 + 0.5 * (-2.0 * long * long - 6.0 * short * short).exp()
    };
    let mass = at.iter().map(|x| depth(x) * spacing * spacing).collect();
    (of, at, mass)
}

/// The total force and the torque about the centre, relative to the sums of their absolute values.
fn totals<F, S>(cells: usize, alpha: f64) -> [f64; 2]
where
    F: for<'a> Functional<f64, 2, Argument = Place, Data<'a> = (&'a [f64],)>,
    S: for<'a> Functional<f64, 2, Argument = f64, Data<'a> = (f64,)>,
{
    let (of, at, mass) = hill(cells);
    let mut deposit = F::new(&of, (&mass,)).expect("a grid");
    let mut smooth = S::new(&of, (alpha,)).expect("a length");
    let weights = Nodes::new(&of).expect("a grid").weights::<f64>();
    let depth = values(&mut deposit, &at);
    let smoothed = values(&mut smooth, &depth);
    let seed: Vec<f64> = weights.iter().zip(&smoothed).map(|(w, s)| w * s).collect();
    let mut forces = vec![Place::zeros(); at.len()];
    deposit
        .pull_back(&at, &seed, &mut forces)
        .expect("a gradient");
    let total = forces.iter().fold(Place::zeros(), |sum, f| sum + f).norm();
    let size: f64 = forces.iter().map(|f| f.norm()).sum();
    let arm = |x: &Place| x - Place::repeat(TAU / 2.0);
    let torques = at.iter().zip(&forces).map(|(x, f)| arm(x).perp(f));
    let torque = sum(torques).abs();
    let around: f64 = at
        .iter()
        .zip(&forces)
        .map(|(x, f)| arm(x).norm() * f.norm())
        .sum();
    [total / size, torque / around]
}

#[test]
fn the_force_on_all_particles_falls_with_the_order_of_splines_and_the_length_of_smoothing() {
    type Split = smooth<f64, 2>;
    let cells = 24;
    let spacing = TAU / cells as f64;
    let mut before = [f64::INFINITY; 2];
    for ratio in [0.5, 1.0, 2.0, 4.0] {
        let alpha = ratio * spacing;
        let [cubic, _] = totals::<deposit<f64, 2>, Split>(cells, alpha);
        let [quintic, _] = totals::<deposit_quintic<f64, 2>, Split>(cells, alpha);
        // From 9e-4 to 2e-4, and from 2e-4 to 4e-5.
        assert!(quintic < 0.3 * cubic, "{quintic:e}, {cubic:e}");
        assert!(cubic < before[0] && quintic < before[1]);
        assert!(quintic > 1e-6, "no grid does as well");
        before = [cubic, quintic];
    }
}

#[test]
fn the_torque_of_the_isotropic_smoother_falls_with_the_grid() {
    let alpha = 0.4;
    let [coarse, fine] = [32, 128].map(|cells| {
        let [_, split] = totals::<deposit<f64, 2>, smooth<f64, 2>>(cells, alpha);
        let [_, whole] = totals::<deposit<f64, 2>, smooth_isotropic<f64, 2>>(cells, alpha);
        [split, whole]
    });
    // 7e-4 with both smoothers on the coarse grid. On the fine grid the split smoother, aligned with the grid axes, still has 4e-4.
    assert!(fine[1] < 0.25 * coarse[1], "{coarse:?} {fine:?}");
    assert!(
        fine[0] > 0.5 * coarse[0] && fine[0] > 3.0 * fine[1],
        "{coarse:?} {fine:?}"
    );
}
