//! Lines whose sites are solved by Newton's method, stated here, as built and from their text.

use super::{Case, Compiled, Data, Made, Named, Random, flat};
use std::collections::BTreeMap;

clebsch::model! {
    /// Beads in the plane whose masses change with a number that moves as well.
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
    /// A number with a potential in the middle of the step that has folds, held at an end.
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
    BeadsLine,
    Beads,
    BeadsState,
    BeadsWorkspace,
    |s, name| match name {
        "q" => flat(s.q()),
        "momentum_q" => flat(s.momentum_q()),
        "X" => flat(s.X()),
        "momentum_X" => flat(s.momentum_X()),
        _ => Vec::new(),
    },
    |m, s| vec![
        (
            "total_momentum_X",
            m.total_momentum_X(s).as_slice().to_vec()
        ),
        (
            "total_momentum_X_angular",
            m.total_momentum_X_angular(s)
                .transpose()
                .as_slice()
                .to_vec()
        ),
    ]
);
compiled!(
    SteepLine,
    Steep,
    SteepState,
    SteepWorkspace,
    |s, name| match name {
        "q" => flat(s.q()),
        "momentum_q" => flat(s.momentum_q()),
        _ => Vec::new(),
    },
    |_, _| Vec::new()
);

/// Beads.
pub fn beads(case: &Case) -> Made {
    let mut r = Random(6 + case.n as u64);
    let nodes = case.nodes();
    let data = Data(BTreeMap::from([
        ("m", r.list(nodes, 0.3).iter().map(|x| 1.0 + x).collect()),
        ("b", vec![0.7]),
        ("k", vec![0.9]),
        ("e", vec![0.4]),
        ("q", r.list(nodes, 1.0)),
        ("momentum_q", r.list(nodes, 0.5)),
        ("X", r.list(2 * nodes, 1.0)),
        ("momentum_X", r.list(2 * nodes, 0.5)),
    ]));
    let parameters = BeadsParameters {
        m: data.numbers("m"),
        b: data.number("b"),
        k: data.number("k"),
        e: data.number("e"),
    };
    let ends = match case.ends {
        None => BeadsEnds::Ring,
        Some(_) => BeadsEnds::Open,
    };
    let model = Beads::new(parameters, BeadsSites { N: case.n, ends }).expect("beads");
    let initial = BeadsInitial {
        q: data.arrays("q"),
        momentum_q: data.arrays("momentum_q"),
        X: data.arrays("X"),
        momentum_X: data.arrays("momentum_X"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(BeadsLine(model, state, work)), data)
}

/// Numbers in a steep potential.
pub fn steep(case: &Case) -> Made {
    let mut r = Random(7 + case.n as u64);
    let data = Data(BTreeMap::from([
        ("m", vec![1.2]),
        ("k", vec![0.8]),
        ("e", vec![0.4]),
        ("q", r.list(case.nodes(), 1.0)),
        ("momentum_q", r.list(case.nodes(), 0.5)),
    ]));
    let line = steep_line(case, &data).expect("starts");
    (line, data)
}

/// The same of these data, or what is said of them.
pub fn steep_line(case: &Case, data: &Data) -> Result<Box<dyn Compiled>, String> {
    let parameters = SteepParameters {
        m: data.number("m"),
        k: data.number("k"),
        e: data.number("e"),
    };
    let ends = match case.ends {
        None => SteepEnds::Ring,
        Some(["pinned", _]) => SteepEnds::Open {
            first: SteepFirst::Pinned,
        },
        Some(_) => SteepEnds::Open {
            first: SteepFirst::Free,
        },
    };
    let model =
        Steep::new(parameters, SteepSites { N: case.n, ends }).map_err(|e| e.to_string())?;
    let initial = SteepInitial {
        q: data.arrays("q"),
        momentum_q: data.arrays("momentum_q"),
    };
    let (state, work) = model.start(initial, case.h).map_err(|e| e.to_string())?;
    Ok(Box::new(SteepLine(model, state, work)))
}
