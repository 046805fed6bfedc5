//! Kirchhoff's rod, inextensible and unshearable: nodes of the centreline, attitudes of segments, and a force in each segment that
//! keeps it along the third axis of its section. Newton's method solves for the forces, starting from zero, with a
//! block-tridiagonal matrix; the momenta at the nodes are projected. Takes the data of the rod, positions, attitudes, momenta and
//! h; gives these at the nodes, and the forces of the last step.

use super::block_tridiagonal::BlockTridiagonal;
use super::section::{Section, Turn, apart, axial_of_product};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, largest, scaled, transposed, transposed_product,
};

/// The first end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum First {
    /// Free.
    Free,
    /// The first node is fixed.
    Pinned,
    /// The first node is fixed, and half a bond couples the first section to this frame.
    Clamped(Matrix),
}

/// The last end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Last {
    /// Free.
    Free,
    /// The last node is fixed.
    Pinned,
    /// This force acts on the last node, spatial axes.
    Load(Vector),
}

/// The ends of a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// An open rod.
    Open(First, Last),
    /// A ring of at least two segments: the last node is followed by the first, displaced by this vector.
    Ring(Vector),
}

/// The data of a rod: masses of nodes, and J of segments per unit length in section axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod {
    /// Length of a segment.
    pub spacing: f64,
    /// Masses of the nodes.
    pub masses: Vec<f64>,
    /// Poinsot (second moment) matrices per unit length, one for all segments or one for each.
    pub poinsots: Vec<Matrix>,
    /// B, where tr(B) Id - B is the stiffness against bending and twist.
    pub stiffness: Matrix,
    /// Acceleration of gravity, space axes.
    pub gravity: Vector,
    /// The ends.
    pub ends: Ends,
}

/// Maximum number of trials per step.
const MOST_TRIALS: usize = 40;

/// Constraint tolerance of a segment, in rounding errors of its terms.
const ROUNDINGS: f64 = 32.0;

/// Tolerance if trials no longer improve, because attitudes and positions have rounding errors of their own.
const STALLED: f64 = 4096.0;

/// A moving rod. Lists of nodes end with a copy of the first node of a ring.
#[derive(Clone, Debug)]
pub struct InextensibleRod {
    spacing: f64,
    stiffness: Matrix,
    ends: Ends,
    sections: Vec<Section>,
    /// h/m for each node; zero if the node is fixed.
    answers: Vec<f64>,
    /// h times the gravity and load on each node.
    forces: Vec<Vector>,
    places: Vec<Vector>,
    /// Momenta of nodes, and of their outgoing edges.
    p: Vec<Vector>,
    leaving: Vec<Vector>,
    q: Vec<Quaternion>,
    rotations: Vec<Matrix>,
    /// Momenta of segments in section axes, and of their outgoing edges.
    mu: Vec<Vector>,
    turning: Vec<Vector>,
    /// Impulses along segments, h times the force, with one extra entry at either end.
    impulses: Vec<Vector>,
    /// Forces of the last step, including the projection.
    tensions: Vec<Vector>,
    /// Positions, body momenta and rotations of a trial.
    trial: Vec<Vector>,
    kicked: Vec<Vector>,
    turns: Vec<Turn>,
    /// Moments of bonds over a step.
    moments: Vec<Vector>,
    right: Vec<Vector>,
    system: BlockTridiagonal<f64>,
    h: f64,
}

/// The map from a segment impulse to the section momentum: A u = s (Lam^T u) x E3.
#[inline(always)]
fn across(r: &Matrix, spacing: f64, u: &Vector) -> [f64; 2] {
    let along = |k: usize| r[0][k] * u[0] + r[1][k] * u[1] + r[2][k] * u[2];
    [spacing * along(1), -spacing * along(0)]
}

impl InextensibleRod {
    /// Starts a trajectory with the momenta of node 0, in section axes for segments. The momenta are projected.
    pub fn start(
        rod: &Rod,
        places: &[Vector],
        momenta: &[Vector],
        attitudes: &[Quaternion],
        body_momenta: &[Vector],
        h: f64,
    ) -> Result<InextensibleRod, Unsolvable> {
        let (n, nodes) = (attitudes.len(), places.len());
        let ring = matches!(rod.ends, Ends::Ring(_));
        let sections = rod.poinsots.iter();
        let sections = sections.map(|j| Section::new(j, rod.spacing, h));
        let mut answers: Vec<f64> = rod.masses.iter().map(|m| h / m).collect();
        let mut forces: Vec<Vector> = rod
            .masses
            .iter()
            .map(|m| scaled(h * m, &rod.gravity))
            .collect();
        if let Ends::Open(first, last) = rod.ends {
            if first != First::Free {
                answers[0] = 0.0;
            }
            match last {
                Last::Free => {}
                Last::Pinned => answers[nodes - 1] = 0.0,
                Last::Load(force) => {
                    forces[nodes - 1] = add_scaled(&forces[nodes - 1], h, &force);
                }
            }
        }
        let again = |list: &[Vector]| [list, &list[..usize::from(ring)]].concat();
        for (force, answer) in forces.iter_mut().zip(&answers) {
            if *answer == 0.0 {
                *force = [0.0; 3];
            }
        }
        let mut made = InextensibleRod {
            spacing: rod.spacing,
            stiffness: rod.stiffness,
            ends: rod.ends,
            sections: sections.collect::<Result<_, _>>()?,
            places: again(places),
            leaving: again(momenta),
            p: again(momenta),
            forces: again(&forces),
            answers: [&answers[..], &answers[..usize::from(ring)]].concat(),
            q: attitudes.to_vec(),
            rotations: attitudes.iter().map(Quaternion::matrix).collect(),
            mu: body_momenta.to_vec(),
            turning: vec![[0.0; 3]; n],
            impulses: vec![[0.0; 3]; n + 2],
            tensions: vec![[0.0; 3]; n],
            trial: again(places),
            kicked: vec![[0.0; 3]; n],
            turns: vec![Turn::NONE; n],
            moments: vec![[0.0; 3]; n],
            right: vec![[0.0; 3]; n],
            system: BlockTridiagonal::new(n, ring),
            h,
        };
        made.around();
        for i in 0..n {
            made.system
                .couple(i, -made.answers[i], -made.answers[i + 1]);
        }
        made.bend();
        made.project();
        made.leave();
        made.tensions.fill([0.0; 3]);
        if made.mu.iter().flatten().all(|x| x.is_finite()) {
            Ok(made)
        } else {
            Err(Unsolvable)
        }
    }

    /// Steps once; the state is unchanged if no forces are found.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        self.find()?;
        let n = self.q.len();
        for i in 0..n {
            let (turn, r) = (&self.turns[i], &mut self.rotations[i]);
            // The spatial momentum is constant along the edge.
            self.mu[i] = turn.seen_from_the_end(&self.kicked[i]);
            self.q[i] = turn.after(&self.q[i]);
            *r = self.q[i].matrix();
        }
        for i in 0..self.places.len() {
            let (back, on) = (&self.impulses[i], self.next_impulse(i));
            let kicked = add_scaled(&add_scaled(&self.leaving[i], 1.0, back), -1.0, &on);
            self.p[i] = add_scaled(&kicked, 0.5, &self.forces[i]);
        }
        std::mem::swap(&mut self.places, &mut self.trial);
        self.around();
        self.bend();
        for i in 0..n {
            self.mu[i] = add_scaled(&self.mu[i], 0.5, &self.moments[i]);
            self.tensions[i] = self.impulses[i + 1];
        }
        self.project();
        self.leave();
        for (n, impulse) in self.tensions.iter_mut().zip(&self.impulses[1..]) {
            *n = add_scaled(n, -1.0, impulse).map(|x| x / self.h);
        }
        Ok(())
    }

    /// The impulse of the segment that begins at a node.
    #[inline(always)]
    fn next_impulse(&self, node: usize) -> Vector {
        self.impulses[node + 1]
    }

    fn section(&self, i: usize) -> &Section {
        &self.sections[i.min(self.sections.len() - 1)]
    }

    /// Copies the first node of a ring behind the last.
    fn around(&mut self) {
        let n = self.q.len();
        if let Ends::Ring(across) = self.ends {
            self.places[n] = add_scaled(&self.places[0], 1.0, &across);
            self.p[n] = self.p[0];
        }
    }

    /// Copies the impulses at the ends of a ring's list to the other side.
    fn impulses_around(&mut self) {
        let n = self.q.len();
        if let Ends::Ring(_) = self.ends {
            (self.impulses[0], self.impulses[n + 1]) = (self.impulses[n], self.impulses[1]);
        }
    }

    /// Finds the impulses for which segments are along their section axes at the end of the step.
    #[inline(always)]
    fn find(&mut self) -> Result<(), Unsolvable> {
        self.impulses.fill([0.0; 3]);
        let mut before = f64::INFINITY;
        for trial in 0..MOST_TRIALS {
            let off = self.reach()?;
            if off <= ROUNDINGS || off > 0.5 * before && off <= STALLED {
                return Ok(());
            }
            if !off.is_finite() {
                return Err(Unsolvable);
            }
            // The previous matrix reduces the residual by the same factor as before, which is enough.
            if trial > 0 && off * (off / before) <= ROUNDINGS {
                self.system.solve(&mut self.right);
            } else {
                self.factor();
            }
            for (y, d) in self.impulses[1..].iter_mut().zip(&self.right) {
                *y = add_scaled(y, 1.0, d);
            }
            self.impulses_around();
            before = off;
        }
        Err(Unsolvable)
    }

    /// Evaluates a trial: returns the largest deviation of a segment from its axis, in rounding errors.
    #[inline(always)]
    fn reach(&mut self) -> Result<f64, Unsolvable> {
        let n = self.q.len();
        let (mut worst, mut lost) = (0.0_f64, 0.0);
        for i in 0..self.places.len() {
            let kick = add_scaled(&self.impulses[i], -1.0, &self.next_impulse(i));
            let kicked = add_scaled(&self.leaving[i], 1.0, &kick);
            self.trial[i] = add_scaled(&self.places[i], self.answers[i], &kicked);
        }
        for i in 0..n {
            let (section, r) = (self.section(i), &self.rotations[i]);
            let [x, y] = across(r, self.spacing, &self.impulses[i + 1]);
            let m = self.turning[i];
            let kicked = [m[0] + x, m[1] + y, m[2]];
            let turn = section.turn(&kicked)?;
            let (from, to) = (&self.trial[i], &self.trial[i + 1]);
            let segment = add_scaled(to, -1.0, from);
            let off = add_scaled(&segment, -self.spacing, &apply(r, &turn.axis));
            let size =
                largest(&off) / (f64::EPSILON * (largest(from) + largest(to) + self.spacing));
            worst = worst.max(size);
            lost += 0.0 * size;
            self.right[i] = scaled(-1.0, &off);
            self.kicked[i] = kicked;
            self.turns[i] = turn;
        }
        Ok(worst + lost)
    }

    /// Factors Newton's matrix at a trial and computes the correction.
    #[inline(always)]
    fn factor(&mut self) {
        for i in 0..self.q.len() {
            let section = &self.sections[i.min(self.sections.len() - 1)];
            let own = section.answer(&self.turns[i], &self.rotations[i]);
            let own = apart(&own, self.answers[i] + self.answers[i + 1]);
            self.system.eliminate(i, &own, &mut self.right);
        }
        self.system.substitute(&mut self.right);
    }

    /// Moments of the bonds at the new attitudes, over the step, section axes.
    #[inline(always)]
    fn bend(&mut self) {
        let (n, b) = (self.q.len(), self.stiffness);
        let share = self.h / self.spacing;
        self.moments[0] = [0.0; 3];
        if let Ends::Open(First::Clamped(wall), _) = self.ends {
            // B Lamw^T Lam, whose axial vector is minus that of the transpose.
            let towards = transposed_product(&self.rotations[0], &wall);
            self.moments[0] = scaled(2.0 * share, &axial_of_product(&towards, &b));
        }
        let bonds = match self.ends {
            Ends::Open(..) => n - 1,
            Ends::Ring(_) => n,
        };
        for i in 0..bonds {
            let next = if i + 1 < n { i + 1 } else { 0 };
            let bond = transposed_product(&self.rotations[i], &self.rotations[next]);
            self.moments[i] = add_scaled(&self.moments[i], share, &axial_of_product(&bond, &b));
            let on_next = axial_of_product(&transposed(&bond), &b);
            self.moments[next] = match next {
                0 => add_scaled(&self.moments[0], share, &on_next),
                _ => scaled(share, &on_next),
            };
        }
    }

    /// Removes the momentum components that would move segments off their axes.
    #[inline(always)]
    fn project(&mut self) {
        let n = self.q.len();
        for i in 0..n {
            let r = &self.rotations[i];
            let (section, mu) = (&self.sections[i.min(self.sections.len() - 1)], &self.mu[i]);
            let [x, y] = section.axis_velocity(mu);
            let of = |k: usize| x * r[k][0] + y * r[k][1];
            let turned = [of(0), of(1), of(2)];
            let ahead = scaled(self.answers[i + 1], &self.p[i + 1]);
            let rate = add_scaled(&ahead, -self.answers[i], &self.p[i]);
            self.right[i] = add_scaled(&rate, 1.0, &turned);
            let own = apart(
                &section.answer_at_rest(r),
                self.answers[i] + self.answers[i + 1],
            );
            self.system.eliminate(i, &own, &mut self.right);
        }
        self.system.substitute(&mut self.right);
        self.impulses[1..=n].copy_from_slice(&self.right);
        self.impulses_around();
        for i in 0..n {
            let [x, y] = across(&self.rotations[i], self.spacing, &self.impulses[i + 1]);
            let mu = &mut self.mu[i];
            (mu[0], mu[1]) = (mu[0] - x, mu[1] - y);
        }
        for i in 0..self.p.len() {
            let taken = add_scaled(&self.impulses[i], -1.0, &self.next_impulse(i));
            self.p[i] = add_scaled(&self.p[i], -1.0, &taken);
        }
    }

    /// Momenta of the outgoing edges; a fixed node has zero momentum.
    #[inline(always)]
    fn leave(&mut self) {
        let last = self.p.len() - 1;
        for node in [0, last] {
            if self.answers[node] == 0.0 {
                self.p[node] = [0.0; 3];
            }
        }
        for i in 0..self.q.len() {
            self.turning[i] = add_scaled(&self.mu[i], 0.5, &self.moments[i]);
        }
        for i in 0..self.p.len() {
            self.leaving[i] = add_scaled(&self.p[i], 0.5, &self.forces[i]);
        }
    }

    /// The number of nodes.
    fn nodes(&self) -> usize {
        self.places.len() - usize::from(matches!(self.ends, Ends::Ring(_)))
    }

    /// Positions at the current time node.
    pub fn places(&self) -> &[Vector] {
        &self.places[..self.nodes()]
    }

    /// Momenta of the nodes of the rod.
    pub fn momenta(&self) -> &[Vector] {
        &self.p[..self.nodes()]
    }

    /// Attitudes of segments, section -> space.
    pub fn attitudes(&self) -> &[Quaternion] {
        &self.q
    }

    /// Spatial momenta of segments.
    pub fn spatial_momenta(&self) -> impl ExactSizeIterator<Item = Vector> {
        let all = self.rotations.iter().zip(&self.mu);
        all.map(|(r, mu)| apply(r, mu))
    }

    /// Forces in segments during the last step, spatial axes; zero at the start.
    pub fn tensions(&self) -> &[Vector] {
        &self.tensions
    }
}
