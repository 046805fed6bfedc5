//! Chains with constraints, with data that satisfy them: an inextensible rod, a chain of rigid links.

use super::*;
use clebsch_models::lattices::hanging_chain::*;
use clebsch_models::lattices::kirchhoff_rod::*;

pub const ROD: &str = include_str!("../../../../models/lattices/kirchhoff-rod.clebsch");
pub const CHAIN: &str = include_str!("../../../../models/lattices/hanging-chain.clebsch");

clebsch::model! {
    /// Charged beads in the plane at constant distances. Each bead has a number that is advected by its position, and whose
    /// velocity is coupled to the bead's velocity.
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
    ChargedLine: ChargedLinks ChargedLinksParameters ChargedLinksSites ChargedLinksEnds ChargedLinksInitial
        ChargedLinksState ChargedLinksWorkspace,
    takes [m a f b e] starts [X momentum_X q momentum_q],
    ring [],
    fields [X momentum_X q momentum_q λ κ] groups []
    totals [
        constraint_κ "constraint_kappa"
        constraint_λ "constraint_lambda"
        constraint_rate_κ "constraint_rate_kappa"
        constraint_rate_λ "constraint_rate_lambda"
    ]
);
compiled!(
    KirchhoffLine: KirchhoffRod KirchhoffRodParameters KirchhoffRodSites KirchhoffRodEnds KirchhoffRodInitial
        KirchhoffRodState KirchhoffRodWorkspace,
    takes [s m J B g] starts [φ momentum_φ Λ body_momentum_Λ],
    ring [X],
    first KirchhoffRodFirst [Free() Pinned() Clamped(Λw)], last KirchhoffRodLast [Free() Pinned() Load(force)],
    fields [φ momentum_φ n] groups [Λ body_momentum_Λ spatial_momentum_Λ]
    totals [
        constraint_n "constraint_n"
        constraint_rate_n "constraint_rate_n"
        total_momentum_angular_g "total_momentum_angular_g"
        total_momentum_angular_g_about_phi "total_momentum_angular_g_about_phi"
        total_momentum_phi_across_g "total_momentum_phi_across_g"
    ]
);
compiled!(
    ChainLine: HangingChain HangingChainParameters HangingChainSites HangingChainEnds HangingChainInitial
        HangingChainState HangingChainWorkspace,
    takes [m a g] starts [x momentum_x],
    ring [], first HangingChainFirst [Free() Pinned()], last HangingChainLast [Free() Pinned()],
    fields [x momentum_x λ] groups []
    totals [
        constraint_λ "constraint_lambda"
        constraint_rate_λ "constraint_rate_lambda"
        total_momentum_angular_about_x_g "total_momentum_angular_about_x_g"
    ]
);

fn rod(case: &Case) -> Data {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(6 + n as u64);
    let turns = r.turns(n, 0.3);
    let masses = about(0.5, r.list(nodes, 0.1));
    let mut places = vec![Vector3::new(0.1, -0.2, 0.3)];
    let mut momenta: Vec<f64> = Vec::new();
    // Sections that rotate about their own axes only do not change the chain.
    for (i, turn) in turns.chunks(9).enumerate() {
        places.push(places[i] + Matrix3::from_row_slice(turn) * Vector3::z() * 0.5);
        momenta.extend([0.0, 0.0, 0.3 * r.number()]);
    }
    let across = places[n] - places[0];
    Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", masses),
        ("J", by_threes(n, SECTION)),
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
    ]))
}

fn chain(case: &Case) -> Data {
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
    let masses = about(0.5, r.list(nodes, 0.1));
    let free = case.ends.is_none_or(|ends| ends == ["free", "free"]);
    let moving = masses.iter().flat_map(|m| match free {
        true => [0.2 * m, -0.1 * m, 0.3 * m],
        false => [0.0; 3],
    });
    Data(BTreeMap::from([
        ("momentum_x", moving.collect()),
        ("a", (0..n).map(length).collect()),
        ("g", vec![0.3, 0.1, -0.8]),
        (
            "x",
            places.iter().flat_map(|x| x.as_slice().to_vec()).collect(),
        ),
        ("m", masses),
    ]))
}

fn charged(case: &Case) -> Data {
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
    // At rest: the momenta are the momenta of the field.
    let (f, b) = (0.7, 0.2);
    Data(BTreeMap::from([
        ("m", about(1.0, r.list(nodes, 0.2))),
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
    ]))
}

/// All chains, with the numbers of their sites and their ends.
pub fn all() -> [Line; 3] {
    let of_rod = pairs(&["free", "pinned", "clamped"], &["free", "pinned", "load"]);
    let pinned = pairs(&["free", "pinned"], &["free", "pinned"]);
    // Two links between the same two beads constrain the same distance.
    let beyond_two = |ends: &[[&'static str; 2]]| {
        let all = cases(true, ends).into_iter();
        all.filter(|c| c.n > 2).collect()
    };
    [
        Line {
            source: ROD,
            make: KirchhoffLine::of,
            data: rod,
            cases: cases(true, &of_rod),
        },
        Line {
            source: CHAIN,
            make: ChainLine::of,
            data: chain,
            cases: beyond_two(&pinned),
        },
        Line {
            source: ChargedLinks::<f64>::SOURCE,
            make: ChargedLine::of,
            data: charged,
            cases: beyond_two(&FREE),
        },
    ]
}
