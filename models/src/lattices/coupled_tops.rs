//! Coupled heavy tops, compiled for every number of tops.

clebsch::model! {
    /// Chain or ring of heavy tops with an elastic coupling of neighbouring attitudes.
    pub model CoupledTops {
        label i in 0..N step s;
        periodic;
        /// second moments of mass per unit length, body frame
        param J: Sym<3>;
        /// stiffness against relative rotation of neighbours
        param C: Sym<3>;
        /// weight per unit length times the vector from support to centre of mass, body frame
        param gU: Vec<3>;
        /// vertical (up), space frame
        param z: Vec<3>;
        group Λ: SO<3> at nodes velocity Ω;
        advected Γ: Vec<3> at nodes = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -s*tr(J*Ω)/h - h*s*dot(gU, Γ) + (h/s)*tr(C*Λ^T*next(Λ, i));
    }
}
