//! A chain of rigid links, compiled for every number of links.

clebsch::model! {
    /// Chain of beads joined by rigid links, suspended from its first bead.
    pub model HangingChain {
        label i in 0..N;
        periodic;
        /// mass of a bead
        param m: Real at nodes;
        /// length of a link
        param a: Real at segments;
        /// gravitational acceleration
        param g: Vec<3>;
        /// position of a bead
        field x: Vec<3> at nodes;
        hold λ: dot(next(x, i) - x, next(x, i) - x) = a^2;
        let V = (next(x) - x)/h;
        lagrangian = h*m*(dot(V, V)/2 + dot(g, x));
        end i = 0 {
            pinned { x = given; }
            free;
        }
        end i = N {
            free;
            pinned { x = given; }
        }
    }
}
