//! The sine-Gordon equation on a chain of points with free or pinned ends, or a ring. Takes spacing, node weights, the square of
//! the frequency, angles, momenta and the step size; gives angles and momenta at the nodes.

/// The data of the chain.
#[derive(Clone, Debug, PartialEq)]
pub struct Wire {
    /// Distance between points.
    pub spacing: f64,
    /// Weight of each node in the sum over the chain.
    pub weights: Vec<f64>,
    /// Square of the frequency of an uncoupled pendulum.
    pub stiffness: f64,
    /// Its ends.
    pub ends: Ends,
}

/// The ends of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Two ends; each may fix its node.
    Open {
        /// Whether the first node is fixed.
        first_pinned: bool,
        /// Whether the last node is fixed.
        last_pinned: bool,
    },
    /// A ring; angles increase by this once around.
    Ring(f64),
}

/// A moving chain.
#[derive(Clone, Debug)]
pub struct SineGordon {
    ends: Ends,
    /// Angles, followed by the first node once around.
    u: Vec<f64>,
    /// Momenta of the current node.
    p: Vec<f64>,
    /// Momenta of the outgoing edges.
    edges: Vec<f64>,
    /// Step size over weight; zero for a fixed node.
    rates: Vec<f64>,
    /// Step size times weight times the square of the frequency.
    weights: Vec<f64>,
    /// Step size over spacing.
    stiffness: f64,
    /// Impulses between neighbours: before the first node, between nodes, after the last.
    pull: Vec<f64>,
}

impl SineGordon {
    /// Starts a trajectory from angles and momenta at node 0; fixed nodes do not move.
    pub fn start(wire: &Wire, angles: &[f64], momenta: &[f64], h: f64) -> Self {
        let n = angles.len();
        let mut line = SineGordon {
            ends: wire.ends,
            u: [angles, &[0.0]].concat(),
            p: momenta.to_vec(),
            edges: momenta.to_vec(),
            rates: wire.weights.iter().map(|w| h / w).collect(),
            weights: wire
                .weights
                .iter()
                .map(|w| h * w * wire.stiffness)
                .collect(),
            stiffness: h / wire.spacing,
            pull: vec![0.0; n + 1],
        };
        if let Ends::Open {
            first_pinned,
            last_pinned,
        } = wire.ends
        {
            if first_pinned {
                line.rates[0] = 0.0;
            }
            if last_pinned {
                line.rates[n - 1] = 0.0;
            }
        }
        line.pulled();
        for i in 0..n {
            line.edges[i] += 0.5 * line.kick(i);
        }
        line
    }

    /// Computes the impulses between neighbours at the current angles.
    fn pulled(&mut self) {
        let n = self.p.len();
        let bonds = match self.ends {
            Ends::Open { .. } => n - 1,
            Ends::Ring(length) => {
                self.u[n] = self.u[0] + length;
                n
            }
        };
        for (pull, u) in self.pull[1..=bonds].iter_mut().zip(self.u.windows(2)) {
            *pull = self.stiffness * (u[1] - u[0]);
        }
        if let Ends::Ring(_) = self.ends {
            self.pull[0] = self.pull[n];
        }
    }

    /// The change of a node's momentum at a time node.
    #[inline(always)]
    fn kick(&self, i: usize) -> f64 {
        (self.pull[i + 1] - self.pull[i]) - self.weights[i] * self.u[i].sin()
    }

    /// One step.
    pub fn step(&mut self) {
        for ((u, edge), rate) in self.u.iter_mut().zip(&self.edges).zip(&self.rates) {
            *u += edge * rate;
        }
        self.pulled();
        for i in 0..self.p.len() {
            let kick = self.kick(i);
            self.p[i] = self.edges[i] + 0.5 * kick;
            self.edges[i] += kick;
        }
    }

    /// Angles of the nodes.
    pub fn angles(&self) -> &[f64] {
        &self.u[..self.p.len()]
    }

    /// Momenta of the nodes at the current time; for a fixed node, the sum of the impulses on it.
    pub fn momenta(&self) -> &[f64] {
        &self.p
    }
}
