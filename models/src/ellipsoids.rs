//! Data of the elastic ellipsoids, shared by both representations: metric, second moments, material, placement and
//! velocity. Each representation computes its momentum from these.

use crate::case::{Case, bounds};

/// The initial state of an ellipsoid with `n` rows.
pub(crate) struct Ellipsoid {
    n: usize,
    name: &'static str,
    doc: &'static str,
    h: f64,
    metric: Vec<f64>,
    moments: Vec<f64>,
    /// The parameter d; a, b and c are given by `STIFFNESS`.
    resistance: f64,
    /// The diagonal of Q.
    stretches: Vec<f64>,
    /// V, the rate of change of the placement.
    velocity: Vec<f64>,
    /// Relative amplitude of the energy oscillation.
    energy: f64,
}

/// a, b and c of thesis figures 3.1 to 3.3.
const STIFFNESS: [f64; 3] = [0.1, 10.0, 10.0];

/// The value of d for which the body is stress-free at the identity.
fn natural(n: usize) -> f64 {
    let [a, b, c] = STIFFNESS;
    2.0 * (a + (n as f64 - 1.0) * b + c)
}

fn diagonal(entries: &[f64]) -> Vec<f64> {
    let n = entries.len();
    let mut matrix = vec![0.0; n * n];
    for (place, x) in matrix.iter_mut().step_by(n + 1).zip(entries) {
        *place = *x;
    }
    matrix
}

fn product(n: usize, a: &[f64], b: &[f64]) -> Vec<f64> {
    let entry = |i: usize, j: usize| -> f64 { (0..n).map(|k| a[n * i + k] * b[n * k + j]).sum() };
    (0..n * n).map(|at| entry(at / n, at % n)).collect()
}

/// A rotation and a deformation without special structure.
fn velocity(n: usize) -> Vec<f64> {
    let entry = |i: usize, j: usize| 0.6 - 0.15 * ((3 * i + 5 * j + 2 * i * j) % 8) as f64;
    (0..n * n).map(|at| entry(at / n, at % n)).collect()
}

impl Ellipsoid {
    /// The case without initial values.
    pub(crate) fn case(&self) -> Case {
        let [a, b, c] = STIFFNESS;
        let numbers = [a, b, c, self.resistance].map(|x| vec![x]);
        let matrices = [self.metric.clone(), self.moments.clone()];
        Case {
            name: self.name.to_owned(),
            doc: self.doc.to_owned(),
            h: self.h,
            steps: 10_000,
            parameters: matrices.into_iter().chain(numbers).collect(),
            initial: Vec::new(),
            // The energy oscillates with the amplitude of the case; exact invariants drift by rounding only.
            bounds: bounds(&[("energy", self.energy)]),
        }
    }

    /// Q, row by row.
    pub(crate) fn placement(&self) -> Vec<f64> {
        diagonal(&self.stretches)
    }

    fn material_momentum(&self) -> Vec<f64> {
        let left = product(self.n, &self.metric, &self.velocity);
        product(self.n, &left, &self.moments)
    }

    /// Q^T C0 V I0.
    pub(crate) fn body_momentum(&self) -> Vec<f64> {
        product(self.n, &self.placement(), &self.material_momentum())
    }

    /// C0 V I0 Q^T.
    pub(crate) fn spatial_momentum(&self) -> Vec<f64> {
        product(self.n, &self.material_momentum(), &self.placement())
    }
}

/// The cases of both models.
pub(crate) fn ellipsoids() -> Vec<Ellipsoid> {
    let isotropic = |n: usize, name, doc| Ellipsoid {
        n,
        name,
        doc,
        h: 0.02,
        metric: diagonal(&vec![1.0; n]),
        moments: diagonal(&vec![1.0; n]),
        resistance: natural(n),
        stretches: vec![1.0; n],
        velocity: velocity(n),
        energy: 1e-3,
    };
    vec![
        isotropic(
            3,
            "natural",
            "Mooney-Rivlin ball that rotates and pulsates from its natural state",
        ),
        Ellipsoid {
            h: 0.05,
            resistance: 50.0,
            stretches: vec![1.0, 0.8, 1.25],
            velocity: vec![2e-4, -0.01, 0.0, 0.01, 1.6e-4, -0.02, 0.0, 0.02, 2.5e-4],
            energy: 1e-2,
            ..isotropic(
                3,
                "figure-3-1",
                "stretches and material of thesis figure 3.1, with d = 50 below the natural-state value, in slow rotation",
            )
        },
        Ellipsoid {
            metric: vec![1.0, 0.05, 0.0, 0.05, 1.1, -0.05, 0.0, -0.05, 0.95],
            moments: vec![0.9, 0.0, 0.05, 0.0, 1.05, 0.025, 0.05, 0.025, 1.15],
            stretches: vec![1.0, 1.0, 1.0],
            ..isotropic(
                3,
                "anisotropic",
                "metric and second moments without a common principal axis, prestressed",
            )
        },
        isotropic(2, "two", "two dimensions, from the natural state"),
        isotropic(4, "four", "four dimensions, from the natural state"),
    ]
}
