//! The stability limit of the step size, with step sizes below and above it.

use super::common::*;
use super::verlet::Run;
use clebsch::mesh::*;

/// The largest velocity after 400 steps of particles on a periodic line, perturbed by rounding alone.
fn after_rounding(alpha: f64, dt: f64, of: &Setting<1>) -> f64 {
    let length = of.domain.lengths[0];
    let place =
        |a: usize| (a as f64 + 0.5 + 1e-9 * (a as f64).sin()) * length / of.particles as f64;
    let mut x: Vec<f64> = (0..of.particles).map(place).collect();
    let mass = vec![length / x.len() as f64; x.len()];
    let mut run = Run::<deposit<f64, 1>, smooth<f64, 1>, 1>::new(of, alpha, mass, 4.0);
    let (mut u, mut slopes) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    run.potential(&x);
    run.slopes(&x, &mut slopes);
    for _ in 0..400 {
        run.step(&mut x, &mut u, &mut slopes, dt, |x, u| (x + dt * u, u));
    }
    largest(u)
}

#[test]
fn steps_are_limited_by_the_fastest_wave() {
    let of = setting(Domain::torus([1.0]), [32], 128);
    for alpha in [0.0, 1.0 / 32.0, 4.0 / 32.0] {
        // The potential gives the square of the speed of long waves.
        let fastest = fastest_wave(&of, alpha, 2.0, 0.0).expect("a grid");
        let slow = after_rounding(alpha, 0.95 * 2.0 / fastest, &of);
        assert!(slow < 1e-6, "{alpha}: {slow:e}");
        // The grid does not represent all wave numbers.
        let quick = after_rounding(alpha, 1.1 * 2.0 / fastest, &of);
        assert!(quick > 1e-3, "{alpha}: {quick:e}");
    }
    // Rotation alone.
    assert_eq!(fastest_wave(&of, 0.1, 0.0, 3.0), Ok(3.0));
}
