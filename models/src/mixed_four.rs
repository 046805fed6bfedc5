//! Four configurations in four groups, coupled by springs: a body with a fixed point, a rigid motion, a second body
//! in unit quaternions, and a point mass with a quartic kinetic energy. The springs act at nodes, so that a step
//! solves for each configuration separately and by a different method.

use crate::case::{Case, Citations, Entry, Place, diagonal, identity};
use crate::thesis::THESIS;

clebsch::model! {
    /// Two rigid bodies with fixed points, a free rigid body and a point mass, coupled by springs.
    pub model MixedFour {
        /// second moments of mass of the first body about its fixed point, body frame
        param J: Sym<3>;
        /// second moments of mass of the free body about its reference point, body frame
        param A: Sym<3>;
        /// mass of the free body
        param M: Real;
        /// principal moments of inertia of the second body
        param I: Diag<3>;
        /// mass of the point mass
        param m: Real;
        /// coefficient of the quartic kinetic energy of the point mass
        param b: Real;
        /// stiffness of the springs
        param k: Real;
        /// attachment points of the springs, body frames: first body, free body, second body
        param p, s, e: Vec<3>;
        /// gravitational acceleration of the point mass, space frame
        param g: Vec<3>;
        /// attitude of the first body, body to space
        group R: SO<3> velocity V;
        /// position and attitude of the free body, body to space
        group G: SE<3> velocity W;
        /// attitude of the second body, body to space
        group q: SU<2> velocity Y;
        /// position of the point mass, space frame
        field X: Vec<3>;
        constraint next(R) = R*V;
        constraint next(G) = G*W;
        constraint next(q) = q*Y;
        let d = next(X) - X;
        let y = pos(next(G)) - pos(G);
        let apart = pos(G) + rot(G)*s - X;
        lagrangian = -tr(J*V)/h - tr(A*rot(W))/h + M*dot(y, y)/(2*h) + (2/h)*dot(im(Y), I*im(Y))
            + m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 + h*m*dot(g, X)
            - (h*k/2)*dot(X - R*p, X - R*p) - (h*k/2)*dot(apart, apart)
            - h*k*dot(rot(q)*e, R*p);
    }
}

/// The equations that also appear in the thesis.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: "",
    places: &[(Place::Reconstruction("R"), "(2.62)")],
};

fn case(name: &str, doc: &str, quartic: f64) -> Case {
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: 0.05,
        steps: 10_000,
        parameters: vec![
            diagonal([1.0, 0.7, 0.4]),
            diagonal([0.5, 0.8, 0.6]),
            vec![1.5],
            diagonal([0.9, 0.8, 0.5]),
            vec![1.2],
            vec![quartic],
            vec![0.9],
            vec![0.6, -0.2, 0.3],
            vec![0.2, 0.4, -0.1],
            vec![-0.3, 0.5, 0.4],
            vec![0.0, 0.0, -0.5],
        ],
        initial: vec![
            identity(),
            vec![0.3, -0.2, 0.6],
            vec![
                1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, -0.3, 0.0, 0.0, 1.0, 0.4, 0.0, 0.0, 0.0, 1.0,
            ],
            vec![-0.2, 0.4, 0.1, 0.3, 0.2, -0.1],
            vec![1.0, 0.0, 0.0, 0.0],
            vec![0.1, 0.5, -0.3],
            vec![0.8, 0.1, -0.2],
            vec![0.2, -0.4, 0.5],
        ],
        // All momenta are exact.
        bounds: Vec::new(),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: MixedFour::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "quartic",
                "all bodies in motion; initially the quartic kinetic energy of the point mass is a tenth of the quadratic part",
                0.3,
            ),
            case(
                "strongly-quartic",
                "the same motion, with a quartic kinetic energy of nearly half of the quadratic part",
                3.0,
            ),
        ],
    }
}
