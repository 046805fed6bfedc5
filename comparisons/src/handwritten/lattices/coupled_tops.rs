//! Heavy tops in a row or a ring, each turned towards the attitude of its neighbours; potentials split over both ends of a step.
//! Takes what tops and bonds are made of, attitudes and body momenta at a node, and the step; gives attitudes and momenta.

use super::columns::{Columns, lane, of_sites, put_lane};
use super::instruction_set::{Steps, widest};
use super::turning::{Bodies, bond};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, cross, scaled, scaled_matrix,
};

/// What the row is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// From top to top.
    pub spacing: f64,
    /// Second moments of mass of a unit length, body axes.
    pub poinsot: Matrix,
    /// Stiffness against a difference of attitude, body axes.
    pub stiffness: Matrix,
    /// Weight of a unit length times the vector from the support to the centre of mass, body axes.
    pub weight: Vector,
    /// Upward vertical, space axes.
    pub up: Vector,
    /// Whether the last top is a neighbour of the first.
    pub ring: bool,
}

/// A row on its way.
#[derive(Clone, Debug)]
pub struct CoupledTops {
    bodies: Bodies,
    count: usize,
    ring: bool,
    /// Step times spacing times weight, in the axes whose attitudes are kept.
    weight: Vector,
    up: Vector,
    /// Step over spacing times stiffness, in the same axes.
    stiffness: Matrix,
    /// Attitudes; behind them that of the first top of a ring.
    q: Columns<4>,
    /// Momenta of the present node, in space.
    m: Columns<3>,
    /// Momenta of the edges that begin here, in space.
    edges: Columns<3>,
    /// Impulses of the bonds on the top before them, in space: before the first top, between tops, behind the last one.
    bonds: Columns<3>,
}

impl CoupledTops {
    /// Starts a trajectory; momenta are those of node 0 in body axes.
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

    /// One step of the motion; attitudes are of no meaning when one of the equations has no solution.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        widest(self)
    }

    /// Impulses of all bonds at the present attitudes.
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

    /// What acts at a node on the top between two bonds: half of it before the node, half after.
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

    /// Attitudes body -> space at the present node.
    pub fn attitudes(&self) -> impl Iterator<Item = Quaternion> {
        (0..self.count).map(|i| self.bodies.leave_attitude(&Quaternion(self.q.get(i))))
    }

    /// Spatial momenta at the present node.
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
