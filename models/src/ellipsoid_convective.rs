//! An elastic ellipsoid (affine body) in the convective representation, with a Mooney-Rivlin material, in two to four
//! dimensions. See sections 3.1.2 and 3.2.3 of the thesis; (3.27) is corrected for potentials, and (3.61) for its
//! natural state.

use crate::case::{Case, Citations, Entry, Place};
use crate::ellipsoids::ellipsoids;
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Elastic ellipsoid, convective representation.
    pub model EllipsoidConvective {
        dim n in 2..=4;
        /// metric of space
        param C0: Sym<n> as "C_0";
        /// second moments of mass, reference configuration
        param I0: Sym<n> as "I_0";
        /// stiffness against changes of length, area and volume
        param a, b, c: Real;
        /// resistance to collapse; the identity is stress-free if d = 2 a + 2 (n - 1) b + 2 c
        param d: Real;
        /// placement, reference to space
        group Q: GL<n> velocity G;
        /// metric of space, pulled back to the reference configuration
        advected C: Sym<n> = Q^T*C0*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W;
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("3.1.2", "h"),
    places: &[
        (Place::Reconstruction("Q"), "(3.16)"),
        (Place::Rule("C"), "(3.23)"),
        (Place::Action, "(3.18) times $1/h$, with a potential"),
        (Place::ClebschAction, "(3.25)"),
        (Place::Relation("Q"), "(3.28)"),
        (Place::Relation("C"), "(3.28)"),
        (Place::Relation("G"), "(3.28)"),
        (Place::Lifted, "(3.32)"),
        (Place::Momentum, "(3.31) has the gradient alone for $M$"),
        (Place::AtStart, "(3.30)"),
        (
            Place::Balance,
            "(3.27) is the same for free motion, with the gradient alone for $M$; with a potential it is not",
        ),
    ],
};

/// The model and its cases.
pub fn entry() -> Entry {
    // The body momentum is Q^T C0 V I0.
    let cases = ellipsoids().into_iter().map(|e| Case {
        initial: vec![e.placement(), e.body_momentum()],
        ..e.case()
    });
    Entry {
        card: EllipsoidConvective::<3>::CARD,
        citations: CITATIONS,
        cases: cases.collect(),
    }
}
