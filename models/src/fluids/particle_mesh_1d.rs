//! Particle-mesh shallow water in one dimension, compiled for every number of particles.

clebsch::model! {
    /// Shallow water in one dimension, as particles whose depth lives on a grid and is smoothed there.
    pub model ParticleMesh1D {
        time k step dt;
        label a in 0..N;
        grid n;
        /// mass of a particle
        param m: Real at a;
        /// weight of a node of the grid in the sum over the domain
        param w: Real at n;
        /// speed of long waves at depth 1
        param c0: Real;
        /// length over which the depth is smoothed
        param alpha: Real;
        /// place of a particle
        field X: Real at a on box;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = m*(next(X) - X)^2/(2*dt) - dt*(c0^2/2)*w*H*S;
    }
}
