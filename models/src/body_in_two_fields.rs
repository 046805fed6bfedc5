//! A heavy top with a dipole in a uniform field: two advected vectors. A body of Kowalevski type is integrable
//! (Bogoyavlenskij 1984; Reyman and Semenov-Tian-Shansky 1987).

use crate::case::{Case, Citations, Entry, Place, bounds, diagonal, identity, poinsot};
use crate::thesis::THESIS;

clebsch::model! {
    /// Rigid body about a fixed point in two uniform fields.
    pub model BodyInTwoFields {
        /// Poinsot (second-moment) matrix
        param J: Sym<3>;
        /// weight times the vector from support to centre of mass, body frame
        param gU: Vec<3> as r"m g \chi";
        /// dipole moment, body frame
        param p: Vec<3>;
        /// vertical (up), space frame
        param z: Vec<3>;
        /// field that acts on the dipole, space frame
        param b: Vec<3>;
        /// attitude, body to space
        group Λ: SO<3> velocity Ω;
        /// vertical, body frame
        advected Γ: Vec<3> = Λ^T*z;
        /// field that acts on the dipole, body frame
        advected B: Vec<3> = Λ^T*b;
        /// reconstruction
        constraint next(Λ) = Λ*Ω;
        /// Γ and B are fixed in space
        constraint next(Γ) = Ω^T*Γ;
        constraint next(B) = Ω^T*B;
        lagrangian = -tr(J*Ω)/h - h*(dot(gU, Γ) - dot(p, B));
    }
}

/// The equations that also appear in the thesis.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: "",
    places: &[
        (Place::Reconstruction("Λ"), "(2.62)"),
        (Place::Rule("Γ"), "(2.141)"),
        (Place::Rule("B"), "(2.141)"),
        (Place::Relation("Λ"), "(2.60)"),
        (Place::Relation("Γ"), "(2.147)"),
        (Place::Relation("B"), "(2.147)"),
    ],
};

fn case(
    name: &str,
    doc: &str,
    moments: [f64; 3],
    weight: [f64; 3],
    dipole: [f64; 3],
    field: [f64; 3],
) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.05,
        steps: 10_000,
        parameters: vec![
            diagonal(poinsot(moments)),
            weight.to_vec(),
            dipole.to_vec(),
            vec![0.0, 0.0, 1.0],
            field.to_vec(),
        ],
        initial: vec![identity(), vec![-0.5, 0.3, 1.0]],
        bounds: bounds(&[("energy", 1e-2)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: BodyInTwoFields::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "kowalevski",
                "moments (2, 2, 1), centre of mass and dipole along e₁ and e₂, fields at right angles: integrable",
                [2.0, 2.0, 1.0],
                [1.0, 0.0, 0.0],
                [0.0, 0.5, 0.0],
                [1.0, 0.0, 0.0],
            ),
            case(
                "general",
                "asymmetric body, centre of mass, dipole and fields in general directions",
                [3.5, 2.5, 2.0],
                [0.3, -0.2, 0.9],
                [0.4, 0.5, -0.1],
                [0.6, 0.2, 0.3],
            ),
        ],
    }
}
