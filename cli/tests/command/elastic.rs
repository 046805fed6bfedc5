//! Elastic bodies and constraints on the command line: the shipped files are derived and run, and compared with
//! reference runs; trajectories contain the multipliers.

use crate::common::{Folder, clebsch, runs, text_of};

/// The model files that the project ships, each with its case and steps that take little time.
const SHIPPED: [(&str, &str); 9] = [
    ("fluid-ellipsoid", "200"),
    ("kirchhoff-static", "2000"),
    ("mooney-rivlin", "200"),
    ("neo-hooke", "200"),
    ("pseudo-rigid", "20"),
    ("pseudo-rigid-anisotropic", "10"),
    ("pseudo-rigid-bipolar", "6"),
    ("pseudo-rigid-positive", "10"),
    ("spherical-pendulum", "200"),
];

/// Long, since each of nine models is derived in four formats and is run.
#[test]
fn every_model_is_derived_and_runs_its_case() {
    for (name, steps) in SHIPPED {
        for format in ["text", "latex", "markdown", "json"] {
            runs(&format!(
                "derive models/elastic/{name}.clebsch --format {format}"
            ))
            .prints("Invariants");
        }
        runs(&format!(
            "run models/elastic/{name}.clebsch --case models/elastic/{name}.toml --steps {steps}"
        ))
        .never_prints("EXCEEDED");
    }
}

/// The end of the shipped rod in equilibrium agrees with an independent program for fifty segments, up to the
/// rounding of fifty products. That program solves the equation of the rod by Newton's method and rotates each frame
/// relative to the previous one.
#[test]
fn a_rod_at_rest_ends_where_the_reference_does() {
    let folder = Folder::new("rod-at-rest");
    runs(&format!(
        "run models/elastic/kirchhoff-static.clebsch --case models/elastic/kirchhoff-static.toml --out {}",
        folder.path("out")
    ));
    let samples = folder.samples("out/trajectory.csv");
    let end = samples.rows.last().expect("rows");
    #[rustfmt::skip]
    let reference = [
        0.7076694221454083, -0.6554814347525227, 0.26371969523559435,
        0.7017068459557356, 0.6084314602598639, -0.3707002299768661,
        0.08253175933684809, 0.4473871330970756, 0.8905241500599189,
    ];
    for (found, wanted) in end[2..11].iter().zip(reference) {
        assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
    }
}

/// A section under a moment m about one axis rotates by the angle with sine h m/K, where K is the stiffness
/// about that axis. If h m exceeds K, there is no step, and the message gives the ratio. For a moment about
/// several axes the general bound applies, here the bound for the axis between them.
#[test]
fn a_section_of_a_rod_turns_by_less_than_a_right_angle() {
    let folder = Folder::new("rod-bound");
    let text = text_of("elastic/kirchhoff-static.toml");
    let with = |moment: &str| {
        let (force, own) = (
            "n = [0.0045000000000000005, 0.0, 0.015]",
            "[0.0012, -0.0008, 0.0036]",
        );
        assert!(text.contains(force) && text.contains(own));
        let text = text.replace(force, "n = [0, 0, 0]").replace(own, moment);
        folder.write("case.toml", &text)
    };
    // K1 = 0.002 against bending, K3 = 0.004 against twist.
    for (moment, stiffness, axis) in [
        ("[0.0036, 0, 0]", 0.002, 1),
        ("[0, 0.0036, 0]", 0.002, 2),
        ("[0, 0, 0.0036]", 0.004, 3),
    ] {
        let case = with(moment);
        let run = |share: f64| {
            let h = format!("{}", share * stiffness / 0.0036);
            clebsch(&format!(
                "run models/elastic/kirchhoff-static.clebsch --case {case} --h {h} --steps 1"
            ))
        };
        run(0.9999).ended(0);
        assert_ne!(run(1.0001).code, 0);
        let done = run(1.01);
        let numbers = format!("|h N_{axis}| = 1.01 I_{axis}{axis})");
        let told = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(told.contains("by a factor 1.010000"), "{told}");
        assert!(told.contains(&numbers), "{numbers}: {told}");
    }
    let case = with("[0.0036, 0.0036, 0]");
    let h = format!("{}", 0.9999 * 0.002 / 0.0036);
    let done = clebsch(&format!(
        "run models/elastic/kirchhoff-static.clebsch --case {case} --h {h} --steps 1"
    ));
    assert_ne!(
        done.code, 0,
        "about the axis between them the moment is larger"
    );
}

/// A case of sample values satisfies the constraints: it runs as printed. If only rotating bodies are constrained, they
/// are unchanged.
#[test]
fn samples_of_held_models_lie_on_their_constraints() {
    let folder = Folder::new("held-samples");
    let model = folder.path("model.clebsch");
    let case = folder.path("case.toml");
    let linked = "model Linked { param m, l, g: Real; field x, y: Vec<3>; \
        hold a: dot(x, x) = l^2; hold b: dot(y - x, y - x) = l^2; \
        lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) - h*m*g*(x[3] + y[3]); }";
    let turned = "model Turned { param J: Sym<3>; group A: SO<3> velocity W; constraint next(A) = A*W; \
        hold n: dot(A*E3, E2) = 0; lagrangian = -tr(J*W)/h; }";
    let pendulum = text_of("elastic/spherical-pendulum.clebsch");
    for text in [linked, turned, &pendulum] {
        std::fs::write(&model, text).expect("writes");
        let sample = folder.runs("case @model.clebsch");
        std::fs::write(&case, &sample.out).expect("writes");
        folder.runs("run @model.clebsch --case @case.toml --steps 10");
    }
}

/// A hanging chain in equilibrium moves by rounding only. The rate of change of its constraints is within that
/// rounding, and does not count as drift.
#[test]
fn a_chain_at_rest_is_within_its_bounds() {
    let folder = Folder::new("chain-at-rest");
    let lattice = |file: &str| {
        format!(
            "{}/../models/lattices/hanging-chain.{file}",
            env!("CARGO_MANIFEST_DIR")
        )
    };
    let text = std::fs::read_to_string(lattice("toml")).expect("reads");
    let slanting = "x = [\"0.015*i\", 0.0, \"-0.02*i\"]";
    assert!(text.contains(slanting), "{text}");
    let case = folder.path("case.toml");
    let vertical = text.replace(slanting, "x = [0.0, 0.0, \"-0.025*i\"]");
    std::fs::write(&case, vertical).expect("writes");
    folder
        .runs(&format!(
            "run {} --case @case.toml --steps 200",
            lattice("clebsch")
        ))
        .never_prints("EXCEEDED");
}

/// These columns of the run of a shipped case, row by row.
fn trajectory(name: &str, more: &str, wanted: &[&str]) -> Vec<Vec<f64>> {
    let folder = Folder::new(&format!("elastic-{name}"));
    let model = format!("models/elastic/{name}");
    folder.runs(&format!(
        "run {model}.clebsch --case {model}.toml --out @out {more}"
    ));
    let samples = folder.samples("out/trajectory.csv");
    let row = |row| wanted.iter().map(|name| samples.at(name, row)).collect();
    (0..samples.rows.len()).map(row).collect()
}

/// Stretches and angular momentum of the run of figures 3.1 to 3.3 from another implementation: nodes 1, 2, 10
/// and 50.
#[test]
fn the_pseudo_rigid_body_of_the_thesis_is_that_of_the_reference_run() {
    let rows = trajectory(
        "pseudo-rigid",
        "--steps 50",
        &["D_1", "D_2", "D_3", "spatial_momentum_R_2"],
    );
    for (node, wanted) in [
        (
            1,
            [0.9821979249661978, 0.7954329005770054, 1.2284501554088025],
        ),
        (
            2,
            [0.939096422791831, 0.7913266125615055, 1.1724312292595402],
        ),
        (
            10,
            [0.935808633565574, 1.2263611948605857, 0.7394511100099694],
        ),
        (
            50,
            [0.8965056176408633, 1.1403595341838453, 0.7775555597739295],
        ),
    ] {
        for (found, wanted) in rows[node].iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-10,
                "node {node}: {found} {wanted}"
            );
        }
    }
    // The thesis's momentum is the negative one.
    assert!((rows[10][3] + 0.0008340017458855056).abs() < 1e-10);
}

/// A Maclaurin spheroid is stationary in its own frame, up to the square of the step size.
#[test]
fn a_maclaurin_spheroid_is_steady() {
    let off = |h: &str, steps: &str| {
        let rows = trajectory(
            "fluid-ellipsoid",
            &format!("--h {h} --steps {steps}"),
            &["Q_31", "Q_32", "Q_33", "Q_11", "Q_21"],
        );
        let height = rows[0][2];
        let radius = rows[0][3];
        let each = rows.iter().map(|q| {
            let own = (q[3] * q[3] + q[4] * q[4]).sqrt() - radius;
            own.abs() + (q[2] - height).abs() + q[0].abs() + q[1].abs()
        });
        each.fold(0.0, |most: f64, x| if x > most { x } else { most })
    };
    let (coarse, fine) = (off("0.04", "250"), off("0.02", "500"));
    let order = (coarse / fine).log2();
    assert!(
        coarse < 2e-4 && (order - 2.0).abs() < 0.1,
        "{coarse:e} {fine:e}"
    );
}

/// (3.62) prints the force with the other sign: the run of figure 3.1 then ends at its eighth step.
#[test]
fn the_printed_sign_of_the_force_in_3_62_explodes() {
    let folder = Folder::new("elastic-sign");
    let text = text_of("elastic/pseudo-rigid.clebsch");
    assert!(text.contains("- h*W;"));
    folder.write("wrong.clebsch", text.replace("- h*W;", "+ h*W;"));
    let done =
        folder.clebsch("run @wrong.clebsch --case models/elastic/pseudo-rigid.toml --steps 30");
    assert_ne!(done.code, 0);
    done.says("step from node 8");
}

/// Multipliers are observables, and constraints at both levels are invariants. The message for inconsistent
/// data says what to do.
#[test]
fn multipliers_and_constraints_are_seen() {
    let rows = trajectory(
        "spherical-pendulum",
        "--steps 100",
        &["lambda", "x_1", "x_2", "x_3"],
    );
    // The weight of the mass along its rod, and the centripetal force of its rotation.
    assert!((rows[1][0] + 10.76).abs() < 0.1, "{:?}", rows[1]);
    for row in &rows {
        let length = row[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - 0.5).abs() < 1e-15, "{length}");
    }
    let folder = Folder::new("elastic-off");
    let text = text_of("elastic/spherical-pendulum.toml");
    for (from, to, wanted) in [
        (
            "x = [0.3,",
            "x = [0.4,",
            "the initial configuration violates the constraint",
        ),
        (
            "momentum = [0.0,",
            "momentum = [0.3,",
            "is not tangent to the constraint",
        ),
    ] {
        assert!(text.contains(from));
        folder.write("off.toml", text.replace(from, to));
        let done = folder.clebsch("run models/elastic/spherical-pendulum.clebsch --case @off.toml");
        assert_ne!(done.code, 0);
        done.says(wanted);
    }
}

/// Momenta of sample cases satisfy the constraints for any configuration: they are zero.
#[test]
fn a_sample_of_a_held_model_is_at_rest_and_says_so() {
    let folder = Folder::new("held-sample");
    folder.write(
        "ring.clebsch",
        "model Ring { param m, k: Real; param c: Vec<2>; field x: Vec<2>; hold λ: dot(x - c, x - c) = 1;
         lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*k*dot(x, x)/2; }",
    );
    let sample = folder.clebsch("case @ring.clebsch");
    sample.prints("\nmomentum = [0.0, 0.0]\n");
    sample.prints("must satisfy the constraints");
    folder.write(
        "rod.clebsch",
        "model Rod { label i in 0..N step s; param m: Real at nodes; field q: Vec<3> at nodes;
         hold n: dot(next(q, i) - q, next(q, i) - q) = s*s;
         lagrangian = m*dot(next(q) - q, next(q) - q)/(2*h); }",
    );
    let sample = folder.clebsch("case @rod.clebsch");
    folder.write("rod.toml", &sample.out);
    folder.runs("run @rod.clebsch --case @rod.toml --steps 3");
}

/// A matrix field whose balance has a number on one side and a matrix on the other: without forces, p = Q̇ I0 is
/// constant.
#[test]
fn a_matrix_field_with_second_moments_runs_from_its_file() {
    let folder = Folder::new("matrix-field");
    folder.write(
        "free.clebsch",
        "model Drifting { param I0: Sym<3>; field Q: Mat<3>; lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h); }",
    );
    folder.runs("run @free.clebsch --case sample --steps 10 --out @out");
    let samples = folder.samples("out/trajectory.csv");
    let numbers = samples.rows.last().expect("a row");
    // The sample: Q begins at a matrix of entries 1, 1/2, ..., momenta 0.1/(1 + i + 3 j), moments 1, 2, 3.
    let (q, p) = (&numbers[2..11], &numbers[11..20]);
    for (k, (q, p)) in q.iter().zip(p).enumerate() {
        let (i, j) = (k / 3, k % 3);
        let momentum = 0.1 / (1 + i + 3 * j) as f64;
        let start = f64::from(u8::from(i == j));
        assert!((p - momentum).abs() < 1e-15, "{p} {momentum}");
        let place = start + 0.1 * momentum / (1 + j) as f64;
        assert!((q - place).abs() < 1e-14, "{k}: {q} {place}");
    }
}
