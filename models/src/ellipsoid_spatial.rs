//! Elastic ellipsoid (affine body) seen from space, its energy a function of the second moments there (thesis 3.1.2,
//! with (3.35) corrected for potentials). Any number of dimensions from two to four.

use crate::case::{Case, Entry};
use crate::ellipsoids::ellipsoids;

clebsch::model! {
    /// Elastic ellipsoid, spatial representation.
    pub model EllipsoidSpatial {
        dim n in 2..=4;
        /// metric of space
        param C0: Sym<n> as "C_0";
        /// second moments of mass in the reference
        param I0: Sym<n> as "I_0";
        /// stiffness of lengths, of areas and of volumes
        param a, b, c: Real;
        /// resistance to collapse; without stress at the identity if d = 2 a + 2 (n - 1) b + 2 c
        param d: Real;
        /// placement, reference to space
        group Q: GL<n> velocity g;
        /// second moments in space
        advected S: Sym<n> = Q*I0*Q^T;
        constraint next(Q) = g*Q;
        constraint next(S) = g*S*g^T;
        let W = a*I1(S) + b*I2(S) + c*det(S) - (d/2)*log(det(S));
        lagrangian = tr(C0*(g - Id)*S*(g - Id)^T)/(2*h) - h*W;
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    // The momentum in space is C0 V I0 Q^T.
    let cases = ellipsoids().into_iter().map(|e| Case {
        initial: vec![e.placement(), e.spatial_momentum()],
        ..e.case()
    });
    Entry {
        card: EllipsoidSpatial::<3>::CARD,
        cases: cases.collect(),
    }
}
