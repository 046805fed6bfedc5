//! Coupled heavy tops, compiled for every number of tops.

clebsch::model! {
    /// Heavy tops in a row or a ring, each turned towards the attitude of its neighbours.
    pub model CoupledTops {
        label i in 0..N step s;
        periodic;
        /// second moments of mass of a unit length, body frame
        param J: Sym<3>;
        /// stiffness against a difference of attitude
        param C: Sym<3>;
        /// weight of a unit length times the arm from its support to its centre of mass, body frame
        param gU: Vec<3>;
        /// the vertical, up, space frame
        param z: Vec<3>;
        group Λ: SO<3> at nodes velocity Ω;
        advected Γ: Vec<3> at nodes = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -s*tr(J*Ω)/h - h*s*dot(gU, Γ) + (h/s)*tr(C*Λ^T*next(Λ, i));
    }
}
