//! Compiled chains of linear maps and of frames, in coordinates, compared with the same chains from their text.

use super::models::{Chain, H, ellipsoids, hanging, scattered};
use super::started;
use clebsch::nalgebra::{SMatrix, SVector};
use clebsch::{BodyMomentum, Rotation};

clebsch::model! {
    pub model Ellipsoids {
        label i in 0..N;
        param I0: Sym<3>;
        param mu, lambda, k: Real;
        group Q: GL<3> at nodes velocity G;
        advected C: Sym<3> at nodes = Q^T*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        let W = (mu/2)*(tr(C) - log(det(C))) + (lambda/8)*log(det(C))^2;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W - (h*k/2)*tr((next(Q, i) - Q)^T*(next(Q, i) - Q));
    }
}

clebsch::model! {
    pub model HangingFrames {
        label i in 0..N step s;
        periodic;
        param J, M, C, K: Sym<3>;
        param g: Vec<3>;
        group Φ: SE<3> at nodes velocity V;
        constraint next(Φ) = Φ*V;
        let y = pos(next(Φ)) - pos(Φ);
        let U = Φ^-1*next(Φ, i);
        let F = pos(U)/s - E3;
        lagrangian = -s*tr(J*rot(V))/h + s*dot(y, y)/(2*h) + h*s*dot(g, pos(Φ))
            - (h*s/2)*dot(F, K*F) + (h/s)*tr(C*rot(U));
        end i = 0 { free; clamped { Φ = given; } }
    }
}

const N: usize = 7;

fn matrix<const R: usize, const C: usize>(list: &[f64]) -> SMatrix<f64, R, C> {
    SMatrix::from_row_slice(list)
}

fn bits(list: &[f64]) -> Vec<u64> {
    list.iter().map(|x| x.to_bits()).collect()
}

/// Rows of matrices, one after the other.
fn rows<const R: usize, const C: usize>(list: &[SMatrix<f64, R, C>]) -> Vec<f64> {
    let each = list.iter();
    each.flat_map(|a| a.transpose().as_slice().to_vec())
        .collect()
}

/// Undeformed at the start, where momenta in coordinates equal the momenta in the body exactly.
pub fn compared() {
    let at_rest = Chain {
        given: |name, nodes| match name {
            "Q" => Some([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0].repeat(nodes)),
            _ => (ellipsoids().given)(name, nodes),
        },
        ..ellipsoids()
    };
    let mut read = started(&at_rest, at_rest.source, N, H);
    let one = |name: &str| (ellipsoids().given)(name, N + 1).expect("is given");
    let parameters = EllipsoidsParameters {
        I0: matrix(&one("I0")),
        mu: one("mu")[0],
        lambda: one("lambda")[0],
        k: one("k")[0],
    };
    let sites = EllipsoidsSites {
        N,
        ends: EllipsoidsEnds::Open,
    };
    let model = Ellipsoids::new(parameters, sites).expect("is admissible");
    let momenta = scattered(9 * (N + 1), 0.7);
    let initial = EllipsoidsInitial {
        Q: vec![SMatrix::identity(); N + 1],
        momentum_Q: momenta.chunks(9).map(matrix).collect(),
    };
    let (mut state, mut work) = model.start(initial, H).expect("starts");
    for _ in 0..50 {
        model.step(&mut state, &mut work).expect("steps");
        read.step().expect("steps");
    }
    let seen = read.observe("Q").expect("is observed");
    assert_eq!(bits(&seen), bits(&rows(state.Q())));
    let (kinetic, potential) = model.energies(&state);
    let energies = read.energies().expect("has energies");
    assert_eq!(bits(&energies), bits(&[kinetic, potential]));

    for first in ["free", "clamped"] {
        frames(first);
    }
}

fn frames(first: &'static str) {
    let straight = Chain {
        given: |name, nodes| match name {
            "Φ" => Some(
                (0..nodes)
                    .flat_map(|i| {
                        let mut g = [0.0; 16];
                        (g[0], g[5], g[10], g[15]) = (1.0, 1.0, 1.0, 1.0);
                        (g[3], g[11]) = (0.1 * (i as f64).sin(), 0.5 * i as f64);
                        g
                    })
                    .collect(),
            ),
            _ => (hanging(None).given)(name, nodes),
        },
        ..hanging(Some([first, "free"]))
    };
    let straight = Chain {
        held: usize::from(first == "clamped"),
        ..straight
    };
    let mut read = started(&straight, straight.source, N, H);
    let one = |name: &str| (straight.given)(name, N + 1).expect("is given");
    let parameters = HangingFramesParameters {
        s: one("s")[0],
        J: matrix(&one("J")),
        M: matrix(&one("M")),
        C: matrix(&one("C")),
        K: matrix(&one("K")),
        g: matrix(&one("g")),
    };
    let sites = HangingFramesSites {
        N,
        ends: HangingFramesEnds::Open {
            first: match first {
                "free" => HangingFramesFirst::Free,
                _ => HangingFramesFirst::Clamped,
            },
        },
    };
    let model = HangingFrames::new(parameters, sites).expect("is admissible");
    let mut momenta = one("body_momentum_Φ");
    momenta[..6 * straight.held].fill(0.0);
    let places = one("Φ");
    let initial = HangingFramesInitial {
        R_Φ: vec![Rotation::identity(); N + 1],
        body_momentum_R_Φ: momenta
            .chunks(6)
            .map(|m| BodyMomentum(matrix(&m[..3])))
            .collect(),
        x_Φ: places
            .chunks(16)
            .map(|g| SVector::<f64, 3>::new(g[3], g[7], g[11]))
            .collect(),
        momentum_x_Φ: momenta.chunks(6).map(|m| matrix(&m[3..])).collect(),
    };
    let (mut state, mut work) = model.start(initial, H).expect("starts");
    for _ in 0..50 {
        model.step(&mut state, &mut work).expect("steps");
        read.step().expect("steps");
    }
    let seen = read.observe("Φ").expect("is observed");
    let places: Vec<f64> = seen.chunks(16).flat_map(|g| [g[3], g[7], g[11]]).collect();
    assert_eq!(bits(&places), bits(&rows(state.x_Φ())), "{first}");
    let turns: Vec<f64> = seen
        .chunks(16)
        .flat_map(|g| [&g[..3], &g[4..7], &g[8..11]].concat())
        .collect();
    let own: Vec<SMatrix<f64, 3, 3>> = state.R_Φ().map(|r| r.matrix()).collect();
    assert_eq!(bits(&turns), bits(&rows(&own)), "{first}");
}
