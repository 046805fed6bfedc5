//! Bodies with kinetic coupling between neighbours, compiled for every number of bodies.

clebsch::model! {
    /// Chain of rigid bodies whose kinetic energy couples neighbours.
    /// Each body has a point mass at d; the coupling is the scalar product of the velocities of neighbouring point masses.
    pub model CoupledBodyChain {
        label i in 0..N;
        periodic;
        /// second moments of mass, body frame
        param J: Sym<3>;
        /// position of the point mass, body frame
        param d: Vec<3>;
        /// coupling strength
        param eps: Real;
        group Λ: SO<3> at nodes velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - (eps/h)*dot((Ω - Id)*d, Λ^T*next(Λ, i)*(next(Ω, i) - Id)*d);
    }
}
