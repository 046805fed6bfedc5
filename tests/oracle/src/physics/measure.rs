//! Deviations from reference states, drifts of conserved quantities, and differences of two motions. Results are largest
//! deviations: absolute for reference states, relative to natural scales for conserved quantities. A failed step is an error and
//! never counts as a small deviation.

use super::motion::Motion;
use crate::handwritten::attitude::{Matrix, Vector, dot};
use crate::reference::NODES;

/// The larger of two deviations; NaN counts as infinite.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}

/// Largest difference of components.
pub fn vectors(a: &Vector, b: &Vector) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, worse)
}

/// Largest difference of entries.
pub fn matrices(a: &Matrix, b: &Matrix) -> f64 {
    (0..3).map(|i| vectors(&a[i], &b[i])).fold(0.0, worse)
}

/// Runs to every reference node and returns the largest value of `deviation` there. The argument is the index of the node in the
/// list.
pub fn at_reference_nodes<M: Motion>(
    motion: &mut M,
    mut deviation: impl FnMut(&M, usize) -> f64,
) -> Result<f64, String> {
    let (mut node, mut worst) = (0, 0.0);
    for (place, target) in NODES.into_iter().enumerate() {
        while node < target {
            motion.step()?;
            node += 1;
        }
        worst = worse(worst, deviation(motion, place));
    }
    Ok(worst)
}

/// Largest drift over a free motion, relative to the values at node 0.
#[derive(Clone, Copy, Debug)]
pub struct FreeDrift {
    /// Drift of the energy mu . I^-1 mu / 2, computed here from the body momentum.
    pub energy: f64,
    /// Drift of the energy that the stepper reports.
    pub reported_energy: f64,
    /// Drift of |mu|^2.
    pub square: f64,
    /// Drift of the spatial momentum R mu: largest component relative to |m|.
    pub spatial: f64,
}

impl FreeDrift {
    /// The largest of the drifts.
    pub fn worst(&self) -> f64 {
        [self.energy, self.reported_energy, self.square, self.spatial]
            .into_iter()
            .fold(0.0, worse)
    }
}

/// Drift over `steps` steps, sampled at every step; `inverse` is I^-1 in body axes.
pub fn free_drift(
    motion: &mut impl Motion,
    inverse: &Matrix,
    steps: u64,
) -> Result<FreeDrift, String> {
    let observe = |motion: &dyn Motion| {
        let mu = motion.body_momentum();
        let energy = 0.5 * dot(&mu, &crate::handwritten::attitude::apply(inverse, &mu));
        // The spatial momentum from attitude and body momentum, not the value that the stepper stores.
        let spatial = crate::handwritten::attitude::apply(&motion.attitude(), &mu);
        (energy, motion.energy(), dot(&mu, &mu), spatial)
    };
    let start = observe(motion);
    let length = start.2.sqrt();
    let mut drift = FreeDrift {
        energy: 0.0,
        reported_energy: 0.0,
        square: 0.0,
        spatial: 0.0,
    };
    for _ in 0..steps {
        motion.step()?;
        let here = observe(motion);
        drift.energy = worse(drift.energy, (here.0 - start.0).abs() / start.0);
        drift.reported_energy = worse(drift.reported_energy, (here.1 - start.1).abs() / start.0);
        drift.square = worse(drift.square, (here.2 - start.2).abs() / start.2);
        drift.spatial = worse(drift.spatial, vectors(&here.3, &start.3) / length);
    }
    Ok(drift)
}

/// Largest drift of the exact invariants of a heavy top.
#[derive(Clone, Copy, Debug)]
pub struct TopDrift {
    /// Relative drift of |Gamma|^2.
    pub vertical: f64,
    /// Drift of mu . Gamma, relative to the largest |mu||Gamma| of the run.
    pub area: f64,
    /// Drift of m . z, on the same scale.
    pub spatial: f64,
}

impl TopDrift {
    /// The largest of the drifts.
    pub fn worst(&self) -> f64 {
        [self.vertical, self.area, self.spatial]
            .into_iter()
            .fold(0.0, worse)
    }
}

/// Drift over `steps` steps, sampled at every step.
pub fn top_drift(motion: &mut impl Motion, up: &Vector, steps: u64) -> Result<TopDrift, String> {
    let observe = |motion: &dyn Motion| {
        let (mu, gamma) = (motion.body_momentum(), motion.vertical());
        (
            dot(&gamma, &gamma),
            dot(&mu, &gamma),
            dot(&motion.spatial_momentum(), up),
            dot(&mu, &mu),
        )
    };
    let start = observe(motion);
    let (mut vertical, mut area, mut spatial, mut largest) = (0.0, 0.0, 0.0, start.3);
    for _ in 0..steps {
        motion.step()?;
        let here = observe(motion);
        vertical = worse(vertical, (here.0 - start.0).abs() / start.0);
        area = worse(area, (here.1 - start.1).abs());
        spatial = worse(spatial, (here.2 - start.2).abs());
        largest = worse(largest, here.3);
    }
    let scale = (largest * start.0).sqrt();
    Ok(TopDrift {
        vertical,
        area: area / scale,
        spatial: spatial / scale,
    })
}

/// Largest difference of two motions over `steps` steps: attitude entries, and momenta relative to the largest |mu| of the run.
pub fn apart(a: &mut impl Motion, b: &mut impl Motion, steps: u64) -> Result<f64, String> {
    let (mut attitude, mut momentum, mut largest) = (0.0, 0.0, 0.0_f64);
    for _ in 0..steps {
        a.step()?;
        b.step()?;
        attitude = worse(attitude, matrices(&a.attitude(), &b.attitude()));
        let (here, there) = (a.body_momentum(), b.body_momentum());
        largest = largest.max(dot(&there, &there).sqrt());
        momentum = worse(momentum, vectors(&here, &there));
        momentum = worse(
            momentum,
            vectors(&a.spatial_momentum(), &b.spatial_momentum()),
        );
    }
    Ok(worse(attitude, momentum / largest))
}

/// The energies at the nodes 0 ..= steps.
pub fn energies(motion: &mut impl Motion, steps: u64) -> Result<Vec<f64>, String> {
    let mut series = vec![motion.energy()];
    for _ in 0..steps {
        motion.step()?;
        series.push(motion.energy());
    }
    Ok(series)
}
