//! Chains whose sites are linear maps, rotations of the plane and rigid motions: their statements, data, and their
//! actions as sums typed by hand.

use super::matrix::{A, D, real};
use clebsch::Real;

/// The step size of all models.
pub const H: f64 = 0.02;

/// A line.
pub struct Chain {
    pub source: &'static str,
    /// The moving quantity, and the number of rows of its matrix.
    pub element: &'static str,
    pub rows: usize,
    /// Its end conditions; `None` for a ring.
    pub ends: Option<[&'static str; 2]>,
    /// Numbers by name, for this number of nodes.
    pub given: fn(&str, usize) -> Option<Vec<f64>>,
    /// The action of an edge, by elements at its two ends.
    pub action: fn(&[A], &[A], bool) -> D,
    /// Directions of variation on the side of the velocity, and the positions of their components in the momentum.
    pub directions: fn() -> Vec<(Vec<f64>, usize)>,
    pub spatial: bool,
    /// The number of first nodes that an end condition prescribes.
    pub held: usize,
}

impl Chain {
    /// The number of nodes for a number of segments.
    pub fn nodes(&self, n: usize) -> usize {
        n + usize::from(self.ends.is_some())
    }

    /// The number of components of a momentum.
    pub fn momentum(&self) -> usize {
        match (self.element, self.rows) {
            ("Q" | "R", n) => n * n,
            (_, 3) => 3,
            _ => 6,
        }
    }
}

/// Numbers between -1 and 1, the same in every run.
pub fn scattered(n: usize, by: f64) -> Vec<f64> {
    (1..=n).map(|i| (by * i as f64).sin()).collect()
}

fn diagonal(x: &[f64]) -> Vec<f64> {
    let n = x.len();
    let all = (0..n * n).map(|k| if k / n == k % n { x[k / n] } else { 0.0 });
    all.collect()
}

/// `1.2 Id` and up to a fifth more in every entry.
fn maps(n: usize, count: usize) -> Vec<f64> {
    let own = scattered(n * n * count, 1.3).into_iter().enumerate();
    own.map(|(k, x)| {
        let k = k % (n * n);
        0.2 * x + if k / n == k % n { 1.2 } else { 0.0 }
    })
    .collect()
}

fn units(n: usize) -> Vec<(Vec<f64>, usize)> {
    let unit = |k: usize| {
        let mut e = vec![0.0; n * n];
        e[k] = 1.0;
        (e, k)
    };
    (0..n * n).map(unit).collect()
}

/// The sum of the values at both ends, times `h/2`.
fn at_nodes(from: &[A], to: &[A], of: impl Fn(&[A]) -> D) -> D {
    (of(from) + of(to)) * real(H / 2.0)
}

/// Pairs of neighbours.
fn pairs(x: &[A], ring: bool) -> Vec<(&A, &A)> {
    let last = if ring { x.len() } else { x.len() - 1 };
    (0..last).map(|i| (&x[i], &x[(i + 1) % x.len()])).collect()
}

fn sum(terms: impl Iterator<Item = D>) -> D {
    terms.fold(real(0.0), |sum, x| sum + x)
}

const I0: [f64; 3] = [1.0, 0.7, 0.5];

/// Neo-Hookean ellipsoids with coupled centres, each with its deformation.
pub fn ellipsoids() -> Chain {
    fn given(name: &str, nodes: usize) -> Option<Vec<f64>> {
        Some(match name {
            "I0" => diagonal(&I0),
            "mu" => vec![0.9],
            "lambda" => vec![1.4],
            "k" => vec![0.6],
            "Q" => maps(3, nodes),
            "body_momentum_Q" => scattered(9 * nodes, 0.7),
            _ => return None,
        })
    }
    fn action(q: &[A], to: &[A], ring: bool) -> D {
        let inertia = A::of(3, &diagonal(&I0));
        let moving = q.iter().zip(to).map(|(q, to)| {
            let d = to - q;
            (&(&d * &inertia) * &d.t()).tr() * real(0.5 / H)
        });
        let potential = |q: &[A]| {
            let own = q.iter().map(|q| {
                let c = &q.t() * q;
                let log = c.det().ln();
                (c.tr() - log) * real(0.45) + log * log * real(1.4 / 8.0)
            });
            let tied = pairs(q, ring).into_iter().map(|(a, b)| {
                let d = b - a;
                d.dot(&d) * real(0.3)
            });
            sum(own) + sum(tied)
        };
        sum(moving) - at_nodes(q, to, potential)
    }
    Chain {
        source: "model Ellipsoids {
    label i in 0..N;
    param I0: Sym<3>;
    param mu, lambda, k: Real;
    group Q: GL<3> at nodes velocity G;
    advected C: Sym<3> at nodes = Q^T*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    let W = (mu/2)*(tr(C) - log(det(C))) + (lambda/8)*log(det(C))^2;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W - (h*k/2)*tr((next(Q, i) - Q)^T*(next(Q, i) - Q));
}",
        element: "Q",
        rows: 3,
        ends: Some(["free", "free"]),
        given,
        action,
        directions: || units(3),
        spatial: false,
        held: 0,
    }
}

const C0: [f64; 4] = [1.2, 0.3, 0.3, 0.9];

/// Ellipses of the plane in the space frame, on a ring, with neighbours coupled by their second moments.
pub fn ellipses() -> Chain {
    fn given(name: &str, nodes: usize) -> Option<Vec<f64>> {
        Some(match name {
            "C0" => C0.to_vec(),
            "I0" => diagonal(&[0.8, 0.5]),
            "a" => vec![0.7],
            "d" => vec![1.1],
            "k" => vec![0.2],
            "Q" => maps(2, nodes),
            "spatial_momentum_Q" => scattered(4 * nodes, 0.7),
            _ => return None,
        })
    }
    fn action(q: &[A], to: &[A], ring: bool) -> D {
        let (metric, inertia) = (A::of(2, &C0), A::of(2, &diagonal(&[0.8, 0.5])));
        let moving = q.iter().zip(to).map(|(q, to)| {
            let d = to - q;
            (&(&metric * &d) * &(&inertia * &d.t())).tr() * real(0.5 / H)
        });
        let potential = |q: &[A]| {
            let moments: Vec<A> = q.iter().map(|q| &(q * &inertia) * &q.t()).collect();
            let own = moments
                .iter()
                .map(|s| s.tr() * real(0.7) - s.det().ln() * real(0.55));
            let tied = pairs(&moments, ring).into_iter().map(|(a, b)| {
                let d = b - a;
                d.dot(&d) * real(0.1)
            });
            sum(own) + sum(tied)
        };
        sum(moving) - at_nodes(q, to, potential)
    }
    Chain {
        source: "model Ellipses {
    label i in 0..N;
    periodic;
    param C0, I0: Sym<2>;
    param a, d, k: Real;
    group Q: GL<2> at nodes velocity g;
    advected S: Sym<2> at nodes = Q*I0*Q^T;
    constraint next(Q) = g*Q;
    constraint next(S) = g*S*g^T;
    let T = next(S, i) - S;
    lagrangian = tr(C0*(g - Id)*S*(g - Id)^T)/(2*h) - h*(a*tr(S) - (d/2)*log(det(S))) - (h*k/2)*tr(T^T*T);
}",
        element: "Q",
        rows: 2,
        ends: None,
        given,
        action,
        directions: || units(2),
        spatial: true,
        held: 0,
    }
}

fn turns(count: usize) -> Vec<f64> {
    let each = scattered(count, 2.1).into_iter();
    each.flat_map(|a| [a.cos(), -a.sin(), a.sin(), a.cos()])
        .collect()
}

/// Rotors of the plane in a field, each coupled to its neighbours; the first may be prescribed.
pub fn rotors(ends: Option<[&'static str; 2]>) -> Chain {
    fn given(name: &str, nodes: usize) -> Option<Vec<f64>> {
        Some(match name {
            "J" => (0..nodes)
                .flat_map(|i| diagonal(&[0.5, 0.3 + 0.1 * (i as f64).sin()]))
                .collect(),
            "c" => vec![0.8],
            "e" => vec![0.6, -0.4],
            "a" => vec![0.3, 0.9],
            "R" => turns(nodes),
            "body_momentum_R" => {
                let each = scattered(nodes, 0.7).into_iter();
                each.flat_map(|m| [0.0, -m, m, 0.0]).collect()
            }
            _ => return None,
        })
    }
    fn action(r: &[A], to: &[A], ring: bool) -> D {
        let [e, a] = [[0.6, -0.4], [0.3, 0.9]].map(|x| A::of(2, &x));
        let moving = r.iter().zip(to).enumerate().map(|(i, (r, to))| {
            let j = A::of(2, &diagonal(&[0.5, 0.3 + 0.1 * (i as f64).sin()]));
            (&j * &(&r.t() * to)).tr() * real(-1.0 / H)
        });
        let potential = |r: &[A]| {
            let own = r.iter().map(|r| e.dot(&(r * &a)));
            let tied = pairs(r, ring)
                .into_iter()
                .map(|(a, b)| (&a.t() * b).tr() * real(0.8));
            real(0.0) - sum(own) - sum(tied)
        };
        sum(moving) - at_nodes(r, to, potential)
    }
    Chain {
        source: "model Rotors {
    label i in 0..N;
    periodic;
    param J: Sym<2> at nodes;
    param c: Real;
    param e, a: Vec<2>;
    group R: SO<2> at nodes velocity W;
    constraint next(R) = R*W;
    lagrangian = -tr(J*W)/h + h*dot(e, R*a) + h*c*tr(R^T*next(R, i));
    end i = 0 { free; held { R = given; } }
}",
        element: "R",
        rows: 2,
        ends,
        given,
        action,
        directions: || vec![(vec![0.0, -1.0, 1.0, 0.0], 2)],
        spatial: false,
        held: usize::from(ends.is_some_and(|[first, _]| first == "held")),
    }
}

/// Frames along a rod, turned and bent.
fn frames_at(count: usize) -> Vec<f64> {
    let mut out = Vec::new();
    for i in 0..count {
        let x = i as f64;
        let (a, b) = (0.3 * x.sin(), 0.2 * (1.7 * x).cos());
        let about_x = A::of(
            3,
            &[1.0, 0.0, 0.0, 0.0, a.cos(), -a.sin(), 0.0, a.sin(), a.cos()],
        );
        let about_z = A::of(
            3,
            &[b.cos(), -b.sin(), 0.0, b.sin(), b.cos(), 0.0, 0.0, 0.0, 1.0],
        );
        let turn = &about_x * &about_z;
        let place = [0.1 * (2.3 * x).sin(), 0.1 * x.cos(), 0.5 * x];
        for (row, x) in turn.e.chunks(3).zip(place) {
            out.extend(row.iter().map(|e| e.real));
            out.push(x);
        }
        out.extend([0.0, 0.0, 0.0, 1.0]);
    }
    out
}

const SIX: [f64; 6] = [0.2, 0.3, 0.4, 1.0, 1.3, 0.8];

/// A rod of frames and positions in one group, in a fluid: added masses, weight, stretching, shear, bending and
/// twist.
pub fn frames(ends: Option<[&'static str; 2]>, spatial: bool) -> Chain {
    fn given(name: &str, nodes: usize) -> Option<Vec<f64>> {
        Some(match name {
            "s" => vec![0.5],
            "J" => diagonal(&SIX[..3]),
            "M" => diagonal(&SIX[3..]),
            "C" => diagonal(&[0.3, 0.5, 0.4]),
            "K" => diagonal(&[2.0, 2.5, 3.0]),
            "b" => vec![0.1, -0.2, 0.05, 0.7],
            "Z" => vec![0.0, 0.6, 0.8, 0.1],
            "F0" => frames_at(1),
            "Φ" => frames_at(nodes),
            "body_momentum_Φ" | "spatial_momentum_Φ" => {
                scattered(6 * nodes, 0.7).iter().map(|x| 0.3 * x).collect()
            }
            _ => return None,
        })
    }
    fn action(g: &[A], to: &[A], ring: bool) -> D {
        let s = 0.5;
        let (j, m) = (
            A::of(3, &diagonal(&SIX[..3])),
            A::of(3, &diagonal(&SIX[3..])),
        );
        let moving = g.iter().zip(to).map(|(g, to)| {
            let v = &g.motion_inverse() * to;
            let u = (&v.pos() - &v.motion_inverse().pos()).scaled(0.5);
            (&j * &v.rot()).tr() * real(-s / H) + u.dot(&(&m * &u)) * real(s / (2.0 * H))
        });
        let (c, k) = (
            A::of(3, &diagonal(&[0.3, 0.5, 0.4])),
            A::of(3, &diagonal(&[2.0, 2.5, 3.0])),
        );
        let (b, z) = (
            A::of(4, &[0.1, -0.2, 0.05, 0.7]),
            A::of(4, &[0.0, 0.6, 0.8, 0.1]),
        );
        let along = A::of(3, &[0.0, 0.0, 1.0]);
        let potential = |g: &[A]| {
            let weight = g.iter().map(|g| b.dot(&(&g.t() * &z)) * real(s));
            let bent = pairs(g, ring).into_iter().map(|(a, b)| {
                let u = &a.motion_inverse() * b;
                let f = &u.pos().scaled(1.0 / s) - &along;
                f.dot(&(&k * &f)) * real(s / 2.0) - (&c * &u.rot()).tr() * real(1.0 / s)
            });
            sum(weight) + sum(bent)
        };
        sum(moving) - at_nodes(g, to, potential)
    }
    fn directions() -> Vec<(Vec<f64>, usize)> {
        let entries = [[(2, 1), (1, 2)], [(0, 2), (2, 0)], [(1, 0), (0, 1)]];
        let turning = entries.iter().enumerate().map(|(k, [up, down])| {
            let mut e = vec![0.0; 16];
            e[4 * up.0 + up.1] = 1.0;
            e[4 * down.0 + down.1] = -1.0;
            (e, k)
        });
        let moving = (0..3).map(|k| {
            let mut e = vec![0.0; 16];
            e[4 * k + 3] = 1.0;
            (e, 3 + k)
        });
        turning.chain(moving).collect()
    }
    Chain {
        source: match spatial {
            false => {
                "model Frames {
    label i in 0..N step s;
    periodic;
    param J, M, C, K: Sym<3>;
    param b, Z: Vec<4>;
    group Φ: SE<3> at nodes velocity V;
    advected P: Vec<4> at nodes = Φ^T*Z;
    constraint next(Φ) = Φ*V;
    constraint next(P) = V^T*P;
    let u = (pos(V) - pos(V^-1))/2;
    let U = Φ^-1*next(Φ, i);
    let F = pos(U)/s - E3;
    lagrangian = -s*tr(J*rot(V))/h + s*dot(u, M*u)/(2*h) - h*s*dot(b, P)
        - (h*s/2)*dot(F, K*F) + (h/s)*tr(C*rot(U));
    end i = 0 {
        free;
        clamped { Φ = given; }
        tied { param F0: SE<3>; term h*tr(rot(F0^-1*Φ)) - (h/2)*dot(pos(F0^-1*Φ), pos(F0^-1*Φ)); }
    }
}"
            }
            true => {
                "model FramesSeenFromSpace {
    label i in 0..N step s;
    periodic;
    param J, M, C, K: Sym<3>;
    param b, Z: Vec<4>;
    group Φ: SE<3> at nodes velocity v;
    constraint next(Φ) = v*Φ;
    let V = Φ^-1*v*Φ;
    let u = (pos(V) - pos(V^-1))/2;
    let U = Φ^-1*next(Φ, i);
    let F = pos(U)/s - E3;
    lagrangian = -s*tr(J*rot(V))/h + s*dot(u, M*u)/(2*h) - h*s*dot(b, Φ^T*Z)
        - (h*s/2)*dot(F, K*F) + (h/s)*tr(C*rot(U));
}"
            }
        },
        element: "Φ",
        rows: 4,
        ends,
        given,
        action: match ends {
            Some(["tied", _]) => |g, to, ring| {
                let origin = A::of(4, &frames_at(1)).motion_inverse();
                let tied = |g: &[A]| {
                    let way = &origin * &g[0];
                    way.pos().dot(&way.pos()) * real(0.5) - way.rot().tr()
                };
                action(g, to, ring) - at_nodes(g, to, tied)
            },
            _ => action,
        },
        directions,
        spatial,
        held: usize::from(ends.is_some_and(|[first, _]| first == "clamped")),
    }
}

/// The rod without the fluid, with its weight stated by `pos`.
pub fn hanging(ends: Option<[&'static str; 2]>) -> Chain {
    Chain {
        source: "model HangingFrames {
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
}",
        given: |name, nodes| match name {
            "g" => Some(vec![0.0, 0.6, 0.8]),
            _ => (frames(None, false).given)(name, nodes),
        },
        ..frames(ends, false)
    }
}

/// Sledges on a plane, one behind the other.
pub fn sledges() -> Chain {
    fn given(name: &str, nodes: usize) -> Option<Vec<f64>> {
        Some(match name {
            "s" => vec![0.5],
            "J" => diagonal(&[0.5, 0.3]),
            "m" => vec![1.2],
            "k" => vec![2.0],
            "c" => vec![0.4],
            "w" => vec![0.3, -0.5],
            "a" => vec![0.2, 0.1],
            "G" => (0..nodes)
                .flat_map(|i| {
                    let a = 0.4 * (1.3 * i as f64).sin();
                    let (x, y) = (0.5 * i as f64, 0.2 * (i as f64).cos());
                    [a.cos(), -a.sin(), x, a.sin(), a.cos(), y, 0.0, 0.0, 1.0]
                })
                .collect(),
            "body_momentum_G" => scattered(3 * nodes, 0.7).iter().map(|x| 0.4 * x).collect(),
            _ => return None,
        })
    }
    fn action(g: &[A], to: &[A], ring: bool) -> D {
        let s = 0.5;
        let j = A::of(2, &diagonal(&[0.5, 0.3]));
        let moving = g.iter().zip(to).map(|(g, to)| {
            let y = &to.pos() - &g.pos();
            let turn = &g.rot().t() * &to.rot();
            (&j * &turn).tr() * real(-1.0 / H) + y.dot(&y) * real(1.2 / (2.0 * H))
        });
        let [w, a, along] = [[0.3, -0.5], [0.2, 0.1], [1.0, 0.0]].map(|x| A::of(2, &x));
        let potential = |g: &[A]| {
            let own = g.iter().map(|g| w.dot(&(&g.pos() + &(&g.rot() * &a))));
            let tied = pairs(g, ring).into_iter().map(|(a, b)| {
                let u = &a.motion_inverse() * b;
                let f = &u.pos().scaled(1.0 / s) - &along;
                f.dot(&f) * real(s) - u.rot().tr() * real(0.4 / s)
            });
            sum(own) + sum(tied)
        };
        sum(moving) - at_nodes(g, to, potential)
    }
    Chain {
        source: "model Sledges {
    label i in 0..N step s;
    param J: Sym<2>;
    param m, k, c: Real;
    param a, w: Vec<2>;
    group G: SE<2> at nodes velocity V;
    constraint next(G) = G*V;
    let y = pos(next(G)) - pos(G);
    let U = G^-1*next(G, i);
    let F = pos(U)/s - E1;
    lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a)
        - (h*s*k/2)*dot(F, F) + (h*c/s)*tr(rot(U));
}",
        element: "G",
        rows: 3,
        ends: Some(["free", "free"]),
        given,
        action,
        directions: || {
            let turning = vec![0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            let along = |k: usize| {
                let mut e = vec![0.0; 9];
                e[3 * k + 2] = 1.0;
                (e, 1 + k)
            };
            vec![(turning, 0), along(0), along(1)]
        },
        spatial: false,
        held: 0,
    }
}

/// All of them.
pub fn all() -> Vec<Chain> {
    let free = Some(["free", "free"]);
    vec![
        ellipsoids(),
        ellipses(),
        rotors(None),
        rotors(free),
        rotors(Some(["held", "free"])),
        frames(None, false),
        frames(free, false),
        frames(Some(["clamped", "free"]), false),
        frames(Some(["tied", "free"]), false),
        frames(None, true),
        sledges(),
    ]
}
