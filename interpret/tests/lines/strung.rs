//! Beads in space that springs join, compiled: totals about places that ends hold, of one end or of both.

use super::{Case, Compiled, Data, Line, Made, Named, Random, cases, flat};
use std::collections::BTreeMap;

clebsch::model! {
    /// Beads in space that springs join.
    pub model Strung {
        label i in 0..N;
        param m: Real at nodes;
        param k, l: Real;
        field X: Vec<3> at nodes;
        let d = next(X, i) - X;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*(k/2)*(dot(d, d) - l)^2;
        end i = 0 { free; pinned { X = given; } }
        end i = N { free; pinned { X = given; } }
    }
}

compiled!(
    StrungLine,
    Strung,
    StrungState,
    StrungWorkspace,
    |s, name| match name {
        "X" => flat(s.X()),
        "momentum_X" => flat(s.momentum_X()),
        _ => Vec::new(),
    },
    |m, s| vec![
        (
            "joint_momentum_across_X_angular",
            vec![m.joint_momentum_across_X_angular(s)]
        ),
        ("total_momentum", m.total_momentum(s).as_slice().to_vec()),
        (
            "total_momentum_angular",
            m.total_momentum_angular(s).as_slice().to_vec()
        ),
        (
            "total_momentum_angular_about_X",
            m.total_momentum_angular_about_X(s).as_slice().to_vec()
        ),
    ]
);

/// Beads with random data; none of them moves at the start that an end holds.
pub fn strung(case: &Case) -> Made {
    let mut r = Random(21 + case.n as u64);
    let nodes = case.nodes();
    let data = Data(BTreeMap::from([
        ("m", r.list(nodes, 0.3).iter().map(|x| 1.0 + x).collect()),
        ("k", vec![0.7]),
        ("l", vec![0.8]),
        ("X", r.list(3 * nodes, 1.0)),
        ("momentum_X", r.list(3 * nodes, 0.5)),
    ]));
    let [first, last] = case.ends.unwrap_or(["free", "free"]);
    let ends = StrungEnds::Open {
        first: match first {
            "pinned" => StrungFirst::Pinned,
            _ => StrungFirst::Free,
        },
        last: match last {
            "pinned" => StrungLast::Pinned,
            _ => StrungLast::Free,
        },
    };
    let parameters = StrungParameters {
        m: data.numbers("m"),
        k: data.number("k"),
        l: data.number("l"),
    };
    let model = Strung::new(parameters, StrungSites { N: case.n, ends }).expect("beads");
    let initial = StrungInitial {
        X: data.arrays("X"),
        momentum_X: data.arrays("momentum_X"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(StrungLine(model, state, work)), data)
}

/// It with the numbers of sites and the ends.
pub fn all() -> Vec<Line> {
    let ends = [
        ["free", "free"],
        ["pinned", "free"],
        ["free", "pinned"],
        ["pinned", "pinned"],
    ];
    vec![(Strung::<f64>::SOURCE, strung, cases(false, &ends))]
}
