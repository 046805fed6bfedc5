//! The free rigid body in unit quaternions, in the space frame: the rotation of the quaternion advects the inertia,
//! and the momentum is constant.

use crate::case::{Case, Citations, Entry, diagonal};
use crate::cayley_klein::{MOMENTUM, SYMMETRIC};

clebsch::model! {
    /// Free rigid body in unit quaternions, spatial representation.
    pub model CayleyKleinSpatial {
        /// choice of discretisation: 0 for Moser-Veselov, 1 for the thesis
        param c: Real;
        /// attitude, body to space
        group q: SU<2> velocity w;
        /// inertia tensor, space frame
        advected I: Sym<3>;
        constraint next(q) = w*q;
        constraint next(I) = rot(w)*I*rot(w)^T;
        lagrangian = -(4*c/h)*re(w) + (2/h)*dot(im(w), (I - c*Id)*im(w));
    }
}

fn case(name: &str, doc: &str, moments: [f64; 3], c: f64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 1_000,
        parameters: vec![vec![c]],
        initial: vec![
            vec![1.0, 0.0, 0.0, 0.0],
            MOMENTUM.to_vec(),
            diagonal(moments),
        ],
        bounds: Vec::new(),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: CayleyKleinSpatial::CARD,
        citations: Citations::NONE,
        cases: vec![
            case(
                "figure-2-9",
                "symmetric body, moments (1, 1, 0.5), with c = 0: thesis figures 2.9 and 2.10",
                SYMMETRIC,
                0.0,
            ),
            case(
                "asymmetric",
                "asymmetric body, moments (3.5, 2.5, 2), with c = 1",
                [3.5, 2.5, 2.0],
                1.0,
            ),
        ],
    }
}
