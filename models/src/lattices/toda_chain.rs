//! Toda's chain, compiled for every number of points.

clebsch::model! {
    /// Toda lattice: point masses on a line or a ring, joined by exponential springs.
    pub model TodaChain {
        label i in 0..N;
        periodic;
        /// mass of a point
        param m: Real;
        /// stiffness of a spring at its natural length, divided by `b`
        param a: Real;
        /// inverse length scale of the exponential force
        param b: Real;
        /// displacement of a point mass; it increases by `L` once around a ring
        field q: Real at nodes offset L;
        let r = next(q, i) - q;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*((a/b)*exp(-b*r) + a*r);
    }
}
