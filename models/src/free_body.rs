//! The free rigid body in the body representation (thesis 2.5): the Moser-Veselov system.

use crate::case::{Case, Citations, Entry, Place, diagonal, identity, poinsot};
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Free rigid body, body representation.
    pub model FreeBody {
        /// Poinsot (second-moment) matrix
        param J: Sym<3>;
        /// attitude, body to space
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("2.5.4", "-h"),
    places: &[
        (Place::Reconstruction("Λ"), "(2.62)"),
        (Place::Action, "(2.29) times $-1/h$"),
        (Place::ClebschAction, "(2.75)"),
        (Place::Relation("Λ"), "(2.60)"),
        (Place::Relation("Ω"), "(2.77)"),
        (Place::Lifted, "(2.79)"),
        (Place::Momentum, "(2.86) times $-1/h$"),
        (Place::AtStart, "(2.79)"),
        (Place::Balance, "(2.85)"),
        (Place::Continuous, "table A.2"),
    ],
};

fn case(name: &str, doc: &str, moments: [f64; 3], momentum: [f64; 3], steps: u64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps,
        parameters: vec![diagonal(poinsot(moments))],
        initial: vec![identity(), momentum.to_vec()],
        // All invariants are exact. Rounding errors do not accumulate, since the stepper projects every 64 steps and
        // stores the spatial momentum.
        bounds: [
            "energy",
            "spatial_momentum",
            "momentum_squared",
            "momentum_quadratic",
        ]
        .map(|v| (v.to_owned(), 1e-14))
        .to_vec(),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let symmetric = [2.0, 2.0, 1.0];
    let general = [3.5, 2.5, 2.0];
    let flat = [1.0, 2.0, 3.0];
    Entry {
        card: FreeBody::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "figure-2-5",
                "symmetric body, moments (2, 2, 1), 1000 steps: thesis figure 2.5",
                symmetric,
                [0.1, 0.0, 1.0],
                1_000,
            ),
            case(
                "figure-2-6",
                "asymmetric body, moments (3.5, 2.5, 2), 1000 steps: thesis figure 2.6",
                general,
                [-0.5, 0.0, 1.0],
                1_000,
            ),
            case(
                "figure-2-7",
                "symmetric body over 10000 steps, drift of energy and momentum: thesis figure 2.7",
                symmetric,
                [0.1, 0.0, 1.0],
                10_000,
            ),
            case(
                "figure-2-8",
                "asymmetric body over 10000 steps, drift of energy and momentum: thesis figure 2.8",
                general,
                [-0.5, 0.0, 1.0],
                10_000,
            ),
            case(
                "figure-2-15",
                "moments (1, 2, 3), long-time energy: thesis figure 2.15, which does not state the body",
                flat,
                [-0.5, 0.0, 1.0],
                1_000,
            ),
            case(
                "figure-2-16",
                "the same body over a million steps: thesis figure 2.16, computing time",
                flat,
                [-0.5, 0.0, 1.0],
                1_000_000,
            ),
            Case {
                h: 0.01,
                ..case(
                    "figure-2-17",
                    "the same body with h = 0.01: thesis figure 2.17, drift compared with a splitting method",
                    flat,
                    [-0.5, 0.0, 1.0],
                    10_000,
                )
            },
            case(
                "flat-body",
                "moments (1, 2, 3), with a singular Poinsot matrix: the inertia of thesis figure 2.17",
                flat,
                [0.5, 0.3, 1.0],
                10_000,
            ),
            case(
                "steady-rotation",
                "rotation about the symmetry axis: the angle per step is asin(h M₃/I₃)",
                symmetric,
                [0.0, 0.0, 1.0],
                1_000,
            ),
        ],
    }
}
