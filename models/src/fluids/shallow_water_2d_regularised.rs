//! Two-dimensional shallow water with a smoothed depth, compiled for every number of particles.

clebsch::model! {
    /// Particle model of rotating shallow water on a doubly periodic plane, with smoothed Voronoi depths.
    /// A repulsive core keeps particles apart.
    pub model ShallowWater2DRegularised {
        time k step dt;
        label a in 0..N;
        /// mass of a particle
        param m: Real at a;
        /// gravitational acceleration
        param g: Real;
        /// Coriolis parameter
        param f: Real;
        /// smoothing length of the depth
        param alpha: Real;
        /// radius of the repulsive core
        param rc: Real;
        /// strength of the repulsive core
        param kappa: Real;
        /// position of a particle
        field X: Vec<2> at a on torus(L);
        mesh phi: Real at a = helmholtz_depth(X, m, alpha);
        mesh core: Real at a = pair_core(X, m, rc, kappa);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X))
            - dt*(g*m*phi/2 + core);
    }
}
