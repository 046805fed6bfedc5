//! Kepler's problem: a planet around a fixed sun, in Cartesian coordinates. The potential acts at nodes, so the step
//! is the Störmer-Verlet method (Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.4).

use crate::case::{Case, Citations, Entry, bounds};

clebsch::model! {
    /// Kepler problem: a planet orbits a fixed sun.
    pub model Kepler {
        /// mass of the planet
        param m: Real;
        /// gravitational parameter of the sun: the gravitational constant times its mass
        param k: Real;
        /// position of the planet relative to the sun
        field X: Vec<3>;
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + h*m*k/sqrt(dot(X, X));
    }
}

/// A planet of mass one that starts on the first axis. Its velocity is perpendicular to that axis, in a plane tilted
/// about the axis by the angle with cosine 0.8.
fn case(name: &str, doc: &str, h: f64, place: f64, speed: f64, energy: f64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h,
        steps: 10_000,
        parameters: vec![vec![1.0], vec![1.0]],
        initial: vec![vec![place, 0.0, 0.0], vec![0.0, 0.8 * speed, 0.6 * speed]],
        // The energy oscillates with the amplitude of the case.
        bounds: bounds(&[("energy", energy)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: Kepler::CARD,
        citations: Citations::NONE,
        cases: vec![
            case(
                "circular",
                "circular orbit of radius 1, gravitational parameter 1, 125 steps per revolution",
                0.05,
                1.0,
                1.0,
                1e-6,
            ),
            case(
                "eccentric",
                "ellipse of semi-major axis 1 and eccentricity 0.6, started at perihelion, 314 steps per revolution",
                0.02,
                0.4,
                2.0,
                1e-3,
            ),
        ],
    }
}
