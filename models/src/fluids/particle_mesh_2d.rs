//! Particle-mesh shallow water in the plane, compiled for every number of particles.

clebsch::model! {
    /// Rotating shallow water in the plane, as particles whose depth lives on a grid and is smoothed there; each direction
    /// of the domain closes on itself or ends in walls.
    pub model ParticleMesh2D {
        time k step dt;
        label a in 0..N;
        grid n;
        /// mass of a particle
        param m: Real at a;
        /// weight of a node of the grid in the sum over the domain
        param w: Real at n;
        /// speed of long waves at depth 1
        param c0: Real;
        /// Coriolis parameter
        param f: Real;
        /// length over which the depth is smoothed
        param alpha: Real;
        /// place of a particle
        field X: Vec<2> at a on box;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X))
            - dt*(c0^2/2)*w*H*S;
    }
}
