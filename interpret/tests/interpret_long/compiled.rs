//! The compiled chains of the gallery with random data, and the same data as numbers.

use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::of_numbers::{OfNumbers, Shown};
use clebsch::{BodyMomentum, Rotation, UnitQuaternion};
use clebsch_models::lattices::coupled_tops::*;
use clebsch_models::lattices::geometrically_exact_rod::*;
use clebsch_models::lattices::shallow_water_1d::*;
use clebsch_models::lattices::sine_gordon::*;
use clebsch_models::lattices::toda_chain::*;
use std::collections::BTreeMap;

pub const TODA: &str = include_str!("../../../models/lattices/toda-chain.clebsch");
const TOPS: &str = include_str!("../../../models/lattices/coupled-tops.clebsch");
const SINE: &str = include_str!("../../../models/lattices/sine-gordon.clebsch");
pub const ROD: &str = include_str!("../../../models/lattices/geometrically-exact-rod.clebsch");
pub const WATER: &str = include_str!("../../../models/lattices/shallow-water-1d.clebsch");

/// A number of sites and the end conditions; a ring if there are none.
#[derive(Clone, Debug)]
pub struct Case {
    pub n: usize,
    pub ends: Option<[&'static str; 2]>,
    pub h: f64,
}

impl Case {
    pub fn new(n: usize, ends: Option<[&'static str; 2]>) -> Self {
        Case { n, ends, h: 0.02 }
    }

    fn nodes(&self) -> usize {
        self.n + usize::from(self.ends.is_some())
    }
}

/// Numbers by the names of quantities.
#[derive(Clone, Debug, Default)]
pub struct Data(BTreeMap<&'static str, Vec<f64>>);

impl Data {
    pub fn get(&self, name: &str) -> Option<Vec<f64>> {
        self.0.get(name).cloned()
    }

    pub fn of_ascii(&self, name: &str) -> Option<Vec<f64>> {
        let mut all = self.0.iter();
        let found = all.find(|(own, _)| clebsch_core::expr::symbol::ascii(own) == name);
        found.map(|(_, list)| list.clone())
    }

    pub fn with(&self, name: &'static str, change: impl Fn(&mut Vec<f64>)) -> Data {
        let mut own = self.clone();
        change(own.0.entry(name).or_default());
        own
    }

    pub fn without(&self, name: &str) -> Data {
        let mut own = self.clone();
        own.0.remove(name);
        own
    }

    /// The value that a field of the compiled line takes.
    fn value<T: Value>(&self, name: &'static str) -> T {
        T::of(name, &self.0[name])
    }
}

/// A value at one site.
trait Entry: OfNumbers {
    const NUMBERS: usize;
}

impl Entry for f64 {
    const NUMBERS: usize = 1;
}
impl<const R: usize, const C: usize> Entry for SMatrix<f64, R, C> {
    const NUMBERS: usize = R * C;
}
impl Entry for Rotation {
    const NUMBERS: usize = 9;
}
impl Entry for UnitQuaternion {
    const NUMBERS: usize = 4;
}
impl Entry for BodyMomentum {
    const NUMBERS: usize = 3;
}

/// The value of a field of a compiled chain: one value, or one for each site.
trait Value {
    fn of(name: &'static str, numbers: &[f64]) -> Self;
}

impl<T: Entry> Value for T {
    fn of(name: &'static str, numbers: &[f64]) -> Self {
        T::of_numbers(name, numbers).expect("is a value")
    }
}

impl<T: Entry> Value for Vec<T> {
    fn of(name: &'static str, numbers: &[f64]) -> Self {
        numbers
            .chunks(T::NUMBERS)
            .map(|own| T::of(name, own))
            .collect()
    }
}

fn shown(list: impl Iterator<Item: Shown>) -> Vec<f64> {
    list.flat_map(Shown::numbers).collect()
}

/// A sequence of numbers between -1 and 1 (a linear congruence of 64 bits, Knuth).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64) / (1u64 << 52) as f64 - 1.0
    }

    fn list(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| size * self.number()).collect()
    }

    /// Matrices of random rotations, row after row.
    fn turns(&mut self, count: usize, size: f64) -> Vec<f64> {
        let mut all = Vec::new();
        for _ in 0..count {
            let v = Vector3::new(self.number(), self.number(), self.number());
            let m: Matrix3<f64> = Rotation::exp(&(v * size)).matrix();
            all.extend(m.transpose().iter());
        }
        all
    }
}

/// A running compiled chain.
pub trait Compiled {
    fn step(&mut self) -> Result<(), String>;
    fn node(&self) -> u64;
    fn seen(&self, name: &str) -> Vec<f64>;
    fn energies(&self) -> [f64; 2];
    fn totals(&self) -> Vec<(&'static str, Vec<f64>)>;
}

/// Totals by their names.
pub type Named = Vec<(&'static str, Vec<f64>)>;

/// A compiled chain by the names of its fields: input, end conditions and observables. Ends are the variants of the
/// emitted types in lower case.
macro_rules! compiled {
    (
        $line:ident: $model:ident $parameters:ident $sites:ident $ends:ident $initial:ident $state:ident $work:ident,
        takes [$($parameter:ident)*] starts [$($start:ident)*],
        $(ring [$($around:ident)*],)?
        $(first $first:ident [$($a:ident($($at_a:ident)?))*],)?
        $(last $last:ident [$($b:ident($($at_b:ident)?))*],)?
        fields [$($field:ident)*] groups [$($group:ident)*] $(sums [$($sum:ident)*])?
        totals [$($total:ident $told:literal)*]
    ) => {
        pub struct $line($model, $state, $work);

        impl $line {
            /// The chain with these data, or why they are rejected.
            pub fn of(case: &Case, data: &Data) -> Result<Box<dyn Compiled>, String> {
                let ends = match case.ends {
                    $(None => $ends::Ring { $($around: data.value(stringify!($around)),)* },)?
                    #[allow(unused_variables)]
                    Some([first, last]) => $ends::Open {
                        $(first: match first {
                            $(end if end == stringify!($a).to_lowercase() => $first::$a {
                                $($at_a: data.value(stringify!($at_a)),)?
                            },)*
                            end => panic!("no line begins {end}"),
                        },)?
                        $(last: match last {
                            $(end if end == stringify!($b).to_lowercase() => $last::$b {
                                $($at_b: data.value(stringify!($at_b)),)?
                            },)*
                            end => panic!("no line ends {end}"),
                        },)?
                    },
                    #[allow(unreachable_patterns)]
                    None => panic!("is no ring"),
                };
                let parameters = $parameters { $($parameter: data.value(stringify!($parameter)),)* };
                let model = $model::new(parameters, $sites { N: case.n, ends }).map_err(|e| e.to_string())?;
                let initial = $initial { $($start: data.value(stringify!($start)),)* };
                let (state, work) = model.start(initial, case.h).map_err(|e| e.to_string())?;
                Ok(Box::new(Self(model, state, work)))
            }
        }

        impl Compiled for $line {
            fn step(&mut self) -> Result<(), String> {
                let $line(model, state, work) = self;
                model.step(state, work).map_err(|e| e.to_string())
            }
            fn node(&self) -> u64 {
                self.1.node()
            }
            fn seen(&self, name: &str) -> Vec<f64> {
                $(if name == stringify!($field) {
                    return shown(self.1.$field().iter().copied());
                })*
                $(if name == stringify!($group) {
                    return shown(self.1.$group());
                })*
                $($(if name == stringify!($sum) {
                    return self.1.$sum().as_slice().to_vec();
                })*)?
                Vec::new()
            }
            fn energies(&self) -> [f64; 2] {
                let (kinetic, potential) = self.0.energies(&self.1);
                [kinetic, potential]
            }
            fn totals(&self) -> Named {
                vec![$(($told, self.0.$total(&self.1).numbers().collect()),)*]
            }
        }
    };
}

pub mod constraints;
pub mod coupled_velocities;
pub mod newton;
pub mod quaternions;
pub mod springs;
pub mod sums;

compiled!(
    TodaLine: TodaChain TodaChainParameters TodaChainSites TodaChainEnds TodaChainInitial TodaChainState TodaChainWorkspace,
    takes [m a b] starts [q momentum_q],
    ring [L],
    fields [q momentum_q] groups []
    totals [total_momentum "total_momentum"]
);
compiled!(
    SineLine: SineGordon SineGordonParameters SineGordonSites SineGordonEnds SineGordonInitial SineGordonState SineGordonWorkspace,
    takes [s w k] starts [u momentum_u],
    ring [L], first SineGordonFirst [Free() Pinned()], last SineGordonLast [Free() Pinned()],
    fields [u momentum_u] groups []
    totals []
);
compiled!(
    WaterLine: ShallowWater1D ShallowWater1DParameters ShallowWater1DSites ShallowWater1DEnds ShallowWater1DInitial
        ShallowWater1DState ShallowWater1DWorkspace,
    takes [m g f] starts [X momentum_X Y momentum_Y],
    ring [L],
    fields [X momentum_X Y momentum_Y] groups []
    totals [total_momentum_X "total_momentum_X" momentum_Y "momentum_Y"]
);
compiled!(
    TopsLine: CoupledTops CoupledTopsParameters CoupledTopsSites CoupledTopsEnds CoupledTopsInitial CoupledTopsState
        CoupledTopsWorkspace,
    takes [s J C gU z] starts [Λ body_momentum_Λ],
    ring [],
    fields [] groups [Λ body_momentum_Λ spatial_momentum_Λ]
    totals [total_momentum_z "total_momentum_z"]
);
compiled!(
    RodLine: GeometricallyExactRod GeometricallyExactRodParameters GeometricallyExactRodSites GeometricallyExactRodEnds
        GeometricallyExactRodInitial GeometricallyExactRodState GeometricallyExactRodWorkspace,
    takes [s m J S B g] starts [φ momentum_φ Λ body_momentum_Λ],
    ring [X],
    first GeometricallyExactRodFirst [Free() Pinned() Clamped(Λw)],
    last GeometricallyExactRodLast [Free() Pinned() Clamped(Λw) Load(force)],
    fields [φ momentum_φ] groups [Λ body_momentum_Λ spatial_momentum_Λ]
    totals [
        total_momentum_angular_g "total_momentum_angular_g"
        total_momentum_angular_g_about_phi "total_momentum_angular_g_about_phi"
        total_momentum_phi_across_g "total_momentum_phi_across_g"
    ]
);

/// A compiled chain with some data, or why they are rejected.
pub type Make = fn(&Case, &Data) -> Result<Box<dyn Compiled>, String>;

/// A line with data.
#[derive(Clone)]
pub struct Line {
    /// The text of its model.
    pub source: &'static str,
    /// The compiled line.
    pub make: Make,
    /// Random data.
    pub data: fn(&Case) -> Data,
    /// The numbers of its sites and its ends.
    pub cases: Vec<Case>,
}

impl Line {
    /// The compiled line with its data.
    pub fn made(&self, case: &Case) -> (Box<dyn Compiled>, Data) {
        let data = (self.data)(case);
        ((self.make)(case, &data).expect("starts"), data)
    }
}

/// Random numbers around a given number.
fn about(middle: f64, list: Vec<f64>) -> Vec<f64> {
    list.iter().map(|x| middle + x).collect()
}

/// Positions along the last axis, half a unit apart, with random perturbations.
fn along(list: Vec<f64>) -> Vec<f64> {
    let each = list.into_iter().enumerate();
    each.map(|(k, x)| match k % 3 {
        2 => x + 0.5 * (k / 3) as f64,
        _ => x,
    })
    .collect()
}

/// Matrices for this number of sections, with period three.
fn by_threes(n: usize, one: [f64; 9]) -> Vec<f64> {
    let each = (0..n).map(|i| 1.0 + 0.1 * (i % 3) as f64);
    each.flat_map(|x| one.map(|y| x * y)).collect()
}

/// Poinsot's matrix of a section.
const SECTION: [f64; 9] = [0.3, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.5];

/// Toda's chain.
pub fn toda(case: &Case) -> Data {
    let mut r = Random(1 + case.n as u64);
    Data(BTreeMap::from([
        ("m", vec![1.3]),
        ("a", vec![0.7]),
        ("b", vec![1.1]),
        ("L", vec![0.3]),
        ("q", r.list(case.nodes(), 0.5)),
        ("momentum_q", r.list(case.nodes(), 1.0)),
    ]))
}

fn sine(case: &Case) -> Data {
    let mut r = Random(2 + case.n as u64);
    Data(BTreeMap::from([
        ("s", vec![0.4]),
        ("k", vec![1.7]),
        ("L", vec![6.0]),
        ("w", about(0.5, r.list(case.nodes(), 0.2))),
        ("u", r.list(case.nodes(), 1.0)),
        ("momentum_u", r.list(case.nodes(), 0.5)),
    ]))
}

/// Shallow water.
pub fn water(case: &Case) -> Data {
    let mut r = Random(3 + case.n as u64);
    let places = r.list(case.nodes(), 0.1).into_iter().enumerate();
    let places: Vec<f64> = places.map(|(i, x)| i as f64 + x).collect();
    let masses = about(1.0, r.list(case.nodes(), 0.2));
    // Nearly at rest: momenta across the channel come from the rotating frame.
    let turning = masses.iter().zip(&places).map(|(m, x)| 0.6 * m * x);
    let across = r.list(case.nodes(), 0.05).into_iter().zip(turning);
    Data(BTreeMap::from([
        ("g", vec![0.9]),
        ("f", vec![0.6]),
        ("L", vec![case.n as f64]),
        ("momentum_X", r.list(case.nodes(), 0.05)),
        ("Y", r.list(case.nodes(), 0.1)),
        ("momentum_Y", across.map(|(x, y)| x + y).collect()),
        ("m", masses),
        ("X", places),
    ]))
}

fn tops(case: &Case) -> Data {
    let mut r = Random(4 + case.n as u64);
    Data(BTreeMap::from([
        ("s", vec![0.8]),
        ("J", vec![0.6, 0.05, 0.02, 0.05, 0.5, 0.01, 0.02, 0.01, 0.9]),
        ("C", vec![0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4]),
        ("gU", vec![0.1, -0.2, 0.7]),
        ("z", vec![0.0, 0.6, 0.8]),
        ("Λ", r.turns(case.nodes(), 0.7)),
        ("body_momentum_Λ", r.list(3 * case.nodes(), 1.0)),
    ]))
}

fn rod(case: &Case) -> Data {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(5 + n as u64);
    let places = along(r.list(3 * nodes, 0.1));
    let wall = r.turns(1, 0.2);
    Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", about(0.5, r.list(nodes, 0.1))),
        ("J", by_threes(n, SECTION)),
        ("S", vec![2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0]),
        ("B", vec![0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.7]),
        ("g", vec![0.0, 0.1, -0.3]),
        ("force", vec![0.2, -0.1, 0.3]),
        ("φ", places),
        ("momentum_φ", r.list(3 * nodes, 0.2)),
        ("Λ", r.turns(n, 0.3)),
        ("body_momentum_Λ", r.list(3 * n, 0.2)),
        ("Λw", wall.clone()),
        ("Λw_0", wall.clone()),
        ("Λw_N", wall),
        ("X", vec![0.1, 0.05, 0.5 * n as f64]),
    ]))
}

/// Every combination of a first and a last end.
fn pairs(first: &[&'static str], last: &[&'static str]) -> Vec<[&'static str; 2]> {
    let each = first.iter();
    each.flat_map(|a| last.iter().map(|b| [*a, *b])).collect()
}

const FREE: [[&str; 2]; 1] = [["free", "free"]];

const COUNTS: [usize; 5] = [2, 3, 5, 12, 50];

fn cases(ring: bool, ends: &[[&'static str; 2]]) -> Vec<Case> {
    let ring = ring.then_some(None);
    let ends: Vec<Option<[&'static str; 2]>> = ring
        .into_iter()
        .chain(ends.iter().map(|e| Some(*e)))
        .collect();
    let each = COUNTS.iter();
    each.flat_map(|n| ends.iter().map(|e| Case::new(*n, *e)))
        .collect()
}

/// Every compiled chain, with the numbers of its sites and its ends.
pub fn all() -> Vec<Line> {
    let pinned = pairs(&["free", "pinned"], &["free", "pinned"]);
    let mut of_rod = cases(true, &pinned);
    let held = pairs(&["free", "pinned", "clamped"], &["free", "clamped", "load"]);
    of_rod.extend(held.into_iter().map(|ends| Case::new(5, Some(ends))));
    // A ring of shallow water has two neighbours on either side.
    let of_water = cases(true, &FREE).into_iter().filter(|c| c.n > 2).collect();
    let line = |source, make, data, cases| Line {
        source,
        make,
        data,
        cases,
    };
    vec![
        line(TODA, TodaLine::of, toda, cases(true, &FREE)),
        line(TOPS, TopsLine::of, tops, cases(true, &FREE)),
        line(SINE, SineLine::of, sine, cases(true, &pinned)),
        line(ROD, RodLine::of, rod, of_rod),
        line(WATER, WaterLine::of, water, of_water),
    ]
}
