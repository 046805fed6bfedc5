//! A rigid body in an ideal fluid (Kirchhoff 1869; Lamb, Hydrodynamics, chapter VI). The kinetic energy is a
//! quadratic form in angular and linear velocity, which includes the added masses of the fluid. The rotation is
//! discretised as by Moser and Veselov. The linear velocity of a step is the mean of its translation in the body
//! frames at both ends, so that the step is symmetric in time.

use crate::case::{Case, Citations, Entry, bounds, diagonal};

clebsch::model! {
    /// Rigid body in an ideal fluid, with added mass, rotation-translation coupling and net weight.
    pub model KirchhoffBody {
        /// Poinsot matrix of the rotational inertia plus the added inertia of the fluid, body frame
        param J: Sym<3>;
        /// mass plus added mass, body frame
        param M: Sym<3>;
        /// coupling of angular and linear velocity, body frame
        param D: Mat<3>;
        /// (moment of weight minus buoyancy, net weight), body frame
        param b: Vec<4>;
        /// (vertical (up), 0), the plane of height 0, space frame
        param Z: Vec<4>;
        /// position and attitude, body to space
        group G: SE<3> velocity V;
        /// (vertical, height), body frame
        advected P: Vec<4> = G^T*Z;
        constraint next(G) = G*V;
        constraint next(P) = V^T*P;
        let u = (pos(V) - pos(V^-1))/2;
        lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) + dot(vee(rot(V)), D*u)/h - h*dot(b, P);
    }
}

/// The homogeneous matrix of a translation, row by row.
fn at([x, y, z]: [f64; 3]) -> Vec<f64> {
    vec![
        1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0,
    ]
}

fn case(name: &str, doc: &str, coupling: [f64; 3], b: [f64; 4], steps: u64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.02,
        steps,
        parameters: vec![
            diagonal([1.0, 0.7, 0.4]),
            diagonal([1.5, 2.0, 3.0]),
            diagonal(coupling),
            b.to_vec(),
            vec![0.0, 0.0, 1.0, 0.0],
        ],
        initial: vec![at([0.0, 0.0, 0.0]), vec![0.3, -0.2, 0.8, 0.9, 0.2, 0.4]],
        bounds: bounds(&[("energy", 1e-2)]),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: KirchhoffBody::CARD,
        citations: Citations::NONE,
        cases: vec![
            case(
                "ellipsoid",
                "neutrally buoyant body with three symmetry planes, 2000 steps",
                [0.0; 3],
                [0.0; 4],
                2_000,
            ),
            case(
                "screw",
                "neutrally buoyant body with rotation-translation coupling",
                [0.1, -0.05, 0.15],
                [0.0; 4],
                2_000,
            ),
            case(
                "floating",
                "weight equal to buoyancy, centre of mass off the centre of buoyancy",
                [0.1, -0.05, 0.15],
                [0.1, 0.0, -0.2, 0.0],
                2_000,
            ),
            case(
                "sinking",
                "negatively buoyant body, centre of mass off the centre of buoyancy",
                [0.1, -0.05, 0.15],
                [0.1, 0.0, -0.2, 0.3],
                1_000,
            ),
        ],
    }
}
