//! Lines with constraints on sums over sites, compiled, with data that are on them: a rod of one tension, beads whose centre
//! of mass and whose sum of squares are held.

use super::{Case, Compiled, Data, Line, Made, Named, Random, cases, flat, turned};
use clebsch::nalgebra::{Matrix3, Vector2, Vector3};
use clebsch_models::lattices::uniform_tension_rod::*;
use std::collections::BTreeMap;

pub const ROD: &str = include_str!("../../../models/lattices/uniform-tension-rod.clebsch");

clebsch::model! {
    /// Beads in the plane whose centre of mass is held, and the sum of the squares of their distances.
    pub model HeldBeads {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param X: Vec<2>;
        param R, k: Real;
        field φ: Vec<2> at nodes offset L;
        hold c: sum(m*φ) = X;
        hold e: sum(dot(next(φ, i) - φ, next(φ, i) - φ)) = R;
        let d = next(φ) - φ;
        lagrangian = m*dot(d, d)/(2*h) - (h/4)*k*dot(φ, φ)^2;
        end i = 0 { free; pinned { φ = given; } }
        end i = N { free; pinned { φ = given; } }
    }
}

compiled!(
    RodLine,
    UniformTensionRod,
    UniformTensionRodState,
    UniformTensionRodWorkspace,
    |s, name| match name {
        "p" => s.p().as_slice().to_vec(),
        "Λ" => turned(s.Λ()),
        "body_momentum_Λ" => flat(&s.body_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_Λ" => flat(&s.spatial_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("constraint_p", vec![m.constraint_p(s)]),
        ("constraint_rate_p", vec![m.constraint_rate_p(s)]),
        ("total_momentum_X", vec![m.total_momentum_X(s)]),
    ]
);
compiled!(
    BeadLine,
    HeldBeads,
    HeldBeadsState,
    HeldBeadsWorkspace,
    |s, name| match name {
        "φ" => flat(s.φ()),
        "momentum_φ" => flat(s.momentum_φ()),
        "c" => s.c().as_slice().to_vec(),
        "e" => s.e().as_slice().to_vec(),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("constraint_c", vec![m.constraint_c(s)]),
        ("constraint_e", vec![m.constraint_e(s)]),
        ("constraint_rate_c", vec![m.constraint_rate_c(s)]),
        ("constraint_rate_e", vec![m.constraint_rate_e(s)]),
    ]
);

fn rod(case: &Case) -> Made {
    let n = case.n;
    let mut r = Random(11 + n as u64);
    let moments = |i: usize| {
        let x = 1.0 + 0.1 * (i % 3) as f64;
        [0.3 * x, 0.0, 0.0, 0.0, 0.4 * x, 0.0, 0.0, 0.0, 0.5 * x]
    };
    let turns = r.turns(n, 0.6);
    let across: Vector3<f64> = turns
        .chunks(9)
        .map(|turn| Matrix3::from_row_slice(turn) * Vector3::z() * 0.5)
        .sum();
    // Sections that spin about their own axes alone leave the line as it is.
    let spins = (0..n).flat_map(|_| [0.0, 0.0, 0.3 * r.number()]).collect();
    let data = Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("J", (0..n).flat_map(moments).collect()),
        ("B", vec![0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.7]),
        ("X", across.as_slice().to_vec()),
        ("Λ", turns),
        ("body_momentum_Λ", spins),
        ("Λw", r.turns(1, 0.2)),
    ]));
    let wall = data.array("Λw");
    let ends = match case.ends {
        None => UniformTensionRodEnds::Ring,
        Some([first, last]) => UniformTensionRodEnds::Open {
            first: match first {
                "free" => UniformTensionRodFirst::Free,
                _ => UniformTensionRodFirst::Clamped { Λw: wall },
            },
            last: match last {
                "free" => UniformTensionRodLast::Free,
                _ => UniformTensionRodLast::Clamped { Λw: wall },
            },
        },
    };
    let parameters = UniformTensionRodParameters {
        s: data.number("s"),
        J: data.arrays("J"),
        B: data.array("B"),
        X: data.array("X"),
    };
    let sites = UniformTensionRodSites { N: n, ends };
    let model = UniformTensionRod::new(parameters, sites).expect("a rod");
    let initial = UniformTensionRodInitial {
        Λ: data.rotations("Λ"),
        body_momentum_Λ: data.momenta("body_momentum_Λ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(RodLine(model, state, work)), data)
}

fn beads(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(12 + n as u64);
    let masses: Vec<f64> = r.list(nodes, 0.2).iter().map(|x| 1.0 + x).collect();
    let offset = [0.4, 0.1];
    let places = r.list(2 * nodes, 1.0);
    let place = |i: usize| Vector2::new(places[2 * (i % nodes)], places[2 * (i % nodes) + 1]);
    let seam = |i: usize| match i == nodes {
        true => Vector2::from(offset),
        false => Vector2::zeros(),
    };
    let centre: Vector2<f64> = (0..nodes).map(|i| place(i) * masses[i]).sum();
    let squares = (0..n).map(|i| (place(i + 1) + seam(i + 1) - place(i)).norm_squared());
    let data = Data(BTreeMap::from([
        ("R", vec![squares.sum()]),
        ("X", centre.as_slice().to_vec()),
        ("k", vec![0.7]),
        ("L", offset.to_vec()),
        ("momentum_φ", vec![0.0; 2 * nodes]),
        ("m", masses),
        ("φ", places.clone()),
    ]));
    let ends = match case.ends {
        None => HeldBeadsEnds::Ring { L: data.array("L") },
        Some([first, last]) => HeldBeadsEnds::Open {
            first: match first {
                "free" => HeldBeadsFirst::Free,
                _ => HeldBeadsFirst::Pinned,
            },
            last: match last {
                "free" => HeldBeadsLast::Free,
                _ => HeldBeadsLast::Pinned,
            },
        },
    };
    let parameters = HeldBeadsParameters {
        m: data.numbers("m"),
        X: data.array("X"),
        R: data.number("R"),
        k: data.number("k"),
    };
    let model = HeldBeads::new(parameters, HeldBeadsSites { N: n, ends }).expect("beads");
    let initial = HeldBeadsInitial {
        φ: data.arrays("φ"),
        momentum_φ: data.arrays("momentum_φ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(BeadLine(model, state, work)), data)
}

/// All of them, with the numbers of their sites and their ends.
pub fn all() -> Vec<Line> {
    let both = |held: &'static str| [["free", "free"], [held, "free"], [held, held]];
    let enough = |c: &Case| c.n > 2;
    vec![
        (
            ROD,
            rod,
            cases(true, &both("clamped"))
                .into_iter()
                .filter(enough)
                .collect(),
        ),
        (
            HeldBeads::<f64>::SOURCE,
            beads,
            cases(true, &both("pinned"))
                .into_iter()
                .filter(|c| c.n > 3)
                .collect(),
        ),
    ]
}
