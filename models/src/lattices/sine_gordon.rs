//! The sine-Gordon equation, compiled for every number of points.

clebsch::model! {
    /// Discrete sine-Gordon equation: a chain of pendulums on a torsion wire.
    pub model SineGordon {
        label i in 0..N step s;
        periodic;
        /// quadrature weight of a node: the spacing, half of it at an end
        param w: Real at nodes;
        /// squared frequency of an uncoupled pendulum
        param k: Real;
        /// angle; it increases by `L` once around a ring
        field u: Real at nodes offset L;
        lagrangian = w*(next(u) - u)^2/(2*h) - h*(next(u, i) - u)^2/(2*s) - h*w*k*(1 - cos(u));
        end i = 0 { free; pinned { u = given; } }
        end i = N { free; pinned { u = given; } }
    }
}
