//! Lines with held constraints, compiled, with data that are on them: a rod that cannot be stretched, a chain of rigid
//! links.

use super::{Case, Compiled, Data, Line, Made, Named, Random, cases, flat, turned};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch_models::lattices::hanging_chain::*;
use clebsch_models::lattices::kirchhoff_rod::*;
use std::collections::BTreeMap;

pub const ROD: &str = include_str!("../../../models/lattices/kirchhoff-rod.clebsch");
pub const CHAIN: &str = include_str!("../../../models/lattices/hanging-chain.clebsch");

clebsch::model! {
    /// Charged beads in the plane at distances that do not change, each with a number that follows from its place and whose
    /// velocity stands beside that of the place.
    pub model ChargedLinks {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param a: Real at segments;
        param f, b, e: Real;
        field X: Vec<2> at nodes;
        field q: Real at nodes;
        hold λ: dot(next(X, i) - X, next(X, i) - X) = a^2;
        hold κ: q = b*dot(X, X);
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + m*(next(q) - q)^2/(2*h) + e*(next(q) - q)*d[1]/h
            + (f/2)*dot(perp(X), next(X)) - h*m*X[2] - h*m*(next(q, i) - q)^2/2;
    }
}

compiled!(
    ChargedLine,
    ChargedLinks,
    ChargedLinksState,
    ChargedLinksWorkspace,
    |s, name| match name {
        "X" => flat(s.X()),
        "momentum_X" => flat(s.momentum_X()),
        "q" => flat(s.q()),
        "momentum_q" => flat(s.momentum_q()),
        "λ" => flat(s.λ()),
        "κ" => flat(s.κ()),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("constraint_kappa", vec![m.constraint_κ(s)]),
        ("constraint_lambda", vec![m.constraint_λ(s)]),
        ("constraint_rate_kappa", vec![m.constraint_rate_κ(s)]),
        ("constraint_rate_lambda", vec![m.constraint_rate_λ(s)]),
    ]
);

compiled!(
    RodLine,
    KirchhoffRod,
    KirchhoffRodState,
    KirchhoffRodWorkspace,
    |s, name| match name {
        "φ" => flat(s.φ()),
        "momentum_φ" => flat(s.momentum_φ()),
        "n" => flat(s.n()),
        "Λ" => turned(s.Λ()),
        "body_momentum_Λ" => flat(&s.body_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_Λ" => flat(&s.spatial_momentum_Λ().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("constraint_n", vec![m.constraint_n(s)]),
        ("constraint_rate_n", vec![m.constraint_rate_n(s)]),
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
compiled!(
    ChainLine,
    HangingChain,
    HangingChainState,
    HangingChainWorkspace,
    |s, name| match name {
        "x" => flat(s.x()),
        "momentum_x" => flat(s.momentum_x()),
        "λ" => flat(s.λ()),
        _ => Vec::new(),
    },
    |m, s| vec![
        ("constraint_lambda", vec![m.constraint_λ(s)]),
        ("constraint_rate_lambda", vec![m.constraint_rate_λ(s)]),
        (
            "total_momentum_angular_about_x_g",
            vec![m.total_momentum_angular_about_x_g(s)]
        ),
    ]
);

fn rod(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(6 + n as u64);
    let moments = |i: usize| {
        let x = 1.0 + 0.1 * (i % 3) as f64;
        [0.3 * x, 0.0, 0.0, 0.0, 0.4 * x, 0.0, 0.0, 0.0, 0.5 * x]
    };
    let turns = r.turns(n, 0.3);
    let masses: Vec<f64> = r.list(nodes, 0.1).iter().map(|x| 0.5 + x).collect();
    let mut places = vec![Vector3::new(0.1, -0.2, 0.3)];
    let mut momenta: Vec<f64> = Vec::new();
    // Sections that spin about their own axes alone leave the line as it is.
    for (i, turn) in turns.chunks(9).enumerate() {
        places.push(places[i] + Matrix3::from_row_slice(turn) * Vector3::z() * 0.5);
        momenta.extend([0.0, 0.0, 0.3 * r.number()]);
    }
    let across = places[n] - places[0];
    let data = Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", masses),
        ("J", (0..n).flat_map(moments).collect()),
        ("B", vec![0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.7]),
        ("g", vec![0.0, 0.1, -0.3]),
        ("X", across.as_slice().to_vec()),
        ("force", vec![0.2, -0.1, 0.3]),
        (
            "φ",
            places[..nodes]
                .iter()
                .flat_map(|x| x.as_slice().to_vec())
                .collect(),
        ),
        ("momentum_φ", vec![0.0; 3 * nodes]),
        ("Λ", turns),
        ("body_momentum_Λ", momenta),
        ("Λw", r.turns(1, 0.2)),
    ]));
    let ends = match case.ends {
        None => KirchhoffRodEnds::Ring { X: data.array("X") },
        Some([first, last]) => KirchhoffRodEnds::Open {
            first: match first {
                "free" => KirchhoffRodFirst::Free,
                "pinned" => KirchhoffRodFirst::Pinned,
                _ => KirchhoffRodFirst::Clamped {
                    Λw: data.array("Λw"),
                },
            },
            last: match last {
                "free" => KirchhoffRodLast::Free,
                "pinned" => KirchhoffRodLast::Pinned,
                _ => KirchhoffRodLast::Load {
                    force: data.array("force"),
                },
            },
        },
    };
    let parameters = KirchhoffRodParameters {
        s: data.number("s"),
        m: data.numbers("m"),
        J: data.arrays("J"),
        B: data.array("B"),
        g: data.array("g"),
    };
    let model = KirchhoffRod::new(parameters, KirchhoffRodSites { N: n, ends }).expect("a rod");
    let initial = KirchhoffRodInitial {
        φ: data.arrays("φ"),
        momentum_φ: data.arrays("momentum_φ"),
        Λ: data.rotations("Λ"),
        body_momentum_Λ: data.momenta("body_momentum_Λ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(RodLine(model, state, work)), data)
}

fn chain(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(7 + n as u64);
    let mut places = vec![Vector3::new(0.1, -0.2, 0.3)];
    for i in 0..n {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        // Around a ring, and nearly straight else.
        let along = match case.ends {
            None => Vector3::new(angle.cos(), angle.sin(), 0.3 * r.number()),
            Some(_) => Vector3::new(0.3 * r.number(), 0.3 * r.number(), -1.0),
        };
        places.push(places[i] + along * 0.5);
    }
    let places = &places[..nodes];
    let length = |i: usize| (places[(i + 1) % nodes] - places[i]).norm();
    let masses: Vec<f64> = r.list(nodes, 0.1).iter().map(|x| 0.5 + x).collect();
    let free = case.ends.is_none_or(|ends| ends == ["free", "free"]);
    let moving = masses.iter().flat_map(|m| match free {
        true => [0.2 * m, -0.1 * m, 0.3 * m],
        false => [0.0; 3],
    });
    let data = Data(BTreeMap::from([
        ("momentum_x", moving.collect()),
        ("a", (0..n).map(length).collect()),
        ("g", vec![0.3, 0.1, -0.8]),
        (
            "x",
            places.iter().flat_map(|x| x.as_slice().to_vec()).collect(),
        ),
        ("m", masses),
    ]));
    let ends = match case.ends {
        None => HangingChainEnds::Ring,
        Some([first, last]) => HangingChainEnds::Open {
            first: match first {
                "pinned" => HangingChainFirst::Pinned,
                _ => HangingChainFirst::Free,
            },
            last: match last {
                "pinned" => HangingChainLast::Pinned,
                _ => HangingChainLast::Free,
            },
        },
    };
    let parameters = HangingChainParameters {
        m: data.numbers("m"),
        a: data.numbers("a"),
        g: data.array("g"),
    };
    let model = HangingChain::new(parameters, HangingChainSites { N: n, ends }).expect("a chain");
    let initial = HangingChainInitial {
        x: data.arrays("x"),
        momentum_x: data.arrays("momentum_x"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(ChainLine(model, state, work)), data)
}

fn charged(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(8 + n as u64);
    let mut places = vec![[0.3, -0.2]];
    for i in 0..n {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        let [x, y] = match case.ends {
            None => [angle.cos(), angle.sin() + 0.3 * r.number()],
            Some(_) => [1.0, 0.5 * r.number()],
        };
        places.push([places[i][0] + 0.4 * x, places[i][1] + 0.4 * y]);
    }
    let places = &places[..nodes];
    let length = |i: usize| {
        let (x, y) = (places[i], places[(i + 1) % nodes]);
        (y[0] - x[0]).hypot(y[1] - x[1])
    };
    // At rest: momenta are those that the field gives.
    let (f, b) = (0.7, 0.2);
    let data = Data(BTreeMap::from([
        ("m", r.list(nodes, 0.2).iter().map(|x| 1.0 + x).collect()),
        ("a", (0..n).map(length).collect()),
        ("f", vec![f]),
        ("b", vec![b]),
        ("e", vec![0.3]),
        ("X", places.concat()),
        (
            "q",
            places.iter().map(|[x, y]| b * (x * x + y * y)).collect(),
        ),
        (
            "momentum_X",
            places
                .iter()
                .flat_map(|[x, y]| [-f * y / 2.0, f * x / 2.0])
                .collect(),
        ),
        ("momentum_q", vec![0.0; nodes]),
    ]));
    let ends = match case.ends {
        None => ChargedLinksEnds::Ring,
        Some(_) => ChargedLinksEnds::Open,
    };
    let parameters = ChargedLinksParameters {
        m: data.numbers("m"),
        a: data.numbers("a"),
        f,
        b,
        e: data.number("e"),
    };
    let model = ChargedLinks::new(parameters, ChargedLinksSites { N: n, ends }).expect("links");
    let initial = ChargedLinksInitial {
        X: data.arrays("X"),
        momentum_X: data.arrays("momentum_X"),
        q: data.arrays("q"),
        momentum_q: data.arrays("momentum_q"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(ChargedLine(model, state, work)), data)
}

/// All of them, with the numbers of their sites and their ends.
pub fn all() -> Vec<Line> {
    let mut of_rod = Vec::new();
    for first in ["free", "pinned", "clamped"] {
        for last in ["free", "pinned", "load"] {
            of_rod.push([first, last]);
        }
    }
    let pinned = [
        ["free", "free"],
        ["pinned", "free"],
        ["free", "pinned"],
        ["pinned", "pinned"],
    ];
    // Two links between the same two beads hold one distance.
    let of_chain = cases(true, &pinned).into_iter().filter(|c| c.n > 2);
    vec![
        (ROD, rod, cases(true, &of_rod)),
        (CHAIN, chain, of_chain.collect()),
        (
            ChargedLinks::<f64>::SOURCE,
            charged,
            cases(true, &[["free", "free"]])
                .into_iter()
                .filter(|c| c.n > 2)
                .collect(),
        ),
    ]
}
