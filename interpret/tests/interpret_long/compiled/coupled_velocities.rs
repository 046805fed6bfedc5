//! Chains that solve for all velocities together.

use super::*;
use clebsch_models::lattices::coupled_body_chain::*;

const BODIES: &str = include_str!("../../../../models/lattices/coupled-body-chain.clebsch");

clebsch::model! {
    /// Beads with coupled velocities; the coupling depends on their positions.
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

compiled!(
    BodiesLine: CoupledBodyChain CoupledBodyChainParameters CoupledBodyChainSites CoupledBodyChainEnds
        CoupledBodyChainInitial CoupledBodyChainState CoupledBodyChainWorkspace,
    takes [J d eps] starts [Λ body_momentum_Λ],
    ring [],
    fields [] groups [Λ body_momentum_Λ spatial_momentum_Λ]
    totals [total_momentum "total_momentum"]
);
compiled!(
    WovenLine: Woven WovenParameters WovenSites WovenEnds WovenInitial WovenState WovenWorkspace,
    takes [m b c e] starts [q momentum_q],
    ring [], first WovenFirst [Free() Pinned()],
    fields [q momentum_q] groups []
    totals []
);

fn bodies(case: &Case) -> Data {
    let mut r = Random(8 + case.n as u64);
    Data(BTreeMap::from([
        ("J", vec![1.0, 0.05, 0.02, 0.05, 0.8, 0.01, 0.02, 0.01, 0.6]),
        ("d", vec![0.3, 0.4, 0.5]),
        ("eps", vec![0.4]),
        ("Λ", r.turns(case.nodes(), 0.7)),
        ("body_momentum_Λ", r.list(3 * case.nodes(), 1.0)),
    ]))
}

fn woven(case: &Case) -> Data {
    let mut r = Random(10 + case.n as u64);
    let nodes = case.nodes();
    Data(BTreeMap::from([
        ("m", about(1.5, r.list(nodes, 0.3))),
        ("b", vec![0.5]),
        ("c", vec![0.3]),
        ("e", vec![0.6]),
        ("q", r.list(nodes, 1.0)),
        ("momentum_q", r.list(nodes, 0.5)),
    ]))
}

/// Chains of up to twelve segments, since longer chains repeat the sites between the ends. A process should build few
/// cards of chains, since it keeps them.
pub fn all() -> Vec<Line> {
    let few = |ends: &[[&'static str; 2]]| {
        let all = cases(true, ends).into_iter();
        all.filter(|c| c.n <= 12).collect()
    };
    vec![
        Line {
            source: BODIES,
            make: BodiesLine::of,
            data: bodies,
            cases: few(&FREE),
        },
        Line {
            source: Woven::<f64>::SOURCE,
            make: WovenLine::of,
            data: woven,
            cases: few(&pairs(&["free", "pinned"], &["free"])),
        },
    ]
}
