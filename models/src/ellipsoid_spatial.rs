//! An elastic ellipsoid (affine body) in the spatial representation, in two to four dimensions. Its energy is a
//! function of the second moments in space (thesis 3.1.2, with (3.35) corrected for potentials).

use crate::case::{Case, Citations, Entry, Place};
use crate::ellipsoids::ellipsoids;
use crate::thesis::{THESIS, system};

clebsch::model! {
    /// Elastic ellipsoid, spatial representation.
    pub model EllipsoidSpatial {
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
        group Q: GL<n> velocity g;
        /// second moments of mass, space frame
        advected S: Sym<n> = Q*I0*Q^T;
        constraint next(Q) = g*Q;
        constraint next(S) = g*S*g^T;
        let W = a*I1(S) + b*I2(S) + c*det(S) - (d/2)*log(det(S));
        lagrangian = tr(C0*(g - Id)*S*(g - Id)^T)/(2*h) - h*W;
    }
}

/// Its equations in the thesis, and the corrections.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: system!("3.1.2", "h"),
    places: &[
        (Place::Reconstruction("Q"), "(3.16)"),
        (Place::Rule("S"), "(3.24)"),
        (Place::Action, "(3.20) times $1/h$, with a potential"),
        (Place::ClebschAction, "(3.26)"),
        (
            Place::Relation("Q"),
            "(3.36), whose solved form prints $Γ$ for $γ$",
        ),
        (Place::Relation("S"), "(3.36)"),
        (Place::Relation("g"), "(3.36)"),
        (Place::Lifted, "(3.40)"),
        (
            Place::Momentum,
            "(3.39) has the gradient alone for $m$, and there the container's metric is missing",
        ),
        (
            Place::AtStart,
            "(3.38) corrected: there the last bracket closes too late",
        ),
        (
            Place::Balance,
            "(3.35) is the same for free motion, with the gradient alone for $m$; with a potential it is not",
        ),
    ],
};

/// The model and its cases.
pub fn entry() -> Entry {
    // The spatial momentum is C0 V I0 Q^T.
    let cases = ellipsoids().into_iter().map(|e| Case {
        initial: vec![e.placement(), e.spatial_momentum()],
        ..e.case()
    });
    Entry {
        card: EllipsoidSpatial::<3>::CARD,
        citations: CITATIONS,
        cases: cases.collect(),
    }
}
