//! Chains in unit quaternions with random signs.

use super::*;
use clebsch_models::lattices::quaternion_rod::*;

pub const ROD: &str = include_str!("../../../../models/lattices/quaternion-rod.clebsch");

clebsch::model! {
    /// Bodies of a chain in unit quaternions, with a kinetic energy and a coupling that depend on the sign.
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

compiled!(
    RodInQuaternions: QuaternionRod QuaternionRodParameters QuaternionRodSites QuaternionRodEnds QuaternionRodInitial
        QuaternionRodState QuaternionRodWorkspace,
    takes [s m I S K g] starts [φ momentum_φ q body_momentum_q],
    ring [X],
    first QuaternionRodFirst [Free() Pinned() Clamped(qw)],
    last QuaternionRodLast [Free() Pinned() Load(force)],
    fields [φ momentum_φ] groups [q body_momentum_q spatial_momentum_q]
    totals [
        total_momentum_angular_g "total_momentum_angular_g"
        total_momentum_angular_g_about_phi "total_momentum_angular_g_about_phi"
        total_momentum_phi_across_g "total_momentum_phi_across_g"
    ]
);
compiled!(
    TwistedLine: Twisted TwistedParameters TwistedSites TwistedEnds TwistedInitial TwistedState TwistedWorkspace,
    takes [s A b K c a z] starts [q body_momentum_q],
    ring [], first TwistedFirst [Free() Held(qw)], last TwistedLast [Free() Held(qw)],
    fields [] groups [q body_momentum_q spatial_momentum_q]
    totals [total_momentum_z "total_momentum_z"]
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

/// The matrix of a wall.
fn wall(r: &mut Random) -> Vec<f64> {
    let q = turns(r, 1, 0.2);
    let q = UnitQuaternion::from_components([q[0], q[1], q[2], q[3]]).expect("a wall");
    q.matrix().transpose().as_slice().to_vec()
}

fn rod(case: &Case) -> Data {
    let (n, nodes) = (case.n, case.nodes());
    let mut r = Random(8 + n as u64);
    let places = along(r.list(3 * nodes, 0.1));
    let inertia = [0.9, 0.05, 0.0, 0.05, 0.8, 0.02, 0.0, 0.02, 0.7];
    Data(BTreeMap::from([
        ("s", vec![0.5]),
        ("m", about(0.5, r.list(nodes, 0.1))),
        ("I", by_threes(n, inertia)),
        ("S", vec![2.0, 0.1, 0.2, 0.1, 2.5, 0.0, 0.2, 0.0, 3.0]),
        ("K", vec![1.1, 0.05, 0.0, 0.05, 1.2, 0.1, 0.0, 0.1, 0.9]),
        ("g", vec![0.0, 0.1, -0.3]),
        ("X", vec![0.01, 0.02, 0.5 * n as f64]),
        ("force", vec![0.2, -0.1, 0.3]),
        ("φ", places),
        ("momentum_φ", r.list(3 * nodes, 0.2)),
        ("q", turns(&mut r, n, 0.3)),
        ("body_momentum_q", r.list(3 * n, 0.2)),
        ("qw", wall(&mut r)),
    ]))
}

/// Bodies that depend on the sign of their quaternion.
fn twisted(case: &Case) -> Data {
    let nodes = case.nodes();
    let mut r = Random(9 + case.n as u64);
    let inertia = [1.5, 0.05, 0.02, 0.05, 1.4, 0.01, 0.02, 0.01, 1.9];
    Data(BTreeMap::from([
        ("s", vec![0.8]),
        ("A", (0..nodes).flat_map(|_| inertia).collect()),
        ("b", about(0.5, r.list(nodes, 0.2))),
        ("K", vec![0.6, 0.04, 0.0, 0.04, 0.5, 0.03, 0.0, 0.03, 0.7]),
        ("c", vec![0.4]),
        ("a", vec![0.1, -0.2, 0.7]),
        ("z", vec![0.0, 0.6, 0.8]),
        ("q", turns(&mut r, nodes, 0.4)),
        ("body_momentum_q", r.list(3 * nodes, 0.5)),
        ("qw", wall(&mut r)),
    ]))
}

/// Every line in quaternions.
pub fn all() -> [Line; 2] {
    let of_rod = pairs(&["free", "pinned", "clamped"], &["free", "pinned", "load"]);
    let held = pairs(&["free", "held"], &["free", "held"]);
    [
        Line {
            source: ROD,
            make: RodInQuaternions::of,
            data: rod,
            cases: cases(true, &of_rod),
        },
        Line {
            source: Twisted::<f64>::SOURCE,
            make: TwistedLine::of,
            data: twisted,
            cases: cases(true, &held),
        },
    ]
}
