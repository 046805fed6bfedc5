//! Chains whose sites are coupled, against the same schemes written by hand: bodies coupled through their velocities, and the
//! inextensible rod. States are random, parameters vary from site to site if the model has such parameters, and tests cover all
//! ends and rings. A test checks that the comparison detects a relative change of 1e-6 in a datum.

use super::models::Random;
use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_comparisons::handwritten::attitude::{Matrix, Quaternion, Vector, apply_transposed};
use clebsch_comparisons::handwritten::lattices::body_chain::{Bodies, BodyChain};
use clebsch_comparisons::handwritten::lattices::inextensible_rod::{
    self as by_hand, InextensibleRod,
};
use clebsch_models::lattices::{coupled_body_chain::*, kirchhoff_rod::*};

const SIZES: [usize; 5] = [2, 3, 5, 12, 50];

/// Tolerance in rounding errors. Constraints and momenta are solved to 32 rounding errors of the terms of an equation. A constraint
/// contains two positions, so each solution may be off by 64 rounding errors of the largest position, with either sign. Arithmetic
/// adds a few.
const ROUNDINGS: f64 = 128.0;

/// Relative size of a planted mistake.
const SHARE: f64 = 1e-6;

/// Relative change of the data to measure the amplification of rounding: far above rounding, and small enough that two nearly
/// collinear segments still respond linearly.
const SMALL_SHARE: f64 = 1e-9;

/// Number of draws, because changes of opposite sign may cancel.
const DRAWS: u64 = 3;

/// The compared values; each kind has its own scale.
type Seen = Vec<Vec<f64>>;

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    clebsch::scalar::largest(a.iter().zip(b).map(|(x, y)| (x - y).abs()))
}

/// A lattice with its data.
trait Case: Sized {
    /// Kinds of data; kinds of the state come first.
    const KINDS: usize;
    /// The kinds that a step uses directly and whose rounding errors it amplifies.
    const ROUNDED: usize;
    fn name(&self) -> String;
    /// One kind of datum changed by a fraction of its size, up or down at random.
    fn nudged(&self, kind: usize, share: f64, draw: u64) -> Self;
    /// Whether the case has this kind.
    fn has(&self, _kind: usize) -> bool {
        true
    }
    fn by_hand(&self, steps: usize) -> Seen;
    fn generated(&self, steps: usize) -> Seen;
}

/// Largest differences from rounding, for each kind of compared value.
fn bounds<C: Case>(case: &C, own: &Seen, steps: usize) -> Vec<f64> {
    let mut magnified: Vec<f64> = own
        .iter()
        .map(|x| clebsch::scalar::largest(x.iter().map(|x| x.abs())))
        .collect();
    for kind in (0..C::ROUNDED).filter(|kind| case.has(*kind)) {
        let others = (1..=DRAWS).map(|draw| case.nudged(kind, SMALL_SHARE, draw).by_hand(steps));
        let others: Vec<Seen> = others.collect();
        for (k, all) in magnified.iter_mut().enumerate() {
            let each = others
                .iter()
                .map(|other| apart(&own[k], &other[k]) / SMALL_SHARE);
            *all += clebsch::scalar::largest(each);
        }
    }
    // Steps amplify the rounding error of one step at most by the factor of the remaining steps.
    let each = ROUNDINGS * f64::EPSILON * steps as f64;
    magnified.iter().map(|x| x * each).collect()
}

/// The largest difference in units of the bounds.
fn off(bounds: &[f64], a: &Seen, b: &Seen) -> f64 {
    let pairs = bounds.iter().zip(a.iter().zip(b));
    clebsch::scalar::largest(pairs.map(|(bound, (a, b))| apart(a, b) / bound))
}

fn agrees<C: Case>(case: &C, steps: usize) {
    let own = case.by_hand(steps);
    let bounds = bounds(case, &own, steps);
    let off = off(&bounds, &own, &case.generated(steps));
    assert!(off < 1.0, "{}, {steps} steps: {off:e}", case.name());
}

/// A planted mistake must exceed the bounds by a factor of ten.
fn mistakes_are_seen<C: Case>(case: &C) {
    let own = case.by_hand(1);
    let (bounds, generated) = (bounds(case, &own, 1), case.generated(1));
    for kind in (0..C::KINDS).filter(|kind| case.has(*kind)) {
        let wrong = off(&bounds, &case.nudged(kind, SHARE, 1).by_hand(1), &generated);
        assert!(wrong > 10.0, "{}, kind {kind}: {wrong:e}", case.name());
    }
}

/// Changes data by a fraction of their size, up or down at random.
struct Nudge(f64, Random);

impl Nudge {
    fn of(&mut self, size: f64) -> f64 {
        self.0 * size * self.1.number().signum()
    }

    fn all<'a>(&mut self, all: impl IntoIterator<Item = &'a mut f64>) {
        let mut all: Vec<&mut f64> = all.into_iter().collect();
        let size = clebsch::scalar::largest(all.iter().map(|x| x.abs()));
        all.iter_mut().for_each(|x| **x += self.of(size));
    }

    fn symmetric(&mut self, m: &mut Matrix) {
        let size = clebsch::scalar::largest(m.iter().flatten().map(|x| x.abs()));
        for [i, j] in [[0, 0], [1, 0], [1, 1], [2, 0], [2, 1], [2, 2]] {
            m[i][j] += self.of(size);
            m[j][i] = m[i][j];
        }
    }

    fn turn(&mut self, q: &mut Quaternion) {
        let [x, y, z] = [0.5; 3].map(|half| self.of(half));
        *q = q.times(&Quaternion([1.0, x, y, z])).normalised();
    }
}

fn vector(r: &mut Random, size: f64) -> Vector {
    (r.vector() * size).data.0[0]
}

fn turn(r: &mut Random, size: f64) -> Quaternion {
    Quaternion(Rotation::exp(&(r.vector() * size)).quaternion())
}

fn symmetric(r: &mut Random, [a, b, c]: Vector) -> Matrix {
    let turn = Rotation::exp(&r.vector()).matrix();
    let m = turn * Matrix3::from_diagonal(&Vector3::new(a, b, c)) * turn.transpose();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (m[(i, j)] + m[(j, i)])))
}

fn of_rows(m: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| m[i][j])
}

fn rotation(q: &Quaternion) -> Rotation {
    Rotation::from_quaternion(q.0).expect("a rotation")
}

fn entries(q: impl Iterator<Item = Matrix>) -> Vec<f64> {
    q.flat_map(|m| m.concat()).collect()
}

fn rows(m: Matrix3<f64>) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)]))
}

fn numbers<'a>(all: impl IntoIterator<Item = &'a SMatrix<f64, 3, 1>>) -> Vec<f64> {
    all.into_iter().flat_map(|x| x.data.0[0]).collect()
}

/// Bodies coupled through their velocities.
#[derive(Clone)]
struct Row {
    seed: u64,
    ring: bool,
    bodies: Bodies,
    turns: Vec<Quaternion>,
    momenta: Vec<Vector>,
    h: f64,
}

impl Row {
    fn drawn(n: usize, ring: bool, seed: u64) -> Self {
        let mut r = Random::new(seed);
        let bodies = Bodies {
            poinsot: symmetric(&mut r, [1.0, 0.8, 0.6]),
            arm: vector(&mut r, 0.5),
            eps: 0.3 + 0.1 * r.number(),
        };
        Row {
            seed,
            ring,
            bodies,
            turns: (0..n).map(|_| turn(&mut r, 0.7)).collect(),
            momenta: (0..n).map(|_| vector(&mut r, 1.0)).collect(),
            h: 0.04 + 0.01 * r.number(),
        }
    }
}

impl Case for Row {
    const KINDS: usize = 6;
    const ROUNDED: usize = 5;

    fn name(&self) -> String {
        format!(
            "{} bodies, ring {}, seed {}",
            self.turns.len(),
            self.ring,
            self.seed
        )
    }

    fn nudged(&self, kind: usize, share: f64, draw: u64) -> Self {
        let (mut all, mut r) = (
            self.clone(),
            Nudge(share, Random::new(self.seed + 77 * draw)),
        );
        match kind {
            0 => all.turns.iter_mut().for_each(|q| r.turn(q)),
            1 => r.all(all.momenta.iter_mut().flatten()),
            2 => r.symmetric(&mut all.bodies.poinsot),
            3 => r.all(&mut all.bodies.arm),
            4 => all.bodies.eps *= 1.0 + share,
            _ => all.h *= 1.0 + share,
        }
        all
    }

    fn by_hand(&self, steps: usize) -> Seen {
        let (turns, momenta) = (&self.turns, &self.momenta);
        let mut row =
            BodyChain::start(&self.bodies, self.ring, turns, momenta, self.h).expect("starts");
        for _ in 0..steps {
            row.step().expect("steps");
        }
        let turns = entries(row.attitudes().map(|q| q.matrix()));
        vec![turns, row.spatial_momenta().flatten().collect()]
    }

    fn generated(&self, steps: usize) -> Seen {
        let parameters = CoupledBodyChainParameters {
            J: of_rows(&self.bodies.poinsot),
            d: self.bodies.arm.into(),
            eps: self.bodies.eps,
        };
        let ends = match self.ring {
            true => CoupledBodyChainEnds::Ring,
            false => CoupledBodyChainEnds::Open,
        };
        let n = self.turns.len() - usize::from(!self.ring);
        let row = CoupledBodyChain::new(parameters, CoupledBodyChainSites { N: n, ends });
        let row = row.expect("bodies");
        let momenta = self.momenta.iter();
        let initial = CoupledBodyChainInitial {
            Λ: self.turns.iter().map(rotation).collect(),
            body_momentum_Λ: momenta.map(|m| BodyMomentum((*m).into())).collect(),
        };
        let (mut state, mut work) = row.start(initial, self.h).expect("starts");
        for _ in 0..steps {
            row.step(&mut state, &mut work).expect("steps");
        }
        let momenta: Vec<Vector3<f64>> = state.spatial_momentum_Λ().map(|m| m.0).collect();
        let turns = entries(state.Λ().map(|r| rows(r.matrix())));
        vec![turns, numbers(&momenta)]
    }
}

/// The inextensible rod.
#[derive(Clone)]
struct Rod {
    seed: u64,
    rod: by_hand::Rod,
    places: Vec<Vector>,
    p: Vec<Vector>,
    turns: Vec<Quaternion>,
    mu: Vec<Vector>,
    h: f64,
}

/// The ends of a rod: a constraint number for each end, or a ring.
type HeldEnds = Option<(usize, usize)>;

impl Rod {
    fn drawn(n: usize, held: HeldEnds, seed: u64) -> Self {
        let mut r = Random::new(seed);
        let nodes = n + usize::from(held.is_some());
        let spacing = 0.5 + 0.1 * r.number();
        let turns: Vec<Quaternion> = (0..n).map(|_| turn(&mut r, 0.8)).collect();
        let mut places = vec![vector(&mut r, 1.0)];
        for (i, q) in turns.iter().enumerate() {
            let (m, x) = (q.matrix(), places[i]);
            places.push([0, 1, 2].map(|k| x[k] + spacing * m[k][2]));
        }
        let (first, last) = (places[0], places[n]);
        let ends = match held {
            None => by_hand::Ends::Ring([0, 1, 2].map(|k| last[k] - first[k])),
            Some((first, last)) => by_hand::Ends::Open(
                match first {
                    0 => by_hand::First::Free,
                    1 => by_hand::First::Pinned,
                    _ => by_hand::First::Clamped(turn(&mut r, 0.4).matrix()),
                },
                match last {
                    0 => by_hand::Last::Free,
                    1 => by_hand::Last::Pinned,
                    _ => by_hand::Last::Load(vector(&mut r, 0.3)),
                },
            ),
        };
        places.truncate(nodes);
        let rod = by_hand::Rod {
            spacing,
            masses: (0..nodes).map(|_| 0.6 + 0.2 * r.number()).collect(),
            poinsots: (0..n)
                .map(|_| {
                    let moments = [0.3, 0.4, 0.5].map(|x| x + 0.1 * r.number());
                    symmetric(&mut r, moments)
                })
                .collect(),
            stiffness: symmetric(&mut r, [0.5, 0.4, 0.7]),
            gravity: vector(&mut r, 0.5),
            ends,
        };
        let p: Vec<Vector> = (0..nodes).map(|_| vector(&mut r, 0.4)).collect();
        let mu: Vec<Vector> = (0..n).map(|_| vector(&mut r, 0.4)).collect();
        let h = 0.02 + 0.005 * r.number();
        let drawn = Rod {
            seed,
            rod,
            places,
            p,
            turns,
            mu,
            h,
        };
        // Tangent momenta, which the emitted stepper requires.
        let along = drawn.started();
        let turns = along.attitudes().iter();
        let mu = turns.zip(along.spatial_momenta());
        Rod {
            p: along.momenta().to_vec(),
            mu: mu.map(|(q, m)| apply_transposed(&q.matrix(), &m)).collect(),
            ..drawn
        }
    }

    fn started(&self) -> InextensibleRod {
        let (turns, mu) = (&self.turns, &self.mu);
        InextensibleRod::start(&self.rod, &self.places, &self.p, turns, mu, self.h).expect("starts")
    }

    fn ends(&self) -> KirchhoffRodEnds<f64> {
        let (first, last) = match self.rod.ends {
            by_hand::Ends::Ring(across) => {
                return KirchhoffRodEnds::Ring { X: across.into() };
            }
            by_hand::Ends::Open(first, last) => (first, last),
        };
        KirchhoffRodEnds::Open {
            first: match first {
                by_hand::First::Free => KirchhoffRodFirst::Free,
                by_hand::First::Pinned => KirchhoffRodFirst::Pinned,
                by_hand::First::Clamped(wall) => KirchhoffRodFirst::Clamped {
                    Λw: of_rows(&wall)
                },
            },
            last: match last {
                by_hand::Last::Free => KirchhoffRodLast::Free,
                by_hand::Last::Pinned => KirchhoffRodLast::Pinned,
                by_hand::Last::Load(force) => KirchhoffRodLast::Load {
                    force: force.into(),
                },
            },
        }
    }
}

impl Case for Rod {
    const KINDS: usize = 13;
    const ROUNDED: usize = 10;

    fn name(&self) -> String {
        let (n, ends) = (self.turns.len(), &self.rod.ends);
        format!("a rod of {n}, {ends:?}, seed {}", self.seed)
    }

    fn has(&self, kind: usize) -> bool {
        use by_hand::{Ends, First, Last};
        let ends = &self.rod.ends;
        match kind {
            8 => matches!(ends, Ends::Open(First::Clamped(_), _)),
            9 => matches!(ends, Ends::Open(_, Last::Load(_))),
            10 => matches!(ends, Ends::Ring(_)),
            _ => true,
        }
    }

    fn nudged(&self, kind: usize, share: f64, draw: u64) -> Self {
        let (mut all, mut r) = (
            self.clone(),
            Nudge(share, Random::new(self.seed + 77 * draw)),
        );
        match (kind, &mut all.rod.ends) {
            (0, _) => r.all(all.places.iter_mut().flatten()),
            (1, _) => all.turns.iter_mut().for_each(|q| r.turn(q)),
            (2, _) => r.all(all.p.iter_mut().flatten()),
            (3, _) => r.all(all.mu.iter_mut().flatten()),
            (4, _) => r.all(&mut all.rod.masses),
            (5, _) => all.rod.poinsots.iter_mut().for_each(|j| r.symmetric(j)),
            (6, _) => r.symmetric(&mut all.rod.stiffness),
            (7, _) => r.all(&mut all.rod.gravity),
            (8, by_hand::Ends::Open(by_hand::First::Clamped(wall), _)) => {
                r.all(wall.iter_mut().flatten());
            }
            (9, by_hand::Ends::Open(_, by_hand::Last::Load(force))) => r.all(force),
            (10, by_hand::Ends::Ring(across)) => r.all(across),
            (11, _) => all.rod.spacing *= 1.0 + share,
            _ => all.h *= 1.0 + share,
        }
        all
    }

    fn by_hand(&self, steps: usize) -> Seen {
        let mut rod = self.started();
        for _ in 0..steps {
            rod.step().expect("steps");
        }
        vec![
            rod.places().concat(),
            rod.momenta().concat(),
            entries(rod.attitudes().iter().map(Quaternion::matrix)),
            rod.spatial_momenta().flatten().collect(),
            rod.tensions().concat(),
        ]
    }

    fn generated(&self, steps: usize) -> Seen {
        let parameters = KirchhoffRodParameters {
            s: self.rod.spacing,
            m: self.rod.masses.clone(),
            J: self.rod.poinsots.iter().map(of_rows).collect(),
            B: of_rows(&self.rod.stiffness),
            g: self.rod.gravity.into(),
        };
        let sites = KirchhoffRodSites {
            N: self.turns.len(),
            ends: self.ends(),
        };
        let rod = KirchhoffRod::new(parameters, sites).expect("a rod");
        let vectors = |all: &[Vector]| all.iter().map(|x| Vector3::from(*x)).collect();
        let momenta = self.mu.iter();
        let initial = KirchhoffRodInitial {
            φ: vectors(&self.places),
            momentum_φ: vectors(&self.p),
            Λ: self.turns.iter().map(rotation).collect(),
            body_momentum_Λ: momenta.map(|m| BodyMomentum((*m).into())).collect(),
        };
        let (mut state, mut work) = rod.start(initial, self.h).expect("starts");
        for _ in 0..steps {
            rod.step(&mut state, &mut work).expect("steps");
        }
        let momenta: Vec<Vector3<f64>> = state.spatial_momentum_Λ().map(|m| m.0).collect();
        vec![
            numbers(state.φ()),
            numbers(state.momentum_φ()),
            entries(state.Λ().map(|r| rows(r.matrix()))),
            numbers(&momenta),
            numbers(state.n()),
        ]
    }
}

/// Every combination of ends of a rod, and the ring.
fn all_ends() -> impl Iterator<Item = HeldEnds> {
    let open = (0..9).map(|ends| Some((ends / 3, ends % 3)));
    open.chain([None])
}

#[test]
fn bodies_step_as_by_hand() {
    for n in SIZES {
        for ring in [false, true] {
            for seed in 0..10 {
                agrees(&Row::drawn(n, ring, seed), 1);
            }
            agrees(&Row::drawn(n, ring, 20), 20);
        }
    }
}

#[test]
fn rods_step_as_by_hand() {
    for n in SIZES {
        for held in all_ends() {
            for seed in 0..5 {
                agrees(&Rod::drawn(n, held, seed), 1);
            }
            agrees(&Rod::drawn(n, held, 20), 20);
        }
    }
}

#[test]
fn data_changed_by_a_millionth_are_seen() {
    for ring in [false, true] {
        mistakes_are_seen(&Row::drawn(5, ring, 3));
    }
    for held in all_ends() {
        mistakes_are_seen(&Rod::drawn(5, held, 3));
    }
}
