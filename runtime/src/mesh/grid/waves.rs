//! The fastest waves of particles on a grid, by which the step of an explicit method is limited. Takes the speed of
//! long waves and the rate of rotation; gives an upper bound of all frequencies.

use super::super::Setting;
use super::nodes::Nodes;
use crate::ParameterError;
use crate::scalar::larger;
use core::f64::consts::PI;

/// Number of sampled wave numbers, from 0 to twice the largest on the grid.
const TRIED: u32 = 512;

/// The largest value of `q² φ(q)² S(q)` over waves of q radians per interval. `φ(q) = (sin(q/2)/(q/2))⁴` is the
/// transform of a cubic spline, an upper bound for a quintic one. The smoother is `S = 1/(1 + r²θ²)`, with θ the alias
/// of the wave on the grid.
fn steepest(ratio: f64) -> f64 {
    let of = |i: u32| {
        let q = 2.0 * PI * f64::from(i) / f64::from(TRIED);
        let seen = if q < PI { q } else { 2.0 * PI - q };
        let spline = (2.0 * (q / 2.0).sin() / q).powi(4);
        (q * spline).powi(2) / (1.0 + (ratio * seen).powi(2))
    };
    // Between two samples the frequency is higher by less than a thousandth.
    1.001 * (1..TRIED).map(of).fold(0.0, larger)
}

/// A bound for the angular frequency of small waves in a layer with several particles per cell, whose depth is smoothed
/// over the length `alpha`: `ω² = f² + c² |k|² φ(k)² S(k)`, with the factors φ of the splines and S of the smoother.
/// `speed` is the speed c of long waves, c0 times the root of the largest depth; `coriolis` is f. If a step of the
/// Störmer-Verlet method is longer than `2/ω`, such waves grow without bound.
///
/// # Errors
/// As [`Nodes::new`].
pub fn fastest_wave<const D: usize>(
    setting: &Setting<D>,
    alpha: f64,
    speed: f64,
    coriolis: f64,
) -> Result<f64, ParameterError> {
    let nodes = Nodes::new(setting)?;
    let along = nodes.axes().iter().map(|axis| {
        let spacing = axis.spacing();
        steepest(alpha / spacing) / (spacing * spacing)
    });
    let square = along.sum::<f64>();
    Ok((coriolis * coriolis + speed * speed * square).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_wave_that_a_grid_or_its_particles_hold_is_faster() {
        for ratio in [0.0, 0.5, 1.0, 2.0, 10.0] {
            let bound = steepest(ratio);
            // Twice as many waves as are tried, by their number on the grid.
            let all = (1..4096).map(|i| {
                let q = PI * f64::from(i) / 2048.0;
                let seen = q.min(2.0 * PI - q);
                let spline = ((0.5 * q).sin() / (0.5 * q)).powi(8);
                q * q * spline / (1.0 + ratio * ratio * seen * seen)
            });
            let largest = all.fold(0.0, larger);
            assert!(
                largest <= bound && bound < 1.01 * largest,
                "{ratio}: {largest} {bound}"
            );
        }
    }
}
