//! Toda's chain: point masses joined by springs of exponential force, on a line with free ends or a ring.
//! Takes mass, stiffness a and softening b, places and momenta at a node, and the step; gives both at the nodes.

/// What the chain is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// Mass of a point.
    pub mass: f64,
    /// Stiffness at rest, divided by `softening`.
    pub stiffness: f64,
    /// Inverse length over which a spring softens.
    pub softening: f64,
}

/// How the chain ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Both free.
    Open,
    /// A ring, places growing by this once around.
    Ring(f64),
}

/// A chain on its way.
#[derive(Clone, Debug)]
pub struct TodaChain {
    springs: Springs,
    ends: Ends,
    h: f64,
    /// Places; behind them that of the first point once around.
    q: Vec<f64>,
    /// Momenta of the present node.
    p: Vec<f64>,
    /// Momenta of the edges that begin here.
    edges: Vec<f64>,
    /// Impulses of the springs: before the first point, between the points, behind the last one.
    pull: Vec<f64>,
}

impl TodaChain {
    /// Starts a trajectory from places and momenta at node 0.
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

    /// Impulses of all springs at the present places.
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

    /// Places of the points.
    pub fn places(&self) -> &[f64] {
        &self.q[..self.p.len()]
    }

    /// Momenta of the points at the present node.
    pub fn momenta(&self) -> &[f64] {
        &self.p
    }
}
