//! Lines in unit quaternions as built and from their text, their signs given at random.

use super::{Case, Compiled, Data, Line, Made, Named, Random, cases, flat};
use clebsch::nalgebra::Vector3;
use clebsch::of_numbers::OfNumbers;
use clebsch::{Rotation, UnitQuaternion};
use clebsch_models::lattices::quaternion_rod::*;
use std::collections::BTreeMap;

pub const ROD: &str = include_str!("../../../models/lattices/quaternion-rod.clebsch");

clebsch::model! {
    /// Bodies along a line in unit quaternions, whose kinetic energy and whose coupling see how they have come round.
    pub model Twisted {
        label i in 0..N step s;
        periodic;
        param A: Sym<3> at nodes;
        param b: Real at nodes;
        param K: Sym<3>;
        param c: Real;
        param a, z: Vec<3>;
        group q: SU<2> at nodes velocity W;
        constraint next(q) = q*W;
        let U = q^T*next(q, i);
        lagrangian = (2/h)*dot(im(W), (A - b*Id)*im(W)) - (4*b/h)*re(W) + h*dot(z, rot(q)*a)
            + (4*c*h/s)*re(U) - (2*h/s)*dot(im(U), (K - c*Id)*im(U));
        end i = 0 {
            free;
            held { param qw: SU<2>; term (8*c*h/s)*re(qw^T*q); }
        }
        end i = N {
            free;
            held { param qw: SU<2>; term (8*c*h/s)*re(qw^T*q); }
        }
    }
}

fn components(list: impl Iterator<Item = UnitQuaternion>) -> Vec<f64> {
    list.flat_map(|q| q.components()).collect()
}

compiled!(
    RodInQuaternions,
    QuaternionRod,
    QuaternionRodState,
    QuaternionRodWorkspace,
    |s, name| match name {
        "φ" => flat(s.φ()),
        "momentum_φ" => flat(s.momentum_φ()),
        "q" => components(s.q()),
        "body_momentum_q" => flat(&s.body_momentum_q().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_q" => flat(&s.spatial_momentum_q().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![
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
    TwistedLine,
    Twisted,
    TwistedState,
    TwistedWorkspace,
    |s, name| match name {
        "q" => components(s.q()),
        "body_momentum_q" => flat(&s.body_momentum_q().map(|m| m.0).collect::<Vec<_>>()),
        "spatial_momentum_q" => flat(&s.spatial_momentum_q().map(|m| m.0).collect::<Vec<_>>()),
        _ => Vec::new(),
    },
    |m, s| vec![("total_momentum_z", vec![m.total_momentum_z(s)])]
);

/// Random unit quaternions of either sign.
fn turns(r: &mut Random, count: usize, size: f64) -> Vec<f64> {
    let mut all = Vec::new();
    for _ in 0..count {
        let v = Vector3::new(r.number(), r.number(), r.number());
        let sign = r.number().signum();
        all.extend(Rotation::exp(&(v * size)).quaternion().map(|x| x * sign));
    }
    all
}

fn quaternions(data: &Data, name: &'static str) -> Vec<UnitQuaternion> {
    let each = data.0[name].chunks(4);
    each.map(|q| OfNumbers::of_numbers(name, q).expect("of unit length"))
        .collect()
}

/// The matrix of a wall.
fn wall(r: &mut Random) -> Vec<f64> {
    let q = turns(r, 1, 0.2);
    let q = UnitQuaternion::from_components([q[0], q[1], q[2], q[3]]).expect("a wall");
    q.matrix().transpose().as_slice().to_vec()
}

fn rod(case: &Case) -> Made {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(8 + n as u64);
    let inertia = (0..n).flat_map(|i| {
        let x = 1.0 + 0.1 * (i % 3) as f64;
        [0.9, 0.05, 0.0, 0.05, 0.8, 0.02, 0.0, 0.02, 0.7].map(|y| y * x)
    });
    let places = r.list(3 * nodes, 0.1).into_iter().enumerate();
    let places = places.map(|(k, x)| {
        if k % 3 == 2 {
            x + 0.5 * (k / 3) as f64
        } else {
            x
        }
    });
    let data = Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", r.list(nodes, 0.1).iter().map(|x| 0.5 + x).collect()),
        ("I", inertia.collect()),
        ("S", vec![2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0]),
        ("K", vec![1.1, 0.05, 0.0, 0.05, 1.2, 0.1, 0.0, 0.1, 0.9]),
        ("g", vec![0.0, 0.1, -0.3]),
        ("X", vec![0.01, 0.02, 0.5 * n as f64]),
        ("force", vec![0.2, -0.1, 0.3]),
        ("φ", places.collect()),
        ("momentum_φ", r.list(3 * nodes, 0.2)),
        ("q", turns(&mut r, n, 0.3)),
        ("body_momentum_q", r.list(3 * n, 0.2)),
        ("qw", wall(&mut r)),
    ]));
    let ends = match case.ends {
        None => QuaternionRodEnds::Ring { X: data.array("X") },
        Some([first, last]) => QuaternionRodEnds::Open {
            first: match first {
                "free" => QuaternionRodFirst::Free,
                "pinned" => QuaternionRodFirst::Pinned,
                _ => QuaternionRodFirst::Clamped {
                    qw: data.array("qw"),
                },
            },
            last: match last {
                "free" => QuaternionRodLast::Free,
                "pinned" => QuaternionRodLast::Pinned,
                _ => QuaternionRodLast::Load {
                    force: data.array("force"),
                },
            },
        },
    };
    let parameters = QuaternionRodParameters {
        s: data.number("s"),
        m: data.numbers("m"),
        I: data.arrays("I"),
        S: data.array("S"),
        K: data.array("K"),
        g: data.array("g"),
    };
    let sites = QuaternionRodSites { N: n, ends };
    let model = QuaternionRod::new(parameters, sites).expect("a rod");
    let initial = QuaternionRodInitial {
        φ: data.arrays("φ"),
        momentum_φ: data.arrays("momentum_φ"),
        q: quaternions(&data, "q"),
        body_momentum_q: data.momenta("body_momentum_q"),
    };
    let (state, work) = model.start(initial, case.h).expect("starts");
    (Box::new(RodInQuaternions(model, state, work)), data)
}

/// What the compiled line says of data, or the line.
pub fn twisted_of(case: &Case, data: &Data) -> Result<Box<dyn Compiled>, String> {
    let (first, last) = (data.array("qw"), data.array("qw"));
    let ends = match case.ends {
        None => TwistedEnds::Ring,
        Some(ends) => TwistedEnds::Open {
            first: match ends[0] {
                "free" => TwistedFirst::Free,
                _ => TwistedFirst::Held { qw: first },
            },
            last: match ends[1] {
                "free" => TwistedLast::Free,
                _ => TwistedLast::Held { qw: last },
            },
        },
    };
    let parameters = TwistedParameters {
        s: data.number("s"),
        A: data.arrays("A"),
        b: data.numbers("b"),
        K: data.array("K"),
        c: data.number("c"),
        a: data.array("a"),
        z: data.array("z"),
    };
    let model = Twisted::new(parameters, TwistedSites { N: case.n, ends }).expect("a line");
    let initial = TwistedInitial {
        q: quaternions(data, "q"),
        body_momentum_q: data.momenta("body_momentum_q"),
    };
    let started = model.start(initial, case.h);
    let (state, work) = started.map_err(|e| e.to_string())?;
    Ok(Box::new(TwistedLine(model, state, work)))
}

/// Bodies that see how they have come round.
pub fn twisted(case: &Case) -> Made {
    let nodes = case.nodes();
    let mut r = Random(9 + case.n as u64);
    let inertia = [1.5, 0.05, 0.02, 0.05, 1.4, 0.01, 0.02, 0.01, 1.9];
    let data = Data(BTreeMap::from([
        ("s", vec![0.8]),
        ("A", (0..nodes).flat_map(|_| inertia).collect()),
        ("b", r.list(nodes, 0.2).iter().map(|x| 0.5 + x).collect()),
        ("K", vec![0.6, 0.04, 0.0, 0.04, 0.5, 0.03, 0.0, 0.03, 0.7]),
        ("c", vec![0.4]),
        ("a", vec![0.1, -0.2, 0.7]),
        ("z", vec![0.0, 0.6, 0.8]),
        ("q", turns(&mut r, nodes, 0.4)),
        ("body_momentum_q", r.list(3 * nodes, 0.5)),
        ("qw", wall(&mut r)),
    ]));
    (twisted_of(case, &data).expect("starts"), data)
}

/// Every line in quaternions.
pub fn all() -> Vec<Line> {
    let mut of_rod = Vec::new();
    for first in ["free", "pinned", "clamped"] {
        for last in ["free", "pinned", "load"] {
            of_rod.push([first, last]);
        }
    }
    let held = [
        ["free", "free"],
        ["held", "free"],
        ["free", "held"],
        ["held", "held"],
    ];
    vec![
        (ROD, rod, cases(true, &of_rod)),
        (Twisted::<f64>::SOURCE, twisted, cases(true, &held)),
    ]
}
