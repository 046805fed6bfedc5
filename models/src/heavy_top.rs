//! The heavy top in the body representation (thesis 2.7.1, with the corrected (2.155)).

use crate::case::{Case, Citations, Entry, Place, diagonal, identity, poinsot};
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Heavy top, body representation.
    pub model HeavyTop {
        /// Poinsot (second-moment) matrix
        param J: Sym<3>;
        /// weight times the vector from support to centre of mass, body frame
        param gU: Vec<3> as r"m g \chi";
        /// vertical (up), space frame
        param z: Vec<3>;
        /// attitude, body to space
        group Λ: SO<3> velocity Ω;
        /// vertical, body frame
        advected Γ: Vec<3> = Λ^T * z;
        /// reconstruction
        constraint next(Λ) = Λ * Ω;
        /// advection of Γ
        constraint next(Γ) = Ω^T * Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("2.7.1", "-h"),
    places: &[
        (Place::Reconstruction("Λ"), "(2.62)"),
        (Place::Rule("Γ"), "(2.141); (2.155) prints $Ω$ for $Ωᵀ$"),
        (
            Place::Action,
            "(2.142) times $-1/h$, which takes the potential at node $k$",
        ),
        (Place::ClebschAction, "(2.143)"),
        (
            Place::Relation("Λ"),
            "(2.145) corrected: there $Ωᵀ P$ for $P Ωᵀ$",
        ),
        (Place::Relation("Γ"), "(2.145)"),
        (Place::Relation("Ω"), "(2.148)"),
        (Place::Lifted, "(2.153)"),
        (
            Place::Momentum,
            "(2.156) times $-1/h$, corrected: there $2/h² skew$ for $2 skew$",
        ),
        (Place::AtStart, "(2.151)"),
        (
            Place::Balance,
            "(2.155) corrected: there $Ad*$ of $Ωᵀ$ for $Ad*$ of $Ω$; its gradient is that of the edge after the node alone",
        ),
        (Place::Continuous, "table A.4"),
    ],
};

/// The rotation about the second axis by the angle with this cosine and sine, which tilts the top.
fn tilted(cos: f64, sin: f64) -> Vec<f64> {
    vec![cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos]
}

fn case(
    name: &str,
    doc: &str,
    moments: [f64; 3],
    weight: [f64; 3],
    attitude: Vec<f64>,
    momentum: [f64; 3],
    energy: f64,
) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps: 10_000,
        parameters: vec![
            diagonal(poinsot(moments)),
            weight.to_vec(),
            vec![0.0, 0.0, 1.0],
        ],
        initial: vec![attitude, momentum.to_vec()],
        // Casimirs are exact up to rounding; the energy oscillates within O(h²), with the amplitude of the case.
        bounds: vec![
            ("energy".to_owned(), energy),
            ("momentum_Gamma".to_owned(), 1e-13),
            ("Gamma_squared".to_owned(), 1e-13),
        ],
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let symmetric = [2.0, 2.0, 1.0];
    let centre = [0.0, 0.0, 1.0];
    Entry {
        card: HeavyTop::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "lagrange",
                "Lagrange top (2, 2, 1), m g χ = e₃, tilted by arccos(4/5)",
                symmetric,
                centre,
                tilted(0.8, 0.6),
                [0.1, 0.0, 1.0],
                2e-2,
            ),
            Case {
                steps: 1_000,
                ..case(
                    "figure-2-11",
                    "hanging top of thesis figure 2.11, with m g χ = -e₃, which the thesis omits",
                    symmetric,
                    [0.0, 0.0, -1.0],
                    identity(),
                    [0.1, 0.0, 1.0],
                    2e-2,
                )
            },
            case(
                "general",
                "asymmetric top (3.5, 2.5, 2) with its centre of mass off the axes: chaotic",
                [3.5, 2.5, 2.0],
                [0.3, -0.2, 0.9],
                tilted(0.8, 0.6),
                [-0.5, 0.3, 1.0],
                2e-2,
            ),
        ],
    }
}
