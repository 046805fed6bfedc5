//! The sine-Gordon equation, compiled for every number of points.

clebsch::model! {
    /// The sine-Gordon equation on a line of points: pendulums on a twisted wire.
    pub model SineGordon {
        label i in 0..N step s;
        periodic;
        /// weight of a node in the sum over the line: the spacing, half of it at an end
        param w: Real at nodes;
        /// square of the frequency of a pendulum by itself
        param k: Real;
        /// angle; once around the ring it grows by `L`
        field u: Real at nodes offset L;
        lagrangian = w*(next(u) - u)^2/(2*h) - h*(next(u, i) - u)^2/(2*s) - h*w*k*(1 - cos(u));
        end i = 0 { free; pinned { u = given; } }
        end i = N { free; pinned { u = given; } }
    }
}
