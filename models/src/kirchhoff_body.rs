//! A rigid body in an ideal fluid (Kirchhoff 1869; Lamb, Hydrodynamics, chapter VI). The kinetic energy is a
//! quadratic form in angular and linear velocity, which includes the added masses of the fluid. The rotation is
//! discretised as by Moser and Veselov. The linear velocity of a step is the mean of its translation in the body
//! frames at both ends, so that the step is symmetric in time.

use crate::case::{Case, Citations, Entry, bounds, diagonal};

clebsch::model! {
    /// Rigid body in an ideal fluid, with added masses, coupling, and net weight.
    pub model KirchhoffBody {
        /// Poinsot matrix of the rotational inertia, fluid included
        param J: Sym<3>;
        /// mass and added masses
        param M: Sym<3>;
        /// coupling of rotation and translation
        param D: Mat<3>;
        /// (moment of weight less buoyancy, net weight), body frame
        param b: Vec<4>;
        /// (vertical up, 0), the plane of height 0 in space
        param Z: Vec<4>;
        /// position, body to space
        group G: SE<3> velocity V;
        /// (vertical, height) seen from the body
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
                "neutrally buoyant body with three planes of symmetry, 2000 steps",
                [0.0; 3],
                [0.0; 4],
                2_000,
            ),
            case(
                "screw",
                "neutrally buoyant body whose rotation and translation are coupled",
                [0.1, -0.05, 0.15],
                [0.0; 4],
                2_000,
            ),
            case(
                "floating",
                "weight and buoyancy in balance, the centre of mass off the centre of buoyancy",
                [0.1, -0.05, 0.15],
                [0.1, 0.0, -0.2, 0.0],
                2_000,
            ),
            case(
                "sinking",
                "a heavy body, its centre of mass off the centre of buoyancy",
                [0.1, -0.05, 0.15],
                [0.1, 0.0, -0.2, 0.3],
                1_000,
            ),
        ],
    }
}
