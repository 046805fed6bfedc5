//! Toda's chain, compiled for every number of points.

clebsch::model! {
    /// Toda's chain: point masses on a line or a ring, joined by springs of exponential force.
    pub model TodaChain {
        label i in 0..N;
        periodic;
        /// mass of a point
        param m: Real;
        /// stiffness of a spring at rest, divided by `b`
        param a: Real;
        /// inverse length over which a spring softens
        param b: Real;
        /// place of a point; once around the ring it grows by `L`
        field q: Real at nodes offset L;
        let r = next(q, i) - q;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*((a/b)*exp(-b*r) + a*r);
    }
}
