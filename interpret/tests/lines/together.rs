//! Lines whose velocities are found together, as built and from their text.

use super::{Case, Compiled, Data, Line, Made, Named, Random, cases, flat, turned};
use clebsch::Rotation;
use clebsch_models::lattices::coupled_body_chain::*;
use std::collections::BTreeMap;

pub const BODIES: &str = include_str!("../../../models/lattices/coupled-body-chain.clebsch");

clebsch::model! {
    /// Beads whose velocities are joined, by an amount that depends on where they are.
    pub model Woven {
        label i in 0..N;
        end i = 0 { free; pinned { q = given; } }
        periodic;
        param m: Real at nodes;
        param b, c, e: Real;
        field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + c*(1 + b*cos((q + next(q))/2))*(next(q) - q)*(next(next(q, i)) - next(q, i))/h
            - h*e*(next(q, i) - q)^2/2;
    }
}

fn body<'a>(
    name: &str,
    turns: impl Iterator<Item = Rotation> + 'a,
    [body, spatial]: [Vec<clebsch::nalgebra::Vector3<f64>>; 2],
) -> Vec<f64> {
    match name {
        "Λ" => turned(turns),
        "body_momentum_Λ" => flat(&body),
        "spatial_momentum_Λ" => flat(&spatial),
        _ => Vec::new(),
    }
}

compiled!(
    BodiesLine,
    CoupledBodyChain,
    CoupledBodyChainState,
    CoupledBodyChainWorkspace,
    |s, name| {
        let momenta = [
            s.body_momentum_Λ().map(|m| m.0).collect(),
            s.spatial_momentum_Λ().map(|m| m.0).collect(),
        ];
        body(name, s.Λ(), momenta)
    },
    |m, s| vec![("total_momentum", m.total_momentum(s).as_slice().to_vec())]
);
compiled!(
    WovenLine,
    Woven,
    WovenState,
    WovenWorkspace,
    |s, name| match name {
        "q" => flat(s.q()),
        "momentum_q" => flat(s.momentum_q()),
        _ => Vec::new(),
    },
    |_, _| Vec::new()
);

const MOMENTS: [f64; 9] = [1.0, 0.05, 0.02, 0.05, 0.8, 0.01, 0.02, 0.01, 0.6];

fn bodies(case: &Case) -> Made {
    let mut r = Random(8 + case.n as u64);
    let data = Data(BTreeMap::from([
        ("J", MOMENTS.to_vec()),
        ("d", vec![0.3, 0.4, 0.5]),
        ("eps", vec![0.4]),
        ("Λ", r.turns(case.nodes(), 0.7)),
        ("body_momentum_Λ", r.list(3 * case.nodes(), 1.0)),
    ]));
    let parameters = CoupledBodyChainParameters {
        J: data.array("J"),
        d: data.array("d"),
        eps: data.number("eps"),
    };
    let ends = match case.ends {
        None => CoupledBodyChainEnds::Ring,
        Some(_) => CoupledBodyChainEnds::Open,
    };
    let sites = CoupledBodyChainSites { N: case.n, ends };
    let model = CoupledBodyChain::new(parameters, sites).expect("bodies");
    let initial = CoupledBodyChainInitial {
        Λ: data.rotations("Λ"),
        body_momentum_Λ: data.momenta("body_momentum_Λ"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(BodiesLine(model, state, work)), data)
}

fn woven(case: &Case) -> Made {
    let mut r = Random(10 + case.n as u64);
    let nodes = case.nodes();
    let data = Data(BTreeMap::from([
        ("m", r.list(nodes, 0.3).iter().map(|x| 1.5 + x).collect()),
        ("b", vec![0.5]),
        ("c", vec![0.3]),
        ("e", vec![0.6]),
        ("q", r.list(nodes, 1.0)),
        ("momentum_q", r.list(nodes, 0.5)),
    ]));
    let parameters = WovenParameters {
        m: data.numbers("m"),
        b: data.number("b"),
        c: data.number("c"),
        e: data.number("e"),
    };
    let ends = match case.ends {
        None => WovenEnds::Ring,
        Some(ends) => WovenEnds::Open {
            first: match ends[0] {
                "pinned" => WovenFirst::Pinned,
                _ => WovenFirst::Free,
            },
        },
    };
    let model = Woven::new(parameters, WovenSites { N: case.n, ends }).expect("beads");
    let initial = WovenInitial {
        q: data.arrays("q"),
        momentum_q: data.arrays("momentum_q"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(WovenLine(model, state, work)), data)
}

/// Of up to twelve segments: longer ones repeat the sites between the ends.
fn few(all: Vec<Case>) -> Vec<Case> {
    all.into_iter().filter(|c| c.n <= 12).collect()
}

/// Those lines; cards of lines are few in a process.
pub fn all() -> Vec<Line> {
    let (free, pinned) = (["free", "free"], ["pinned", "free"]);
    vec![
        (BODIES, bodies, few(cases(true, &[free]))),
        (WOVEN, woven, few(cases(true, &[free, pinned]))),
    ]
}

const WOVEN: &str = Woven::<f64>::SOURCE;
