//! Pictures of columns of a finished run.

use super::common::{Folder, shipped};
use std::fs;

/// A run of the eccentric orbit, in this folder.
fn orbit(out: &str) {
    let run = [
        "run",
        "kepler:eccentric",
        "--steps",
        "500",
        "--quiet",
        "--out",
        out,
    ];
    assert_eq!(shipped(&run).code, 0);
}

#[test]
fn columns_are_drawn_against_time_and_each_other() {
    let folder = Folder::new("plot");
    let out = folder.path("run");
    orbit(&out);
    let listed = shipped(&["plot", &out]);
    for column in ["  X.1 to X.3\n", "  invariant_energy\n", "  time\n"] {
        assert!(listed.out.contains(column), "{}", listed.out);
    }
    let orbit = folder.path("orbit.svg");
    let done = shipped(&["plot", &out, "--x", "X.1", "--y", "X_2", "--out", &orbit]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        fs::read_to_string(&orbit)
            .expect("a picture")
            .contains("X_2 against X.1")
    );
    // Drawn anew over itself; never over another file.
    assert_eq!(
        shipped(&["plot", &out, "--y", "X", "--out", &orbit]).code,
        0
    );
    let other = folder.write("other.svg", "<svg>mine</svg>");
    let refused = shipped(&["plot", &out, "--y", "X", "--out", &other]);
    assert_eq!(refused.code, 2);
    assert_eq!(fs::read_to_string(&other).expect("it"), "<svg>mine</svg>");
    // Several orbits, each against its own column; all against one otherwise.
    let two = [
        "plot", &out, "--x", "X.1", "--y", "X.2", "--x", "X.2", "--y", "X.3", "--out", &orbit,
    ];
    assert_eq!(shipped(&two).code, 0);
    let picture = fs::read_to_string(&orbit).expect("a picture");
    assert!(picture.contains("X.2 against X.1") && picture.contains("X.3 against X.2"));
    let odd = shipped(&["plot", &out, "--x", "X.1", "--x", "X.2", "--y", "X"]);
    assert!(
        odd.err.contains("2 columns along x and 3 along y"),
        "{}",
        odd.err
    );
    let png = shipped(&["plot", &out, "--y", "X", "--out", &folder.path("a.png")]);
    assert!(png.err.contains("ends in .svg"), "{}", png.err);
    // In the folder of the run, which may still be replaced.
    let done = shipped(&[
        "plot",
        &out,
        "--y",
        "X",
        "--y",
        "invariant_energy",
        "--from",
        "2",
        "--to",
        "3",
    ]);
    assert_eq!(done.code, 0, "{}", done.err);
    let picture = fs::read_to_string(format!("{out}/plot-X-invariant_energy.svg"));
    assert!(picture.expect("a picture").contains("time 2 to 3"));
    let again = shipped(&[
        "run",
        "kepler:eccentric",
        "--steps",
        "500",
        "--quiet",
        "--out",
        &out,
        "--force",
    ]);
    assert_eq!(again.code, 0, "{}", again.err);
    for (arguments, words) in [
        (&["--y", "Y"][..], "the run has no column `Y`"),
        (
            &["--y", "X.4"],
            "`X.4` names no single column of `X`; give a component, X.1 to X.3",
        ),
        (&["--y", "X", "--from", "1e9"], "the run has times 0 to "),
    ] {
        let done = shipped(&[&["plot", &out], arguments].concat());
        assert_eq!(done.code, 2, "{arguments:?}");
        assert!(done.err.contains(words), "{}", done.err);
    }
    let nothing = shipped(&["plot", &folder.path("."), "--y", "X"]);
    assert!(nothing.err.contains("no trajectory.npz"), "{}", nothing.err);
}

#[test]
fn sites_are_counted_from_zero() {
    let folder = Folder::new("plot-sites");
    let out = folder.path("run");
    assert_eq!(
        shipped(&[
            "run",
            "toda-chain",
            "--steps",
            "5",
            "--quiet",
            "--out",
            &out
        ])
        .code,
        0
    );
    let listed = shipped(&["plot", &out]);
    assert!(listed.out.contains("  q_0 to q_31\n"), "{}", listed.out);
    let done = shipped(&["plot", &out, "--x", "momentum_q_31", "--y", "q_0"]);
    assert_eq!(done.code, 0, "{}", done.err);
    // A first site that an end holds is no column, and the others keep their numbers.
    let held = folder.path("held");
    assert_eq!(
        shipped(&[
            "run",
            "hanging-chain:swing",
            "--steps",
            "5",
            "--quiet",
            "--out",
            &held
        ])
        .code,
        0
    );
    let listed = shipped(&["plot", &held]);
    assert!(listed.out.contains("  x_1.1 to x_"), "{}", listed.out);
    let done = shipped(&["plot", &held, "--y", "x_0.1"]);
    assert!(
        done.err.contains(
            "an end prescribes `x_0`, so the run has no such column; give a site and a component, x_1.1 to x_20.3"
        ),
        "{}",
        done.err
    );
    let done = shipped(&["plot", &out, "--y", "q_32"]);
    assert!(
        done.err.contains("give a site, q_0 to q_31"),
        "{}",
        done.err
    );
    let done = shipped(&["plot", &held, "--y", "lambda"]);
    assert!(
        done.err.contains("give a site, lambda_0 to lambda_19"),
        "{}",
        done.err
    );
    // Of a vector at a site all components; lists and brackets.
    for (name, labels) in [
        ("x_10", &["x_10.1", "x_10.2", "x_10.3"][..]),
        ("x_10.1,x_9.3", &["x_10.1", "x_9.3"]),
        ("x[10][2], lambda_3", &["x[10][2]", "lambda_3"]),
    ] {
        let svg = curves(&held, &folder, &[name]).0;
        for label in labels {
            assert!(svg.contains(label), "{name}: {label}");
        }
    }
}

/// A picture of these columns, and the points of its longest lines.
fn curves(run: &str, folder: &Folder, names: &[&str]) -> (String, Vec<Vec<[f64; 2]>>) {
    let out = folder.path("curves.svg");
    let mut arguments = vec!["plot", run, "--out", &out];
    arguments.extend(names.iter().flat_map(|name| ["--y", name]));
    let done = shipped(&arguments);
    assert_eq!(done.code, 0, "{}", done.err);
    let svg = fs::read_to_string(&out).expect("a picture");
    let of_line = |text: &str| -> Vec<[f64; 2]> {
        let points = text.split("points=\"").nth(1).unwrap_or_default();
        let points = points.split('"').next().unwrap_or_default();
        let number = |text: &str| text.parse::<f64>().expect("a number");
        let point = |text: &str| text.split_once(',').map(|(x, y)| [number(x), number(y)]);
        points.split_whitespace().filter_map(point).collect()
    };
    let lines = svg.split("<polyline").skip(1).map(of_line);
    let lines = lines.filter(|line| line.len() > 2).collect();
    (svg, lines)
}

#[test]
fn a_multiplier_begins_where_a_step_has_found_it() {
    let folder = Folder::new("plot-multiplier");
    let out = folder.path("run");
    let run = [
        "run",
        "hanging-chain:swing",
        "--steps",
        "5",
        "--quiet",
        "--out",
        &out,
    ];
    assert_eq!(shipped(&run).code, 0);
    let left = |name: &str| curves(&out, &folder, &[name]).1[0].clone();
    assert_eq!(left("x_1.1").len(), 6);
    let multiplier = left("lambda_3");
    assert_eq!(multiplier.len(), 5);
    assert!(multiplier[0][0] > left("x_1.1")[0][0] + 1.0);
}

#[test]
fn what_is_constant_to_rounding_is_drawn_flat() {
    let folder = Folder::new("plot-flat");
    let out = folder.path("run");
    orbit(&out);
    let height = |line: &[[f64; 2]]| {
        let heights = || line.iter().map(|point| point[1]);
        heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min)
    };
    // The first is rounding about zero, the norm of the whole is not small.
    for name in [
        "invariant_momentum_angular.1",
        "invariant_momentum_angular.2",
        "invariant_momentum_angular.3",
    ] {
        let (svg, lines) = curves(&out, &folder, &[name]);
        assert!(svg.contains("constant to rounding"), "{name}");
        // Of a chart nearly a thousand units high.
        assert!(lines.iter().all(|line| height(line) < 10.0), "{name}");
    }
    let (svg, lines) = curves(&out, &folder, &["X.1"]);
    assert!(!svg.contains("constant to rounding"));
    assert!(lines.iter().any(|line| height(line) > 300.0));
}

/// Names of the table that hold sites in their middle, as those of relative attitudes, are found too.
#[test]
fn columns_are_found_as_the_table_names_them() {
    let folder = Folder::new("plot-names");
    let model = "model Turns {
        label i in 0..N;
        param J: Sym<3> at nodes;
        param k: Real;
        group R: SO<3> at nodes velocity W;
        constraint next(R) = R*W;
        lagrangian = -tr(J*R^T*next(R))/h + h*k*tr(R^T*next(R, i));
    }";
    let case = "model = \"turns\"\nh = 0.01\nsteps = 3\n[labels]\ni = 2\n[parameters]\nJ = { I = [2, 3, 4] }\nk = 1\n[initial]\n\
                R = { axis = [0, 0, 1], angle = 0.3 }\nangular_velocity_R = [1, 0.2, 0]\n";
    let out = folder.path("out");
    let done = super::ran::run(&folder, model, case, &["--out", &out]);
    assert_eq!(done.code, 0, "{}", done.err);
    let table = std::fs::read_to_string(format!("{out}/trajectory.csv")).expect("is written");
    let names = table.lines().next().unwrap_or_default().split(',');
    let own: Vec<&str> = names.filter(|name| name.starts_with("relative_")).collect();
    assert!(own.contains(&"relative_R_0_R_1_11"), "{own:?}");
    for name in own {
        let picture = folder.path(&format!("{name}.svg"));
        let arguments = [
            "plot", &out, "--x", name, "--y", "R_0_11", "--out", &picture,
        ];
        let done = super::common::program(&arguments);
        assert_eq!(done.code, 0, "{name}: {}", done.err);
    }
}
