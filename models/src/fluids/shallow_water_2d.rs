//! Two-dimensional shallow water on Voronoi cells, compiled for every number of particles.

clebsch::model! {
    /// Particle model of rotating shallow water on a doubly periodic plane, with Voronoi cells.
    /// The depth at a particle is its mass divided by the area of its cell.
    pub model ShallowWater2D {
        time k step dt;
        label a in 0..N;
        /// mass of a particle
        param m: Real at a;
        /// gravitational acceleration
        param g: Real;
        /// Coriolis parameter
        param f: Real;
        /// position of a particle
        field X: Vec<2> at a on torus(L);
        mesh A: Real at a = voronoi_area(X);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X)) - dt*g*m*(m/A)/2;
    }
}
