//! A chain whose ends prescribe rotations equals the shorter chain between walls at these attitudes. Its clocks and
//! advected quantities evolve unchanged. A driven rod that hangs from a fixed end moves like the pendulum typed by hand.

use super::{card, observed, started};
use clebsch::card::Card;

const H: f64 = 0.05;

/// Bodies coupled by torsion springs, whose stiffness depends on a clock at segments.
const BODIES: &str = "model Bodies {
    label i in 0..N;
    param J: Sym<3> at nodes;
    param k, m, a, w: Real;
    param e: Vec<3>;
    group Λ: SO<3> at nodes velocity Ω;
    advected v, n: Vec<3> at nodes;
    advected z: Vec<3> at nodes = Λ^T*e;
    advected τ: Real at nodes;
    advected σ: Real at segments;
    constraint next(Λ) = Λ*Ω;
    constraint next(v) = Ω^T*v;
    constraint next(n) = Ω^T*n;
    constraint next(z) = Ω^T*z;
    constraint next(τ) = τ + h;
    constraint next(σ) = σ + h;
    lagrangian = (1/h)*tr((Id - Ω)*((tr(J)/2)*Id - J)) - h*m*(1 + a*sin(w*τ))*dot(v, E1) - h*m*dot(z, E2)
        - h*m*dot(n, v) - h*m*dot(n, e) + h*k*(1 + a*sin(w*σ))*tr(Λ^T*next(Λ, i));
    end i = 0 { free; held { Λ = given; }
        wall { param W: SO<3>; term h*k*(1 + a*sin(w*τ))*tr(W^T*Λ); } }
    end i = N { held { Λ = given; } free;
        wall { param W: SO<3>; term h*k*(1 + a*sin(w*τ))*tr(W^T*Λ); } }
}";

/// A rotation about an axis that differs from site to site.
fn attitude(site: usize) -> Vec<f64> {
    let angle = 0.4 + 0.3 * site as f64;
    let (s, c) = angle.sin_cos();
    match site % 2 {
        0 => vec![1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c],
        _ => vec![c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c],
    }
}

/// The numbers of the longer chain at one of its sites. All clocks agree, since a wall reads the clock of its
/// neighbour.
fn of_bodies(name: &str, site: usize) -> Vec<f64> {
    let j = site as f64;
    match name {
        "J" => vec![1.0 + 0.1 * j, 0.0, 0.0, 0.0, 1.4, 0.1, 0.0, 0.1, 1.7],
        "k" => vec![0.7],
        "m" => vec![0.3],
        "a" => vec![0.5],
        "w" => vec![1.7],
        "e" => vec![0.2, -0.4, 0.8],
        "Lambda" | "W" => attitude(site),
        "v" => vec![0.3, 0.1 * j, -0.2],
        "n" => vec![0.1, 0.3, 0.5 - 0.1 * j],
        "z" => panic!("z has a definition"),
        "tau" | "sigma" => vec![0.6],
        momentum if momentum.contains("momentum") => vec![0.2 - 0.1 * j, 0.1, 0.05 * j],
        other => panic!("{other} is not expected"),
    }
}

#[test]
fn an_end_that_holds_a_rotation_is_a_wall_beside_a_shorter_chain() {
    for (n, ends) in [
        (2, ["held", "free"]),
        (3, ["free", "held"]),
        (3, ["held", "held"]),
    ] {
        let [first, last] = ends.map(|e| usize::from(e == "held"));
        let shorter = ends.map(|e| if e == "held" { "wall" } else { e });
        let fewer = n - first - last;
        let whole = card(BODIES, n, false, ends);
        let inner = card(BODIES, fewer, false, shorter);
        let given = |name: &str, site: Option<usize>| of_bodies(name, site.unwrap_or(0));
        // The walls replace the ends of the longer chain.
        let moved = |name: &str, site: Option<usize>| match (name, site) {
            ("W", Some(0)) => attitude(0),
            ("W", _) => attitude(n),
            (name, site) => of_bodies(name, site.unwrap_or(0) + first),
        };
        let (mut a, mut b) = (started(&whole, &given, H), started(&inner, &moved, H));
        for _ in 0..40 {
            a.step().expect("steps");
            b.step().expect("steps");
            for site in 0..=fewer {
                for name in ["Lambda", "v", "n", "tau"] {
                    let one = observed(&*a, &format!("{name}_{}", site + first));
                    let other = observed(&*b, &format!("{name}_{site}"));
                    for (x, y) in one.iter().zip(&other) {
                        // The roots are accurate to rounding, and forty steps accumulate these errors.
                        assert!((x - y).abs() < 1e-12, "{name} {site}: {one:?} {other:?}");
                    }
                }
            }
        }
        // The clocks of prescribed sites advance too.
        for (held, site) in [(first, 0), (last, n)] {
            if held == 1 {
                let told = observed(&*a, &format!("tau_{site}"));
                assert!((told[0] - 0.6 - 40.0 * H).abs() < 1e-14, "{told:?}");
            }
        }
    }
}

/// Beads on rods in a plane, driven.
const RODS: &str = "model Rods {
    label i in 0..N;
    param m, f: Real at nodes;
    param w, r: Real;
    field x: Vec<2> at nodes;
    advected τ: Real at nodes;
    constraint next(τ) = τ + h;
    let d = next(x, i) - x;
    hold λ: dot(d, d) = r^2;
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + h*f*sin(w*τ)*dot(x, E1);
    end i = 0 { free; pinned { x = given; } }
    end i = N { free; pinned { x = given; } }
}";

/// A step of the bead by hand: half a kick, the position on the circle that an impulse along the rod gives, half a
/// kick, and the momentum tangent to the circle.
fn by_hand(x: &mut [f64; 2], p: &mut [f64; 2], about: [f64; 2], m: f64, force: [f64; 2]) {
    let radius = |x: &[f64; 2]| [x[0] - about[0], x[1] - about[1]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let here = radius(x);
    let length = dot(here, here);
    p[0] += H / 2.0 * force[0];
    let free = [here[0] + H * p[0] / m, here[1] + H * p[1] / m];
    // |free - s here|² = length; the root near zero.
    let (b, c) = (dot(free, here), dot(free, free) - length);
    let s = c / (b + (b * b - length * c).sqrt());
    for i in 0..2 {
        x[i] = about[i] + free[i] - s * here[i];
        p[i] = m * (free[i] - s * here[i] - here[i]) / H;
    }
    let there = radius(x);
    p[0] += H / 2.0 * force[1];
    let along = dot(*p, there) / length;
    for i in 0..2 {
        p[i] -= along * there[i];
    }
}

fn rods(ends: [&str; 2]) -> Card {
    card(RODS, 1, false, ends)
}

#[test]
fn a_clock_drives_a_rod_that_hangs_from_an_end() {
    for (ends, site) in [(["pinned", "free"], 1), (["free", "pinned"], 0)] {
        let places = [[0.1, 0.2], [0.7, -0.6]];
        let tau = |j: usize| 0.3 + 0.4 * j as f64;
        let (m, f, w) = (1.3, 0.8, 1.1);
        let about = places[1 - site];
        let mut x = places[site];
        // Along the circle.
        let mut p = [0.4 * (x[1] - about[1]), -0.4 * (x[0] - about[0])];
        let start = p;
        let value = |name: &str, at: Option<usize>| match name {
            "m" => vec![m],
            "f" => vec![f],
            "w" => vec![w],
            "r" => vec![1.0],
            "x" => places[at.unwrap_or(site)].to_vec(),
            "tau" => vec![tau(at.unwrap_or(site))],
            _ => start.to_vec(),
        };
        let mut t = started(&rods(ends), &value, H);
        for k in 0..60 {
            t.step().expect("steps");
            let drive = |k: usize| f * (w * (tau(site) + k as f64 * H)).sin();
            by_hand(&mut x, &mut p, about, m, [drive(k), drive(k + 1)]);
            let found = observed(&*t, &format!("x_{site}"));
            for (a, b) in found.iter().zip(x) {
                // Both solve the constraint to rounding.
                assert!((a - b).abs() < 1e-11, "{k}: {found:?} {x:?}");
            }
        }
    }
}
