//! The free rigid body in the spatial representation (thesis 2.5.5): the motion advects the Poinsot matrix, and the
//! spatial momentum is constant.

use crate::case::{
    Case, Citations, Entry, Place, bounds, carried, identity, poinsot, rotation, turned,
};
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Free rigid body, spatial representation.
    pub model FreeBodySpatial {
        /// attitude, body to space
        group Λ: SO<3> velocity ω;
        /// Poinsot (second-moment) matrix, space frame
        advected J: Sym<3>;
        /// reconstruction
        constraint next(Λ) = ω*Λ;
        /// advection of the second moments
        constraint next(J) = ω*J*ω^T;
        lagrangian = -tr(ω*J)/h;
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("2.5.5", "-h"),
    places: &[
        (Place::Reconstruction("Λ"), "(2.106)"),
        (Place::Rule("J"), "(2.120)"),
        (Place::Action, "(2.37) times $-1/h$"),
        (
            Place::ClebschAction,
            "(2.101), where the second multiplier carries a factor $1/2$",
        ),
        (Place::Relation("Λ"), "(2.104)"),
        (
            Place::Relation("J"),
            "(2.104), where the multiplier carries a factor $1/2$",
        ),
        (
            Place::Relation("ω"),
            "(2.107) corrected: there $Pᵀ Λᵀ$ for $P Λᵀ$",
        ),
        (Place::Lifted, "(2.111)"),
        (Place::Momentum, "(2.109) times $-1/h$"),
        (Place::AtEnd, "(2.108)"),
        (Place::Balance, "(2.120)"),
        (
            Place::Riccati,
            "A.3 solves it; there step 6 divides by the new tensor for the old one",
        ),
        (
            Place::Continuous,
            "table A.3, where both terms have the other sign",
        ),
    ],
};

/// Takes the momentum in body axes and converts it to space axes.
fn case(name: &str, doc: &str, moments: [f64; 3], attitude: Vec<f64>, momentum: [f64; 3]) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 10_000,
        parameters: vec![],
        initial: vec![
            attitude.clone(),
            turned(&attitude, momentum),
            carried(&attitude, poinsot(moments)),
        ],
        // The energy of a free body is exact, up to rounding.
        bounds: bounds(&[("energy", 1e-12)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: FreeBodySpatial::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "figure-2-7",
                "symmetric body, moments (2, 2, 1), over 10000 steps: thesis figure 2.7",
                [2.0, 2.0, 1.0],
                identity(),
                [0.1, 0.0, 1.0],
            ),
            case(
                "figure-2-8",
                "asymmetric body, moments (3.5, 2.5, 2), over 10000 steps: thesis figure 2.8",
                [3.5, 2.5, 2.0],
                identity(),
                [-0.5, 0.0, 1.0],
            ),
            case(
                "turned",
                "asymmetric body, initial attitude from the quaternion (√0.86, 0.1, -0.3, 0.2)",
                [3.5, 2.5, 2.0],
                rotation([0.86_f64.sqrt(), 0.1, -0.3, 0.2]),
                [-0.5, 0.0, 1.0],
            ),
        ],
    }
}
