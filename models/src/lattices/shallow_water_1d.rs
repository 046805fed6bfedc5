//! Rotating shallow water in one dimension, compiled for every number of particles.

clebsch::model! {
    /// Rotating shallow water in one dimension, as particles on a ring: places along it and across it.
    pub model ShallowWater1D {
        time k step dt;
        label i in 0..N;
        periodic;
        /// mass of a particle
        param m: Real at nodes;
        /// acceleration of gravity
        param g: Real;
        /// Coriolis parameter
        param f: Real;
        /// place along the channel; once around it grows by its length `L`
        field X: Real at nodes offset L;
        /// place across the channel
        field Y: Real at nodes;
        let depth = 2*m/(next(X, i) - prev(X, i));
        lagrangian = m*((next(X) - X)^2 + (next(Y) - Y)^2)/(2*dt) + m*f*((X + next(X))/2)*(next(Y) - Y) - dt*(g/2)*m*depth;
    }
}
