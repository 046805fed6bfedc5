//! A charge in uniform magnetic and electric fields. The magnetic term is linear in the velocity, with the vector
//! potential B x X/2, so that the step is the centred rotation of Boris (1970).

use crate::case::{Case, Citations, Entry};

clebsch::model! {
    /// Charged particle in uniform magnetic and electric fields.
    pub model ChargedParticle {
        /// mass
        param m: Real;
        /// charge
        param q: Real;
        /// magnetic field
        param B: Vec<3>;
        /// electric field
        param E: Vec<3>;
        /// position of the particle
        field X: Vec<3>;
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + (q/2)*dot(cross(B, X), d) + h*q*dot(E, X);
    }
}

/// A particle with unit mass and charge in a field of unit strength along the third axis. If E = 0, it moves on a
/// helix of radius one around that axis.
fn case(name: &str, doc: &str, electric: [f64; 3]) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 1_000,
        parameters: vec![vec![1.0], vec![1.0], vec![0.0, 0.0, 1.0], electric.to_vec()],
        // m V + (q/2) B x X with the velocity (1, 0, 0.1).
        initial: vec![vec![0.0, 1.0, 0.0], vec![0.5, 0.0, 0.1]],
        // All derived invariants are exact.
        bounds: Vec::new(),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: ChargedParticle::CARD,
        citations: Citations::NONE,
        cases: vec![
            case(
                "drift",
                "crossed fields, |E| = |B|/10: the guiding centre drifts along E x B",
                [0.1, 0.0, 0.0],
            ),
            case(
                "gyration",
                "helix about the magnetic field, without electric field",
                [0.0; 3],
            ),
        ],
    }
}
