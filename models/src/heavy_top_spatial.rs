//! The heavy top in the spatial representation, which section 2.7 of the thesis mentions but does not derive. The
//! motion advects second moments and centre of mass, and the vertical is fixed.

use crate::case::{Case, Citations, Entry, Place, bounds, carried, poinsot, turned};
use crate::thesis::THESIS;

clebsch::model! {
    /// Heavy top, spatial representation.
    pub model HeavyTopSpatial {
        /// weight
        param w: Real;
        /// vertical (up), space frame
        param z: Vec<3>;
        /// attitude, body to space
        group Λ: SO<3> velocity ω;
        /// Poinsot (second-moment) matrix, space frame
        advected J: Sym<3>;
        /// vector from support to centre of mass, space frame
        advected χ: Vec<3>;
        /// reconstruction
        constraint next(Λ) = ω*Λ;
        /// advection of the second moments
        constraint next(J) = ω*J*ω^T;
        /// advection of the centre of mass
        constraint next(χ) = ω*χ;
        lagrangian = -tr(ω*J)/h - h*w*dot(χ, z);
    }
}

/// The equations that also appear in the thesis.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: "",
    places: &[
        (Place::Reconstruction("Λ"), "(2.106)"),
        (Place::Rule("J"), "(2.120)"),
        (Place::Relation("Λ"), "(2.104)"),
        (
            Place::Relation("J"),
            "(2.104), where the multiplier carries a factor $1/2$",
        ),
    ],
};

/// The rotation about the second axis by the angle with cosine 0.8, which tilts the top.
fn tilted() -> Vec<f64> {
    vec![0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8]
}

/// Takes momentum and centre of mass in body axes and converts them to space axes.
fn case(
    name: &str,
    doc: &str,
    moments: [f64; 3],
    centre: [f64; 3],
    momentum: [f64; 3],
    energy: f64,
) -> Case {
    let attitude = tilted();
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 10_000,
        parameters: vec![vec![1.0], vec![0.0, 0.0, 1.0]],
        initial: vec![
            attitude.clone(),
            turned(&attitude, momentum),
            carried(&attitude, poinsot(moments)),
            turned(&attitude, centre),
        ],
        bounds: bounds(&[("energy", energy)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let symmetric = [2.0, 2.0, 1.0];
    Entry {
        card: HeavyTopSpatial::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "lagrange",
                "Lagrange top (2, 2, 1), m g χ = e₃ in the body frame, tilted by arccos(4/5)",
                symmetric,
                [0.0, 0.0, 1.0],
                [0.1, 0.0, 1.0],
                2e-2,
            ),
            case(
                "hanging",
                "the same Lagrange top, hanging: m g χ = -e₃ in the body frame",
                symmetric,
                [0.0, 0.0, -1.0],
                [0.1, 0.0, 1.0],
                2e-2,
            ),
            case(
                "general",
                "asymmetric top (3.5, 2.5, 2) with its centre of mass off the axes: chaotic",
                [3.5, 2.5, 2.0],
                [0.3, -0.2, 0.9],
                [-0.5, 0.3, 1.0],
                2e-2,
            ),
        ],
    }
}
