//! A geometrically exact elastic rod: positions of the centreline at nodes, attitudes of sections at segments; potentials are split
//! over both ends of a step. Takes the data of the rod, positions, attitudes, momenta and the step size; gives positions, attitudes
//! and momenta at the nodes.

use super::columns::{Columns, lane, of_sites, put_lane};
use super::instruction_set::{Steps, widest};
use super::turning::{Bodies, bond};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, scaled, scaled_matrix,
};

/// The data of the rod.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod {
    /// Length of a segment.
    pub spacing: f64,
    /// Mass of each node.
    pub masses: Vec<f64>,
    /// Second moments of mass per unit length for each segment, section axes.
    pub poinsots: Vec<Matrix>,
    /// Stiffness against shear and extension, section axes.
    pub shear: Matrix,
    /// Stiffness against bending and twist, as second moments.
    pub bending: Matrix,
    /// Acceleration of gravity, space axes.
    pub gravity: Vector,
    /// Its ends.
    pub ends: Ends,
}

/// The ends of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// An open rod.
    Open {
        /// The first end.
        first: End,
        /// The last end.
        last: End,
    },
    /// A ring; positions increase by this once around.
    Ring(Vector),
}

/// One end of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// Free except for this force, spatial axes.
    Loaded(Vector),
    /// The node is fixed.
    Pinned,
    /// The node is fixed, and the section is coupled to a wall.
    Clamped {
        /// Attitude of the wall.
        wall: Quaternion,
        /// Stiffness of the coupling to the wall relative to a coupling between sections: two, because the distance
        /// is half as long.
        bonds: f64,
    },
}

impl End {
    /// A free end.
    pub const FREE: End = End::Loaded([0.0; 3]);
}

/// Precomputed data of an end.
#[derive(Clone, Copy, Debug)]
struct EndData {
    /// The fixed node, if any; its momentum is zero.
    node: Option<usize>,
    /// Impulse of the load.
    load: Vector,
    wall: Matrix,
    bonds: f64,
}

/// A moving rod.
#[derive(Clone, Debug)]
pub struct ElasticRod {
    bodies: Bodies,
    nodes: usize,
    segments: usize,
    ends: [EndData; 2],
    /// The increase of positions around a ring.
    ring: Option<Vector>,
    per_length: f64,
    /// Step size times stiffness, in the stored axes.
    shear: Matrix,
    /// The third axis of a section, in the stored axes.
    along: Vector,
    /// Step size over spacing times second moments, in the stored axes.
    bending: Matrix,
    gravity: Vector,
    /// Step size times mass, and step size over mass.
    masses: Columns<2>,
    /// Positions, followed by the first node of a ring once around.
    x: Columns<3>,
    /// Momenta of the nodes, and of their outgoing edges.
    p: Columns<3>,
    edges: Columns<3>,
    /// Attitudes, followed by the first section of a ring.
    q: Columns<4>,
    /// Spatial momenta of the sections, and of their outgoing edges.
    m: Columns<3>,
    section_edges: Columns<3>,
    /// Impulses of the segments on the preceding node: before the first node, for each segment, after the last node.
    forces: Columns<3>,
    /// Torque impulses of the segments on their sections.
    torques: Columns<3>,
    /// Impulses of the bonds on the preceding section: before the first section, between sections, after the last.
    bonds: Columns<3>,
}

impl ElasticRod {
    /// Starts a trajectory with the section momenta of node 0 in section axes. Momenta of fixed nodes stay zero.
    pub fn start(
        rod: &Rod,
        places: &[Vector],
        momenta: &[Vector],
        attitudes: &[Quaternion],
        body_momenta: &[Vector],
        h: f64,
    ) -> Result<ElasticRod, Unsolvable> {
        let (nodes, segments, s) = (places.len(), attitudes.len(), rod.spacing);
        let poinsots: Vec<Matrix> = rod.poinsots.iter().map(|j| scaled_matrix(s, j)).collect();
        let bodies = Bodies::new(&poinsots, h)?;
        let held = |end: End, node: usize| {
            let (wall, bonds) = match end {
                End::Clamped { wall, bonds } => (wall, bonds),
                _ => (Quaternion::IDENTITY, 0.0),
            };
            EndData {
                node: (!matches!(end, End::Loaded(_))).then_some(node),
                load: match end {
                    End::Loaded(force) => scaled(h, &force),
                    _ => [0.0; 3],
                },
                wall: bodies.enter_attitude(&wall).matrix(),
                bonds,
            }
        };
        let (first, last, ring) = match rod.ends {
            Ends::Open { first, last } => (first, last, None),
            Ends::Ring(growth) => (End::FREE, End::FREE, Some(growth)),
        };
        let mut rod = ElasticRod {
            nodes,
            segments,
            ends: [held(first, 0), held(last, nodes - 1)],
            ring,
            per_length: 1.0 / s,
            shear: scaled_matrix(h, &bodies.enter_matrix(&rod.shear)),
            along: bodies.enter(&[0.0, 0.0, 1.0]),
            bending: scaled_matrix(h / s, &bodies.enter_matrix(&rod.bending)),
            gravity: rod.gravity,
            masses: {
                let mut masses = Columns::zeros(nodes);
                for (i, mass) in rod.masses.iter().enumerate() {
                    masses.set(i, [h * mass, h / mass]);
                }
                masses
            },
            x: Columns::zeros(nodes + 1),
            p: Columns::zeros(nodes),
            edges: Columns::zeros(nodes),
            q: Columns::zeros(segments + 1),
            m: Columns::zeros(segments),
            section_edges: Columns::zeros(segments),
            forces: Columns::zeros(nodes + 1),
            torques: Columns::zeros(segments),
            bonds: Columns::zeros(segments + 1),
            bodies,
        };
        for (i, place) in places.iter().enumerate() {
            rod.x.set(i, *place);
        }
        for (i, q) in attitudes.iter().enumerate() {
            rod.q.set(i, rod.bodies.enter_attitude(q).0);
        }
        rod.pull();
        for (i, momentum) in momenta.iter().enumerate() {
            let edge = add_scaled(momentum, 0.5, &rod.kick_of_node(i));
            rod.p.set(i, *momentum);
            rod.edges.set(i, edge);
        }
        for (i, (q, momentum)) in attitudes.iter().zip(body_momenta).enumerate() {
            let momentum = apply(&q.matrix(), momentum);
            let edge = add_scaled(&momentum, 0.5, &rod.kick_of_section(i));
            rod.m.set(i, momentum);
            rod.section_edges.set(i, edge);
        }
        rod.hold();
        Ok(rod)
    }

    /// Steps once; if one of the equations has no solution, attitudes are meaningless.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        widest(self)
    }

    /// Computes the impulses of all segments and bonds in the current configuration.
    #[inline(always)]
    fn pull(&mut self) {
        if let Some(growth) = self.ring {
            self.x
                .set(self.nodes, add_scaled(&self.x.get(0), 1.0, &growth));
            self.q.set(self.segments, self.q.get(0));
        }
        of_sites!(self.segments, self.pull_of);
        if self.ring.is_some() {
            self.forces.set(0, self.forces.get(self.nodes));
            self.bonds.set(0, self.bonds.get(self.segments));
            return;
        }
        let [first, last] = &self.ends;
        self.forces.set(0, scaled(-1.0, &first.load));
        self.forces.set(self.nodes, last.load);
        let wall = |end: &EndData, section: usize| {
            let section = Quaternion(self.q.get(section)).matrix();
            scaled(end.bonds, &bond(&section, &end.wall, &self.bending))
        };
        let (first, last) = (wall(first, 0), wall(last, self.segments - 1));
        self.bonds.set(0, scaled(-1.0, &first));
        self.bonds.set(self.segments, last);
    }

    #[inline(always)]
    fn pull_of<const L: usize>(&mut self, first: usize) {
        let (x, x_next) = (self.x.read::<L>(first), self.x.read::<L>(first + 1));
        let (q, q_next) = (self.q.read::<L>(first), self.q.read::<L>(first + 1));
        let (mut forces, mut torques, mut bonds) = ([[0.0; L]; 3], [[0.0; L]; 3], [[0.0; L]; 3]);
        for at in 0..L {
            let here = Quaternion(lane(&q, at)).matrix();
            let next = Quaternion(lane(&q_next, at)).matrix();
            let chord = add_scaled(&lane(&x_next, at), -1.0, &lane(&x, at));
            let stretch = scaled(self.per_length, &apply_transposed(&here, &chord));
            let strain = add_scaled(&stretch, -1.0, &self.along);
            let force = apply(&here, &apply(&self.shear, &strain));
            put_lane(&mut forces, at, force);
            put_lane(&mut torques, at, cross(&chord, &force));
            put_lane(&mut bonds, at, bond(&here, &next, &self.bending));
        }
        self.forces.write(first + 1, &forces);
        self.torques.write(first, &torques);
        self.bonds.write(first + 1, &bonds);
    }

    /// The impulse on a site at a time node: half of it before the node, half after.
    fn kick_of_node(&self, i: usize) -> Vector {
        let [mass, _] = self.masses.get(i);
        let pulled = add_scaled(&self.forces.get(i + 1), -1.0, &self.forces.get(i));
        add_scaled(&pulled, mass, &self.gravity)
    }

    /// The spatial impulse on a section.
    fn kick_of_section(&self, i: usize) -> Vector {
        let bent = add_scaled(&self.bonds.get(i + 1), -1.0, &self.bonds.get(i));
        add_scaled(&self.torques.get(i), 1.0, &bent)
    }

    /// Sets the momenta of fixed nodes to zero.
    #[inline(always)]
    fn hold(&mut self) {
        for node in self.ends.iter().filter_map(|end| end.node) {
            self.p.set(node, [0.0; 3]);
            self.edges.set(node, [0.0; 3]);
        }
    }

    #[inline(always)]
    fn move_nodes<const L: usize>(&mut self, first: usize) {
        let (mut x, edges) = (self.x.read::<L>(first), self.edges.read::<L>(first));
        let [_, rates] = self.masses.read::<L>(first);
        for (x, edge) in x.iter_mut().zip(&edges) {
            for at in 0..L {
                x[at] += rates[at] * edge[at];
            }
        }
        self.x.write(first, &x);
    }

    #[inline(always)]
    fn kick_nodes<const L: usize>(&mut self, first: usize) {
        let (mut p, mut edges) = ([[0.0; L]; 3], self.edges.read::<L>(first));
        let (before, after) = (
            self.forces.read::<L>(first),
            self.forces.read::<L>(first + 1),
        );
        let [masses, _] = self.masses.read::<L>(first);
        for k in 0..3 {
            for at in 0..L {
                let kick = (after[k][at] - before[k][at]) + masses[at] * self.gravity[k];
                p[k][at] = edges[k][at] + 0.5 * kick;
                edges[k][at] += kick;
            }
        }
        self.p.write(first, &p);
        self.edges.write(first, &edges);
    }

    #[inline(always)]
    fn kick_sections<const L: usize>(&mut self, first: usize) {
        let (mut m, mut edges) = ([[0.0; L]; 3], self.section_edges.read::<L>(first));
        let torques = self.torques.read::<L>(first);
        let (before, after) = (self.bonds.read::<L>(first), self.bonds.read::<L>(first + 1));
        for k in 0..3 {
            for at in 0..L {
                let kick = torques[k][at] + (after[k][at] - before[k][at]);
                m[k][at] = edges[k][at] + 0.5 * kick;
                edges[k][at] += kick;
            }
        }
        self.m.write(first, &m);
        self.section_edges.write(first, &edges);
    }

    /// Positions of the nodes.
    pub fn places(&self) -> impl Iterator<Item = Vector> {
        (0..self.nodes).map(|i| self.x.get(i))
    }

    /// Momenta of the nodes at the current time; zero for fixed nodes.
    pub fn momenta(&self) -> impl Iterator<Item = Vector> {
        (0..self.nodes).map(|i| self.p.get(i))
    }

    /// Attitudes section -> space at the current time node.
    pub fn attitudes(&self) -> impl Iterator<Item = Quaternion> {
        (0..self.segments).map(|i| self.bodies.leave_attitude(&Quaternion(self.q.get(i))))
    }

    /// Spatial momenta of the sections at the current time node.
    pub fn spatial_momenta(&self) -> impl Iterator<Item = Vector> {
        (0..self.segments).map(|i| self.m.get(i))
    }
}

impl Steps for ElasticRod {
    #[inline(always)]
    fn stepped(&mut self) -> Result<(), Unsolvable> {
        self.bodies
            .turn(&mut self.q, &self.section_edges, self.segments)?;
        of_sites!(self.nodes, self.move_nodes);
        self.pull();
        of_sites!(self.nodes, self.kick_nodes);
        of_sites!(self.segments, self.kick_sections);
        self.hold();
        Ok(())
    }
}
