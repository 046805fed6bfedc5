//! Heavy tops in a chain or ring with elastic torques between the attitudes of neighbours; potentials are split over both ends of a
//! step. Takes the data of tops and bonds, attitudes, body momenta and the step size; gives attitudes and momenta.

use super::columns::{Columns, lane, of_sites, put_lane};
use super::instruction_set::{Steps, widest};
use super::turning::{Bodies, bond};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, cross, scaled, scaled_matrix,
};

/// The data of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Distance between tops.
    pub spacing: f64,
    /// Second moments of mass per unit length, body axes.
    pub poinsot: Matrix,
    /// Stiffness of the elastic torque, body axes.
    pub stiffness: Matrix,
    /// Weight per unit length times the vector from the support to the centre of mass, body axes.
    pub weight: Vector,
    /// Upward vertical, space axes.
    pub up: Vector,
    /// Whether the last top is a neighbour of the first.
    pub ring: bool,
}

/// A moving chain of tops.
#[derive(Clone, Debug)]
pub struct CoupledTops {
    bodies: Bodies,
    count: usize,
    ring: bool,
    /// Step size times spacing times weight, in the stored axes.
    weight: Vector,
    up: Vector,
    /// Step size over spacing times stiffness, in the stored axes.
    stiffness: Matrix,
    /// Attitudes, followed by the attitude of the first top of a ring.
    q: Columns<4>,
    /// Spatial momenta of the current node.
    m: Columns<3>,
    /// Spatial momenta of the outgoing edges.
    edges: Columns<3>,
    /// Spatial impulses of the bonds on the preceding top: before the first top, between tops, after the last.
    bonds: Columns<3>,
}

impl CoupledTops {
    /// Starts a trajectory with the body momenta of node 0.
    pub fn start(
        row: &Row,
        attitudes: &[Quaternion],
        body_momenta: &[Vector],
        h: f64,
    ) -> Result<CoupledTops, Unsolvable> {
        let count = attitudes.len();
        let bodies = Bodies::new(&[scaled_matrix(row.spacing, &row.poinsot)], h)?;
        let mut tops = CoupledTops {
            count,
            ring: row.ring,
            weight: scaled(h * row.spacing, &bodies.enter(&row.weight)),
            up: row.up,
            stiffness: scaled_matrix(h / row.spacing, &bodies.enter_matrix(&row.stiffness)),
            q: Columns::zeros(count + 1),
            m: Columns::zeros(count),
            edges: Columns::zeros(count),
            bonds: Columns::zeros(count + 1),
            bodies,
        };
        for (i, q) in attitudes.iter().enumerate() {
            tops.q.set(i, tops.bodies.enter_attitude(q).0);
        }
        tops.bond();
        for (i, (q, momentum)) in attitudes.iter().zip(body_momenta).enumerate() {
            let (momentum, kick) = (apply(&q.matrix(), momentum), tops.kick(i));
            tops.m.set(i, momentum);
            tops.edges.set(i, add_scaled(&momentum, 0.5, &kick));
        }
        Ok(tops)
    }

    /// Steps once; if one of the equations has no solution, attitudes are meaningless.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        widest(self)
    }

    /// Computes the impulses of all bonds at the current attitudes.
    #[inline(always)]
    fn bond(&mut self) {
        let count = match self.ring {
            true => {
                self.q.set(self.count, self.q.get(0));
                self.count
            }
            false => self.count - 1,
        };
        of_sites!(count, self.bond_of);
        if self.ring {
            self.bonds.set(0, self.bonds.get(self.count));
        }
    }

    #[inline(always)]
    fn bond_of<const L: usize>(&mut self, first: usize) {
        let (here, next) = (self.q.read::<L>(first), self.q.read::<L>(first + 1));
        let mut all = [[0.0; L]; 3];
        for at in 0..L {
            let here = Quaternion(lane(&here, at)).matrix();
            let next = Quaternion(lane(&next, at)).matrix();
            put_lane(&mut all, at, bond(&here, &next, &self.stiffness));
        }
        self.bonds.write(first + 1, &all);
    }

    /// The impulse at a node on the top between two bonds: half of it before the node, half after.
    #[inline(always)]
    fn kicked(&self, q: [f64; 4], before: &Vector, after: &Vector) -> Vector {
        let arm = apply(&Quaternion(q).matrix(), &self.weight);
        add_scaled(
            &add_scaled(&cross(&self.up, &arm), 1.0, after),
            -1.0,
            before,
        )
    }

    fn kick(&self, i: usize) -> Vector {
        self.kicked(self.q.get(i), &self.bonds.get(i), &self.bonds.get(i + 1))
    }

    #[inline(always)]
    fn kick_of<const L: usize>(&mut self, first: usize) {
        let (q, mut edges) = (self.q.read::<L>(first), self.edges.read::<L>(first));
        let mut m = [[0.0; L]; 3];
        let (before, after) = (self.bonds.read::<L>(first), self.bonds.read::<L>(first + 1));
        for at in 0..L {
            let kick = self.kicked(lane(&q, at), &lane(&before, at), &lane(&after, at));
            let edge = lane(&edges, at);
            put_lane(&mut m, at, add_scaled(&edge, 0.5, &kick));
            put_lane(&mut edges, at, add_scaled(&edge, 1.0, &kick));
        }
        self.m.write(first, &m);
        self.edges.write(first, &edges);
    }

    /// Attitudes body -> space at the current node.
    pub fn attitudes(&self) -> impl Iterator<Item = Quaternion> {
        (0..self.count).map(|i| self.bodies.leave_attitude(&Quaternion(self.q.get(i))))
    }

    /// Spatial momenta at the current node.
    pub fn spatial_momenta(&self) -> impl Iterator<Item = Vector> {
        (0..self.count).map(|i| self.m.get(i))
    }
}

impl Steps for CoupledTops {
    #[inline(always)]
    fn stepped(&mut self) -> Result<(), Unsolvable> {
        self.bodies.turn(&mut self.q, &self.edges, self.count)?;
        self.bond();
        of_sites!(self.count, self.kick_of);
        Ok(())
    }
}
