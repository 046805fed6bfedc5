//! The compiled lines of the gallery with random data, and the same data as numbers.

use clebsch::nalgebra::{Matrix3, SMatrix, Vector3};
use clebsch::of_numbers::OfNumbers;
use clebsch::{BodyMomentum, Rotation};
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

/// A number of sites and how the line ends; a ring where that is not said.
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

    fn number(&self, name: &str) -> f64 {
        self.0[name][0]
    }

    fn numbers(&self, name: &str) -> Vec<f64> {
        self.0[name].clone()
    }

    fn arrays<const R: usize, const C: usize>(&self, name: &str) -> Vec<SMatrix<f64, R, C>> {
        let each = self.0[name].chunks(R * C);
        each.map(SMatrix::from_row_slice).collect()
    }

    fn array<const R: usize, const C: usize>(&self, name: &str) -> SMatrix<f64, R, C> {
        SMatrix::from_row_slice(&self.0[name])
    }

    fn rotations(&self, name: &'static str) -> Vec<Rotation> {
        let each = self.0[name].chunks(9);
        each.map(|m| OfNumbers::of_numbers(name, m).expect("a rotation"))
            .collect()
    }

    fn momenta(&self, name: &str) -> Vec<BodyMomentum> {
        self.arrays::<3, 1>(name)
            .into_iter()
            .map(BodyMomentum)
            .collect()
    }
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

/// A compiled line on its way.
pub trait Compiled {
    fn step(&mut self) -> Result<(), String>;
    fn node(&self) -> u64;
    fn seen(&self, name: &str) -> Vec<f64>;
    fn energies(&self) -> [f64; 2];
    fn totals(&self) -> Vec<(&'static str, Vec<f64>)>;
    fn clone_box(&self) -> Box<dyn Compiled>;
}

type Named = Vec<(&'static str, Vec<f64>)>;

macro_rules! compiled {
    ($ty:ident, $model:ty, $state:ty, $work:ty, $seen:expr, $totals:expr) => {
        #[derive(Clone)]
        struct $ty($model, $state, $work);

        impl Compiled for $ty {
            fn step(&mut self) -> Result<(), String> {
                let $ty(model, state, work) = self;
                model.step(state, work).map_err(|e| e.to_string())
            }
            fn node(&self) -> u64 {
                self.1.node()
            }
            fn seen(&self, name: &str) -> Vec<f64> {
                let seen: fn(&$state, &str) -> Vec<f64> = $seen;
                seen(&self.1, name)
            }
            fn energies(&self) -> [f64; 2] {
                let (kinetic, potential) = self.0.energies(&self.1);
                [kinetic, potential]
            }
            fn totals(&self) -> Named {
                let totals: fn(&$model, &$state) -> Named = $totals;
                totals(&self.0, &self.1)
            }
            fn clone_box(&self) -> Box<dyn Compiled> {
                Box::new(self.clone())
            }
        }
    };
}

#[path = "held.rs"]
pub mod held;
#[path = "newton.rs"]
pub mod newton;
#[path = "quaternions.rs"]
pub mod quaternions;
#[path = "strung.rs"]
pub mod strung;
#[path = "sums.rs"]
pub mod sums;
#[path = "together.rs"]
pub mod together;

fn flat<const R: usize>(list: &[SMatrix<f64, R, 1>]) -> Vec<f64> {
    list.iter().flat_map(|x| x.as_slice().to_vec()).collect()
}

fn turned(list: impl Iterator<Item = Rotation>) -> Vec<f64> {
    list.flat_map(|r| r.matrix().transpose().as_slice().to_vec())
        .collect()
}

compiled!(
    TodaLine,
    TodaChain,
    TodaChainState,
    TodaChainWorkspace,
    |s, name| match name {
        "q" => flat(s.q()),
        "momentum_q" => flat(s.momentum_q()),
        _ => Vec::new(),
    },
    |m, s| vec![("total_momentum", vec![m.total_momentum(s)])]
);
compiled!(
    SineLine,
    SineGordon,
    SineGordonState,
    SineGordonWorkspace,
    |s, name| match name {
        "u" => flat(s.u()),
        "momentum_u" => flat(s.momentum_u()),
        _ => Vec::new(),
    },
    |_, _| Vec::new()
);
compiled!(
    WaterLine,
    ShallowWater1D,
    ShallowWater1DState,
    ShallowWater1DWorkspace,
    |s, name| match name {
        "X" => flat(s.X()),
        "momentum_X" => flat(s.momentum_X()),
        "Y" => flat(s.Y()),
        "momentum_Y" => flat(s.momentum_Y()),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("total_momentum_X", vec![m.total_momentum_X(s)]),
        ("momentum_Y", vec![m.momentum_Y(s)])
    ]
);
compiled!(
    TopsLine,
    CoupledTops,
    CoupledTopsState,
    CoupledTopsWorkspace,
    |s, name| match name {
        "Λ" => turned(s.Λ()),
        "body_momentum_Λ" => flat(&s.body_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_Λ" => flat(&s.spatial_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![("total_momentum_z", vec![m.total_momentum_z(s)])]
);
compiled!(
    RodLine,
    GeometricallyExactRod,
    GeometricallyExactRodState,
    GeometricallyExactRodWorkspace,
    |s, name| match name {
        "φ" => flat(s.φ()),
        "momentum_φ" => flat(s.momentum_φ()),
        "Λ" => turned(s.Λ()),
        "body_momentum_Λ" => flat(&s.body_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_Λ" => flat(&s.spatial_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![
        (
            "total_momentum_angular_g",
            vec![m.total_momentum_angular_g(s)]
        ),
        (
            "total_momentum_angular_g_about_phi",
            vec![m.total_momentum_angular_g_about_phi(s)]
        ),
        (
            "total_momentum_phi_across_g",
            m.total_momentum_phi_across_g(s).as_slice().to_vec()
        ),
    ]
);

pub type Made = (Box<dyn Compiled>, Data);

fn toda_chain(case: &Case, data: &Data) -> Result<TodaLine, String> {
    let parameters = TodaChainParameters {
        m: data.number("m"),
        a: data.number("a"),
        b: data.number("b"),
    };
    let ends = match case.ends {
        None => TodaChainEnds::Ring {
            L: data.number("L"),
        },
        Some(_) => TodaChainEnds::Open,
    };
    let sites = TodaChainSites { N: case.n, ends };
    let model = TodaChain::new(parameters, sites).map_err(|e| e.to_string())?;
    let initial = TodaChainInitial {
        q: data.arrays("q"),
        momentum_q: data.arrays("momentum_q"),
    };
    let started = model.start(initial, case.h);
    let (state, work) = started.map_err(|e| e.to_string())?;
    Ok(TodaLine(model, state, work))
}

/// What the compiled chain says of data that are wrong.
pub fn refused(case: &Case, data: &Data) -> String {
    match toda_chain(case, data) {
        Ok(_) => String::new(),
        Err(why) => why,
    }
}

/// Toda's chain.
pub fn toda(case: &Case) -> Made {
    let mut r = Random(1 + case.n as u64);
    let data = Data(BTreeMap::from([
        ("m", vec![1.3]),
        ("a", vec![0.7]),
        ("b", vec![1.1]),
        ("L", vec![0.3]),
        ("q", r.list(case.nodes(), 0.5)),
        ("momentum_q", r.list(case.nodes(), 1.0)),
    ]));
    let line = toda_chain(case, &data).expect("a chain");
    (Box::new(line), data)
}

fn sine(case: &Case) -> Made {
    let mut r = Random(2 + case.n as u64);
    let data = Data(BTreeMap::from([
        ("s", vec![0.4]),
        ("k", vec![1.7]),
        ("L", vec![6.0]),
        (
            "w",
            r.list(case.nodes(), 0.2).iter().map(|x| 0.5 + x).collect(),
        ),
        ("u", r.list(case.nodes(), 1.0)),
        ("momentum_u", r.list(case.nodes(), 0.5)),
    ]));
    let ends = match case.ends {
        None => SineGordonEnds::Ring {
            L: data.number("L"),
        },
        Some([first, last]) => SineGordonEnds::Open {
            first: match first {
                "pinned" => SineGordonFirst::Pinned,
                _ => SineGordonFirst::Free,
            },
            last: match last {
                "pinned" => SineGordonLast::Pinned,
                _ => SineGordonLast::Free,
            },
        },
    };
    let parameters = SineGordonParameters {
        s: data.number("s"),
        w: data.numbers("w"),
        k: data.number("k"),
    };
    let model = SineGordon::new(parameters, SineGordonSites { N: case.n, ends }).expect("a line");
    let initial = SineGordonInitial {
        u: data.arrays("u"),
        momentum_u: data.arrays("momentum_u"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(SineLine(model, state, work)), data)
}

/// Shallow water.
pub fn water(case: &Case) -> Made {
    let mut r = Random(3 + case.n as u64);
    let places = r.list(case.nodes(), 0.1).into_iter().enumerate();
    let places: Vec<f64> = places.map(|(i, x)| i as f64 + x).collect();
    let masses: Vec<f64> = r.list(case.nodes(), 0.2).iter().map(|x| 1.0 + x).collect();
    // Nearly at rest: momenta across the channel are those of the turning frame.
    let turning = masses.iter().zip(&places).map(|(m, x)| 0.6 * m * x);
    let across = r.list(case.nodes(), 0.05).into_iter().zip(turning);
    let data = Data(BTreeMap::from([
        ("g", vec![0.9]),
        ("f", vec![0.6]),
        ("L", vec![case.n as f64]),
        ("momentum_X", r.list(case.nodes(), 0.05)),
        ("Y", r.list(case.nodes(), 0.1)),
        ("momentum_Y", across.map(|(x, y)| x + y).collect()),
        ("m", masses),
        ("X", places),
    ]));
    (shallow_water(case, &data), data)
}

/// Shallow water of these data.
pub fn shallow_water(case: &Case, data: &Data) -> Box<dyn Compiled> {
    let ends = match case.ends {
        None => ShallowWater1DEnds::Ring {
            L: data.number("L"),
        },
        Some(_) => ShallowWater1DEnds::Open,
    };
    let parameters = ShallowWater1DParameters {
        m: data.numbers("m"),
        g: data.number("g"),
        f: data.number("f"),
    };
    let model =
        ShallowWater1D::new(parameters, ShallowWater1DSites { N: case.n, ends }).expect("water");
    let initial = ShallowWater1DInitial {
        X: data.arrays("X"),
        momentum_X: data.arrays("momentum_X"),
        Y: data.arrays("Y"),
        momentum_Y: data.arrays("momentum_Y"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    Box::new(WaterLine(model, state, work))
}

fn tops(case: &Case) -> Made {
    let mut r = Random(4 + case.n as u64);
    let data = Data(BTreeMap::from([
        ("s", vec![0.8]),
        ("J", vec![0.6, 0.05, 0.02, 0.05, 0.5, 0.01, 0.02, 0.01, 0.9]),
        ("C", vec![0.3, 0.04, 0.0, 0.04, 0.2, 0.03, 0.0, 0.03, 0.4]),
        ("gU", vec![0.1, -0.2, 0.7]),
        ("z", vec![0.0, 0.6, 0.8]),
        ("Λ", r.turns(case.nodes(), 0.7)),
        ("body_momentum_Λ", r.list(3 * case.nodes(), 1.0)),
    ]));
    let parameters = CoupledTopsParameters {
        s: data.number("s"),
        J: data.array("J"),
        C: data.array("C"),
        gU: data.array("gU"),
        z: data.array("z"),
    };
    let ends = match case.ends {
        None => CoupledTopsEnds::Ring,
        Some(_) => CoupledTopsEnds::Open,
    };
    let model = CoupledTops::new(parameters, CoupledTopsSites { N: case.n, ends }).expect("tops");
    let initial = CoupledTopsInitial {
        Λ: data.rotations("Λ"),
        body_momentum_Λ: data.momenta("body_momentum_Λ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(TopsLine(model, state, work)), data)
}

fn rod(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(5 + n as u64);
    let inertia = |i: usize| 1.0 + 0.1 * (i % 3) as f64;
    let inertia = (0..n).flat_map(|i| {
        let x = inertia(i);
        [0.3 * x, 0.0, 0.0, 0.0, 0.4 * x, 0.0, 0.0, 0.0, 0.5 * x]
    });
    let places = r.list(3 * nodes, 0.1).into_iter().enumerate();
    let places = places.map(|(k, x)| {
        if k % 3 == 2 {
            x + 0.5 * (k / 3) as f64
        } else {
            x
        }
    });
    let wall = r.turns(1, 0.2);
    let data = Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", r.list(nodes, 0.1).iter().map(|x| 0.5 + x).collect()),
        ("J", inertia.collect()),
        ("S", vec![2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0]),
        ("B", vec![0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.7]),
        ("g", vec![0.0, 0.1, -0.3]),
        ("force", vec![0.2, -0.1, 0.3]),
        ("φ", places.collect()),
        ("momentum_φ", r.list(3 * nodes, 0.2)),
        ("Λ", r.turns(n, 0.3)),
        ("body_momentum_Λ", r.list(3 * n, 0.2)),
        ("Λw", wall.clone()),
        ("Λw_0", wall.clone()),
        ("Λw_N", wall),
        ("X", vec![0.1, 0.05, 0.5 * n as f64]),
    ]));
    let ends = match case.ends {
        None => GeometricallyExactRodEnds::Ring { X: data.array("X") },
        Some([first, last]) => GeometricallyExactRodEnds::Open {
            first: match first {
                "free" => GeometricallyExactRodFirst::Free,
                "pinned" => GeometricallyExactRodFirst::Pinned,
                _ => GeometricallyExactRodFirst::Clamped {
                    Λw: data.array("Λw"),
                },
            },
            last: match last {
                "free" => GeometricallyExactRodLast::Free,
                "pinned" => GeometricallyExactRodLast::Pinned,
                "clamped" => GeometricallyExactRodLast::Clamped {
                    Λw: data.array("Λw"),
                },
                _ => GeometricallyExactRodLast::Load {
                    force: data.array("force"),
                },
            },
        },
    };
    let parameters = GeometricallyExactRodParameters {
        s: data.number("s"),
        m: data.numbers("m"),
        J: data.arrays("J"),
        S: data.array("S"),
        B: data.array("B"),
        g: data.array("g"),
    };
    let model = GeometricallyExactRod::new(parameters, GeometricallyExactRodSites { N: n, ends })
        .expect("a rod");
    let initial = GeometricallyExactRodInitial {
        φ: data.arrays("φ"),
        momentum_φ: data.arrays("momentum_φ"),
        Λ: data.rotations("Λ"),
        body_momentum_Λ: data.momenta("body_momentum_Λ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(RodLine(model, state, work)), data)
}

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

/// The text of a model, its compiled line with data, and numbers of sites.
pub type Line = (&'static str, fn(&Case) -> Made, Vec<Case>);

/// Every compiled line, with the numbers of its sites and its ends.
pub fn all() -> Vec<Line> {
    let free = [["free", "free"]];
    let pinned = [
        ["free", "free"],
        ["pinned", "free"],
        ["free", "pinned"],
        ["pinned", "pinned"],
    ];
    let mut of_rod = cases(true, &pinned);
    for first in ["free", "pinned", "clamped"] {
        for last in ["free", "clamped", "load"] {
            of_rod.push(Case::new(5, Some([first, last])));
        }
    }
    // A ring of shallow water has two neighbours on either side.
    let water_cases = cases(true, &free).into_iter().filter(|c| c.n > 2).collect();
    vec![
        (TODA, toda, cases(true, &free)),
        (TOPS, tops, cases(true, &free)),
        (SINE, sine, cases(true, &pinned)),
        (ROD, rod, of_rod),
        (WATER, water, water_cases),
    ]
}

/// Those whose sites are solved by Newton's method; cards of lines are few in a process.
pub fn by_newton() -> Vec<Line> {
    let free = ["free", "free"];
    vec![
        (
            newton::Beads::<f64>::SOURCE,
            newton::beads,
            cases(true, &[free]),
        ),
        (
            newton::Steep::<f64>::SOURCE,
            newton::steep,
            cases(true, &[free, ["pinned", "free"]]),
        ),
    ]
}
