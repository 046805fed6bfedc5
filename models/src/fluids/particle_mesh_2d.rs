//! Particle-mesh shallow water in the plane, compiled for every number of particles.

clebsch::model! {
    /// Particle-mesh model of rotating shallow water in the plane, with a smoothed depth.
    /// Each direction of the domain is periodic or bounded by walls.
    pub model ParticleMesh2D {
        time k step dt;
        label a in 0..N;
        grid n;
        /// mass of a particle
        param m: Real at a;
        /// quadrature weight of a grid node
        param w: Real at n;
        /// speed of long gravity waves at depth 1
        param c0: Real;
        /// Coriolis parameter
        param f: Real;
        /// smoothing length of the depth
        param alpha: Real;
        /// position of a particle
        field X: Vec<2> at a on box;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X))
            - dt*(c0^2/2)*w*H*S;
    }
}
