//! Repeats the reference runs: starts a motion from the recorded data and compares it at the recorded nodes. Gives the largest
//! deviation of any recorded number; all are of order one.

use super::cases::{Start, lagrange_top, steady_body, symmetric_body};
use super::measure::{at_reference_nodes, matrices, vectors, worse};
use super::motion::Motion;
use crate::handwritten::attitude::{apply_transposed, dot};
use crate::reference::{body_sym, steady_rotation, top_lagrange};

/// Attitude, momentum and energy of the symmetric free body, and its first rotation.
pub fn symmetric<M: Motion>(start: impl Fn(&Start) -> M) -> Result<f64, String> {
    let mut once = start(&symmetric_body());
    once.step()?;
    // From the identity, the first rotation equals the first attitude.
    let first = matrices(&once.attitude(), &body_sym::OMEGA_1);
    at_reference_nodes(&mut start(&symmetric_body()), |motion, place| {
        let attitude = matrices(&motion.attitude(), &body_sym::ATTITUDE[place]);
        let momentum = vectors(&motion.body_momentum(), &body_sym::MOMENTUM[place]);
        let energy = (motion.energy() - body_sym::ENERGY).abs();
        [first, attitude, momentum, energy]
            .into_iter()
            .fold(0.0, worse)
    })
}

/// Attitude, momenta, vertical and mu . Gamma of the Lagrange top.
pub fn lagrange<M: Motion>(start: impl Fn(&Start) -> M) -> Result<f64, String> {
    at_reference_nodes(&mut start(&lagrange_top()), |motion, place| {
        let attitude = matrices(&motion.attitude(), &top_lagrange::ATTITUDE[place]);
        let momentum = vectors(&motion.body_momentum(), &top_lagrange::MOMENTUM[place]);
        let spatial = vectors(
            &motion.spatial_momentum(),
            &top_lagrange::SPATIAL_MOMENTUM[place],
        );
        let vertical = vectors(&motion.vertical(), &top_lagrange::VERTICAL[place]);
        let area = (dot(&motion.body_momentum(), &motion.vertical()) - top_lagrange::AREA).abs();
        [attitude, momentum, spatial, vertical, area]
            .into_iter()
            .fold(0.0, worse)
    })
}

/// Smallest and largest energy deviation of the Lagrange top over a thousand steps, compared with the recorded values.
pub fn lagrange_energy<M: Motion>(start: impl Fn(&Start) -> M) -> Result<f64, String> {
    let mut motion = start(&lagrange_top());
    let series = super::measure::energies(&mut motion, 1000)?;
    let (low, high) = series.iter().fold((0.0_f64, 0.0_f64), |(l, h), e| {
        (
            l.min(e - top_lagrange::ENERGY_0),
            h.max(e - top_lagrange::ENERGY_0),
        )
    });
    let [least, largest] = top_lagrange::ENERGY_DEVIATION;
    Ok(worse((low - least).abs(), (high - largest).abs()))
}

/// N_{k+1} and Gamma_k of the one-sided Lagrange top.
pub fn one_sided<M: Motion>(start: impl Fn(&Start) -> M) -> Result<f64, String> {
    at_reference_nodes(&mut start(&lagrange_top()), |motion, place| {
        let momentum = vectors(
            &motion.body_momentum(),
            &top_lagrange::ONE_SIDED_MOMENTUM[place],
        );
        let vertical = vectors(&motion.vertical(), &top_lagrange::ONE_SIDED_VERTICAL[place]);
        worse(momentum, vertical)
    })
}

/// Angle of each of a hundred steps of the steady rotation, and the momentum, which must be constant.
pub fn steady<M: Motion>(start: impl Fn(&Start) -> M) -> Result<f64, String> {
    let mut motion = start(&steady_body());
    let mut worst = 0.0;
    for _ in 0..100 {
        let before = motion.attitude();
        motion.step()?;
        // In the new body frame, the columns of the old attitude are rotated back by the angle.
        let column = apply_transposed(
            &motion.attitude(),
            &[before[0][0], before[1][0], before[2][0]],
        );
        let angle = (-column[1]).atan2(column[0]);
        worst = worse(worst, (angle - steady_rotation::ANGLE).abs());
        worst = worse(
            worst,
            vectors(&motion.body_momentum(), &steady_rotation::M0),
        );
    }
    Ok(worst)
}
