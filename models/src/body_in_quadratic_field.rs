//! A rigid body in a field that is quadratic in the direction of its axis, such as a satellite in a gravity gradient.
//! If the quadratic form is proportional to the inertia of the body, this is Brun's integrable problem.

use crate::case::{Case, Citations, Entry, Place, bounds, diagonal, poinsot, rotation};
use crate::thesis::THESIS;

clebsch::model! {
    /// Rigid body about a fixed point in a quadratic field.
    pub model BodyInQuadraticField {
        /// Poinsot (second-moment) matrix
        param J: Sym<3>;
        /// matrix of the field, body frame: potential energy ½ Γ·KΓ
        param K: Sym<3>;
        /// attitude, body to space
        group Λ: SO<3> velocity Ω;
        /// axis of the field, body frame
        advected Γ: Vec<3>;
        /// reconstruction
        constraint next(Λ) = Λ*Ω;
        /// the axis is fixed in space
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - (h/2)*dot(Γ, K*Γ);
    }
}

/// The equations that also appear in the thesis.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: "",
    places: &[
        (Place::Reconstruction("Λ"), "(2.62)"),
        (Place::Rule("Γ"), "(2.141)"),
        (Place::Relation("Λ"), "(2.60)"),
        (Place::Relation("Γ"), "(2.147)"),
    ],
};

fn case(name: &str, doc: &str, moments: [f64; 3], field: Vec<f64>, axis: [f64; 3]) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 10_000,
        parameters: vec![diagonal(poinsot(moments)), field],
        initial: vec![
            rotation([1.0, 0.2, -0.1, 0.3]),
            vec![-0.5, 0.3, 1.0],
            axis.to_vec(),
        ],
        bounds: bounds(&[("energy", 1e-2)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let moments = [3.5, 2.5, 2.0];
    Entry {
        card: BodyInQuadraticField::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "satellite",
                "K = 3 n² I with the mean motion n = 0.3, orbital rotation neglected: Brun's integrable case",
                moments,
                diagonal(moments.map(|i| 0.27 * i)),
                [0.48, 0.6, 0.64],
            ),
            case(
                "general",
                "field whose principal axes differ from those of the body",
                moments,
                vec![1.0, 0.3, -0.2, 0.3, -0.5, 0.4, -0.2, 0.4, 0.7],
                [0.48, 0.6, 0.64],
            ),
        ],
    }
}
