//! The pseudospectral solver for rotating shallow water against known results: the frequency of Poincaré waves, mass to rounding,
//! and energy to the order of the time steps.

use clebsch_comparisons::shallow_water::{Fields, Smoothing, Spectral};
use core::f64::consts::TAU;

const ALL: [Smoothing; 3] = [Smoothing::Split, Smoothing::Isotropic, Smoothing::Twice];

/// Water with c = 1.3, f = 2 and a smoothing length of 0.3 on a torus of length 2π.
fn water(smoothing: Smoothing) -> Spectral {
    let alpha = (0.3, smoothing);
    Spectral::new([TAU; 2], false, [32; 2], alpha, 1.69, 2.0).expect("powers of two")
}

/// The largest difference of depths and velocities.
fn apart(a: &Fields, b: &Fields) -> f64 {
    let pairs = [(&a.h, &b.h), (&a.u, &b.u), (&a.v, &b.v)];
    let each = pairs.into_iter().flat_map(|(a, b)| a.iter().zip(b));
    each.map(|(a, b)| (a - b).abs())
        .max_by(f64::total_cmp)
        .expect("fields")
}

#[test]
fn poincares_waves_have_their_frequency_and_shape() {
    for smoothing in ALL {
        for k in [[1.0, 0.0], [0.0, 3.0], [2.0, 1.0], [-3.0, 4.0]] {
            let mut spectral = water(smoothing);
            let square: f64 = k[0] * k[0] + k[1] * k[1];
            let [a, b] = k.map(|k: f64| (0.3 * k).powi(2));
            let factor = match smoothing {
                Smoothing::Split => 1.0 / ((1.0 + a) * (1.0 + b)),
                Smoothing::Isotropic => 1.0 / (1.0 + a + b),
                Smoothing::Twice => 1.0 / (1.0 + a + b).powi(2),
            };
            let frequency = (4.0 + 1.69 * square * factor).sqrt();
            assert!(frequency < spectral.fastest_wave());
            let size = 1e-6;
            // The velocity component along k is in phase with the depth; the component across k lags by a quarter of a period.
            let wave = |x: [f64; 2], time: f64| {
                let (sin, cos) = (k[0] * x[0] + k[1] * x[1] - frequency * time).sin_cos();
                let (along, across) = (frequency * cos / square, 2.0 * sin / square);
                let u = k[0] * along - k[1] * across;
                let v = k[1] * along + k[0] * across;
                [1.0 + size * cos, size * u, size * v]
            };
            let mut now = spectral.fields(|x| wave(x, 0.0));
            let (steps, dt) = (100, 0.01);
            for _ in 0..steps {
                spectral.step(&mut now, dt);
            }
            let exact = spectral.fields(|x| wave(x, dt * f64::from(steps)));
            // The error of the time steps is (ω dt)⁴ ω t/120 relative to the amplitude, at most 1e-7; the rest is quadratic in the
            // amplitude.
            let off = apart(&now, &exact);
            assert!(
                off < 2e-7 * size + 50.0 * size * size,
                "{smoothing:?} {k:?}: {off:e}"
            );
        }
    }
}

/// Steep water with rotation and flow.
fn steep(spectral: &Spectral) -> Fields {
    spectral.fields(|x| {
        let h = 1.0 + 0.2 * x[0].cos() + 0.1 * (x[0] + x[1]).sin();
        [h, 0.2 * x[1].sin(), 0.1 * (x[0] - x[1]).cos()]
    })
}

#[test]
fn mass_is_kept_to_rounding_and_energy_to_the_order_of_the_steps() {
    for smoothing in ALL {
        let mut spectral = water(smoothing);
        let start = steep(&spectral);
        let mass = |f: &Fields| f.h.iter().sum::<f64>() / f.h.len() as f64;
        let mut changes = vec![];
        for steps in [16, 32, 64] {
            let mut now = start.clone();
            for _ in 0..steps {
                spectral.step(&mut now, 1.0 / f64::from(steps));
            }
            assert!((mass(&now) / mass(&start) - 1.0).abs() < 1e-14);
            let [before, after] = [&start, &now].map(|f| spectral.energy(f).iter().sum::<f64>());
            changes.push((after / before - 1.0).abs());
        }
        // At least fourth order: the energy error of a linear wave is of fifth order in the step size.
        for pair in changes.windows(2) {
            assert!(pair[0] > 14.0 * pair[1], "{smoothing:?}: {changes:?}");
        }
        assert!(changes[2] < 1e-7, "{smoothing:?}: {changes:?}");
    }
}

#[test]
fn what_is_truncated_has_no_components_that_products_drop() {
    let mut spectral = water(Smoothing::Isotropic);
    // With 32 nodes along a direction, wave numbers up to 10 are kept.
    let smooth = |x: [f64; 2]| 1.0 + (3.0 * x[0]).cos() + (10.0 * x[1] + x[0]).sin();
    let rough = |x: [f64; 2]| smooth(x) + (11.0 * x[0]).cos() + (16.0 * x[1]).cos();
    let mut found = spectral.fields(|x| [rough(x), -rough(x), rough(x)]);
    spectral.truncate(&mut found);
    let wanted = spectral.fields(|x| [smooth(x), -smooth(x), smooth(x)]);
    assert!(apart(&found, &wanted) < 1e-13);
    // Steps do not restore dropped components.
    let mut now = steep(&spectral);
    for _ in 0..20 {
        spectral.step(&mut now, 0.02);
    }
    let mut truncated = now.clone();
    spectral.truncate(&mut truncated);
    assert!(apart(&truncated, &now) < 1e-13);
}
