//! Bodies with kinetic coupling between neighbours, compiled for every number of bodies.

clebsch::model! {
    /// Bodies in a row whose kinetic energy joins the velocities of neighbours: each carries a mass at d
    /// that drags on that of the next one.
    pub model CoupledBodyChain {
        label i in 0..N;
        periodic;
        /// second moments of mass, body frame
        param J: Sym<3>;
        /// place of the mass, body frame
        param d: Vec<3>;
        /// strength of the coupling
        param eps: Real;
        group Λ: SO<3> at nodes velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - (eps/h)*dot((Ω - Id)*d, Λ^T*next(Λ, i)*(next(Ω, i) - Id)*d);
    }
}
