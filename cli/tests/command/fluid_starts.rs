//! Initial values of fluids from the meshes of the model: values and slopes at the particles. They balance the
//! force of the model up to rounding. Equal cases have identical initial values, byte for byte. If a mesh is
//! undefined there, the message says what to write.

use crate::common::{Folder, table};
use crate::text_runs::{Ran, run};
use clebsch::scalar::largest;

const MODEL: &str = "model Channel {
    label a in 0..N; grid n;
    param m: Real at a; param w: Real at n; param c0, f, alpha: Real;
    field X: Vec<2> at a on box;
    mesh H: Real at n = deposit(X, m);
    mesh S: Real at n = smooth(H, alpha);
    lagrangian = (m/(2*h))*dot(next(X) - X, next(X) - X) + (m*f/2)*dot(perp(X), next(X)) - h*(c0^2/2)*w*H*S;
}
";

const VELOCITY: &str = r#"["-(c0^2/f)*slope(S, 2)", "(c0^2/f)*slope(S, 1)"]"#;

/// Particles on a perturbed lattice that do not reach a wall in a step; numbers are given by expressions in one
/// another.
fn case(start: &str) -> String {
    format!(
        "model = \"Channel\"\nh = 0.05\nsteps = 1\n[labels]\na = 64\nn = [6, 5]\n\
         [domain]\nlengths = [2.0, 1.5]\nwalls = [\"solid\", \"periodic\"]\n\
         [parameters]\nm = {{ depth = \"1 + 0.2*exp(-4*((x - 1)^2 + (y - 0.7)^2))\" }}\n\
         alpha = \"0.1*c0\"\nc0 = \"pi/2\"\nf = 1.5\n\
         [initial]\nX = {{ lattice = \"square\", jitter = 0.3, seed = 5 }}\n{start}\n"
    )
}

/// The deviation of the first step from the direction of the velocity, relative to the deviation by the Coriolis
/// force alone. It vanishes if and only if the force balances the Coriolis force at the start: the velocity u of the
/// step solves `u - (f h/2) R u = v + (h/2) a`, and `v` solves this equation for `a = -f R v`.
fn imbalance(model: &str, start: &str, name: &str) -> f64 {
    let ran = Ran::of(model, &case(start), name);
    let (h, f) = (0.05, ran.parameter("f"));
    let (mut off, mut scale) = (Vec::new(), Vec::new());
    for a in 0..64 {
        let m = ran.parameter(&format!("m_{a}"));
        let x = |node: usize| [1, 2].map(|d| ran.at(&format!("X_{a}_{d}"), node));
        let [from, to] = [x(0), x(1)];
        let turned = [-from[1], from[0]];
        for d in 0..2 {
            let p = ran.at(&format!("momentum_X_{a}_{}", d + 1), 0);
            let v = p / m - f / 2.0 * turned[d];
            off.push(to[d] - from[d] - h * v);
            scale.push(h * h * f / 2.0 * v);
        }
    }
    let (off, scale) = (largest(off), largest(scale));
    assert!(scale > 1e-5, "{scale}");
    off / scale
}

#[test]
fn velocities_by_slopes_are_in_balance_with_the_force_of_the_model() {
    let other = MODEL
        .replace("deposit(X, m)", "deposit_quintic(X, m)")
        .replace("smooth(H", "smooth_isotropic(H");
    // Positions of size 2 are rounded to 2e-16, relative to rotations of at least 1e-4. The isotropic smoother is an
    // iteration, whose remainder differs from the remainder of its transpose.
    for (name, model, rounding) in [("cubic", MODEL, 1e-11), ("quintic", &other, 1e-10)] {
        let off = imbalance(model, &format!("velocity_X = {VELOCITY}"), name);
        println!("{name}: {off:e}");
        assert!(off < rounding, "{name}: {off:e}");
    }
    // A different slope and a different mesh.
    for wrong in [
        r#"["-(c0^2/f)*slope(S, 1)", "(c0^2/f)*slope(S, 1)"]"#,
        r#"["-(c0^2/f)*slope(H, 2)", "(c0^2/f)*slope(H, 1)"]"#,
    ] {
        let off = imbalance(MODEL, &format!("velocity_X = {wrong}"), "wrong");
        assert!(off > 1e-2, "{wrong}: {off:e}");
    }
}

#[test]
fn along_a_line_a_momentum_that_the_first_kick_takes_away_moves_nothing() {
    let model = "model Line {
        label a in 0..N; grid n; param m: Real at a; param w: Real at n; param c0, alpha: Real;
        field X: Real at a on box; mesh H: Real at n = deposit(X, m); mesh S: Real at n = smooth(H, alpha);
        lagrangian = m*(next(X) - X)^2/(2*h) - h*(c0^2/2)*w*H*S;
    }";
    let case = "model = \"Line\"\nh = 0.1\nsteps = 1\n[labels]\na = 40\nn = 12\n[domain]\nlengths = [1.5]\nwalls = [\"solid\"]\n\
        [parameters]\nm = { depth = \"1 + 0.3*cos(pi*x/Lx)\" }\nc0 = 1.0\nalpha = 0.2\n\
        [initial]\nX = { lattice = \"square\", jitter = 0.2 }\nmomentum_X = \"m*(h/2)*c0^2*slope(S, 1)\"\n";
    let ran = Ran::of(model, case, "line");
    for a in 0..40 {
        let [from, to] = [0, 1].map(|node| ran.at(&format!("X_{a}"), node));
        // The rounding of a position of at most 1.5.
        assert!((to - from).abs() < 1e-15, "{a}: {from} {to}");
        assert!(ran.at(&format!("momentum_X_{a}"), 0).abs() > 1e-9, "{a}");
    }
}

/// The interpolation is the transpose of the deposit: the masses of the particles times the depth at them is the sum over nodes of the
/// depth, the deposit and the weight.
#[test]
fn a_mesh_by_its_name_is_its_value_at_the_particle() {
    let ran = Ran::of(MODEL, &case("momentum_X = [\"m*S\", 0.0]"), "values");
    let (mut there, mut here) = (0.0, 0.0);
    for a in 0..64 {
        let p = ran.at(&format!("momentum_X_{a}_1"), 0);
        let value = p / ran.parameter(&format!("m_{a}"));
        assert!((0.9..1.3).contains(&value), "{a}: {value}");
        there += p;
    }
    for n in 0..35 {
        let [s, h] = ["S", "H"].map(|mesh| ran.at(&format!("{mesh}_{n}"), 0));
        here += ran.parameter(&format!("w_{n}")) * s * h;
    }
    // Sums of a few hundred terms of one sign.
    assert!((there / here - 1.0).abs() < 1e-13, "{there} {here}");
    // Meshes at particles belong to these particles.
    let model = "model Cells {
        label a in 0..N; param m: Real at a; param g, α: Real; field X: Vec<2> at a on torus(L);
        mesh φ: Real at a = helmholtz_depth(X, m, α);
        lagrangian = (m/(2*h))*dot(next(X) - X, next(X) - X) - h*g*m*φ/2;
    }";
    let case = "model = \"Cells\"\nh = 0.01\nsteps = 1\n[labels]\na = 36\n[domain]\nL = [1.0, 1.0]\n\
        [parameters]\nm = { depth = \"1 + 0.1*cos(2*pi*x)\" }\ng = 1.0\nalpha = 0.2\n\
        [initial]\nX = { lattice = \"brick\", jitter = 0.2 }\nvelocity_X = [\"phi\", \"0.1*sin(2*pi*phi)\"]\n";
    let ran = Ran::of(model, case, "cells");
    for a in 0..36 {
        let p = ran.at(&format!("momentum_X_{a}_1"), 0);
        let expected = ran.parameter(&format!("m_{a}")) * ran.at(&format!("phi_{a}"), 0);
        // Both are computed from the same positions, and multiplied once.
        assert!((p / expected - 1.0).abs() < 1e-15, "{a}: {p} {expected}");
    }
}

/// Long, since every number that an error suggests is run.
#[test]
fn a_lattice_that_cannot_fill_its_domain_evenly_is_refused_with_numbers_that_can() {
    let folder = Folder::new("fluid-starts-uneven");
    for kind in ["square", "brick"] {
        let of = |count: usize, more: &str| {
            let text = case("").replace("a = 64", &format!("a = {count}"));
            let text = text.replace("\"square\"", &format!("\"{kind}\"{more}"));
            run(&folder, MODEL, &text, "--steps 1")
        };
        let done = of(257, "").exits(2);
        let said = format!(
            "initial.X: 257 particles do not fill the domain evenly with lattice = \"{kind}\"; use "
        );
        let (_, rest) = done
            .err
            .split_once(&said)
            .unwrap_or_else(|| panic!("{}", done.err));
        let (numbers, rest) = rest.split_once(" particles").expect("numbers");
        assert!(
            rest.contains("lattice = \"random\", which accepts any number"),
            "{rest}"
        );
        let numbers = numbers.replace(" or ", ", ");
        let numbers: Vec<usize> = numbers
            .split(", ")
            .map(|n| n.parse().expect("a number"))
            .collect();
        assert_eq!(numbers.len(), 4, "{numbers:?}");
        for n in numbers {
            assert!(n.abs_diff(257) < 10, "{n}");
            of(n, "").ended(0);
        }
        // Columns that a case states are used as given.
        of(257, ", columns = 257").ended(0);
    }
}

#[test]
fn equal_cases_start_alike_to_the_last_byte_and_go_on_from_a_checkpoint() {
    let folder = Folder::new("fluid-starts-bytes");
    let text = case(&format!("velocity_X = {VELOCITY}"));
    let whole = |name: &str, more: &str| {
        run(
            &folder,
            MODEL,
            &text,
            &format!("--steps 20 --out @{name} {more}"),
        )
        .ended(0);
        ["trajectory.csv", "trajectory.npz", "run.json"]
            .map(|file| folder.bytes(&format!("{name}/{file}")))
    };
    let first = whole("first", "");
    assert!(first == whole("second", ""));
    // A complete run is recognised as the same run, because its initial numbers are equal.
    assert!(first == whole("first", "--resume"));
}

#[test]
fn what_has_no_value_is_told_with_what_to_write() {
    let folder = Folder::new("fluid-starts-refused");
    let check = |text: &str, said: &[&str]| {
        let done = run(&folder, MODEL, text, "").exits(2);
        for said in said {
            done.says(said);
        }
    };
    let velocity = |first: &str| case(&format!("velocity_X = [\n\"0\",\n\"{first}\"]"));
    let (line, _) = case("")
        .split_once("[initial]")
        .map_or((0, ""), |(head, _)| (head.lines().count() + 5, ""));
    let place = format!("case.toml:{line}: initial.velocity_X: ");
    for [text, said] in table("
        slope(S, 3)   | slope(S, 3): the domain has two directions: write 1 or 2
        slope(S, 0)   | the domain has two directions
        slope(S, x)   | the direction of a slope must be a whole number, as in slope(S, 1)
        slope(S)      | `slope` takes a mesh and a direction, as in slope(S, 1)
        slope(2, 1)   | `slope` takes the name of a mesh
        slope(S^2, 1) | 2*S*slope(S, 1) for S^2
        slope(m, 1)   | `m` is not a mesh of the model; slopes exist for meshes on a grid, of which the model has `H`, `S`
        slope(Q, 1)   | `Q` is not a mesh of the model
        grad(S, 1)    | `grad` is not a function of site data; there are sin
        Q             | `Q` has no value here
        w             | `w` has no value here
") {
        check(&velocity(text), &[&place, text, said]);
    }
    let of = |from: &str, to: &str| {
        let text = velocity("0");
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    check(
        &of("1 + 0.2*exp", "1 + 0.2*S*exp"),
        &[
            "parameters.m: ",
            "`S` is a mesh, whose values depend on the parameters and the positions X",
            "velocity_X = [\"-slope(S, 2)\"",
        ],
    );
    check(
        &of("f = 1.5", "f = \"slope(S, 1)\""),
        &[
            "parameters.f: ",
            "slope(S, 1) has no value here: use it for meshes on the grid of a fluid",
        ],
    );
    check(
        &of(
            "{ lattice = \"square\", jitter = 0.3, seed = 5 }",
            "[\"a/N\", \"S\"]",
        ),
        &[
            "initial.X: ",
            "`S` depends on the positions X, which this entry defines",
        ],
    );
    check(
        &velocity("S").replace("alpha = \"0.1*c0\"\n", ""),
        &["`S` needs alpha: missing key `parameters.alpha`"],
    );
    check(
        &velocity("S").replace("\"0.1*c0\"", "-1.0"),
        &["`S` has no value at these positions: "],
    );
    // A different set of sites.
    let two = MODEL
        .replace("grid n;", "label b in 0..M; grid n; param k: Real at b;")
        .replace("    mesh H", "    field Y: Vec<2> at b;\n    mesh H")
        .replace(
            "- h*(c0",
            "+ (k/(2*h))*dot(next(Y) - Y, next(Y) - Y) - h*(c0",
        );
    let text = velocity("0")
        .replace("velocity_X", "momentum_X")
        .replace("a = 64", "a = 64\nb = 3");
    let text = text.replace("c0 = ", "k = 1.0\nc0 = ");
    for (momentum, said) in [
        (
            "S",
            "`S` has values at the particles `a`, but the values of Y belong to `b`",
        ),
        ("x", "`x` has no value here"),
    ] {
        let text = format!("{text}Y = [\"b\", 0.0]\nmomentum_Y = [\"{momentum}\", 0.0]\n");
        let done = run(&folder, &two, &text, "").exits(2);
        let said = format!("initial.momentum_Y: \"{momentum}\": {said}");
        done.says(&said);
    }
}

/// A case may give particles and another field. Each can start from velocities, if its momenta do not depend on
/// the other's velocity.
#[test]
fn particles_beside_another_field_start_by_velocities() {
    let model = MODEL.replace("param m: Real at a;", "param m, b: Real at a;");
    let model = model
        .replace("mesh H", "field s: Real at a; mesh H")
        .replace(
            "lagrangian = ",
            "lagrangian = b*(next(s) - s)^2/(2*h) - h*b*s^2*exp(dot(X, X)/8)/2 + ",
        );
    let start = "velocity_X = [\"0.1*sin(2*pi*y/1.5)\", \"0.05*x\"]\ns = \"0.2*x\"\nvelocity_s = \"0.3 - 0.1*y\"";
    let case = case(start).replace("[parameters]\nm = ", "[parameters]\nb = 0.02\nm = 0.03 # ");
    let ran = Ran::of(&model, &case, "beside-another-field");
    for a in 0..64 {
        let m = 0.03;
        let [x, y, p, q] = ["X_{}_1", "X_{}_2", "momentum_X_{}_1", "momentum_X_{}_2"]
            .map(|name| ran.at(&name.replace("{}", &a.to_string()), 0));
        // A vector potential adds to the momenta of velocities.
        let [p, q] = [
            p - m * 0.1 * (std::f64::consts::TAU * y / 1.5).sin(),
            q - m * 0.05 * x,
        ];
        let off = (p.abs() - 0.75 * m * y.abs()).abs() + (q.abs() - 0.75 * m * x.abs()).abs();
        assert!(off < 1e-14, "{a}: {off}");
        assert!((p * x + q * y).abs() < 1e-14, "{a}");
        let s = ran.at(&format!("momentum_s_{a}"), 0);
        assert!((s - 0.02 * (0.3 - 0.1 * y)).abs() < 1e-15, "{a}: {s}");
    }
}
