//! Chains with constraints on sums over sites, with data that satisfy them: a rod of uniform tension, beads with a
//! fixed centre of mass and a fixed sum of squares.

use super::*;
use clebsch::nalgebra::Vector2;
use clebsch_models::lattices::uniform_tension_rod::*;

const ROD: &str = include_str!("../../../../models/lattices/uniform-tension-rod.clebsch");

clebsch::model! {
    /// Beads in the plane whose centre of mass and sum of squared distances are constrained.
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
    TensionLine: UniformTensionRod UniformTensionRodParameters UniformTensionRodSites UniformTensionRodEnds
        UniformTensionRodInitial UniformTensionRodState UniformTensionRodWorkspace,
    takes [s J B X] starts [Λ body_momentum_Λ],
    ring [], first UniformTensionRodFirst [Free() Clamped(Λw)], last UniformTensionRodLast [Free() Clamped(Λw)],
    fields [] groups [Λ body_momentum_Λ spatial_momentum_Λ] sums [p]
    totals [
        constraint_p "constraint_p"
        constraint_rate_p "constraint_rate_p"
        total_momentum_X "total_momentum_X"
    ]
);
compiled!(
    BeadLine: HeldBeads HeldBeadsParameters HeldBeadsSites HeldBeadsEnds HeldBeadsInitial HeldBeadsState HeldBeadsWorkspace,
    takes [m X R k] starts [φ momentum_φ],
    ring [L], first HeldBeadsFirst [Free() Pinned()], last HeldBeadsLast [Free() Pinned()],
    fields [φ momentum_φ] groups [] sums [c e]
    totals [
        constraint_c "constraint_c"
        constraint_e "constraint_e"
        constraint_rate_c "constraint_rate_c"
        constraint_rate_e "constraint_rate_e"
    ]
);

fn rod(case: &Case) -> Data {
    let n = case.n;
    let mut r = Random(11 + n as u64);
    let turns = r.turns(n, 0.6);
    let across: Vector3<f64> = turns
        .chunks(9)
        .map(|turn| Matrix3::from_row_slice(turn) * Vector3::z() * 0.5)
        .sum();
    // Sections that rotate about their own axes only do not change the chain.
    let spins = (0..n).flat_map(|_| [0.0, 0.0, 0.3 * r.number()]).collect();
    Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("J", by_threes(n, SECTION)),
        ("B", vec![0.5, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.7]),
        ("X", across.as_slice().to_vec()),
        ("Λ", turns),
        ("body_momentum_Λ", spins),
        ("Λw", r.turns(1, 0.2)),
    ]))
}

fn beads(case: &Case) -> Data {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(12 + n as u64);
    let masses = about(1.0, r.list(nodes, 0.2));
    let offset = [0.4, 0.1];
    let places = r.list(2 * nodes, 1.0);
    let place = |i: usize| Vector2::new(places[2 * (i % nodes)], places[2 * (i % nodes) + 1]);
    let seam = |i: usize| match i == nodes {
        true => Vector2::from(offset),
        false => Vector2::zeros(),
    };
    let centre: Vector2<f64> = (0..nodes).map(|i| place(i) * masses[i]).sum();
    let squares = (0..n).map(|i| (place(i + 1) + seam(i + 1) - place(i)).norm_squared());
    Data(BTreeMap::from([
        ("R", vec![squares.sum()]),
        ("X", centre.as_slice().to_vec()),
        ("k", vec![0.7]),
        ("L", offset.to_vec()),
        ("momentum_φ", vec![0.0; 2 * nodes]),
        ("m", masses),
        ("φ", places.clone()),
    ]))
}

/// All chains, with the numbers of their sites and their ends.
pub fn all() -> [Line; 2] {
    let both = |held: &'static str| [["free", "free"], [held, "free"], [held, held]];
    let beyond = |least: usize, held: &'static str| {
        let all = cases(true, &both(held)).into_iter();
        all.filter(|c| c.n > least).collect()
    };
    [
        Line {
            source: ROD,
            make: TensionLine::of,
            data: rod,
            cases: beyond(2, "clamped"),
        },
        Line {
            source: HeldBeads::<f64>::SOURCE,
            make: BeadLine::of,
            data: beads,
            cases: beyond(3, "pinned"),
        },
    ]
}
