//! Beads in space connected by springs: totals about positions that one or both ends prescribe.

use super::*;

clebsch::model! {
    /// Beads in space that are joined by springs.
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
    StrungLine: Strung StrungParameters StrungSites StrungEnds StrungInitial StrungState StrungWorkspace,
    takes [m k l] starts [X momentum_X],
    first StrungFirst [Free() Pinned()], last StrungLast [Free() Pinned()],
    fields [X momentum_X] groups []
    totals [
        joint_momentum_across_X_angular "joint_momentum_across_X_angular"
        total_momentum "total_momentum"
        total_momentum_angular "total_momentum_angular"
        total_momentum_angular_about_X "total_momentum_angular_about_X"
    ]
);

/// Beads with random data; prescribed beads are initially at rest.
fn beads(case: &Case) -> Data {
    let mut r = Random(21 + case.n as u64);
    let nodes = case.nodes();
    Data(BTreeMap::from([
        ("m", about(1.0, r.list(nodes, 0.3))),
        ("k", vec![0.7]),
        ("l", vec![0.8]),
        ("X", r.list(3 * nodes, 1.0)),
        ("momentum_X", r.list(3 * nodes, 0.5)),
    ]))
}

/// The chain with the numbers of sites and the ends.
pub fn line() -> Line {
    Line {
        source: Strung::<f64>::SOURCE,
        make: StrungLine::of,
        data: beads,
        cases: cases(false, &pairs(&["free", "pinned"], &["free", "pinned"])),
    }
}
