//! Chains whose sites are solved by Newton's method, stated in this file.

use super::*;

clebsch::model! {
    /// Beads in the plane whose masses depend on another dynamic number.
    pub model Beads {
        label i in 0..N;
        periodic;
        param m: Real at nodes;
        param b, k, e: Real;
        field q: Real at nodes;
        field X: Vec<2> at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h)
            + m*(1 + b*((q + next(q))/2)^2)*dot(next(X) - X, next(X) - X)/(2*h)
            + h*k*cos((q + next(q))/2)
            - h*e*(next(q, i) - q)^2/2 - h*e*dot(next(X, i) - X, next(X, i) - X)/2;
    }
}

clebsch::model! {
    /// A number with a potential at the midpoint of the step, which causes folds; one end may be prescribed.
    pub model Steep {
        label i in 0..N;
        end i = 0 { free; pinned { q = given; } }
        periodic;
        param m, k, e: Real;
        field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) - h*k*((q + next(q))/2)^4 - h*e*(next(q, i) - q)^2/2;
    }
}

compiled!(
    BeadsLine: Beads BeadsParameters BeadsSites BeadsEnds BeadsInitial BeadsState BeadsWorkspace,
    takes [m b k e] starts [q momentum_q X momentum_X],
    ring [],
    fields [q momentum_q X momentum_X] groups []
    totals [total_momentum_X "total_momentum_X" total_momentum_X_angular "total_momentum_X_angular"]
);
compiled!(
    SteepLine: Steep SteepParameters SteepSites SteepEnds SteepInitial SteepState SteepWorkspace,
    takes [m k e] starts [q momentum_q],
    ring [], first SteepFirst [Free() Pinned()],
    fields [q momentum_q] groups []
    totals []
);

fn beads(case: &Case) -> Data {
    let mut r = Random(6 + case.n as u64);
    let nodes = case.nodes();
    Data(BTreeMap::from([
        ("m", about(1.0, r.list(nodes, 0.3))),
        ("b", vec![0.7]),
        ("k", vec![0.9]),
        ("e", vec![0.4]),
        ("q", r.list(nodes, 1.0)),
        ("momentum_q", r.list(nodes, 0.5)),
        ("X", r.list(2 * nodes, 1.0)),
        ("momentum_X", r.list(2 * nodes, 0.5)),
    ]))
}

/// Numbers in a steep potential.
pub fn steep(case: &Case) -> Data {
    let mut r = Random(7 + case.n as u64);
    Data(BTreeMap::from([
        ("m", vec![1.2]),
        ("k", vec![0.8]),
        ("e", vec![0.4]),
        ("q", r.list(case.nodes(), 1.0)),
        ("momentum_q", r.list(case.nodes(), 0.5)),
    ]))
}

pub fn all() -> Vec<Line> {
    let held = pairs(&["free", "pinned"], &["free"]);
    vec![
        Line {
            source: Beads::<f64>::SOURCE,
            make: BeadsLine::of,
            data: beads,
            cases: cases(true, &FREE),
        },
        Line {
            source: Steep::<f64>::SOURCE,
            make: SteepLine::of,
            data: steep,
            cases: cases(true, &held),
        },
    ]
}
