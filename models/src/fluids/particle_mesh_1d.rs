//! Particle-mesh shallow water in one dimension, compiled for every number of particles.

clebsch::model! {
    /// Particle-mesh model of shallow water in one dimension, with a smoothed depth.
    pub model ParticleMesh1D {
        time k step dt;
        label a in 0..N;
        grid n;
        /// mass of a particle
        param m: Real at a;
        /// quadrature weight of a grid node
        param w: Real at n;
        /// speed of long gravity waves at depth 1
        param c0: Real;
        /// smoothing length of the depth
        param alpha: Real;
        /// position of a particle
        field X: Real at a on box;
        mesh H: Real at n = deposit(X, m);
        mesh S: Real at n = smooth(H, alpha);
        lagrangian = m*(next(X) - X)^2/(2*dt) - dt*(c0^2/2)*w*H*S;
    }
}
