//! Rotating shallow water in one dimension, compiled for every number of particles.

clebsch::model! {
    /// Particle model of rotating shallow water on a ring, with positions along and across the channel.
    pub model ShallowWater1D {
        time k step dt;
        label i in 0..N;
        periodic;
        /// mass of a particle
        param m: Real at nodes;
        /// gravitational acceleration
        param g: Real;
        /// Coriolis parameter
        param f: Real;
        /// position along the channel; it increases by the length `L` once around
        field X: Real at nodes offset L;
        /// position across the channel
        field Y: Real at nodes;
        let depth = 2*m/(next(X, i) - prev(X, i));
        lagrangian = m*((next(X) - X)^2 + (next(Y) - Y)^2)/(2*dt) + m*f*((X + next(X))/2)*(next(Y) - Y) - dt*(g/2)*m*depth;
    }
}
