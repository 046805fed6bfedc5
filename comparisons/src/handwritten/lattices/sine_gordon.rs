//! The sine-Gordon equation on a line of points with free or pinned ends, or a ring.
//! Takes spacing, weights of the nodes and the square of the frequency, angles and momenta at a node, and the step; gives
//! both at the nodes.

/// What the line is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Wire {
    /// From point to point.
    pub spacing: f64,
    /// Weight of each node in the sum over the line.
    pub weights: Vec<f64>,
    /// Square of the frequency of a pendulum by itself.
    pub stiffness: f64,
    /// How it ends.
    pub ends: Ends,
}

/// How the line ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Two ends; whether the first and the last node are held where they are.
    Open {
        /// Whether the first one is.
        first_pinned: bool,
        /// Whether the last one is.
        last_pinned: bool,
    },
    /// A ring, angles growing by this once around.
    Ring(f64),
}

/// A line on its way.
#[derive(Clone, Debug)]
pub struct SineGordon {
    ends: Ends,
    /// Angles; behind them that of the first node once around.
    u: Vec<f64>,
    /// Momenta of the present node.
    p: Vec<f64>,
    /// Momenta of the edges that begin here.
    edges: Vec<f64>,
    /// Step over weight; zero where a node is held.
    rates: Vec<f64>,
    /// Step times weight times the square of the frequency.
    weights: Vec<f64>,
    /// Step over spacing.
    stiffness: f64,
    /// Impulses of the wire: before the first node, between nodes, behind the last one.
    pull: Vec<f64>,
}

impl SineGordon {
    /// Starts a trajectory from angles and momenta at node 0; those of held nodes stand still.
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

    /// Impulses of the wire at the present angles.
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

    /// What the momentum of a node changes by at it.
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

    /// Momenta of the nodes at the present one in time; of a held node the sum of what acted on it.
    pub fn momenta(&self) -> &[f64] {
        &self.p
    }
}
