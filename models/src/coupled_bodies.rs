//! Two rigid bodies with a ball-and-socket joint (thesis 2.8, with the coupling corrected), relative to the joint.
//! The common centre of mass is at rest.

use crate::case::{Case, Citations, Entry, Place, bounds, diagonal, identity, poinsot};
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Two rigid bodies connected by a spherical joint.
    pub model CoupledBodies {
        /// Poinsot matrices about the centres of mass, plus eps dᵢ dᵢᵀ, body frames
        param J1, J2: Sym<3>;
        /// vectors from the joint to the centres of mass, body frames
        param d1, d2: Vec<3>;
        /// reduced mass m₁ m₂/(m₁ + m₂)
        param eps: Real as r"\varepsilon";
        /// attitude of body 1, body to space
        group Λ1: SO<3> velocity Ω1;
        /// attitude of body 2, body to space
        group Λ2: SO<3> velocity Ω2;
        /// attitude of body 2 relative to body 1
        advected R: SO<3> = Λ1^T*Λ2;
        constraint next(Λ1) = Λ1*Ω1;
        constraint next(Λ2) = Λ2*Ω2;
        constraint next(R) = Ω1^T*R*Ω2;
        lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("2.8.2", "-h"),
    places: &[
        (Place::Reconstruction("Λ1"), "(2.62)"),
        (Place::Reconstruction("Λ2"), "(2.62)"),
        (Place::Rule("R"), "(2.167)"),
        (
            Place::Action,
            "(2.166) times $-1/h$, corrected: there the matrix $A$ of the vector form stands under the trace",
        ),
        (Place::ClebschAction, "(2.168)"),
        (Place::Relation("Λ1"), "(2.170)"),
        (Place::Relation("Λ2"), "(2.170)"),
        (
            Place::Relation("R"),
            "(2.171) corrected: there the terms of the multiplier have the other sign",
        ),
        (Place::Relation("Ω1"), "(2.174)"),
        (Place::Relation("Ω2"), "(2.174)"),
        (
            Place::Lifted,
            "(2.180) corrected: there $skew$ for $2 skew$ in the terms of the multiplier of the relative orientation",
        ),
        (Place::Momentum, "(2.176) times $-1/h$"),
        (Place::AtStart, "(2.176), with the same correction"),
        (
            Place::Balance,
            "(2.184); (2.182) and (2.183) print $skew$ for $2 skew$ in its last term",
        ),
        (
            Place::Riccati,
            "(2.187) has the coupling in the factor instead of $N$",
        ),
        (
            Place::Continuous,
            "table A.5, whose matrix $A$ belongs to the vector form",
        ),
    ],
};

/// A body: principal moments about its own centre of mass, and the vector from the joint to that centre.
#[derive(Clone, Copy)]
struct Body {
    moments: [f64; 3],
    arm: [f64; 3],
    momentum: [f64; 3],
}

impl Body {
    /// `J + eps d dᵀ`, row by row.
    fn poinsot_about_joint(&self, eps: f64) -> Vec<f64> {
        let arm = self.arm;
        let added = arm
            .iter()
            .flat_map(|a| arm.iter().map(move |b| eps * (a * b)));
        let own = diagonal(poinsot(self.moments));
        own.iter().zip(added).map(|(j, a)| j + a).collect()
    }
}

fn case(
    name: &str,
    doc: &str,
    steps: u64,
    bodies: [Body; 2],
    second: Vec<f64>,
    energy: f64,
) -> Case {
    let eps = 0.5;
    let [one, two] = bodies;
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.1,
        steps,
        parameters: vec![
            one.poinsot_about_joint(eps),
            two.poinsot_about_joint(eps),
            one.arm.to_vec(),
            two.arm.to_vec(),
            vec![eps],
        ],
        initial: vec![
            identity(),
            one.momentum.to_vec(),
            second,
            two.momentum.to_vec(),
        ],
        bounds: bounds(&[("energy", energy)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    let body = |arm| Body {
        moments: [2.0, 2.0, 1.0],
        arm,
        momentum: [0.5, 0.0, 1.0],
    };
    // A quarter turn of the second body about the common first axis.
    let right_angle = vec![1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
    let along = body([0.0, 0.0, 1.0]);
    let across = body([1.0, 0.0, 0.0]);
    let general = [
        Body {
            moments: [3.5, 2.5, 2.0],
            arm: [0.4, -0.3, 0.8],
            momentum: [-0.5, 0.2, 1.0],
        },
        Body {
            moments: [1.5, 2.0, 1.0],
            arm: [-0.2, 0.7, 0.5],
            momentum: [0.3, 0.6, -0.4],
        },
    ];
    Entry {
        card: CoupledBodies::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "symmetric",
                "identical symmetric bodies (2, 2, 1) at right angles, arms along their axes: both μ₃ are conserved exactly",
                10_000,
                [along, along],
                right_angle.clone(),
                1e-4,
            ),
            case(
                "figure-2-12",
                "identical bodies at right angles, with eps = 0.5 and d = e₁, since the thesis omits masses and arms",
                1_000,
                [across, across],
                right_angle.clone(),
                1e-2,
            ),
            case(
                "figure-2-13",
                "identical bodies initially aligned, same eps and d: exchange symmetry, unstable motion",
                10_000,
                [across, across],
                identity(),
                1e-2,
            ),
            case(
                "figure-2-14",
                "the bodies of figure 2.12 over 10000 steps: Casimir, energy, total spatial momentum",
                10_000,
                [across, across],
                right_angle,
                1e-2,
            ),
            case(
                "general",
                "two different asymmetric bodies with arms off their principal axes: chaotic",
                10_000,
                general,
                identity(),
                1e-2,
            ),
        ],
    }
}
