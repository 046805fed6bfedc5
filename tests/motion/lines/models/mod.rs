//! The tested chains: their steppers, random states, and hand-written sums of their actions.

use super::action::{Configuration, D};
use clebsch::nalgebra::{Matrix3, SVector, Vector3};
use clebsch::of_numbers::Shown;
use clebsch::{BodyMomentum, Dual, Rotation};

mod beta_plane;
mod bodies;
mod cells;
mod chain;
mod charges;
pub mod cloud;
mod coupled_velocities;
mod dense;
pub mod grid;
mod kirchhoff;
mod name_collisions;
mod newton_sites;
mod non_quadratic;
mod quartic;
mod quaternions;
mod rod;
mod sine;
mod sums;
mod tension;
mod toda;
mod tops;
mod water;

pub use beta_plane::Beta;
pub use bodies::{Beaded, Bodies, Dragged};
pub use cells::{Cells, Smoothed};
pub use chain::Chain;
pub use charges::Charges;
pub use cloud::Cloud;
pub use coupled_velocities::{Linked, LinkedChainState, Woven};
pub use grid::{Basin, Plane};
pub use kirchhoff::{Ends, Kirchhoff};
pub use name_collisions::Named;
pub use newton_sites::Bent;
pub use non_quadratic::Fast;
pub use quartic::Quartic;
pub use quaternions::{QRod, Spins, TwistedSpinsOf, turn};
pub use rod::{EndCondition, Rod};
pub use sine::Sine;
pub use toda::Toda;
pub use tops::Tops;
pub use water::Water;

/// A number with derivatives with respect to the positions and momenta of six sites.
pub type Wide = Dual<12>;

/// A tested chain.
pub trait Line {
    /// A description for failure messages.
    fn name(&self) -> String;
    /// The number of terms of its action.
    fn terms(&self) -> usize;
    /// The action of an edge, with a weight for each term.
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D;
    /// Whether an end prescribes this coordinate.
    fn held(&self, _: usize) -> bool {
        false
    }
    /// Three consecutive nodes from a random start.
    fn three(&self, seed: u64) -> [Configuration<f64>; 3];
    /// The momenta at the first node.
    fn given(&self, seed: u64) -> Vec<f64>;
    /// The distance between the start and the end of a run forward and back.
    fn there_and_back(&self, steps: u64) -> f64;
    /// The largest relative changes of the energy and of a conserved total.
    fn kept(&self, steps: u64) -> [f64; 2];
    /// The bound on the energy change.
    fn energy_bound(&self) -> f64;
    /// The energy change divided by the change at half the step size.
    fn energy_ratio(&self) -> f64;
    /// The largest mass divided by the step size, which converts position rounding to momentum rounding.
    fn mass_by_step(&self) -> f64;

    /// The constraint functions at a node, up to constants.
    fn constraints(&self, _: &Configuration<D>) -> Vec<D> {
        Vec::new()
    }

    /// Whether its potential is twice differentiable. Cell potentials jump where neighbours change, and particles without
    /// short-range repulsion form pairs; then the energy has no guaranteed bound.
    fn is_smooth(&self) -> bool {
        true
    }

    /// The weights of the unmodified action.
    fn weights(&self) -> Vec<f64> {
        vec![1.0; self.terms()]
    }

    /// The weights with the sign of one term flipped.
    fn flipped(&self, term: usize) -> Vec<f64> {
        let mut weights = self.weights();
        weights[term] = -1.0;
        weights
    }
}

/// Every chain of this size, with every end.
pub fn all(n: usize) -> Vec<Box<dyn Line>> {
    let mut out: Vec<Box<dyn Line>> = vec![
        Box::new(Toda::ring(n)),
        Box::new(Toda { n, ring: false }),
        Box::new(Tops::new(n, false)),
        Box::new(Tops::new(n, true)),
        Box::new(Water::new(n)),
        Box::new(Charges::new(n)),
        Box::new(Cloud { n }),
        Box::new(Plane { n, walls: false }),
    ];
    // With fewer than five particles, a cell meets its own images around the torus.
    if n >= 5 {
        out.push(Box::new(Cells { n }));
        out.push(Box::new(Smoothed { n }));
        out.push(Box::new(Beta { n }));
    }
    for ring in [false, true] {
        out.push(Box::new(Bent { n, ring }));
    }
    let linked = (0..4).map(|ends| Linked { n, ends });
    out.extend(linked.map(|line| Box::new(line) as Box<dyn Line>));
    for ring in [false, true] {
        out.push(Box::new(Woven { n, ring }));
        out.push(Box::new(Bodies { n, ring }));
        if n > 1 {
            // In a ring of one site, a bead has no potential.
            out.push(Box::new(Beaded { n, ring }));
        }
    }
    let fast = (0..4).filter(|ends| n > 1 || *ends < 4);
    out.extend(fast.map(|ends| Box::new(Fast { n, ends }) as Box<dyn Line>));
    let dragged = (0..5).filter(|ends| n > 1 || *ends < 4);
    out.extend(dragged.map(|ends| Box::new(Dragged { n, ends }) as Box<dyn Line>));
    let quartic = (0..4).map(|ends| Quartic { n, ends });
    out.extend(quartic.map(|line| Box::new(line) as Box<dyn Line>));
    out.push(Box::new(Named { n, end: false }));
    out.push(Box::new(Named { n, end: true }));
    let sine = (0..5).filter(|ends| n > 1 || *ends < 4);
    out.extend(sine.map(|ends| Box::new(Sine::new(n, ends)) as Box<dyn Line>));
    let chains = (0..5).filter(|ends| n > 2 || *ends < 3);
    out.extend(chains.map(|ends| Box::new(Chain { n, ends }) as Box<dyn Line>));
    out.extend(
        kirchhoff::all(n)
            .into_iter()
            .map(|line| Box::new(line) as Box<dyn Line>),
    );
    let tension = tension::all(n).into_iter();
    out.extend(tension.map(|line| Box::new(line) as Box<dyn Line>));
    let sums = sums::all(n).into_iter();
    out.extend(sums.map(|line| Box::new(line) as Box<dyn Line>));
    out.push(Box::new(Rod::free(n)));
    if n > 1 {
        out.push(Box::new(Rod::new(n, None)));
        let ends = EndCondition::FIRST
            .iter()
            .flat_map(|f| EndCondition::LAST.map(|l| [*f, l]));
        for ends in ends.filter(|ends| *ends != [EndCondition::Free; 2]) {
            out.push(Box::new(Rod::new(n, Some(ends))));
        }
    }
    let rods = 0..10;
    out.extend(rods.map(|ends| Box::new(QRod { n, ends }) as Box<dyn Line>));
    for ring in [false, true] {
        out.push(Box::new(Spins { n, ring }));
    }
    out
}

/// Random numbers in (-1, 1).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(12345))
    }
    pub fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1u64 << 53) as f64).mul_add(2.0, -1.0)
    }
    /// `count` columns with entries up to `size`.
    fn list<const R: usize>(&mut self, count: usize, size: f64) -> Vec<SVector<f64, R>> {
        let mut column = || SVector::from_fn(|_, _| size * self.number());
        (0..count).map(|_| column()).collect()
    }
    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.number())
    }
}

/// The attitudes of `n` bodies, and their momenta.
fn attitudes(n: usize, r: &mut Random) -> (Vec<Rotation>, Vec<BodyMomentum>) {
    let turns = (0..n).map(|_| Rotation::exp(&(r.vector() * 0.7)));
    let turns = turns.collect();
    (turns, (0..n).map(|_| BodyMomentum(r.vector())).collect())
}

/// The scalars of a list.
fn numbers<T: Shown + Copy>(list: &[T]) -> Vec<f64> {
    list.iter().copied().flat_map(Shown::numbers).collect()
}

fn c(x: f64) -> D {
    D::constant(x)
}

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

/// Implements the methods that use the stepper alone.
macro_rules! stepped {
    ([$($momentum:ident)*], $h:expr, $bound:expr, $mass:expr) => {
        stepped!([$($momentum)*], $h, $bound);
        fn mass_by_step(&self) -> f64 {
            $mass
        }
    };
    ([$($momentum:ident)*], $h:expr, $bound:expr) => {
        fn given(&self, seed: u64) -> Vec<f64> {
            let all = self.initial(seed);
            let lists = [$(super::numbers(&all.$momentum)),*];
            lists.concat()
        }
        fn three(&self, seed: u64) -> [Configuration<f64>; 3] {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(seed), $h).expect("starts");
            let a = self.seen(&state);
            model.step(&mut state, &mut work).expect("steps");
            let b = self.seen(&state);
            model.step(&mut state, &mut work).expect("steps");
            [a, b, self.seen(&state)]
        }
        fn there_and_back(&self, steps: u64) -> f64 {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(7), $h).expect("starts");
            let from = self.seen(&state);
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("steps");
            }
            let mut back = model.workspace(&state, -$h).expect("a step back");
            for _ in 0..steps {
                model.step(&mut state, &mut back).expect("steps back");
            }
            let to = self.seen(&state);
            let x = from.x.iter().zip(&to.x).map(|(a, b)| (a - b).abs());
            let r = from.r.iter().zip(&to.r).map(|(a, b)| (a - b).amax());
            let q = from.q.iter().flatten().zip(to.q.iter().flatten());
            let q = q.map(|(a, b)| (a - b).abs());
            clebsch::scalar::largest(x.chain(r).chain(q))
        }
        fn kept(&self, steps: u64) -> [f64; 2] {
            self.kept_with($h, steps)
        }
        fn energy_bound(&self) -> f64 {
            $bound
        }
        fn energy_ratio(&self) -> f64 {
            let one = self.kept_with($h, 400)[0];
            let half = self.kept_with($h / 2.0, 800)[0];
            one / half
        }
    };
}

macro_rules! keeping {
    ($model:ty, $total:expr) => {
        fn kept_with(&self, h: f64, steps: u64) -> [f64; 2] {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(4), h).expect("starts");
            let total: fn(&$model, &_) -> f64 = $total;
            let (energy, first) = (model.energy(&state), total(&model, &state));
            let (kinetic, _) = model.energies(&state);
            let (mut worst, mut off) = (0.0_f64, 0.0_f64);
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("steps");
                worst = worst.max((model.energy(&state) - energy).abs());
                off = off.max((total(&model, &state) - first).abs());
            }
            [worst / (energy.abs() + kinetic), off / (1.0 + first.abs())]
        }
    };
}

/// Like `keeping`, but for the energy between two nodes as a function of their field values or rotations. The scale is its initial
/// value plus `$each` per node.
macro_rules! keeping_between {
    ($part:ident, $total:expr, $each:expr) => {
        fn kept_with(&self, h: f64, steps: u64) -> [f64; 2] {
            let model = self.stepper();
            let (mut state, mut work) = model.start(self.initial(4), h).expect("starts");
            let total: fn(&Self, &_) -> f64 = $total;
            let (mut before, first) = (self.seen(&state).$part, total(self, &state));
            let (mut energy, mut worst, mut off) = (None, 0.0_f64, 0.0_f64);
            for _ in 0..steps {
                model.step(&mut state, &mut work).expect("steps");
                let after = self.seen(&state).$part;
                let now = self.energy(&before, &after, h);
                let start: f64 = *energy.get_or_insert(now);
                let size = start.abs() + $each * self.nodes() as f64;
                worst = worst.max((now - start).abs() / size);
                off = off.max((total(self, &state) - first).abs());
                before = after;
            }
            [worst, off / (1.0 + first.abs())]
        }
    };
}

fn vector(x: &Vector3<f64>) -> Vector3<D> {
    x.map(c)
}

pub(crate) use {keeping, keeping_between, stepped};
