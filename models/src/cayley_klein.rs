//! The free rigid body in unit quaternions (thesis 2.8, the Cayley-Klein form): a family of discretisations. The
//! member `c = 0` is the Moser-Veselov system lifted to SU(2).

use crate::case::{Case, Citations, Entry, bounds, diagonal};

clebsch::model! {
    /// Free rigid body in unit quaternions.
    /// The body momentum is q* m q, a Hopf map of q: its fibres over the sphere of body momenta are circles.
    pub model CayleyKlein {
        /// principal moments of inertia
        param I: Diag<3>;
        /// choice of discretisation: 0 for Moser-Veselov, 1 for the thesis
        param c: Real;
        /// attitude, body to space
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        lagrangian = -(4*c/h)*re(W) + (2/h)*dot(im(W), (I - c*Id)*im(W));
    }
}

/// Moments of inertia in the figures.
pub(crate) const SYMMETRIC: [f64; 3] = [1.0, 1.0, 0.5];

/// Momentum at node 0 in the figures.
pub(crate) const MOMENTUM: [f64; 3] = [-0.5, 0.1, 0.5];

fn case(name: &str, doc: &str, moments: [f64; 3], c: f64, energy: f64, steps: u64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps,
        parameters: vec![diagonal(moments), vec![c]],
        initial: vec![vec![1.0, 0.0, 0.0, 0.0], MOMENTUM.to_vec()],
        bounds: bounds(&[("energy", energy)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let rounding = 1e-12;
    Entry {
        card: CayleyKlein::CARD,
        citations: Citations::NONE,
        cases: vec![
            case(
                "figure-2-9",
                "symmetric body, moments (1, 1, 0.5), with c = 0, 1000 steps: thesis figures 2.9 and 2.10",
                SYMMETRIC,
                0.0,
                rounding,
                1_000,
            ),
            case(
                "figure-2-9-thesis",
                "the same body with c = 1, the type of discretisation in the thesis",
                SYMMETRIC,
                1.0,
                1e-3,
                1_000,
            ),
            case(
                "asymmetric",
                "asymmetric body, moments (3.5, 2.5, 2), with c = 1: the energy oscillates",
                [3.5, 2.5, 2.0],
                1.0,
                1e-3,
                10_000,
            ),
        ],
    }
}
