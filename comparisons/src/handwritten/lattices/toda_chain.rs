//! Toda's chain: point masses coupled by springs of exponential force, on a chain with free ends or a ring. Takes mass, stiffness a
//! and softening b, positions, momenta and the step size; gives positions and momenta at the nodes.

/// The data of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// Mass of a point.
    pub mass: f64,
    /// Stiffness at equilibrium, divided by `softening`.
    pub stiffness: f64,
    /// Inverse length over which a spring softens.
    pub softening: f64,
}

/// The ends of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Both ends free.
    Open,
    /// A ring; positions increase by this once around.
    Ring(f64),
}

/// A moving chain.
#[derive(Clone, Debug)]
pub struct TodaChain {
    springs: Springs,
    ends: Ends,
    h: f64,
    /// Positions, followed by the first point once around.
    q: Vec<f64>,
    /// Momenta of the current node.
    p: Vec<f64>,
    /// Momenta of the outgoing edges.
    edges: Vec<f64>,
    /// Impulses of the springs: before the first point, between points, after the last.
    pull: Vec<f64>,
}

impl TodaChain {
    /// Starts a trajectory from positions and momenta at node 0.
    pub fn start(springs: Springs, ends: Ends, places: &[f64], momenta: &[f64], h: f64) -> Self {
        let mut chain = TodaChain {
            springs,
            ends,
            h,
            q: [places, &[0.0]].concat(),
            p: momenta.to_vec(),
            edges: momenta.to_vec(),
            pull: vec![0.0; places.len() + 1],
        };
        chain.pulled();
        for (edge, pull) in chain.edges.iter_mut().zip(chain.pull.windows(2)) {
            *edge += 0.5 * (pull[1] - pull[0]);
        }
        chain
    }

    /// Computes the impulses of all springs at the current positions.
    fn pulled(&mut self) {
        let Springs {
            stiffness,
            softening,
            ..
        } = self.springs;
        let (n, factor) = (self.p.len(), self.h * stiffness);
        if let Ends::Ring(length) = self.ends {
            self.q[n] = self.q[0] + length;
        }
        let springs = match self.ends {
            Ends::Open => n - 1,
            Ends::Ring(_) => n,
        };
        for (pull, q) in self.pull[1..=springs].iter_mut().zip(self.q.windows(2)) {
            *pull = factor * (1.0 - (-softening * (q[1] - q[0])).exp());
        }
        if let Ends::Ring(_) = self.ends {
            self.pull[0] = self.pull[n];
        }
    }

    /// One step.
    pub fn step(&mut self) {
        let rate = self.h / self.springs.mass;
        for (q, edge) in self.q.iter_mut().zip(&self.edges) {
            *q += edge * rate;
        }
        self.pulled();
        let nodes = self.p.iter_mut().zip(&mut self.edges);
        for ((p, edge), pull) in nodes.zip(self.pull.windows(2)) {
            let kick = pull[1] - pull[0];
            *p = *edge + 0.5 * kick;
            *edge += kick;
        }
    }

    /// Positions of the points.
    pub fn places(&self) -> &[f64] {
        &self.q[..self.p.len()]
    }

    /// Momenta of the points at the current node.
    pub fn momenta(&self) -> &[f64] {
        &self.p
    }
}
